#include "overlay.h"

#include "message.h"

static bool make_render_pass(struct viewer_overlay *overlay, VkFormat format)
{
    const VkAttachmentDescription color = {
        .format = format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
    };
    const VkAttachmentReference reference = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {
        .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
        .colorAttachmentCount = 1,
        .pColorAttachments = &reference,
    };
    const VkSubpassDependency after_draw = {
        .srcSubpass = VK_SUBPASS_EXTERNAL,
        .dstSubpass = 0,
        .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
        .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
    };
    const VkRenderPassCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &color,
        .subpassCount = 1,
        .pSubpasses = &subpass,
        .dependencyCount = 1,
        .pDependencies = &after_draw,
    };
    return vkCreateRenderPass(overlay->vulkan.device, &info, NULL, &overlay->render_pass) ==
           VK_SUCCESS;
}

static bool make_descriptors(struct viewer_overlay *overlay)
{
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4};
    const VkDescriptorPoolCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
        .maxSets = 4,
        .poolSizeCount = 1,
        .pPoolSizes = &size,
    };
    return vkCreateDescriptorPool(overlay->vulkan.device, &info, NULL, &overlay->descriptors) ==
           VK_SUCCESS;
}

static bool make_frame(const struct viewer_overlay *overlay, struct viewer_overlay_frame *frame)
{
    VkDevice device = overlay->vulkan.device;
    const VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .queueFamilyIndex = overlay->vulkan.queue_family,
    };
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    const VkFenceCreateInfo fence = {
        .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
        .flags = VK_FENCE_CREATE_SIGNALED_BIT,
    };
    if (vkCreateCommandPool(device, &pool, NULL, &frame->pool) != VK_SUCCESS)
        return false;
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = frame->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    return vkAllocateCommandBuffers(device, &commands, &frame->commands) == VK_SUCCESS &&
           vkCreateSemaphore(device, &semaphore, NULL, &frame->acquired) == VK_SUCCESS &&
           vkCreateSemaphore(device, &semaphore, NULL, &frame->drawn) == VK_SUCCESS &&
           vkCreateFence(device, &fence, NULL, &frame->done) == VK_SUCCESS;
}

static bool begin_commands(const struct viewer_overlay_frame *frame)
{
    const VkCommandBufferBeginInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    return vkBeginCommandBuffer(frame->commands, &info) == VK_SUCCESS;
}

static bool make_panels(struct viewer_overlay *overlay, const struct viewer_swapchain *swapchain)
{
    const struct viewer_panels_setup setup = {swapchain->window, overlay->vulkan,
                                              overlay->descriptors, overlay->render_pass,
                                              swapchain->image_count};
    const struct viewer_overlay_frame *frame = &overlay->frames[0];
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .commandBufferCount = 1,
        .pCommandBuffers = &frame->commands,
    };
    if (!begin_commands(frame))
        return false;
    overlay->panels = true;
    bool ok = viewer_panels_init(&setup, frame->commands) &&
              vkEndCommandBuffer(frame->commands) == VK_SUCCESS &&
              vkQueueSubmit(overlay->vulkan.queue, 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS &&
              vkQueueWaitIdle(overlay->vulkan.queue) == VK_SUCCESS;
    viewer_panels_uploaded();
    return ok;
}

bool viewer_overlay_init(struct viewer_overlay *overlay, const struct viewer_swapchain *swapchain)
{
    *overlay = (struct viewer_overlay){.vulkan = swapchain->vulkan, .log = swapchain->log};
    bool ok = make_render_pass(overlay, swapchain->format.format) && make_descriptors(overlay);
    for (int i = 0; ok && i < VIEWER_FRAMES_IN_FLIGHT; i++)
        ok = make_frame(overlay, &overlay->frames[i]);
    ok = ok && make_panels(overlay, swapchain) && viewer_overlay_resize(overlay, swapchain);
    if (ok)
        return true;
    viewer_error(&overlay->log, "the panels over the picture cannot be made: out of memory");
    viewer_overlay_finish(overlay);
    return false;
}

