#include "frame/passes/terrain.h"

#include <string.h>

static const uint32_t terrain_vert[] =
#include "terrain.vert.inc"
    ;
static const uint32_t terrain_frag[] =
#include "terrain.frag.inc"
    ;

static const uint32_t terrain_mark_frag[] =
#include "terrain_mark.frag.inc"
    ;
static const uint32_t terrain_shade_comp[] =
#include "terrain_shade.comp.inc"
    ;

enum { PATCH_INDICES = WD_PATCH_CELLS * WD_PATCH_CELLS * 6 };

/* Two triangles a cell, counter-clockwise from above, split from south-west to north-east. The
 * host writes them once, before any submission: no barrier is ever needed. */
static bool init_indices(struct wd_buffer *buffer, struct wd_gpu *gpu)
{
    const struct wd_buffer_params params = {.name = "terrain indices",
                                            .size = PATCH_INDICES * sizeof(uint16_t),
                                            .usage = VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                                            .memory = WD_MEMORY_UPLOAD};
    if (!wd_buffer_init(buffer, gpu, &params))
        return false;
    uint16_t *next = buffer->mapped;
    for (uint32_t j = 0; j < WD_PATCH_CELLS; j++) {
        for (uint32_t i = 0; i < WD_PATCH_CELLS; i++) {
            uint16_t south_west = (uint16_t)(j * (WD_PATCH_CELLS + 1) + i);
            uint16_t north_west = south_west + WD_PATCH_CELLS + 1;
            const uint16_t cell[6] = {south_west, south_west + 1, north_west + 1,
                                      south_west, north_west + 1, north_west};
            memcpy(next, cell, sizeof cell);
            next += 6;
        }
    }
    return true;
}

/* Whether fragments only mark the ground. */
static bool marks(const struct wd_gpu *gpu)
{
    return gpu->features & WD_GPU_FEATURE_STORED_TARGETS;
}

