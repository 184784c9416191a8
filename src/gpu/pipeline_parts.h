/* pipeline_parts.h: what compute and graphics pipelines have in common. */
#ifndef WD_GPU_PIPELINE_PARTS_H
#define WD_GPU_PIPELINE_PARTS_H

#include "gpu/pipeline.h"

enum { WD_MAX_SPEC_CONSTANTS = 32 };

/* Storage for VkSpecializationInfo; must outlive its use. */
struct wd_specialization {
    VkSpecializationMapEntry entries[WD_MAX_SPEC_CONSTANTS];
    VkSpecializationInfo info;
};
void wd_specialization_init(struct wd_specialization *specialization,
                            const struct wd_spec_constants *constants);

/* Set layout and pipeline layout for stages `stages`. `name` shows in errors. */
bool wd_pipeline_init_layout(struct wd_pipeline *pipeline, struct wd_gpu *gpu,
                             const struct wd_bindings *bindings, uint32_t push_size,
                             VkShaderStageFlags stages, const char *name);
void wd_pipeline_destroy_layout(struct wd_pipeline *pipeline, struct wd_gpu *gpu);
bool wd_spirv_check(const struct wd_spirv *spirv, struct wd_gpu *gpu);
bool wd_shader_module_init(VkShaderModule *module, struct wd_gpu *gpu,
                           const struct wd_spirv *spirv);
VkShaderStageFlags wd_pipeline_stages(const struct wd_pipeline *pipeline);

/* All that a pipeline is made from; shaders by where their words lie. */
struct wd_pipeline_key {
    size_t size;
    unsigned char bytes[1024];
};
void wd_pipeline_key_add(struct wd_pipeline_key *key, const void *bytes, size_t size);
void wd_pipeline_key_add_constants(struct wd_pipeline_key *key, const struct wd_spec_constants *constants);

/* Of its two parameters the one that suits the bind point. */
struct wd_pipeline_params {
    struct wd_compute_params compute;
    struct wd_graphics_params graphics;
};

/* VK_NULL_HANDLE, with a message, on failure. */
VkPipeline wd_compute_create(struct wd_gpu *gpu, VkPipelineLayout layout, const struct wd_compute_params *params);
VkPipeline wd_graphics_create(struct wd_gpu *gpu, VkPipelineLayout layout, const struct wd_graphics_params *params);

/* The driver's; VK_NULL_HANDLE where it has not been made yet. */
VkPipeline wd_pipeline_made(const struct wd_pipeline *pipeline);

/* What the device keeps. Threads may ask for pipelines at the same time. */
void wd_pipeline_store_init(struct wd_gpu *gpu);
void wd_pipeline_store_finish(struct wd_gpu *gpu); /* destroys them */
bool wd_pipeline_find(struct wd_pipeline *pipeline, struct wd_gpu *gpu, const struct wd_pipeline_key *key);
/* Keeps `pipeline`, which has a layout, with a copy of what it is made from; where another thread has kept one of the
 * same key, this one's layout is destroyed and that is given. False, with {0} and a message, if it was to be made at once
 * and was not; then the next who asks for it has another try. */
bool wd_pipeline_keep(struct wd_pipeline *pipeline, struct wd_gpu *gpu, const struct wd_pipeline_key *key,
                      const struct wd_pipeline_params *params);

#endif
