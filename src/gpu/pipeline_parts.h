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
bool wd_shader_module_init(VkShaderModule *module, struct wd_gpu *gpu,
                           const struct wd_spirv *spirv);
VkShaderStageFlags wd_pipeline_stages(const struct wd_pipeline *pipeline);

#endif
