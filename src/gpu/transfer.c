#include "gpu/transfer.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "gpu/barriers.h"

static const VkDeviceSize chunk_bytes = 16 << 20;

static bool create_transfer(struct wd_gpu *gpu)
{
    struct wd_transfer *transfer = gpu->transfer = wd_alloc(sizeof *transfer);
    const VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = gpu->queue_family,
    };
    VkResult result = vkCreateCommandPool(gpu->device, &pool, NULL, &transfer->pool);
    if (result == VK_SUCCESS) {
        const VkCommandBufferAllocateInfo commands = {
            .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
            .commandPool = transfer->pool,
            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
            .commandBufferCount = 1,
        };
        result = vkAllocateCommandBuffers(gpu->device, &commands, &transfer->commands);
    }
    if (result == VK_SUCCESS) {
        const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        result = vkCreateFence(gpu->device, &fence, NULL, &transfer->fence);
    }
    if (wd_gpu_check(gpu, result, "creating the transfer commands"))
        return true;
    wd_transfer_finish(gpu);
    return false;
}

void wd_transfer_finish(struct wd_gpu *gpu)
{
    struct wd_transfer *transfer = gpu->transfer;
    if (!transfer)
        return;
    wd_buffer_finish(&transfer->upload, gpu);
    wd_buffer_finish(&transfer->readback, gpu);
    vkDestroyFence(gpu->device, transfer->fence, NULL);
    vkDestroyCommandPool(gpu->device, transfer->pool, NULL);
    free(transfer);
    gpu->transfer = NULL;
}

static bool grow_staging(struct wd_gpu *gpu, struct wd_buffer *staging,
                         enum wd_gpu_memory_kind kind, VkDeviceSize size)
{
    if (staging->size >= size)
        return true;
    wd_buffer_finish(staging, gpu);
    return wd_buffer_init(staging, gpu, &(struct wd_buffer_params){
        .name = kind == WD_MEMORY_UPLOAD ? "upload staging" : "read-back staging",
        .size = size,
        .memory = kind,
    });
}

static struct wd_buffer *staging_of(struct wd_gpu *gpu, enum wd_gpu_memory_kind kind)
{
    return kind == WD_MEMORY_UPLOAD ? &gpu->transfer->upload : &gpu->transfer->readback;
}

/* Makes staging of `size` bytes and begins the commands. */
static bool begin(struct wd_gpu *gpu, enum wd_gpu_memory_kind kind, VkDeviceSize size)
{
    if (gpu->lost || (!gpu->transfer && !create_transfer(gpu)) ||
        !grow_staging(gpu, staging_of(gpu, kind), kind, size))
        return false;
    VkResult result = vkResetCommandPool(gpu->device, gpu->transfer->pool, 0);
    if (result == VK_SUCCESS) {
        const VkCommandBufferBeginInfo info = {
            .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
        };
        result = vkBeginCommandBuffer(gpu->transfer->commands, &info);
    }
    return wd_gpu_check(gpu, result, "beginning a transfer");
}

static bool submit_and_wait(struct wd_gpu *gpu)
{
    struct wd_transfer *transfer = gpu->transfer;
    VkResult result = vkEndCommandBuffer(transfer->commands);
    const VkCommandBufferSubmitInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
        .commandBuffer = transfer->commands,
    };
    const VkSubmitInfo2 submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
        .commandBufferInfoCount = 1,
        .pCommandBufferInfos = &commands,
    };
    if (result == VK_SUCCESS)
        result = vkQueueSubmit2(gpu->queue, 1, &submit, transfer->fence);
    if (result == VK_SUCCESS)
        result = vkWaitForFences(gpu->device, 1, &transfer->fence, VK_TRUE, UINT64_MAX);
    if (result == VK_SUCCESS)
        result = vkResetFences(gpu->device, 1, &transfer->fence);
    return wd_gpu_check(gpu, result, "a transfer");
}

static void use_buffer(struct wd_gpu *gpu, struct wd_buffer *buffer, enum wd_gpu_use use)
{
    struct wd_barrier barrier;
    if (wd_barrier_for_buffer(buffer, use, &barrier))
        wd_barrier_record(gpu->transfer->commands, &barrier);
}

static void use_image(struct wd_gpu *gpu, struct wd_image *image, enum wd_gpu_use use)
{
    struct wd_barrier barrier;
    if (wd_barrier_for_image(image, use, WD_CONTENTS_KEEP, &barrier))
        wd_barrier_record(gpu->transfer->commands, &barrier);
}

