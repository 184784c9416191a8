/* place_layer.h: what ground.h and placement.h are told of the ground and of a layer of trees, as C
 * and as GLSL: a shader's buffers hold these, so they stand apart from the functions. */
#ifndef WD_SHARED_PLACE_LAYER_H
#define WD_SHARED_PLACE_LAYER_H

#include "shared/types.h"

#ifdef __STDC_VERSION__
#define WD_STRUCT struct
#else
#define WD_STRUCT
#endif

/* How a coordinate in millimetres becomes cells: cells = mm * inverse / 2^(32 + shift). The inverse
 * is rounded up, so that a sample's own place falls into the cell that begins there. */
struct wd_axis {
    uint32_t inverse, shift; /* shift at most 31 */
};

struct wd_place_ground {
    int32_t extent_mm[2];    /* east, north; the ground is where 0 <= x, y <= extent */
    uint32_t width, height;  /* samples, at least 2 each; row 0 in the south */
    WD_STRUCT wd_axis axis;  /* cells of the grid */
    float half_per_m;        /* 1 / (2 * cell in metres) */
    uint32_t has_holes;
};

#define WD_PLACE_MAP_NONE 0u
#define WD_PLACE_MAP_NEAREST 1u
#define WD_PLACE_MAP_LINEAR 2u

/* A soft edge: 0 at `from`, 1 where (value - from) * scale >= 1. A negative scale falls. */
struct wd_ramp {
    float from, scale;
};

struct wd_place_layer {
    uint32_t key;              /* hash of the world's seed and the layer's index */
    uint32_t columns, rows;    /* cells over the ground, from its south-west corner */
    uint32_t cell_mm;
    int32_t extent_mm[2];      /* of the ground */
    uint32_t jitter;           /* share of the (sub-)cell, 2^31 is all of it */
    uint32_t count_first, count_size; /* in the table: a cell has as many trees as there are
                                         thresholds <= its hash, ascending */
    uint32_t pick_first, pick_size;   /* in the table: WD_PLACE_PICK_WORDS a species */
    uint32_t height_min_cm, height_span_cm;     /* span counts both ends */
    uint32_t aspect_min, aspect_span;           /* in 1/1024 */
    uint32_t tint;             /* greatest step from neutral, 0..127 */
    uint32_t turn;             /* yaw of all in 1/65536 turns; from 65536: each its own */
    uint32_t variants;
    uint32_t map_kind, map_width, map_height;
    WD_STRUCT wd_axis map_axis[2];
    uint32_t map_half_mm[2];   /* half a cell, for the linear kind */
    uint32_t has_slope, has_altitude, has_patches, has_water;
    WD_STRUCT wd_ramp slope[2];                 /* of rise over run, squared */
    WD_STRUCT wd_ramp altitude[2];              /* of metres */
    float patchiness;
    WD_STRUCT wd_axis patch_axis[2];            /* groves, and half their size */
    float water_m;
};

/* One species of a layer in the table. */
#define WD_PLACE_PICK_WORDS 6u
#define WD_PICK_THRESHOLD 0u /* picked where the hash is below; not read of the last species */
#define WD_PICK_SPECIES 1u
#define WD_PICK_CROWN 2u     /* where its crown table begins: crown diameter in quarters of a cm */
#define WD_PICK_CROWN_SIZE 3u
#define WD_PICK_LOW_CM 4u    /* heights that its variants stand for, from the first variant's */
#define WD_PICK_SPAN_CM 5u   /* to the last one's; 0: all for any height */
#define WD_CROWN_STEP_CM 32u /* tree height from one entry of a crown table to the next */

#endif
