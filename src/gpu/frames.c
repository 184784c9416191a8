#include "gpu/frames.h"

#include <assert.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/memory.h"
#include "gpu/deferred.h"
#include "gpu/timers.h"

static VkResult create_slot(struct wd_frame_slot *slot, struct wd_gpu *gpu)
{
    const VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = gpu->queue_family,
    };
    VkResult result = vkCreateCommandPool(gpu->device, &pool, NULL, &slot->pool);
    if (result != VK_SUCCESS)
        return result;
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = slot->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    result = vkAllocateCommandBuffers(gpu->device, &commands, &slot->commands);
    if (result != VK_SUCCESS)
        return result;
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    result = vkCreateFence(gpu->device, &fence, NULL, &slot->fence);
    if (result != VK_SUCCESS || !(gpu->features & WD_GPU_FEATURE_TIMESTAMPS))
        return result;
    const VkQueryPoolCreateInfo queries = {
        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
        .queryType = VK_QUERY_TYPE_TIMESTAMP,
        .queryCount = 2 * WD_MAX_SCOPES,
    };
    return vkCreateQueryPool(gpu->device, &queries, NULL, &slot->queries);
}

static void finish_slot(struct wd_frame_slot *slot, struct wd_gpu *gpu)
{
    wd_deferred_free(slot, gpu);
    wd_descriptors_finish(slot, gpu);
    if (slot->upload)
        wd_buffer_finish(slot->upload, gpu);
    free(slot->upload);
    free(slot->barriers);
    vkDestroyQueryPool(gpu->device, slot->queries, NULL);
    vkDestroyFence(gpu->device, slot->fence, NULL);
    vkDestroyCommandPool(gpu->device, slot->pool, NULL);
    *slot = (struct wd_frame_slot){0};
}

bool wd_frames_init(struct wd_frames *frames, struct wd_gpu *gpu)
{
    *frames = (struct wd_frames){.gpu = gpu};
    if (gpu->lost)
        return false;
    for (int i = 0; i < WD_FRAMES_IN_FLIGHT; i++) {
        VkResult result = create_slot(&frames->slots[i], gpu);
        if (!wd_gpu_check(gpu, result, "creating the frames in flight")) {
            wd_frames_finish(frames);
            return false;
        }
    }
    return true;
}

static bool wait_slot(struct wd_frames *frames, struct wd_frame_slot *slot)
{
    struct wd_gpu *gpu = frames->gpu;
    if (!slot->pending)
        return true;
    VkResult result = vkWaitForFences(gpu->device, 1, &slot->fence, VK_TRUE, UINT64_MAX);
    slot->pending = false;
    if (!wd_gpu_check(gpu, result, "waiting for a frame"))
        return false;
    wd_timers_collect(frames, slot);
    return true;
}

bool wd_frames_wait(struct wd_frames *frames)
{
    bool ok = !frames->gpu->lost;
    for (uint32_t i = 0; i < WD_FRAMES_IN_FLIGHT; i++) {
        uint32_t oldest = (frames->next + i) % WD_FRAMES_IN_FLIGHT;
        ok = wait_slot(frames, &frames->slots[oldest]) && ok;
    }
    return ok;
}

void wd_frames_finish(struct wd_frames *frames)
{
    if (!frames->gpu)
        return;
    wd_frames_wait(frames);
    for (int i = 0; i < WD_FRAMES_IN_FLIGHT; i++)
        finish_slot(&frames->slots[i], frames->gpu);
    *frames = (struct wd_frames){0};
}

static VkResult restart_commands(struct wd_frame_slot *slot, struct wd_gpu *gpu)
{
    VkResult result = vkResetCommandPool(gpu->device, slot->pool, 0);
    if (result != VK_SUCCESS)
        return result;
    const VkCommandBufferBeginInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    slot->barrier_count = 0;
    return vkBeginCommandBuffer(slot->commands, &info);
}

bool wd_frame_begin(struct wd_frames *frames, struct wd_cmd *cmd)
{
    struct wd_gpu *gpu = frames->gpu;
    struct wd_frame_slot *slot = &frames->slots[frames->next];
    *cmd = (struct wd_cmd){.gpu = gpu, .frames = frames, .slot = slot, .vk = slot->commands};
    if (gpu->lost || !wait_slot(frames, slot))
        return false;
    wd_deferred_free(slot, gpu);
    slot->upload_used = 0;
    if (!wd_descriptors_reset(slot, gpu) ||
        !wd_gpu_check(gpu, restart_commands(slot, gpu), "beginning a frame"))
        return false;
    wd_timers_begin_frame(cmd);
    return true;
}

