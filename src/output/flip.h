/* flip.h: how different two pictures look when one is flipped to the other: FLIP (Andersson,
 * Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: a difference evaluator for
 * alternating images", Proc. ACM CGIT 3 (2)). */
#ifndef WD_OUTPUT_FLIP_H
#define WD_OUTPUT_FLIP_H

#include <stdint.h>

/* Pixels a degree of the paper's viewer: 0.7 m from a screen 0.7 m and 3840 pixels wide. */
#define WD_FLIP_PIXELS_PER_DEGREE 67.0206432765823f

/* Fills `error` (width * height) with 0 no .. 1 the greatest difference and returns its mean. Both
 * pictures are 8-bit sRGB, `stride` bytes a pixel (3 or 4), rows from the top. */
double wd_flip(float *error, const uint8_t *reference, const uint8_t *test, uint32_t width,
               uint32_t height, uint32_t stride, float pixels_per_degree);

#endif
