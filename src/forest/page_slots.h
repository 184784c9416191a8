/* page_slots.h: which page is in which slot, and which was used longest ago. */
#ifndef WD_FOREST_PAGE_SLOTS_H
#define WD_FOREST_PAGE_SLOTS_H

#include "forest/pages.h"

enum { WD_NO_SLOT = -1 };

void wd_page_slots_init(struct wd_pages *pages, uint32_t capacity);
void wd_page_slots_finish(struct wd_pages *pages);

/* The slot that holds the page, now the newest; WD_NO_SLOT: none does. */
int64_t wd_page_slots_find(struct wd_pages *pages, const struct wd_page *page);
/* Makes a slot the newest. */
void wd_page_slots_touch(struct wd_pages *pages, uint32_t slot);
/* Gives the page, which no slot holds, the slot that was used longest ago. */
uint32_t wd_page_slots_take(struct wd_pages *pages, const struct wd_page *page);

#endif
