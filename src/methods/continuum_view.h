/* continuum_view.h: what continuum's passes know of one view. */
#ifndef WD_METHODS_CONTINUUM_VIEW_H
#define WD_METHODS_CONTINUUM_VIEW_H

#include "methods/continuum_forest.h"
#include "methods/continuum_near.h"

/* The camera's newest frame, whose depth pyramid is there. */
struct wd_continuum_history {
    uint32_t width, height; /* 0: there is none */
    double eye_m[3];
    struct wd_camera camera;
    float clip_from_rel[4][4];
};
void wd_continuum_history_keep(struct wd_continuum_history *history, const struct wd_view *view);

struct wd_continuum_view_params {
    const struct wd_tree_draw *draw;
    const struct wd_continuum_forest *forest;
    const struct wd_continuum_history *history;
    bool puts_off; /* what a moved camera's history hides is tried again; else it has none */
    uint32_t page_count, tree_capacity, item_capacity, cluster_capacity;
};
void wd_continuum_view_fill(struct wd_splat_view *values,
                            const struct wd_continuum_view_params *params);
/* From the first round of a view to the second, which goes by this frame's own pyramid. */
void wd_continuum_view_again(struct wd_splat_view *values);

/* Pixels each way, over the picture's own, that the error bound asks level of detail to be chosen for.
 * Maps that are kept for later frames do not follow it. */
float wd_continuum_detail(const struct wd_tree_draw *draw);
/* Which stored trees cascades draw, that may hold the whole world: so many of each cluster, and all that are this tall. */
struct wd_cascade_share {
    uint32_t records;
    float whole_m;
};
struct wd_cascade_share wd_cascade_share_of(uint32_t capacity, const uint32_t taller[WD_HEIGHT_STEPS]);
/* Of a cascade: texels that a metre spans. */
float wd_texels_per_m(const struct wd_view *view);
/* Where trees are meshes: in cascades but the first, or in that while it is calm, none are, nor where they are
 * on demand and not known here. */
struct wd_near_rule wd_continuum_near_rule(const struct wd_tree_draw *draw,
                                           const struct wd_continuum_forest *forest);
/* Floats of the depth pyramid; `first`: of each level. */
uint32_t wd_pyramid_offsets(uint32_t first[WD_PYRAMID_LEVELS], uint32_t width, uint32_t height);

#endif
