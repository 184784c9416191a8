/* continuum: cost that follows the pixels (shaders/shared/continuum.h tells how passes connect).
 *
 * All that depends on single trees happens on the device: clusters are culled, trees chosen and
 * splatted into one visibility buffer, which is resolved into the same G-buffer that every method
 * fills. */
#include "methods/continuum_pipelines.h"
#include "methods/continuum_view.h"
#include "methods/method.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/memory.h"

/* Visible trees and items of one view: hard caps, whatever the world holds. Lists have room for a tree for each
 * PIXELS_A_TREE, but no more than the device can bind and than ids of items, which have 22 bits, can tell. */
enum { LEAST_TREES = 1 << 20, PIXELS_A_TREE = 4, ITEMS_A_TREE = 2, LEAST_ITEMS = 1 << 20,
       MOST_TREES = (1 << 22) / ITEMS_A_TREE - 1 };

struct continuum {
    struct wd_gpu *gpu;
    struct wd_continuum_pipelines pipelines;
    struct wd_continuum_forest forest;
    struct wd_buffer visible, counts, groups, trees, items, wood_items, pixels;
    struct wd_buffer lost;    /* struct wd_splat_lost, since the forest is in use */
    bool told_lost;
    struct wd_buffer put_off; /* uint32_t[]: see shaders/lib/put_off.glsl */
    uint32_t tree_capacity, item_capacity, cluster_capacity;
    uint32_t most_trees; /* that any view can hold */
    struct wd_buffer large;    /* parts of triangles of wood: see lib/wood_draw.glsl */
    struct wd_buffer depths;   /* of a view, in its target's texels */
    enum wd_filled filled;     /* whether the view's targets are */
    struct wd_buffer pyramid; /* float[], of the camera's newest frame */
    struct wd_continuum_history history;
    struct wd_splat_view values; /* of the view being drawn */
    struct wd_binding view;      /* the same, for the device */
    struct wd_forest_device *device; /* whose pages this plants */
    struct wd_page_list pages[2]; /* of that view; [WD_PASS_*] */
    struct wd_selection near;  /* drawn leaf by leaf */
};

static bool make_work(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                      VkDeviceSize size, VkFormat texels)
{
    const struct wd_buffer_params params = {
        name, size,
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
            (texels ? VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT : 0),
        WD_MEMORY_DEVICE, texels};
    return wd_buffer_init(buffer, gpu, &params);
}

static bool continuum_init(void *state, struct wd_gpu *gpu)
{
    struct continuum *c = state;
    c->gpu = gpu;
    return wd_continuum_pipelines_init(&c->pipelines, gpu) &&
           make_work(&c->large, gpu, "large triangles",
                     4 * sizeof(uint32_t) + WD_LARGE_MOST * sizeof(struct wd_large_part),
                     VK_FORMAT_UNDEFINED);
}

static void continuum_finish(void *state, struct wd_gpu *gpu)
{
    struct continuum *c = state;
    wd_continuum_pipelines_finish(&c->pipelines, gpu);
    wd_buffer_finish(&c->pixels, gpu);
    wd_buffer_finish(&c->depths, gpu);
    wd_buffer_finish(&c->large, gpu);
    wd_buffer_finish(&c->pyramid, gpu);
    wd_page_list_finish(&c->pages[WD_PASS_CAMERA]);
    wd_page_list_finish(&c->pages[WD_PASS_SHADOW]);
}

/* --- forest ------------------------------------------------------------------------------ */

/* Their capacity is 0 until all are there. */
static bool make_lists(struct continuum *c, struct wd_gpu *gpu, uint32_t trees)
{
    uint32_t items = trees > LEAST_ITEMS / ITEMS_A_TREE ? trees * ITEMS_A_TREE : LEAST_ITEMS;
    c->tree_capacity = c->item_capacity = 0;
    bool ok = make_work(&c->trees, gpu, "splat trees", trees * sizeof(struct wd_splat_tree),
                        VK_FORMAT_R32G32B32A32_UINT) &&
              make_work(&c->items, gpu, "splat items", items * sizeof(struct wd_splat_item),
                        VK_FORMAT_R32G32_UINT) &&
              make_work(&c->wood_items, gpu, "wood items", items * sizeof(struct wd_splat_item),
                        VK_FORMAT_R32G32_UINT);
    if (ok) {
        c->tree_capacity = trees;
        c->item_capacity = items;
    }
    return ok;
}

