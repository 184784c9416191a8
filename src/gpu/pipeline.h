/* pipeline.h: compute and graphics pipelines from SPIR-V that is embedded in the program. The device keeps them
 * until it is finished: what is asked for with equal parameters is the same pipeline. Drivers make one when it is
 * first bound, for a picture needs about half of those that its renderer has; for windows and on an embedder's device
 * at once, so that no frame waits for one. */
#ifndef WD_GPU_PIPELINE_H
#define WD_GPU_PIPELINE_H

#include "gpu/device.h"

/* SPIR-V words as the build embeds them (NAME.inc): kept as long as the program, as pipelines are told apart by where
 * they lie. */
struct wd_spirv {
    const uint32_t *words;
    size_t size; /* bytes */
    const char *name;
};
/* Initializes a struct wd_spirv from such an array. */
#define WD_SPIRV(words) {words, sizeof words, #words}

/* One descriptor set (set 0); binding i has type types[i]. All stages see all bindings. */
enum { WD_MAX_BINDINGS = 18 };
struct wd_bindings {
    uint32_t count;
    VkDescriptorType types[WD_MAX_BINDINGS];
};

struct wd_pipeline {
    struct wd_kept_pipeline *kept; /* by the device; NULL: there is none */
    VkPipelineLayout layout;
    VkDescriptorSetLayout set_layout;
    VkPipelineBindPoint bind_point;
    struct wd_bindings bindings;
    uint32_t push_size;
};

/* Specialization constants 0..count-1, 32 bits each. */
struct wd_spec_constants {
    uint32_t count;
    const uint32_t *values;
};

struct wd_compute_params {
    struct wd_spirv shader;
    struct wd_bindings bindings;
    uint32_t push_size; /* bytes of push constants, at most 128 */
    struct wd_spec_constants constants;
};
bool wd_pipeline_init_compute(struct wd_pipeline *pipeline, struct wd_gpu *gpu,
                              const struct wd_compute_params *params);

enum { WD_MAX_COLOR_TARGETS = 4 };
enum wd_cull { WD_CULL_NONE, WD_CULL_BACK, WD_CULL_FRONT };
enum wd_blend { WD_BLEND_OFF, WD_BLEND_PREMULTIPLIED };
enum { WD_MAX_VERTEX_ATTRIBUTES = 4 };
struct wd_graphics_params {
    struct wd_spirv vertex;
    struct wd_spirv fragment; /* .words NULL: depth only */
    struct wd_vertex_layout {
        uint32_t stride, count; /* count 0: vertices are pulled from storage buffers */
        struct {
            VkFormat format;
            uint32_t offset;
        } attributes[WD_MAX_VERTEX_ATTRIBUTES]; /* by location */
    } vertices;
    struct wd_bindings bindings;
    uint32_t push_size;
    struct wd_spec_constants constants; /* for both stages */
    uint32_t color_count;
    VkFormat color_formats[WD_MAX_COLOR_TARGETS];
    enum wd_color_writes { WD_COLORS_WRITTEN, WD_COLORS_KEPT } color_writes;
    enum wd_blend blend;
    VkFormat depth_format;       /* VK_FORMAT_UNDEFINED: no depth */
    VkCompareOp depth_compare;   /* NEVER (0): GREATER, depth is reversed: 1 near, 0 far */
    bool depth_read_only;
    enum wd_cull cull;           /* counter-clockwise is front */
    VkPrimitiveTopology topology; /* 0 would be points: set TRIANGLE_LIST yourself */
    float depth_bias_constant, depth_bias_slope; /* both 0: off */
};
/* Viewport and scissor are dynamic; wd_cmd_begin_rendering sets them. */
bool wd_pipeline_init_graphics(struct wd_pipeline *pipeline, struct wd_gpu *gpu,
                               const struct wd_graphics_params *params);

/* Has the driver make it now: many are made by several threads in less time. False, with a message, on failure. Any
 * thread may do so. */
bool wd_pipeline_make(const struct wd_pipeline *pipeline, struct wd_gpu *gpu);

enum wd_sampler_kind {
    WD_SAMPLER_NEAREST_CLAMP,
    WD_SAMPLER_LINEAR_CLAMP,
    WD_SAMPLER_MAGNIFY_CLAMP, /* linear where a texel is larger than a pixel, else nearest */
    WD_SAMPLER_LINEAR_REPEAT,
    WD_SAMPLER_TRILINEAR_CLAMP,
    WD_SAMPLER_TRILINEAR_REPEAT,
    WD_SAMPLER_SHADOW, /* linear compare GREATER_OR_EQUAL, border 0 */
};
bool wd_sampler_init(VkSampler *sampler, struct wd_gpu *gpu, enum wd_sampler_kind kind);

#endif
