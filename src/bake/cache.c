#include "bake/cache.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <xxhash.h>
#include <zstd.h>

#include "base/bytes.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"

#include "code_key.h"

/* A file: little-endian words (magic, key, bytes of the content, its XXH64), then a zstd frame. */
enum { HEADER_BYTES = 32, NAME_TAIL = 21 /* -0123456789abcdef.bin */ };
static const char MAGIC[8] = "weald-1";
static const int COMPRESSION = 1;
/* Temporary files of writers that died. */
static const time_t STALE_S = 3600;

uint64_t wd_cache_code_key(void)
{
    return WD_CODE_KEY;
}

uint64_t wd_cache_key(uint64_t key, const void *data, size_t size)
{
    return XXH64(data, size, key);
}

static bool is_off(const struct wd_bake_cache *cache)
{
    return !cache || !cache->directory || !cache->directory[0];
}

static char *cache_path(const struct wd_bake_cache *cache, const char *kind, uint64_t key)
{
    return wd_format("%s/%s-%016llx.bin", cache->directory, kind, (unsigned long long)key);
}

void wd_cache_put_word(uint8_t *words, size_t at, uint32_t value)
{
    for (size_t i = 0; i < 4; i++)
        words[4 * at + i] = (uint8_t)(value >> (8 * i));
}

uint32_t wd_cache_get_word(const uint8_t *words, size_t at)
{
    uint32_t value = 0;
    for (size_t i = 0; i < 4; i++)
        value |= (uint32_t)words[4 * at + i] << (8 * i);
    return value;
}

/* --- loading ----------------------------------------------------------------------------- */

static void *decode(const uint8_t *file, size_t file_size, uint64_t key, size_t max_size,
                    size_t *size)
{
    if (file_size < HEADER_BYTES || memcmp(file, MAGIC, sizeof MAGIC) != 0 ||
        wd_get_u64(file + 8) != key || wd_get_u64(file + 16) > max_size)
        return NULL;
    size_t expected = (size_t)wd_get_u64(file + 16);
    uint8_t *data = wd_alloc(expected);
    size_t got = ZSTD_decompress(data, expected, file + HEADER_BYTES, file_size - HEADER_BYTES);
    if (ZSTD_isError(got) || got != expected || XXH64(data, got, key) != wd_get_u64(file + 24)) {
        free(data);
        return NULL;
    }
    *size = got;
    return data;
}

void *wd_cache_load(struct wd_bake_cache *cache, const char *kind, uint64_t key, size_t max_size,
                    size_t *size)
{
    *size = 0;
    if (is_off(cache))
        return NULL;
    char *path = cache_path(cache, kind, key), *file = NULL;
    size_t file_size = 0;
    void *data = NULL;
    if (wd_file_exists(path) &&
        wd_file_read(path, HEADER_BYTES + ZSTD_compressBound(max_size), &wd_log_quiet, &file, &file_size))
        data = decode((const uint8_t *)file, file_size, key, max_size, size);
    if (data)
        utimensat(AT_FDCWD, path, NULL, 0); /* used now; a folder that forbids it ages on */
    free(file);
    free(path);
    return data;
}

/* --- keeping the folder small --------------------------------------------------------------- */

struct cache_file {
    char *path;
    time_t used;
    uint64_t bytes;
};

static bool is_cache_name(const char *name)
{
    size_t length = strlen(name);
    const char *tail = length > NAME_TAIL ? name + length - NAME_TAIL : "";
    return tail[0] == '-' && strspn(tail + 1, "0123456789abcdef") == 16 &&
           strcmp(tail + 17, ".bin") == 0;
}

static int older_first(const void *a, const void *b)
{
    time_t x = ((const struct cache_file *)a)->used, y = ((const struct cache_file *)b)->used;
    return x < y ? -1 : x > y;
}

/* The folder's cache files; temporary ones that nobody will finish are removed. */
static struct cache_file *list_files(const char *directory, size_t *count, uint64_t *bytes)
{
    struct cache_file *files = NULL;
    size_t capacity = 0;
    DIR *folder = opendir(directory);
    time_t now = time(NULL);
    *count = 0;
    *bytes = 0;
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        struct stat info;
        if (!is_cache_name(entry->d_name))
            continue;
        char *path = wd_format("%s/%s", directory, entry->d_name);
        if (stat(path, &info) != 0 || !S_ISREG(info.st_mode)) {
            free(path);
        } else if (entry->d_name[0] == '.') {
            if (now - info.st_mtime > STALE_S)
                unlink(path);
            free(path);
        } else {
            *wd_push(files, *count, capacity) =
                (struct cache_file){path, info.st_mtime, (uint64_t)info.st_size};
            *bytes += (uint64_t)info.st_size;
        }
    }
    if (folder)
        closedir(folder);
    return files;
}

static void bound_size(const struct wd_bake_cache *cache)
{
    uint64_t most = cache->max_bytes ? cache->max_bytes : WD_CACHE_BYTES, bytes;
    size_t count;
    struct cache_file *files = list_files(cache->directory, &count, &bytes);
    if (bytes > most)
        qsort(files, count, sizeof *files, older_first);
    for (size_t i = 0; i < count; i++) {
        if (bytes > most && unlink(files[i].path) == 0)
            bytes -= files[i].bytes;
        free(files[i].path);
    }
    free(files);
}

/* --- storing ----------------------------------------------------------------------------- */

static bool write_file(const char *path, const uint8_t *header, const void *packed, size_t size)
{
    struct wd_output_file file;
    if (!wd_output_open(&file, path, &wd_log_quiet))
        return false;
    fwrite(header, 1, HEADER_BYTES, file.stream);
    fwrite(packed, 1, size, file.stream);
    return wd_output_commit(&file, &wd_log_quiet);
}

void wd_cache_store(struct wd_bake_cache *cache, const char *kind, uint64_t key, const void *data,
                    size_t size)
{
    if (is_off(cache))
        return;
    size_t bound = ZSTD_compressBound(size);
    void *packed = wd_alloc(bound);
    size_t packed_bytes = ZSTD_compress(packed, bound, data, size, COMPRESSION);
    uint8_t header[HEADER_BYTES];
    memcpy(header, MAGIC, sizeof MAGIC);
    wd_put_u64(header + 8, key);
    wd_put_u64(header + 16, size);
    wd_put_u64(header + 24, XXH64(data, size, key));
    char *path = cache_path(cache, kind, key);
    bool ok = !ZSTD_isError(packed_bytes) && wd_make_directories(cache->directory, &wd_log_quiet) &&
              write_file(path, header, packed, packed_bytes);
    int error = errno;
    if (ok)
        bound_size(cache);
    else if (!atomic_exchange(&cache->warned, true))
        wd_warn(cache->log, "%s: cannot be written: %s; baked trees are not cached", path,
                strerror(error));
    free(path);
    free(packed);
}
