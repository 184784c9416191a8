#include "swapchain.h"

#include <SDL_vulkan.h>

#include "message.h"

static bool choose_format(struct viewer_swapchain *swapchain)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = 64;
    vkGetPhysicalDeviceSurfaceFormatsKHR(swapchain->vulkan.physical_device, swapchain->surface,
                                         &count, formats);
    for (uint32_t i = 0; i < count; i++) {
        bool usable = formats[i].format == VK_FORMAT_B8G8R8A8_UNORM ||
                      formats[i].format == VK_FORMAT_R8G8B8A8_UNORM;
        if (usable && formats[i].colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
            swapchain->format = formats[i];
            return true;
        }
    }
    return viewer_error(&swapchain->log, "the window offers no 8-bit RGBA or BGRA format");
}

bool viewer_swapchain_init(struct viewer_swapchain *swapchain, SDL_Window *window,
                           const struct wd_vulkan_handles *vulkan, const struct wd_log *log)
{
    VkBool32 presentable = VK_FALSE;
    *swapchain = (struct viewer_swapchain){.vulkan = *vulkan, .window = window, .log = *log};
    if (!SDL_Vulkan_CreateSurface(window, vulkan->instance, &swapchain->surface))
        return viewer_error(log, "the window takes no Vulkan pictures: %s", SDL_GetError());
    vkGetPhysicalDeviceSurfaceSupportKHR(vulkan->physical_device, vulkan->queue_family,
                                         swapchain->surface, &presentable);
    if (!presentable)
        viewer_error(log, "this device cannot show pictures in this window; try another --gpu");
    if (presentable && choose_format(swapchain))
        return true;
    viewer_swapchain_finish(swapchain);
    return false;
}

static void drop_images(struct viewer_swapchain *swapchain)
{
    VkDevice device = swapchain->vulkan.device;
    for (uint32_t i = 0; i < swapchain->image_count; i++) {
        vkDestroyImageView(device, swapchain->views[i], NULL);
        vkDestroySemaphore(device, swapchain->finished[i], NULL);
        swapchain->views[i] = VK_NULL_HANDLE;
        swapchain->finished[i] = VK_NULL_HANDLE;
    }
    swapchain->image_count = 0;
}

void viewer_swapchain_finish(struct viewer_swapchain *swapchain)
{
    if (!swapchain->surface)
        return;
    drop_images(swapchain);
    vkDestroySwapchainKHR(swapchain->vulkan.device, swapchain->swapchain, NULL);
    vkDestroySurfaceKHR(swapchain->vulkan.instance, swapchain->surface, NULL);
    *swapchain = (struct viewer_swapchain){0};
}

static uint32_t clamp(uint32_t value, uint32_t low, uint32_t high)
{
    return value < low ? low : value > high ? high : value;
}

/* Surfaces without a size of their own (Wayland) take the window's. */
static VkExtent2D window_extent(const struct viewer_swapchain *swapchain,
                                const VkSurfaceCapabilitiesKHR *able)
{
    if (able->currentExtent.width != UINT32_MAX)
        return able->currentExtent;
    int width, height;
    SDL_Vulkan_GetDrawableSize(swapchain->window, &width, &height);
    return (VkExtent2D){
        clamp((uint32_t)width, able->minImageExtent.width, able->maxImageExtent.width),
        clamp((uint32_t)height, able->minImageExtent.height, able->maxImageExtent.height)};
}

static bool make_swapchain(struct viewer_swapchain *swapchain, const VkSurfaceCapabilitiesKHR *able)
{
    uint32_t most = able->maxImageCount ? able->maxImageCount : VIEWER_MAX_IMAGES;
    VkSwapchainKHR old = swapchain->swapchain;
    VkSwapchainCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = swapchain->surface,
        .minImageCount = clamp(3, able->minImageCount, most),
        .imageFormat = swapchain->format.format,
        .imageColorSpace = swapchain->format.colorSpace,
        .imageExtent = swapchain->extent,
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .preTransform = able->currentTransform,
        .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
        .presentMode = VK_PRESENT_MODE_FIFO_KHR,
        .clipped = VK_TRUE,
        .oldSwapchain = old,
    };
    if (!(able->supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR))
        info.compositeAlpha = VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    swapchain->swapchain = VK_NULL_HANDLE;
    VkResult result =
        vkCreateSwapchainKHR(swapchain->vulkan.device, &info, NULL, &swapchain->swapchain);
    vkDestroySwapchainKHR(swapchain->vulkan.device, old, NULL);
    return result == VK_SUCCESS ||
           viewer_error(&swapchain->log, "the window's images cannot be made (%ux%u, Vulkan %d)",
                        swapchain->extent.width, swapchain->extent.height, result);
}

