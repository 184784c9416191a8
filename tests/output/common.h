/* common.h: a folder of its own for each test, collected messages, and a picture with structure. */
#ifndef WD_TESTS_OUTPUT_COMMON_H
#define WD_TESTS_OUTPUT_COMMON_H

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "weald/types.h"

struct fixture {
    char folder[64], path[160], text[4096];
    struct wd_log log;
};

static inline void collect(void *user, enum wd_log_level level, const char *message)
{
    struct fixture *f = user;
    size_t used = strlen(f->text);
    (void)level;
    snprintf(f->text + used, sizeof f->text - used, "%s\n", message);
}

static inline bool logged(const struct fixture *f, const char *part)
{
    if (strstr(f->text, part))
        return true;
    fprintf(stderr, "wanted: %s\nlogged: %s\n", part, f->text);
    return false;
}

static inline int setup(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    strcpy(f->folder, "/tmp/weald-output-XXXXXX");
    f->log = (struct wd_log){collect, f};
    *state = f;
    return mkdtemp(f->folder) ? 0 : -1;
}

/* Files in the folder, hidden temporary ones too. */
static inline int file_count(const struct fixture *f)
{
    int count = 0;
    DIR *folder = opendir(f->folder);
    for (struct dirent *entry; (entry = readdir(folder));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(folder);
    return count;
}

static inline int teardown(void **state)
{
    struct fixture *f = *state;
    DIR *folder = opendir(f->folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", f->folder, entry->d_name);
        if (unlink(path) != 0)
            rmdir(path);
    }
    closedir(folder);
    int result = rmdir(f->folder);
    free(f);
    return result;
}

static inline const char *in_folder(struct fixture *f, const char *name)
{
    snprintf(f->path, sizeof f->path, "%s/%s", f->folder, name);
    f->text[0] = '\0';
    return f->path;
}

/* Gradients and a little hashed noise; free() it. */
static inline uint8_t *make_picture(uint32_t width, uint32_t height, uint32_t seed)
{
    uint8_t *rgb = wd_alloc((size_t)width * height * 3);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        seed = seed * 1664525u + 1013904223u;
        rgb[i * 3] = (uint8_t)(i % width * 255 / width);
        rgb[i * 3 + 1] = (uint8_t)(i / width * 255 / height);
        rgb[i * 3 + 2] = (uint8_t)(seed >> 24);
    }
    return rgb;
}

#endif