static bool init_shade(struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    const struct wd_compute_params params = {
        .shader = WD_SPIRV(terrain_shade_comp),
        .bindings = {9,
                     {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}},
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

static bool init_pipeline(struct wd_pipeline *pipeline, struct wd_gpu *gpu, uint32_t has_holes,
                          uint32_t is_near)
{
    const uint32_t constants[] = {has_holes, is_near};
    struct wd_graphics_params params = {
        .vertex = WD_SPIRV(terrain_vert),
        .fragment = WD_SPIRV(terrain_frag),
        .bindings = {8,
                     {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
        .constants = {2, constants},
        .color_count = 3,
        .color_formats = {WD_ALBEDO_FORMAT, WD_NORMAL_FORMAT, WD_SURFACE_FORMAT},
        .depth_format = WD_DEPTH_FORMAT,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    if (marks(gpu)) {
        params.fragment = (struct wd_spirv)WD_SPIRV(terrain_mark_frag);
        params.color_count = 1;
        params.color_formats[0] = WD_SURFACE_FORMAT;
    }
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

bool wd_terrain_pass_init(struct wd_terrain_pass *pass, struct wd_gpu *gpu)
{
    *pass = (struct wd_terrain_pass){0};
    bool ok = init_indices(&pass->indices, gpu);
    for (uint32_t near = 0; near < 2 && ok; near++)
        ok = init_pipeline(&pass->pipelines[0][near], gpu, 0, near);
    ok = ok && (!marks(gpu) || (init_shade(&pass->shade, gpu) &&
                                wd_sampler_init(&pass->nearest, gpu, WD_SAMPLER_NEAREST_CLAMP)));
    if (!ok)
        wd_terrain_pass_finish(pass, gpu);
    return ok;
}

bool wd_terrain_pass_prepare(struct wd_terrain_pass *pass, struct wd_gpu *gpu,
                             const struct wd_ground *ground)
{
    bool ok = true;
    for (uint32_t near = 0; near < 2 && ok && ground->terrain->hole; near++)
        ok = pass->pipelines[1][near].kept ||
             init_pipeline(&pass->pipelines[1][near], gpu, 1, near);
    return ok;
}

void wd_terrain_pass_finish(struct wd_terrain_pass *pass, struct wd_gpu *gpu)
{
    if (pass->nearest)
        vkDestroySampler(gpu->device, pass->nearest, NULL);
    wd_buffer_finish(&pass->indices, gpu);
    wd_patch_list_finish(&pass->patches);
    *pass = (struct wd_terrain_pass){0};
}

static void draw(struct wd_cmd *cmd, const struct wd_pipeline *pipeline,
                 const struct wd_binding *bindings, uint32_t first, uint32_t count)
{
    if (!count)
        return;
    wd_cmd_bind(cmd, pipeline, bindings);
    if (!cmd->failed)
        vkCmdDrawIndexed(cmd->vk, PATCH_INDICES, count, 0, 0, first);
}

void wd_terrain_pass_record(struct wd_terrain_pass *pass, struct wd_cmd *cmd,
                            const struct wd_terrain_params *params)
{
    const struct wd_ground *ground = params->ground;
    struct wd_patch_ranges ranges;
    wd_patch_ranges_init(&ranges, ground, params->view, params->error_px);
    wd_patches_select(&pass->patches, &ranges, ground, params->view);
    size_t count = pass->patches.count;
    pass->triangles = (uint64_t)count * PATCH_INDICES / 3;
    pass->view = (struct wd_binding){0};
    if (!count)
        return;
    struct wd_binding view_binding, patch_binding;
    struct wd_terrain_view *view = wd_cmd_upload(cmd, sizeof *view, &view_binding);
    void *patches = wd_cmd_upload(cmd, count * sizeof *pass->patches.items, &patch_binding);
    if (!view || !patches)
        return;
    wd_terrain_view_init(view, &ranges, ground, params->view);
    pass->view = view_binding;
    memcpy(patches, pass->patches.items, count * sizeof *pass->patches.items);
    const struct wd_binding bindings[] = {
        params->uniforms,
        view_binding,
        patch_binding,
        WD_BIND_BUFFER(&ground->heights),
        WD_BIND_IMAGE(&ground->slopes, ground->sampler),
        WD_BIND_IMAGE(&ground->cover, ground->sampler),
        WD_BIND_BUFFER(&ground->holes),
        WD_BIND_BUFFER(&ground->waters),
    };
    const struct wd_pipeline *pipelines = pass->pipelines[ground->terrain->hole != NULL];
    uint32_t detailed = (uint32_t)pass->patches.detailed;
    vkCmdBindIndexBuffer(cmd->vk, pass->indices.buffer, 0, VK_INDEX_TYPE_UINT16);
    draw(cmd, &pipelines[1], bindings, 0, detailed);
    draw(cmd, &pipelines[0], bindings, detailed, (uint32_t)count - detailed);
}

void wd_terrain_pass_shade(struct wd_terrain_pass *pass, struct wd_cmd *cmd,
                           const struct wd_terrain_params *params, struct wd_targets *targets)
{
    const struct wd_ground *ground = params->ground;
    if (!pass->shade.kept || !pass->view.buffer || cmd->failed)
        return;
    wd_cmd_use_image(cmd, &targets->depth, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->surface, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_image(cmd, &targets->albedo, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_image(cmd, &targets->normal, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {
        params->uniforms,
        pass->view,
        WD_BIND_IMAGE(&targets->depth, pass->nearest),
        WD_BIND_STORAGE_IMAGE(&targets->surface),
        WD_BIND_IMAGE(&ground->slopes, ground->sampler),
        WD_BIND_IMAGE(&ground->cover, ground->sampler),
        WD_BIND_STORAGE_IMAGE(&targets->albedo),
        WD_BIND_BUFFER(&ground->waters),
        WD_BIND_STORAGE_IMAGE(&targets->normal),
    };
    wd_cmd_bind(cmd, &pass->shade, bindings);
    wd_cmd_dispatch(cmd, (targets->width + 7) / 8, (targets->height + 7) / 8, 1);
}

struct wd_rendering wd_terrain_pass_targets(const struct wd_terrain_pass *pass,
                                            struct wd_targets *targets)
{
    struct wd_rendering rendering = wd_targets_gbuffer(targets, WD_LOAD_KEEP);
    if (pass->shade.kept) {
        rendering.color_count = 1;
        rendering.color[0].image = &targets->surface;
    }
    return rendering;
}
