/* format.h: the image formats that the renderer uses. */
#ifndef WD_GPU_FORMAT_H
#define WD_GPU_FORMAT_H

#include <vulkan/vulkan.h>

const char *wd_format_name(VkFormat format); /* never NULL */
VkImageAspectFlags wd_format_aspect(VkFormat format);

#endif
