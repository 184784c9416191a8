/* deferred.h: objects that die when the frame that used them last has finished. */
#ifndef WD_GPU_DEFERRED_H
#define WD_GPU_DEFERRED_H

#include "gpu/command.h"

struct wd_deferred {
    struct wd_deferred *next;
    struct wd_buffer buffer;
    struct wd_image image;
    struct wd_buffer *upload; /* a whole upload arena that bindings may still point to; or NULL */
};

/* Takes over slot->upload. */
void wd_defer_upload(struct wd_frame_slot *slot);
/* Destroys everything that waits in the slot; its fence must have been waited for. */
void wd_deferred_free(struct wd_frame_slot *slot, struct wd_gpu *gpu);

#endif
