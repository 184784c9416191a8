/* transfer.h: the staging that blocking transfers share. */
#ifndef WD_GPU_TRANSFER_H
#define WD_GPU_TRANSFER_H

#include "gpu/memory.h"

struct wd_transfer {
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
    struct wd_buffer upload, readback; /* grow to at most one chunk */
};

void wd_transfer_finish(struct wd_gpu *gpu); /* frees gpu->transfer; accepts NULL there */

#endif
