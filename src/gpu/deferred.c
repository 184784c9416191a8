#include "gpu/deferred.h"

#include <stdlib.h>

#include "base/memory.h"

static struct wd_deferred *add(struct wd_frame_slot *slot)
{
    struct wd_deferred *item = wd_alloc(sizeof *item);
    item->next = slot->deferred;
    slot->deferred = item;
    return item;
}

void wd_cmd_defer_buffer(struct wd_cmd *cmd, struct wd_buffer *buffer)
{
    if (!buffer->buffer)
        return;
    add(cmd->slot)->buffer = *buffer;
    *buffer = (struct wd_buffer){0};
}

void wd_cmd_defer_image(struct wd_cmd *cmd, struct wd_image *image)
{
    if (!image->image)
        return;
    add(cmd->slot)->image = *image;
    *image = (struct wd_image){0};
}

void wd_defer_upload(struct wd_frame_slot *slot)
{
    add(slot)->upload = slot->upload;
    slot->upload = NULL;
}

void wd_deferred_free(struct wd_frame_slot *slot, struct wd_gpu *gpu)
{
    while (slot->deferred) {
        struct wd_deferred *item = slot->deferred;
        slot->deferred = item->next;
        wd_buffer_finish(&item->buffer, gpu);
        wd_image_finish(&item->image, gpu);
        if (item->upload)
            wd_buffer_finish(item->upload, gpu);
        free(item->upload);
        free(item);
    }
}
