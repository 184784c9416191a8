/* uniforms.h: what a frame's passes know, gathered from the scene, the world and the camera. */
#ifndef WD_FRAME_UNIFORMS_H
#define WD_FRAME_UNIFORMS_H

#include "forest/forest.h"
#include "frame/view.h"

/* Pictures of so many samples draw their shadow maps once for all of these. */
enum { WD_FINE_SAMPLES = 4 };

struct wd_uniforms_params {
    const struct wd_forest_device *forest;
    struct wd_camera camera, previous_camera;
    struct wd_sun sun;
    double time_s, previous_time_s;
    uint32_t width, height, shadow_size;
    uint32_t adds; /* as in struct wd_frame_uniforms */
    uint32_t samples;                    /* of the picture */
    uint32_t sample_index, sample_count; /* where the camera stands for this one */
    uint32_t view_mode;
    double calm_m; /* of struct wd_cascades_params */
    enum wd_shadow_maps maps;
};

/* Fills all of `*uniforms`, the camera's view and those of the sun's cascades. */
void wd_uniforms_init(struct wd_frame_uniforms *uniforms, struct wd_view *view,
                      struct wd_view cascades[WD_CASCADES],
                      const struct wd_uniforms_params *params);

#endif
