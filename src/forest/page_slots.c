#include "forest/page_slots.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/hash.h"

static bool is_page(const struct wd_page *a, const struct wd_page *b)
{
    return a->layer == b->layer && a->level == b->level && a->column == b->column &&
           a->row == b->row;
}

static uint32_t home_of(const struct wd_pages *pages, const struct wd_page *page)
{
    return wd_hash4(page->layer, page->level, page->column, page->row) & (pages->hash_size - 1);
}

/* Where the page is in the table, or the free place where it would be. */
static uint32_t place_of(const struct wd_pages *pages, const struct wd_page *page)
{
    uint32_t at = home_of(pages, page);
    while (pages->slot_of_hash[at] &&
           !is_page(&pages->slots[pages->slot_of_hash[at] - 1].page, page))
        at = (at + 1) & (pages->hash_size - 1);
    return at;
}

/* Knuth, The Art of Computer Programming 3, 6.4, algorithm R: moves up what the gap would hide. */
static void remove_place(struct wd_pages *pages, uint32_t gap)
{
    uint32_t mask = pages->hash_size - 1;
    for (uint32_t at = (gap + 1) & mask; pages->slot_of_hash[at]; at = (at + 1) & mask) {
        uint32_t home = home_of(pages, &pages->slots[pages->slot_of_hash[at] - 1].page);
        if (((at - home) & mask) < ((at - gap) & mask))
            continue;
        pages->slot_of_hash[gap] = pages->slot_of_hash[at];
        gap = at;
    }
    pages->slot_of_hash[gap] = 0;
}

/* --- order of use ------------------------------------------------------------------------- */

static void unlink_slot(struct wd_pages *pages, uint32_t index)
{
    struct wd_page_slot *slot = &pages->slots[index];
    if (slot->newer == pages->capacity)
        pages->newest = slot->older;
    else
        pages->slots[slot->newer].older = slot->older;
    if (slot->older == pages->capacity)
        pages->oldest = slot->newer;
    else
        pages->slots[slot->older].newer = slot->newer;
}

static void link_newest(struct wd_pages *pages, uint32_t index)
{
    struct wd_page_slot *slot = &pages->slots[index];
    slot->newer = pages->capacity;
    slot->older = pages->newest;
    if (pages->newest == pages->capacity)
        pages->oldest = index;
    else
        pages->slots[pages->newest].newer = index;
    pages->newest = index;
}

/* --- slots -------------------------------------------------------------------------------- */

void wd_page_slots_init(struct wd_pages *pages, uint32_t capacity)
{
    pages->capacity = capacity;
    pages->slots = wd_alloc_array(capacity, sizeof *pages->slots);
    pages->hash_size = 4;
    while (pages->hash_size < 4 * capacity)
        pages->hash_size *= 2;
    pages->slot_of_hash = wd_alloc_array(pages->hash_size, sizeof *pages->slot_of_hash);
    wd_pages_forget(pages);
}

void wd_page_slots_finish(struct wd_pages *pages)
{
    free(pages->slots);
    free(pages->slot_of_hash);
}

void wd_pages_forget(struct wd_pages *pages)
{
    if (!pages->capacity)
        return;
    memset(pages->slot_of_hash, 0, pages->hash_size * sizeof *pages->slot_of_hash);
    pages->newest = pages->oldest = pages->capacity;
    pages->changes++;
    for (uint32_t i = 0; i < pages->capacity; i++) {
        pages->slots[i] = (struct wd_page_slot){0};
        link_newest(pages, i);
    }
}

void wd_page_slots_touch(struct wd_pages *pages, uint32_t slot)
{
    unlink_slot(pages, slot);
    link_newest(pages, slot);
}

int64_t wd_page_slots_find(struct wd_pages *pages, const struct wd_page *page)
{
    uint32_t found = pages->slot_of_hash[place_of(pages, page)];
    if (!found)
        return WD_NO_SLOT;
    wd_page_slots_touch(pages, found - 1);
    return found - 1;
}

uint32_t wd_page_slots_take(struct wd_pages *pages, const struct wd_page *page)
{
    uint32_t index = pages->oldest;
    struct wd_page_slot *slot = &pages->slots[index];
    pages->changes++;
    if (slot->filled)
        remove_place(pages, place_of(pages, &slot->page));
    unlink_slot(pages, index);
    slot->page = *page;
    slot->filled = true;
    link_newest(pages, index);
    pages->slot_of_hash[place_of(pages, page)] = index + 1;
    return index;
}
