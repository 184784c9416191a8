#include "methods/canopy_map.h"

static const uint32_t canopy_map_comp[] =
#include "canopy_map.comp.inc"
    ;
static const uint32_t canopy_map_frag[] =
#include "canopy_map.frag.inc"
    ;
static const uint32_t whole_target_vert[] =
#include "whole_target.vert.inc"
    ;

enum { MAP_BINDINGS = 12, TILE = 8, SAMPLED_TREES = 4096 };

bool wd_canopy_map_init(struct wd_canopy_map *map, struct wd_gpu *gpu)
{
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const VkDescriptorType image = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const struct wd_compute_params compute = {
        .shader = WD_SPIRV(canopy_map_comp),
        .bindings = {MAP_BINDINGS,
                     {uniform, image, image, buffer, buffer, buffer, buffer, buffer, image, image,
                      image, buffer}},
        .push_size = sizeof(struct wd_canopy_push),
    };
    const struct wd_graphics_params draw = {
        .vertex = WD_SPIRV(whole_target_vert),
        .fragment = WD_SPIRV(canopy_map_frag),
        .bindings = {2, {uniform, buffer}},
        .color_count = 3,
        .color_formats = {WD_ALBEDO_FORMAT, WD_NORMAL_FORMAT, WD_SURFACE_FORMAT},
        .depth_format = WD_DEPTH_FORMAT,
        .depth_compare = VK_COMPARE_OP_ALWAYS,
        .depth_read_only = true,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    return wd_pipeline_init_compute(&map->map, gpu, &compute) &&
           wd_pipeline_init_graphics(&map->draw, gpu, &draw) &&
           wd_sampler_init(&map->sampler, gpu, WD_SAMPLER_NEAREST_CLAMP);
}

void wd_canopy_map_finish(struct wd_canopy_map *map, struct wd_gpu *gpu)
{
    vkDestroySampler(gpu->device, map->sampler, NULL);
    wd_buffer_finish(&map->pixels, gpu);
}

static bool upload(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                   const uint32_t *values, size_t count)
{
    const struct wd_buffer_params params = {name, count * sizeof *values,
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    return wd_buffer_init(buffer, gpu, &params) &&
           wd_buffer_upload(gpu, buffer, 0, values, params.size);
}

bool wd_canopy_map_use_forest(struct wd_canopy_map *map, struct wd_gpu *gpu,
                              const struct wd_forest_device *forest,
                              const struct wd_view_trees *trees)
{
    const struct wd_world *world = forest->world;
    const struct wd_cells *cells = &trees->groups;
    size_t step = world->tree_count / SAMPLED_TREES + 1, sampled = 0;
    double sum_m = 0.0, sum_aspect = 0.0;
    if (!world->tree_count)
        return true;
    for (size_t i = 0; i < world->tree_count; i += step, sampled++) {
        double height_cm = WD_TREE_HEIGHT_CM(world->trees[i]), crown_cm = WD_TREE_CROWN_CM(world->trees[i]);
        sum_m += 0.01 * height_cm;
        sum_aspect += height_cm / (crown_cm > 1.0 ? crown_cm : 1.0);
    }
    map->canopy_m = (float)(sum_m / (double)sampled);
    map->aspect = (float)(sum_aspect / (double)sampled);
    return upload(&map->cell_first, gpu, "canopy cells", cells->first,
                  (size_t)cells->columns * cells->rows + 1) &&
           upload(&map->cell_trees, gpu, "canopy trees", cells->trees, world->tree_count);
}

void wd_canopy_map_drop_forest(struct wd_canopy_map *map, struct wd_gpu *gpu)
{
    wd_buffer_finish(&map->cell_first, gpu);
    wd_buffer_finish(&map->cell_trees, gpu);
}

/* As many pixels as the picture has; a smaller buffer dies when its frames have ended. */
static bool fit_pixels(struct wd_canopy_map *map, const struct wd_tree_draw *draw)
{
    VkDeviceSize size = (VkDeviceSize)draw->targets->width * draw->targets->height *
                        sizeof(struct wd_canopy_pixel);
    const struct wd_buffer_params params = {"canopy pixels", size,
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    if (map->pixels.size == size)
        return true;
    if (map->pixels.buffer)
        wd_cmd_defer_buffer(draw->cmd, &map->pixels);
    if (wd_buffer_init(&map->pixels, draw->cmd->gpu, &params))
        return true;
    draw->cmd->failed = true;
    return false;
}

static struct wd_canopy_push push_of(const struct wd_canopy_map *map,
                                     const struct wd_tree_draw *draw,
                                     const struct wd_view_trees *trees)
{
    const struct wd_ground *ground = &draw->forest->ground;
    const struct wd_cells *cells = &trees->groups;
    return (struct wd_canopy_push){
        .atlas = trees->sets.atlas,
        .variants = draw->forest->variants,
        .baked_variants = trees->sets.variants,
        .camera_m = {(float)draw->view->eye_m[0], (float)draw->view->eye_m[1]},
        .cover_scale = {(float)(1.0 / (ground->cover_cell_m * ground->cover.width)),
                        (float)(1.0 / (ground->cover_cell_m * ground->cover.height))},
        .cover_texel_m = (float)ground->cover_cell_m,
        .pixel_rad = 1.0f / draw->view->pixels_per_radian,
        .cells_min_m = {(float)cells->min_m[0], (float)cells->min_m[1]},
        .cell_m = (float)cells->cell_m,
        .columns = cells->columns,
        .rows = cells->rows,
        .canopy_m = map->canopy_m,
        .aspect = map->aspect,
    };
}

void wd_canopy_map_select(struct wd_canopy_map *map, const struct wd_tree_draw *draw,
                          const struct wd_view_trees *trees, float range_m, float fade)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_view_sets *sets = &trees->sets;
    struct wd_canopy_push push = push_of(map, draw, trees);
    push.range_m = range_m;
    push.fade = fade;
    if (!fit_pixels(map, draw))
        return;
    const struct wd_binding bindings[MAP_BINDINGS] = {
        draw->uniforms,
        WD_BIND_IMAGE(&draw->targets->depth, map->sampler),
        WD_BIND_IMAGE(&forest->ground.cover, forest->ground.sampler),
        WD_BIND_BUFFER(&forest->trees),
        WD_BIND_BUFFER(&forest->models),
        WD_BIND_BUFFER(&sets->models),
        WD_BIND_BUFFER(&map->cell_first),
        WD_BIND_BUFFER(&map->cell_trees),
        WD_BIND_IMAGE(&sets->planes[WD_PLANE_ALBEDO], trees->sampler),
        WD_BIND_IMAGE(&sets->planes[WD_PLANE_NORMAL], trees->sampler),
        WD_BIND_IMAGE(&sets->planes[WD_PLANE_DEPTH], trees->sampler),
        WD_BIND_BUFFER(&map->pixels)};
    wd_cmd_use_image(draw->cmd, &draw->targets->depth, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(draw->cmd, &map->cell_first, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(draw->cmd, &map->cell_trees, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(draw->cmd, &map->pixels, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(draw->cmd, &map->map, bindings);
    wd_cmd_push(draw->cmd, &map->map, &push, sizeof push);
    wd_cmd_dispatch(draw->cmd, (draw->targets->width + TILE - 1) / TILE,
                    (draw->targets->height + TILE - 1) / TILE, 1);
    wd_cmd_use_buffer(draw->cmd, &map->pixels, WD_USE_GRAPHICS_READ);
}

void wd_canopy_map_draw(struct wd_canopy_map *map, const struct wd_tree_draw *draw)
{
    const struct wd_binding bindings[] = {draw->uniforms, WD_BIND_BUFFER(&map->pixels)};
    wd_cmd_bind(draw->cmd, &map->draw, bindings);
    wd_cmd_draw(draw->cmd, 3, 1);
    draw->stats->draw_calls++;
}
