#include "gpu/allocation.h"

#include "base/log.h"

static double mebibytes(uint64_t bytes)
{
    return (double)bytes / (1 << 20);
}

static uint64_t device_heap_bytes(const struct wd_gpu *gpu)
{
    uint64_t largest = 0;
    for (uint32_t i = 0; i < gpu->memory.memoryHeapCount; i++) {
        if (gpu->memory.memoryHeaps[i].size > largest)
            largest = gpu->memory.memoryHeaps[i].size;
    }
    return largest;
}

bool wd_report_no_memory(struct wd_gpu *gpu, const char *name, uint64_t size)
{
    gpu->no_memory = true;
    return wd_error(gpu->log, "out of device memory: \"%s\" wants %.1f MiB, %.1f MiB are held "
                              "already, \"%s\" has %.1f MiB in all",
                    name, mebibytes(size), mebibytes(gpu->bytes_allocated),
                    gpu->properties.deviceName, mebibytes(device_heap_bytes(gpu)));
}

/* A software device hands out more than the machine has and the process dies later. */
static bool heap_has_room(const struct wd_gpu *gpu, uint32_t heap, uint64_t size)
{
    uint64_t capacity = gpu->memory.memoryHeaps[heap].size;
    if (size > capacity)
        return false;
    return !gpu->software || gpu->bytes_allocated <= capacity - size;
}

static VkResult allocate_with(struct wd_gpu *gpu, const VkMemoryRequirements *needs,
                              VkMemoryPropertyFlags wanted, VkDeviceMemory *memory)
{
    const VkMemoryPropertyFlags known =
        VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
        VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    for (uint32_t i = 0; i < gpu->memory.memoryTypeCount; i++) {
        const VkMemoryType *type = &gpu->memory.memoryTypes[i];
        bool fits = (needs->memoryTypeBits >> i & 1) &&
                    (type->propertyFlags & wanted) == wanted && !(type->propertyFlags & ~known);
        if (!fits || !heap_has_room(gpu, type->heapIndex, needs->size))
            continue;
        const VkMemoryAllocateInfo info = {
            .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
            .allocationSize = needs->size,
            .memoryTypeIndex = i,
        };
        result = vkAllocateMemory(gpu->device, &info, NULL, memory);
        if (result != VK_ERROR_OUT_OF_DEVICE_MEMORY)
            return result;
    }
    return result;
}

static bool report_failure(struct wd_gpu *gpu, VkResult result, const char *name, uint64_t size)
{
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        return wd_report_no_memory(gpu, name, size);
    return wd_gpu_check(gpu, result, name);
}

bool wd_allocate(struct wd_gpu *gpu, const VkMemoryRequirements *needs,
                 enum wd_gpu_memory_kind kind, const char *name, VkDeviceMemory *memory)
{
    const VkMemoryPropertyFlags mapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags wishes[][2] = {
        [WD_MEMORY_DEVICE] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0},
        [WD_MEMORY_UPLOAD] = {mapped, mapped},
        [WD_MEMORY_READBACK] = {mapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, mapped},
    };
    *memory = VK_NULL_HANDLE;
    uint32_t limit = gpu->properties.limits.maxMemoryAllocationCount;
    if (gpu->allocation_count >= limit) {
        return wd_error(gpu->log, "\"%s\" would be GPU object %u, but \"%s\" allows only %u "
                                  "separate allocations",
                        name, gpu->allocation_count + 1, gpu->properties.deviceName, limit);
    }
    VkResult result = allocate_with(gpu, needs, wishes[kind][0], memory);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
        result = allocate_with(gpu, needs, wishes[kind][1], memory);
    if (result != VK_SUCCESS) {
        *memory = VK_NULL_HANDLE;
        return report_failure(gpu, result, name, needs->size);
    }
    gpu->allocation_count++;
    gpu->bytes_allocated += needs->size;
    if (gpu->bytes_allocated > gpu->bytes_peak)
        gpu->bytes_peak = gpu->bytes_allocated;
    return true;
}

void wd_free_memory(struct wd_gpu *gpu, VkDeviceMemory memory, VkDeviceSize size)
{
    if (!memory)
        return;
    vkFreeMemory(gpu->device, memory, NULL);
    gpu->allocation_count--;
    gpu->bytes_allocated -= size;
}

void wd_set_object_name(struct wd_gpu *gpu, VkObjectType type, uint64_t handle, const char *name)
{
    if (!gpu->set_name || !name)
        return;
    const VkDebugUtilsObjectNameInfoEXT info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
        .objectType = type,
        .objectHandle = handle,
        .pObjectName = name,
    };
    gpu->set_name(gpu->device, &info);
}
