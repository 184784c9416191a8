/* device.h: a Vulkan 1.3 device of our own or the caller's, and what it can do. Knows no trees. */
#ifndef WD_GPU_DEVICE_H
#define WD_GPU_DEVICE_H

#include <vulkan/vulkan.h>

#include "weald/types.h"

enum wd_gpu_validation {
    WD_GPU_VALIDATION_OFF,
    WD_GPU_VALIDATION_ON, /* validation + synchronization validation; abort() on the first error */
};

/* A device that belongs to somebody else; never destroyed here. It must have been made with the
 * features that wd_gpu_required_features() fills in. */
struct wd_gpu_external {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue;         /* graphics + compute + transfer; used only during our calls */
    uint32_t queue_family;
    /* what it was made with, read by wd_gpu_init alone; NULL: the required ones */
    const VkPhysicalDeviceFeatures2 *enabled;
};

struct wd_gpu_params {
    /* NULL: the fastest device present (discrete, integrated, virtual, software). "software":
     * a CPU implementation. Otherwise a case-insensitive part of the device's name; when nothing
     * matches, the error lists what there is. */
    const char *name;
    enum wd_gpu_validation validation;
    const char *const *instance_extensions; /* wanted besides our own (window surfaces) */
    uint32_t instance_extension_count;
    /* enable VK_KHR_swapchain where present (viewer) */
    enum wd_gpu_presentation { WD_GPU_HEADLESS, WD_GPU_PRESENT } presentation;
    /* fallback tests: pretend that these optional features (wd_gpu_feature bits) are absent */
    uint32_t disabled_features;
    /* tests: use these optional features also where others are faster */
    uint32_t asked_features;
    const struct wd_gpu_external *external; /* or NULL: make our own */
};

/* Optional features; each user has a fallback, and tests disable them. */
enum wd_gpu_feature {
    WD_GPU_FEATURE_INT64_ATOMICS = 1 << 0, /* shaderInt64 + shaderBufferInt64Atomics */
    WD_GPU_FEATURE_ANISOTROPY = 1 << 1,
    WD_GPU_FEATURE_TIMESTAMPS = 1 << 2, /* and they are true: never set on software devices */
    WD_GPU_FEATURE_DEBUG_LABELS = 1 << 3,
    WD_GPU_FEATURE_BLOCKS = 1 << 4, /* textureCompressionBC */
    /* shaderStorageImageExtendedFormats: compute fills the G-buffer, where fragments cost more than that: on
     * software devices only if asked for */
    WD_GPU_FEATURE_STORED_TARGETS = 1 << 5,
    /* Thousands of lanes: what one would do for long is shared out. On software devices only if asked for. */
    WD_GPU_FEATURE_MANY_LANES = 1 << 6,
};

struct wd_gpu {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue;
    uint32_t queue_family;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory;
    uint32_t features; /* wd_gpu_feature bits */
    bool software;     /* a CPU implementation (lavapipe) */
    unsigned threads;  /* of the processor that make what it is given; 0: one a processor */
    uint32_t runs;     /* of workgroups that it deals to its threads at once; 1: none */
    bool owned;        /* instance and device are ours to destroy */
    bool makes_at_once; /* pipelines, not only where they are bound */
    /* What frames have spent on having pipelines made, which no time of theirs holds: by the clock, of the processor. */
    double making_s, making_processor_s;
    bool lost;         /* VK_ERROR_DEVICE_LOST was seen; every later call fails fast */
    bool no_memory;    /* memory ran out since whoever asks cleared it */
    uint64_t bytes_allocated;  /* device memory held now through memory.h */
    uint64_t bytes_peak;
    uint32_t allocation_count; /* VkDeviceMemory objects held now */
    uint64_t max_buffer_size;
    uint32_t timestamp_bits;   /* valid bits of a timestamp in our queue */
    struct wd_transfer *transfer; /* staging for blocking transfers, made on first use */
    const struct wd_log *log;
    VkDebugUtilsMessengerEXT messenger;
    VkPipelineCache pipeline_cache;
    struct wd_pipeline_store *pipelines; /* all that were made: of the device until it is finished */
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label; /* NULL without VK_EXT_debug_utils */
    PFN_vkCmdEndDebugUtilsLabelEXT end_label;
    PFN_vkSetDebugUtilsObjectNameEXT set_name;
};

/* Features a device must have: Vulkan 1.3 with dynamicRendering, synchronization2, maintenance4,
 * shaderTerminateInvocation, shaderDemoteToHelperInvocation (all five are part of any 1.3),
 * scalarBlockLayout, fragmentStoresAndAtomics, independentBlend.
 * Chains `*features12`, `*features13` behind `*features`. Used for our own devices and published
 * (through weald/vulkan.h) for embedders. */
void wd_gpu_required_features(VkPhysicalDeviceFeatures2 *features,
                              VkPhysicalDeviceVulkan12Features *features12,
                              VkPhysicalDeviceVulkan13Features *features13);
/* These and the optional ones that the device has. */
void wd_gpu_wanted_features(VkPhysicalDevice device, VkPhysicalDeviceFeatures2 *features,
                            VkPhysicalDeviceVulkan12Features *features12,
                            VkPhysicalDeviceVulkan13Features *features13);

/* On failure `*gpu` is `{0}` but for no_memory, and the log says what was looked for and what was found. */
bool wd_gpu_init(struct wd_gpu *gpu, const struct wd_gpu_params *params, const struct wd_log *log);
void wd_gpu_finish(struct wd_gpu *gpu); /* waits for idle; accepts {0} */

/* Turns a VkResult into a log line that names `what`; true on VK_SUCCESS. Marks the device lost, or
 * without memory; says how much memory was asked for and held where memory ran out. */
bool wd_gpu_check(struct wd_gpu *gpu, VkResult result, const char *what);

/* Names of all devices present, one a line; free() it. "" without Vulkan. */
char *wd_gpu_list(const struct wd_log *log);

#endif
