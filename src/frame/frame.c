#include "frame/frame.h"

#include <string.h>

#include "frame/uniforms.h"

bool wd_frame_init(struct wd_frame *frame, struct wd_gpu *gpu)
{
    *frame = (struct wd_frame){.gpu = gpu};
    bool ok = wd_frames_init(&frame->ring, gpu) && wd_tree_pipelines_init(&frame->trees, gpu) &&
              wd_terrain_pass_init(&frame->terrain, gpu) &&
              wd_light_pass_init(&frame->light, gpu) && wd_post_pass_init(&frame->post, gpu);
    if (!ok)
        wd_frame_finish(frame);
    return ok;
}

void wd_frame_finish(struct wd_frame *frame)
{
    if (!frame->gpu)
        return;
    wd_frames_finish(&frame->ring);
    wd_tree_pipelines_finish(&frame->trees, frame->gpu);
    wd_terrain_pass_finish(&frame->terrain, frame->gpu);
    wd_light_pass_finish(&frame->light, frame->gpu);
    wd_post_pass_finish(&frame->post, frame->gpu);
    wd_targets_finish(&frame->targets, frame->gpu);
    wd_selection_finish(&frame->selection);
    *frame = (struct wd_frame){0};
}

bool wd_frame_prepare(struct wd_frame *frame, const struct wd_frame_params *params)
{
    struct wd_targets *targets = &frame->targets;
    uint32_t shadow_size = (uint32_t)params->forest->scene->quality.shadow_size;
    frame->params = *params;
    if (targets->width == params->width && targets->height == params->height &&
        targets->shadow_size == shadow_size)
        return true;
    if (!wd_frames_wait(&frame->ring))
        return false;
    wd_targets_finish(targets, frame->gpu);
    return wd_targets_init(targets, frame->gpu, params->width, params->height, shadow_size);
}
