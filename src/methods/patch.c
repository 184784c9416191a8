/* Tiled patches of plants, blended back to front in an order found by arithmetic (McNabb: foliage
 * sample, Intel 2013; rows I1, I2, I7-I9).
 *
 * The world is an array of patches, each of cells x cells cells. A patch's table (which trees stand
 * in which cell) is made when the patch is first seen and dropped again when others need the room.
 * Billboards face the eye; their opacity is blended, premultiplied, patch after patch and cell after
 * cell from the back (shared/patch_order.h). Near the eye meshes stand in the G-buffer; billboards
 * fade in before they go. */
#include "methods/method.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "methods/cells.h"
#include "shared/patch_order.h"

static const uint32_t patch_card_vert[] =
#include "patch_card.vert.inc"
    ;
static const uint32_t patch_blend_frag[] =
#include "patch_blend.frag.inc"
    ;
static const uint32_t tree_card_frag[] =
#include "tree_card.frag.inc"
    ;

enum { BINDINGS = 13 };

/* A patch on the device. */
struct resident {
    struct wd_buffer table; /* uint32_t: see patch_card.vert */
    uint64_t used;          /* frame in which it was last drawn */
};

struct patch_state {
    struct wd_pipeline blend, layers;
    struct wd_cells patches;
    double cell_m;
    uint32_t cells;            /* of a patch along a side */
    struct resident *resident; /* by patch */
    uint32_t resident_count;
    uint32_t *seen;            /* patches in view, farthest first */
    size_t seen_count, seen_capacity;
    struct wd_buffer near;     /* float[2] by layer + 1: see patch_card.vert */
    float (*host_near)[2];
    struct wd_instance *sorted; /* scratch of the exact order */
    uint32_t *listed;
    struct wd_selection meshes;
    void *shadows; /* state of `octree`, which draws them */
    uint64_t frame;
};

/* --- pipelines --------------------------------------------------------------------------- */

static bool init_pipeline(struct wd_pipeline *pipeline, struct wd_gpu *gpu,
                          struct wd_graphics_params *params)
{
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const VkDescriptorType image = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    params->vertex = (struct wd_spirv)WD_SPIRV(patch_card_vert);
    params->bindings = (struct wd_bindings){
        BINDINGS,
        {uniform, buffer, buffer, buffer, image, image, buffer, image, image, buffer, buffer,
         image, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER}};
    params->push_size = sizeof(struct wd_patch_push);
    params->depth_format = WD_DEPTH_FORMAT;
    params->topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    return wd_pipeline_init_graphics(pipeline, gpu, params);
}

static bool patch_init(void *state, struct wd_gpu *gpu)
{
    struct patch_state *patch = state;
    struct wd_graphics_params blend = {.fragment = WD_SPIRV(patch_blend_frag),
                                       .color_count = 1,
                                       .color_formats = {WD_OVERLAY_FORMAT},
                                       .blend = WD_BLEND_PREMULTIPLIED,
                                       .depth_read_only = true};
    struct wd_graphics_params layers = {
        .fragment = WD_SPIRV(tree_card_frag),
        .color_count = 3,
        .color_formats = {WD_ALBEDO_FORMAT, WD_NORMAL_FORMAT, WD_SURFACE_FORMAT}};
    patch->shadows = wd_method_borrow(&wd_method_octree, gpu);
    return patch->shadows && init_pipeline(&patch->blend, gpu, &blend) &&
           init_pipeline(&patch->layers, gpu, &layers);
}

static void patch_finish(void *state, struct wd_gpu *gpu)
{
    struct patch_state *patch = state;
    wd_method_give_back(&wd_method_octree, &patch->shadows, gpu);
}

/* --- the forest -------------------------------------------------------------------------- */

/* A cell holds one plant of the densest layer, as in the sample; without grids, one tree in the
 * mean. */
static double cell_size(const struct wd_forest_device *forest)
{
    const struct wd_scene *scene = forest->scene;
    double cell_m = scene->methods.patch.cell_m;
    if (cell_m > 0.0)
        return cell_m;
    for (size_t i = 0; i < scene->layer_count; i++) {
        double spacing_m = scene->layers[i].spacing_m;
        if (scene->layers[i].placement == WD_PLACE_GRID && (cell_m == 0.0 || spacing_m < cell_m))
            cell_m = spacing_m;
    }
    return cell_m > 0.0 ? cell_m : wd_cells_size(forest->world, 1.0);
}

