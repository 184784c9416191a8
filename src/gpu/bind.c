#include <assert.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/log.h"
#include "base/memory.h"
#include "gpu/frames.h"
#include "gpu/pipeline_parts.h"

enum { SETS_PER_POOL = 128, DESCRIPTORS_PER_TYPE = 512 };

static bool add_pool(struct wd_frame_slot *slot, struct wd_gpu *gpu)
{
    static const VkDescriptorType types[] = {
        VK_DESCRIPTOR_TYPE_SAMPLER,        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,  VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
    };
    enum { TYPE_COUNT = sizeof types / sizeof types[0] };
    VkDescriptorPoolSize sizes[TYPE_COUNT];
    for (int i = 0; i < TYPE_COUNT; i++)
        sizes[i] = (VkDescriptorPoolSize){types[i], DESCRIPTORS_PER_TYPE};
    const VkDescriptorPoolCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = SETS_PER_POOL,
        .poolSizeCount = TYPE_COUNT,
        .pPoolSizes = sizes,
    };
    VkDescriptorPool pool;
    VkResult result = vkCreateDescriptorPool(gpu->device, &info, NULL, &pool);
    if (!wd_gpu_check(gpu, result, "vkCreateDescriptorPool"))
        return false;
    *wd_push(slot->descriptor_pools, slot->descriptor_pool_count,
             slot->descriptor_pool_capacity) = pool;
    return true;
}

/* Sets come from pool used - 1; the pools before it are full. Drivers may hand out more sets than
 * a pool was made for, so they are counted here. */
static VkDescriptorSet allocate_set(struct wd_cmd *cmd, VkDescriptorSetLayout layout)
{
    struct wd_frame_slot *slot = cmd->slot;
    VkDescriptorSetAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorSetCount = 1,
        .pSetLayouts = &layout,
    };
    VkDescriptorSet set = VK_NULL_HANDLE;
    if (slot->descriptor_pool_used > 0 && slot->descriptor_sets_used < SETS_PER_POOL) {
        info.descriptorPool = slot->descriptor_pools[slot->descriptor_pool_used - 1];
        slot->descriptor_sets_used++;
        if (vkAllocateDescriptorSets(cmd->gpu->device, &info, &set) == VK_SUCCESS)
            return set;
    }
    if (slot->descriptor_pool_used == slot->descriptor_pool_count && !add_pool(slot, cmd->gpu))
        return VK_NULL_HANDLE;
    info.descriptorPool = slot->descriptor_pools[slot->descriptor_pool_used++];
    slot->descriptor_sets_used = 1;
    VkResult result = vkAllocateDescriptorSets(cmd->gpu->device, &info, &set);
    return wd_gpu_check(cmd->gpu, result, "vkAllocateDescriptorSets") ? set : VK_NULL_HANDLE;
}

bool wd_descriptors_reset(struct wd_frame_slot *slot, struct wd_gpu *gpu)
{
    for (size_t i = 0; i < slot->descriptor_pool_used; i++) {
        VkResult result = vkResetDescriptorPool(gpu->device, slot->descriptor_pools[i], 0);
        if (!wd_gpu_check(gpu, result, "vkResetDescriptorPool"))
            return false;
    }
    slot->descriptor_pool_used = slot->descriptor_sets_used = 0;
    return true;
}

void wd_descriptors_finish(struct wd_frame_slot *slot, struct wd_gpu *gpu)
{
    for (size_t i = 0; i < slot->descriptor_pool_count; i++)
        vkDestroyDescriptorPool(gpu->device, slot->descriptor_pools[i], NULL);
    free(slot->descriptor_pools);
    slot->descriptor_pools = NULL;
    slot->descriptor_pool_count = slot->descriptor_pool_used = slot->descriptor_pool_capacity = 0;
}

