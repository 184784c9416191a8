#include "gpu/command.h"

#include <assert.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"
#include "gpu/deferred.h"
#include "gpu/frames.h"

void wd_cmd_use_buffer(struct wd_cmd *cmd, struct wd_buffer *buffer, enum wd_gpu_use use)
{
    struct wd_barrier barrier;
    if (!wd_barrier_for_buffer(buffer, use, &barrier))
        return;
    assert(!cmd->rendering);
    wd_frame_barrier(cmd, &barrier);
}

static void use_image(struct wd_cmd *cmd, struct wd_image *image, enum wd_gpu_use use,
                      enum wd_contents contents)
{
    struct wd_barrier barrier;
    if (!wd_barrier_for_image(image, use, contents, &barrier))
        return;
    assert(!cmd->rendering);
    wd_frame_barrier(cmd, &barrier);
}

void wd_cmd_use_image(struct wd_cmd *cmd, struct wd_image *image, enum wd_gpu_use use)
{
    use_image(cmd, image, use, WD_CONTENTS_KEEP);
}

void wd_cmd_discard_image(struct wd_cmd *cmd, struct wd_image *image, enum wd_gpu_use use)
{
    use_image(cmd, image, use, WD_CONTENTS_DISCARD);
}

static bool grow_upload(struct wd_cmd *cmd, VkDeviceSize size)
{
    struct wd_frame_slot *slot = cmd->slot;
    VkDeviceSize wanted = slot->upload ? 2 * slot->upload->size : 1 << 20;
    if (wanted < size)
        wanted = size;
    if (slot->upload)
        wd_defer_upload(slot);
    slot->upload_used = 0;
    slot->upload = wd_alloc(sizeof *slot->upload);
    const struct wd_buffer_params params = {
        .name = "upload arena",
        .size = wanted,
        .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
        .memory = WD_MEMORY_UPLOAD,
    };
    if (wd_buffer_init(slot->upload, cmd->gpu, &params))
        return true;
    free(slot->upload);
    slot->upload = NULL;
    return false;
}

void *wd_cmd_upload(struct wd_cmd *cmd, VkDeviceSize size, struct wd_binding *binding)
{
    assert(size > 0);
    struct wd_frame_slot *slot = cmd->slot;
    *binding = (struct wd_binding){0};
    VkDeviceSize offset = (slot->upload_used + 255) & ~(VkDeviceSize)255;
    if (!slot->upload || offset > slot->upload->size || size > slot->upload->size - offset) {
        if (cmd->failed || !grow_upload(cmd, size)) {
            cmd->failed = true;
            return NULL;
        }
        offset = 0;
    }
    slot->upload_used = offset + size;
    *binding = (struct wd_binding){.buffer = slot->upload, .offset = offset, .size = size};
    return (char *)slot->upload->mapped + offset;
}

void wd_cmd_dispatch(struct wd_cmd *cmd, uint32_t x, uint32_t y, uint32_t z)
{
    if (cmd->failed || x == 0 || y == 0 || z == 0)
        return;
    cmd->recorded = true;
    vkCmdDispatch(cmd->vk, x, y, z);
}

void wd_cmd_dispatch_1d(struct wd_cmd *cmd, uint64_t groups)
{
    if (cmd->failed || groups == 0)
        return;
    const uint32_t *most = cmd->gpu->properties.limits.maxComputeWorkGroupCount;
    uint64_t rows = (groups + most[0] - 1) / most[0];
    if (rows > most[1]) {
        wd_error(cmd->gpu->log, "%llu workgroups are more than \"%s\" can dispatch at once",
                 (unsigned long long)groups, cmd->gpu->properties.deviceName);
        cmd->failed = true;
        return;
    }
    wd_cmd_dispatch(cmd, (uint32_t)((groups + rows - 1) / rows), (uint32_t)rows, 1);
}

void wd_cmd_dispatch_indirect(struct wd_cmd *cmd, const struct wd_buffer *buffer,
                              VkDeviceSize offset)
{
    if (cmd->failed)
        return;
    cmd->recorded = true;
    vkCmdDispatchIndirect(cmd->vk, buffer->buffer, offset);
}

void wd_cmd_draw(struct wd_cmd *cmd, uint32_t vertices, uint32_t instances)
{
    assert(cmd->rendering);
    if (!cmd->failed)
        vkCmdDraw(cmd->vk, vertices, instances, 0, 0);
}

void wd_cmd_bind_vertices(struct wd_cmd *cmd, const struct wd_buffer *vertices)
{
    const VkDeviceSize offset = 0;
    if (!cmd->failed)
        vkCmdBindVertexBuffers(cmd->vk, 0, 1, &vertices->buffer, &offset);
}

void wd_cmd_bind_indices(struct wd_cmd *cmd, const struct wd_buffer *indices)
{
    wd_cmd_bind_indices_of(cmd, indices, VK_INDEX_TYPE_UINT32);
}

void wd_cmd_bind_indices_of(struct wd_cmd *cmd, const struct wd_buffer *indices, VkIndexType type)
{
    if (!cmd->failed)
        vkCmdBindIndexBuffer(cmd->vk, indices->buffer, 0, type);
}

void wd_cmd_draw_indexed(struct wd_cmd *cmd, const VkDrawIndexedIndirectCommand *draw)
{
    if (!cmd->failed)
        vkCmdDrawIndexed(cmd->vk, draw->indexCount, draw->instanceCount, draw->firstIndex,
                         draw->vertexOffset, draw->firstInstance);
}

void wd_cmd_draw_indexed_indirect(struct wd_cmd *cmd, const struct wd_buffer *buffer,
                                  VkDeviceSize offset)
{
    assert(cmd->rendering);
    if (!cmd->failed)
        vkCmdDrawIndexedIndirect(cmd->vk, buffer->buffer, offset, 1,
                                 sizeof(VkDrawIndexedIndirectCommand));
}

void wd_cmd_fill_buffer(struct wd_cmd *cmd, struct wd_buffer *buffer, uint32_t value)
{
    assert(!cmd->rendering && buffer->size % 4 == 0);
    wd_cmd_use_buffer(cmd, buffer, WD_USE_TRANSFER_WRITE);
    cmd->recorded = true;
    vkCmdFillBuffer(cmd->vk, buffer->buffer, 0, VK_WHOLE_SIZE, value);
}

void wd_cmd_copy_to_image(struct wd_cmd *cmd, struct wd_buffer *buffer, VkDeviceSize offset,
                          struct wd_image *image, uint32_t layer)
{
    assert(!cmd->rendering && layer < image->layers);
    const VkBufferImageCopy region = {
        .bufferOffset = offset,
        .imageSubresource = {image->aspect, 0, layer, 1},
        .imageExtent = {image->width, image->height, 1},
    };
    wd_cmd_use_buffer(cmd, buffer, WD_USE_TRANSFER_READ);
    wd_cmd_use_image(cmd, image, WD_USE_TRANSFER_WRITE);
    cmd->recorded = true;
    if (!cmd->failed)
        vkCmdCopyBufferToImage(cmd->vk, buffer->buffer, image->image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}
