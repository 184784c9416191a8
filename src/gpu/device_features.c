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

static void hand_out(struct wd_feature_set *set, VkPhysicalDeviceFeatures2 *features,
                     VkPhysicalDeviceVulkan12Features *features12,
                     VkPhysicalDeviceVulkan13Features *features13)
{
    link_structs(features, features12, features13);
    features->features = set->base.features;
    set->v12.pNext = features12->pNext;
    *features12 = set->v12;
    set->v13.pNext = NULL;
    *features13 = set->v13;
}

void wd_gpu_required_features(VkPhysicalDeviceFeatures2 *features,
                              VkPhysicalDeviceVulkan12Features *features12,
                              VkPhysicalDeviceVulkan13Features *features13)
{
    struct wd_feature_set set;
    wd_features_choose(&set, 0);
    hand_out(&set, features, features12, features13);
}

void wd_gpu_wanted_features(VkPhysicalDevice device, VkPhysicalDeviceFeatures2 *features,
                            VkPhysicalDeviceVulkan12Features *features12,
                            VkPhysicalDeviceVulkan13Features *features13)
{
    struct wd_feature_set supported, set;
    wd_features_query(&supported, device);
    wd_features_choose(&set, wd_features_optional(&supported));
    hand_out(&set, features, features12, features13);
}

/* Structs of one feature that may stand in a chain for a member of ours. */
struct single {
    VkStructureType type;
    size_t offset, into; /* of the VkBool32 there and in struct wd_feature_set */
};
#define SINGLE(name, type_name, part, member)                                                      \
    {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##name##_FEATURES,                                          \
     offsetof(VkPhysicalDevice##type_name##Features, member),                                      \
     offsetof(struct wd_feature_set, part.member)}

static const struct single singles[] = {
    SINGLE(SCALAR_BLOCK_LAYOUT, ScalarBlockLayout, v12, scalarBlockLayout),
    SINGLE(SHADER_ATOMIC_INT64, ShaderAtomicInt64, v12, shaderBufferInt64Atomics),
    SINGLE(DYNAMIC_RENDERING, DynamicRendering, v13, dynamicRendering),
    SINGLE(SYNCHRONIZATION_2, Synchronization2, v13, synchronization2),
    SINGLE(MAINTENANCE_4, Maintenance4, v13, maintenance4),
    SINGLE(SHADER_TERMINATE_INVOCATION, ShaderTerminateInvocation, v13, shaderTerminateInvocation),
    SINGLE(SHADER_DEMOTE_TO_HELPER_INVOCATION, ShaderDemoteToHelperInvocation, v13,
           shaderDemoteToHelperInvocation),
};

static void take_single(struct wd_feature_set *set, const VkBaseInStructure *link)
{
    for (size_t i = 0; i < sizeof singles / sizeof singles[0]; i++) {
        if (singles[i].type == link->sType)
            *(VkBool32 *)((char *)set + singles[i].into) =
                *(const VkBool32 *)((const char *)link + singles[i].offset);
    }
}

void wd_features_read(struct wd_feature_set *set, const VkPhysicalDeviceFeatures2 *enabled)
{
    link_structs(&set->base, &set->v12, &set->v13);
    set->base.features = enabled->features;
    for (const VkBaseInStructure *link = enabled->pNext; link; link = link->pNext) {
        if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
            set->v12 = *(const VkPhysicalDeviceVulkan12Features *)link;
        else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)
            set->v13 = *(const VkPhysicalDeviceVulkan13Features *)link;
        else
            take_single(set, link);
    }
    set->v12.pNext = &set->v13;
    set->v13.pNext = NULL;
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
