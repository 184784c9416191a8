/* select.h: the physical devices of an instance and the choice among them. */
#ifndef WD_GPU_SELECT_H
#define WD_GPU_SELECT_H

#include "gpu/device.h"

struct wd_candidate {
    VkPhysicalDevice handle;
    VkPhysicalDeviceProperties properties;
    uint32_t queue_family;
    uint32_t timestamp_bits;
    uint32_t optional; /* wd_gpu_feature bits that come from device features */
    char *problem;     /* why it cannot be used, or NULL */
};

/* Reads what one device can do; free() candidate->problem. */
void wd_candidate_init(struct wd_candidate *candidate, VkPhysicalDevice handle);

/* In place of the family that it found: one that the caller's queue is of. */
void wd_candidate_take_family(struct wd_candidate *candidate, uint32_t family);

/* Picks by wd_gpu_params.name. The choice has no problem. */
bool wd_select_device(struct wd_candidate *choice, VkInstance instance, const char *name,
                      const struct wd_log *log);

/* "NAME (kind)" of each device, with `separator` between. free() it. */
char *wd_select_names(VkInstance instance, const char *separator);

#endif
