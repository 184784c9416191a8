#include "frame/passes/light.h"

#include "shared/light.h"

static const uint32_t light_comp[] =
#include "light.comp.inc"
    ;
static const uint32_t light_velocity_comp[] =
#include "light_velocity.comp.inc"
    ;

#define SPIRV(words) {words, sizeof words, #words}

static bool init_light(struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    const VkDescriptorType image = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const struct wd_compute_params params = {
        .shader = SPIRV(light_comp),
        .bindings = {10,
                     {buffer, image, image, image, image, image, buffer, buffer, buffer,
                      VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}},
        .push_size = sizeof(struct wd_light_push),
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

static bool init_velocity(struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    const VkDescriptorType image = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const struct wd_compute_params params = {
        .shader = SPIRV(light_velocity_comp),
        .bindings = {8, {buffer, image, image, image, image, buffer, buffer, buffer}},
        .push_size = sizeof(struct wd_light_push),
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

bool wd_light_pass_init(struct wd_light_pass *pass, struct wd_gpu *gpu)
{
    *pass = (struct wd_light_pass){0};
    bool ok = init_light(&pass->light, gpu) && init_velocity(&pass->velocity, gpu) &&
              wd_sampler_init(&pass->nearest, gpu, WD_SAMPLER_NEAREST_CLAMP) &&
              wd_sampler_init(&pass->shadow, gpu, WD_SAMPLER_SHADOW);
    if (!ok)
        wd_light_pass_finish(pass, gpu);
    return ok;
}

void wd_light_pass_finish(struct wd_light_pass *pass, struct wd_gpu *gpu)
{
    wd_pipeline_finish(&pass->light, gpu);
    wd_pipeline_finish(&pass->velocity, gpu);
    if (pass->nearest)
        vkDestroySampler(gpu->device, pass->nearest, NULL);
    if (pass->shadow)
        vkDestroySampler(gpu->device, pass->shadow, NULL);
    wd_sun_field_finish(&pass->sun_field, gpu);
    *pass = (struct wd_light_pass){0};
}

void wd_light_pass_drop_forest(struct wd_light_pass *pass, struct wd_gpu *gpu)
{
    wd_sun_field_finish(&pass->sun_field, gpu);
}

static void use_gbuffer(struct wd_cmd *cmd, struct wd_targets *targets)
{
    wd_cmd_use_image(cmd, &targets->albedo, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->normal, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->surface, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->depth, WD_USE_COMPUTE_READ);
}

static struct wd_light_push push_of(const struct wd_light_pass *pass,
                                    const struct wd_light_params *params)
{
    return (struct wd_light_push){
        .camera_m = {(float)params->view->eye_m[0], (float)params->view->eye_m[1]},
        .sun_cell_m = pass->sun_field.cell_m,
        .sun_soft_m = pass->sun_field.soft_m,
        .sun_width = pass->sun_field.width,
        .sun_height = pass->sun_field.height,
        .variants = params->forest->variants,
    };
}

/* A forest without species has no models; the slot must be filled all the same. */
static struct wd_binding models_of(const struct wd_forest_device *forest)
{
    return WD_BIND_BUFFER(forest->models.buffer ? &forest->models : &forest->trees);
}

void wd_light_pass_record(struct wd_light_pass *pass, struct wd_cmd *cmd,
                          const struct wd_light_params *params)
{
    struct wd_targets *targets = params->targets;
    wd_sun_field_update(&pass->sun_field, cmd, params->forest->ground.terrain,
                        params->frame->sun_direction);
    use_gbuffer(cmd, targets);
    wd_cmd_use_image(cmd, &targets->shadow, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->radiance, WD_USE_COMPUTE_WRITE);
    if (cmd->failed)
        return;
    const struct wd_binding bindings[] = {
        params->uniforms,
        WD_BIND_IMAGE(&targets->albedo, pass->nearest),
        WD_BIND_IMAGE(&targets->normal, pass->nearest),
        WD_BIND_IMAGE(&targets->surface, pass->nearest),
        WD_BIND_IMAGE(&targets->depth, pass->nearest),
        WD_BIND_IMAGE(&targets->shadow, pass->shadow),
        WD_BIND_BUFFER(&pass->sun_field.heights),
        WD_BIND_BUFFER(&params->forest->trees),
        models_of(params->forest),
        WD_BIND_STORAGE_IMAGE(&targets->radiance),
    };
    const struct wd_light_push push = push_of(pass, params);
    wd_cmd_bind(cmd, &pass->light, bindings);
    wd_cmd_push(cmd, &pass->light, &push, sizeof push);
    wd_cmd_dispatch(cmd, (targets->width + 7) / 8, (targets->height + 7) / 8, 1);
}

void wd_light_pass_record_velocity(struct wd_light_pass *pass, struct wd_cmd *cmd,
                                   const struct wd_light_params *params,
                                   struct wd_buffer *velocity_px)
{
    struct wd_targets *targets = params->targets;
    use_gbuffer(cmd, targets);
    wd_cmd_use_buffer(cmd, velocity_px, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {
        params->uniforms,
        WD_BIND_IMAGE(&targets->albedo, pass->nearest),
        WD_BIND_IMAGE(&targets->normal, pass->nearest),
        WD_BIND_IMAGE(&targets->surface, pass->nearest),
        WD_BIND_IMAGE(&targets->depth, pass->nearest),
        WD_BIND_BUFFER(&params->forest->trees),
        models_of(params->forest),
        WD_BIND_BUFFER(velocity_px),
    };
    const struct wd_light_push push = push_of(pass, params);
    wd_cmd_bind(cmd, &pass->velocity, bindings);
    wd_cmd_push(cmd, &pass->velocity, &push, sizeof push);
    wd_cmd_dispatch(cmd, (targets->width + 7) / 8, (targets->height + 7) / 8, 1);
}
