/* memory.h: buffers and images that own their memory and remember their last use, so that one
 * helper (command.h) emits exactly the barrier still needed. */
#ifndef WD_GPU_MEMORY_H
#define WD_GPU_MEMORY_H

#include "gpu/device.h"

/* A place and way of use: what a barrier needs to know. */
enum wd_gpu_use {
    WD_USE_NONE = 0,         /* never used yet; contents undefined */
    WD_USE_TRANSFER_READ,
    WD_USE_TRANSFER_WRITE,
    WD_USE_COMPUTE_READ,     /* storage buffer or sampled image, in compute */
    WD_USE_COMPUTE_WRITE,    /* storage buffer or image: write, or read and write */
    WD_USE_GRAPHICS_READ,    /* storage buffer or sampled image, in vertex and fragment stages */
    WD_USE_SHADER_READ,      /* both of the above */
    WD_USE_INDEX,            /* index or vertex buffer */
    WD_USE_INDIRECT,         /* indirect commands, also read by compute */
    WD_USE_COLOR_TARGET,
    WD_USE_DEPTH_TARGET,
    WD_USE_HOST_READ,        /* read-back memory, read by the CPU after the frame has finished */
    WD_USE_COUNT,
};

enum wd_gpu_memory_kind {
    WD_MEMORY_DEVICE,   /* fastest for the device */
    WD_MEMORY_UPLOAD,   /* host writes, device reads; mapped, coherent */
    WD_MEMORY_READBACK, /* device writes, host reads; mapped, coherent, cached where there is */
};

struct wd_buffer {
    VkBuffer buffer;
    VkBufferView texels; /* of all of it, where its parameters name a format */
    VkDeviceMemory memory;
    VkDeviceSize size;
    VkDeviceSize memory_size;
    void *mapped; /* UPLOAD and READBACK, for the whole life */
    enum wd_gpu_use last_use;
    uint32_t reads; /* bit 1 << use for each reading use that the last write is visible to */
};

/* `usage` is ORed with TRANSFER_SRC and TRANSFER_DST. `name` shows in errors and debuggers. With a
 * format of texels shaders can fetch from it, too: llvmpipe does so for all lanes at once, while storage
 * buffers are read lane by lane. */
struct wd_buffer_params {
    const char *name;
    VkDeviceSize size; /* > 0 */
    VkBufferUsageFlags usage;
    enum wd_gpu_memory_kind memory;
    VkFormat texels; /* 0: none */
};
bool wd_buffer_init(struct wd_buffer *buffer, struct wd_gpu *gpu,
                    const struct wd_buffer_params *params);
void wd_buffer_finish(struct wd_buffer *buffer, struct wd_gpu *gpu);

struct wd_image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;   /* all layers and mips; 2D, or 2D array when layered */
    VkImageView stored; /* the same to be stored to, where its parameters name a format */
    VkFormat format;
    VkImageAspectFlags aspect;
    uint32_t width, height, layers, mips;
    VkDeviceSize memory_size;
    enum wd_gpu_use last_use;
    uint32_t reads; /* as in wd_buffer */
};

enum wd_image_view_kind {
    WD_IMAGE_AUTO,    /* 2D for one layer, 2D array for more */
    WD_IMAGE_ARRAY,   /* 2D array even for one layer */
};
struct wd_image_params {
    const char *name;
    VkFormat format;
    uint32_t width, height;
    uint32_t layers; /* 0 means 1 */
    uint32_t mips;   /* 0 means 1; WD_ALL_MIPS: down to 1x1 */
    VkImageUsageFlags usage; /* ORed with TRANSFER_SRC and TRANSFER_DST */
    enum wd_image_view_kind view;
    VkFormat stored_as; /* of a view for storage alone, where the image's own format has none; 0: none */
    /* Shaders look at texels, not at places from 0 to 1, and at one mip: it may have more than asked for. llvmpipe
     * compiles each of its shaders anew for sides that are powers of two, so it gets none. */
    bool by_texel;
};
#define WD_ALL_MIPS UINT32_MAX
/* The least side of so many or more that is no power of two. */
uint32_t wd_image_odd_side(uint32_t side);

bool wd_image_init(struct wd_image *image, struct wd_gpu *gpu,
                   const struct wd_image_params *params);
void wd_image_finish(struct wd_image *image, struct wd_gpu *gpu);

/* A view of one layer (and one mip) to render into or to store to. The caller destroys it. */
bool wd_image_layer_view(struct wd_gpu *gpu, const struct wd_image *image, uint32_t layer,
                         uint32_t mip, VkImageView *view);

/* Blocking transfers over an internal staging buffer, chunked so that no size is too large. Not
 * while a frame that uses the object is being recorded: the transfer would overtake it.
 * Image data is tightly packed, rows top to bottom, one mip of one layer. */
bool wd_buffer_upload(struct wd_gpu *gpu, struct wd_buffer *buffer, VkDeviceSize offset,
                      const void *data, VkDeviceSize size);
bool wd_buffer_read(struct wd_gpu *gpu, struct wd_buffer *buffer, VkDeviceSize offset, void *data,
                    VkDeviceSize size);
bool wd_image_upload(struct wd_gpu *gpu, struct wd_image *image, uint32_t layer, uint32_t mip,
                     const void *data, size_t size);
bool wd_image_read(struct wd_gpu *gpu, struct wd_image *image, uint32_t layer, uint32_t mip,
                   void *data, size_t size);

/* Whole layers at once: each is its mips, finest first, tightly packed. One submission for as many as
 * the staging holds. */
bool wd_image_upload_layers(struct wd_gpu *gpu, struct wd_image *image, uint32_t first,
                            uint32_t count, const void *data);
size_t wd_image_layer_bytes(const struct wd_image *image);

/* Gives the staging's memory back; the next transfer makes it anew. */
void wd_transfer_drop_staging(struct wd_gpu *gpu);

/* Bytes of one texel, or of one block of block_side x block_side texels; 0 for formats the renderer
 * does not use. */
uint32_t wd_format_texel_bytes(VkFormat format);
uint32_t wd_format_block_side(VkFormat format);

#endif
