/* accumulate.h: samples of frames that follow each other, gathered along the motion of surfaces. */
#ifndef WD_FRAME_PASSES_ACCUMULATE_H
#define WD_FRAME_PASSES_ACCUMULATE_H

#include "frame/targets.h"
#include "shared/accumulate.h"

struct wd_accumulate_pass {
    struct wd_pipeline gather, store;
    VkSampler nearest;
    struct wd_buffer history[2][WD_HISTORY_PARTS]; /* of the frame before and of this one */
    uint32_t newest;             /* of history */
    uint32_t width, height;      /* that it holds; 0: nothing */
};

bool wd_accumulate_pass_init(struct wd_accumulate_pass *pass, struct wd_gpu *gpu);
void wd_accumulate_pass_finish(struct wd_accumulate_pass *pass, struct wd_gpu *gpu);

/* Forgets all: the next frame begins anew. */
void wd_accumulate_pass_reset(struct wd_accumulate_pass *pass);

struct wd_accumulate_params {
    struct wd_targets *targets;    /* one lit sample; radiance becomes the mean of those gathered */
    struct wd_binding uniforms;
    struct wd_buffer *velocity_px; /* of that sample, since the frame before */
    enum wd_motion { WD_MOTION_SOME, WD_MOTION_NONE } motion; /* of camera and time since then */
};
void wd_accumulate_pass_record(struct wd_accumulate_pass *pass, struct wd_cmd *cmd,
                               const struct wd_accumulate_params *params);

#endif
