/* barriers.h: from tracked uses to the barriers still needed. */
#ifndef WD_GPU_BARRIERS_H
#define WD_GPU_BARRIERS_H

#include "gpu/memory.h"

/* One barrier as it was recorded; `image.image` or `buffer.buffer` is set. */
struct wd_barrier {
    VkImageMemoryBarrier2 image;
    VkBufferMemoryBarrier2 buffer;
};

/* Advances the tracked state to `use`. True when `*barrier`, which it fills, has to be recorded first. */
bool wd_barrier_for_buffer(struct wd_buffer *buffer, enum wd_gpu_use use,
                           struct wd_barrier *barrier);
/* Whether the old contents are still needed: the change of layout may lose them. */
enum wd_contents { WD_CONTENTS_KEEP, WD_CONTENTS_DISCARD };
bool wd_barrier_for_image(struct wd_image *image, enum wd_gpu_use use, enum wd_contents contents,
                          struct wd_barrier *barrier);

void wd_barrier_record(VkCommandBuffer commands, const struct wd_barrier *barrier);

#endif
