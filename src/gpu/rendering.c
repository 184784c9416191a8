#include <assert.h>

#include "gpu/command.h"

static void use_target(struct wd_cmd *cmd, const struct wd_rendering *rendering,
                       struct wd_image *image, enum wd_load load, enum wd_gpu_use use)
{
    bool whole = image->layers == 1 && image->mips == 1 && rendering->width >= image->width &&
                 rendering->height >= image->height;
    if (whole && load != WD_LOAD_KEEP)
        wd_cmd_discard_image(cmd, image, use);
    else
        wd_cmd_use_image(cmd, image, use);
}

static VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout,
                                            enum wd_load load)
{
    return (VkRenderingAttachmentInfo){
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
        .imageView = view,
        .imageLayout = layout,
        .loadOp =
            load == WD_LOAD_KEEP ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
    };
}

static void set_viewport(struct wd_cmd *cmd, uint32_t width, uint32_t height)
{
    const VkViewport viewport = {0, 0, (float)width, (float)height, 0, 1};
    const VkRect2D scissor = {{0, 0}, {width, height}};
    vkCmdSetViewport(cmd->vk, 0, 1, &viewport);
    vkCmdSetScissor(cmd->vk, 0, 1, &scissor);
}

void wd_cmd_begin_rendering(struct wd_cmd *cmd, const struct wd_rendering *rendering)
{
    assert(!cmd->rendering && rendering->color_count <= WD_MAX_COLOR_TARGETS);
    VkRenderingAttachmentInfo colors[WD_MAX_COLOR_TARGETS], depth;
    for (uint32_t i = 0; i < rendering->color_count; i++) {
        const struct wd_color_attachment *color = &rendering->color[i];
        use_target(cmd, rendering, color->image, color->load, WD_USE_COLOR_TARGET);
        colors[i] = attachment(color->view ? color->view : color->image->view,
                               VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, color->load);
        colors[i].clearValue.color = color->clear;
    }
    if (rendering->depth) {
        use_target(cmd, rendering, rendering->depth, rendering->depth_load, WD_USE_DEPTH_TARGET);
        depth = attachment(
            rendering->depth_view ? rendering->depth_view : rendering->depth->view,
            VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, rendering->depth_load);
    }
    const VkRenderingInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
        .renderArea = {{0, 0}, {rendering->width, rendering->height}},
        .layerCount = 1,
        .colorAttachmentCount = rendering->color_count,
        .pColorAttachments = colors,
        .pDepthAttachment = rendering->depth ? &depth : NULL,
    };
    vkCmdBeginRendering(cmd->vk, &info);
    set_viewport(cmd, rendering->width, rendering->height);
    cmd->rendering = true;
    cmd->recorded = true;
}

void wd_cmd_end_rendering(struct wd_cmd *cmd)
{
    assert(cmd->rendering);
    vkCmdEndRendering(cmd->vk);
    cmd->rendering = false;
}
