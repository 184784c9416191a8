#include <assert.h>

#include "gpu/allocation.h"
#include "gpu/pipeline_parts.h"

static VkCullModeFlags cull_mode(enum wd_cull cull)
{
    return cull == WD_CULL_BACK    ? VK_CULL_MODE_BACK_BIT
           : cull == WD_CULL_FRONT ? VK_CULL_MODE_FRONT_BIT
                                   : VK_CULL_MODE_NONE;
}

static VkPipelineRasterizationStateCreateInfo raster_state(const struct wd_graphics_params *params)
{
    return (VkPipelineRasterizationStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .polygonMode = VK_POLYGON_MODE_FILL,
        .cullMode = cull_mode(params->cull),
        .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .depthBiasEnable = params->depth_bias_constant != 0 || params->depth_bias_slope != 0,
        .depthBiasConstantFactor = params->depth_bias_constant,
        .depthBiasSlopeFactor = params->depth_bias_slope,
        .lineWidth = 1,
    };
}

static VkPipelineDepthStencilStateCreateInfo depth_state(const struct wd_graphics_params *params)
{
    bool has_depth = params->depth_format != VK_FORMAT_UNDEFINED;
    bool reversed = params->depth_compare == VK_COMPARE_OP_NEVER;
    return (VkPipelineDepthStencilStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = has_depth,
        .depthWriteEnable = has_depth && !params->depth_read_only,
        .depthCompareOp = reversed ? VK_COMPARE_OP_GREATER : params->depth_compare,
    };
}

/* Integer formats cannot blend: there the switch does nothing. */
static VkPipelineColorBlendAttachmentState blend_state(struct wd_gpu *gpu,
                                                       const struct wd_graphics_params *params,
                                                       VkFormat format)
{
    const VkColorComponentFlags all = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                      VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(gpu->physical_device, format, &properties);
    bool can = properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    return (VkPipelineColorBlendAttachmentState){
        .blendEnable = can && params->blend == WD_BLEND_PREMULTIPLIED,
        .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .colorBlendOp = VK_BLEND_OP_ADD,
        .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .alphaBlendOp = VK_BLEND_OP_ADD,
        .colorWriteMask = params->color_writes == WD_COLORS_KEPT ? 0 : all,
    };
}

static VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage,
                                                  VkShaderModule module,
                                                  const struct wd_specialization *specialization)
{
    return (VkPipelineShaderStageCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = stage,
        .module = module,
        .pName = "main",
        .pSpecializationInfo = &specialization->info,
    };
}

static VkResult create_graphics(VkPipeline *made, struct wd_gpu *gpu, VkPipelineLayout layout,
                                const struct wd_graphics_params *params,
                                const VkPipelineShaderStageCreateInfo *stages, uint32_t stage_count)
{
    const VkVertexInputBindingDescription buffer = {.stride = params->vertices.stride};
    VkVertexInputAttributeDescription attributes[WD_MAX_VERTEX_ATTRIBUTES];
    for (uint32_t i = 0; i < params->vertices.count; i++)
        attributes[i] = (VkVertexInputAttributeDescription){
            .location = i,
            .format = params->vertices.attributes[i].format,
            .offset = params->vertices.attributes[i].offset,
        };
    const VkPipelineVertexInputStateCreateInfo vertex_input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = params->vertices.count ? 1 : 0,
        .pVertexBindingDescriptions = &buffer,
        .vertexAttributeDescriptionCount = params->vertices.count,
        .pVertexAttributeDescriptions = attributes,
    };
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = params->topology,
    };
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1,
    };
    const VkPipelineRasterizationStateCreateInfo raster = raster_state(params);
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT,
    };
    const VkPipelineDepthStencilStateCreateInfo depth = depth_state(params);
    VkPipelineColorBlendAttachmentState targets[WD_MAX_COLOR_TARGETS];
    for (uint32_t i = 0; i < params->color_count; i++)
        targets[i] = blend_state(gpu, params, params->color_formats[i]);
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = params->color_count,
        .pAttachments = targets,
    };
    const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = dynamic_states,
    };
    const VkPipelineRenderingCreateInfo rendering = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = params->color_count,
        .pColorAttachmentFormats = params->color_formats,
        .depthAttachmentFormat = params->depth_format,
    };
    const VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .pNext = &rendering,
        .stageCount = stage_count,
        .pStages = stages,
        .pVertexInputState = &vertex_input,
        .pInputAssemblyState = &assembly,
        .pViewportState = &viewport,
        .pRasterizationState = &raster,
        .pMultisampleState = &samples,
        .pDepthStencilState = &depth,
        .pColorBlendState = &blend,
        .pDynamicState = &dynamic,
        .layout = layout,
    };
    return vkCreateGraphicsPipelines(gpu->device, gpu->pipeline_cache, 1, &info, NULL, made);
}

