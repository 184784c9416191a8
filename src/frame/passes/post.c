#include "frame/passes/post.h"

#include <math.h>

#include "shared/light.h"

static const uint32_t meter_comp[] =
#include "meter.comp.inc"
    ;
static const uint32_t meter_exposure_comp[] =
#include "meter_exposure.comp.inc"
    ;
static const uint32_t tonemap_comp[] =
#include "tonemap.comp.inc"
    ;

enum { METERED_PER_GROUP = 16 * 256 }; /* as in meter.comp */

static bool init_meter(struct wd_post_pass *pass, struct wd_gpu *gpu)
{
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const struct wd_compute_params meter = {
        .shader = WD_SPIRV(meter_comp),
        .bindings = {3, {uniform, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, buffer}},
    };
    const struct wd_compute_params exposure = {
        .shader = WD_SPIRV(meter_exposure_comp),
        .bindings = {2, {uniform, buffer}},
    };
    const struct wd_buffer_params histogram = {
        .name = "luminance histogram",
        .size = sizeof(struct wd_meter),
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
    };
    return wd_pipeline_init_compute(&pass->meter, gpu, &meter) &&
           wd_pipeline_init_compute(&pass->exposure, gpu, &exposure) &&
           wd_buffer_init(&pass->histogram, gpu, &histogram);
}

static bool init_tonemap(struct wd_pipeline *pipeline, struct wd_gpu *gpu, enum wd_tone tone)
{
    const struct wd_compute_params params = {
        .shader = WD_SPIRV(tonemap_comp),
        .bindings = {5,
                     {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                      VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
        .push_size = sizeof(struct wd_post_push),
        .constants = {2, (const uint32_t[]){tone == WD_TONE_BLOOM, tone != WD_TONE_VIEW}},
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

bool wd_post_pass_init(struct wd_post_pass *pass, struct wd_gpu *gpu)
{
    *pass = (struct wd_post_pass){0};
    bool ok = init_meter(pass, gpu) && wd_bloom_pass_init(&pass->bloom, gpu);
    for (int tone = 0; tone < WD_TONE_KINDS && ok; tone++)
        ok = init_tonemap(&pass->tonemap[tone], gpu, (enum wd_tone)tone);
    if (!ok)
        wd_post_pass_finish(pass, gpu);
    return ok;
}

void wd_post_pass_finish(struct wd_post_pass *pass, struct wd_gpu *gpu)
{
    wd_bloom_pass_finish(&pass->bloom, gpu);
    wd_buffer_finish(&pass->histogram, gpu);
    *pass = (struct wd_post_pass){0};
}

static void record_meter(struct wd_post_pass *pass, struct wd_cmd *cmd,
                         const struct wd_post_params *params)
{
    struct wd_targets *targets = params->targets;
    wd_cmd_fill_buffer(cmd, &pass->histogram, 0);
    wd_cmd_use_buffer(cmd, &pass->histogram, WD_USE_COMPUTE_WRITE);
    const struct wd_binding meter[] = {params->uniforms, WD_BIND_STORAGE_IMAGE(&targets->radiance),
                                       WD_BIND_BUFFER(&pass->histogram)};
    wd_cmd_bind(cmd, &pass->meter, meter);
    uint64_t metered = (uint64_t)((targets->width + 1) / 2) * ((targets->height + 1) / 2);
    wd_cmd_dispatch_1d(cmd, (metered + METERED_PER_GROUP - 1) / METERED_PER_GROUP);
    wd_cmd_use_buffer(cmd, &pass->histogram, WD_USE_COMPUTE_WRITE);
    const struct wd_binding exposure[] = {params->uniforms, WD_BIND_BUFFER(&pass->histogram)};
    wd_cmd_bind(cmd, &pass->exposure, exposure);
    wd_cmd_dispatch(cmd, 1, 1, 1);
}

void wd_post_pass_record(struct wd_post_pass *pass, struct wd_cmd *cmd,
                         const struct wd_post_params *params)
{
    struct wd_targets *targets = params->targets;
    wd_cmd_use_image(cmd, &targets->radiance, WD_USE_COMPUTE_WRITE); /* stays a storage image */
    record_meter(pass, cmd, params);
    bool lit = params->view_mode == WD_MODE_LIT, bloom = lit && params->bloom > 0.0f;
    if (bloom)
        wd_bloom_pass_record(&pass->bloom, cmd, targets);
    wd_cmd_use_buffer(cmd, &pass->histogram, WD_USE_COMPUTE_READ);
    wd_cmd_discard_image(cmd, &targets->display, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {
        params->uniforms, WD_BIND_STORAGE_IMAGE(&targets->radiance),
        WD_BIND_STORAGE_IMAGE(&targets->display), WD_BIND_BUFFER(&pass->histogram),
        /* without bloom nobody reads the slot; it is filled all the same */
        WD_BIND_BUFFER(bloom ? &pass->bloom.pyramid : &pass->histogram)};
    const struct wd_post_push push = {exp2f(params->exposure_ev), params->bloom};
    struct wd_pipeline *tonemap =
        &pass->tonemap[!lit ? WD_TONE_VIEW : bloom ? WD_TONE_BLOOM : WD_TONE_PLAIN];
    wd_cmd_bind(cmd, tonemap, bindings);
    wd_cmd_push(cmd, tonemap, &push, sizeof push);
    wd_cmd_dispatch(cmd, (targets->width + 7) / 8, (targets->height + 7) / 8, 1);
}