static VkDeviceSize smaller(VkDeviceSize a, VkDeviceSize b)
{
    return a < b ? a : b;
}

bool wd_buffer_upload(struct wd_gpu *gpu, struct wd_buffer *buffer, VkDeviceSize offset,
                      const void *data, VkDeviceSize size)
{
    assert(offset <= buffer->size && size <= buffer->size - offset);
    for (VkDeviceSize done = 0; done < size; done += chunk_bytes) {
        VkDeviceSize part = smaller(size - done, chunk_bytes);
        if (!begin(gpu, WD_MEMORY_UPLOAD, part))
            return false;
        struct wd_buffer *staging = &gpu->transfer->upload;
        memcpy(staging->mapped, (const char *)data + done, part);
        use_buffer(gpu, buffer, WD_USE_TRANSFER_WRITE);
        const VkBufferCopy copy = {0, offset + done, part};
        vkCmdCopyBuffer(gpu->transfer->commands, staging->buffer, buffer->buffer, 1, &copy);
        if (!submit_and_wait(gpu))
            return false;
    }
    return true;
}

bool wd_buffer_read(struct wd_gpu *gpu, struct wd_buffer *buffer, VkDeviceSize offset, void *data,
                    VkDeviceSize size)
{
    assert(offset <= buffer->size && size <= buffer->size - offset);
    for (VkDeviceSize done = 0; done < size; done += chunk_bytes) {
        VkDeviceSize part = smaller(size - done, chunk_bytes);
        if (!begin(gpu, WD_MEMORY_READBACK, part))
            return false;
        struct wd_buffer *staging = &gpu->transfer->readback;
        use_buffer(gpu, buffer, WD_USE_TRANSFER_READ);
        use_buffer(gpu, staging, WD_USE_TRANSFER_WRITE);
        const VkBufferCopy copy = {offset + done, 0, part};
        vkCmdCopyBuffer(gpu->transfer->commands, buffer->buffer, staging->buffer, 1, &copy);
        use_buffer(gpu, staging, WD_USE_HOST_READ);
        if (!submit_and_wait(gpu))
            return false;
        memcpy((char *)data + done, staging->mapped, part);
    }
    return true;
}

/* One mip of one layer, moved in bands of whole rows: of texels, or of blocks of them. */
struct bands {
    uint32_t layer, mip, width, height, block_side, rows;
    size_t row_bytes;
    uint32_t rows_per_band;
};

static struct bands bands_of(const struct wd_image *image, uint32_t layer, uint32_t mip)
{
    uint32_t width = image->width >> mip, height = image->height >> mip;
    struct bands bands = {layer, mip, width ? width : 1, height ? height : 1,
                          wd_format_block_side(image->format), 0, 0, 1};
    bands.rows = (bands.height + bands.block_side - 1) / bands.block_side;
    bands.row_bytes = (size_t)((bands.width + bands.block_side - 1) / bands.block_side) *
                      wd_format_texel_bytes(image->format);
    return bands;
}

static bool plan_bands(struct wd_gpu *gpu, const struct wd_image *image, uint32_t layer,
                       uint32_t mip, size_t size, struct bands *bands)
{
    assert(layer < image->layers && mip < image->mips);
    *bands = bands_of(image, layer, mip);
    if (bands->row_bytes == 0 || size != bands->row_bytes * bands->rows) {
        return wd_error(gpu->log, "image data of %zu bytes where %ux%u texels of %u bytes are due",
                        size, bands->width, bands->height, wd_format_texel_bytes(image->format));
    }
    if (bands->row_bytes < chunk_bytes)
        bands->rows_per_band = (uint32_t)(chunk_bytes / bands->row_bytes);
    if (bands->rows_per_band > bands->rows)
        bands->rows_per_band = bands->rows;
    return true;
}

static VkBufferImageCopy band_copy(const struct wd_image *image, const struct bands *bands,
                                   uint32_t row)
{
    uint32_t first = row * bands->block_side, most = bands->rows_per_band * bands->block_side;
    uint32_t left = bands->height - first;
    return (VkBufferImageCopy){
        .imageSubresource = {image->aspect, bands->mip, bands->layer, 1},
        .imageOffset = {0, (int32_t)first, 0},
        .imageExtent = {bands->width, left < most ? left : most, 1},
    };
}

