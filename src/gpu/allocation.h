/* allocation.h: one VkDeviceMemory for one object, counted. */
#ifndef WD_GPU_ALLOCATION_H
#define WD_GPU_ALLOCATION_H

#include "gpu/memory.h"

/* Allocates what `needs` asks for, in the best memory type that has room. `name`: for errors. */
bool wd_allocate(struct wd_gpu *gpu, const VkMemoryRequirements *needs,
                 enum wd_gpu_memory_kind kind, const char *name, VkDeviceMemory *memory);
/* `size` as in the requirements. Accepts VK_NULL_HANDLE. */
void wd_free_memory(struct wd_gpu *gpu, VkDeviceMemory memory, VkDeviceSize size);

/* Logs that `name` of `size` bytes does not fit; returns false. */
bool wd_report_no_memory(struct wd_gpu *gpu, const char *name, uint64_t size);

/* Names an object for debuggers and validation messages. */
void wd_set_object_name(struct wd_gpu *gpu, VkObjectType type, uint64_t handle, const char *name);

#endif
