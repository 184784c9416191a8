#include "frame/targets.h"

bool wd_targets_init(struct wd_targets *targets, struct wd_gpu *gpu, uint32_t width,
                     uint32_t height, uint32_t shadow_size)
{
    bool stored = gpu->features & WD_GPU_FEATURE_STORED_TARGETS;
    const VkImageUsageFlags target = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkImageUsageFlags filled = target | (stored ? VK_IMAGE_USAGE_STORAGE_BIT : 0);
    const VkImageUsageFlags depth =
        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkImageUsageFlags storage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const struct {
        struct wd_image *image;
        struct wd_image_params params;
    } images[] = {
        {&targets->albedo, {"albedo", WD_ALBEDO_FORMAT, width, height, 1, 1, target, 0,
                            stored ? WD_ALBEDO_STORED : VK_FORMAT_UNDEFINED, true}},
        {&targets->normal, {"normal", WD_NORMAL_FORMAT, width, height, 1, 1, filled, 0, 0, true}},
        {&targets->surface, {"surface", WD_SURFACE_FORMAT, width, height, 1, 1, filled, 0, 0, true}},
        {&targets->depth, {"depth", WD_DEPTH_FORMAT, width, height, 1, 1, depth, 0, 0, true}},
        {&targets->overlay, {"overlay", WD_OVERLAY_FORMAT, width, height, 1, 1, target, 0, 0, true}},
        {&targets->radiance, {"radiance", WD_RADIANCE_FORMAT, width, height, 1, 1, storage, 0, 0, true}},
        {&targets->display, {"display", WD_DISPLAY_FORMAT, width, height, 1, 1, storage, 0, 0, true}},
        {&targets->shadow,
         {"shadow", WD_DEPTH_FORMAT, shadow_size, shadow_size, WD_CASCADES, 1, depth,
          WD_IMAGE_ARRAY, 0, false}},
        {&targets->stored_shadow,
         {"stored shadow", WD_DEPTH_STORED, shadow_size, shadow_size, WD_CASCADES, 1, storage,
          WD_IMAGE_ARRAY, 0, false}},
    };
    const size_t count = sizeof images / sizeof *images - (stored ? 0 : 1);
    *targets = (struct wd_targets){
        .width = width, .height = height, .shadow_size = shadow_size};
    for (size_t i = 0; i < count; i++) {
        if (!wd_image_init(images[i].image, gpu, &images[i].params)) {
            wd_targets_finish(targets, gpu);
            return false;
        }
    }
    for (uint32_t i = 0; i < WD_CASCADES; i++) {
        if (!wd_image_layer_view(gpu, &targets->shadow, i, 0, &targets->shadow_layers[i])) {
            wd_targets_finish(targets, gpu);
            return false;
        }
    }
    return true;
}

void wd_targets_finish(struct wd_targets *targets, struct wd_gpu *gpu)
{
    struct wd_image *images[] = {&targets->albedo,   &targets->normal,  &targets->surface,
                                 &targets->depth,    &targets->radiance, &targets->display,
                                 &targets->overlay,  &targets->shadow,   &targets->stored_shadow};
    for (uint32_t i = 0; i < WD_CASCADES; i++) {
        if (targets->shadow_layers[i])
            vkDestroyImageView(gpu->device, targets->shadow_layers[i], NULL);
    }
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        wd_image_finish(images[i], gpu);
    *targets = (struct wd_targets){0};
}

struct wd_image *wd_targets_shadow(struct wd_targets *targets)
{
    return targets->shadow_is_stored ? &targets->stored_shadow : &targets->shadow;
}

struct wd_rendering wd_targets_gbuffer(struct wd_targets *targets, enum wd_load load)
{
    return (struct wd_rendering){
        .width = targets->width,
        .height = targets->height,
        .color_count = 3,
        .color = {{.image = &targets->albedo, .load = load},
                  {.image = &targets->normal, .load = load},
                  {.image = &targets->surface, .load = load}},
        .depth = &targets->depth,
        .depth_load = load,
    };
}