void wd_frame_barrier(struct wd_cmd *cmd, const struct wd_barrier *barrier)
{
    struct wd_frame_slot *slot = cmd->slot;
    wd_barrier_record(cmd->vk, barrier);
    *wd_push(slot->barriers, slot->barrier_count, slot->barrier_capacity) = *barrier;
    cmd->recorded = true;
}

static VkResult submit(struct wd_gpu *gpu, struct wd_frame_slot *slot, VkSemaphore wait,
                       VkSemaphore signal)
{
    VkResult result = vkEndCommandBuffer(slot->commands);
    if (result == VK_SUCCESS)
        result = vkResetFences(gpu->device, 1, &slot->fence);
    if (result != VK_SUCCESS)
        return result;
    const VkCommandBufferSubmitInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
        .commandBuffer = slot->commands,
    };
    const VkSemaphoreSubmitInfo before = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
        .semaphore = wait,
        .stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, /* all else may begin before */
    };
    const VkSemaphoreSubmitInfo after = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
        .semaphore = signal,
        .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    };
    const VkSubmitInfo2 info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
        .waitSemaphoreInfoCount = wait ? 1 : 0,
        .pWaitSemaphoreInfos = &before,
        .commandBufferInfoCount = 1,
        .pCommandBufferInfos = &commands,
        .signalSemaphoreInfoCount = signal ? 1 : 0,
        .pSignalSemaphoreInfos = &after,
    };
    return vkQueueSubmit2(gpu->queue, 1, &info, slot->fence);
}

double wd_frame_run_now(struct wd_cmd *cmd)
{
    struct wd_gpu *gpu = cmd->gpu;
    struct wd_frame_slot *slot = cmd->slot;
    if (cmd->failed || gpu->lost)
        return 0;
    double start_s = wd_clock_s();
    VkResult result = submit(gpu, slot, VK_NULL_HANDLE, VK_NULL_HANDLE);
    if (result == VK_SUCCESS)
        result = vkWaitForFences(gpu->device, 1, &slot->fence, VK_TRUE, UINT64_MAX);
    double elapsed_s = wd_clock_s() - start_s;
    cmd->waited_s += elapsed_s;
    if (result == VK_SUCCESS)
        result = restart_commands(slot, gpu);
    cmd->recorded = false;
    if (!wd_gpu_check(gpu, result, "running a scope of a frame"))
        cmd->failed = true;
    return elapsed_s;
}

/* Tracked uses have advanced as if the frame had run. Its barriers alone make them true. */
static void abandon(struct wd_cmd *cmd, VkSemaphore wait)
{
    struct wd_gpu *gpu = cmd->gpu;
    struct wd_frame_slot *slot = cmd->slot;
    slot->scope_count = 0;
    if (gpu->lost)
        return;
    size_t count = slot->barrier_count;
    VkResult result = restart_commands(slot, gpu);
    if (result == VK_SUCCESS) {
        for (size_t i = 0; i < count; i++)
            wd_barrier_record(slot->commands, &slot->barriers[i]);
        result = submit(gpu, slot, wait, VK_NULL_HANDLE);
    }
    if (result == VK_SUCCESS)
        result = vkWaitForFences(gpu->device, 1, &slot->fence, VK_TRUE, UINT64_MAX);
    wd_gpu_check(gpu, result, "abandoning a frame");
}

bool wd_frame_submit(struct wd_cmd *cmd, VkSemaphore wait, VkSemaphore signal)
{
    assert(cmd->failed || (!cmd->rendering && cmd->scope_depth == 0));
    struct wd_gpu *gpu = cmd->gpu;
    if (!cmd->failed && !gpu->lost) {
        VkResult result = submit(gpu, cmd->slot, wait, signal);
        if (result == VK_SUCCESS) {
            cmd->slot->pending = true;
            cmd->frames->next = (cmd->frames->next + 1) % WD_FRAMES_IN_FLIGHT;
            return true;
        }
        wd_gpu_check(gpu, result, "submitting a frame");
    }
    abandon(cmd, wait);
    return false;
}
