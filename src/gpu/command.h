/* command.h: recording work: frames in flight, tracked barriers, bindings, scopes with time. */
#ifndef WD_GPU_COMMAND_H
#define WD_GPU_COMMAND_H

#include "gpu/memory.h"
#include "gpu/pipeline.h"

enum { WD_FRAMES_IN_FLIGHT = 2, WD_MAX_SCOPES = 64, WD_MAX_SCOPE_DEPTH = 8 };

/* Time of one named scope of a finished frame. */
struct wd_scope_time {
    char name[32];
    double gpu_us; /* device time (timestamps), or wall clock of a scope that was submitted alone */
    double cpu_us; /* time spent recording it */
    double processor_us; /* that all threads ran in it, where the scope runs alone; else 0 */
    uint32_t depth; /* nesting, 0 outermost; a parent's time includes its children's */
};

enum wd_timing {
    WD_TIMING_OFF,
    /* Timestamps where the device has true ones; else what lies between one scope's begin or end and the next
     * is submitted alone and timed by fence + wall clock. Slower, but true. */
    WD_TIMING_ON,
};

struct wd_deferred; /* objects that wait for the device before they die */

/* A ring of frames in flight; each has a command buffer, descriptor pools and an upload arena. */
struct wd_frame_slot {
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
    VkDescriptorPool *descriptor_pools;
    size_t descriptor_pool_count, descriptor_pool_used, descriptor_pool_capacity;
    size_t descriptor_sets_used; /* of the pool in use */
    struct wd_buffer *upload; /* replaced by a larger one on demand; uniforms, per-frame arrays */
    VkDeviceSize upload_used;
    VkQueryPool queries;
    uint32_t scope_count;
    struct wd_scope_time scopes[WD_MAX_SCOPES];
    struct wd_deferred *deferred;
    struct wd_barrier *barriers; /* recorded since the last submission; see wd_frame_submit */
    size_t barrier_count, barrier_capacity;
    bool pending; /* submitted, fence not yet waited for */
};
struct wd_frames {
    struct wd_gpu *gpu;
    struct wd_frame_slot slots[WD_FRAMES_IN_FLIGHT];
    uint32_t next;
    enum wd_timing timing;
    struct wd_scope_time last_scopes[WD_MAX_SCOPES]; /* of the newest finished frame */
    uint32_t last_scope_count;
};

bool wd_frames_init(struct wd_frames *frames, struct wd_gpu *gpu);
void wd_frames_finish(struct wd_frames *frames); /* waits for all; accepts {0} */

/* A frame being recorded. */
struct wd_cmd {
    struct wd_gpu *gpu;
    struct wd_frames *frames;
    struct wd_frame_slot *slot;
    VkCommandBuffer vk; /* changes when a scope is submitted alone: do not keep it */
    bool failed;        /* a pipeline, descriptor or upload could not be had; wd_frame_submit returns false */
    uint32_t scope_stack[WD_MAX_SCOPE_DEPTH], scope_depth;
    double scope_start[WD_MAX_SCOPES], scope_processor[WD_MAX_SCOPES];
    enum wd_timing timing; /* of this frame */
    bool rendering;        /* between wd_cmd_begin_rendering and wd_cmd_end_rendering */
    bool recorded;         /* something was recorded since the frame or scope began or ended */
    double waited_s;       /* spent waiting for scopes that were submitted alone */
};

/* Waits until the slot's earlier frame is done, frees what was deferred, starts recording. */
bool wd_frame_begin(struct wd_frames *frames, struct wd_cmd *cmd);
/* Ends and submits; wait/signal may be VK_NULL_HANDLE (binary semaphores, for swapchains). `wait`
 * holds back the frame's transfers: what it guards is copied into. To be called for every frame
 * that was begun, also after a failure. A failed frame draws nothing: only its barriers are
 * submitted, so that tracked uses stay true; `wait` is consumed, `signal` is not signalled, the
 * result is false and the next frame may begin. With timing on a device without true timestamps,
 * work on the image that `wait` guards must stand after the last scope. */
bool wd_frame_submit(struct wd_cmd *cmd, VkSemaphore wait, VkSemaphore signal);
/* Waits for every submitted frame; afterwards frames->last_scopes is that of the newest one. */
bool wd_frames_wait(struct wd_frames *frames);

/* Begins and ends a named part of the frame (debug label + timer); at most WD_MAX_SCOPE_DEPTH deep. No rendering may
 * be open, and what is bound does not survive a scope's begin or end. */
void wd_cmd_scope_begin(struct wd_cmd *cmd, const char *name);
void wd_cmd_scope_end(struct wd_cmd *cmd);

/* Declares the next use; emits the barrier (and layout change) since the last use, if one is
 * needed. Write after write and write after read count; read after read does not. */
void wd_cmd_use_buffer(struct wd_cmd *cmd, struct wd_buffer *buffer, enum wd_gpu_use use);
void wd_cmd_use_image(struct wd_cmd *cmd, struct wd_image *image, enum wd_gpu_use use);
/* The old contents are not needed: the layout change may discard them. */
void wd_cmd_discard_image(struct wd_cmd *cmd, struct wd_image *image, enum wd_gpu_use use);

