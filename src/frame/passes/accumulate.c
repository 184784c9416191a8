#include "frame/passes/accumulate.h"

static const uint32_t accumulate_comp[] =
#include "accumulate.comp.inc"
    ;

static bool init_pipeline(struct wd_pipeline *pipeline, struct wd_gpu *gpu, uint32_t stores)
{
    const VkDescriptorType image = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const struct wd_compute_params params = {
        .shader = WD_SPIRV(accumulate_comp),
        .bindings = {11,
                     {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, image,
                      image, buffer, buffer, buffer, buffer, buffer, buffer, buffer}},
        .push_size = sizeof(struct wd_accumulate_push),
        .constants = {1, &stores},
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

bool wd_accumulate_pass_init(struct wd_accumulate_pass *pass, struct wd_gpu *gpu)
{
    *pass = (struct wd_accumulate_pass){0};
    bool ok = init_pipeline(&pass->gather, gpu, 0) && init_pipeline(&pass->store, gpu, 1) &&
              wd_sampler_init(&pass->nearest, gpu, WD_SAMPLER_NEAREST_CLAMP);
    if (!ok)
        wd_accumulate_pass_finish(pass, gpu);
    return ok;
}

void wd_accumulate_pass_finish(struct wd_accumulate_pass *pass, struct wd_gpu *gpu)
{
    if (pass->nearest)
        vkDestroySampler(gpu->device, pass->nearest, NULL);
    for (int i = 0; i < 2 * WD_HISTORY_PARTS; i++)
        wd_buffer_finish(&pass->history[i / WD_HISTORY_PARTS][i % WD_HISTORY_PARTS], gpu);
    *pass = (struct wd_accumulate_pass){0};
}

void wd_accumulate_pass_reset(struct wd_accumulate_pass *pass)
{
    pass->width = pass->height = 0;
}

static bool fit_history(struct wd_accumulate_pass *pass, struct wd_cmd *cmd,
                        const struct wd_targets *targets)
{
    const struct wd_buffer_params params = {
        .name = "history",
        .size = (VkDeviceSize)targets->width * targets->height * 2 * sizeof(uint32_t),
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
    };
    for (int i = 0; i < 2 * WD_HISTORY_PARTS; i++) {
        struct wd_buffer *part = &pass->history[i / WD_HISTORY_PARTS][i % WD_HISTORY_PARTS];
        if (part->size == params.size)
            continue;
        wd_cmd_defer_buffer(cmd, part);
        wd_accumulate_pass_reset(pass);
        if (!wd_buffer_init(part, cmd->gpu, &params))
            return false;
    }
    return true;
}

void wd_accumulate_pass_record(struct wd_accumulate_pass *pass, struct wd_cmd *cmd,
                               const struct wd_accumulate_params *params)
{
    struct wd_targets *targets = params->targets;
    if (!fit_history(pass, cmd, targets))
        cmd->failed = true;
    if (cmd->failed)
        return;
    const struct wd_accumulate_push push = {
        .has_history = pass->width == targets->width && pass->height == targets->height,
        .still = params->motion == WD_MOTION_NONE,
    };
    struct wd_buffer *before = pass->history[pass->newest], *now = pass->history[1 - pass->newest];
    wd_cmd_use_image(cmd, &targets->radiance, WD_USE_COMPUTE_WRITE); /* stays a storage image */
    wd_cmd_use_image(cmd, &targets->surface, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->depth, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, params->velocity_px, WD_USE_COMPUTE_READ);
    for (int i = 0; i < WD_HISTORY_PARTS; i++)
        wd_cmd_use_buffer(cmd, &before[i], WD_USE_COMPUTE_READ);
    const struct wd_binding bindings[] = {params->uniforms,
                                          WD_BIND_STORAGE_IMAGE(&targets->radiance),
                                          WD_BIND_IMAGE(&targets->surface, pass->nearest),
                                          WD_BIND_IMAGE(&targets->depth, pass->nearest),
                                          WD_BIND_BUFFER(params->velocity_px),
                                          WD_BIND_BUFFER(&before[WD_HISTORY_RED_GREEN]),
                                          WD_BIND_BUFFER(&before[WD_HISTORY_BLUE_SAMPLES]),
                                          WD_BIND_BUFFER(&before[WD_HISTORY_SEEN]),
                                          WD_BIND_BUFFER(&now[WD_HISTORY_RED_GREEN]),
                                          WD_BIND_BUFFER(&now[WD_HISTORY_BLUE_SAMPLES]),
                                          WD_BIND_BUFFER(&now[WD_HISTORY_SEEN])};
    const struct wd_pipeline *pipelines[] = {&pass->gather, &pass->store};
    for (int i = 0; i < 2; i++) {
        wd_cmd_use_image(cmd, &targets->radiance, WD_USE_COMPUTE_WRITE);
        for (int part = 0; part < WD_HISTORY_PARTS; part++)
            wd_cmd_use_buffer(cmd, &now[part], WD_USE_COMPUTE_WRITE);
        wd_cmd_bind(cmd, pipelines[i], bindings);
        wd_cmd_push(cmd, pipelines[i], &push, sizeof push);
        wd_cmd_dispatch(cmd, (targets->width + 7) / 8, (targets->height + 7) / 8, 1);
    }
    pass->newest = 1 - pass->newest;
    pass->width = targets->width;
    pass->height = targets->height;
}