/* Where billboards begin, by layer: a layer's own mesh distance goes before the method's. */
static bool make_near(struct patch_state *patch, struct wd_gpu *gpu,
                      const struct wd_forest_device *forest)
{
    const struct wd_patch_options *options = &forest->scene->methods.patch;
    size_t count = forest->scene->layer_count + 1;
    float (*near)[2] = wd_alloc_array(count, sizeof *near);
    for (size_t i = 0; i < count; i++) {
        double own = i ? forest->scene->layers[i - 1].mesh_distance_m : 0.0;
        double end = own > 0.0 ? own : options->near_end_m;
        near[i][0] = (float)(end * options->near_begin_m / fmax(options->near_end_m, 1e-6));
        near[i][1] = (float)end;
    }
    patch->host_near = near;
    const struct wd_buffer_params params = {"near fades", count * sizeof *near,
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    return wd_buffer_init(&patch->near, gpu, &params) &&
           wd_buffer_upload(gpu, &patch->near, 0, near, params.size);
}

static bool patch_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    struct patch_state *patch = state;
    const struct wd_world *world = forest->world;
    if (!world->tree_count)
        return true;
    patch->cells = (uint32_t)forest->scene->methods.patch.cells;
    patch->cell_m = cell_size(forest);
    wd_cells_init(&patch->patches, world, patch->cell_m * patch->cells);
    patch->cell_m = patch->patches.cell_m / patch->cells;
    patch->resident = wd_alloc_array((size_t)patch->patches.columns * patch->patches.rows,
                                     sizeof *patch->resident);
    return make_near(patch, gpu, forest);
}

static void patch_drop_forest(void *state, struct wd_gpu *gpu)
{
    struct patch_state *patch = state;
    size_t count = (size_t)patch->patches.columns * patch->patches.rows;
    for (size_t i = 0; i < count; i++)
        wd_buffer_finish(&patch->resident[i].table, gpu);
    free(patch->resident);
    free(patch->seen);
    free(patch->host_near);
    free(patch->sorted);
    free(patch->listed);
    wd_buffer_finish(&patch->near, gpu);
    wd_cells_finish(&patch->patches);
    wd_selection_finish(&patch->meshes);
    struct wd_pipeline blend = patch->blend, layers = patch->layers;
    void *shadows = patch->shadows;
    *patch = (struct patch_state){.blend = blend, .layers = layers, .shadows = shadows};
}

/* --- population on demand ---------------------------------------------------------------- */

static uint32_t cell_of(const struct patch_state *patch, uint32_t index, const struct wd_tree *tree,
                        bool by_columns)
{
    double corner[2] = {
        patch->patches.min_m[0] + index % patch->patches.columns * patch->patches.cell_m,
        patch->patches.min_m[1] + index / patch->patches.columns * patch->patches.cell_m};
    double last = patch->cells - 1;
    double column = fmin(fmax((tree->x_mm * 0.001 - corner[0]) / patch->cell_m, 0.0), last);
    double row = fmin(fmax((tree->y_mm * 0.001 - corner[1]) / patch->cell_m, 0.0), last);
    return by_columns ? (uint32_t)column * patch->cells + (uint32_t)row
                      : (uint32_t)row * patch->cells + (uint32_t)column;
}

/* Words of half a table: first[cells * cells + 1], then the trees. */
static size_t half_words(const struct patch_state *patch, uint32_t index)
{
    uint32_t trees = patch->patches.first[index + 1] - patch->patches.first[index];
    return (size_t)patch->cells * patch->cells + 1 + trees;
}

static void fill_half(uint32_t *table, const struct patch_state *patch, uint32_t index,
                      const struct wd_world *world, bool by_columns)
{
    const uint32_t *trees = patch->patches.trees + patch->patches.first[index];
    uint32_t count = patch->patches.first[index + 1] - patch->patches.first[index];
    uint32_t cells = patch->cells * patch->cells;
    uint32_t *next = wd_alloc_array(cells, sizeof *next);
    for (uint32_t i = 0; i < count; i++)
        table[cell_of(patch, index, &world->trees[trees[i]], by_columns) + 1]++;
    for (uint32_t i = 0; i < cells; i++) {
        next[i] = table[i];
        table[i + 1] += table[i];
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t cell = cell_of(patch, index, &world->trees[trees[i]], by_columns);
        table[cells + 1 + next[cell]++] = trees[i];
    }
    free(next);
}

