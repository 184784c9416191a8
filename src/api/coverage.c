#include "api/coverage.h"

#include <stdlib.h>

#include "base/memory.h"

bool wd_coverage_init(struct wd_coverage *coverage, size_t pixels)
{
    uint32_t *first = wd_try_array(pixels, sizeof *first);
    *coverage = first ? (struct wd_coverage){.pixels = pixels, .first = first}
                      : (struct wd_coverage){0};
    return first != NULL;
}

void wd_coverage_finish(struct wd_coverage *coverage)
{
    free(coverage->first);
    free(coverage->entries);
    *coverage = (struct wd_coverage){0};
}

void wd_coverage_add(struct wd_coverage *coverage, size_t pixel, uint32_t tree)
{
    if (tree == 0)
        return;
    for (uint32_t at = coverage->first[pixel]; at; at = coverage->entries[at - 1].next) {
        if (coverage->entries[at - 1].tree == tree) {
            coverage->entries[at - 1].samples++;
            return;
        }
    }
    struct wd_coverage_entry *entry = wd_push(coverage->entries, coverage->count, coverage->capacity);
    *entry = (struct wd_coverage_entry){tree, 1, coverage->first[pixel]};
    coverage->first[pixel] = (uint32_t)coverage->count;
}

static bool stands_before(const struct wd_coverage_entry *a, const struct wd_coverage_entry *b)
{
    return a->samples > b->samples || (a->samples == b->samples && a->tree < b->tree);
}

/* The pixel's entries of most samples, at most WD_RANKS. */
static size_t best_of(const struct wd_coverage *coverage, size_t pixel,
                      const struct wd_coverage_entry *best[WD_RANKS])
{
    size_t count = 0;
    for (uint32_t at = coverage->first[pixel]; at; at = coverage->entries[at - 1].next) {
        const struct wd_coverage_entry *entry = &coverage->entries[at - 1];
        size_t place = count;
        while (place > 0 && stands_before(entry, best[place - 1]))
            place--;
        if (place == WD_RANKS)
            continue;
        count += count < WD_RANKS;
        for (size_t i = count - 1; i > place; i--)
            best[i] = best[i - 1];
        best[place] = entry;
    }
    return count;
}

void wd_coverage_rank(const struct wd_coverage *coverage, uint32_t samples,
                      struct wd_picture *picture)
{
    for (size_t i = 0; i < coverage->pixels; i++) {
        const struct wd_coverage_entry *best[WD_RANKS];
        size_t count = best_of(coverage, i, best);
        for (size_t k = 0; k < count; k++) {
            picture->rank_tree[i * WD_RANKS + k] = best[k]->tree;
            picture->rank_share[i * WD_RANKS + k] = (float)best[k]->samples / (float)samples;
        }
    }
}
