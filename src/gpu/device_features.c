#include "gpu/device_features.h"

#include <stdlib.h>

#include "base/memory.h"

struct feature {
    const char *name;
    size_t offset; /* of a VkBool32 in struct wd_feature_set */
    uint32_t bit;  /* wd_gpu_feature; 0: required */
};

#define FEATURE(part, member, feature_bit)                                                         \
    {#member, offsetof(struct wd_feature_set, part.member), feature_bit}

/* terminate and demote: what glslc makes of `discard` in SPIR-V 1.6. maintenance4: LocalSizeId. */
static const struct feature all_features[] = {
    FEATURE(base.features, independentBlend, 0),
    FEATURE(base.features, fragmentStoresAndAtomics, 0),
    FEATURE(v12, scalarBlockLayout, 0),
    FEATURE(v13, dynamicRendering, 0),
    FEATURE(v13, synchronization2, 0),
    FEATURE(v13, maintenance4, 0),
    FEATURE(v13, shaderTerminateInvocation, 0),
    FEATURE(v13, shaderDemoteToHelperInvocation, 0),
    FEATURE(base.features, shaderInt64, WD_GPU_FEATURE_INT64_ATOMICS),
    FEATURE(v12, shaderBufferInt64Atomics, WD_GPU_FEATURE_INT64_ATOMICS),
    FEATURE(base.features, samplerAnisotropy, WD_GPU_FEATURE_ANISOTROPY),
    FEATURE(base.features, textureCompressionBC, WD_GPU_FEATURE_BLOCKS),
    FEATURE(base.features, shaderStorageImageExtendedFormats, WD_GPU_FEATURE_STORED_TARGETS),
};
enum { FEATURE_COUNT = sizeof all_features / sizeof all_features[0] };

static VkBool32 *member(struct wd_feature_set *set, const struct feature *feature)
{
    return (VkBool32 *)((char *)set + feature->offset);
}

static bool has(const struct wd_feature_set *set, const struct feature *feature)
{
    return *(const VkBool32 *)((const char *)set + feature->offset);
}

static void link_structs(VkPhysicalDeviceFeatures2 *features,
                         VkPhysicalDeviceVulkan12Features *features12,
                         VkPhysicalDeviceVulkan13Features *features13)
{
    *features13 = (VkPhysicalDeviceVulkan13Features){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
    };
    *features12 = (VkPhysicalDeviceVulkan12Features){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
        .pNext = features13,
    };
    *features = (VkPhysicalDeviceFeatures2){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
        .pNext = features12,
    };
}

void wd_features_query(struct wd_feature_set *set, VkPhysicalDevice device)
{
    link_structs(&set->base, &set->v12, &set->v13);
    vkGetPhysicalDeviceFeatures2(device, &set->base);
}

void wd_features_choose(struct wd_feature_set *set, uint32_t bits)
{
    link_structs(&set->base, &set->v12, &set->v13);
    for (int i = 0; i < FEATURE_COUNT; i++) {
        if (!all_features[i].bit || (all_features[i].bit & bits))
            *member(set, &all_features[i]) = VK_TRUE;
    }
}

void wd_gpu_required_features(VkPhysicalDeviceFeatures2 *features,
                              VkPhysicalDeviceVulkan12Features *features12,
                              VkPhysicalDeviceVulkan13Features *features13)
{
    struct wd_feature_set set;
    wd_features_choose(&set, 0);
    link_structs(features, features12, features13);
    features->features = set.base.features;
    set.v12.pNext = features12->pNext;
    *features12 = set.v12;
    set.v13.pNext = NULL;
    *features13 = set.v13;
}

char *wd_features_missing(const struct wd_feature_set *supported)
{
    char *names = NULL;
    for (int i = 0; i < FEATURE_COUNT; i++) {
        if (all_features[i].bit || has(supported, &all_features[i]))
            continue;
        char *longer = names ? wd_format("%s, %s", names, all_features[i].name)
                             : wd_strdup(all_features[i].name);
        free(names);
        names = longer;
    }
    return names;
}

uint32_t wd_features_optional(const struct wd_feature_set *supported)
{
    uint32_t bits = 0, lacking = 0;
    for (int i = 0; i < FEATURE_COUNT; i++) {
        bits |= all_features[i].bit;
        if (!has(supported, &all_features[i]))
            lacking |= all_features[i].bit;
    }
    return bits & ~lacking;
}
