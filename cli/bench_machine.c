/* What a run was measured on. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

static void processor_name(char name[128])
{
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    snprintf(name, 128, "unknown processor");
    while (file && fgets(line, sizeof line, file)) {
        char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && colon) {
            snprintf(name, 128, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
            break;
        }
    }
    if (file)
        fclose(file);
}

/* As the run that measured wrote it down. */
static char *remembered(const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = fopen(path, "r");
    if (file && getdelim(&text, &size, 0, file) <= 0) {
        free(text);
        text = NULL;
    }
    if (file)
        fclose(file);
    return text;
}

static void remember(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return; /* the report itself holds it, too */
    fputs(text, file);
    fclose(file);
}

static char *describe_machine(const struct bench *bench)
{
    char processor[128], *text = NULL;
    struct utsname name;
    processor_name(processor);
    if (uname(&name) != 0)
        name = (struct utsname){0};
    double memory_gb = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGE_SIZE) * 1e-9;
    if (asprintf(&text,
                 "device: %s\nprocessor: %s, %ld threads\nmemory: %.1f GB\nsystem: %s %s %s\n"
                 "weald %s",
                 bench->device, processor, sysconf(_SC_NPROCESSORS_ONLN), memory_gb, name.sysname,
                 name.release, name.machine, wd_version()) < 0)
        abort();
    return text;
}

bool bench_machine_fits(const struct bench *bench)
{
    char *path = bench_path(bench, "machine.txt"), *before = bench->resumed ? remembered(path) : NULL;
    char *now = describe_machine(bench);
    size_t device = strcspn(now, "\n");
    bool fits = !before || (strcspn(before, "\n") == device && memcmp(before, now, device) == 0);
    if (fits)
        remember(path, now);
    else
        cli_fail(bench->session, "%s: holds results of the %.*s, not of %s; name another directory or remove it",
                 bench->directory, (int)strcspn(before, "\n"), before, bench->device);
    free(path);
    free(before);
    free(now);
    return fits;
}

char *bench_machine_text(const struct bench *bench)
{
    char *path = bench_path(bench, "machine.txt"), *text = NULL;
    if (*bench->device) {
        text = describe_machine(bench);
        remember(path, text);
    } else {
        text = remembered(path);
    }
    free(path);
    return text ? text : describe_machine(bench);
}
