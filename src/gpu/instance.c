#include "gpu/instance.h"

#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"

static const char validation_layer[] = "VK_LAYER_KHRONOS_validation";

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user)
{
    const struct wd_log *log = user;
    bool validation = types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    if (validation && (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT)) {
        wd_error(log, "Vulkan validation: %s", data->pMessage);
        abort();
    }
    wd_warn(log, "Vulkan: %s", data->pMessage);
    return VK_FALSE;
}

static VkDebugUtilsMessengerCreateInfoEXT messenger_info(const struct wd_log *log)
{
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = (void *)log,
    };
}

static bool has_extension(const char *layer, const char *name)
{
    uint32_t count = 0;
    if (vkEnumerateInstanceExtensionProperties(layer, &count, NULL) != VK_SUCCESS)
        return false;
    VkExtensionProperties *extensions = wd_alloc_array(count, sizeof *extensions);
    vkEnumerateInstanceExtensionProperties(layer, &count, extensions);
    bool found = false;
    for (uint32_t i = 0; i < count && !found; i++)
        found = strcmp(extensions[i].extensionName, name) == 0;
    free(extensions);
    return found;
}

static bool has_layer(const char *name)
{
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, NULL);
    VkLayerProperties *layers = wd_alloc_array(count, sizeof *layers);
    vkEnumerateInstanceLayerProperties(&count, layers);
    bool found = false;
    for (uint32_t i = 0; i < count && !found; i++)
        found = strcmp(layers[i].layerName, name) == 0;
    free(layers);
    return found;
}

/* The caller's extensions first, ours behind; NULL with a message when one is missing. */
static const char **choose_extensions(const struct wd_gpu_params *params, const struct wd_log *log,
                                      bool debug_utils, uint32_t *count)
{
    const char **names = wd_alloc_array(params->instance_extension_count + 2, sizeof *names);
    *count = 0;
    for (uint32_t i = 0; i < params->instance_extension_count; i++) {
        const char *name = params->instance_extensions[i];
        if (strcmp(name, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0)
            continue;
        if (!has_extension(NULL, name)) {
            wd_error(log, "the Vulkan installation has no instance extension %s", name);
            free(names);
            return NULL;
        }
        names[(*count)++] = name;
    }
    if (debug_utils)
        names[(*count)++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (params->validation == WD_GPU_VALIDATION_ON)
        names[(*count)++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
    return names;
}

static bool check_validation(const struct wd_log *log)
{
    if (!has_layer(validation_layer)) {
        return wd_error(log, "validation was asked for, but the layer %s is not installed "
                             "(Debian: apt install vulkan-validationlayers)", validation_layer);
    }
    if (!has_extension(validation_layer, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME) ||
        !has_extension(validation_layer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) {
        return wd_error(log, "the installed layer %s lacks synchronization validation "
                             "(VK_EXT_validation_features)", validation_layer);
    }
    return true;
}

static bool report_create(const struct wd_log *log, VkResult result)
{
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        return wd_error(log, "no Vulkan driver is installed (Debian: apt install "
                             "mesa-vulkan-drivers, or the driver of the graphics card's maker)");
    }
    return wd_error(log, "vkCreateInstance failed with VkResult %d", (int)result);
}

static VkResult create_instance(struct wd_gpu *gpu, const struct wd_gpu_params *params,
                                const char **extensions, uint32_t extension_count)
{
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "weald",
        .apiVersion = VK_API_VERSION_1_3,
    };
    VkDebugUtilsMessengerCreateInfoEXT messages = messenger_info(gpu->log);
    const VkValidationFeatureEnableEXT enables[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT,
    };
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messages,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = enables,
    };
    const char *layers[] = {validation_layer};
    bool validation = params->validation == WD_GPU_VALIDATION_ON;
    const VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validation ? &features : NULL,
        .pApplicationInfo = &application,
        .enabledLayerCount = validation ? 1 : 0,
        .ppEnabledLayerNames = layers,
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
    };
    return vkCreateInstance(&info, NULL, &gpu->instance);
}

static bool create_messenger(struct wd_gpu *gpu)
{
    PFN_vkCreateDebugUtilsMessengerEXT create = (PFN_vkCreateDebugUtilsMessengerEXT)
        vkGetInstanceProcAddr(gpu->instance, "vkCreateDebugUtilsMessengerEXT");
    VkDebugUtilsMessengerCreateInfoEXT info = messenger_info(gpu->log);
    if (!create || create(gpu->instance, &info, NULL, &gpu->messenger) != VK_SUCCESS)
        return wd_error(gpu->log, "validation messages cannot be received from Vulkan");
    return true;
}

bool wd_instance_init(struct wd_gpu *gpu, const struct wd_gpu_params *params, bool *debug_utils)
{
    uint32_t version = 0;
    vkEnumerateInstanceVersion(&version);
    if (version < VK_API_VERSION_1_3) {
        return wd_error(gpu->log, "the Vulkan loader has version %u.%u, 1.3 is needed",
                        VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
    }
    bool validation = params->validation == WD_GPU_VALIDATION_ON;
    if (validation && !check_validation(gpu->log))
        return false;
    *debug_utils = validation || has_extension(NULL, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    uint32_t count = 0;
    const char **extensions = choose_extensions(params, gpu->log, *debug_utils, &count);
    if (!extensions)
        return false;
    VkResult result = create_instance(gpu, params, extensions, count);
    free(extensions);
    if (result != VK_SUCCESS) {
        gpu->instance = VK_NULL_HANDLE;
        return report_create(gpu->log, result);
    }
    if (validation && !create_messenger(gpu)) {
        wd_instance_finish(gpu);
        return false;
    }
    return true;
}

void wd_instance_finish(struct wd_gpu *gpu)
{
    if (!gpu->instance)
        return;
    if (gpu->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy = (PFN_vkDestroyDebugUtilsMessengerEXT)
            vkGetInstanceProcAddr(gpu->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(gpu->instance, gpu->messenger, NULL);
    }
    vkDestroyInstance(gpu->instance, NULL);
    gpu->messenger = VK_NULL_HANDLE;
    gpu->instance = VK_NULL_HANDLE;
}
