/* progressive.h: orders in which every prefix is well spread, so that a level of detail is a
 * count: the first n of a tree's leaves or surface points are a fair sample of all of them
 * (stochastic simplification of aggregate detail: Cook, Halstead, Planck, Ryu, SIGGRAPH 2007). */
#ifndef WD_TREE_PROGRESSIVE_H
#define WD_TREE_PROGRESSIVE_H

#include <stddef.h>
#include <stdint.h>

#include "tree/vec.h"

/* The i-th number of van der Corput's sequence in base 2 with Owen's nested scrambling, as a
 * fraction of 2^32: for every k, each 2^k numbers from a multiple of 2^k on fall one into each of
 * 2^k equal parts. */
uint32_t wd_scrambled_radical(uint32_t index, uint32_t key);

/* order[count]: indices along a Hilbert curve through the points' bounding box, so that
 * neighbours in the order are neighbours in space. Points at one place keep their order. */
void wd_curve_order(uint32_t *order, const struct wd_vec3 *points, size_t count);

/* order[count]: indices so that every prefix is spread over space as evenly as the whole. */
void wd_progressive_order(uint32_t *order, const struct wd_vec3 *points, size_t count,
                          uint32_t key);

#endif
