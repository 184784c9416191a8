#include "gpu/select.h"

#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "gpu/device_features.h"

static const char *kind_name(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "software";
    default:
        return "other";
    }
}

static int speed_rank(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 1;
    default:
        return 0;
    }
}

/* The first family from `first` on, before `end`, that does for all work. */
static bool find_queue_family(struct wd_candidate *candidate, uint32_t first, uint32_t end)
{
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(candidate->handle, &count, NULL);
    VkQueueFamilyProperties *families = wd_alloc_array(count, sizeof *families);
    vkGetPhysicalDeviceQueueFamilyProperties(candidate->handle, &count, families);
    bool found = false;
    for (uint32_t i = first; i < count && i < end && !found; i++) {
        found = (families[i].queueFlags & wanted) == wanted;
        candidate->queue_family = i;
        candidate->timestamp_bits = families[i].timestampValidBits;
    }
    free(families);
    return found;
}

void wd_candidate_take_family(struct wd_candidate *candidate, uint32_t family)
{
    if (!candidate->problem && (family == UINT32_MAX || !find_queue_family(candidate, family, family + 1)))
        candidate->problem =
            wd_format("its queue family %u is not there or not for both graphics and compute", family);
}

void wd_candidate_init(struct wd_candidate *candidate, VkPhysicalDevice handle)
{
    *candidate = (struct wd_candidate){.handle = handle};
    vkGetPhysicalDeviceProperties(handle, &candidate->properties);
    uint32_t version = candidate->properties.apiVersion;
    if (version < VK_API_VERSION_1_3) {
        candidate->problem = wd_format("it has Vulkan %u.%u, 1.3 is needed",
                                       VK_API_VERSION_MAJOR(version),
                                       VK_API_VERSION_MINOR(version));
        return;
    }
    struct wd_feature_set supported;
    wd_features_query(&supported, handle);
    candidate->optional = wd_features_optional(&supported);
    char *missing = wd_features_missing(&supported);
    if (missing)
        candidate->problem = wd_format("it lacks the feature %s", missing);
    else if (!find_queue_family(candidate, 0, UINT32_MAX))
        candidate->problem = wd_strdup("it has no queue for both graphics and compute");
    free(missing);
}

static VkPhysicalDevice *enumerate(VkInstance instance, uint32_t *count)
{
    *count = 0;
    vkEnumeratePhysicalDevices(instance, count, NULL);
    VkPhysicalDevice *devices = wd_alloc_array(*count, sizeof *devices);
    VkResult result = vkEnumeratePhysicalDevices(instance, count, devices);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE)
        *count = 0;
    return devices;
}

char *wd_select_names(VkInstance instance, const char *separator)
{
    uint32_t count = 0;
    VkPhysicalDevice *devices = enumerate(instance, &count);
    char *names = wd_strdup("");
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        char *longer = wd_format("%s%s%s (%s)", names, i ? separator : "", properties.deviceName,
                                 kind_name(properties.deviceType));
        free(names);
        names = longer;
    }
    free(devices);
    return names;
}

static bool matches(const VkPhysicalDeviceProperties *properties, const char *name)
{
    if (!name)
        return true;
    if (strcasecmp(name, "software") == 0)
        return properties->deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    return strcasestr(properties->deviceName, name);
}

/* Usable beats unusable, then the faster kind, then the first. */
static bool is_better(const struct wd_candidate *a, const struct wd_candidate *b)
{
    if (!b->handle)
        return true;
    if (!a->problem != !b->problem)
        return !a->problem;
    return speed_rank(a->properties.deviceType) > speed_rank(b->properties.deviceType);
}

static bool report_no_match(VkInstance instance, const char *name, uint32_t count,
                            const struct wd_log *log)
{
    if (count == 0) {
        return wd_error(log, "there is no Vulkan device (Debian: apt install mesa-vulkan-drivers, "
                             "or the driver of the graphics card's maker)");
    }
    char *names = wd_select_names(instance, ", ");
    wd_error(log, "no Vulkan device matches \"%s\"; there is: %s", name, names);
    free(names);
    return false;
}

bool wd_select_device(struct wd_candidate *choice, VkInstance instance, const char *name,
                      const struct wd_log *log)
{
    *choice = (struct wd_candidate){0};
    uint32_t count = 0;
    VkPhysicalDevice *devices = enumerate(instance, &count);
    for (uint32_t i = 0; i < count; i++) {
        struct wd_candidate candidate;
        wd_candidate_init(&candidate, devices[i]);
        bool take = matches(&candidate.properties, name) && is_better(&candidate, choice);
        free(take ? choice->problem : candidate.problem);
        if (take)
            *choice = candidate;
    }
    free(devices);
    if (!choice->handle)
        return report_no_match(instance, name, count, log);
    if (choice->problem) {
        wd_error(log, "Vulkan device \"%s\" cannot be used: %s", choice->properties.deviceName,
                 choice->problem);
        free(choice->problem);
        *choice = (struct wd_candidate){0};
        return false;
    }
    return true;
}
