/* splats.h: a tree's surface as discs of equal area, in progressive order. */
#ifndef WD_BAKE_SPLATS_H
#define WD_BAKE_SPLATS_H

#include "shared/continuum.h"
#include "tree/grow.h"

/* WD_SPLATS discs, stratum after stratum from the top of the crown down. Within a stratum any run of
 * them, taken round its end, is a fair sample by area: they keep the order of struct
 * wd_tree_points. */
struct wd_splats {
    struct wd_splat *splats;
    uint32_t *looks; /* parallel; see WD_SPLAT_WOOD */
    struct wd_splat_model model;
};

/* Samples the full mesh of `model`. `looks`: its look textures as in struct wd_point_look. Deterministic. */
void wd_splats_init(struct wd_splats *splats, const struct wd_tree_model *model,
                    const uint8_t *looks, uint32_t size);
void wd_splats_finish(struct wd_splats *splats); /* accepts {0} */

#endif
