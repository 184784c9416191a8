#include "frame/passes/bloom.h"

#include "shared/bloom.h"

static const uint32_t bloom_down_comp[] =
#include "bloom_down.comp.inc"
    ;
static const uint32_t bloom_up_comp[] =
#include "bloom_up.comp.inc"
    ;

static bool init_down(struct wd_pipeline *pipeline, struct wd_gpu *gpu, uint32_t first)
{
    const struct wd_compute_params params = {
        .shader = WD_SPIRV(bloom_down_comp),
        .bindings = {2, {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}},
        .push_size = sizeof(struct wd_bloom_push),
        .constants = {1, &first},
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

bool wd_bloom_pass_init(struct wd_bloom_pass *pass, struct wd_gpu *gpu)
{
    const struct wd_compute_params up = {
        .shader = WD_SPIRV(bloom_up_comp),
        .bindings = {1, {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
        .push_size = sizeof(struct wd_bloom_push),
    };
    *pass = (struct wd_bloom_pass){0};
    bool ok = init_down(&pass->first, gpu, 1) && init_down(&pass->down, gpu, 0) &&
              wd_pipeline_init_compute(&pass->up, gpu, &up);
    if (!ok)
        wd_bloom_pass_finish(pass, gpu);
    return ok;
}

void wd_bloom_pass_finish(struct wd_bloom_pass *pass, struct wd_gpu *gpu)
{
    wd_buffer_finish(&pass->pyramid, gpu);
    *pass = (struct wd_bloom_pass){0};
}

/* levels[0] is the picture itself, of which nothing is in the buffer; returns the texels of all. */
static uint32_t lay_out(struct wd_bloom_level levels[WD_BLOOM_LEVELS + 1], uint32_t width,
                        uint32_t height)
{
    uint32_t texels = 0;
    levels[0] = (struct wd_bloom_level){0, width, height};
    for (int i = 1; i <= WD_BLOOM_LEVELS; i++) {
        levels[i] = (struct wd_bloom_level){texels, (levels[i - 1].width + 1) / 2,
                                            (levels[i - 1].height + 1) / 2};
        texels += levels[i].width * levels[i].height;
    }
    return texels;
}

static bool fit_pyramid(struct wd_bloom_pass *pass, struct wd_cmd *cmd, uint32_t texels)
{
    const struct wd_buffer_params params = {"bloom", texels * 4 * sizeof(float),
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    if (pass->pyramid.size == params.size)
        return true;
    wd_cmd_defer_buffer(cmd, &pass->pyramid);
    return wd_buffer_init(&pass->pyramid, cmd->gpu, &params);
}

static void record_level(struct wd_bloom_pass *pass, struct wd_cmd *cmd, struct wd_pipeline *pipeline,
                         const struct wd_binding *bindings, const struct wd_bloom_push *push)
{
    wd_cmd_use_buffer(cmd, &pass->pyramid, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, pipeline, bindings);
    wd_cmd_push(cmd, pipeline, push, sizeof *push);
    wd_cmd_dispatch(cmd, (push->to.width + 7) / 8, (push->to.height + 7) / 8, 1);
}

void wd_bloom_pass_record(struct wd_bloom_pass *pass, struct wd_cmd *cmd,
                          struct wd_targets *targets)
{
    struct wd_bloom_level levels[WD_BLOOM_LEVELS + 1];
    if (!fit_pyramid(pass, cmd, lay_out(levels, targets->width, targets->height))) {
        cmd->failed = true;
        return;
    }
    const struct wd_binding bindings[] = {WD_BIND_BUFFER(&pass->pyramid),
                                          WD_BIND_STORAGE_IMAGE(&targets->radiance)};
    for (int i = 0; i < WD_BLOOM_LEVELS; i++)
        record_level(pass, cmd, i ? &pass->down : &pass->first, bindings,
                     &(struct wd_bloom_push){levels[i], levels[i + 1]});
    for (int i = WD_BLOOM_LEVELS; i > 1; i--)
        record_level(pass, cmd, &pass->up, bindings,
                     &(struct wd_bloom_push){levels[i], levels[i - 1]});
    wd_cmd_use_buffer(cmd, &pass->pyramid, WD_USE_COMPUTE_READ);
}