static void populate(struct patch_state *patch, const struct wd_tree_draw *draw, uint32_t index)
{
    struct resident *resident = &patch->resident[index];
    size_t words = half_words(patch, index);
    const struct wd_buffer_params params = {"patch", 2 * words * sizeof(uint32_t),
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    uint32_t *table = wd_alloc_array(2 * words, sizeof *table);
    fill_half(table, patch, index, draw->forest->world, false);
    fill_half(table + words, patch, index, draw->forest->world, true);
    bool ok = wd_buffer_init(&resident->table, draw->cmd->gpu, &params) &&
              wd_buffer_upload(draw->cmd->gpu, &resident->table, 0, table, params.size);
    free(table);
    if (ok) {
        patch->resident_count++;
    } else {
        wd_buffer_finish(&resident->table, draw->cmd->gpu);
        draw->cmd->failed = true;
    }
}

/* Drops the patch that has not been drawn for longest, unless it is in use now. */
static bool evict(struct patch_state *patch, struct wd_cmd *cmd)
{
    size_t count = (size_t)patch->patches.columns * patch->patches.rows;
    struct resident *oldest = NULL;
    for (size_t i = 0; i < count; i++) {
        struct resident *at = &patch->resident[i];
        if (at->table.buffer && at->used < patch->frame && (!oldest || at->used < oldest->used))
            oldest = at;
    }
    if (!oldest)
        return false;
    wd_cmd_defer_buffer(cmd, &oldest->table);
    patch->resident_count--;
    return true;
}

/* --- choosing ---------------------------------------------------------------------------- */

static uint32_t before(double eye, double begin, double cell, uint32_t count)
{
    return (uint32_t)fmin(fmax(floor((eye - begin) / cell), 0.0), count);
}

static struct wd_patch_order order_of(const struct patch_state *patch, const struct wd_view *view)
{
    const struct wd_cells *patches = &patch->patches;
    return (struct wd_patch_order){
        .columns = patches->columns,
        .rows = patches->rows,
        .before_column =
            before(view->eye_m[0], patches->min_m[0], patches->cell_m, patches->columns),
        .before_row = before(view->eye_m[1], patches->min_m[1], patches->cell_m, patches->rows),
        .by_columns = fabsf(view->clip_from_rel[0][3]) > fabsf(view->clip_from_rel[1][3]), /* looks more east or west */
    };
}

static enum wd_side patch_side(const struct patch_state *patch, const struct wd_view *view,
                               uint32_t index, float *distance_m)
{
    const struct wd_cell_box *box = &patch->patches.boxes[index];
    float min[3], max[3], squared = 0.0f;
    if (patch->patches.first[index] == patch->patches.first[index + 1])
        return WD_OUTSIDE;
    for (int k = 0; k < 3; k++) {
        min[k] = (float)((double)box->min_m[k] - view->eye_m[k]);
        max[k] = (float)((double)box->max_m[k] - view->eye_m[k]);
        float outside = fmaxf(fmaxf(min[k], -max[k]), 0.0f);
        squared += outside * outside;
    }
    *distance_m = sqrtf(squared);
    return wd_frustum_box(&view->frustum, min, max);
}

/* Factor on the distances where billboards begin. */
static float near_scale(const struct wd_tree_draw *draw)
{
    return draw->forest->scene->methods.patch.faithful ? 1.0f : draw->view->lod_scale;
}

/* Meshes of the trees near the eye; billboards take over where they end. */
static void add_meshes(struct patch_state *patch, const struct wd_tree_draw *draw, uint32_t index)
{
    const struct wd_forest_device *forest = draw->forest;
    struct wd_level_rule rule = wd_level_rule_of(forest, draw->view, draw->pass);
    float full_m = rule.mesh_m;
    rule.plain = true;
    for (uint32_t i = patch->patches.first[index]; i < patch->patches.first[index + 1]; i++) {
        uint32_t tree = patch->patches.trees[i];
        float end_m = near_scale(draw) * patch->host_near[wd_forest_fade_of(forest, tree)][1];
        rule.mesh_m = fminf(full_m, end_m);
        rule.reduced_m = end_m;
        wd_selection_add_tree(&patch->meshes, forest, draw->view, &rule, tree);
    }
    patch->meshes.card_count = 0;
}

/* The widest blend, which scenes may ask for (quality.blend), ends before so many times its begin. */
static const float MOST_BLEND = 1.9f;

static float farthest_mesh(const struct patch_state *patch, const struct wd_forest_device *forest)
{
    float farthest_m = 0.0f;
    for (size_t i = 0; i <= forest->scene->layer_count; i++)
        farthest_m = fmaxf(farthest_m, patch->host_near[i][1]);
    return farthest_m * MOST_BLEND;
}

static void patch_select(void *state, const struct wd_tree_draw *draw)
{
    struct patch_state *patch = state;
    if (draw->pass == WD_PASS_SHADOW) {
        wd_method_octree.select(patch->shadows, draw);
        return;
    }
    const struct wd_patch_order order = order_of(patch, draw->view);
    const uint32_t capacity = (uint32_t)draw->forest->scene->methods.patch.resident_patches;
    float meshes_m = near_scale(draw) * farthest_mesh(patch, draw->forest);
    patch->frame++;
    patch->seen_count = 0;
    wd_selection_clear(&patch->meshes);
    for (uint32_t i = 0; i < order.columns * order.rows; i++) {
        uint32_t index = wd_patch_cell(order, i);
        float distance_m;
        if (patch_side(patch, draw->view, index, &distance_m) == WD_OUTSIDE)
            continue;
        *wd_push(patch->seen, patch->seen_count, patch->seen_capacity) = index;
        patch->resident[index].used = patch->frame;
        if (distance_m < meshes_m)
            add_meshes(patch, draw, index);
    }
    for (size_t i = 0; i < patch->seen_count; i++) {
        struct wd_buffer *table = &patch->resident[patch->seen[i]].table;
        while (!table->buffer && patch->resident_count >= capacity && evict(patch, draw->cmd)) {
        }
        if (!table->buffer)
            populate(patch, draw, patch->seen[i]);
        if (table->buffer)
            wd_cmd_use_buffer(draw->cmd, table, WD_USE_SHADER_READ);
    }
    wd_cmd_use_buffer(draw->cmd, &patch->near, WD_USE_SHADER_READ);
}

/* --- drawing ----------------------------------------------------------------------------- */

/* What the draws of one view share. */
struct drawing {
    struct patch_state *patch;
    const struct wd_tree_draw *draw;
    const struct wd_light_inputs *light; /* NULL: into the G-buffer */
    const struct wd_pipeline *pipeline;
    struct wd_patch_push push;
    bool by_columns;
};

static void draw_quads(const struct drawing *d, struct wd_binding table, uint32_t quads)
{
    const struct wd_forest_device *forest = d->draw->forest;
    struct wd_binding card = WD_BIND_IMAGE(&forest->card_albedo, forest->card_sampler);
    const struct wd_binding bindings[BINDINGS] = {
        d->draw->uniforms,
        WD_BIND_BUFFER(&forest->trees),
        WD_BIND_BUFFER(&forest->models),
        table,
        card,
        WD_BIND_IMAGE(&forest->card_normal, forest->point_sampler),
        WD_BIND_BUFFER(&forest->fades),
        WD_BIND_IMAGE(&forest->card_leaf, forest->point_sampler),
        d->light ? d->light->shadow_map : card,
        d->light ? d->light->sun_heights : WD_BIND_BUFFER(&forest->fades),
        WD_BIND_BUFFER(&d->patch->near),
        d->light ? d->light->canopy_light : card,
        WD_BIND_BUFFER(&forest->lit_models),
    };
    struct wd_cmd *cmd = d->draw->cmd;
    wd_cmd_bind(cmd, d->pipeline, bindings);
    wd_cmd_push(cmd, d->pipeline, &d->push, sizeof d->push);
    wd_tree_draw_quads(d->draw, quads);
}

static void draw_patch(struct drawing *d, uint32_t index)
{
    const struct patch_state *patch = d->patch;
    const struct wd_cells *patches = &patch->patches;
    const double *eye_m = d->draw->view->eye_m;
    double x_m = patches->min_m[0] + index % patches->columns * patches->cell_m;
    double y_m = patches->min_m[1] + index / patches->columns * patches->cell_m;
    uint32_t column = before(eye_m[0], x_m, patch->cell_m, patch->cells);
    uint32_t row = before(eye_m[1], y_m, patch->cell_m, patch->cells);
    uint32_t trees = patches->first[index + 1] - patches->first[index];
    d->push.cells = patch->cells;
    d->push.before_line = d->by_columns ? column : row;
    d->push.before_cell = d->by_columns ? row : column;
    d->push.table = d->by_columns ? (uint32_t)half_words(patch, index) : 0;
    draw_quads(d, WD_BIND_BUFFER(&patch->resident[index].table), trees);
    d->draw->stats->trees[WD_LEVEL_CARD] += trees;
}

/* Farther first; `show` holds the distance here. */
static int farther_first(const void *a, const void *b)
{
    const struct wd_instance *one = a, *other = b;
    if (one->show != other->show)
        return one->show > other->show ? -1 : 1;
    return one->tree < other->tree ? -1 : 1;
}

/* The order that arithmetic comes near to: every tree in view sorted by its own distance. */
static void draw_sorted(struct drawing *d)
{
    struct patch_state *patch = d->patch;
    const struct wd_world *world = d->draw->forest->world;
    const double *eye_m = d->draw->view->eye_m;
    uint32_t count = 0;
    if (!patch->sorted) {
        patch->sorted = wd_alloc_array(world->tree_count, sizeof *patch->sorted);
        patch->listed = wd_alloc_array(world->tree_count, sizeof *patch->listed);
    }
    for (size_t i = 0; i < patch->seen_count; i++) {
        uint32_t index = patch->seen[i];
        for (uint32_t k = patch->patches.first[index]; k < patch->patches.first[index + 1]; k++) {
            uint32_t tree = patch->patches.trees[k];
            double x = world->trees[tree].x_mm * 0.001 - eye_m[0];
            double y = world->trees[tree].y_mm * 0.001 - eye_m[1];
            patch->sorted[count++] = (struct wd_instance){tree, (float)(x * x + y * y)};
        }
    }
    if (!count)
        return;
    qsort(patch->sorted, count, sizeof *patch->sorted, farther_first);
    struct wd_binding table;
    uint32_t *memory = wd_cmd_upload(d->draw->cmd, count * sizeof *memory, &table);
    if (!memory)
        return;
    for (uint32_t i = 0; i < count; i++)
        memory[i] = patch->sorted[i].tree;
    d->push.cells = 0;
    draw_quads(d, table, count);
    d->draw->stats->trees[WD_LEVEL_CARD] += count;
}

static void draw_billboards(struct patch_state *patch, const struct wd_tree_draw *draw,
                            const struct wd_light_inputs *light)
{
    const struct wd_patch_options *options = &draw->forest->scene->methods.patch;
    struct drawing drawing = {
        .patch = patch,
        .draw = draw,
        .light = light,
        .pipeline = light ? &patch->blend : &patch->layers,
        .push = {.whole_fades = options->faithful,
                 .pixels_per_radian = draw->view->pixels_per_radian,
                 .near_scale = near_scale(draw)},
        .by_columns = order_of(patch, draw->view).by_columns,
    };
    if (light)
        drawing.push.light = light->push;
    drawing.push.light.variants = draw->forest->variants;
    if (options->order == WD_PATCH_EXACT) {
        draw_sorted(&drawing);
        return;
    }
    for (size_t i = 0; i < patch->seen_count; i++)
        draw_patch(&drawing, patch->seen[i]);
}

static void patch_draw(void *state, const struct wd_tree_draw *draw)
{
    struct patch_state *patch = state;
    if (draw->pass == WD_PASS_SHADOW) {
        wd_method_octree.draw(patch->shadows, draw);
        return;
    }
    wd_tree_draw_selection(draw, &patch->meshes, WD_DRAW_GROUPED);
    if (draw->view_mode != WD_MODE_LIT)
        draw_billboards(patch, draw, NULL);
}

static void patch_blend(void *state, const struct wd_tree_draw *draw,
                        const struct wd_light_inputs *light)
{
    struct patch_state *patch = state;
    const struct wd_rendering rendering = {
        .width = draw->targets->width,
        .height = draw->targets->height,
        .color_count = 1,
        .color = {{.image = &draw->targets->overlay, .load = WD_LOAD_CLEAR}},
        .depth = &draw->targets->depth,
        .depth_load = WD_LOAD_KEEP,
    };
    wd_cmd_begin_rendering(draw->cmd, &rendering);
    draw_billboards(patch, draw, light);
    wd_cmd_end_rendering(draw->cmd);
}

static void patch_draw_layers(void *state, const struct wd_tree_draw *draw)
{
    draw_billboards(state, draw, NULL);
}

const struct wd_method wd_method_patch = {
    .name = "patch",
    .cards = true,
    .state_size = sizeof(struct patch_state),
    .init = patch_init,
    .finish = patch_finish,
    .use_forest = patch_use_forest,
    .drop_forest = patch_drop_forest,
    .select = patch_select,
    .draw = patch_draw,
    .blend = patch_blend,
    .draw_layers = patch_draw_layers,
};
