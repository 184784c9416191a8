/* grid.h: where between a row of samples, at least two, a place lies. */
#ifndef WD_SHARED_GRID_H
#define WD_SHARED_GRID_H

#include "shared/vec.h"

/* A place so many cells from the first sample, kept between the first and the last. */
WD_FUNC float wd_grid_along(float cells, uint32_t samples)
{
    return WD_CLAMP(cells, 0.0f, WD_FLOAT(samples - 1u));
}

/* The sample before it, which is never the last: by whole numbers, as fractions of large ones round. */
WD_FUNC uint32_t wd_grid_cell(float along, uint32_t samples)
{
    uint32_t cell = WD_UINT(along);
    return cell < samples - 2u ? cell : samples - 2u;
}

#endif
