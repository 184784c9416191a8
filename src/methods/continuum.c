/* continuum: cost that follows the pixels (shaders/shared/continuum.h tells how passes connect).
 *
 * All that depends on single trees happens on the device: clusters are culled, trees chosen and
 * splatted into one visibility buffer, which is resolved into the same G-buffer that every method
 * fills. */
#include "methods/continuum_forest.h"
#include "methods/continuum_near.h"
#include "methods/continuum_pipelines.h"
#include "methods/method.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Visible trees and items of one view: hard caps, whatever the world holds. */
enum { MAX_TREES = 1 << 19, MAX_ITEMS = 1 << 20 };

struct continuum {
    struct wd_gpu *gpu;
    struct wd_continuum_pipelines pipelines;
    struct wd_continuum_forest forest;
    struct wd_buffer visible, counts, groups, trees, items, wood_items, pixels;
    uint32_t tree_capacity, item_capacity;
    struct history {
        struct wd_buffer pyramid; /* float[], of the camera's newest frame */
        uint32_t width, height;   /* 0: there is none */
        double eye_m[3];
        struct wd_camera camera;
        float clip_from_rel[4][4];
    } history;
    struct wd_binding view; /* struct wd_splat_view of the view being drawn */
    struct wd_forest_device *device; /* whose pages this plants */
    struct wd_page_list pages; /* of that view */
    struct wd_selection near;  /* drawn leaf by leaf */
};

static bool continuum_init(void *state, struct wd_gpu *gpu)
{
    struct continuum *c = state;
    c->gpu = gpu;
    return wd_continuum_pipelines_init(&c->pipelines, gpu);
}

static void continuum_finish(void *state, struct wd_gpu *gpu)
{
    struct continuum *c = state;
    wd_continuum_pipelines_finish(&c->pipelines, gpu);
    wd_buffer_finish(&c->pixels, gpu);
    wd_buffer_finish(&c->history.pyramid, gpu);
    wd_page_list_finish(&c->pages);
}

/* --- forest ------------------------------------------------------------------------------ */

static bool make_work(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                      VkDeviceSize size)
{
    const struct wd_buffer_params params = {
        name, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
        WD_MEMORY_DEVICE};
    return wd_buffer_init(buffer, gpu, &params);
}

static bool continuum_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    struct continuum *c = state;
    size_t paged = (size_t)forest->pages.capacity * WD_PAGE_TREES;
    size_t trees = forest->world->tree_count + paged;
    if (!trees)
        return true;
    c->device = forest;
    wd_pages_forget(&forest->pages);
    c->tree_capacity = trees < MAX_TREES ? (uint32_t)trees : MAX_TREES;
    c->item_capacity = MAX_ITEMS;
    return wd_continuum_forest_init(&c->forest, gpu, forest) &&
           make_work(&c->visible, gpu, "visible clusters",
                     (c->forest.cluster_count + paged / WD_PAGE_CLUSTER) * sizeof(uint32_t)) &&
           make_work(&c->counts, gpu, "splat counts", sizeof(struct wd_splat_counts)) &&
           make_work(&c->groups, gpu, "splat groups", sizeof(struct wd_splat_groups)) &&
           make_work(&c->trees, gpu, "splat trees",
                     c->tree_capacity * sizeof(struct wd_splat_tree)) &&
           make_work(&c->items, gpu, "splat items",
                     c->item_capacity * sizeof(struct wd_splat_item)) &&
           make_work(&c->wood_items, gpu, "wood items",
                     c->item_capacity * sizeof(struct wd_splat_item));
}

static void continuum_drop_forest(void *state, struct wd_gpu *gpu)
{
    struct continuum *c = state;
    struct wd_buffer *buffers[] = {&c->visible, &c->counts, &c->groups,
                                   &c->trees,   &c->items,  &c->wood_items};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        wd_buffer_finish(buffers[i], gpu);
    wd_continuum_forest_finish(&c->forest, gpu);
    wd_selection_finish(&c->near);
    c->history.width = c->history.height = 0;
}

/* --- one view ---------------------------------------------------------------------------- */

