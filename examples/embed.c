/* embed.c: draws a forest into an image of this program's own Vulkan device and saves it as PPM.
 *     cc embed.c $(pkg-config --cflags --libs weald vulkan) -o embed && ./embed SCENE OUT.ppm */
#include <stdio.h>
#include <stdlib.h>

#include <weald/vulkan.h>

enum { WIDTH = 640, HEIGHT = 360, BYTES = WIDTH * HEIGHT * 4 };

/* Vulkan and weald return 0 for success. */
#define CHECK(call) check((call) == 0, #call " failed")
static void check(bool ok, const char *what)
{
    if (ok)
        return;
    fprintf(stderr, "embed: %s\n", what);
    exit(1);
}

static struct wd_vulkan_handles open_device(void)
{
    struct wd_vulkan_handles vk = {0};
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                           .pApplicationInfo = &application};
    CHECK(vkCreateInstance(&instance, NULL, &vk.instance));
    uint32_t one = 1; /* the first device, and its first queue family, do for an example */
    vkEnumeratePhysicalDevices(vk.instance, &one, &vk.physical_device);
    check(vk.physical_device != VK_NULL_HANDLE, "there is no Vulkan device");
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = vk.queue_family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    static VkPhysicalDeviceFeatures2 features; /* all three are read again for the renderer */
    static VkPhysicalDeviceVulkan12Features features12;
    static VkPhysicalDeviceVulkan13Features features13;
    wd_vulkan_wanted_features(vk.physical_device, &features, &features12, &features13);
    vk.enabled = &features;
    const VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                       .pNext = &features,
                                       .queueCreateInfoCount = 1,
                                       .pQueueCreateInfos = &queue};
    CHECK(vkCreateDevice(vk.physical_device, &device, NULL, &vk.device));
    vkGetDeviceQueue(vk.device, vk.queue_family, 0, &vk.queue);
    return vk;
}

static VkDeviceMemory allocate(const struct wd_vulkan_handles *vk, VkMemoryRequirements need, VkMemoryPropertyFlags wanted)
{
    VkDeviceMemory block = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(vk->physical_device, &memory);
    for (uint32_t i = 0; i < memory.memoryTypeCount && !block; i++) {
        VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, need.size, i};
        if (need.memoryTypeBits >> i & 1 && !(wanted & ~memory.memoryTypes[i].propertyFlags))
            CHECK(vkAllocateMemory(vk->device, &info, NULL, &block));
    }
    check(block != VK_NULL_HANDLE, "the device has no such memory");
    return block;
}

static VkImage make_image(const struct wd_vulkan_handles *vk)
{
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = VK_FORMAT_R8G8B8A8_UNORM,
                                    .extent = {WIDTH, HEIGHT, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    VkImage image;
    VkMemoryRequirements need;
    CHECK(vkCreateImage(vk->device, &info, NULL, &image));
    vkGetImageMemoryRequirements(vk->device, image, &need);
    VkDeviceMemory memory = allocate(vk, need, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    CHECK(vkBindImageMemory(vk->device, image, memory, 0));
    return image;
}

/* Saves `image`, which is in layout TRANSFER_SRC and which later work on the queue sees (wd_renderer_draw). */
static void save(const struct wd_vulkan_handles *vk, VkImage image, const char *path)
{
    VkBuffer buffer;
    VkMemoryRequirements need;
    VkCommandPool pool;
    VkCommandBuffer commands;
    void *pixels;
    const VkBufferCreateInfo buffer_info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                            .size = BYTES,
                                            .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    CHECK(vkCreateBuffer(vk->device, &buffer_info, NULL, &buffer));
    vkGetBufferMemoryRequirements(vk->device, buffer, &need);
    VkDeviceMemory memory = allocate(vk, need, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    CHECK(vkBindBufferMemory(vk->device, buffer, memory, 0));
    const VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, vk->queue_family};
    CHECK(vkCreateCommandPool(vk->device, &pool_info, NULL, &pool));
    const VkCommandBufferAllocateInfo commands_info = {
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool, 0, 1};
    CHECK(vkAllocateCommandBuffers(vk->device, &commands_info, &commands));
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {WIDTH, HEIGHT, 1}};
    const VkMemoryBarrier to_host = {VK_STRUCTURE_TYPE_MEMORY_BARRIER, NULL, VK_ACCESS_TRANSFER_WRITE_BIT,
                                     VK_ACCESS_HOST_READ_BIT};
    CHECK(vkBeginCommandBuffer(commands, &begin));
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &copy);
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &to_host, 0, NULL, 0, NULL);
    CHECK(vkEndCommandBuffer(commands));
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &commands};
    CHECK(vkQueueSubmit(vk->queue, 1, &submit, VK_NULL_HANDLE));
    CHECK(vkQueueWaitIdle(vk->queue));
    CHECK(vkMapMemory(vk->device, memory, 0, BYTES, 0, &pixels));
    FILE *file = fopen(path, "wb");
    check(file != NULL, "the picture cannot be written");
    fprintf(file, "P6 %d %d 255\n", WIDTH, HEIGHT);
    for (int i = 0; i < BYTES; i += 4)
        fwrite((unsigned char *)pixels + i, 1, 3, file);
    CHECK(fclose(file));
}

int main(int argc, char **argv)
{
    check(argc == 3, "usage: embed SCENE OUT.ppm");
    struct wd_vulkan_handles vk = open_device();
    VkImage image = make_image(&vk);
    struct wd_forest *forest;
    struct wd_renderer *renderer;
    CHECK(wd_forest_create(&forest, &(struct wd_forest_params){.scene_path = argv[1]}));
    CHECK(wd_renderer_create_vulkan(&renderer, &vk, &(struct wd_renderer_params){0}));
    CHECK(wd_renderer_set_forest(renderer, forest));

    struct wd_render_params params = {.width = WIDTH, .height = HEIGHT};
    const struct wd_vulkan_target target = {.image = image, .format = VK_FORMAT_R8G8B8A8_UNORM, .width = WIDTH,
                                            .height = HEIGHT, .layout_after = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    CHECK(wd_forest_get_camera(forest, NULL, &params.camera));
    CHECK(wd_renderer_draw(renderer, &params, &target));
    CHECK(wd_renderer_wait(renderer));
    save(&vk, image, argv[2]);
    wd_renderer_destroy(&renderer);
    wd_forest_destroy(&forest); /* the process's end frees this program's own objects */
    return 0;
}
