#include "weald/vulkan.h"

#include "api/arguments.h"
#include "api/renderer.h"
#include "base/clock.h"

void wd_vulkan_required_features(VkPhysicalDeviceFeatures2 *features,
                                 VkPhysicalDeviceVulkan12Features *features12,
                                 VkPhysicalDeviceVulkan13Features *features13)
{
    wd_gpu_required_features(features, features12, features13);
}

void wd_vulkan_wanted_features(VkPhysicalDevice physical_device,
                               VkPhysicalDeviceFeatures2 *features,
                               VkPhysicalDeviceVulkan12Features *features12,
                               VkPhysicalDeviceVulkan13Features *features13)
{
    wd_gpu_wanted_features(physical_device, features, features12, features13);
}

void wd_renderer_get_vulkan(const struct wd_renderer *renderer, struct wd_vulkan_handles *handles)
{
    const struct wd_gpu *gpu = &renderer->gpu;
    *handles = (struct wd_vulkan_handles){gpu->instance, gpu->physical_device, gpu->device,
                                          gpu->queue, gpu->queue_family, NULL};
}

static bool check_target(const struct wd_renderer *renderer, const struct wd_render_params *params,
                         const struct wd_vulkan_target *target)
{
    if (!target->image)
        return wd_error(&renderer->log, "the target has no image");
    if (target->width != params->width || target->height != params->height)
        return wd_error(&renderer->log, "the target is %u x %u pixels, the picture %u x %u",
                        target->width, target->height, params->width, params->height);
    switch (target->format) {
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_UNORM:
        return true;
    default:
        return wd_error(&renderer->log,
                        "the target's format is %d: R8G8B8A8_UNORM, R8G8B8A8_SRGB "
                        "and B8G8R8A8_UNORM are possible",
                        (int)target->format);
    }
}

/* Device time of the newest finished frame. */
static double scopes_ms(const struct wd_frames *ring)
{
    double sum_us = 0.0;
    for (uint32_t i = 0; i < ring->last_scope_count; i++)
        sum_us += ring->last_scopes[i].depth == 0 ? ring->last_scopes[i].gpu_us : 0.0;
    return sum_us * 1e-3;
}

enum wd_result wd_renderer_draw(struct wd_renderer *renderer, const struct wd_render_params *params,
                                const struct wd_vulkan_target *target)
{
    enum { LIVE_SAMPLES = 1, LIVE_PAGES = 256 };
    if (!wd_given(params, &renderer->log) || !wd_given(target, &renderer->log) ||
        !check_target(renderer, params, target))
        return WD_ERROR_INPUT;
    enum wd_result result = wd_renderer_prepare(renderer, params, LIVE_SAMPLES, WD_FRAME_LIT, NULL);
    if (result != WD_OK)
        return result;
    renderer->frame.params.page_budget = LIVE_PAGES;
    bool true_clock = (renderer->gpu.features & WD_GPU_FEATURE_TIMESTAMPS) != 0;
    if (true_clock)
        renderer->frame.ring.timing = WD_TIMING_ON;
    struct wd_cmd cmd;
    double start = wd_clock_s() - renderer->gpu.making_s;
    if (!wd_frame_begin(&renderer->frame.ring, &cmd))
        return wd_renderer_failure(renderer);
    wd_frame_record(&renderer->frame, &cmd, 0);
    const struct wd_frame_target copy = {target->image, target->format, target->layout_after};
    wd_frame_copy(&renderer->frame, &cmd, &copy);
    if (!wd_frame_submit(&cmd, target->wait, target->signal)) {
        wd_frame_abandoned(&renderer->frame);
        return wd_renderer_failure(renderer);
    }
    renderer->samples = 1;
    renderer->frame_ms = (wd_clock_s() - renderer->gpu.making_s - start) * 1e3;
    wd_renderer_keep_times(renderer);
    renderer->gpu_ms = true_clock ? scopes_ms(&renderer->frame.ring) : 0.0;
    return WD_OK;
}

enum wd_result wd_renderer_wait(struct wd_renderer *renderer)
{
    renderer->no_memory = renderer->gpu.no_memory = false;
    return wd_frames_wait(&renderer->frame.ring) ? WD_OK : wd_renderer_failure(renderer);
}