/* A descriptor's content; which fields count follows from the pipeline's binding type. An unused
 * slot must still be filled (lavapipe reads it). */
struct wd_binding {
    const struct wd_buffer *buffer;
    VkDeviceSize offset, size; /* size 0: the rest */
    VkImageView view;
    VkImageLayout layout; /* 0: SHADER_READ_ONLY_OPTIMAL for sampled, GENERAL for storage */
    VkSampler sampler;
};
#define WD_BIND_BUFFER(b) ((struct wd_binding){.buffer = (b)})
#define WD_BIND_IMAGE(i, s) ((struct wd_binding){.view = (i)->view, .sampler = (s)})
#define WD_BIND_STORAGE_IMAGE(i)                                                                   \
    ((struct wd_binding){.view = (i)->stored ? (i)->stored : (i)->view})
/* Binds the pipeline and a fresh descriptor set with `bindings[pipeline->bindings.count]`. Buffers that a transfer
 * has written must have been declared as used since. */
void wd_cmd_bind(struct wd_cmd *cmd, const struct wd_pipeline *pipeline,
                 const struct wd_binding *bindings);
void wd_cmd_push(struct wd_cmd *cmd, const struct wd_pipeline *pipeline, const void *data,
                 uint32_t size);

/* Draws and indirect work that do nothing in a failed frame (prefer them to vkCmd*). The buffer's
 * use must have been declared as WD_USE_INDIRECT. */
void wd_cmd_draw(struct wd_cmd *cmd, uint32_t vertices, uint32_t instances);
/* Vertices of the pipeline's layout, 32-bit indices; both in use as WD_USE_INDEX. */
void wd_cmd_bind_vertices(struct wd_cmd *cmd, const struct wd_buffer *vertices);
void wd_cmd_bind_indices(struct wd_cmd *cmd, const struct wd_buffer *indices);
void wd_cmd_bind_indices_of(struct wd_cmd *cmd, const struct wd_buffer *indices, VkIndexType type);
void wd_cmd_draw_indexed(struct wd_cmd *cmd, const VkDrawIndexedIndirectCommand *draw);
/* One indexed draw with its parameters from the buffer, the first instance 0. */
void wd_cmd_draw_indexed_indirect(struct wd_cmd *cmd, const struct wd_buffer *buffer,
                                  VkDeviceSize offset);
void wd_cmd_dispatch_indirect(struct wd_cmd *cmd, const struct wd_buffer *buffer,
                              VkDeviceSize offset);
/* Fills a whole buffer with a 32-bit value; declares the use. */
void wd_cmd_fill_buffer(struct wd_cmd *cmd, struct wd_buffer *buffer, uint32_t value);

/* Texels of all of a layer's first mip, tightly packed from `offset` on; declares both uses. Outside of any
 * rendering. */
void wd_cmd_copy_to_image(struct wd_cmd *cmd, struct wd_buffer *buffer, VkDeviceSize offset,
                          struct wd_image *image, uint32_t layer);

/* Space in this frame's upload arena (256-byte aligned); NULL marks the frame failed. `*binding`
 * describes the range for wd_cmd_bind. */
void *wd_cmd_upload(struct wd_cmd *cmd, VkDeviceSize size, struct wd_binding *binding);

struct wd_color_attachment {
    struct wd_image *image;
    VkImageView view; /* VK_NULL_HANDLE: image->view */
    enum wd_load { WD_LOAD_KEEP, WD_LOAD_CLEAR } load;
    VkClearColorValue clear;
};
struct wd_rendering {
    uint32_t width, height;
    uint32_t color_count;
    struct wd_color_attachment color[WD_MAX_COLOR_TARGETS];
    struct wd_image *depth; /* or NULL */
    VkImageView depth_view; /* VK_NULL_HANDLE: depth->view */
    enum wd_load depth_load; /* clears to 0 (far; depth is reversed) */
};
/* Declares the uses, begins dynamic rendering, sets viewport (y down, depth 0..1) and scissor. */
void wd_cmd_begin_rendering(struct wd_cmd *cmd, const struct wd_rendering *rendering);
void wd_cmd_end_rendering(struct wd_cmd *cmd);

/* Dispatches `groups` workgroups in 2D so that no dimension passes the device's limit; the shader
 * takes its index as gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x and checks bounds. */
void wd_cmd_dispatch_1d(struct wd_cmd *cmd, uint64_t groups);
void wd_cmd_dispatch(struct wd_cmd *cmd, uint32_t x, uint32_t y, uint32_t z);

/* Destroys the object once the device has finished this frame; `*buffer`/`*image` becomes {0}. */
void wd_cmd_defer_buffer(struct wd_cmd *cmd, struct wd_buffer *buffer);
void wd_cmd_defer_image(struct wd_cmd *cmd, struct wd_image *image);

#endif