static bool make_image(struct viewer_swapchain *swapchain, uint32_t index)
{
    VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = swapchain->images[index],
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = swapchain->format.format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkDevice device = swapchain->vulkan.device;
    return vkCreateImageView(device, &view, NULL, &swapchain->views[index]) == VK_SUCCESS &&
           vkCreateSemaphore(device, &semaphore, NULL, &swapchain->finished[index]) == VK_SUCCESS;
}

static bool make_images(struct viewer_swapchain *swapchain)
{
    VkDevice device = swapchain->vulkan.device;
    uint32_t count = 0;
    vkGetSwapchainImagesKHR(device, swapchain->swapchain, &count, NULL);
    if (count > VIEWER_MAX_IMAGES)
        return viewer_error(&swapchain->log, "the window insists on %u images", count);
    swapchain->image_count = count;
    bool ok = vkGetSwapchainImagesKHR(device, swapchain->swapchain, &count, swapchain->images) ==
              VK_SUCCESS;
    for (uint32_t i = 0; ok && i < count; i++)
        ok = make_image(swapchain, i);
    return ok || viewer_error(&swapchain->log, "out of memory for the window's images");
}

enum viewer_swap_state viewer_swapchain_rebuild(struct viewer_swapchain *swapchain)
{
    VkSurfaceCapabilitiesKHR able;
    if (vkGetPhysicalDeviceSurfaceCapabilitiesKHR(swapchain->vulkan.physical_device,
                                                  swapchain->surface, &able) != VK_SUCCESS) {
        viewer_error(&swapchain->log, "the window was lost");
        return VIEWER_SWAP_FAILED;
    }
    drop_images(swapchain);
    swapchain->extent = window_extent(swapchain, &able);
    if (!swapchain->extent.width || !swapchain->extent.height)
        return VIEWER_SWAP_HIDDEN;
    bool ok = make_swapchain(swapchain, &able) && make_images(swapchain);
    return ok ? VIEWER_SWAP_READY : VIEWER_SWAP_FAILED;
}

static enum viewer_swap_state judge(const struct viewer_swapchain *swapchain, VkResult result)
{
    switch (result) {
    case VK_SUCCESS:
        return VIEWER_SWAP_READY;
    case VK_SUBOPTIMAL_KHR:
    case VK_ERROR_OUT_OF_DATE_KHR:
        return VIEWER_SWAP_STALE;
    default:
        viewer_error(&swapchain->log, "the window's images were lost (Vulkan %d)", result);
        return VIEWER_SWAP_FAILED;
    }
}

enum viewer_swap_state viewer_swapchain_acquire(struct viewer_swapchain *swapchain,
                                                VkSemaphore acquired, uint32_t *index)
{
    VkResult result = vkAcquireNextImageKHR(swapchain->vulkan.device, swapchain->swapchain,
                                            UINT64_MAX, acquired, VK_NULL_HANDLE, index);
    /* A suboptimal image has been acquired all the same: it must be drawn and presented. */
    return judge(swapchain, result == VK_SUBOPTIMAL_KHR ? VK_SUCCESS : result);
}

enum viewer_swap_state viewer_swapchain_present(struct viewer_swapchain *swapchain, uint32_t index)
{
    VkPresentInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &swapchain->finished[index],
        .swapchainCount = 1,
        .pSwapchains = &swapchain->swapchain,
        .pImageIndices = &index,
    };
    return judge(swapchain, vkQueuePresentKHR(swapchain->vulkan.queue, &info));
}
