/* overlay.h: the pass that lays panels over a drawn image and hands it to presentation. */
#ifndef VIEWER_OVERLAY_H
#define VIEWER_OVERLAY_H

#include "panels.h"
#include "swapchain.h"

enum { VIEWER_FRAMES_IN_FLIGHT = 2 };

struct viewer_overlay_frame {
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkSemaphore acquired; /* the window's image may be written */
    VkSemaphore drawn;    /* the forest is in it */
    VkFence done;         /* the panels are in it, too; begins signalled */
};

struct viewer_overlay {
    struct wd_vulkan_handles vulkan; /* not owned */
    struct wd_log log;
    VkRenderPass render_pass;
    VkDescriptorPool descriptors;
    struct viewer_overlay_frame frames[VIEWER_FRAMES_IN_FLIGHT];
    VkFramebuffer framebuffers[VIEWER_MAX_IMAGES];
    bool panels; /* viewer_panels_init was called */
};

/* `swapchain` must have images. */
bool viewer_overlay_init(struct viewer_overlay *overlay, const struct viewer_swapchain *swapchain);
/* After the swapchain was made anew; no frame may be in flight. */
bool viewer_overlay_resize(struct viewer_overlay *overlay,
                           const struct viewer_swapchain *swapchain);
void viewer_overlay_finish(struct viewer_overlay *overlay);

/* Waits until the frame is no longer in flight. */
bool viewer_overlay_begin(struct viewer_overlay *overlay, struct viewer_overlay_frame *frame);
/* Submits the panels over image `index`, which comes in layout COLOR_ATTACHMENT_OPTIMAL once
 * frame->drawn is signalled and leaves in PRESENT_SRC. */
bool viewer_overlay_draw(struct viewer_overlay *overlay, struct viewer_overlay_frame *frame,
                         const struct viewer_swapchain *swapchain, uint32_t index,
                         const struct viewer_panels_content *content);

#endif