/* Trees that lists for a view of so many pixels hold. */
static uint32_t trees_in_lists(const struct continuum *c, uint64_t pixels)
{
    uint64_t trees = pixels / PIXELS_A_TREE > LEAST_TREES ? pixels / PIXELS_A_TREE : LEAST_TREES;
    return trees < c->most_trees ? (uint32_t)trees : c->most_trees;
}

/* All of the world, or what the device can bind. */
static uint32_t most_trees(const struct wd_gpu *gpu, size_t trees)
{
    const VkPhysicalDeviceLimits *limits = &gpu->properties.limits;
    uint32_t bound = limits->maxStorageBufferRange / (uint32_t)sizeof(struct wd_splat_tree);
    uint32_t texels = limits->maxTexelBufferElements / WD_SPLAT_TREE_TEXELS;
    uint32_t most = bound < texels ? bound : texels;
    most = most < MOST_TREES ? most : MOST_TREES;
    return trees < most ? (uint32_t)trees : most;
}

static bool continuum_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    struct continuum *c = state;
    size_t paged = (size_t)forest->pages.capacity * WD_PAGE_TREES;
    size_t trees = forest->world->tree_count + paged;
    if (!trees)
        return true;
    const struct wd_splat_lost none = {0};
    c->device = forest;
    c->told_lost = false;
    wd_pages_forget(&forest->pages);
    c->most_trees = most_trees(gpu, trees);
    bool ok = wd_continuum_forest_init(&c->forest, gpu, forest);
    c->cluster_capacity = c->forest.cluster_count + (uint32_t)(paged / WD_PAGE_CLUSTER);
    return ok &&
           make_work(&c->visible, gpu, "visible clusters",
                     c->cluster_capacity * sizeof(uint32_t), VK_FORMAT_UNDEFINED) &&
           make_work(&c->put_off, gpu, "trees put off",
                     (VkDeviceSize)c->cluster_capacity * 4 * sizeof(uint32_t), VK_FORMAT_UNDEFINED) &&
           make_work(&c->counts, gpu, "splat counts", sizeof(struct wd_splat_counts),
                     VK_FORMAT_UNDEFINED) &&
           make_work(&c->lost, gpu, "splats without room", sizeof none, VK_FORMAT_UNDEFINED) &&
           wd_buffer_upload(gpu, &c->lost, 0, &none, sizeof none) &&
           make_work(&c->groups, gpu, "splat groups", sizeof(struct wd_splat_groups),
                     VK_FORMAT_UNDEFINED) &&
           make_lists(c, gpu, trees_in_lists(c, 0));
}

static void continuum_forget(void *state)
{
    struct continuum *c = state;
    c->history.width = c->history.height = 0;
}

static void continuum_drop_forest(void *state, struct wd_gpu *gpu)
{
    struct continuum *c = state;
    struct wd_buffer *buffers[] = {&c->visible, &c->counts, &c->groups, &c->lost,
                                   &c->put_off, &c->trees,  &c->items,  &c->wood_items};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        wd_buffer_finish(buffers[i], gpu);
    wd_continuum_forest_finish(&c->forest, gpu);
    wd_selection_finish(&c->near);
    continuum_forget(c);
}

/* --- one view ---------------------------------------------------------------------------- */

/* For either pass: id and depth of each pixel, or fewer words. */
static bool fit_pixels(struct continuum *c, struct wd_cmd *cmd, const struct wd_view *view)
{
    VkDeviceSize size = (VkDeviceSize)view->width * view->height * 2 * sizeof(uint32_t);
    if (c->pixels.size >= size)
        return true;
    wd_cmd_defer_buffer(cmd, &c->pixels);
    return make_work(&c->pixels, cmd->gpu, "visibility", size, VK_FORMAT_R32G32_UINT);
}

