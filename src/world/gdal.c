#define WD_GDAL_NAMES_ALONE
#include "world/gdal.h"

#include <dlfcn.h>
#include <pthread.h>
#include <string.h>

struct wd_gdal_functions wd_gdal;

static pthread_once_t once = PTHREAD_ONCE_INIT;
static const char *missing = "";
static pthread_mutex_t registering = PTHREAD_MUTEX_INITIALIZER;

/* GDAL stays for the life of the process: it cannot be unloaded. */
static void load(void)
{
#define NAME(name) #name,
    static const char *const names[] = {WD_GDAL_FUNCTIONS(NAME)};
#undef NAME
    _Static_assert(sizeof wd_gdal == sizeof names, "a pointer each");
    void *library = dlopen(GDAL_SONAME, RTLD_NOW | RTLD_LOCAL);
    missing = library ? NULL : dlerror();
    for (size_t i = 0; !missing && i < sizeof names / sizeof *names; i++) {
        void *function = dlsym(library, names[i]);
        if (!function)
            missing = dlerror();
        memcpy((char *)&wd_gdal + i * sizeof function, &function, sizeof function);
    }
    if (!missing)
        wd_gdal.GDALAllRegister();
}

bool wd_gdal_load(const char *subject, const struct wd_log *log)
{
    pthread_once(&once, load);
    if (missing)
        return wd_error(log, "%s: GDAL, which reads rasters and coordinate systems, cannot be loaded: %s", subject, missing);
    /* A host program that uses GDAL, too, may have destroyed the drivers when it was done. */
    pthread_mutex_lock(&registering);
    if (wd_gdal.GDALGetDriverCount() == 0)
        wd_gdal.GDALAllRegister();
    pthread_mutex_unlock(&registering);
    return true;
}
