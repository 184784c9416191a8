/* convolve.h: filtering of pictures by products of two one-dimensional kernels. */
#ifndef WD_OUTPUT_CONVOLVE_H
#define WD_OUTPUT_CONVOLVE_H

#include <stddef.h>
#include <stdint.h>

/* `result` = `plane` filtered by `across` along rows and `down` along columns, each 2 radius + 1
 * weights; pixels beyond the edge are those at the edge. `scratch` and `result` hold width * height
 * and are neither `plane` nor each other. */
void wd_convolve(float *result, float *scratch, const float *plane, uint32_t width,
                 uint32_t height, const float *across, const float *down, int radius);

#endif
