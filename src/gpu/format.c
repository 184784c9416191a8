#include "gpu/format.h"

#include "gpu/memory.h"

struct format_row {
    VkFormat format;
    uint32_t texel_bytes;
    const char *name;
};
#define FORMAT(name, bytes) {VK_FORMAT_##name, bytes, #name}

static const struct format_row formats[] = {
    FORMAT(R8_UNORM, 1), FORMAT(R8_SNORM, 1), FORMAT(R8_UINT, 1),
    FORMAT(R8G8_UNORM, 2), FORMAT(R8G8_SNORM, 2), FORMAT(R8G8_UINT, 2),
    FORMAT(R8G8B8A8_UNORM, 4), FORMAT(R8G8B8A8_SNORM, 4), FORMAT(R8G8B8A8_UINT, 4),
    FORMAT(R8G8B8A8_SRGB, 4), FORMAT(B8G8R8A8_UNORM, 4), FORMAT(B8G8R8A8_SRGB, 4),
    FORMAT(A8B8G8R8_UNORM_PACK32, 4), FORMAT(A8B8G8R8_SRGB_PACK32, 4),
    FORMAT(A2B10G10R10_UNORM_PACK32, 4), FORMAT(A2R10G10B10_UNORM_PACK32, 4),
    FORMAT(B10G11R11_UFLOAT_PACK32, 4), FORMAT(E5B9G9R9_UFLOAT_PACK32, 4),
    FORMAT(R16_UNORM, 2), FORMAT(R16_SNORM, 2), FORMAT(R16_UINT, 2), FORMAT(R16_SINT, 2),
    FORMAT(R16_SFLOAT, 2), FORMAT(R16G16_UNORM, 4), FORMAT(R16G16_SNORM, 4),
    FORMAT(R16G16_UINT, 4), FORMAT(R16G16_SINT, 4), FORMAT(R16G16_SFLOAT, 4),
    FORMAT(R16G16B16A16_UNORM, 8), FORMAT(R16G16B16A16_SNORM, 8), FORMAT(R16G16B16A16_UINT, 8),
    FORMAT(R16G16B16A16_SFLOAT, 8), FORMAT(R32_UINT, 4), FORMAT(R32_SINT, 4),
    FORMAT(R32_SFLOAT, 4), FORMAT(R32G32_UINT, 8), FORMAT(R32G32_SINT, 8),
    FORMAT(R32G32_SFLOAT, 8), FORMAT(R32G32B32A32_UINT, 16), FORMAT(R32G32B32A32_SINT, 16),
    FORMAT(R32G32B32A32_SFLOAT, 16), FORMAT(R64_UINT, 8), FORMAT(D16_UNORM, 2),
    FORMAT(D32_SFLOAT, 4), FORMAT(BC3_UNORM_BLOCK, 16), FORMAT(BC3_SRGB_BLOCK, 16),
    FORMAT(BC4_UNORM_BLOCK, 8),
};

static const struct format_row *find_format(VkFormat format)
{
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        if (formats[i].format == format)
            return &formats[i];
    }
    return NULL;
}

uint32_t wd_format_texel_bytes(VkFormat format)
{
    const struct format_row *row = find_format(format);
    return row ? row->texel_bytes : 0;
}

uint32_t wd_format_block_side(VkFormat format)
{
    bool blocks = format == VK_FORMAT_BC3_UNORM_BLOCK || format == VK_FORMAT_BC3_SRGB_BLOCK ||
                  format == VK_FORMAT_BC4_UNORM_BLOCK;
    return blocks ? 4 : 1;
}

const char *wd_format_name(VkFormat format)
{
    const struct format_row *row = find_format(format);
    return row ? row->name : "unknown format";
}

VkImageAspectFlags wd_format_aspect(VkFormat format)
{
    bool depth = format == VK_FORMAT_D16_UNORM || format == VK_FORMAT_D32_SFLOAT;
    return depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}
