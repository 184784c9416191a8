/* imported.h: files of models in a folder of the test's own, and what becomes of them. */
#ifndef IMPORTED_H
#define IMPORTED_H

#include "tree_test.h"

#include <dirent.h>
#include <unistd.h>

#include "base/memory.h"
#include "tree/import.h"

static char folder[] = "/tmp/weald-import-XXXXXX";

static inline char *path_of(const char *name)
{
    return wd_format("%s/%s", folder, name);
}

static inline void write_file(const char *name, const void *bytes, size_t size)
{
    char *path = path_of(name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    free(path);
}

static inline void write_text(const char *name, const char *text)
{
    write_file(name, text, strlen(text));
}

/* All messages, one after the other. */
struct record {
    struct wd_log log;
    char text[8192];
};

static inline void keep(void *user, enum wd_log_level level, const char *message)
{
    struct record *record = user;
    size_t used = strlen(record->text);
    (void)level;
    snprintf(record->text + used, sizeof record->text - used, "%s\n", message);
}

struct result {
    struct wd_arena arena;
    struct wd_species species;
    struct wd_tree_import import;
    struct record record;
    bool ok;
};

/* Imports a file of the folder: a model, or a species file that names one. */
static inline struct result *import(const char *name)
{
    struct result *result = calloc(1, sizeof *result);
    char *path = path_of(name);
    result->record.log = (struct wd_log){keep, &result->record};
    result->ok =
        wd_species_load(&result->species, path, &result->arena, &result->record.log) &&
        wd_tree_import(&result->import, &result->species, &result->record.log);
    free(path);
    return result;
}

static inline void drop(struct result *result)
{
    wd_tree_import_finish(&result->import);
    wd_arena_finish(&result->arena);
    free(result);
}

static inline void expect_message(const struct result *result, const char *part)
{
    if (!strstr(result->record.text, part))
        fail_msg("no \"%s\" in:\n%s", part, result->record.text);
}

/* A trunk of 20 x 300 x 20 about x = 500, and a leaf beside its top that hangs to -10. */
#define TRUNK                                                                                      \
    "v 490 0 -10\nv 510 0 -10\nv 510 0 10\nv 490 0 10\n"                                           \
    "v 490 300 -10\nv 510 300 -10\nv 510 300 10\nv 490 300 10\n"                                   \
    "usemtl Bark\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
#define LEAF "v 510 310 0\nv 600 300 0\nv 600 -10 0\nv 510 300 0\nusemtl Blatt\nf 9 10 11 12\n"
#define LIBRARY "newmtl Bark\nKd 0.3 0.2 0.1\nnewmtl Blatt\nKd 0.1 0.4 0.1\n"

static inline int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) == NULL;
}

static inline int remove_folder(void **state)
{
    (void)state;
    DIR *list = opendir(folder);
    for (struct dirent *entry; list && (entry = readdir(list));) {
        char *path = path_of(entry->d_name);
        if (entry->d_name[0] != '.')
            unlink(path);
        free(path);
    }
    closedir(list);
    return rmdir(folder);
}

#endif