static bool fit_lists(struct continuum *c, struct wd_cmd *cmd, const struct wd_view *view)
{
    uint32_t trees = trees_in_lists(c, (uint64_t)view->width * view->height);
    if (c->tree_capacity >= trees)
        return true;
    wd_cmd_defer_buffer(cmd, &c->trees);
    wd_cmd_defer_buffer(cmd, &c->items);
    wd_cmd_defer_buffer(cmd, &c->wood_items);
    return make_lists(c, cmd->gpu, trees);
}

static bool fit_pyramid(struct continuum *c, struct wd_cmd *cmd, const struct wd_view *view)
{
    uint32_t first[WD_PYRAMID_LEVELS];
    VkDeviceSize size = wd_pyramid_offsets(first, view->width, view->height) * sizeof(float);
    if (c->pyramid.size >= size)
        return true;
    wd_cmd_defer_buffer(cmd, &c->pyramid);
    return make_work(&c->pyramid, cmd->gpu, "depth pyramid", size, VK_FORMAT_R32_SFLOAT);
}

static bool sees_all_at_once(const struct continuum *c)
{
    return !c->values.has_history || !c->values.moved;
}

static void upload_view(struct continuum *c, struct wd_cmd *cmd)
{
    struct wd_splat_view *values = wd_cmd_upload(cmd, sizeof *values, &c->view);
    if (values)
        *values = c->values;
}

static void fill_view(struct continuum *c, const struct wd_tree_draw *draw)
{
    const struct wd_continuum_view_params params = {
        .draw = draw,
        .forest = &c->forest,
        .history = &c->history,
        /* without these, ids of a second round could not be told from those of the first */
        .puts_off = c->gpu->features & WD_GPU_FEATURE_INT64_ATOMICS,
        .page_count = (uint32_t)c->pages[draw->pass].count,
        .tree_capacity = c->tree_capacity,
        .item_capacity = c->item_capacity,
        .cluster_capacity = c->cluster_capacity,
    };
    wd_continuum_view_fill(&c->values, &params);
    upload_view(c, draw->cmd);
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
        .view_hash = XXH3_64bits(&view->frustum, sizeof view->frustum),
        .eye_m = {view->eye_m[0], view->eye_m[1], view->eye_m[2]},
        .pixels = view->pixels_per_radian,
        .orthographic = shadow,
        .whole_px = WD_WHOLE_TREE_PX / wd_continuum_detail(draw),
        .budget = shadow ? (draw->page_budget + 3) / 4 : draw->page_budget,
        .most = (uint32_t)((shadow ? CASCADE_SHARE : CAMERA_SHARE) * pages->capacity),
    };
    if (shadow) {
        query.pixels = wd_texels_per_m(view);
        query.whole_px *= 0.5f; /* a shadow is seen from nearer than it falls */
    }
    wd_pages_select(pages, draw->cmd, &query, &c->device->trees, &c->forest.clusters,
                    c->forest.cluster_count, &c->pages[draw->pass]);
    draw->stats->unfinished = draw->stats->unfinished || c->pages[draw->pass].coarser;
}

static struct wd_binding upload_pages(const struct wd_page_list *pages, struct wd_cmd *cmd)
{
    struct wd_binding binding = {0};
    size_t size = pages->count * sizeof *pages->slots;
    uint32_t *slots = wd_cmd_upload(cmd, size ? size : sizeof *slots, &binding);
    if (slots && size)
        memcpy(slots, pages->slots, size);
    return binding;
}

enum round { FIRST_ROUND, SECOND_ROUND };

/* What the counts so far are made to be: the next stage's groups, or the beginning of a second round. */
enum args { COUNT_GROUPS, BEGIN_SECOND };

