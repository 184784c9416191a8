#include "gpu/pipeline.h"

bool wd_sampler_init(VkSampler *sampler, struct wd_gpu *gpu, enum wd_sampler_kind kind)
{
    bool trilinear = kind == WD_SAMPLER_TRILINEAR_CLAMP || kind == WD_SAMPLER_TRILINEAR_REPEAT;
    bool repeat = kind == WD_SAMPLER_LINEAR_REPEAT || kind == WD_SAMPLER_TRILINEAR_REPEAT;
    bool shadow = kind == WD_SAMPLER_SHADOW;
    VkFilter filter = kind == WD_SAMPLER_NEAREST_CLAMP ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    VkSamplerAddressMode address = repeat   ? VK_SAMPLER_ADDRESS_MODE_REPEAT
                                   : shadow ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER
                                            : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    float most = gpu->properties.limits.maxSamplerAnisotropy;
    /* llvmpipe walks the footprint's whole ellipse for each sample: seconds a frame at low angles */
    bool stretched = trilinear && !gpu->software && (gpu->features & WD_GPU_FEATURE_ANISOTROPY);
    const VkSamplerCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = filter,
        .minFilter = kind == WD_SAMPLER_MAGNIFY_CLAMP ? VK_FILTER_NEAREST : filter,
        .mipmapMode = trilinear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST,
        .addressModeU = address,
        .addressModeV = address,
        .addressModeW = address,
        .anisotropyEnable = stretched,
        .maxAnisotropy = most < 8 ? most : 8,
        .compareEnable = shadow,
        .compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL,
        .maxLod = VK_LOD_CLAMP_NONE,
        .borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK,
    };
    VkResult result = vkCreateSampler(gpu->device, &info, NULL, sampler);
    if (result != VK_SUCCESS)
        *sampler = VK_NULL_HANDLE;
    return wd_gpu_check(gpu, result, "vkCreateSampler");
}