VkPipeline wd_graphics_create(struct wd_gpu *gpu, VkPipelineLayout layout, const struct wd_graphics_params *params)
{
    struct wd_specialization specialization;
    wd_specialization_init(&specialization, &params->constants);
    bool depth_only = !params->fragment.words;
    VkShaderModule vertex = VK_NULL_HANDLE, fragment = VK_NULL_HANDLE;
    VkPipeline made = VK_NULL_HANDLE;
    if (wd_shader_module_init(&vertex, gpu, &params->vertex) &&
        (depth_only || wd_shader_module_init(&fragment, gpu, &params->fragment))) {
        const VkPipelineShaderStageCreateInfo stages[] = {
            stage_info(VK_SHADER_STAGE_VERTEX_BIT, vertex, &specialization),
            stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, &specialization),
        };
        VkResult result = create_graphics(&made, gpu, layout, params, stages, depth_only ? 1 : 2);
        if (wd_gpu_check(gpu, result, params->vertex.name))
            wd_set_object_name(gpu, VK_OBJECT_TYPE_PIPELINE, (uint64_t)(uintptr_t)made, params->vertex.name);
        else
            made = VK_NULL_HANDLE;
    }
    vkDestroyShaderModule(gpu->device, vertex, NULL);
    vkDestroyShaderModule(gpu->device, fragment, NULL);
    return made;
}

static void add_graphics(struct wd_pipeline_key *key, const struct wd_graphics_params *params)
{
    const uint32_t state[] = {params->push_size, params->color_count, params->color_writes, params->blend,
                              params->depth_format, params->depth_compare, params->depth_read_only, params->cull,
                              params->topology};
    const float bias[] = {params->depth_bias_constant, params->depth_bias_slope};
    wd_pipeline_key_add(key, &params->vertex.words, sizeof params->vertex.words);
    wd_pipeline_key_add(key, &params->fragment.words, sizeof params->fragment.words);
    wd_pipeline_key_add(key, &params->vertices, sizeof params->vertices);
    wd_pipeline_key_add(key, &params->bindings, sizeof params->bindings);
    wd_pipeline_key_add(key, params->color_formats, sizeof params->color_formats);
    wd_pipeline_key_add(key, state, sizeof state);
    wd_pipeline_key_add(key, bias, sizeof bias);
    wd_pipeline_key_add_constants(key, &params->constants);
}

bool wd_pipeline_init_graphics(struct wd_pipeline *pipeline, struct wd_gpu *gpu,
                               const struct wd_graphics_params *params)
{
    assert(params->color_count <= WD_MAX_COLOR_TARGETS &&
           params->vertices.count <= WD_MAX_VERTEX_ATTRIBUTES);
    struct wd_pipeline_key key = {0};
    add_graphics(&key, params);
    if (!gpu->lost && wd_pipeline_find(pipeline, gpu, &key))
        return true;
    *pipeline = (struct wd_pipeline){.bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS};
    VkShaderStageFlags stages = wd_pipeline_stages(pipeline);
    if (gpu->lost || !wd_spirv_check(&params->vertex, gpu) ||
        (params->fragment.words && !wd_spirv_check(&params->fragment, gpu)) ||
        !wd_pipeline_init_layout(pipeline, gpu, &params->bindings, params->push_size, stages,
                                 params->vertex.name)) {
        wd_pipeline_destroy_layout(pipeline, gpu);
        return false;
    }
    return wd_pipeline_keep(pipeline, gpu, &key, &(struct wd_pipeline_params){.graphics = *params});
}
