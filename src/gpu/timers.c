#include "gpu/timers.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "gpu/frames.h"

static const uint32_t untimed = UINT32_MAX;

static bool has_timestamps(const struct wd_gpu *gpu)
{
    return gpu->features & WD_GPU_FEATURE_TIMESTAMPS;
}

void wd_timers_begin_frame(struct wd_cmd *cmd)
{
    cmd->slot->scope_count = 0;
    cmd->timing = cmd->frames->timing;
    if (cmd->timing == WD_TIMING_ON && has_timestamps(cmd->gpu))
        vkCmdResetQueryPool(cmd->vk, cmd->slot->queries, 0, 2 * WD_MAX_SCOPES);
}

/* Runs what has been recorded since the last cut; its time belongs to every open scope. */
static void cut(struct wd_cmd *cmd)
{
    if (!cmd->recorded)
        return;
    double elapsed_us = 1e6 * wd_frame_run_now(cmd);
    for (uint32_t i = 0; i < cmd->scope_depth; i++) {
        if (cmd->scope_stack[i] != untimed)
            cmd->slot->scopes[cmd->scope_stack[i]].gpu_us += elapsed_us;
    }
}

/* Of the frame's own work. */
static double clock_s(const struct wd_cmd *cmd)
{
    return wd_clock_s() - cmd->waited_s - cmd->gpu->making_s;
}

static double processor_s(const struct wd_cmd *cmd)
{
    return wd_processor_s() - cmd->gpu->making_processor_s;
}

static void stamp(struct wd_cmd *cmd, uint32_t query)
{
    vkCmdWriteTimestamp2(cmd->vk, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, cmd->slot->queries, query);
}

static uint32_t open_scope(struct wd_cmd *cmd, const char *name)
{
    if (cmd->slot->scope_count == WD_MAX_SCOPES)
        return untimed;
    uint32_t index = cmd->slot->scope_count++;
    struct wd_scope_time *scope = &cmd->slot->scopes[index];
    *scope = (struct wd_scope_time){.depth = cmd->scope_depth};
    snprintf(scope->name, sizeof scope->name, "%s", name);
    if (has_timestamps(cmd->gpu))
        stamp(cmd, 2 * index);
    else
        cut(cmd);
    cmd->scope_processor[index] = processor_s(cmd);
    cmd->scope_start[index] = clock_s(cmd);
    return index;
}

/* Where scopes are cut a label would end in another command buffer than it began in, which Mesa 22.3's
 * llvmpipe does not survive. */
static bool has_labels(const struct wd_cmd *cmd)
{
    return cmd->gpu->begin_label && (cmd->timing != WD_TIMING_ON || has_timestamps(cmd->gpu));
}

void wd_cmd_scope_begin(struct wd_cmd *cmd, const char *name)
{
    assert(!cmd->rendering && cmd->scope_depth < WD_MAX_SCOPE_DEPTH);
    uint32_t index = cmd->timing == WD_TIMING_ON ? open_scope(cmd, name) : untimed;
    cmd->scope_stack[cmd->scope_depth++] = index;
    if (has_labels(cmd)) {
        const VkDebugUtilsLabelEXT label = {
            .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
            .pLabelName = name,
        };
        cmd->gpu->begin_label(cmd->vk, &label);
    }
}

void wd_cmd_scope_end(struct wd_cmd *cmd)
{
    assert(!cmd->rendering && cmd->scope_depth > 0);
    if (has_labels(cmd))
        cmd->gpu->end_label(cmd->vk);
    uint32_t index = cmd->scope_stack[cmd->scope_depth - 1];
    if (index != untimed) {
        cmd->slot->scopes[index].cpu_us = 1e6 * (clock_s(cmd) - cmd->scope_start[index]);
        if (has_timestamps(cmd->gpu)) {
            stamp(cmd, 2 * index + 1);
        } else {
            cut(cmd);
            cmd->slot->scopes[index].processor_us =
                1e6 * (processor_s(cmd) - cmd->scope_processor[index]);
        }
    }
    cmd->scope_depth--;
}

static void read_timestamps(struct wd_gpu *gpu, struct wd_frame_slot *slot)
{
    uint64_t ticks[2 * WD_MAX_SCOPES];
    VkResult result = vkGetQueryPoolResults(
        gpu->device, slot->queries, 0, 2 * slot->scope_count,
        2 * slot->scope_count * sizeof ticks[0], ticks, sizeof ticks[0], VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS)
        return;
    uint64_t mask = gpu->timestamp_bits >= 64 ? UINT64_MAX : (1ull << gpu->timestamp_bits) - 1;
    for (uint32_t i = 0; i < slot->scope_count; i++) {
        uint64_t elapsed = (ticks[2 * i + 1] - ticks[2 * i]) & mask;
        slot->scopes[i].gpu_us = (double)elapsed * gpu->properties.limits.timestampPeriod * 1e-3;
    }
}

void wd_timers_collect(struct wd_frames *frames, struct wd_frame_slot *slot)
{
    if (slot->scope_count && has_timestamps(frames->gpu))
        read_timestamps(frames->gpu, slot);
    memcpy(frames->last_scopes, slot->scopes, slot->scope_count * sizeof slot->scopes[0]);
    frames->last_scope_count = slot->scope_count;
}
