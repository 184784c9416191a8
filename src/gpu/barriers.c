#include "gpu/barriers.h"

#include <assert.h>

struct use_row {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 reads, writes;
    VkImageLayout layout;
};

#define COMPUTE VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT
#define GRAPHICS (VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT)
#define DEPTH_TESTS                                                                                \
    (VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT)
#define SHADER_READS                                                                               \
    (VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |                   \
     VK_ACCESS_2_UNIFORM_READ_BIT)
#define LAYOUT(name) VK_IMAGE_LAYOUT_##name

static const struct use_row uses[WD_USE_COUNT] = {
    [WD_USE_NONE] = {0},
    [WD_USE_TRANSFER_READ] = {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                              0, LAYOUT(TRANSFER_SRC_OPTIMAL)},
    [WD_USE_TRANSFER_WRITE] = {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0,
                               VK_ACCESS_2_TRANSFER_WRITE_BIT, LAYOUT(TRANSFER_DST_OPTIMAL)},
    [WD_USE_COMPUTE_READ] = {COMPUTE, SHADER_READS, 0, LAYOUT(SHADER_READ_ONLY_OPTIMAL)},
    [WD_USE_COMPUTE_WRITE] = {COMPUTE, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                              VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, LAYOUT(GENERAL)},
    [WD_USE_GRAPHICS_READ] = {GRAPHICS, SHADER_READS, 0, LAYOUT(SHADER_READ_ONLY_OPTIMAL)},
    [WD_USE_SHADER_READ] = {GRAPHICS | COMPUTE, SHADER_READS, 0, LAYOUT(SHADER_READ_ONLY_OPTIMAL)},
    [WD_USE_INDEX] = {VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT,
                      VK_ACCESS_2_INDEX_READ_BIT | VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, 0,
                      LAYOUT(UNDEFINED)},
    [WD_USE_INDIRECT] = {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | COMPUTE,
                         VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | SHADER_READS, 0,
                         LAYOUT(UNDEFINED)},
    [WD_USE_COLOR_TARGET] = {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                             VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                             VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                             LAYOUT(COLOR_ATTACHMENT_OPTIMAL)},
    [WD_USE_DEPTH_TARGET] = {DEPTH_TESTS, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                             VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                             LAYOUT(DEPTH_STENCIL_ATTACHMENT_OPTIMAL)},
    [WD_USE_HOST_READ] = {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, 0,
                          LAYOUT(UNDEFINED)},
};

/* What must be waited for and made visible before the next use. */
struct before {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 writes;
};

/* After a write: the write. After reads: all of them; what they read is available already, and
 * each has a barrier behind the write, so that a chain through their stages reaches it. */
static struct before pending(enum wd_gpu_use last, uint32_t reads)
{
    if (uses[last].writes || last == WD_USE_NONE)
        return (struct before){uses[last].stages, uses[last].writes};
    struct before before = {0};
    for (int use = 0; use < WD_USE_COUNT; use++) {
        if ((reads | 1u << last) >> use & 1)
            before.stages |= uses[use].stages;
    }
    return before;
}

/* Bit WD_USE_NONE in `reads` says that nothing on the device ever wrote the contents. */
static bool is_visible(enum wd_gpu_use last, uint32_t reads, enum wd_gpu_use next)
{
    reads |= 1u << last;
    if (reads & 1u << WD_USE_NONE)
        return true;
    for (int use = 0; use < WD_USE_COUNT; use++) {
        bool covers = !(uses[next].stages & ~uses[use].stages) &&
                      !(uses[next].reads & ~uses[use].reads);
        if ((reads >> use & 1) && covers)
            return true;
    }
    return false;
}

bool wd_barrier_for_buffer(struct wd_buffer *buffer, enum wd_gpu_use use,
                           struct wd_barrier *barrier)
{
    assert(buffer->buffer && use > WD_USE_NONE && use < WD_USE_COUNT && use != WD_USE_COLOR_TARGET &&
           use != WD_USE_DEPTH_TARGET);
    enum wd_gpu_use last = buffer->last_use;
    struct before before = pending(last, buffer->reads);
    bool writes = uses[use].writes;
    bool after_write = uses[last].writes;
    bool needed = last != WD_USE_NONE &&
                  (writes || after_write || !is_visible(last, buffer->reads, use));
    if (writes)
        buffer->reads = 0;
    else if (after_write)
        buffer->reads = 1u << use;
    else
        buffer->reads |= 1u << use | 1u << last;
    buffer->last_use = use;
    if (!needed)
        return false;
    *barrier = (struct wd_barrier){.buffer = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
        .srcStageMask = before.stages,
        .srcAccessMask = before.writes,
        .dstStageMask = uses[use].stages,
        .dstAccessMask = uses[use].reads | uses[use].writes,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .buffer = buffer->buffer,
        .size = VK_WHOLE_SIZE,
    }};
    return true;
}

bool wd_barrier_for_image(struct wd_image *image, enum wd_gpu_use use, enum wd_contents contents,
                          struct wd_barrier *barrier)
{
    assert(image->image && uses[use].layout != VK_IMAGE_LAYOUT_UNDEFINED);
    enum wd_gpu_use last = image->last_use;
    struct before before = pending(last, image->reads);
    bool changes = uses[last].layout != uses[use].layout;
    bool writes = uses[use].writes;
    bool fresh = changes || uses[last].writes;
    bool needed = fresh || writes || !is_visible(last, image->reads, use);
    if (writes)
        image->reads = 0;
    else
        image->reads = fresh ? 1u << use : image->reads | 1u << use | 1u << last;
    image->last_use = use;
    if (!needed)
        return false;
    bool keep = contents == WD_CONTENTS_KEEP;
    *barrier = (struct wd_barrier){.image = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = before.stages,
        .srcAccessMask = before.writes,
        .dstStageMask = uses[use].stages,
        .dstAccessMask = uses[use].reads | uses[use].writes,
        .oldLayout = keep ? uses[last].layout : VK_IMAGE_LAYOUT_UNDEFINED,
        .newLayout = uses[use].layout,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->image,
        .subresourceRange = {image->aspect, 0, image->mips, 0, image->layers},
    }};
    return true;
}

void wd_barrier_record(VkCommandBuffer commands, const struct wd_barrier *barrier)
{
    const VkDependencyInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
        .bufferMemoryBarrierCount = barrier->buffer.buffer ? 1 : 0,
        .pBufferMemoryBarriers = &barrier->buffer,
        .imageMemoryBarrierCount = barrier->image.image ? 1 : 0,
        .pImageMemoryBarriers = &barrier->image,
    };
    vkCmdPipelineBarrier2(commands, &info);
}
