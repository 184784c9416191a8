#include <stdint.h>

#include "base/log.h"
#include "gpu/allocation.h"

static bool create_buffer(struct wd_buffer *buffer, struct wd_gpu *gpu,
                          const struct wd_buffer_params *params)
{
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = params->size,
        .usage = params->usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 (params->texels ? VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT : 0),
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
    };
    VkResult result = vkCreateBuffer(gpu->device, &info, NULL, &buffer->buffer);
    if (result == VK_SUCCESS)
        return true;
    buffer->buffer = VK_NULL_HANDLE;
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        return wd_report_no_memory(gpu, params->name, params->size);
    return wd_gpu_check(gpu, result, params->name);
}

static bool back_buffer(struct wd_buffer *buffer, struct wd_gpu *gpu,
                        const struct wd_buffer_params *params)
{
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(gpu->device, buffer->buffer, &needs);
    if (!wd_allocate(gpu, &needs, params->memory, params->name, &buffer->memory))
        return false;
    buffer->memory_size = needs.size;
    VkResult result = vkBindBufferMemory(gpu->device, buffer->buffer, buffer->memory, 0);
    if (result == VK_SUCCESS && params->memory != WD_MEMORY_DEVICE)
        result = vkMapMemory(gpu->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->mapped);
    return wd_gpu_check(gpu, result, params->name);
}

static bool view_texels(struct wd_buffer *buffer, struct wd_gpu *gpu,
                        const struct wd_buffer_params *params)
{
    uint64_t most = gpu->properties.limits.maxTexelBufferElements;
    uint64_t count = params->size / wd_format_texel_bytes(params->texels);
    if (count > most)
        return wd_error(gpu->log, "GPU buffer \"%s\" has %llu texels; \"%s\" lets a shader fetch "
                                  "from at most %llu",
                        params->name, (unsigned long long)count, gpu->properties.deviceName,
                        (unsigned long long)most);
    const VkBufferViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
        .buffer = buffer->buffer,
        .format = params->texels,
        .range = count * wd_format_texel_bytes(params->texels),
    };
    VkResult result = vkCreateBufferView(gpu->device, &info, NULL, &buffer->texels);
    if (result != VK_SUCCESS)
        buffer->texels = VK_NULL_HANDLE;
    return wd_gpu_check(gpu, result, params->name);
}

bool wd_buffer_init(struct wd_buffer *buffer, struct wd_gpu *gpu,
                    const struct wd_buffer_params *params)
{
    *buffer = (struct wd_buffer){0};
    if (gpu->lost)
        return false;
    if (params->size == 0)
        return wd_error(gpu->log, "GPU buffer \"%s\" would be empty", params->name);
    if (params->size > gpu->max_buffer_size)
        return wd_report_no_memory(gpu, params->name, params->size);
    buffer->size = params->size;
    if (!create_buffer(buffer, gpu, params) || !back_buffer(buffer, gpu, params) ||
        (params->texels && !view_texels(buffer, gpu, params))) {
        wd_buffer_finish(buffer, gpu);
        return false;
    }
    wd_set_object_name(gpu, VK_OBJECT_TYPE_BUFFER, (uint64_t)(uintptr_t)buffer->buffer,
                       params->name);
    return true;
}

void wd_buffer_finish(struct wd_buffer *buffer, struct wd_gpu *gpu)
{
    if (buffer->texels)
        vkDestroyBufferView(gpu->device, buffer->texels, NULL);
    if (buffer->buffer)
        vkDestroyBuffer(gpu->device, buffer->buffer, NULL);
    wd_free_memory(gpu, buffer->memory, buffer->memory_size);
    *buffer = (struct wd_buffer){0};
}
