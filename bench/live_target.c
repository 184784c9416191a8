#include "live_target.h"

static uint32_t local_memory(const struct live_target *live, uint32_t types)
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(live->vk.physical_device, &memory);
    for (uint32_t i = 0; i < memory.memoryTypeCount; i++) {
        if (types >> i & 1 &&
            memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
            return i;
    }
    return 0;
}

bool live_target_init(struct live_target *live, const struct wd_renderer *renderer, uint32_t width,
                      uint32_t height)
{
    *live = (struct live_target){.target = {.format = VK_FORMAT_R8G8B8A8_UNORM,
                                            .width = width,
                                            .height = height,
                                            .layout_after = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}};
    wd_renderer_get_vulkan(renderer, &live->vk);
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = live->target.format,
                                    .extent = {width, height, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    if (vkCreateImage(live->vk.device, &info, NULL, &live->target.image) != VK_SUCCESS)
        return false;
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(live->vk.device, live->target.image, &needs);
    const VkMemoryAllocateInfo allocation = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                             .allocationSize = needs.size,
                                             .memoryTypeIndex =
                                                 local_memory(live, needs.memoryTypeBits)};
    return vkAllocateMemory(live->vk.device, &allocation, NULL, &live->memory) == VK_SUCCESS &&
           vkBindImageMemory(live->vk.device, live->target.image, live->memory, 0) == VK_SUCCESS;
}

void live_target_finish(struct live_target *live)
{
    if (live->target.image)
        vkDestroyImage(live->vk.device, live->target.image, NULL);
    if (live->memory)
        vkFreeMemory(live->vk.device, live->memory, NULL);
    *live = (struct live_target){0};
}
