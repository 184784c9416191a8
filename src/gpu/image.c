#include <assert.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"
#include "gpu/allocation.h"
#include "gpu/format.h"

struct usage_row {
    VkImageUsageFlags usage;
    VkFormatFeatureFlags feature;
    const char *name;
};

static const struct usage_row usages[] = {
    {VK_IMAGE_USAGE_SAMPLED_BIT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, "sampled"},
    {VK_IMAGE_USAGE_STORAGE_BIT, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, "storage"},
    {VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, "color target"},
    {VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT,
     "depth target"},
    {VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_FORMAT_FEATURE_TRANSFER_SRC_BIT, "transfer source"},
    {VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_FORMAT_FEATURE_TRANSFER_DST_BIT, "transfer target"},
};

static bool report_usage(struct wd_gpu *gpu, const struct wd_image_params *params,
                         VkImageUsageFlags usage)
{
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(gpu->physical_device, params->format, &properties);
    for (size_t i = 0; i < sizeof usages / sizeof usages[0]; i++) {
        if (!(usage & usages[i].usage) ||
            (properties.optimalTilingFeatures & usages[i].feature))
            continue;
        return wd_error(gpu->log, "image \"%s\": \"%s\" cannot use format %s (VkFormat %d) as %s",
                        params->name, gpu->properties.deviceName, wd_format_name(params->format),
                        (int)params->format, usages[i].name);
    }
    return wd_error(gpu->log, "image \"%s\": \"%s\" cannot use format %s (VkFormat %d) with usage "
                              "flags 0x%x together",
                    params->name, gpu->properties.deviceName, wd_format_name(params->format),
                    (int)params->format, usage);
}

/* Of two formats, each view for what its own can. */
static VkImageCreateFlags image_flags(const struct wd_image_params *params)
{
    return params->stored_as ? VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT
                             : 0;
}

static bool check_image(struct wd_gpu *gpu, const struct wd_image_params *params,
                        const struct wd_image *image, VkImageUsageFlags usage)
{
    if (wd_format_texel_bytes(params->format) == 0) {
        return wd_error(gpu->log, "image \"%s\": VkFormat %d is not among the renderer's formats",
                        params->name, (int)params->format);
    }
    VkImageFormatProperties can;
    VkResult result = vkGetPhysicalDeviceImageFormatProperties(
        gpu->physical_device, params->format, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL, usage,
        image_flags(params), &can);
    if (result == VK_ERROR_FORMAT_NOT_SUPPORTED)
        return report_usage(gpu, params, usage);
    if (!wd_gpu_check(gpu, result, params->name))
        return false;
    if (image->width == 0 || image->height == 0 || image->width > can.maxExtent.width ||
        image->height > can.maxExtent.height || image->layers > can.maxArrayLayers ||
        image->mips > can.maxMipLevels) {
        return wd_error(gpu->log, "image \"%s\" of %ux%u with %u layers and %u mips: \"%s\" allows "
                                  "1x1 to %ux%u, %u layers and %u mips in %s",
                        params->name, image->width, image->height, image->layers, image->mips,
                        gpu->properties.deviceName, can.maxExtent.width, can.maxExtent.height,
                        can.maxArrayLayers, can.maxMipLevels, wd_format_name(params->format));
    }
    return true;
}

struct view_kind {
    VkImageViewType type;
    VkFormat format;
    VkImageUsageFlags usage; /* 0: all of the image's */
};

static VkResult create_view(struct wd_gpu *gpu, const struct wd_image *image,
                            const struct view_kind *kind, const VkImageSubresourceRange *range,
                            VkImageView *view)
{
    const VkImageViewUsageCreateInfo usage = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_USAGE_CREATE_INFO,
        .usage = kind->usage,
    };
    const VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .pNext = kind->usage ? &usage : NULL,
        .image = image->image,
        .viewType = kind->type,
        .format = kind->format,
        .subresourceRange = *range,
    };
    VkResult result = vkCreateImageView(gpu->device, &info, NULL, view);
    if (result != VK_SUCCESS)
        *view = VK_NULL_HANDLE;
    return result;
}

static VkImageViewType whole_type(const struct wd_image *image, enum wd_image_view_kind kind)
{
    bool array = image->layers > 1 || kind == WD_IMAGE_ARRAY;
    return array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
}

static bool create_whole_view(struct wd_gpu *gpu, const struct wd_image *image,
                              const struct view_kind *kind, const char *name, VkImageView *view)
{
    const VkImageSubresourceRange range = {image->aspect, 0, image->mips, 0, image->layers};
    VkResult result = create_view(gpu, image, kind, &range, view);
    if (result == VK_SUCCESS) {
        wd_set_object_name(gpu, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)(uintptr_t)*view, name);
        return true;
    }
    char *what = wd_format("view of image \"%s\"", name);
    wd_gpu_check(gpu, result, what);
    free(what);
    return false;
}

