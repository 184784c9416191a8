/* Layout, little-endian: 8 bytes "WDTRACE1"; key (8); width, height (4 each); samples of each tile
 * (4 each); sums (4-byte floats, 3 a pixel); xxh64 of all before (8). Written and read piece by piece: a
 * large picture's sums need not be held twice. */
#include "reference/checkpoint.h"

#include <errno.h>
#include <string.h>
#include <xxhash.h>

#include "base/file.h"
#include "base/log.h"

static const char MAGIC[8] = {'W', 'D', 'T', 'R', 'A', 'C', 'E', '1'};
enum { HEAD = 24 };

static size_t samples_bytes(const struct wd_trace_sums *sums)
{
    return (size_t)sums->tile_columns * sums->tile_rows * sizeof *sums->tile_samples;
}

static size_t radiance_bytes(const struct wd_trace_sums *sums)
{
    return (size_t)sums->width * sums->height * 3 * sizeof *sums->radiance;
}

static void put_head(uint8_t head[HEAD], uint64_t key, const struct wd_trace_sums *sums)
{
    memcpy(head, MAGIC, 8);
    memcpy(head + 8, &key, 8);
    memcpy(head + 16, &sums->width, 4);
    memcpy(head + 20, &sums->height, 4);
}

/* A file, and the hash of what has passed. */
struct stream {
    FILE *file;
    XXH64_state_t *hash;
};

static bool stream_init(struct stream *stream, FILE *file, const char *path, const struct wd_log *log)
{
    *stream = (struct stream){file, XXH64_createState()};
    return (stream->hash && XXH64_reset(stream->hash, 0) == XXH_OK) ||
           wd_error(log, "%s: out of memory", path);
}

static void put(struct stream *stream, const void *data, size_t size)
{
    fwrite(data, 1, size, stream->file); /* commit checks */
    XXH64_update(stream->hash, data, size);
}

static bool get(struct stream *stream, void *data, size_t size)
{
    return fread(data, 1, size, stream->file) == size && XXH64_update(stream->hash, data, size) == XXH_OK;
}

bool wd_checkpoint_write(const char *path, uint64_t key, const struct wd_trace_sums *sums,
                         const struct wd_log *log)
{
    uint8_t head[HEAD];
    struct wd_output_file file;
    struct stream stream;
    put_head(head, key, sums);
    if (!wd_output_open(&file, path, log))
        return false;
    bool ok = stream_init(&stream, file.stream, path, log);
    if (ok) {
        put(&stream, head, HEAD);
        put(&stream, sums->tile_samples, samples_bytes(sums));
        put(&stream, sums->radiance, radiance_bytes(sums));
        const uint64_t hash = XXH64_digest(stream.hash);
        put(&stream, &hash, sizeof hash);
        ok = wd_output_commit(&file, log);
    }
    wd_output_discard(&file);
    XXH64_freeState(stream.hash);
    return ok;
}

/* What stands after the head. */
static bool get_sums(struct stream *stream, struct wd_trace_sums *sums)
{
    uint64_t hash;
    if (!get(stream, sums->tile_samples, samples_bytes(sums)) ||
        !get(stream, sums->radiance, radiance_bytes(sums)))
        return false;
    const uint64_t found = XXH64_digest(stream->hash);
    return get(stream, &hash, sizeof hash) && hash == found && fgetc(stream->file) == EOF;
}

static bool take(struct stream *stream, uint64_t key, struct wd_trace_sums *sums, const char *path,
                 const struct wd_log *log)
{
    uint8_t head[HEAD], wanted[HEAD];
    put_head(wanted, key, sums);
    if (!get(stream, head, HEAD) || memcmp(head, MAGIC, sizeof MAGIC) != 0)
        return wd_error(log, "%s: is not an unfinished picture; remove it to begin anew", path);
    if (memcmp(head, wanted, HEAD) != 0)
        return wd_error(log,
                        "%s: holds an unfinished picture of another scene, camera, light or size; "
                        "remove it to begin anew",
                        path);
    return get_sums(stream, sums) || wd_error(log, "%s: is damaged; remove it to begin anew", path);
}

bool wd_checkpoint_read(const char *path, uint64_t key, struct wd_trace_sums *sums,
                        const struct wd_log *log)
{
    struct stream stream;
    FILE *file = fopen(path, "rb");
    if (!file)
        return wd_error(log, "%s: cannot be opened: %s", path, strerror(errno));
    bool ok = stream_init(&stream, file, path, log) && take(&stream, key, sums, path, log);
    XXH64_freeState(stream.hash);
    fclose(file);
    return ok;
}
