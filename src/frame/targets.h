/* targets.h: the images of a frame that passes share. */
#ifndef WD_FRAME_TARGETS_H
#define WD_FRAME_TARGETS_H

#include "gpu/command.h"
#include "shared/frame.h"

#define WD_ALBEDO_FORMAT VK_FORMAT_R8G8B8A8_SRGB
#define WD_ALBEDO_STORED VK_FORMAT_R8G8B8A8_UNORM /* by compute, see lib/stored_targets.glsl */
#define WD_NORMAL_FORMAT VK_FORMAT_A2B10G10R10_UNORM_PACK32
#define WD_SURFACE_FORMAT VK_FORMAT_R32_UINT
#define WD_DEPTH_FORMAT VK_FORMAT_D32_SFLOAT
#define WD_DEPTH_STORED VK_FORMAT_R32_SFLOAT
#define WD_OVERLAY_FORMAT VK_FORMAT_R16G16B16A16_SFLOAT
#define WD_RADIANCE_FORMAT VK_FORMAT_R32G32B32A32_SFLOAT
#define WD_DISPLAY_FORMAT VK_FORMAT_R8G8B8A8_UNORM

struct wd_targets {
    uint32_t width, height;
    struct wd_image albedo, normal, surface, depth; /* the G-buffer: shaders/shared/frame.h */
    struct wd_image overlay;                        /* premultiplied radiance over the G-buffer's,
                                                       of methods that blend; else not written */
    struct wd_image radiance;                       /* storage: sum over the samples so far */
    struct wd_image display;                        /* storage: tone-mapped, sRGB-encoded bytes */
    struct wd_image shadow;                         /* depth, WD_CASCADES layers */
    struct wd_image stored_shadow;                  /* the same, of methods that store it; {0} where targets
                                                       cannot be stored to */
    bool shadow_is_stored;                          /* which of both holds it */
    VkImageView shadow_layers[WD_CASCADES];
    uint32_t shadow_size;
};

bool wd_targets_init(struct wd_targets *targets, struct wd_gpu *gpu, uint32_t width,
                     uint32_t height, uint32_t shadow_size);
void wd_targets_finish(struct wd_targets *targets, struct wd_gpu *gpu);

/* The one that holds the maps of this frame. */
struct wd_image *wd_targets_shadow(struct wd_targets *targets);

/* The G-buffer as targets of a rendering: albedo, normal, surface, depth in this order. `load` says
 * whether it is cleared or kept. */
struct wd_rendering wd_targets_gbuffer(struct wd_targets *targets, enum wd_load load);

#endif
