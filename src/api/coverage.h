/* coverage.h: which trees a pixel's samples show, and how many of them each. */
#ifndef WD_API_COVERAGE_H
#define WD_API_COVERAGE_H

#include "weald/renderer.h"

struct wd_coverage {
    size_t pixels;
    uint32_t *first; /* of each pixel: 1 + index of its first entry; 0: none */
    struct wd_coverage_entry {
        uint32_t tree, samples, next; /* next as first */
    } *entries;
    size_t count, capacity;
};

/* False where there is no memory for so many pixels: then it is {0}. */
bool wd_coverage_init(struct wd_coverage *coverage, size_t pixels);
void wd_coverage_finish(struct wd_coverage *coverage); /* accepts {0} */

/* One sample of a pixel shows this tree; 0: none. */
void wd_coverage_add(struct wd_coverage *coverage, size_t pixel, uint32_t tree);

/* Fills picture->rank_tree and rank_share, which are there and zero, from `samples` samples. */
void wd_coverage_rank(const struct wd_coverage *coverage, uint32_t samples,
                      struct wd_picture *picture);

#endif
