/* cache.h: one cache on disk for all that costs time to make.
 *
 * A file is named by its kind and by a key made from everything its content depends on. It carries
 * the version of what made it, its length and a checksum, and appears whole by renaming: a cut,
 * damaged, outdated or foreign file is a miss, never an error. The folder is kept below a size by
 * dropping what has gone unused longest. */
#ifndef WD_BAKE_CACHE_H
#define WD_BAKE_CACHE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

#define WD_CACHE_BYTES ((uint64_t)2 << 30)

/* {0} is a cache that holds nothing and takes nothing. */
struct wd_bake_cache {
    const char *directory; /* NULL or "": none */
    uint64_t max_bytes;    /* 0: WD_CACHE_BYTES */
    const struct wd_log *log;
    atomic_bool warned;    /* that nothing can be written: once is enough */
};

/* A key: a running hash of byte strings. Begin with wd_cache_code_key(), which changes whenever the
 * sources of growth and baking do: what other code has made is never found. */
uint64_t wd_cache_code_key(void);
uint64_t wd_cache_key(uint64_t key, const void *data, size_t size);

/* Words of blocks, `at` counted in words, alike on any machine. */
void wd_cache_put_word(uint8_t *words, size_t at, uint32_t value);
uint32_t wd_cache_get_word(const uint8_t *words, size_t at);

/* The block stored under `kind` (letters) and `key`, or NULL. At most `max_size` bytes are taken.
 * free() it. Safe to call from several threads and processes. */
void *wd_cache_load(struct wd_bake_cache *cache, const char *kind, uint64_t key,
                    size_t max_size, size_t *size);

/* Failure to write is a warning: the next start makes the thing again. */
void wd_cache_store(struct wd_bake_cache *cache, const char *kind, uint64_t key,
                    const void *data, size_t size);

#endif