static void drop_framebuffers(struct viewer_overlay *overlay)
{
    for (int i = 0; i < VIEWER_MAX_IMAGES; i++) {
        vkDestroyFramebuffer(overlay->vulkan.device, overlay->framebuffers[i], NULL);
        overlay->framebuffers[i] = VK_NULL_HANDLE;
    }
}

bool viewer_overlay_resize(struct viewer_overlay *overlay, const struct viewer_swapchain *swapchain)
{
    drop_framebuffers(overlay);
    for (uint32_t i = 0; i < swapchain->image_count; i++) {
        const VkFramebufferCreateInfo info = {
            .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
            .renderPass = overlay->render_pass,
            .attachmentCount = 1,
            .pAttachments = &swapchain->views[i],
            .width = swapchain->extent.width,
            .height = swapchain->extent.height,
            .layers = 1,
        };
        if (vkCreateFramebuffer(overlay->vulkan.device, &info, NULL, &overlay->framebuffers[i]) !=
            VK_SUCCESS)
            return viewer_error(&overlay->log, "out of memory for the window's images");
    }
    return true;
}

void viewer_overlay_finish(struct viewer_overlay *overlay)
{
    VkDevice device = overlay->vulkan.device;
    if (!device)
        return;
    if (overlay->panels)
        viewer_panels_finish();
    drop_framebuffers(overlay);
    for (int i = 0; i < VIEWER_FRAMES_IN_FLIGHT; i++) {
        vkDestroyCommandPool(device, overlay->frames[i].pool, NULL);
        vkDestroySemaphore(device, overlay->frames[i].acquired, NULL);
        vkDestroySemaphore(device, overlay->frames[i].drawn, NULL);
        vkDestroyFence(device, overlay->frames[i].done, NULL);
    }
    vkDestroyDescriptorPool(device, overlay->descriptors, NULL);
    vkDestroyRenderPass(device, overlay->render_pass, NULL);
    *overlay = (struct viewer_overlay){0};
}

bool viewer_overlay_begin(struct viewer_overlay *overlay, struct viewer_overlay_frame *frame)
{
    return vkWaitForFences(overlay->vulkan.device, 1, &frame->done, VK_TRUE, UINT64_MAX) ==
               VK_SUCCESS ||
           viewer_error(&overlay->log, "the device was lost");
}

static void record(const struct viewer_overlay *overlay, const struct viewer_overlay_frame *frame,
                   const struct viewer_swapchain *swapchain, uint32_t index,
                   const struct viewer_panels_content *content)
{
    const VkRenderPassBeginInfo pass = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = overlay->render_pass,
        .framebuffer = overlay->framebuffers[index],
        .renderArea.extent = swapchain->extent,
    };
    vkCmdBeginRenderPass(frame->commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
    viewer_panels_draw(content, frame->commands);
    vkCmdEndRenderPass(frame->commands);
}

bool viewer_overlay_draw(struct viewer_overlay *overlay, struct viewer_overlay_frame *frame,
                         const struct viewer_swapchain *swapchain, uint32_t index,
                         const struct viewer_panels_content *content)
{
    VkDevice device = overlay->vulkan.device;
    const VkPipelineStageFlags wait_stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &frame->drawn,
        .pWaitDstStageMask = &wait_stage,
        .commandBufferCount = 1,
        .pCommandBuffers = &frame->commands,
        .signalSemaphoreCount = 1,
        .pSignalSemaphores = &swapchain->finished[index],
    };
    bool ok = vkResetFences(device, 1, &frame->done) == VK_SUCCESS &&
              vkResetCommandPool(device, frame->pool, 0) == VK_SUCCESS && begin_commands(frame);
    if (ok)
        record(overlay, frame, swapchain, index, content);
    ok = ok && vkEndCommandBuffer(frame->commands) == VK_SUCCESS &&
         vkQueueSubmit(overlay->vulkan.queue, 1, &submit, frame->done) == VK_SUCCESS;
    return ok || viewer_error(&overlay->log, "the panels cannot be drawn: the device was lost");
}
