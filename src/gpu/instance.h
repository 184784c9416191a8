/* instance.h: the Vulkan instance and its validation messages. */
#ifndef WD_GPU_INSTANCE_H
#define WD_GPU_INSTANCE_H

#include "gpu/device.h"

/* Makes gpu->instance (and gpu->messenger with validation). Needs gpu->log. `*debug_utils`: the
 * instance has VK_EXT_debug_utils. */
bool wd_instance_init(struct wd_gpu *gpu, const struct wd_gpu_params *params, bool *debug_utils);
void wd_instance_finish(struct wd_gpu *gpu);

#endif
