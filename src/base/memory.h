/* memory.h: allocation that never returns NULL, growable arrays, and an arena.
 *
 * Host memory of the sizes a scene needs is either there or the program cannot go on: these
 * abort with a message that names the size. Sizes that come from outside are checked before, or had from
 * wd_try_array. */
#ifndef WD_BASE_MEMORY_H
#define WD_BASE_MEMORY_H

#include <stddef.h>

void *wd_alloc(size_t size);                 /* zeroed; free() it; size 0 gives a valid pointer */
void *wd_alloc_array(size_t count, size_t element_size); /* zeroed, overflow-checked */
/* As wd_alloc_array, but NULL where there is not so much: for blocks as large as a caller likes. */
void *wd_try_array(size_t count, size_t element_size);
void *wd_realloc(void *block, size_t size);
char *wd_strdup(const char *text);
/* free() it */
char *wd_format(const char *format, ...) __attribute__((format(printf, 1, 2), nonnull(1)));

/* The texts one after another with `between` them; free() it. */
char *wd_join(const char *const *texts, size_t count, const char *between);

/* Grows `*items` so that one more element fits: doubles `*capacity` when count == capacity. */
void *wd_grow(void *items, size_t count, size_t *capacity, size_t element_size);

/* wd_push(items, count, capacity) makes room and yields a pointer to the new, zeroed last item. */
#define wd_push(items, count, capacity)                                                            \
    ((items) = wd_grow((items), (count), &(capacity), sizeof *(items)), &(items)[(count)++])

/* An arena: many small blocks that die together. Embed it, `{0}` is valid and empty. */
struct wd_arena_block;
struct wd_arena {
    struct wd_arena_block *blocks;
    size_t used;
    size_t bytes; /* total handed out, for reports */
};

void *wd_arena_alloc(struct wd_arena *arena, size_t size); /* zeroed, 16-byte aligned */
char *wd_arena_strdup(struct wd_arena *arena, const char *text);
void wd_arena_finish(struct wd_arena *arena);

#endif
