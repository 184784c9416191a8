#include "gpu/device.h"

#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
#include "base/log.h"
#include "base/memory.h"
#include "gpu/device_features.h"
#include "gpu/instance.h"
#include "gpu/pipeline_parts.h"
#include "gpu/select.h"
#include "gpu/transfer.h"

static bool has_swapchain(VkPhysicalDevice device)
{
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, NULL, &count, NULL);
    VkExtensionProperties *extensions = wd_alloc_array(count, sizeof *extensions);
    vkEnumerateDeviceExtensionProperties(device, NULL, &count, extensions);
    bool found = false;
    for (uint32_t i = 0; i < count && !found; i++)
        found = strcmp(extensions[i].extensionName, VK_KHR_SWAPCHAIN_EXTENSION_NAME) == 0;
    free(extensions);
    return found;
}

static bool create_device(struct wd_gpu *gpu, enum wd_gpu_presentation presentation)
{
    struct wd_feature_set features;
    wd_features_choose(&features, gpu->features);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = gpu->queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    const char *extensions[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    bool swapchain = presentation == WD_GPU_PRESENT && has_swapchain(gpu->physical_device);
    const VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features.base,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = swapchain ? 1 : 0,
        .ppEnabledExtensionNames = extensions,
    };
    VkResult result = vkCreateDevice(gpu->physical_device, &info, NULL, &gpu->device);
    if (result != VK_SUCCESS) {
        gpu->device = VK_NULL_HANDLE;
        return wd_error(gpu->log, "vkCreateDevice failed for \"%s\" with VkResult %d",
                        gpu->properties.deviceName, (int)result);
    }
    vkGetDeviceQueue(gpu->device, gpu->queue_family, 0, &gpu->queue);
    return true;
}

static void take_candidate(struct wd_gpu *gpu, const struct wd_candidate *candidate)
{
    gpu->physical_device = candidate->handle;
    gpu->properties = candidate->properties;
    gpu->queue_family = candidate->queue_family;
    gpu->timestamp_bits = candidate->timestamp_bits;
    gpu->features = candidate->optional;
    gpu->software = candidate->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    gpu->runs = gpu->software ? wd_jobs_default_threads() : 1;
    /* Software devices stamp when a command is queued, not when it has run. */
    if (!gpu->software && gpu->timestamp_bits && gpu->properties.limits.timestampPeriod > 0)
        gpu->features |= WD_GPU_FEATURE_TIMESTAMPS;
}

static void load_debug_functions(struct wd_gpu *gpu)
{
    gpu->begin_label = (PFN_vkCmdBeginDebugUtilsLabelEXT)
        vkGetInstanceProcAddr(gpu->instance, "vkCmdBeginDebugUtilsLabelEXT");
    gpu->end_label = (PFN_vkCmdEndDebugUtilsLabelEXT)
        vkGetInstanceProcAddr(gpu->instance, "vkCmdEndDebugUtilsLabelEXT");
    gpu->set_name = (PFN_vkSetDebugUtilsObjectNameEXT)
        vkGetInstanceProcAddr(gpu->instance, "vkSetDebugUtilsObjectNameEXT");
    if (!gpu->begin_label || !gpu->end_label)
        gpu->features &= ~(uint32_t)WD_GPU_FEATURE_DEBUG_LABELS;
}

/* What costs software devices more than it spares them. */
static const uint32_t hardware_alone = WD_GPU_FEATURE_STORED_TARGETS | WD_GPU_FEATURE_MANY_LANES;

/* Of those that there are. */
static void choose_features(struct wd_gpu *gpu, const struct wd_gpu_params *params)
{
    if (gpu->software)
        gpu->features &= params->asked_features | ~hardware_alone;
    gpu->features &= ~params->disabled_features;
}

static bool init_own(struct wd_gpu *gpu, const struct wd_gpu_params *params)
{
    gpu->owned = true;
    bool debug_utils = false;
    if (!wd_instance_init(gpu, params, &debug_utils))
        return false;
    struct wd_candidate choice;
    if (!wd_select_device(&choice, gpu->instance, params->name, gpu->log))
        return false;
    take_candidate(gpu, &choice);
    if (debug_utils)
        gpu->features |= WD_GPU_FEATURE_DEBUG_LABELS;
    gpu->features |= WD_GPU_FEATURE_MANY_LANES;
    choose_features(gpu, params);
    return create_device(gpu, params->presentation);
}

/* What the owner enabled cannot be asked of a VkDevice: the owner says it. */
static bool read_enabled(struct wd_gpu *gpu, const struct wd_gpu_external *external, uint32_t *bits)
{
    struct wd_feature_set set;
    *bits = 0;
    if (!external->enabled)
        return true;
    wd_features_read(&set, external->enabled);
    *bits = wd_features_optional(&set);
    char *missing = wd_features_missing(&set);
    if (!missing)
        return true;
    wd_error(gpu->log, "the external Vulkan device \"%s\" was made without the feature %s",
             gpu->properties.deviceName, missing);
    free(missing);
    return false;
}

