/* splats.h: a tree as discs, in an order that any part of suits, and of its wood as triangles, the first of which do. */
#ifndef WD_BAKE_SPLATS_H
#define WD_BAKE_SPLATS_H

#include "bake/cache.h"
#include "shared/continuum.h"
#include "tree/grow.h"
#include "tree/points.h"

/* A model's discs with looks and light. */
enum { WD_SPLATS_BYTES = WD_SPLATS * (sizeof(struct wd_splat) + 2 * sizeof(uint32_t)) };

struct wd_splats {
    struct wd_splat *splats; /* WD_SPLATS: strata of leaves from the top down, then wood */
    uint32_t *looks; /* parallel, see shared/continuum.h; as is: */
    uint32_t *lit;   /* ways of shared/sun_ways.h that the tree leaves open, a bit each */
    struct wd_splat_corner *corners; /* model.wood_corners */
    uint64_t *wood;                  /* model.wood_count triangles of them */
    struct wd_splat_model model;     /* model.wood_first is 0 */
};

/* Makes them of the model's points, the wood of its reduced mesh and the far stem. Where leaves or wood are
 * missing their strata hold what there is. False, logged, for a tree without surface. */
bool wd_splats_init(struct wd_splats *splats, const struct wd_tree_model *model,
                    const struct wd_point_look *look, const struct wd_log *log);
void wd_splats_finish(struct wd_splats *splats); /* accepts {0} */

/* `model_key` names what they are made of (wd_growth_get). */
bool wd_splats_load(struct wd_splats *splats, struct wd_bake_cache *cache, uint64_t model_key);
void wd_splats_store(const struct wd_splats *splats, struct wd_bake_cache *cache,
                     uint64_t model_key);

#endif
