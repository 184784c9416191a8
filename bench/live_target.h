/* live_target.h: an image of the renderer's device to draw into live, as a viewer does. */
#ifndef WD_BENCH_LIVE_TARGET_H
#define WD_BENCH_LIVE_TARGET_H

#include "weald/vulkan.h"

struct live_target {
    struct wd_vulkan_handles vk;
    struct wd_vulkan_target target;
    VkDeviceMemory memory;
};

/* False where the device has no such image. */
bool live_target_init(struct live_target *live, const struct wd_renderer *renderer, uint32_t width,
                      uint32_t height);
/* No frame may be in flight; accepts {0}. */
void live_target_finish(struct live_target *live);

#endif
