/* ssim.h: structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004, IEEE Transactions on Image
 * Processing 13 (4)): Gaussian window of 11 pixels, deviation 1.5, K1 0.01, K2 0.03, on luma. */
#ifndef WD_OUTPUT_SSIM_H
#define WD_OUTPUT_SSIM_H

#include <stdint.h>

/* Mean over the picture, 1 for equal ones. 8-bit sRGB, `stride` bytes a pixel (3 or 4). */
double wd_ssim(const uint8_t *a, const uint8_t *b, uint32_t width, uint32_t height,
               uint32_t stride);

#endif