static size_t band_bytes(const struct bands *bands, const VkBufferImageCopy *copy)
{
    return bands->row_bytes *
           ((copy->imageExtent.height + bands->block_side - 1) / bands->block_side);
}

bool wd_image_upload(struct wd_gpu *gpu, struct wd_image *image, uint32_t layer, uint32_t mip,
                     const void *data, size_t size)
{
    struct bands bands;
    if (!plan_bands(gpu, image, layer, mip, size, &bands))
        return false;
    for (uint32_t row = 0; row < bands.rows; row += bands.rows_per_band) {
        VkBufferImageCopy copy = band_copy(image, &bands, row);
        size_t part = band_bytes(&bands, &copy);
        if (!begin(gpu, WD_MEMORY_UPLOAD, part))
            return false;
        struct wd_buffer *staging = &gpu->transfer->upload;
        memcpy(staging->mapped, (const char *)data + bands.row_bytes * row, part);
        use_image(gpu, image, WD_USE_TRANSFER_WRITE);
        vkCmdCopyBufferToImage(gpu->transfer->commands, staging->buffer, image->image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        if (!submit_and_wait(gpu))
            return false;
    }
    return true;
}

size_t wd_image_layer_bytes(const struct wd_image *image)
{
    size_t bytes = 0;
    for (uint32_t mip = 0; mip < image->mips; mip++) {
        const struct bands bands = bands_of(image, 0, mip);
        bytes += bands.row_bytes * bands.rows;
    }
    return bytes;
}

/* Records the copies of one layer's mips from `offset` of the staging on. */
static void copy_layer(struct wd_gpu *gpu, struct wd_image *image, uint32_t layer, size_t offset)
{
    for (uint32_t mip = 0; mip < image->mips; mip++) {
        struct bands bands = bands_of(image, layer, mip);
        bands.rows_per_band = bands.rows;
        VkBufferImageCopy copy = band_copy(image, &bands, 0);
        copy.bufferOffset = offset;
        vkCmdCopyBufferToImage(gpu->transfer->commands, gpu->transfer->upload.buffer, image->image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        offset += bands.row_bytes * bands.rows;
    }
}

bool wd_image_upload_layers(struct wd_gpu *gpu, struct wd_image *image, uint32_t first,
                            uint32_t count, const void *data)
{
    size_t bytes = wd_image_layer_bytes(image);
    assert(first + count <= image->layers && bytes <= chunk_bytes);
    uint32_t most = (uint32_t)(chunk_bytes / bytes);
    for (uint32_t done = 0; done < count; done += most) {
        uint32_t part = count - done < most ? count - done : most;
        if (!begin(gpu, WD_MEMORY_UPLOAD, part * bytes))
            return false;
        memcpy(gpu->transfer->upload.mapped, (const char *)data + done * bytes, part * bytes);
        use_image(gpu, image, WD_USE_TRANSFER_WRITE);
        for (uint32_t i = 0; i < part; i++)
            copy_layer(gpu, image, first + done + i, i * bytes);
        if (!submit_and_wait(gpu))
            return false;
    }
    return true;
}

void wd_transfer_drop_staging(struct wd_gpu *gpu)
{
    if (!gpu->transfer)
        return;
    wd_buffer_finish(&gpu->transfer->upload, gpu);
    wd_buffer_finish(&gpu->transfer->readback, gpu);
}

bool wd_image_read(struct wd_gpu *gpu, struct wd_image *image, uint32_t layer, uint32_t mip,
                   void *data, size_t size)
{
    struct bands bands;
    if (!plan_bands(gpu, image, layer, mip, size, &bands))
        return false;
    for (uint32_t row = 0; row < bands.rows; row += bands.rows_per_band) {
        VkBufferImageCopy copy = band_copy(image, &bands, row);
        size_t part = band_bytes(&bands, &copy);
        if (!begin(gpu, WD_MEMORY_READBACK, part))
            return false;
        struct wd_buffer *staging = &gpu->transfer->readback;
        use_image(gpu, image, WD_USE_TRANSFER_READ);
        use_buffer(gpu, staging, WD_USE_TRANSFER_WRITE);
        vkCmdCopyImageToBuffer(gpu->transfer->commands, image->image,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging->buffer, 1, &copy);
        use_buffer(gpu, staging, WD_USE_HOST_READ);
        if (!submit_and_wait(gpu))
            return false;
        memcpy((char *)data + bands.row_bytes * row, staging->mapped, part);
    }
    return true;
}
