#include "base/memory.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *check(void *block, size_t size)
{
    if (block)
        return block;
    fprintf(stderr, "weald: out of memory: %zu bytes could not be had\n", size);
    abort();
}

void *wd_alloc(size_t size)
{
    return check(calloc(1, size ? size : 1), size);
}

void *wd_alloc_array(size_t count, size_t element_size)
{
    if (element_size && count > SIZE_MAX / element_size)
        return check(NULL, SIZE_MAX);
    return wd_alloc(count * element_size);
}

void *wd_try_array(size_t count, size_t element_size)
{
    return count && element_size ? calloc(count, element_size) : calloc(1, 1);
}

void *wd_realloc(void *block, size_t size)
{
    return check(realloc(block, size ? size : 1), size);
}

char *wd_strdup(const char *text)
{
    size_t size = strlen(text) + 1;
    return memcpy(wd_alloc(size), text, size);
}

char *wd_format(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    int length = vsnprintf(NULL, 0, format, args);
    va_end(args);
    char *text = wd_alloc((size_t)length + 1);
    va_start(args, format);
    vsnprintf(text, (size_t)length + 1, format, args);
    va_end(args);
    return text;
}

char *wd_join(const char *const *texts, size_t count, const char *between)
{
    char *joined = wd_strdup("");
    for (size_t i = 0; i < count; i++) {
        char *longer = wd_format("%s%s%s", joined, i ? between : "", texts[i]);
        free(joined);
        joined = longer;
    }
    return joined;
}

void *wd_grow(void *items, size_t count, size_t *capacity, size_t element_size)
{
    if (count == *capacity) {
        *capacity = *capacity ? *capacity * 2 : 16;
        if (*capacity > SIZE_MAX / element_size)
            return check(NULL, SIZE_MAX);
        items = wd_realloc(items, *capacity * element_size);
    }
    memset((char *)items + count * element_size, 0, element_size);
    return items;
}

struct wd_arena_block {
    struct wd_arena_block *next;
    size_t size;
    _Alignas(16) unsigned char data[];
};

void *wd_arena_alloc(struct wd_arena *arena, size_t size)
{
    size = (size + 15) & ~(size_t)15;
    if (!arena->blocks || arena->blocks->size - arena->used < size) {
        size_t block_size = size > 65536 ? size : 65536;
        struct wd_arena_block *block = wd_alloc(sizeof *block + block_size);
        block->size = block_size;
        block->next = arena->blocks;
        arena->blocks = block;
        arena->used = 0;
    }
    void *result = arena->blocks->data + arena->used;
    arena->used += size;
    arena->bytes += size;
    return result;
}

char *wd_arena_strdup(struct wd_arena *arena, const char *text)
{
    size_t size = strlen(text) + 1;
    return memcpy(wd_arena_alloc(arena, size), text, size);
}

void wd_arena_finish(struct wd_arena *arena)
{
    while (arena->blocks) {
        struct wd_arena_block *next = arena->blocks->next;
        free(arena->blocks);
        arena->blocks = next;
    }
    *arena = (struct wd_arena){0};
}
