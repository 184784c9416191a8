/* weald/vulkan.h: drawing into images of the caller's own Vulkan device. */
#ifndef WEALD_VULKAN_H
#define WEALD_VULKAN_H

#include <vulkan/vulkan.h>

#include "weald/renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fills the features that a device must be made with and chains them: features -> features12 ->
 * features13. Pass `features` as VkDeviceCreateInfo.pNext (pEnabledFeatures NULL). The instance and
 * device must be of Vulkan 1.3. These alone are enough, but slow: see the next. */
void wd_vulkan_required_features(VkPhysicalDeviceFeatures2 *features,
                                 VkPhysicalDeviceVulkan12Features *features12,
                                 VkPhysicalDeviceVulkan13Features *features13);

/* The same with all that makes drawing faster where the physical device has it, such as 64-bit
 * atomics; each of these has a fallback. More may be set before the device is made. The instance
 * must be of Vulkan 1.3. */
void wd_vulkan_wanted_features(VkPhysicalDevice physical_device,
                               VkPhysicalDeviceFeatures2 *features,
                               VkPhysicalDeviceVulkan12Features *features12,
                               VkPhysicalDeviceVulkan13Features *features13);

struct wd_vulkan_handles {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue; /* graphics, compute and transfer */
    uint32_t queue_family;
    /* What the device was made with, with all behind it in pNext; read while a renderer is made,
     * not kept. NULL: the required features alone, so that the fallbacks draw. */
    const VkPhysicalDeviceFeatures2 *enabled;
};

/* A renderer on the caller's device, which must outlive it. `params->gpu` and `->validation` are
 * not used. The queue is used only during calls on the renderer, on the calling thread.
 * `handles->enabled` is believed as far as the physical device has what it says.
 * Errors: as wd_renderer_create; WD_ERROR_DEVICE also where `enabled` lacks a required feature. */
enum wd_result wd_renderer_create_vulkan(struct wd_renderer **renderer,
                                         const struct wd_vulkan_handles *handles,
                                         const struct wd_renderer_params *params);

/* A renderer on a device of its own that can also present: for programs with a window.
 * `instance_extensions`: what the window system needs. VK_KHR_swapchain is enabled where the device has it.
 * Errors: as wd_renderer_create; WD_ERROR_DEVICE also where an extension is missing. */
enum wd_result wd_renderer_create_presenting(struct wd_renderer **renderer,
                                             const char *const *instance_extensions,
                                             uint32_t instance_extension_count,
                                             const struct wd_renderer_params *params);
/* Of a renderer made in any way; `enabled` is NULL. They live as long as the renderer, but for those of the caller. */
void wd_renderer_get_vulkan(const struct wd_renderer *renderer, struct wd_vulkan_handles *handles);

/* Where a frame goes. */
struct wd_vulkan_target {
    VkImage image;          /* 2D, one sample, one mip, one layer; usage TRANSFER_DST. Its tiling
                               has the format feature TRANSFER_DST; for B8G8R8A8_UNORM, which is
                               blitted and not copied, BLIT_DST. Optimal tiling always has both. */
    VkFormat format;        /* R8G8B8A8_UNORM, R8G8B8A8_SRGB or B8G8R8A8_UNORM; receives
                               sRGB-encoded bytes in each case */
    uint32_t width, height; /* must equal params->width, height */
    VkImageLayout layout_after; /* e.g. PRESENT_SRC_KHR; old contents are discarded */
    VkSemaphore wait;       /* signalled when the image may be written, or VK_NULL_HANDLE */
    VkSemaphore signal;     /* signalled when it is finished, or VK_NULL_HANDLE */
};

/* Draws one frame into `target` and returns once it is submitted: up to two frames are in flight.
 * Only the display is made (params->layers is not used).
 * Before the image is written, `wait` is waited for, by the frame's transfers alone; without it,
 * transfers that were submitted to the queue earlier, and nothing else.
 * After it, whoever waits for `signal` sees the image in any use. Without `signal`, work that is
 * submitted to the queue later sees it as a colour attachment and as a source of transfers; any
 * other use needs a barrier that begins at the stage TRANSFER.
 * No ownership passes between queue families. None need be given to the renderer's, for the old
 * contents are discarded; to use an image of exclusive sharing in another family afterwards,
 * release it on the renderer's queue.
 * Errors: as wd_renderer_render; `signal` is then not signalled. */
enum wd_result wd_renderer_draw(struct wd_renderer *renderer, const struct wd_render_params *params,
                                const struct wd_vulkan_target *target);

/* Waits until every submitted frame is finished. Errors: WD_ERROR_DEVICE, WD_ERROR_MEMORY. */
enum wd_result wd_renderer_wait(struct wd_renderer *renderer);

#ifdef __cplusplus
}
#endif
#endif