static bool init_external(struct wd_gpu *gpu, const struct wd_gpu_params *params)
{
    const struct wd_gpu_external *external = params->external;
    if (!external->instance || !external->physical_device || !external->device || !external->queue)
        return wd_error(gpu->log, "the external Vulkan device has a null handle");
    if (params->validation == WD_GPU_VALIDATION_ON)
        wd_warn(gpu->log, "validation belongs to the instance, which is external: not enabled");
    struct wd_candidate candidate;
    wd_candidate_init(&candidate, external->physical_device);
    wd_candidate_take_family(&candidate, external->queue_family);
    if (candidate.problem) {
        wd_error(gpu->log, "the external Vulkan device \"%s\" cannot be used: %s",
                 candidate.properties.deviceName, candidate.problem);
        free(candidate.problem);
        return false;
    }
    take_candidate(gpu, &candidate);
    uint32_t enabled;
    if (!read_enabled(gpu, external, &enabled))
        return false;
    gpu->features &= enabled | WD_GPU_FEATURE_TIMESTAMPS;
    gpu->features |= WD_GPU_FEATURE_MANY_LANES;
    choose_features(gpu, params);
    gpu->instance = external->instance;
    gpu->device = external->device;
    gpu->queue = external->queue;
    return true;
}

static bool init_rest(struct wd_gpu *gpu)
{
    if (gpu->features & WD_GPU_FEATURE_DEBUG_LABELS)
        load_debug_functions(gpu);
    vkGetPhysicalDeviceMemoryProperties(gpu->physical_device, &gpu->memory);
    VkPhysicalDeviceVulkan13Properties properties13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES,
    };
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &properties13,
    };
    vkGetPhysicalDeviceProperties2(gpu->physical_device, &properties);
    gpu->max_buffer_size = properties13.maxBufferSize;
    const VkPipelineCacheCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
    };
    wd_pipeline_store_init(gpu);
    VkResult result = vkCreatePipelineCache(gpu->device, &info, NULL, &gpu->pipeline_cache);
    return wd_gpu_check(gpu, result, "vkCreatePipelineCache");
}

bool wd_gpu_init(struct wd_gpu *gpu, const struct wd_gpu_params *params, const struct wd_log *log)
{
    *gpu = (struct wd_gpu){.log = log,
                           .makes_at_once = params->external || params->presentation == WD_GPU_PRESENT};
    bool ok = params->external ? init_external(gpu, params) : init_own(gpu, params);
    if (!ok || !init_rest(gpu)) {
        bool no_memory = gpu->no_memory;
        wd_gpu_finish(gpu);
        gpu->no_memory = no_memory; /* whoever asked is told why */
        return false;
    }
    wd_info(log, "Vulkan device: %s", gpu->properties.deviceName);
    return true;
}

static void finish_device(struct wd_gpu *gpu)
{
    if (gpu->owned)
        vkDeviceWaitIdle(gpu->device);
    else
        vkQueueWaitIdle(gpu->queue);
    wd_transfer_finish(gpu);
    wd_pipeline_store_finish(gpu);
    vkDestroyPipelineCache(gpu->device, gpu->pipeline_cache, NULL);
    if (gpu->allocation_count) {
        wd_warn(gpu->log, "%u GPU objects with %llu bytes were never destroyed",
                gpu->allocation_count, (unsigned long long)gpu->bytes_allocated);
    }
    if (gpu->owned)
        vkDestroyDevice(gpu->device, NULL);
}

void wd_gpu_finish(struct wd_gpu *gpu)
{
    if (gpu->device)
        finish_device(gpu);
    if (gpu->owned)
        wd_instance_finish(gpu);
    *gpu = (struct wd_gpu){0};
}

static const char *result_text(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialization failed";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
        return "format not supported";
    case VK_ERROR_FRAGMENTED_POOL:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
        return "descriptor pool exhausted";
    case VK_ERROR_SURFACE_LOST_KHR:
        return "surface lost";
    case VK_ERROR_OUT_OF_DATE_KHR:
        return "surface out of date";
    default:
        return "unexpected result";
    }
}

bool wd_gpu_check(struct wd_gpu *gpu, VkResult result, const char *what)
{
    if (result == VK_SUCCESS)
        return true;
    if (result == VK_ERROR_DEVICE_LOST) {
        gpu->lost = true;
        return wd_error(gpu->log, "the Vulkan device \"%s\" was lost during %s: the driver "
                                  "stopped or reset it; nothing more can be drawn with it",
                        gpu->properties.deviceName, what);
    }
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        gpu->no_memory = true;
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) {
        return wd_error(gpu->log, "%s: out of device memory (%.1f MiB held now)", what,
                        (double)gpu->bytes_allocated / (1 << 20));
    }
    return wd_error(gpu->log, "%s: %s (VkResult %d)", what, result_text(result), (int)result);
}

char *wd_gpu_list(const struct wd_log *log)
{
    struct wd_gpu gpu = {.log = log};
    const struct wd_gpu_params params = {0};
    bool debug_utils = false;
    if (!wd_instance_init(&gpu, &params, &debug_utils))
        return wd_strdup("");
    char *names = wd_select_names(gpu.instance, "\n");
    wd_instance_finish(&gpu);
    return names;
}