static bool create_whole_views(struct wd_gpu *gpu, struct wd_image *image,
                               const struct wd_image_params *params)
{
    VkImageViewType type = whole_type(image, params->view);
    const struct view_kind own = {type, image->format, params->stored_as ? params->usage : 0};
    const struct view_kind stored = {type, params->stored_as, VK_IMAGE_USAGE_STORAGE_BIT};
    return create_whole_view(gpu, image, &own, params->name, &image->view) &&
           (!params->stored_as ||
            create_whole_view(gpu, image, &stored, params->name, &image->stored));
}

uint32_t wd_image_odd_side(uint32_t side)
{
    while ((side & (side - 1)) == 0)
        side++;
    return side;
}

static uint32_t side_of(const struct wd_gpu *gpu, const struct wd_image_params *params, uint32_t side)
{
    bool may = params->by_texel && gpu->software && side < gpu->properties.limits.maxImageDimension2D;
    return may ? wd_image_odd_side(side) : side;
}

static bool create_image(struct wd_image *image, struct wd_gpu *gpu,
                         const struct wd_image_params *params, VkImageUsageFlags usage)
{
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .flags = image_flags(params),
        .imageType = VK_IMAGE_TYPE_2D,
        .format = image->format,
        .extent = {side_of(gpu, params, image->width), side_of(gpu, params, image->height), 1},
        .mipLevels = image->mips,
        .arrayLayers = image->layers,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = usage,
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
    };
    VkResult result = vkCreateImage(gpu->device, &info, NULL, &image->image);
    if (result != VK_SUCCESS) {
        image->image = VK_NULL_HANDLE;
        return wd_gpu_check(gpu, result, params->name);
    }
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(gpu->device, image->image, &needs);
    if (!wd_allocate(gpu, &needs, WD_MEMORY_DEVICE, params->name, &image->memory))
        return false;
    image->memory_size = needs.size;
    result = vkBindImageMemory(gpu->device, image->image, image->memory, 0);
    return wd_gpu_check(gpu, result, params->name);
}

static uint32_t mip_count(uint32_t width, uint32_t height)
{
    uint32_t count = 1;
    for (uint32_t size = width > height ? width : height; size > 1; size /= 2)
        count++;
    return count;
}

bool wd_image_init(struct wd_image *image, struct wd_gpu *gpu, const struct wd_image_params *params)
{
    *image = (struct wd_image){
        .format = params->format,
        .aspect = wd_format_aspect(params->format),
        .width = params->width,
        .height = params->height,
        .layers = params->layers ? params->layers : 1,
        .mips = params->mips ? params->mips : 1,
    };
    if (params->mips == WD_ALL_MIPS)
        image->mips = mip_count(params->width, params->height);
    assert(!params->by_texel || image->mips == 1);
    VkImageUsageFlags usage =
        params->usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
        (params->stored_as ? VK_IMAGE_USAGE_STORAGE_BIT : 0);
    if (gpu->lost || !check_image(gpu, params, image, usage) ||
        !create_image(image, gpu, params, usage)) {
        wd_image_finish(image, gpu);
        return false;
    }
    wd_set_object_name(gpu, VK_OBJECT_TYPE_IMAGE, (uint64_t)(uintptr_t)image->image, params->name);
    const VkImageUsageFlags viewable =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if ((usage & viewable) && !create_whole_views(gpu, image, params)) {
        wd_image_finish(image, gpu);
        return false;
    }
    return true;
}

void wd_image_finish(struct wd_image *image, struct wd_gpu *gpu)
{
    if (image->view)
        vkDestroyImageView(gpu->device, image->view, NULL);
    if (image->stored)
        vkDestroyImageView(gpu->device, image->stored, NULL);
    if (image->image)
        vkDestroyImage(gpu->device, image->image, NULL);
    wd_free_memory(gpu, image->memory, image->memory_size);
    *image = (struct wd_image){0};
}

bool wd_image_layer_view(struct wd_gpu *gpu, const struct wd_image *image, uint32_t layer,
                         uint32_t mip, VkImageView *view)
{
    assert(layer < image->layers && mip < image->mips);
    const VkImageSubresourceRange range = {image->aspect, mip, 1, layer, 1};
    const struct view_kind kind = {VK_IMAGE_VIEW_TYPE_2D, image->format, 0};
    VkResult result = create_view(gpu, image, &kind, &range, view);
    return wd_gpu_check(gpu, result, "view of an image layer");
}
