/* device_features.h: which device features are needed, wanted, and there. */
#ifndef WD_GPU_DEVICE_FEATURES_H
#define WD_GPU_DEVICE_FEATURES_H

#include "gpu/device.h"

/* The structs of one feature query or device creation; wd_features_link chains them. */
struct wd_feature_set {
    VkPhysicalDeviceFeatures2 base;
    VkPhysicalDeviceVulkan12Features v12;
    VkPhysicalDeviceVulkan13Features v13;
};

/* What the physical device supports. It must be a Vulkan 1.3 device. */
void wd_features_query(struct wd_feature_set *set, VkPhysicalDevice device);
/* What a device was made with: `enabled` and all behind it, structs of single features, too. */
void wd_features_read(struct wd_feature_set *set, const VkPhysicalDeviceFeatures2 *enabled);
/* Required features plus the optional ones of `bits`. The set must not move afterwards. */
void wd_features_choose(struct wd_feature_set *set, uint32_t bits);
/* Comma-separated names of required features that `supported` lacks; NULL if none. free() it. */
char *wd_features_missing(const struct wd_feature_set *supported);
/* Optional wd_gpu_feature bits that are matters of VkPhysicalDeviceFeatures. */
uint32_t wd_features_optional(const struct wd_feature_set *supported);

#endif
