/* views.h: a model's pictures from all over the upper hemisphere (rows R3, R6), baked on the device
 * and cached on disk. How points get into them: shared/view_set.h. */
#ifndef WD_BAKE_VIEWS_H
#define WD_BAKE_VIEWS_H

#include "bake/baker.h"
#include "bake/cache.h"
#include "shared/view_set.h"

enum {
    WD_VIEW_SIZE_MIN = 8,
    WD_VIEW_SIZE_MAX = 256,
    WD_VIEW_SIZE = 64, /* texels a side where params say 0 */
    WD_VIEW_SAMPLES_MAX = WD_BAKE_SAMPLES_MAX,
};

/* {0} is valid: 181 evenly spread views of 64 x 64 texels, 4 x 4 samples a texel. */
struct wd_view_set_params {
    struct wd_hemisphere hemisphere; /* rows, columns 0: WD_VIEWS_EVEN 9, _RINGS 10 x 30,
                                        _OCTAHEDRAL 12 */
    uint32_t size;    /* texels a side of a view: a power of two, WD_VIEW_SIZE_MIN .. _MAX */
    uint32_t samples; /* a texel, along each side: 1 .. WD_VIEW_SAMPLES_MAX */
    enum wd_bake_parts parts;
};

/* Fills in what is 0; false (logged) where a value is not allowed or `gpu` cannot hold a layer. */
bool wd_view_atlas_init(struct wd_view_atlas *atlas, struct wd_view_set_params *params,
                        const struct wd_gpu *gpu, const struct wd_log *log);

/* One model's layer of the atlas on the host. */
struct wd_view_set {
    struct wd_view_atlas atlas;
    struct wd_view_model model;
    uint8_t *planes[WD_PLANES]; /* all mips, finest first; 4 bytes a texel */
};
/* Texels a side of a layer at a mip; byte offset of a mip in a plane; bytes of a plane. */
uint32_t wd_view_layer_size(const struct wd_view_atlas *atlas, uint32_t mip);
size_t wd_view_mip_offset(const struct wd_view_atlas *atlas, uint32_t mip);
size_t wd_view_plane_bytes(const struct wd_view_atlas *atlas);

/* Renders every view of `mesh`, and finds how its wood differs from its leaves (set->model.mixed). `params` as filled in
 * by wd_view_atlas_init. Deterministic on one device. */
bool wd_view_set_bake(struct wd_view_set *set, struct wd_baker *baker,
                      const struct wd_bake_mesh *mesh, const struct wd_view_model *model,
                      const struct wd_view_atlas *atlas, const struct wd_view_set_params *params);
void wd_view_set_finish(struct wd_view_set *set); /* accepts {0} */

/* What names a set in the cache; `model_key` names the model's content (struct
 * wd_forest_device.model_keys). */
struct wd_view_set_name {
    struct wd_bake_cache *cache;
    uint64_t model_key;
    const struct wd_view_set_params *params;
    const struct wd_view_model *model;
};
/* False, with {0}, where it is not there. */
bool wd_view_set_load(struct wd_view_set *set, const struct wd_view_atlas *atlas,
                      const struct wd_view_set_name *name);
void wd_view_set_store(const struct wd_view_set *set, const struct wd_view_set_name *name);

#endif