/* For either pass. */
static bool fit_pixels(struct continuum *c, struct wd_cmd *cmd, const struct wd_view *view)
{
    VkDeviceSize size = (VkDeviceSize)view->width * view->height * 2 * sizeof(uint32_t);
    if (c->pixels.size >= size)
        return true;
    wd_cmd_defer_buffer(cmd, &c->pixels);
    return make_work(&c->pixels, cmd->gpu, "visibility", size);
}

_Static_assert((int)WD_SPLAT_PLANES == (int)WD_FRUSTUM_PLANES, "planes are copied whole");

static uint32_t pyramid_offsets(uint32_t first[WD_PYRAMID_LEVELS], uint32_t width, uint32_t height)
{
    uint32_t total = 0;
    for (uint32_t level = 0; level < WD_PYRAMID_LEVELS; level++) {
        uint32_t texel = 2u << level;
        first[level] = total;
        total += (width + texel - 1) / texel * ((height + texel - 1) / texel);
    }
    return total;
}

static bool fit_pyramid(struct continuum *c, struct wd_cmd *cmd, const struct wd_view *view)
{
    uint32_t first[WD_PYRAMID_LEVELS];
    VkDeviceSize size = pyramid_offsets(first, view->width, view->height) * sizeof(float);
    if (c->history.pyramid.size >= size)
        return true;
    wd_cmd_defer_buffer(cmd, &c->history.pyramid);
    return make_work(&c->history.pyramid, cmd->gpu, "depth pyramid", size);
}

/* What was hidden from one place may be seen from any other: a camera that has moved knows nothing,
 * and one that has turned knows of what it saw all of. */
static void set_history(const struct continuum *c, struct wd_splat_view *values,
                        const struct wd_view *view)
{
    const struct history *history = &c->history;
    const struct wd_camera *was = &history->camera, *is = &view->camera;
    pyramid_offsets(values->pyramid_first, view->width, view->height);
    memcpy(values->history_from_rel, history->clip_from_rel, sizeof values->history_from_rel);
    values->has_history = history->width == view->width && history->height == view->height &&
                          !memcmp(view->eye_m, history->eye_m, sizeof history->eye_m);
    values->still = was->yaw_rad == is->yaw_rad && was->pitch_rad == is->pitch_rad &&
                    was->fov_rad == is->fov_rad;
}

/* Where trees that stand for others find the ground's slope. */
static void set_slopes(struct wd_splat_view *values, const struct wd_ground *ground,
                       const struct wd_view *view)
{
    double texel_m = ground->slopes_step * ground->terrain->cell_m;
    const uint32_t size[2] = {ground->slopes.width, ground->slopes.height};
    for (int k = 0; k < 2; k++) {
        values->slopes_scale[k] = (float)(1.0 / (texel_m * size[k]));
        values->slopes_offset[k] =
            (float)((view->eye_m[k] / texel_m + 0.5) / size[k]); /* of rel (0, 0) */
    }
    values->slopes_texel_m = (float)texel_m;
}

/* Of a cascade: texels that a metre spans. */
static float texels_per_m(const struct wd_view *view)
{
    float squared = 0.0f;
    for (int k = 0; k < 3; k++)
        squared += view->clip_from_rel[k][0] * view->clip_from_rel[k][0];
    return 0.5f * sqrtf(squared) * (float)view->width;
}

/* Pixels each way, over the picture's own, that the error bound asks level of detail to be chosen for.
 * Maps that are kept for later frames do not follow it. */
static float detail_of(const struct wd_tree_draw *draw)
{
    double spacing_px = 1.0 / sqrt(draw->forest->scene->methods.continuum.density);
    if (draw->max_error_px <= 0.0f || (draw->pass == WD_PASS_SHADOW && draw->view->box.calm))
        return 1.0f;
    return (float)(spacing_px / draw->max_error_px);
}

