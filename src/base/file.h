/* file.h: whole files in, whole files out. */
#ifndef WD_BASE_FILE_H
#define WD_BASE_FILE_H

#include <stdio.h>

#include "weald/types.h"

/* Reads a file into a fresh block with a NUL after its end (not counted in *size). Refuses
 * directories and anything over `max_size` bytes with a message. free() the block. */
bool wd_file_read(const char *path, size_t max_size, const struct wd_log *log, char **data,
                  size_t *size);

bool wd_file_exists(const char *path);
/* Whether it is a file proper: no folder, and no pipe or device, which would be read without end. */
bool wd_file_is_plain(const char *path);

/* Whether a name ends in `ending` (".png"), in upper or lower case, with something before it. */
bool wd_has_ending(const char *path, const char *ending);

/* Makes `path` and its parents. An existing directory is fine. */
bool wd_make_directories(const char *path, const struct wd_log *log);

/* `name` as seen from the directory of `base_file` ("" or NULL: the working directory);
 * absolute names stay. free() it. */
char *wd_path_beside(const char *base_file, const char *name);

/* Directory for cached bakes: $XDG_CACHE_HOME/weald or ~/.cache/weald; without a home that can be written to
 * /tmp/weald-UID. free() it. */
char *wd_cache_directory(void);

/* An output that appears whole or not at all: written beside `target` under a temporary name,
 * renamed by commit. `{0}` is closed. */
struct wd_output_file {
    char *path;      /* as it was named */
    char *target;    /* where symbolic links lead from there: they stay */
    char *temporary;
    FILE *stream;
};

/* A file that is there keeps its permissions; one that may not be written is an error. */
bool wd_output_open(struct wd_output_file *file, const char *path, const struct wd_log *log);
/* Flushes, checks every earlier write, renames. On failure the old file at `path` is untouched. */
bool wd_output_commit(struct wd_output_file *file, const struct wd_log *log);
/* Drops the temporary file. Accepts a committed file and `{0}`. */
void wd_output_discard(struct wd_output_file *file);

/* Removes what processes that were killed have left of an output under temporary names. */
void wd_output_sweep(const char *named);

/* A fresh temporary name beside `path` (same directory and extension) for writers that insist on
 * opening by name; each thread has its own. free() it. */
char *wd_temporary_name(const char *path);

#endif
