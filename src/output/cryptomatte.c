#include "output/cryptomatte.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static uint32_t turned(uint32_t value, int bits)
{
    return value << bits | value >> (32 - bits);
}

static uint32_t stirred(uint32_t block)
{
    return turned(block * 0xcc9e2d51u, 15) * 0x1b873593u;
}

uint32_t wd_murmur3(const void *data, size_t size)
{
    const uint8_t *bytes = data;
    uint32_t hash = 0, tail = 0;
    size_t whole = size / 4 * 4;
    for (size_t i = 0; i < whole; i += 4) {
        uint32_t block = (uint32_t)bytes[i] | (uint32_t)bytes[i + 1] << 8 |
                         (uint32_t)bytes[i + 2] << 16 | (uint32_t)bytes[i + 3] << 24;
        hash = turned(hash ^ stirred(block), 13) * 5 + 0xe6546b64u;
    }
    for (size_t i = size; i > whole; i--)
        tail = tail << 8 | bytes[i - 1];
    hash ^= stirred(tail) ^ (uint32_t)size;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

uint32_t wd_cryptomatte_id(const char *name)
{
    uint32_t hash = wd_murmur3(name, strlen(name));
    uint32_t exponent = hash >> 23 & 255u;
    if (exponent == 0 || exponent == 255)
        hash ^= 1u << 23;
    return hash;
}

enum { NAME_SIZE = 32 };

static void name_of(const struct wd_cryptomatte_tree *tree, char name[NAME_SIZE])
{
    int length = snprintf(name, NAME_SIZE, "tree_%u", tree->tree);
    for (uint32_t i = 0; i < tree->tries && length < NAME_SIZE - 1; i++)
        name[length++] = '_';
    name[length] = 0;
}

static int by_id(const void *a, const void *b)
{
    const struct wd_cryptomatte_tree *x = a, *y = b;
    return x->tree < y->tree ? -1 : x->tree > y->tree;
}

static int by_bits(const void *a, const void *b)
{
    const struct wd_cryptomatte_tree *x = a, *y = b;
    return x->bits < y->bits ? -1 : x->bits > y->bits ? 1 : by_id(a, b);
}

static void set_bits(struct wd_cryptomatte_tree *tree)
{
    char name[NAME_SIZE];
    name_of(tree, name);
    tree->bits = wd_cryptomatte_id(name);
}

/* Among equal floats the least id keeps its name. */
static bool part_equals(struct wd_cryptomatte *matte)
{
    bool parted = false;
    qsort(matte->trees, matte->count, sizeof *matte->trees, by_bits);
    for (size_t i = matte->count; i-- > 1;) {
        struct wd_cryptomatte_tree *tree = &matte->trees[i];
        if (tree->bits != tree[-1].bits)
            continue;
        tree->tries++;
        set_bits(tree);
        parted = true;
    }
    return parted;
}

static int compare_ids(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

void wd_cryptomatte_init(struct wd_cryptomatte *matte, const uint32_t *ids, size_t count)
{
    *matte = (struct wd_cryptomatte){0};
    uint32_t *sorted = wd_alloc_array(count + 1, sizeof *sorted);
    memcpy(sorted, ids, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, compare_ids);
    size_t capacity = 0;
    for (size_t i = 0; i < count; i++) {
        if (sorted[i] == 0 || (i > 0 && sorted[i] == sorted[i - 1]))
            continue;
        struct wd_cryptomatte_tree *tree = wd_push(matte->trees, matte->count, capacity);
        tree->tree = sorted[i];
        set_bits(tree);
    }
    free(sorted);
    while (matte->count && part_equals(matte))
        ;
    if (matte->count)
        qsort(matte->trees, matte->count, sizeof *matte->trees, by_id);
}

void wd_cryptomatte_finish(struct wd_cryptomatte *matte)
{
    free(matte->trees);
    *matte = (struct wd_cryptomatte){0};
}

float wd_cryptomatte_find(const struct wd_cryptomatte *matte, uint32_t id)
{
    const struct wd_cryptomatte_tree wanted = {.tree = id};
    const struct wd_cryptomatte_tree *found =
        id && matte->count ? bsearch(&wanted, matte->trees, matte->count, sizeof wanted, by_id) : NULL;
    float value = 0.0f;
    if (found)
        memcpy(&value, &found->bits, sizeof value);
    return value;
}

char *wd_cryptomatte_manifest(const struct wd_cryptomatte *matte)
{
    char *text = NULL, name[NAME_SIZE];
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        abort();
    putc('{', stream);
    for (size_t i = 0; i < matte->count; i++) {
        name_of(&matte->trees[i], name);
        fprintf(stream, "%s\"%s\":\"%08x\"", i ? "," : "", name, matte->trees[i].bits);
    }
    putc('}', stream);
    fclose(stream);
    return text;
}
