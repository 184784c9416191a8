/* Layout, little-endian: "WDFILM01", key (8 bytes); then of each frame the bytes of its zstd frame
 * (8), their XXH64 with key + number as seed (8), and they themselves. */
#include "output/film_store.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <zstd.h>

#include "base/bytes.h"
#include "base/log.h"
#include "base/memory.h"

static const char MAGIC[8] = {'W', 'D', 'F', 'I', 'L', 'M', '0', '1'};
enum { HEAD = 16, FRAME_HEAD = 16, LEVEL = 1 };

static bool cannot(const struct wd_film_store *store, const struct wd_log *log)
{
    return wd_error(log, "%s: finished frames cannot be kept: %s", store->path, strerror(errno));
}

/* --- the file ---------------------------------------------------------------------------- */

/* Drops all from here on. */
static bool cut(struct wd_film_store *store)
{
    off_t at = ftello(store->stream);
    store->adding = true;
    clearerr(store->stream);
    return at >= 0 && ftruncate(fileno(store->stream), at) == 0 &&
           fseeko(store->stream, at, SEEK_SET) == 0;
}

/* A head that is there must be ours; one cut short is written anew. */
static bool check_head(struct wd_film_store *store, uint64_t key, const struct wd_log *log)
{
    uint8_t head[HEAD], found[HEAD];
    memcpy(head, MAGIC, 8);
    wd_put_u64(head + 8, key);
    size_t got = fread(found, 1, HEAD, store->stream);
    if (memcmp(found, MAGIC, got < 8 ? got : 8) != 0)
        return wd_error(log, "%s: is no unfinished film; remove it to begin anew", store->path);
    if (got == HEAD && memcmp(found, head, HEAD) != 0)
        return wd_error(log,
                        "%s: holds frames of another scene, camera, option, device or version of "
                        "weald; remove it to begin anew", store->path);
    if (got == HEAD)
        return true;
    rewind(store->stream);
    return (cut(store) && fwrite(head, 1, HEAD, store->stream) == HEAD) || cannot(store, log);
}

bool wd_film_store_open(struct wd_film_store *store, const char *path, uint64_t key,
                        const struct wd_log *log)
{
    *store = (struct wd_film_store){.path = wd_strdup(path), .key = key};
    int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    bool locked = file >= 0 && (flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK);
    if (locked)
        store->stream = fdopen(file, "r+b");
    if (store->stream)
        setvbuf(store->stream, NULL, _IONBF, 0); /* what failed to be written is not tried again */
    bool ok = store->stream && check_head(store, key, log);
    if (file >= 0 && !locked)
        wd_error(log, "%s: another process is at work on this film", path);
    else if (!store->stream)
        cannot(store, log);
    if (ok)
        return true;
    if (store->stream)
        fclose(store->stream);
    else if (file >= 0)
        close(file);
    free(store->path);
    *store = (struct wd_film_store){0};
    return false;
}

void wd_film_store_remove(struct wd_film_store *store)
{
    if (store->stream) {
        unlink(store->path); /* before others may lock it */
        fclose(store->stream);
    }
    free(store->path);
    *store = (struct wd_film_store){0};
}

void wd_film_store_close(struct wd_film_store *store)
{
    struct stat info;
    if (store->stream && fstat(fileno(store->stream), &info) == 0 && info.st_size <= HEAD) {
        wd_film_store_remove(store);
        return;
    }
    if (store->stream)
        fclose(store->stream);
    free(store->path);
    *store = (struct wd_film_store){0};
}

/* --- frames ------------------------------------------------------------------------------ */

static bool read_frame(struct wd_film_store *store, void *frame, size_t size)
{
    uint8_t head[FRAME_HEAD];
    if (fread(head, 1, FRAME_HEAD, store->stream) != FRAME_HEAD)
        return false;
    uint64_t packed = wd_get_u64(head);
    if (packed > ZSTD_compressBound(size))
        return false;
    uint8_t *bytes = wd_alloc(packed);
    bool ok = fread(bytes, 1, packed, store->stream) == packed &&
              XXH64(bytes, packed, store->key + store->frames) == wd_get_u64(head + 8) &&
              ZSTD_decompress(frame, size, bytes, packed) == size;
    free(bytes);
    return ok;
}

bool wd_film_store_read(struct wd_film_store *store, void *frame, size_t size)
{
    if (store->adding)
        return false;
    off_t at = ftello(store->stream);
    if (read_frame(store, frame, size)) {
        store->frames++;
        store->before = at;
        return true;
    }
    fseeko(store->stream, at, SEEK_SET);
    cut(store);
    return false;
}

void wd_film_store_unread(struct wd_film_store *store)
{
    fseeko(store->stream, store->before, SEEK_SET);
    store->frames--;
    cut(store);
}

bool wd_film_store_add(struct wd_film_store *store, const void *frame, size_t size,
                       const struct wd_log *log)
{
    if (!store->adding && !cut(store))
        return cannot(store, log);
    off_t at = ftello(store->stream);
    size_t room = ZSTD_compressBound(size);
    uint8_t head[FRAME_HEAD], *bytes = wd_alloc(room);
    size_t packed = ZSTD_compress(bytes, room, frame, size, LEVEL);
    wd_put_u64(head, packed);
    wd_put_u64(head + 8, XXH64(bytes, packed, store->key + store->frames));
    bool ok = fwrite(head, 1, FRAME_HEAD, store->stream) == FRAME_HEAD &&
              fwrite(bytes, 1, packed, store->stream) == packed;
    int error = errno;
    free(bytes);
    if (ok) {
        store->frames++;
        return true;
    }
    clearerr(store->stream);
    fseeko(store->stream, at, SEEK_SET);
    cut(store);
    errno = error;
    return cannot(store, log);
}
