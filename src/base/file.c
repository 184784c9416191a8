#include "base/file.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <pwd.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"

bool wd_file_read(const char *path, size_t max_size, const struct wd_log *log, char **data,
                  size_t *size)
{
    *data = NULL;
    *size = 0;
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return wd_error(log, "%s: cannot be opened: %s", path, strerror(errno));
    struct stat info;
    char *block = NULL;
    size_t length = 0, capacity = 0;
    if (fstat(fileno(stream), &info) == 0 && S_ISDIR(info.st_mode)) {
        wd_error(log, "%s: is a directory, a file is wanted", path);
        goto fail;
    }
    for (;;) {
        if (length == capacity) {
            capacity = capacity ? capacity * 2 : 65536;
            block = wd_realloc(block, capacity + 1);
        }
        size_t got = fread(block + length, 1, capacity - length, stream);
        length += got;
        if (length > max_size) {
            wd_error(log, "%s: is larger than the %zu bytes allowed here", path, max_size);
            goto fail;
        }
        if (got == 0)
            break;
    }
    if (ferror(stream)) {
        wd_error(log, "%s: cannot be read: %s", path, strerror(errno));
        goto fail;
    }
    fclose(stream);
    block[length] = '\0';
    *data = block;
    *size = length;
    return true;
fail:
    free(block);
    fclose(stream);
    return false;
}

bool wd_has_ending(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

bool wd_file_exists(const char *path)
{
    return access(path, F_OK) == 0;
}

bool wd_file_is_plain(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

bool wd_make_directories(const char *path, const struct wd_log *log)
{
    char *copy = wd_strdup(path);
    bool ok = true;
    for (char *at = copy + 1;; at++) {
        char saved = *at;
        if (saved != '/' && saved != '\0')
            continue;
        *at = '\0';
        if (mkdir(copy, 0777) != 0 && errno != EEXIST) {
            ok = wd_error(log, "%s: directory cannot be made: %s", copy, strerror(errno));
            break;
        }
        *at = saved;
        if (saved == '\0')
            break;
    }
    free(copy);
    return ok;
}

char *wd_path_beside(const char *base_file, const char *name)
{
    const char *slash = base_file ? strrchr(base_file, '/') : NULL;
    if (name[0] == '/' || !slash)
        return wd_strdup(name);
    return wd_format("%.*s%s", (int)(slash + 1 - base_file), base_file, name);
}

char *wd_cache_directory(void)
{
    const char *cache = getenv("XDG_CACHE_HOME");
    if (cache && cache[0] == '/')
        return wd_format("%s/weald", cache);
    const char *home = getenv("HOME");
    char names[16384];
    struct passwd user, *found = NULL;
    if (home && home[0] == '/')
        return wd_format("%s/.cache/weald", home);
    if (getpwuid_r(getuid(), &user, names, sizeof names, &found) == 0 && found && access(user.pw_dir, W_OK) == 0)
        return wd_format("%s/.cache/weald", user.pw_dir);
    return wd_format("/tmp/weald-%ld", (long)getuid()); /* not a name that users share */
}

char *wd_temporary_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    int directory = slash ? (int)(slash + 1 - path) : 0;
    return wd_format("%.*s.%d.%d-%s", directory, path, (int)getpid(), (int)gettid(), path + directory);
}

/* Where symbolic links lead, whether there is a file or not: it is the file there that is replaced. */
static char *target_of(const char *path)
{
    enum { MOST_LINKS = 40 };
    char *target = wd_strdup(path), text[PATH_MAX];
    ssize_t length = 0;
    for (int i = 0; i < MOST_LINKS; i++) {
        length = readlink(target, text, sizeof text - 1);
        if (length <= 0)
            break;
        text[length] = '\0';
        char *next = wd_path_beside(target, text);
        free(target);
        target = next;
    }
    return target;
}

static bool cannot_write(const char *path, const struct wd_log *log)
{
    return wd_error(log, "%s: cannot be written: %s", path, strerror(errno));
}

/* A file that is there keeps its permissions, those against writing, too. */
static bool open_temporary(struct wd_output_file *file, const struct wd_log *log)
{
    struct stat info;
    bool there = stat(file->path, &info) == 0;
    if (there && S_ISDIR(info.st_mode))
        return wd_error(log, "%s: is a directory, cannot be written as a file", file->path);
    if (there && !S_ISREG(info.st_mode))
        return wd_error(log, "%s: is a device, pipe or socket; only plain files are written", file->path);
    if ((!there && errno == ELOOP) || (there && access(file->path, W_OK) != 0))
        return cannot_write(file->path, log);
    file->stream = fopen(file->temporary, "wb");
    return (file->stream && (!there || fchmod(fileno(file->stream), info.st_mode & 07777) == 0)) ||
           cannot_write(file->path, log);
}

bool wd_output_open(struct wd_output_file *file, const char *path, const struct wd_log *log)
{
    char *target = target_of(path);
    *file = (struct wd_output_file){wd_strdup(path), target, wd_temporary_name(target), NULL};
    if (open_temporary(file, log))
        return true;
    wd_output_discard(file);
    return false;
}

bool wd_output_commit(struct wd_output_file *file, const struct wd_log *log)
{
    bool ok = !ferror(file->stream) && fflush(file->stream) == 0;
    int error = errno;
    if (fclose(file->stream) != 0 && ok) {
        ok = false;
        error = errno;
    }
    file->stream = NULL;
    if (ok && rename(file->temporary, file->target) != 0) {
        ok = false;
        error = errno;
    }
    if (!ok)
        wd_error(log, "%s: cannot be written: %s", file->path, strerror(error));
    wd_output_discard(file);
    return ok;
}

void wd_output_discard(struct wd_output_file *file)
{
    if (file->stream)
        fclose(file->stream);
    if (file->temporary)
        unlink(file->temporary); /* after a commit there is nothing under this name */
    free(file->path);
    free(file->target);
    free(file->temporary);
    *file = (struct wd_output_file){0};
}

/* The process that gave a name such as wd_temporary_name's to a temporary of `base`, or 0. */
static pid_t writer_of(const char *name, const char *base)
{
    char *end;
    if (name[0] != '.' || name[1] < '0' || name[1] > '9')
        return 0;
    long process = strtol(name + 1, &end, 10);
    if (*end == '.') /* and its thread */
        end += 1 + strspn(end + 1, "0123456789");
    return *end == '-' && strcmp(end + 1, base) == 0 ? (pid_t)process : 0;
}

void wd_output_sweep(const char *named)
{
    char *path = target_of(named);
    const char *slash = strrchr(path, '/');
    char *folder = slash ? wd_format("%.*s", (int)(slash + 1 - path), path) : wd_strdup(".");
    DIR *stream = opendir(folder);
    for (struct dirent *entry; stream && (entry = readdir(stream));) {
        pid_t process = writer_of(entry->d_name, slash ? slash + 1 : path);
        if (process > 0 && kill(process, 0) != 0 && errno == ESRCH)
            unlinkat(dirfd(stream), entry->d_name, 0);
    }
    if (stream)
        closedir(stream);
    free(folder);
    free(path);
}
