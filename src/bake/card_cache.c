#include "bake/cards.h"

#include <stdlib.h>
#include <string.h>

#include <xxhash.h>
#include <zstd.h>

#include "base/file.h"
#include "base/memory.h"

/* Raised whenever the same input would bake to something else. */
static const uint32_t BAKE_VERSION = 2;

/* A cache file: a header of little-endian words, then albedo and normal as one zstd frame. */
enum { HEADER_BYTES = 48 };
static const char MAGIC[8] = "wdcards";

static size_t payload_bytes(void)
{
    return 2 * wd_cards_bytes();
}

uint64_t wd_cards_key(const struct wd_tree_model *model, const uint8_t *looks, size_t look_bytes)
{
    const struct wd_tree_mesh *mesh = &model->full;
    const uint32_t form[] = {BAKE_VERSION, WD_CARD_WIDTH, WD_CARD_HEIGHT, WD_CARD_MIPS, WD_CARDS};
    XXH64_state_t *state = XXH64_createState();
    XXH64_reset(state, 0);
    XXH64_update(state, form, sizeof form);
    XXH64_update(state, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices);
    XXH64_update(state, mesh->indices, mesh->index_count * sizeof *mesh->indices);
    XXH64_update(state, looks, look_bytes);
    uint64_t key = XXH64_digest(state);
    XXH64_freeState(state);
    return key;
}

static char *cache_path(const char *cache_dir, uint64_t key)
{
    return wd_format("%s/cards-%016llx.bin", cache_dir, (unsigned long long)key);
}

static void put(uint8_t *at, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        at[i] = (uint8_t)(value >> (8 * i));
}

static uint64_t get(const uint8_t *at, int bytes)
{
    uint64_t value = 0;
    for (int i = 0; i < bytes; i++)
        value |= (uint64_t)at[i] << (8 * i);
    return value;
}

static uint32_t float_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float bits_float(uint64_t value)
{
    uint32_t bits = (uint32_t)value;
    float result;
    memcpy(&result, &bits, sizeof result);
    return result;
}

static bool decode(struct wd_cards *cards, uint64_t key, const uint8_t *file, size_t size)
{
    if (size < HEADER_BYTES || memcmp(file, MAGIC, sizeof MAGIC) != 0 ||
        get(file + 8, 8) != key || get(file + 16, 8) != payload_bytes())
        return false;
    uint8_t *payload = wd_alloc(payload_bytes());
    size_t got = ZSTD_decompress(payload, payload_bytes(), file + HEADER_BYTES, size - HEADER_BYTES);
    bool ok = !ZSTD_isError(got) && got == payload_bytes() &&
              XXH64(payload, payload_bytes(), key) == get(file + 24, 8);
    if (ok) {
        *cards = (struct wd_cards){.albedo = wd_alloc(wd_cards_bytes()),
                                   .normal = wd_alloc(wd_cards_bytes()),
                                   .half_width_m = bits_float(get(file + 32, 4)),
                                   .half_depth_m = bits_float(get(file + 36, 4)),
                                   .bottom_m = bits_float(get(file + 40, 4)),
                                   .top_m = bits_float(get(file + 44, 4))};
        memcpy(cards->albedo, payload, wd_cards_bytes());
        memcpy(cards->normal, payload + wd_cards_bytes(), wd_cards_bytes());
    }
    free(payload);
    return ok;
}

static void ignore_message(void *user, enum wd_log_level level, const char *message)
{
    (void)user;
    (void)level;
    (void)message;
}

bool wd_cards_load(struct wd_cards *cards, const char *cache_dir, uint64_t key)
{
    const struct wd_log quiet = {.sink = ignore_message};
    char *path = cache_path(cache_dir, key), *file = NULL;
    size_t size = 0;
    *cards = (struct wd_cards){0};
    bool ok = wd_file_exists(path) &&
              wd_file_read(path, HEADER_BYTES + ZSTD_compressBound(payload_bytes()), &quiet, &file,
                           &size) &&
              decode(cards, key, (const uint8_t *)file, size);
    free(file);
    free(path);
    return ok;
}

void wd_cards_store(const struct wd_cards *cards, const char *cache_dir, uint64_t key,
                    const struct wd_log *log)
{
    uint8_t *payload = wd_alloc(payload_bytes()), header[HEADER_BYTES] = {0};
    memcpy(payload, cards->albedo, wd_cards_bytes());
    memcpy(payload + wd_cards_bytes(), cards->normal, wd_cards_bytes());
    memcpy(header, MAGIC, sizeof MAGIC);
    put(header + 8, key, 8);
    put(header + 16, payload_bytes(), 8);
    put(header + 24, XXH64(payload, payload_bytes(), key), 8);
    put(header + 32, float_bits(cards->half_width_m), 4);
    put(header + 36, float_bits(cards->half_depth_m), 4);
    put(header + 40, float_bits(cards->bottom_m), 4);
    put(header + 44, float_bits(cards->top_m), 4);
    size_t bound = ZSTD_compressBound(payload_bytes());
    uint8_t *packed = wd_alloc(bound);
    size_t packed_bytes = ZSTD_compress(packed, bound, payload, payload_bytes(), 1);
    char *path = cache_path(cache_dir, key);
    struct wd_output_file file;
    if (!ZSTD_isError(packed_bytes) && wd_make_directories(cache_dir, log) &&
        wd_output_open(&file, path, log)) {
        fwrite(header, 1, sizeof header, file.stream);
        fwrite(packed, 1, packed_bytes, file.stream);
        if (!wd_output_commit(&file, log))
            wd_warn(log, "%s: baked trees are not cached", path);
    }
    free(path);
    free(packed);
    free(payload);
}