/* None in cascades, nor where trees are on demand and not known here. */
static struct wd_near_rule near_rule_of(const struct continuum *c, const struct wd_tree_draw *draw)
{
    const struct wd_continuum_options *options = &draw->forest->scene->methods.continuum;
    struct wd_near_rule rule = {.grains = c->forest.grains};
    if (draw->forest->pages.capacity || draw->pass == WD_PASS_SHADOW)
        return rule;
    rule.leaves_m = (float)options->near_leaves_m;
    if (options->near_px > 0.0)
        rule.reach = draw->view->pixels_per_radian * detail_of(draw) / (float)options->near_px;
    rule.farthest_m = fmaxf(rule.leaves_m, rule.reach * c->forest.coarsest_m);
    return rule;
}

static void upload_view(struct continuum *c, const struct wd_tree_draw *draw)
{
    const struct wd_view *view = draw->view;
    struct wd_splat_view *values = wd_cmd_upload(draw->cmd, sizeof *values, &c->view);
    if (!values)
        return;
    const struct wd_continuum_options *options = &draw->forest->scene->methods.continuum;
    bool shadow = draw->pass == WD_PASS_SHADOW;
    float detail = detail_of(draw);
    *values = (struct wd_splat_view){
        .plane_count = view->frustum.count,
        .orthographic = shadow,
        .calm = shadow && view->box.calm,
        .pixels = view->pixels_per_radian,
        .near_m = 0.1f,
        .typical_m = 0.7f * draw->forest->max_tree_height_m,
        .width = view->width,
        .height = view->height,
        .texels = 1,
        .density = (float)options->density * detail * detail,
        .detail = detail,
        .min_splats = (uint32_t)options->min_splats,
        .wood_px = (float)options->wood_px,
        .cluster_count = c->forest.cluster_count,
        .page_count = (uint32_t)c->pages.count,
        .variants = draw->forest->variants,
        .tree_capacity = c->tree_capacity,
        .item_capacity = c->item_capacity,
    };
    memcpy(values->clip_from_rel, view->clip_from_rel, sizeof values->clip_from_rel);
    memcpy(values->planes, view->frustum.planes, sizeof values->planes);
    set_slopes(values, &draw->forest->ground, view);
    if (!shadow) {
        set_history(c, values, view);
        const struct wd_near_rule rule = near_rule_of(c, draw);
        values->near_leaves_m = rule.leaves_m;
        values->near_grains = rule.reach;
    }
    if (shadow) {
        values->density = (float)options->shadow_density * detail * detail;
        values->min_splats = WD_SPLAT_STRATA;
        if (view->cascade > 0 && view->width % 2 == 0)
            values->texels = 2; /* these cascades hold crowns, not leaves: shaders/lib/shade.glsl */
        values->width /= values->texels;
        values->height /= values->texels;
        values->pixels = texels_per_m(view) / (float)values->texels;
    }
}

/* --- pages ------------------------------------------------------------------------------- */

/* Of all slots, so that a frame's views leave each other theirs. */
static const double CAMERA_SHARE = 0.5, CASCADE_SHARE = 0.1;

static bool page_seen(const void *view, const float min[3], const float max[3])
{
    return wd_frustum_box(&((const struct wd_view *)view)->frustum, min, max) != WD_OUTSIDE;
}

/* Trees on demand: which pages this view is made of. */
static void select_pages(struct continuum *c, const struct wd_tree_draw *draw)
{
    const struct wd_view *view = draw->view;
    struct wd_pages *pages = &c->device->pages;
    bool shadow = draw->pass == WD_PASS_SHADOW;
    struct wd_pages_query query = {
        .sees = page_seen,
        .view = view,
        .eye_m = {view->eye_m[0], view->eye_m[1], view->eye_m[2]},
        .pixels = view->pixels_per_radian,
        .orthographic = shadow,
        .whole_px = WD_WHOLE_TREE_PX / detail_of(draw),
        .budget = shadow ? (draw->page_budget + 3) / 4 : draw->page_budget,
        .most = (uint32_t)((shadow ? CASCADE_SHARE : CAMERA_SHARE) * pages->capacity),
    };
    if (shadow) {
        query.pixels = texels_per_m(view);
        query.whole_px *= 0.5f; /* a shadow is seen from nearer than it falls */
    }
    wd_pages_select(pages, draw->cmd, &query, &c->device->trees, &c->forest.clusters,
                    c->forest.cluster_count, &c->pages);
}

