/* Layout, little-endian: 8 bytes "WDTRACE1"; key (8); width, height (4 each); samples of each tile
 * (4 each); sums (4-byte floats, 3 a pixel); xxh64 of all before (8). */
#include "reference/checkpoint.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"

static const char MAGIC[8] = {'W', 'D', 'T', 'R', 'A', 'C', 'E', '1'};
enum { HEAD = 24, HASH = 8 };

static size_t tiles_of(const struct wd_trace_sums *sums)
{
    return (size_t)sums->tile_columns * sums->tile_rows;
}

static size_t size_of(const struct wd_trace_sums *sums)
{
    size_t floats = (size_t)sums->width * sums->height * 3;
    return HEAD + tiles_of(sums) * 4 + floats * 4 + HASH;
}

static void put_head(uint8_t head[HEAD], uint64_t key, const struct wd_trace_sums *sums)
{
    memcpy(head, MAGIC, 8);
    memcpy(head + 8, &key, 8);
    memcpy(head + 16, &sums->width, 4);
    memcpy(head + 20, &sums->height, 4);
}

bool wd_checkpoint_write(const char *path, uint64_t key, const struct wd_trace_sums *sums,
                         const struct wd_log *log)
{
    size_t size = size_of(sums), tiles = tiles_of(sums) * 4;
    uint8_t *data = wd_alloc(size);
    put_head(data, key, sums);
    memcpy(data + HEAD, sums->tile_samples, tiles);
    memcpy(data + HEAD + tiles, sums->radiance, size - HASH - HEAD - tiles);
    uint64_t hash = XXH64(data, size - HASH, 0);
    memcpy(data + size - HASH, &hash, HASH);
    struct wd_output_file file;
    bool ok = wd_output_open(&file, path, log);
    if (ok) {
        fwrite(data, 1, size, file.stream); /* commit checks */
        ok = wd_output_commit(&file, log);
    }
    free(data);
    return ok;
}

static bool take(const uint8_t *data, size_t size, uint64_t key, struct wd_trace_sums *sums,
                 const char *path, const struct wd_log *log)
{
    uint8_t head[HEAD];
    uint64_t hash;
    put_head(head, key, sums);
    if (size < HEAD + HASH || memcmp(data, MAGIC, sizeof MAGIC) != 0)
        return wd_error(log, "%s: is not an unfinished picture; remove it to begin anew", path);
    if (size != size_of(sums) || memcmp(data, head, HEAD) != 0)
        return wd_error(log,
                        "%s: holds an unfinished picture of another scene, camera, light or size; "
                        "remove it to begin anew",
                        path);
    memcpy(&hash, data + size - HASH, HASH);
    if (XXH64(data, size - HASH, 0) != hash)
        return wd_error(log, "%s: is damaged; remove it to begin anew", path);
    size_t tiles = tiles_of(sums) * 4;
    memcpy(sums->tile_samples, data + HEAD, tiles);
    memcpy(sums->radiance, data + HEAD + tiles, size - HASH - HEAD - tiles);
    return true;
}

bool wd_checkpoint_read(const char *path, uint64_t key, struct wd_trace_sums *sums,
                        const struct wd_log *log)
{
    char *data;
    size_t size;
    if (!wd_file_read(path, (size_t)1 << 33, log, &data, &size))
        return false;
    bool ok = take((const uint8_t *)data, size, key, sums, path, log);
    free(data);
    return ok;
}
