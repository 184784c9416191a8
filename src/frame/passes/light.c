#include "frame/passes/light.h"

#include <math.h>
#include <stdatomic.h>
#include <stddef.h>
#include <string.h>

#include "base/jobs.h"
#include "world/surroundings.h"

static const uint32_t light_comp[] =
#include "light.comp.inc"
    ;
static const uint32_t light_water_comp[] =
#include "light_water.comp.inc"
    ;
static const uint32_t light_args_comp[] =
#include "light_args.comp.inc"
    ;
static const uint32_t light_shafts_comp[] =
#include "light_shafts.comp.inc"
    ;
static const uint32_t light_tiles_comp[] =
#include "light_tiles.comp.inc"
    ;
static const uint32_t light_velocity_comp[] =
#include "light_velocity.comp.inc"
    ;
static const uint32_t light_view_comp[] =
#include "light_view.comp.inc"
    ;

/* --- pipelines ----------------------------------------------------------------------------- */

static const VkDescriptorType IMAGE = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
static const VkDescriptorType BUFFER = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
static const VkDescriptorType TEXELS = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
static const VkDescriptorType UNIFORM = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;

enum { WET_LIST = WD_TILE_LISTS - 1, SHADING_BINDINGS = 18 };

/* To software devices a list's shader is 0.06 s of work at each start, and a second where they have not kept it from another.
 * Small pictures have one for all that is dry; of larger ones it would make the light pass up to a sixth slower. */
static const uint32_t FEW_PIXELS = 400 * 300;

static bool has_few_tiles(const struct wd_gpu *gpu, uint32_t width, uint32_t height)
{
    return gpu->software && (uint64_t)width * height <= FEW_PIXELS;
}

/* Lists of trees and no water, which most of a forest's pixels are in. */
static bool has_single(uint32_t list)
{
    return (wd_tile_list_parts(list) & (WD_PART_TREES | WD_PART_WATER)) == WD_PART_TREES;
}

static struct wd_compute_params shading_params(void)
{
    return (struct wd_compute_params){
        .shader = WD_SPIRV(light_comp),
        .bindings = {SHADING_BINDINGS,
                     {UNIFORM, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, TEXELS, TEXELS, TEXELS,
                      VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, BUFFER, IMAGE, IMAGE, IMAGE, BUFFER, BUFFER, TEXELS}},
        .push_size = sizeof(struct wd_light_push),
    };
}

/* Stored shadow maps have no format that samplers compare. */
static bool compares(const struct wd_gpu *gpu)
{
    return gpu->features & WD_GPU_FEATURE_STORED_TARGETS;
}

