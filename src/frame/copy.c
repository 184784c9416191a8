#include "frame/frame.h"

static void barrier(struct wd_cmd *cmd, const VkImageMemoryBarrier2 *image)
{
    const VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
        .imageMemoryBarrierCount = 1,
        .pImageMemoryBarriers = image,
    };
    vkCmdPipelineBarrier2(cmd->vk, &dependency);
}

/* Bytes are copied as they are where both sides order them alike; B8G8R8A8_UNORM takes a blit. */
static void copy_pixels(struct wd_frame *frame, struct wd_cmd *cmd,
                        const struct wd_frame_target *target)
{
    const struct wd_image *display = &frame->targets.display;
    const VkImageSubresourceLayers layers = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    if (target->format == VK_FORMAT_R8G8B8A8_UNORM || target->format == VK_FORMAT_R8G8B8A8_SRGB) {
        const VkImageCopy region = {.srcSubresource = layers,
                                    .dstSubresource = layers,
                                    .extent = {display->width, display->height, 1}};
        vkCmdCopyImage(cmd->vk, display->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target->image,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        return;
    }
    const VkOffset3D end = {(int32_t)display->width, (int32_t)display->height, 1};
    const VkImageBlit region = {.srcSubresource = layers,
                                .srcOffsets = {{0, 0, 0}, end},
                                .dstSubresource = layers,
                                .dstOffsets = {{0, 0, 0}, end}};
    vkCmdBlitImage(cmd->vk, display->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target->image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
}

void wd_frame_copy(struct wd_frame *frame, struct wd_cmd *cmd, const struct wd_frame_target *target)
{
    VkImageMemoryBarrier2 image = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        /* waits for whoever signalled that the image may be written */
        .srcStageMask = VK_PIPELINE_STAGE_2_TRANSFER_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_TRANSFER_BIT,
        .dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
        .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = target->image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    if (cmd->failed)
        return;
    wd_cmd_use_image(cmd, &frame->targets.display, WD_USE_TRANSFER_READ);
    barrier(cmd, &image);
    copy_pixels(frame, cmd, target);
    image.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    image.dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT |
                         VK_PIPELINE_STAGE_2_TRANSFER_BIT;
    image.dstAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
                          VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT;
    image.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    image.newLayout = target->layout_after;
    barrier(cmd, &image);
}
