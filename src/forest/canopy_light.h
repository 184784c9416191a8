/* canopy_light.h: how much of the sky's light comes down to the ground, past crowns and hills. */
#ifndef WD_FOREST_CANOPY_LIGHT_H
#define WD_FOREST_CANOPY_LIGHT_H

#include "gpu/memory.h"
#include "shared/forest.h"
#include "tree/grow.h"
#include "world/world.h"

/* The field on the CPU: for each cell, of the light that an even sky sends to level ground from the
 * east, north, west and south, the share that arrives, and the same of upright surfaces there that look that way, of
 * light from above 30 degrees and from below; and between which heights over the ground the leaves are that stop the
 * rest. Herbs stop nothing of that: they are told apart. */
struct wd_canopy_field {
    float (*quarters)[4]; /* width * height, rows from the south */
    float (*high)[4];     /* parallel: of upright surfaces, */
    float (*low)[4];      /* and of the low sky */
    float (*layer_m)[2];  /* parallel: base and top; both 0 where no trees are */
    float (*herbs)[2];    /* parallel: layers of plants below WD_HERB_M, no swards, and their height */
    uint32_t width, height;
    double cell_m;
    double from_m[2]; /* of the south-western corner, in the world's own coordinates */
};

struct wd_canopy_field_params {
    const struct wd_world *world;
    const struct wd_model *models; /* [species * variants + variant] */
    const struct wd_tree_model *grown; /* parallel */
    uint32_t variants;
    unsigned threads;
};

/* The same for any number of threads. */
void wd_canopy_field_init(struct wd_canopy_field *field,
                          const struct wd_canopy_field_params *params);
void wd_canopy_field_finish(struct wd_canopy_field *field);

/* Four layers of R8G8B8A8_UNORM; x runs east, y north over the field's cells. The first holds square
 * roots of the shares of level ground; the second those of base and top over WD_CANOPY_MOST_M, of herbs' layers over
 * WD_HERBS_MOST and of their height over WD_HERB_M; the others those of the shares of upright surfaces,
 * of the sky above 30 degrees and below. (Local metres - from) * `scale` are its coordinates; no side is a power of two,
 * for which llvmpipe compiles all shaders that look it up anew. */
bool wd_canopy_light_upload(struct wd_image *image, float scale[2], struct wd_gpu *gpu,
                            const struct wd_canopy_field *field);

#endif
