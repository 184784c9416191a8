/* panels.h: the text panels over the picture (Dear ImGui), behind a C interface. */
#ifndef VIEWER_PANELS_H
#define VIEWER_PANELS_H

#include <SDL.h>

#include "weald/vulkan.h"

#ifdef __cplusplus
extern "C" {
#endif

struct viewer_panels_setup {
    SDL_Window *window;
    struct wd_vulkan_handles vulkan;
    VkDescriptorPool descriptors; /* room for one combined image sampler */
    VkRenderPass render_pass;
    uint32_t image_count; /* of the swapchain */
};

struct viewer_panels_content {
    const char *status; /* one line, always shown */
    const char *notice; /* what just happened; NULL: nothing */
    const char *times;  /* NULL: hidden */
    const char *help;   /* NULL: hidden */
};

/* Only one window of a process may have panels. `upload` is a command buffer being recorded; once
 * it has run, call viewer_panels_uploaded. */
bool viewer_panels_init(const struct viewer_panels_setup *setup, VkCommandBuffer upload);
void viewer_panels_uploaded(void);
void viewer_panels_event(const SDL_Event *event);
/* Records the panels into `commands`, inside the render pass. */
void viewer_panels_draw(const struct viewer_panels_content *content, VkCommandBuffer commands);
void viewer_panels_finish(void);

#ifdef __cplusplus
}
#endif
#endif