static void record_args(struct continuum *c, struct wd_cmd *cmd, enum args args)
{
    wd_cmd_use_buffer(cmd, &c->counts, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &c->groups, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &c->lost, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &c->large, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {c->view, WD_BIND_BUFFER(&c->counts),
                                          WD_BIND_BUFFER(&c->groups), WD_BIND_BUFFER(&c->lost),
                                          WD_BIND_BUFFER(&c->large)};
    wd_cmd_bind(cmd, &c->pipelines.args[args], bindings);
    wd_cmd_dispatch(cmd, 1, 1, 1);
    wd_cmd_use_buffer(cmd, &c->groups, WD_USE_INDIRECT);
}

static void record_cull(struct continuum *c, const struct wd_tree_draw *draw)
{
    struct wd_cmd *cmd = draw->cmd;
    wd_cmd_use_buffer(cmd, &c->pyramid, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &c->forest.clusters, WD_USE_COMPUTE_READ); /* later views may plant there */
    wd_cmd_use_buffer(cmd, &c->device->trees, WD_USE_SHADER_READ);
    wd_cmd_fill_buffer(cmd, &c->counts, 0);
    wd_cmd_use_buffer(cmd, &c->counts, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &c->visible, WD_USE_COMPUTE_WRITE);
    if (!sees_all_at_once(c))
        wd_cmd_fill_buffer(cmd, &c->put_off, 0);
    wd_cmd_use_buffer(cmd, &c->put_off, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {draw->uniforms, c->view,
                                          WD_BIND_BUFFER(&c->forest.clusters),
                                          WD_BIND_BUFFER(&c->counts), WD_BIND_BUFFER(&c->visible),
                                          WD_BIND_BUFFER(&c->pyramid),
                                          upload_pages(&c->pages[draw->pass], cmd), WD_BIND_BUFFER(&c->put_off)};
    size_t clusters = c->forest.cluster_count + c->pages[draw->pass].count * WD_PAGE_CLUSTERS;
    wd_cmd_bind(cmd, &c->pipelines.cull, bindings);
    wd_cmd_dispatch_1d(cmd, (clusters + 63) / 64);
    record_args(c, cmd, COUNT_GROUPS);
}

static void record_sort(struct continuum *c, struct wd_cmd *cmd)
{
    wd_cmd_use_buffer(cmd, &c->counts, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &c->items, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {c->view, WD_BIND_BUFFER(&c->counts),
                                          WD_BIND_BUFFER(&c->items)};
    wd_cmd_bind(cmd, &c->pipelines.sort, bindings);
    wd_cmd_dispatch_indirect(cmd, &c->groups, offsetof(struct wd_splat_groups, sort));
}

static void record_select(struct continuum *c, const struct wd_tree_draw *draw, enum round round)
{
    struct wd_cmd *cmd = draw->cmd;
    const struct wd_pipeline *pipeline =
        round == SECOND_ROUND ? &c->pipelines.choose_again : &c->pipelines.choose[draw->pass];
    wd_cmd_use_buffer(cmd, &c->pyramid, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &c->put_off, WD_USE_COMPUTE_WRITE);
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
                                          WD_BIND_BUFFER(&c->pyramid),
                                          WD_BIND_IMAGE(&draw->forest->ground.slopes,
                                                        draw->forest->ground.sampler),
                                          WD_BIND_BUFFER(&c->put_off),
                                          WD_BIND_BUFFER(&draw->forest->fades)};
    wd_cmd_bind(cmd, pipeline, bindings);
    wd_cmd_dispatch_indirect(cmd, &c->groups, offsetof(struct wd_splat_groups, select));
    record_args(c, cmd, COUNT_GROUPS);
    record_sort(c, cmd);
}

/* Of the visibility buffer, for a pixel: words of id and depth, or of depth alone. */
static VkDeviceSize pixel_bytes(enum wd_tree_pass pass)
{
    return pass == WD_PASS_CAMERA ? 2 * sizeof(uint32_t) : sizeof(uint32_t);
}

static void clear_pixels(struct continuum *c, const struct wd_tree_draw *draw)
{
    VkDeviceSize size = (VkDeviceSize)c->values.width * c->values.height * pixel_bytes(draw->pass);
    wd_cmd_use_buffer(draw->cmd, &c->pixels, WD_USE_TRANSFER_WRITE);
    if (!draw->cmd->failed)
        vkCmdFillBuffer(draw->cmd->vk, c->pixels.buffer, 0, size, 0);
}

/* One kind of what is rasterised, where this device draws it so: then the large triangles that it has listed. */
static void record_shape(struct continuum *c, const struct wd_tree_draw *draw, uint32_t shape, uint32_t ids)
{
    static const VkDeviceSize groups[WD_SHAPES] = {
        [WD_SHAPE_SPLATS] = offsetof(struct wd_splat_groups, splat),
        [WD_SHAPE_SMALL] = offsetof(struct wd_splat_groups, small),
        [WD_SHAPE_BOTH] = offsetof(struct wd_splat_groups, all_splats),
        [WD_SHAPE_WOOD] = offsetof(struct wd_splat_groups, wood)};
    struct wd_cmd *cmd = draw->cmd;
    bool wood = shape == WD_SHAPE_WOOD;
    const struct wd_pipeline *pipeline = &c->pipelines.draw[shape][draw->pass][ids];
    const struct wd_pipeline *large = &c->pipelines.large[draw->pass];
    const struct wd_binding bindings[] = {c->view,
                                          WD_BIND_BUFFER(&c->counts),
                                          WD_BIND_BUFFER(&c->trees),
                                          WD_BIND_BUFFER(wood ? &c->wood_items : &c->items),
                                          WD_BIND_BUFFER(wood ? &c->forest.wood : &c->forest.splats),
                                          WD_BIND_BUFFER(&c->pixels), /* to be drawn to, */
                                          WD_BIND_BUFFER(&c->forest.lit),
                                          WD_BIND_BUFFER(&c->pixels), /* and its texels: lib/drawn.glsl */
                                          WD_BIND_BUFFER(&c->large)};
    if (!pipeline->kept)
        return;
    wd_cmd_use_buffer(cmd, &c->pixels, WD_USE_COMPUTE_WRITE);
    if (wood)
        wd_cmd_use_buffer(cmd, &c->large, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, pipeline, bindings);
    wd_cmd_dispatch_indirect(cmd, &c->groups, groups[shape]);
    if (!wood || !large->kept)
        return;
    wd_cmd_use_buffer(cmd, &c->large, WD_USE_INDIRECT);
    wd_cmd_use_buffer(cmd, &c->pixels, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, large, bindings);
    wd_cmd_dispatch_indirect(cmd, &c->large, 0);
}

/* All shapes; where ids take a pass of their own (continuum_splat_twice.comp), all of them again. */
static void record_draws(struct continuum *c, const struct wd_tree_draw *draw)
{
    wd_cmd_use_buffer(draw->cmd, &c->counts, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(draw->cmd, &c->trees, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(draw->cmd, &c->items, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(draw->cmd, &c->wood_items, WD_USE_COMPUTE_READ);
    for (uint32_t ids = 0; ids < 2; ids++)
        for (uint32_t shape = 0; shape < WD_SHAPES; shape++)
            record_shape(c, draw, shape, ids);
}

static void record_pyramid(struct continuum *c, const struct wd_tree_draw *draw,
                           const struct wd_pipeline *finest)
{
    struct wd_cmd *cmd = draw->cmd;
    wd_cmd_use_image(cmd, &draw->targets->depth, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &c->pixels, WD_USE_COMPUTE_READ);
    const struct wd_binding bindings[] = {c->view, WD_BIND_BUFFER(&c->pixels),
                                          WD_BIND_IMAGE(&draw->targets->depth, c->pipelines.nearest),
                                          WD_BIND_BUFFER(&c->pyramid)};
    for (uint32_t i = 0; i < WD_PYRAMID_LEVELS - 1; i++) {
        uint32_t texels = 8 * (4u << i); /* pixels of a workgroup */
        wd_cmd_use_buffer(cmd, &c->pyramid, WD_USE_COMPUTE_WRITE);
        wd_cmd_bind(cmd, i ? &c->pipelines.pyramid[i] : finest, bindings);
        wd_cmd_dispatch(cmd, (draw->view->width + texels - 1) / texels,
                        (draw->view->height + texels - 1) / texels, 1);
    }
}

/* What the frame before hid and what is drawn by now does not. */
static void record_second_round(struct continuum *c, const struct wd_tree_draw *draw)
{
    record_pyramid(c, draw, &c->pipelines.pyramid_of_trees);
    wd_continuum_view_again(&c->values);
    upload_view(c, draw->cmd);
    if (draw->cmd->failed)
        return;
    record_args(c, draw->cmd, BEGIN_SECOND);
    record_select(c, draw, SECOND_ROUND);
    record_draws(c, draw);
}

static void record_rounds(struct continuum *c, const struct wd_tree_draw *draw)
{
    struct wd_cmd *cmd = draw->cmd;
    wd_cmd_scope_begin(cmd, "select");
    record_cull(c, draw);
    record_select(c, draw, FIRST_ROUND);
    wd_cmd_scope_end(cmd);
    wd_cmd_scope_begin(cmd, "splat");
    clear_pixels(c, draw);
    record_draws(c, draw);
    wd_cmd_scope_end(cmd);
    if (sees_all_at_once(c))
        return;
    wd_cmd_scope_begin(cmd, "second round");
    record_second_round(c, draw);
    wd_cmd_scope_end(cmd);
}

/* What was uploaded for the forest, for all the passes of a view. */
static void use_forest_buffers(struct continuum *c, struct wd_cmd *cmd)
{
    struct wd_buffer *buffers[] = {&c->forest.splats, &c->forest.looks, &c->forest.lit,
                                   &c->forest.wood, &c->forest.models};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        wd_cmd_use_buffer(cmd, buffers[i], WD_USE_SHADER_READ);
}

static void continuum_select(void *state, const struct wd_tree_draw *draw)
{
    struct continuum *c = state;
    struct wd_cmd *cmd = draw->cmd;
    const struct wd_near_rule near = wd_continuum_near_rule(draw, &c->forest);
    use_forest_buffers(c, cmd);
    wd_cmd_scope_begin(cmd, "pages");
    select_pages(c, draw);
    wd_cmd_scope_end(cmd);
    wd_near_trees_select(&c->near, draw, &near);
    if (!fit_lists(c, cmd, draw->view) || !fit_pixels(c, cmd, draw->view) ||
        !fit_pyramid(c, cmd, draw->view))
        cmd->failed = true;
    fill_view(c, draw);
    if (cmd->failed)
        return;
    record_rounds(c, draw);
}

static bool fit_depths(struct continuum *c, struct wd_cmd *cmd, VkDeviceSize texels)
{
    VkDeviceSize size = texels * sizeof(uint32_t);
    if (c->depths.size < size) {
        if (c->depths.buffer)
            wd_cmd_defer_buffer(cmd, &c->depths);
        cmd->failed = cmd->failed ||
                      !make_work(&c->depths, cmd->gpu, "depths", size, VK_FORMAT_UNDEFINED);
    }
    if (!cmd->failed)
        wd_cmd_use_buffer(cmd, &c->depths, WD_USE_COMPUTE_WRITE);
    return !cmd->failed;
}

/* A cascade's depth lies in the visibility buffer as its map holds it, but where discs have larger texels. */
static void fill_cascade(struct continuum *c, const struct wd_tree_draw *draw)
{
    struct wd_cmd *cmd = draw->cmd;
    struct wd_image *map = &draw->targets->shadow;
    VkDeviceSize texels = (VkDeviceSize)map->width * map->height;
    bool as_map = c->values.texels == 1;
    if (!as_map && fit_depths(c, cmd, texels)) {
        const struct wd_binding bindings[] = {c->view, WD_BIND_BUFFER(&c->pixels),
                                              WD_BIND_BUFFER(&c->depths)};
        wd_cmd_bind(cmd, &c->pipelines.cascade, bindings);
        wd_cmd_dispatch_1d(cmd, (texels + 63) / 64);
    }
    if (!cmd->failed)
        wd_cmd_copy_to_image(cmd, as_map ? &c->pixels : &c->depths, 0, map, draw->view->cascade);
}

enum { RESOLVE_BINDINGS = 10 };

/* What shaders/lib/resolve.glsl reads, by fragments or by compute. */
static void bind_resolve(struct wd_binding bindings[RESOLVE_BINDINGS], const struct continuum *c,
                         const struct wd_tree_draw *draw)
{
    const struct wd_binding reads[RESOLVE_BINDINGS] = {
        draw->uniforms,
        WD_BIND_BUFFER(&c->pixels),
        WD_BIND_BUFFER(&c->trees),
        WD_BIND_BUFFER(&c->items),
        WD_BIND_BUFFER(&c->forest.splats),
        WD_BIND_BUFFER(&c->forest.looks),
        WD_BIND_BUFFER(&c->wood_items),
        WD_BIND_BUFFER(&c->forest.wood),
        WD_BIND_IMAGE(&draw->forest->looks, draw->forest->look_sampler),
        WD_BIND_BUFFER(&c->forest.lit)};
    memcpy(bindings, reads, sizeof reads);
}

static void fill_camera(struct continuum *c, const struct wd_tree_draw *draw)
{
    struct wd_cmd *cmd = draw->cmd;
    struct wd_targets *targets = draw->targets;
    if (!fit_depths(c, cmd, (VkDeviceSize)targets->width * targets->height))
        return;
    wd_cmd_discard_image(cmd, &targets->albedo, WD_USE_COMPUTE_WRITE);
    wd_cmd_discard_image(cmd, &targets->normal, WD_USE_COMPUTE_WRITE);
    wd_cmd_discard_image(cmd, &targets->surface, WD_USE_COMPUTE_WRITE);
    struct wd_binding bindings[RESOLVE_BINDINGS + 4];
    bind_resolve(bindings, c, draw);
    bindings[RESOLVE_BINDINGS] = WD_BIND_STORAGE_IMAGE(&targets->albedo);
    bindings[RESOLVE_BINDINGS + 1] = WD_BIND_STORAGE_IMAGE(&targets->normal);
    bindings[RESOLVE_BINDINGS + 2] = WD_BIND_STORAGE_IMAGE(&targets->surface);
    bindings[RESOLVE_BINDINGS + 3] = WD_BIND_BUFFER(&c->depths);
    wd_cmd_bind(cmd, &c->pipelines.resolve_all, bindings);
    wd_cmd_dispatch(cmd, (targets->width + 7) / 8, (targets->height + 7) / 8, 1);
    wd_cmd_copy_to_image(cmd, &c->depths, 0, &targets->depth, 0);
}

/* As an image that compute stores to: a copy to depth takes an H200 four times as long. */
static void store_cascade(struct continuum *c, const struct wd_tree_draw *draw)
{
    struct wd_cmd *cmd = draw->cmd;
    struct wd_targets *targets = draw->targets;
    const struct wd_cascade_push push = {draw->view->cascade, c->near.mesh_count > 0};
    wd_cmd_use_buffer(cmd, &c->pixels, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->shadow, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, &targets->stored_shadow, WD_USE_COMPUTE_WRITE);
    const struct wd_binding bindings[] = {c->view, WD_BIND_BUFFER(&c->pixels),
                                          WD_BIND_IMAGE(&targets->shadow, c->pipelines.nearest),
                                          WD_BIND_STORAGE_IMAGE(&targets->stored_shadow)};
    wd_cmd_bind(cmd, &c->pipelines.cascade_store, bindings);
    wd_cmd_push(cmd, &c->pipelines.cascade_store, &push, sizeof push);
    wd_cmd_dispatch(cmd, (targets->shadow_size + 7) / 8, (targets->shadow_size + 7) / 8, 1);
}

static void continuum_merge(void *state, const struct wd_tree_draw *draw)
{
    struct continuum *c = state;
    if (draw->pass == WD_PASS_SHADOW && c->pipelines.cascade_store.kept && !draw->cmd->failed)
        store_cascade(c, draw);
}

static enum wd_filled continuum_fill(void *state, const struct wd_tree_draw *draw)
{
    struct continuum *c = state;
    bool fills = draw->pass == WD_PASS_SHADOW || c->pipelines.resolve_all.kept;
    bool stores = draw->pass == WD_PASS_SHADOW && c->pipelines.cascade_store.kept; /* in continuum_merge */
    bool meshes = c->near.mesh_count > 0;
    c->filled = WD_FILLED_NOT;
    if (draw->cmd->failed)
        return c->filled;
    struct wd_buffer *reads[] = {&c->pixels, &c->trees, &c->items, &c->wood_items};
    for (size_t i = 0; i < sizeof reads / sizeof *reads; i++)
        wd_cmd_use_buffer(draw->cmd, reads[i], fills ? WD_USE_COMPUTE_READ : WD_USE_GRAPHICS_READ);
    if (!fills)
        return c->filled;
    if (!stores && draw->pass == WD_PASS_SHADOW)
        fill_cascade(c, draw);
    else if (!stores)
        fill_camera(c, draw);
    c->filled = !meshes ? WD_FILLED_LAST : stores ? WD_FILLED_NOT : WD_FILLED;
    return c->filled;
}

static void draw_camera(struct continuum *c, const struct wd_tree_draw *draw)
{
    struct wd_binding bindings[RESOLVE_BINDINGS];
    bind_resolve(bindings, c, draw);
    const struct wd_binding depth_bindings[] = {c->view, WD_BIND_BUFFER(&c->pixels),
                                                WD_BIND_BUFFER(&c->trees),
                                                WD_BIND_BUFFER(&c->items)};
    for (uint32_t wood = 2; wood-- > 0;) {
        wd_cmd_bind(draw->cmd, &c->pipelines.depth[wood], depth_bindings);
        wd_cmd_draw(draw->cmd, 3, 1);
        wd_cmd_bind(draw->cmd, &c->pipelines.resolve[wood], bindings);
        wd_cmd_draw(draw->cmd, 3, 1);
        draw->stats->draw_calls += 2;
    }
}

static void continuum_draw(void *state, const struct wd_tree_draw *draw)
{
    if (draw->cmd->failed)
        return;
    if (draw->pass == WD_PASS_CAMERA && ((struct continuum *)state)->filled == WD_FILLED_NOT)
        draw_camera(state, draw);
    wd_tree_draw_selection(draw, &((struct continuum *)state)->near, WD_DRAW_GROUPED);
}

/* The depth pyramid of what this frame sees. */
static void continuum_keep(void *state, const struct wd_tree_draw *draw)
{
    struct continuum *c = state;
    if (draw->cmd->failed)
        return;
    record_pyramid(c, draw, &c->pipelines.pyramid[0]);
    wd_continuum_history_keep(&c->history, draw->view);
}

/* Splats of the items first..first + count. */
static uint64_t count_splats(struct continuum *c, struct wd_gpu *gpu, uint32_t first, uint32_t count)
{
    uint64_t splats = 0;
    size_t size = count * sizeof(struct wd_splat_item);
    struct wd_splat_item *items = wd_alloc_array(count ? count : 1, sizeof *items);
    if (count && wd_buffer_read(gpu, &c->items, first * sizeof *items, items, size)) {
        for (uint32_t i = 0; i < count; i++)
            splats += WD_ITEM_COUNT(items[i]);
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

/* Once a forest: what is missing is missing from pictures like this one. */
static void continuum_check(void *state, struct wd_gpu *gpu)
{
    struct continuum *c = state;
    struct wd_splat_lost lost;
    if (c->told_lost || !c->lost.buffer || !wd_buffer_read(gpu, &c->lost, 0, &lost, sizeof lost))
        return;
    c->told_lost = lost.trees || lost.items;
    if (c->told_lost)
        wd_warn(gpu->log,
                "continuum: a view holds more than %u trees or %u parts of trees: %u and %u are not "
                "drawn; a larger error bound needs fewer",
                c->tree_capacity, c->item_capacity, lost.trees, lost.items);
}

const struct wd_method wd_method_continuum = {
    .name = "continuum",
    .on_demand = true,
    .cascades = WD_CASCADES_KEPT,
    .ground = WD_GROUND_LAST,
    .stores_shadow = true,
    .single_leaves = true,
    .state_size = sizeof(struct continuum),
    .init = continuum_init,
    .finish = continuum_finish,
    .use_forest = continuum_use_forest,
    .drop_forest = continuum_drop_forest,
    .select = continuum_select,
    .fill = continuum_fill,
    .draw = continuum_draw,
    .merge = continuum_merge,
    .keep = continuum_keep,
    .forget = continuum_forget,
    .discs = continuum_discs,
    .check = continuum_check,
};
