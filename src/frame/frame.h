/* frame.h: one frame, pass by pass. */
#ifndef WD_FRAME_FRAME_H
#define WD_FRAME_FRAME_H

#include "frame/passes/accumulate.h"
#include "frame/passes/light.h"
#include "frame/passes/post.h"
#include "frame/passes/terrain.h"
#include "frame/targets.h"
#include "frame/view.h"
#include "methods/method.h"

/* What a frame shows. */
struct wd_frame_params {
    struct wd_forest_device *forest;
    const struct wd_method *method;
    struct wd_camera camera, previous_camera;
    struct wd_sun sun;
    double time_s, previous_time_s;
    uint32_t width, height;
    uint32_t samples;
    uint32_t view_mode; /* WD_MODE_* */
    enum wd_gbuffer_use {
        WD_GBUFFER_OWN,  /* for the frame's own passes */
        WD_GBUFFER_READ, /* its layers are read afterwards: trees stand in all of them */
        WD_GBUFFER_READ_EACH, /* after every sample */
    } gbuffer;
    enum wd_frame_light {
        WD_FRAME_LIT,
        WD_FRAME_UNLIT, /* neither colour nor display is asked for: no shadows, no light */
    } light;
    uint32_t page_budget; /* pages of trees on demand to plant for a view, at most; 0: all it needs */
    float max_error_px;   /* see struct wd_render_params; 0: the method's own */
    enum wd_velocity { WD_VELOCITY_OFF, WD_VELOCITY_ON } velocity;
    /* Frames are one sample each, jittered in turn, and gathered along motion. The previous camera and
     * time are those of the frame before; velocity must be on. */
    enum wd_gathering { WD_GATHER_OFF, WD_GATHER_ON } gathering;
};

struct wd_frame {
    struct wd_gpu *gpu;
    struct wd_frames ring;
    struct wd_targets targets;
    struct wd_buffer velocity_px; /* 2 floats a pixel, once it has been asked for */
    struct wd_tree_pipelines trees;
    struct wd_terrain_pass terrain;
    struct wd_light_pass light;
    struct wd_post_pass post;
    struct wd_accumulate_pass accumulate;
    struct wd_gathered {             /* what accumulate holds */
        struct wd_camera camera;
        struct wd_sun sun;
        double time_s;
        const struct wd_method *method;
        uint32_t view_mode;
        uint32_t frames; /* gathered since it was forgotten */
    } gathered;
    struct wd_methods methods;       /* states of those used so far */
    void *method_state;              /* of params.method */
    struct wd_kept_cascade {         /* what the shadow maps hold, as far as it may be kept */
        const struct wd_method *method; /* NULL: unknown */
        uint32_t samples;
        struct wd_cascade_box box;
    } kept[WD_CASCADES];
    struct wd_draw_stats camera_stats; /* of the last sample: what the camera sees */
    struct wd_draw_stats stats;      /* of the last sample, shadows too */
    struct wd_frame_params params;
    float near_m; /* depth target = near_m / distance along the view axis */
};

bool wd_frame_init(struct wd_frame *frame, struct wd_gpu *gpu);
void wd_frame_finish(struct wd_frame *frame);

/* Takes the parameters and makes the targets fit; waits for frames in flight when they change. */
bool wd_frame_prepare(struct wd_frame *frame, const struct wd_frame_params *params);

/* Records sample `index` of params.samples up to the radiance target. Sample 0 draws the shadows,
 * which the others share. The last one is followed by the display. Of unlit frames up to the G-buffer and the velocity,
 * beginning with any sample. */
void wd_frame_record(struct wd_frame *frame, struct wd_cmd *cmd, uint32_t index);

/* A foreign image that takes the display. */
struct wd_frame_target {
    VkImage image; /* as large as the frame; its contents are discarded */
    VkFormat format;
    VkImageLayout layout_after;
};
/* Records the copy of the display (sRGB-encoded bytes) into the image; the last thing in a frame. */
void wd_frame_copy(struct wd_frame *frame, struct wd_cmd *cmd, const struct wd_frame_target *target);

/* Forgets what the device was to hold after a recorded frame; call when wd_frame_submit has returned false. */
void wd_frame_abandoned(struct wd_frame *frame);

/* Forgets what the passes keep of a forest; call before it is destroyed. */
void wd_frame_drop_forest(struct wd_frame *frame);

#endif