static struct wd_binding upload_pages(struct continuum *c, struct wd_cmd *cmd)
{
    struct wd_binding binding = {0};
    size_t size = c->pages.count * sizeof *c->pages.slots;
    uint32_t *slots = wd_cmd_upload(cmd, size ? size : sizeof *slots, &binding);
    if (slots && size)
        memcpy(slots, c->pages.slots, size);
    return binding;
}

static void record_args(struct continuum *c, struct wd_cmd *cmd)
{
    wd_cmd_use_buffer(cmd, &c->counts, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &c->groups, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {c->view, WD_BIND_BUFFER(&c->counts),
                                          WD_BIND_BUFFER(&c->groups)};
    wd_cmd_bind(cmd, &c->pipelines.args, bindings);
    wd_cmd_dispatch(cmd, 1, 1, 1);
    wd_cmd_use_buffer(cmd, &c->groups, WD_USE_INDIRECT);
}

static void record_cull(struct continuum *c, const struct wd_tree_draw *draw)
{
    struct wd_cmd *cmd = draw->cmd;
    wd_cmd_use_buffer(cmd, &c->history.pyramid, WD_USE_COMPUTE_READ);
    wd_cmd_fill_buffer(cmd, &c->counts, 0);
    wd_cmd_use_buffer(cmd, &c->counts, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &c->visible, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {draw->uniforms, c->view,
                                          WD_BIND_BUFFER(&c->forest.clusters),
                                          WD_BIND_BUFFER(&c->counts), WD_BIND_BUFFER(&c->visible),
                                          WD_BIND_BUFFER(&c->history.pyramid),
                                          upload_pages(c, cmd)};
    size_t clusters = c->forest.cluster_count + c->pages.count * WD_PAGE_CLUSTERS;
    wd_cmd_bind(cmd, &c->pipelines.cull, bindings);
    wd_cmd_dispatch_1d(cmd, (clusters + 63) / 64);
    record_args(c, cmd);
}

static void record_select(struct continuum *c, const struct wd_tree_draw *draw)
{
    struct wd_cmd *cmd = draw->cmd;
    wd_cmd_use_buffer(cmd, &c->counts, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &c->visible, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &c->trees, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &c->items, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &c->wood_items, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {draw->uniforms,
                                          c->view,
                                          WD_BIND_BUFFER(&c->forest.clusters),
                                          WD_BIND_BUFFER(&c->counts),
                                          WD_BIND_BUFFER(&c->visible),
                                          WD_BIND_BUFFER(&draw->forest->trees),
                                          WD_BIND_BUFFER(&draw->forest->models),
                                          WD_BIND_BUFFER(&c->forest.models),
                                          WD_BIND_BUFFER(&c->trees),
                                          WD_BIND_BUFFER(&c->items),
                                          WD_BIND_BUFFER(&c->wood_items),
                                          WD_BIND_BUFFER(&c->history.pyramid),
                                          WD_BIND_IMAGE(&draw->forest->ground.slopes,
                                                        draw->forest->ground.sampler)};
    wd_cmd_bind(cmd, &c->pipelines.choose[draw->pass], bindings);
    wd_cmd_dispatch_indirect(cmd, &c->groups, offsetof(struct wd_splat_groups, select));
    record_args(c, cmd);
}

/* Words of the visibility buffer that a pixel takes: id and depth, or depth alone. */
static VkDeviceSize pixel_bytes(enum wd_tree_pass pass)
{
    return pass == WD_PASS_CAMERA ? 2 * sizeof(uint32_t) : sizeof(uint32_t);
}

static void clear_pixels(struct continuum *c, const struct wd_tree_draw *draw)
{
    VkDeviceSize size =
        (VkDeviceSize)draw->view->width * draw->view->height * pixel_bytes(draw->pass);
    wd_cmd_use_buffer(draw->cmd, &c->pixels, WD_USE_TRANSFER_WRITE);
    if (!draw->cmd->failed)
        vkCmdFillBuffer(draw->cmd->vk, c->pixels.buffer, 0, size, 0);
}

static void record_draws(struct continuum *c, const struct wd_tree_draw *draw)
{
    struct wd_cmd *cmd = draw->cmd;
    const struct wd_buffer *items[] = {&c->items, &c->items, &c->wood_items};
    const struct wd_buffer *shapes[] = {&c->forest.splats, &c->forest.splats, &c->forest.wood};
    const VkDeviceSize groups[] = {offsetof(struct wd_splat_groups, splat),
                                   offsetof(struct wd_splat_groups, small),
                                   offsetof(struct wd_splat_groups, wood)};
    wd_cmd_use_buffer(cmd, &c->counts, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &c->trees, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &c->items, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &c->wood_items, WD_USE_COMPUTE_READ);
    clear_pixels(c, draw);
    for (uint32_t i = 0; i < 2 * WD_SHAPES; i++) {
        uint32_t ids = i / WD_SHAPES, kind = i % WD_SHAPES;
        const struct wd_pipeline *pipeline = &c->pipelines.draw[kind][draw->pass][ids];
        const struct wd_binding bindings[] = {c->view,
                                              WD_BIND_BUFFER(&c->counts),
                                              WD_BIND_BUFFER(&c->trees),
                                              WD_BIND_BUFFER(items[kind]),
                                              WD_BIND_BUFFER(shapes[kind]),
                                              WD_BIND_BUFFER(&c->pixels)};
        if (!pipeline->pipeline)
            continue;
        wd_cmd_use_buffer(cmd, &c->pixels, WD_USE_COMPUTE_WRITE);
        wd_cmd_bind(cmd, pipeline, bindings);
        wd_cmd_dispatch_indirect(cmd, &c->groups, groups[kind]);
    }
}

static void continuum_select(void *state, const struct wd_tree_draw *draw)
{
    struct continuum *c = state;
    struct wd_cmd *cmd = draw->cmd;
    wd_cmd_scope_begin(cmd, "pages");
    select_pages(c, draw);
    wd_cmd_scope_end(cmd);
    const struct wd_near_rule near = near_rule_of(c, draw);
    if (draw->pass == WD_PASS_CAMERA)
        wd_near_trees_select(&c->near, draw, &near);
    upload_view(c, draw);
    if (!fit_pixels(c, cmd, draw->view) || !fit_pyramid(c, cmd, draw->view))
        cmd->failed = true;
    if (cmd->failed)
        return;
    wd_cmd_scope_begin(cmd, "select");
    record_cull(c, draw);
    record_select(c, draw);
    wd_cmd_scope_end(cmd);
    wd_cmd_scope_begin(cmd, "splat");
    record_draws(c, draw);
    wd_cmd_scope_end(cmd);
    wd_cmd_use_buffer(cmd, &c->pixels, WD_USE_GRAPHICS_READ);
    wd_cmd_use_buffer(cmd, &c->trees, WD_USE_GRAPHICS_READ);
    wd_cmd_use_buffer(cmd, &c->items, WD_USE_GRAPHICS_READ);
    wd_cmd_use_buffer(cmd, &c->wood_items, WD_USE_GRAPHICS_READ);
}

static void draw_camera(struct continuum *c, const struct wd_tree_draw *draw)
{
    const struct wd_tree_push push = {.variants = draw->forest->variants};
    const struct wd_binding bindings[] = {draw->uniforms,
                                          WD_BIND_BUFFER(&c->pixels),
                                          WD_BIND_BUFFER(&c->trees),
                                          WD_BIND_BUFFER(&c->items),
                                          WD_BIND_BUFFER(&c->forest.splats),
                                          WD_BIND_BUFFER(&c->forest.looks),
                                          WD_BIND_BUFFER(&draw->forest->trees),
                                          WD_BIND_BUFFER(&draw->forest->models),
                                          WD_BIND_BUFFER(&c->wood_items),
                                          WD_BIND_BUFFER(&c->forest.wood),
                                          WD_BIND_IMAGE(&draw->forest->looks,
                                                        draw->forest->look_sampler)};
    for (uint32_t wood = 0; wood < 2; wood++) {
        wd_cmd_bind(draw->cmd, &c->pipelines.resolve[wood], bindings);
        wd_cmd_push(draw->cmd, &c->pipelines.resolve[wood], &push, sizeof push);
        wd_cmd_draw(draw->cmd, 3, 1);
        draw->stats->draw_calls++;
    }
}

static void draw_cascade(struct continuum *c, const struct wd_tree_draw *draw)
{
    const struct wd_binding bindings[] = {c->view, WD_BIND_BUFFER(&c->pixels)};
    wd_cmd_bind(draw->cmd, &c->pipelines.resolve_shadow, bindings);
    wd_cmd_draw(draw->cmd, 3, 1);
    draw->stats->draw_calls++;
}

static void continuum_draw(void *state, const struct wd_tree_draw *draw)
{
    if (draw->cmd->failed)
        return;
    if (draw->pass == WD_PASS_CAMERA) {
        draw_camera(state, draw);
        wd_tree_draw_selection(draw, &((struct continuum *)state)->near, WD_DRAW_GROUPED);
    } else
        draw_cascade(state, draw);
}

/* The depth pyramid of what this frame sees. */
static void continuum_keep(void *state, const struct wd_tree_draw *draw)
{
    struct continuum *c = state;
    struct wd_cmd *cmd = draw->cmd;
    const struct wd_view *view = draw->view;
    if (cmd->failed)
        return;
    wd_cmd_use_image(cmd, &draw->targets->depth, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &c->pixels, WD_USE_COMPUTE_READ);
    const struct wd_binding bindings[] = {c->view, WD_BIND_BUFFER(&c->pixels),
                                          WD_BIND_IMAGE(&draw->targets->depth, c->pipelines.nearest),
                                          WD_BIND_BUFFER(&c->history.pyramid)};
    for (uint32_t i = 0; i < WD_PYRAMID_LEVELS - 1; i++) {
        uint32_t texels = 8 * (4u << i); /* pixels of a workgroup */
        wd_cmd_use_buffer(cmd, &c->history.pyramid, WD_USE_COMPUTE_WRITE);
        wd_cmd_bind(cmd, &c->pipelines.pyramid[i], bindings);
        wd_cmd_dispatch(cmd, (view->width + texels - 1) / texels,
                        (view->height + texels - 1) / texels, 1);
    }
    c->history.width = view->width;
    c->history.height = view->height;
    memcpy(c->history.eye_m, view->eye_m, sizeof c->history.eye_m);
    c->history.camera = view->camera;
    memcpy(c->history.clip_from_rel, view->clip_from_rel, sizeof c->history.clip_from_rel);
}

/* Splats of the items first..first + count. */
static uint64_t count_splats(struct continuum *c, struct wd_gpu *gpu, uint32_t first, uint32_t count)
{
    uint64_t splats = 0;
    size_t size = count * sizeof(struct wd_splat_item);
    struct wd_splat_item *items = wd_alloc_array(count ? count : 1, sizeof *items);
    if (count && wd_buffer_read(gpu, &c->items, first * sizeof *items, items, size)) {
        for (uint32_t i = 0; i < count; i++)
            splats += items[i].count;
    }
    free(items);
    return splats;
}

static uint64_t continuum_discs(void *state, struct wd_gpu *gpu)
{
    struct continuum *c = state;
    struct wd_splat_counts counts;
    if (!c->counts.buffer || !wd_buffer_read(gpu, &c->counts, 0, &counts, sizeof counts))
        return 0;
    uint32_t many = counts.items < c->item_capacity ? counts.items : c->item_capacity;
    uint32_t few = counts.small_items < c->item_capacity ? counts.small_items : c->item_capacity;
    return count_splats(c, gpu, 0, many) + count_splats(c, gpu, c->item_capacity - few, few);
}

const struct wd_method wd_method_continuum = {
    .name = "continuum",
    .on_demand = true,
    .cascades = WD_CASCADES_KEPT,
    .ground = WD_GROUND_LAST,
    .state_size = sizeof(struct continuum),
    .init = continuum_init,
    .finish = continuum_finish,
    .use_forest = continuum_use_forest,
    .drop_forest = continuum_drop_forest,
    .select = continuum_select,
    .draw = continuum_draw,
    .keep = continuum_keep,
    .discs = continuum_discs,
};