/* Shades of a list's tiles the pixels of these parts. */
static bool init_list(struct wd_pipeline *pipeline, struct wd_gpu *gpu, uint32_t list,
                      uint32_t parts, uint32_t single)
{
    const uint32_t rows = gpu->software ? 1 : WD_TILE; /* of a tile at once */
    const uint32_t constants[] = {parts, list, gpu->runs, single, rows, compares(gpu)};
    struct wd_compute_params params = shading_params();
    if (list == WET_LIST) {
        params.shader = (struct wd_spirv)WD_SPIRV(light_water_comp);
        params.bindings.types[0] = BUFFER;
    }
    params.constants = (struct wd_spec_constants){6, constants};
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

static bool init_view(struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    struct wd_compute_params params = shading_params();
    params.shader = (struct wd_spirv)WD_SPIRV(light_view_comp);
    params.bindings.count = 11;
    params.bindings.types[0] = BUFFER;
    params.bindings.types[7] = BUFFER;
    const uint32_t compare = compares(gpu);
    params.constants = (struct wd_spec_constants){1, &compare};
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

static bool has_water(const struct wd_forest_device *forest)
{
    return forest->scene->water.enabled || forest->ground.terrain->water_m;
}

/* What shades a list or, at WD_TILE_LISTS, the water of the last one; NULL where no such picture has any. */
static struct wd_pipeline *shading_of(struct wd_light_pass *pass, const struct wd_gpu *gpu, uint32_t list,
                                      const struct wd_light_needs *needs)
{
    if (list < WD_TILE_LIST_DRY && has_few_tiles(gpu, needs->width, needs->height))
        return NULL;
    if (list >= WET_LIST && !has_water(needs->forest))
        return NULL;
    if (list == WD_TILE_LISTS)
        return &pass->water;
    bool single = needs->leaves == WD_LEAVES_SINGLE && has_single(list);
    return single ? &pass->single[list] : &pass->light[list];
}

struct preparation {
    struct wd_light_pass *pass;
    struct wd_gpu *gpu;
    const struct wd_light_needs *needs;
    atomic_bool failed;
};

static void prepare_list(void *user, size_t index)
{
    struct preparation *work = user;
    uint32_t list = (uint32_t)index;
    struct wd_pipeline *pipeline = shading_of(work->pass, work->gpu, list, work->needs);
    if (!pipeline || pipeline->kept)
        return;
    bool water = pipeline == &work->pass->water;
    bool single = list < WD_TILE_LISTS && pipeline == &work->pass->single[list];
    uint32_t parts = water ? WD_PART_ALL : wd_tile_list_parts(list) & ~WD_PART_WATER;
    if (!init_list(pipeline, work->gpu, water ? WET_LIST : list, parts, single) ||
        !wd_pipeline_make(pipeline, work->gpu))
        atomic_store(&work->failed, true);
}

/* Shaders of lists are the largest of a frame: drivers take as long for them as for all others. */
bool wd_light_pass_prepare(struct wd_light_pass *pass, struct wd_gpu *gpu,
                           const struct wd_light_needs *needs)
{
    struct preparation work = {pass, gpu, needs, false};
    uint32_t missing = 0;
    if (needs->view_mode != WD_MODE_LIT)
        return pass->view.kept || init_view(&pass->view, gpu);
    for (uint32_t list = 0; list <= WD_TILE_LISTS; list++) {
        const struct wd_pipeline *pipeline = shading_of(pass, gpu, list, needs);
        missing += pipeline && !pipeline->kept;
    }
    if (missing)
        wd_jobs_run(gpu->threads, WD_TILE_LISTS + 1, prepare_list, &work);
    return !atomic_load(&work.failed);
}

static bool init_sorting(struct wd_light_pass *pass, struct wd_gpu *gpu)
{
    const struct wd_compute_params tiles = {
        .shader = WD_SPIRV(light_tiles_comp),
        .bindings = {4, {UNIFORM, IMAGE, IMAGE, BUFFER}},
        .push_size = sizeof(struct wd_light_push),
    };
    const struct wd_compute_params args = {.shader = WD_SPIRV(light_args_comp),
                                           .bindings = {1, {BUFFER}}};
    return wd_pipeline_init_compute(&pass->tiles, gpu, &tiles) &&
           wd_pipeline_init_compute(&pass->args, gpu, &args);
}

static bool init_shafts(struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    const uint32_t constants[] = {compares(gpu)};
    const struct wd_compute_params params = {
        .shader = WD_SPIRV(light_shafts_comp),
        .bindings = {4, {UNIFORM, IMAGE, IMAGE, BUFFER}},
        .push_size = sizeof(struct wd_light_push),
        .constants = {1, constants},
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

static bool init_velocity(struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    const struct wd_compute_params params = {
        .shader = WD_SPIRV(light_velocity_comp),
        .bindings = {8, {UNIFORM, IMAGE, IMAGE, IMAGE, IMAGE, BUFFER, BUFFER, BUFFER}},
        .push_size = sizeof(struct wd_light_push),
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

bool wd_light_pass_init(struct wd_light_pass *pass, struct wd_gpu *gpu)
{
    *pass = (struct wd_light_pass){0};
    bool ok = init_sorting(pass, gpu) && init_shafts(&pass->shafts, gpu) && init_velocity(&pass->velocity, gpu) &&
              wd_crown_sky_init(&pass->crown_sky, gpu) &&
              wd_sampler_init(&pass->nearest, gpu, WD_SAMPLER_NEAREST_CLAMP) &&
              wd_sampler_init(&pass->shadow, gpu, WD_SAMPLER_SHADOW);
    if (!ok)
        wd_light_pass_finish(pass, gpu);
    return ok;
}

void wd_light_pass_finish(struct wd_light_pass *pass, struct wd_gpu *gpu)
{
    if (pass->nearest)
        vkDestroySampler(gpu->device, pass->nearest, NULL);
    if (pass->shadow)
        vkDestroySampler(gpu->device, pass->shadow, NULL);
    wd_buffer_finish(&pass->lists, gpu);
    wd_buffer_finish(&pass->shaft_shares, gpu);
    wd_sun_field_finish(&pass->sun_field, gpu);
    wd_crown_sky_finish(&pass->crown_sky, gpu);
    *pass = (struct wd_light_pass){0};
}

void wd_light_pass_forget(struct wd_light_pass *pass)
{
    wd_sun_field_forget(&pass->sun_field);
    wd_crown_sky_forget(&pass->crown_sky);
}

void wd_light_pass_drop_forest(struct wd_light_pass *pass, struct wd_gpu *gpu)
{
    wd_sun_field_finish(&pass->sun_field, gpu);
    wd_crown_sky_drop_forest(&pass->crown_sky, gpu);
}

/* --- recording ----------------------------------------------------------------------------- */

static void use_gbuffer(struct wd_cmd *cmd, struct wd_targets *targets)
{
    wd_cmd_use_image(cmd, &targets->albedo, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->normal, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->surface, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->depth, WD_USE_COMPUTE_READ);
}

static float eye_over_ground_m(const struct wd_light_params *params)
{
    const struct wd_terrain *terrain = params->forest->ground.terrain;
    const double *eye_m = params->view->eye_m;
    if (!wd_terrain_contains(terrain, eye_m[0], eye_m[1]))
        return 1e6f;
    return (float)(eye_m[2] - (double)wd_terrain_height(terrain, eye_m[0], eye_m[1]));
}

/* Shafts are told apart so far from the eye, or as far as the maps of shadows reach, which end softly. */
static const float SHAFTS_M = 300, WITHIN_MAPS = 0.9f;

static float shafts_m(const struct wd_frame_uniforms *frame)
{
    return fminf(SHAFTS_M, WITHIN_MAPS * frame->cascades[WD_CASCADES - 1][WD_CASCADE_FAR_M]);
}

/* Optical depths of haze over that way between which shafts begin to show: in thinner haze the canopy's mean is
 * enough. */
static const float HAZE_THIN = 0.06f, HAZE_THICK = 0.12f;

static float shafts_of(const struct wd_frame_uniforms *frame)
{
    float depth = frame->fog_per_m * SHAFTS_M;
    float part = (depth - HAZE_THIN) / (HAZE_THICK - HAZE_THIN);
    return frame->shadow_taps && shafts_m(frame) > 0 ? fminf(fmaxf(part, 0), 1) : 0;
}

static struct wd_light_push push_of(const struct wd_light_pass *pass, const struct wd_gpu *gpu,
                                    const struct wd_light_params *params)
{
    return (struct wd_light_push){
        .camera_m = {(float)params->view->eye_m[0], (float)params->view->eye_m[1]},
        .sun_cell_m = pass->sun_field.cell_m,
        .sun_soft_m = pass->sun_field.soft_m,
        .sun_width = pass->sun_field.width,
        .sun_height = pass->sun_field.height,
        .variants = params->forest->variants ? params->forest->variants : 1,
        .is_sea = wd_water_is_sea(params->forest->ground.terrain, params->frame->water_level_m),
        .has_rivers = params->forest->ground.terrain->water_m != NULL,
        .has_overlay = params->overlay == WD_OVERLAY_OVER,
        .level_cards = params->level_cards,
        .pixels_a_radian = params->view->pixels_per_radian,
        .few_tiles = has_few_tiles(gpu, params->targets->width, params->targets->height),
        .floor_sky_m = wd_crown_sky_floor_m(params->forest, params->view),
        .shafts_m = shafts_m(params->frame),
        .shafts = shafts_of(params->frame),
        .eye_over_ground_m = eye_over_ground_m(params),
        .extent_m = {(float)wd_terrain_extent_x_m(params->forest->ground.terrain),
                     (float)wd_terrain_extent_y_m(params->forest->ground.terrain)},
        .canopy_from_m = {params->forest->canopy_light_from_m[0],
                          params->forest->canopy_light_from_m[1]},
        .canopy_scale = {params->forest->canopy_light_scale[0],
                         params->forest->canopy_light_scale[1]},
        .tile_columns = (params->targets->width + WD_TILE - 1) / WD_TILE,
        .tile_rows = (params->targets->height + WD_TILE - 1) / WD_TILE,
    };
}

/* A forest without species has no models; the slot must be filled all the same. */
static struct wd_binding models_or_trees(const struct wd_buffer *models,
                                         const struct wd_forest_device *forest)
{
    return WD_BIND_BUFFER(models->buffer ? models : &forest->trees);
}

static bool fit_lists(struct wd_light_pass *pass, struct wd_cmd *cmd, uint64_t tiles)
{
    const struct wd_buffer_params params = {
        .name = "light tiles",
        .size = sizeof(struct wd_tile_lists) + tiles * WD_TILE_LISTS * sizeof(uint32_t),
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
    };
    if (pass->lists.size == params.size)
        return true;
    wd_cmd_defer_buffer(cmd, &pass->lists);
    return wd_buffer_init(&pass->lists, cmd->gpu, &params);
}

/* Where no shafts are asked for, the buffer is bound all the same. */
static bool fit_shafts(struct wd_light_pass *pass, struct wd_cmd *cmd, uint64_t tiles)
{
    const struct wd_buffer_params params = {
        .name = "shafts of light",
        .size = tiles * WD_SHAFT_SLICES * sizeof(float),
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
    };
    if (pass->shaft_shares.size == params.size)
        return true;
    wd_cmd_defer_buffer(cmd, &pass->shaft_shares);
    return wd_buffer_init(&pass->shaft_shares, cmd->gpu, &params);
}

static void find_shafts(struct wd_light_pass *pass, struct wd_cmd *cmd,
                        const struct wd_light_params *params, const struct wd_light_push *push)
{
    wd_cmd_use_buffer(cmd, &pass->shaft_shares, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {
        params->uniforms, WD_BIND_IMAGE(&params->targets->shadow, pass->shadow),
        WD_BIND_IMAGE(wd_targets_shadow(params->targets), pass->nearest), WD_BIND_BUFFER(&pass->shaft_shares)};
    wd_cmd_bind(cmd, &pass->shafts, bindings);
    wd_cmd_push(cmd, &pass->shafts, push, sizeof *push);
    uint32_t tiles = push->tile_columns * push->tile_rows;
    wd_cmd_dispatch_1d(cmd, (tiles + WD_TILE_THREADS - 1) / WD_TILE_THREADS);
}

static void sort_tiles(struct wd_light_pass *pass, struct wd_cmd *cmd,
                       const struct wd_light_params *params, const struct wd_light_push *push)
{
    const struct wd_targets *targets = params->targets;
    wd_cmd_use_buffer(cmd, &pass->lists, WD_USE_TRANSFER_WRITE);
    vkCmdFillBuffer(cmd->vk, pass->lists.buffer, 0, sizeof(struct wd_tile_lists), 0);
    wd_cmd_use_buffer(cmd, &pass->lists, WD_USE_COMPUTE_WRITE);
    const struct wd_binding tiles[] = {
        params->uniforms, WD_BIND_IMAGE(&targets->surface, pass->nearest),
        WD_BIND_IMAGE(&targets->depth, pass->nearest), WD_BIND_BUFFER(&pass->lists)};
    wd_cmd_bind(cmd, &pass->tiles, tiles);
    wd_cmd_push(cmd, &pass->tiles, push, sizeof *push);
    uint32_t tile_count = push->tile_columns * push->tile_rows;
    wd_cmd_dispatch_1d(cmd, (tile_count + WD_TILE_THREADS - 1) / WD_TILE_THREADS);
    wd_cmd_use_buffer(cmd, &pass->lists, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, &pass->args, &WD_BIND_BUFFER(&pass->lists));
    wd_cmd_dispatch(cmd, 1, 1, 1);
    wd_cmd_use_buffer(cmd, &pass->lists, WD_USE_INDIRECT);
}

static void shade_list(struct wd_light_pass *pass, struct wd_cmd *cmd,
                       const struct wd_pipeline *pipeline, uint32_t list,
                       const struct wd_binding *bindings, const struct wd_light_push *push)
{
    wd_cmd_bind(cmd, pipeline, bindings);
    wd_cmd_push(cmd, pipeline, push, sizeof *push);
    wd_cmd_dispatch_indirect(cmd, &pass->lists, offsetof(struct wd_tile_lists, groups[list]));
}

/* Water comes last: it mirrors what the others have been lit to. */
static void shade_lists(struct wd_light_pass *pass, struct wd_cmd *cmd,
                        const struct wd_light_params *params, const struct wd_binding *bindings,
                        const struct wd_light_push *push)
{
    for (uint32_t list = push->few_tiles ? WD_TILE_LIST_DRY : 0; list < WET_LIST; list++) {
        bool single = params->leaves == WD_LEAVES_SINGLE && has_single(list);
        shade_list(pass, cmd, single ? &pass->single[list] : &pass->light[list], list, bindings, push);
    }
    if (!has_water(params->forest))
        return;
    shade_list(pass, cmd, &pass->light[WET_LIST], WET_LIST, bindings, push);
    wd_cmd_use_image(cmd, &params->targets->radiance, WD_USE_COMPUTE_WRITE);
    shade_list(pass, cmd, &pass->water, WET_LIST, bindings, push);
}

/* In the order of lib/light_pixels.glsl. */
static void bind_shading(struct wd_binding bindings[SHADING_BINDINGS], const struct wd_light_pass *pass,
                         const struct wd_light_params *params, bool has_overlay)
{
    struct wd_targets *targets = params->targets;
    const struct wd_binding reads[SHADING_BINDINGS] = {
        params->uniforms,
        WD_BIND_IMAGE(&targets->albedo, pass->nearest),
        WD_BIND_IMAGE(&targets->normal, pass->nearest),
        WD_BIND_IMAGE(&targets->surface, pass->nearest),
        WD_BIND_IMAGE(&targets->depth, pass->nearest),
        WD_BIND_IMAGE(&targets->shadow, pass->shadow),
        WD_BIND_IMAGE(wd_targets_shadow(targets), pass->nearest),
        WD_BIND_BUFFER(&pass->sun_field.heights),
        WD_BIND_BUFFER(&params->forest->trees),
        models_or_trees(&params->forest->lit_models, params->forest),
        WD_BIND_STORAGE_IMAGE(&targets->radiance),
        WD_BIND_BUFFER(&pass->lists),
        WD_BIND_IMAGE(has_overlay ? &targets->overlay : &targets->albedo, pass->nearest),
        WD_BIND_IMAGE(&params->forest->canopy_light, params->forest->ground.sampler),
        WD_BIND_IMAGE(&params->forest->sky, params->forest->look_sampler),
        WD_BIND_BUFFER(&params->forest->ground.waters),
        WD_BIND_BUFFER(&pass->shaft_shares),
        WD_BIND_BUFFER(&pass->crown_sky.table),
    };
    memcpy(bindings, reads, sizeof reads);
}

void wd_light_pass_record(struct wd_light_pass *pass, struct wd_cmd *cmd,
                          const struct wd_light_params *params)
{
    struct wd_targets *targets = params->targets;
    wd_sun_field_update(&pass->sun_field, cmd, params->forest->ground.terrain,
                        params->frame->sun_direction);
    if (params->frame->view_mode == WD_MODE_LIT)
        wd_crown_sky_update(&pass->crown_sky, cmd, params->forest, params->view);
    const struct wd_light_push push = push_of(pass, cmd->gpu, params);
    uint64_t tiles = (uint64_t)push.tile_columns * push.tile_rows;
    if (!fit_lists(pass, cmd, tiles) || !fit_shafts(pass, cmd, tiles))
        cmd->failed = true;
    use_gbuffer(cmd, targets);
    if (push.has_overlay)
        wd_cmd_use_image(cmd, &targets->overlay, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->shadow, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, wd_targets_shadow(targets), WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->radiance, WD_USE_COMPUTE_WRITE);
    if (cmd->failed)
        return;
    struct wd_binding bindings[SHADING_BINDINGS];
    bind_shading(bindings, pass, params, push.has_overlay);
    if (params->frame->view_mode == WD_MODE_LIT) {
        sort_tiles(pass, cmd, params, &push);
        if (push.shafts > 0)
            find_shafts(pass, cmd, params, &push);
        wd_cmd_use_buffer(cmd, &pass->shaft_shares, WD_USE_COMPUTE_READ);
        shade_lists(pass, cmd, params, bindings, &push);
        return;
    }
    wd_cmd_bind(cmd, &pass->view, bindings);
    wd_cmd_push(cmd, &pass->view, &push, sizeof push);
    wd_cmd_dispatch(cmd, push.tile_columns, push.tile_rows, 1);
}

bool wd_light_pass_inputs(struct wd_light_pass *pass, struct wd_cmd *cmd,
                          const struct wd_light_params *params, struct wd_light_inputs *inputs)
{
    wd_sun_field_update(&pass->sun_field, cmd, params->forest->ground.terrain,
                        params->frame->sun_direction);
    if (cmd->failed)
        return false;
    wd_cmd_use_buffer(cmd, &pass->sun_field.heights, WD_USE_SHADER_READ);
    wd_cmd_use_image(cmd, &params->targets->shadow, WD_USE_SHADER_READ);
    *inputs = (struct wd_light_inputs){
        .push = push_of(pass, cmd->gpu, params),
        .shadow_map = WD_BIND_IMAGE(&params->targets->shadow, pass->shadow),
        .sun_heights = WD_BIND_BUFFER(&pass->sun_field.heights),
        .canopy_light = WD_BIND_IMAGE(&params->forest->canopy_light, params->forest->ground.sampler),
    };
    return true;
}

void wd_light_pass_record_velocity(struct wd_light_pass *pass, struct wd_cmd *cmd,
                                   const struct wd_light_params *params,
                                   struct wd_buffer *velocity_px)
{
    struct wd_targets *targets = params->targets;
    use_gbuffer(cmd, targets);
    wd_cmd_use_buffer(cmd, velocity_px, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {
        params->uniforms,
        WD_BIND_IMAGE(&targets->albedo, pass->nearest),
        WD_BIND_IMAGE(&targets->normal, pass->nearest),
        WD_BIND_IMAGE(&targets->surface, pass->nearest),
        WD_BIND_IMAGE(&targets->depth, pass->nearest),
        WD_BIND_BUFFER(&params->forest->trees),
        models_or_trees(&params->forest->models, params->forest),
        WD_BIND_BUFFER(velocity_px),
    };
    const struct wd_light_push push = push_of(pass, cmd->gpu, params);
    wd_cmd_bind(cmd, &pass->velocity, bindings);
    wd_cmd_push(cmd, &pass->velocity, &push, sizeof push);
    wd_cmd_dispatch(cmd, push.tile_columns, push.tile_rows, 1);
}
