#include "gpu/pipeline.h"

#include <assert.h>

#include "base/log.h"
#include "gpu/allocation.h"
#include "gpu/pipeline_parts.h"

void wd_specialization_init(struct wd_specialization *specialization,
                            const struct wd_spec_constants *constants)
{
    assert(constants->count <= WD_MAX_SPEC_CONSTANTS);
    for (uint32_t i = 0; i < constants->count; i++)
        specialization->entries[i] = (VkSpecializationMapEntry){i, i * 4, 4};
    specialization->info = (VkSpecializationInfo){
        .mapEntryCount = constants->count,
        .pMapEntries = specialization->entries,
        .dataSize = constants->count * 4,
        .pData = constants->values,
    };
}

static VkResult create_set_layout(struct wd_pipeline *pipeline, struct wd_gpu *gpu,
                                  VkShaderStageFlags stages)
{
    VkDescriptorSetLayoutBinding bindings[WD_MAX_BINDINGS];
    for (uint32_t i = 0; i < pipeline->bindings.count; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = pipeline->bindings.types[i],
            .descriptorCount = 1,
            .stageFlags = stages,
        };
    }
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = pipeline->bindings.count,
        .pBindings = bindings,
    };
    return vkCreateDescriptorSetLayout(gpu->device, &info, NULL, &pipeline->set_layout);
}

bool wd_pipeline_init_layout(struct wd_pipeline *pipeline, struct wd_gpu *gpu,
                             const struct wd_bindings *bindings, uint32_t push_size,
                             VkShaderStageFlags stages, const char *name)
{
    assert(bindings->count <= WD_MAX_BINDINGS && push_size <= 128 && push_size % 4 == 0);
    pipeline->bindings = *bindings;
    pipeline->push_size = push_size;
    VkResult result = create_set_layout(pipeline, gpu, stages);
    if (!wd_gpu_check(gpu, result, name))
        return false;
    const VkPushConstantRange range = {stages, 0, push_size};
    const VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &pipeline->set_layout,
        .pushConstantRangeCount = push_size ? 1 : 0,
        .pPushConstantRanges = &range,
    };
    result = vkCreatePipelineLayout(gpu->device, &info, NULL, &pipeline->layout);
    return wd_gpu_check(gpu, result, name);
}

bool wd_spirv_check(const struct wd_spirv *spirv, struct wd_gpu *gpu)
{
    const uint32_t spirv_magic = 0x07230203;
    if (spirv->size < 20 || spirv->size % 4 != 0 || spirv->words[0] != spirv_magic)
        return wd_error(gpu->log, "shader \"%s\" is not SPIR-V", spirv->name);
    return true;
}

bool wd_shader_module_init(VkShaderModule *module, struct wd_gpu *gpu, const struct wd_spirv *spirv)
{
    *module = VK_NULL_HANDLE;
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = spirv->size,
        .pCode = spirv->words,
    };
    return wd_gpu_check(gpu, vkCreateShaderModule(gpu->device, &info, NULL, module), spirv->name);
}

VkShaderStageFlags wd_pipeline_stages(const struct wd_pipeline *pipeline)
{
    return pipeline->bind_point == VK_PIPELINE_BIND_POINT_COMPUTE
               ? VK_SHADER_STAGE_COMPUTE_BIT
               : VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
}

VkPipeline wd_compute_create(struct wd_gpu *gpu, VkPipelineLayout layout, const struct wd_compute_params *params)
{
    VkShaderModule module;
    VkPipeline made = VK_NULL_HANDLE;
    if (!wd_shader_module_init(&module, gpu, &params->shader))
        return VK_NULL_HANDLE;
    struct wd_specialization specialization;
    wd_specialization_init(&specialization, &params->constants);
    const VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = VK_SHADER_STAGE_COMPUTE_BIT,
            .module = module,
            .pName = "main",
            .pSpecializationInfo = &specialization.info,
        },
        .layout = layout,
    };
    VkResult result = vkCreateComputePipelines(gpu->device, gpu->pipeline_cache, 1, &info, NULL, &made);
    vkDestroyShaderModule(gpu->device, module, NULL);
    if (!wd_gpu_check(gpu, result, params->shader.name))
        return VK_NULL_HANDLE;
    wd_set_object_name(gpu, VK_OBJECT_TYPE_PIPELINE, (uint64_t)(uintptr_t)made, params->shader.name);
    return made;
}

static void add_compute(struct wd_pipeline_key *key, const struct wd_compute_params *params)
{
    wd_pipeline_key_add(key, &params->shader.words, sizeof params->shader.words);
    wd_pipeline_key_add(key, &params->bindings, sizeof params->bindings);
    wd_pipeline_key_add(key, &params->push_size, sizeof params->push_size);
    wd_pipeline_key_add_constants(key, &params->constants);
}

bool wd_pipeline_init_compute(struct wd_pipeline *pipeline, struct wd_gpu *gpu,
                              const struct wd_compute_params *params)
{
    struct wd_pipeline_key key = {0};
    add_compute(&key, params);
    if (!gpu->lost && wd_pipeline_find(pipeline, gpu, &key))
        return true;
    *pipeline = (struct wd_pipeline){.bind_point = VK_PIPELINE_BIND_POINT_COMPUTE};
    if (gpu->lost || !wd_spirv_check(&params->shader, gpu) ||
        !wd_pipeline_init_layout(pipeline, gpu, &params->bindings, params->push_size,
                                 VK_SHADER_STAGE_COMPUTE_BIT, params->shader.name)) {
        wd_pipeline_destroy_layout(pipeline, gpu);
        return false;
    }
    return wd_pipeline_keep(pipeline, gpu, &key, &(struct wd_pipeline_params){.compute = *params});
}

void wd_pipeline_destroy_layout(struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    if (pipeline->layout)
        vkDestroyPipelineLayout(gpu->device, pipeline->layout, NULL);
    if (pipeline->set_layout)
        vkDestroyDescriptorSetLayout(gpu->device, pipeline->set_layout, NULL);
    *pipeline = (struct wd_pipeline){0};
}
