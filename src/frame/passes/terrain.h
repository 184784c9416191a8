/* terrain.h: the ground into the G-buffer. */
#ifndef WD_FRAME_PASSES_TERRAIN_H
#define WD_FRAME_PASSES_TERRAIN_H

#include "forest/ground.h"
#include "frame/passes/terrain_patches.h"
#include "frame/targets.h"
#include "frame/view.h"

struct wd_terrain_pass {
    struct wd_pipeline pipelines[2][2]; /* with holes; near enough for what is strewn on it */
    struct wd_pipeline shade; /* where fragments only mark the ground */
    VkSampler nearest;
    struct wd_binding view; /* struct wd_terrain_view of the newest record */
    struct wd_buffer indices;
    struct wd_patch_list patches; /* scratch */
    uint64_t triangles;           /* of the newest record */
};

bool wd_terrain_pass_init(struct wd_terrain_pass *pass, struct wd_gpu *gpu);
/* Adds the pipelines that such ground needs. No frame is being recorded. */
bool wd_terrain_pass_prepare(struct wd_terrain_pass *pass, struct wd_gpu *gpu,
                             const struct wd_ground *ground);
void wd_terrain_pass_finish(struct wd_terrain_pass *pass, struct wd_gpu *gpu);

struct wd_terrain_params {
    const struct wd_ground *ground; /* wd_ground_use has been called for this frame */
    const struct wd_view *view;
    struct wd_binding uniforms;     /* struct wd_frame_uniforms */
    float error_px;                 /* wanted bound of the mesh's error on screen */
};
/* What it draws into, of a G-buffer that has been cleared or drawn to before. */
struct wd_rendering wd_terrain_pass_targets(const struct wd_terrain_pass *pass,
                                            struct wd_targets *targets);
/* Records up to two indexed draws into an open rendering of these.
 *
 * The ground needs no pass into the shadow maps: its own shadows, at any distance, are in the light
 * pass (frame/sun_field.h), and the maps hold what stands on it. */
void wd_terrain_pass_record(struct wd_terrain_pass *pass, struct wd_cmd *cmd,
                            const struct wd_terrain_params *params);
/* Outside of any rendering, after that: what the ground looks like, on devices on which compute finds that. */
void wd_terrain_pass_shade(struct wd_terrain_pass *pass, struct wd_cmd *cmd,
                           const struct wd_terrain_params *params, struct wd_targets *targets);

#endif