static bool is_buffer(VkDescriptorType type)
{
    return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

static bool is_texels(VkDescriptorType type)
{
    return type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER ||
           type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
}

static bool describe_buffer(struct wd_cmd *cmd, const struct wd_binding *binding,
                            VkDescriptorType type, uint32_t slot, VkDescriptorBufferInfo *info)
{
    assert(binding->buffer && binding->buffer->buffer && binding->offset < binding->buffer->size);
    const VkPhysicalDeviceLimits *limits = &cmd->gpu->properties.limits;
    uint64_t most = type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? limits->maxUniformBufferRange
                                                              : limits->maxStorageBufferRange;
    VkDeviceSize rest = binding->buffer->size - binding->offset;
    VkDeviceSize size = binding->size ? binding->size : rest;
    assert(size <= rest);
    if (size > most) {
        return wd_error(cmd->gpu->log, "binding %u is %llu bytes long; \"%s\" lets a shader see "
                                       "at most %llu bytes of one %s buffer",
                        slot, (unsigned long long)size, cmd->gpu->properties.deviceName,
                        (unsigned long long)most,
                        type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? "uniform" : "storage");
    }
    *info = (VkDescriptorBufferInfo){binding->buffer->buffer, binding->offset, size};
    return true;
}

static VkDescriptorImageInfo describe_image(const struct wd_binding *binding, VkDescriptorType type)
{
    bool storage = type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    bool with_sampler = type == VK_DESCRIPTOR_TYPE_SAMPLER ||
                        type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    assert(binding->view || type == VK_DESCRIPTOR_TYPE_SAMPLER);
    assert(binding->sampler || !with_sampler);
    VkImageLayout usual =
        storage ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return (VkDescriptorImageInfo){
        .sampler = with_sampler ? binding->sampler : VK_NULL_HANDLE,
        .imageView = binding->view,
        .imageLayout = binding->layout ? binding->layout : usual,
    };
}

static bool write_set(struct wd_cmd *cmd, VkDescriptorSet set, const struct wd_bindings *types,
                      const struct wd_binding *bindings)
{
    VkWriteDescriptorSet writes[WD_MAX_BINDINGS];
    VkDescriptorBufferInfo buffers[WD_MAX_BINDINGS];
    VkDescriptorImageInfo images[WD_MAX_BINDINGS];
    for (uint32_t i = 0; i < types->count; i++) {
        VkDescriptorType type = types->types[i];
        assert(!is_texels(type) || bindings[i].buffer->texels);
        /* the wait for a transfer makes nothing visible to shaders: a use must have been declared since */
        assert(!bindings[i].buffer || bindings[i].buffer->last_use != WD_USE_TRANSFER_WRITE);
        if (is_texels(type))
            images[i] = (VkDescriptorImageInfo){0};
        else if (!is_buffer(type))
            images[i] = describe_image(&bindings[i], type);
        else if (!describe_buffer(cmd, &bindings[i], type, i, &buffers[i]))
            return false;
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = set,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = type,
            .pBufferInfo = &buffers[i],
            .pImageInfo = &images[i],
            .pTexelBufferView = bindings[i].buffer ? &bindings[i].buffer->texels : NULL,
        };
    }
    vkUpdateDescriptorSets(cmd->gpu->device, types->count, writes, 0, NULL);
    return true;
}

static bool bind_set(struct wd_cmd *cmd, const struct wd_pipeline *pipeline,
                     const struct wd_binding *bindings)
{
    VkDescriptorSet set = allocate_set(cmd, pipeline->set_layout);
    if (!set || !write_set(cmd, set, &pipeline->bindings, bindings))
        return false;
    vkCmdBindDescriptorSets(cmd->vk, pipeline->bind_point, pipeline->layout, 0, 1, &set, 0, NULL);
    return true;
}

/* Makes it where it has not been yet; VK_NULL_HANDLE, with a message, on failure. */
static VkPipeline made_now(struct wd_gpu *gpu, const struct wd_pipeline *pipeline)
{
    VkPipeline made = wd_pipeline_made(pipeline);
    if (made)
        return made;
    double clock_s = wd_clock_s(), processor_s = wd_processor_s();
    wd_pipeline_make(pipeline, gpu);
    gpu->making_s += wd_clock_s() - clock_s;
    gpu->making_processor_s += wd_processor_s() - processor_s;
    return wd_pipeline_made(pipeline);
}

void wd_cmd_bind(struct wd_cmd *cmd, const struct wd_pipeline *pipeline,
                 const struct wd_binding *bindings)
{
    if (cmd->failed)
        return;
    VkPipeline made = made_now(cmd->gpu, pipeline);
    cmd->failed = !made;
    if (cmd->failed)
        return;
    cmd->recorded = true;
    vkCmdBindPipeline(cmd->vk, pipeline->bind_point, made);
    if (pipeline->bindings.count > 0 && !bind_set(cmd, pipeline, bindings))
        cmd->failed = true;
}

void wd_cmd_push(struct wd_cmd *cmd, const struct wd_pipeline *pipeline, const void *data,
                 uint32_t size)
{
    assert(size <= pipeline->push_size);
    if (!cmd->failed)
        vkCmdPushConstants(cmd->vk, pipeline->layout, wd_pipeline_stages(pipeline), 0, size, data);
}
