/* swapchain.h: the window's images: made anew when its size changes, acquired, presented. */
#ifndef VIEWER_SWAPCHAIN_H
#define VIEWER_SWAPCHAIN_H

#include <SDL.h>

#include "weald/vulkan.h"

enum { VIEWER_MAX_IMAGES = 8 };

enum viewer_swap_state {
    VIEWER_SWAP_READY,
    VIEWER_SWAP_STALE,  /* must be made anew before the next frame */
    VIEWER_SWAP_HIDDEN, /* the window has no area */
    VIEWER_SWAP_FAILED, /* logged */
};

struct viewer_swapchain {
    struct wd_vulkan_handles vulkan; /* not owned */
    SDL_Window *window;              /* not owned */
    struct wd_log log;
    VkSurfaceKHR surface;
    VkSwapchainKHR swapchain;
    VkSurfaceFormatKHR format;
    VkExtent2D extent;
    uint32_t image_count;
    VkImage images[VIEWER_MAX_IMAGES];
    VkImageView views[VIEWER_MAX_IMAGES];
    VkSemaphore finished[VIEWER_MAX_IMAGES]; /* an image's: signalled when it may be presented */
};

bool viewer_swapchain_init(struct viewer_swapchain *swapchain, SDL_Window *window,
                           const struct wd_vulkan_handles *vulkan, const struct wd_log *log);
void viewer_swapchain_finish(struct viewer_swapchain *swapchain);

/* Fits the images to the window. No frame may be in flight. */
enum viewer_swap_state viewer_swapchain_rebuild(struct viewer_swapchain *swapchain);
enum viewer_swap_state viewer_swapchain_acquire(struct viewer_swapchain *swapchain,
                                                VkSemaphore acquired, uint32_t *index);
enum viewer_swap_state viewer_swapchain_present(struct viewer_swapchain *swapchain, uint32_t index);

#endif
