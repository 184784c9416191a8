/* light.h: from G-buffer and shadow maps to radiance: sun, sky, crowns, water, haze. */
#ifndef WD_FRAME_PASSES_LIGHT_H
#define WD_FRAME_PASSES_LIGHT_H

#include "forest/forest.h"
#include "frame/crown_sky.h"
#include "frame/sun_field.h"
#include "frame/targets.h"
#include "frame/view.h"
#include "shared/light.h"

struct wd_light_pass {
    struct wd_pipeline tiles, args;            /* sort tiles by what they show */
    struct wd_pipeline light[WD_TILE_LISTS];   /* shade one list each: what shows no water, */
    struct wd_pipeline single[WD_TILE_LISTS];  /* the same with single leaves: lists of trees */
    struct wd_pipeline water;                  /* what does */
    struct wd_pipeline view, velocity;
    struct wd_pipeline shafts;                 /* of sunlight in haze */
    struct wd_buffer shaft_shares;             /* float[tiles * WD_SHAFT_SLICES] */
    struct wd_buffer lists;                    /* struct wd_tile_lists and the lists */
    VkSampler nearest, shadow;
    struct wd_sun_field sun_field; /* of the newest forest, */
    struct wd_crown_sky crown_sky; /* and this */
};

bool wd_light_pass_init(struct wd_light_pass *pass, struct wd_gpu *gpu);
void wd_light_pass_finish(struct wd_light_pass *pass, struct wd_gpu *gpu);

enum wd_leaf_kinds { WD_LEAVES_ANY, WD_LEAVES_SINGLE }; /* as wd_method.single_leaves */

/* Makes the pipelines that such pictures need and that are not there yet. No frame is being recorded. */
struct wd_light_needs {
    const struct wd_forest_device *forest;
    uint32_t view_mode; /* WD_MODE_* */
    enum wd_leaf_kinds leaves;
    uint32_t width, height; /* of the picture */
};
bool wd_light_pass_prepare(struct wd_light_pass *pass, struct wd_gpu *gpu,
                           const struct wd_light_needs *needs);

struct wd_light_params {
    struct wd_targets *targets;
    const struct wd_forest_device *forest; /* wd_forest_device_use has been called */
    const struct wd_view *view;
    const struct wd_frame_uniforms *frame;
    struct wd_binding uniforms;            /* the same, on the device */
    enum wd_overlay { WD_OVERLAY_NONE, WD_OVERLAY_OVER } overlay; /* whether targets->overlay counts */
    enum wd_leaf_kinds leaves;
    bool level_cards; /* not wd_method.eye_pictures */
};

/* What shading needs besides the frame's uniforms: for methods that light trees by themselves. All
 * of it is in use for reading by any shader. */
struct wd_light_inputs {
    struct wd_light_push push;
    struct wd_binding shadow_map, sun_heights, canopy_light;
};
bool wd_light_pass_inputs(struct wd_light_pass *pass, struct wd_cmd *cmd,
                          const struct wd_light_params *params, struct wd_light_inputs *inputs);

/* Stores radiance, or adds to it where frame->adds says so. */
void wd_light_pass_record(struct wd_light_pass *pass, struct wd_cmd *cmd,
                          const struct wd_light_params *params);

/* Writes 2 floats a pixel into `velocity_px`: see wd_picture.velocity_px. */
void wd_light_pass_record_velocity(struct wd_light_pass *pass, struct wd_cmd *cmd,
                                   const struct wd_light_params *params,
                                   struct wd_buffer *velocity_px);

/* After an abandoned frame. */
void wd_light_pass_forget(struct wd_light_pass *pass);
/* Forgets what is kept of a forest; no frame that uses it may be in flight. */
void wd_light_pass_drop_forest(struct wd_light_pass *pass, struct wd_gpu *gpu);

#endif
