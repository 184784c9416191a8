/* Octant impostors (Guerrero 2006, section 2; rows G2 to G4): far off, an octant is a sprite or a
 * cube of six colours within its tight cube, or a cluster of such cells in one draw; nearer come
 * billboards, nearest meshes. An octant is replaced when it, or a cell of its cluster, covers less
 * of the screen than a threshold. */
#include "methods/method.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "forest/octant_colors.h"
#include "methods/cells.h"
#include "shared/impostor.h"

static const uint32_t impostor_vert[] =
#include "impostor.vert.inc"
    ;
static const uint32_t impostor_frag[] =
#include "impostor.frag.inc"
    ;

/* Octants with this many times the trees of the smallest cluster have none any more: their cells
 * would be larger than groups of trees. */
enum { CLUSTER_SPAN = 64, MOST_CLUSTERS = 512, NO_CLUSTER = UINT32_MAX };

/* A cluster: its cells, in the order of the trees that they are of. */
struct cluster {
    uint32_t first, count; /* in cell_trees */
    float cell_m;
};

/* One draw of cells. */
struct part {
    uint32_t first, count; /* impostors */
};

struct impostors {
    struct wd_pipeline pipeline;
    struct wd_buffer table;      /* struct wd_impostor[]: octants, then cells of clusters */
    struct cluster *clusters;    /* by chosen octant */
    uint32_t *cell_trees;        /* by cell of all clusters: the tree that it is of */
    uint32_t cells_first;        /* impostor of the first of these */
    uint32_t *cluster_of;        /* by octant: into clusters, or NO_CLUSTER */
    struct wd_selection selection;
    uint32_t *singles;           /* octants drawn as one impostor */
    size_t single_count, single_capacity;
    struct part *drawn;          /* of clusters */
    size_t drawn_count, drawn_capacity;
    void *shadows; /* state of `octree`, which draws them */
};

static bool impostor_init(void *state, struct wd_gpu *gpu)
{
    struct impostors *impostors = state;
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const struct wd_graphics_params params = {
        .vertex = WD_SPIRV(impostor_vert),
        .fragment = WD_SPIRV(impostor_frag),
        .bindings = {3, {uniform, buffer, buffer}},
        .push_size = sizeof(struct wd_impostor_push),
        .color_count = 3,
        .color_formats = {WD_ALBEDO_FORMAT, WD_NORMAL_FORMAT, WD_SURFACE_FORMAT},
        .depth_format = WD_DEPTH_FORMAT,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    impostors->shadows = wd_method_borrow(&wd_method_octree, gpu);
    return impostors->shadows && wd_pipeline_init_graphics(&impostors->pipeline, gpu, &params);
}

static void impostor_finish(void *state, struct wd_gpu *gpu)
{
    struct impostors *impostors = state;
    wd_method_give_back(&wd_method_octree, &impostors->shadows, gpu);
}

/* --- the forest -------------------------------------------------------------------------- */

static bool has_cluster(const struct wd_octant *octant, uint32_t least)
{
    uint32_t trees = octant->end - octant->begin;
    return trees >= least && trees / CLUSTER_SPAN < least;
}

/* Octants that get a cluster, in the octree's order. Making one takes some 30 ms of software
 * rendering: of a large forest only larger octants have them. */
static uint32_t choose_clusters(struct impostors *impostors, const struct wd_octree *octree,
                                const struct wd_impostor_options *options, uint32_t *chosen)
{
    uint32_t count, least = (uint32_t)options->cluster_trees;
    for (;; least *= 2) {
        count = 0;
        for (uint32_t i = 0; i < octree->count; i++)
            count += has_cluster(&octree->octants[i], least);
        if (count <= MOST_CLUSTERS)
            break;
    }
    count = 0;
    impostors->cluster_of = wd_alloc_array(octree->count, sizeof *impostors->cluster_of);
    for (uint32_t i = 0; i < octree->count; i++) {
        bool has = options->cluster_size > 1 && has_cluster(&octree->octants[i], least);
        impostors->cluster_of[i] = has ? count : NO_CLUSTER;
        if (has)
            chosen[count++] = i;
    }
    return count;
}

/* A place, and the octant's tree that is nearest to it by now. */
struct nearest {
    const struct wd_cells *cells;
    const struct wd_world *world;
    const struct wd_octant *octant;
    double x_m, y_m;
    uint32_t tree;
    double squared_m2; /* how far off that is; infinite: none has been found */
};

static void take_nearest(struct nearest *n, int column, int row)
{
    if (column < 0 || row < 0 || column >= (int)n->cells->columns || row >= (int)n->cells->rows)
        return;
    size_t cell = (size_t)row * n->cells->columns + (size_t)column;
    for (uint32_t k = n->cells->first[cell]; k < n->cells->first[cell + 1]; k++) {
        uint32_t index = n->cells->trees[k];
        if (index < n->octant->begin || index >= n->octant->end)
            continue;
        double x = n->world->trees[index].x_mm * 0.001 - n->x_m, y = n->world->trees[index].y_mm * 0.001 - n->y_m;
        if (x * x + y * y < n->squared_m2) {
            n->squared_m2 = x * x + y * y;
            n->tree = index;
        }
    }
}

/* The tree of an octant that a cell of a cluster is of: one whose foot is about as near to a place as any, from the
 * smallest square of cells about it that holds one; the octant's first where none is within reach. */
static uint32_t nearest_tree(const struct wd_cells *cells, const struct wd_world *world,
                             const struct wd_octant *octant, double x_m, double y_m)
{
    enum { FARTHEST = 64 }; /* cells */
    struct nearest nearest = {cells, world, octant, x_m, y_m, octant->begin, INFINITY};
    int column = (int)floor((x_m - cells->min_m[0]) / cells->cell_m);
    int row = (int)floor((y_m - cells->min_m[1]) / cells->cell_m);
    for (int reach = 0; reach < FARTHEST && nearest.squared_m2 == INFINITY; reach++)
        for (int j = row - reach; j <= row + reach; j++)
            for (int i = column - reach; i <= column + reach; i++)
                take_nearest(&nearest, i, j);
    return nearest.tree;
}

/* The tree of a tight octant's own or its descendants'; UINT32_MAX: none reaches into it. */
static uint32_t any_tree(const struct wd_octree *octree, uint32_t index)
{
    const struct wd_octant *octant = &octree->octants[index];
    if (octant->begin != octant->end)
        return octant->begin;
    if (octant->tight_begin != octant->tight_end)
        return octree->tight_trees[octant->tight_begin];
    return octant->child_count ? any_tree(octree, octant->first_child) : UINT32_MAX;
}

struct box {
    float min_m[3], max_m[3];
};

static const struct box NO_BOX = {{INFINITY, INFINITY, INFINITY},
                                  {-INFINITY, -INFINITY, -INFINITY}};

static void add_box(struct box *sum, const float min_m[3], const float max_m[3])
{
    for (int axis = 0; axis < 3; axis++) {
        sum->min_m[axis] = fminf(sum->min_m[axis], min_m[axis]);
        sum->max_m[axis] = fmaxf(sum->max_m[axis], max_m[axis]);
    }
}

/* A tree with all that reaches beyond the bounds by which octants hold it. */
static struct box whole_tree(const struct wd_forest_device *forest, uint32_t index)
{
    const struct wd_tree *tree = &forest->world->trees[index];
    const struct wd_model *model = &forest->host_models[wd_forest_model_of(forest, tree)];
    float more_m = WD_TREE_CROWN_M(*tree) * (model->half_depth_m / model->crown_m - 0.5f);
    struct box box;
    wd_tree_bounds(tree, box.min_m, box.max_m);
    for (int axis = 0; axis < 2; axis++) {
        box.min_m[axis] -= fmaxf(more_m, 0.0f);
        box.max_m[axis] += fmaxf(more_m, 0.0f);
    }
    return box;
}

/* As much of `box` as lies in a cube. */
static struct box within_cube(const struct box *box, const float cube_min_m[3], float cube_m)
{
    struct box part;
    for (int axis = 0; axis < 3; axis++) {
        float low = cube_min_m[axis], high = low + cube_m;
        part.min_m[axis] = fminf(fmaxf(box->min_m[axis], low), high);
        part.max_m[axis] = fmaxf(fminf(box->max_m[axis], high), part.min_m[axis]);
    }
    return part;
}

/* What trees fill of each octant's cube; children come after their parents. */
static struct box *filled_boxes(const struct wd_forest_device *forest)
{
    const struct wd_octree *octree = &forest->world->octree;
    struct box *boxes = wd_alloc_array(octree->count, sizeof *boxes);
    for (uint32_t i = octree->count; i-- > 0;) {
        const struct wd_octant *octant = &octree->octants[i];
        uint32_t child = octant->first_child;
        struct box box = NO_BOX;
        for (uint32_t k = octant->tight_begin; k < octant->tight_end; k++) {
            struct box tree = whole_tree(forest, octree->tight_trees[k]);
            add_box(&box, tree.min_m, tree.max_m);
        }
        for (uint32_t k = 0; k < octant->child_count; k++) {
            add_box(&box, boxes[child].min_m, boxes[child].max_m);
            child = octree->octants[child].next_sibling;
        }
        boxes[i] = within_cube(&box, octant->cube_min_m, octant->cube_size_m);
    }
    return boxes;
}

/* From shares of the cube's sides to shares of the box's. */
static void fit_look(struct wd_impostor *impostor, float cube_m)
{
    for (uint32_t side = 0; side < WD_OCTANT_SIDES; side++) {
        uint32_t axis = side / 2, color = impostor->look.color[side];
        float area = impostor->size_m[(axis + 1) % 3] * impostor->size_m[(axis + 2) % 3];
        float root = (float)(color >> 24) * cube_m / sqrtf(fmaxf(area, 1e-6f));
        impostor->look.color[side] = (color & 0xffffffu) | (uint32_t)fminf(root + 0.5f, 255.0f) << 24;
    }
}

static void fit_box(struct wd_impostor *impostor, const struct box *box, float cube_m)
{
    for (int axis = 0; axis < 3; axis++) {
        impostor->min_m[axis] = box->min_m[axis];
        impostor->size_m[axis] = box->max_m[axis] - box->min_m[axis];
    }
    fit_look(impostor, cube_m);
}

static void fill_octants(struct wd_impostor *table, const struct wd_forest_device *forest,
                         const struct wd_octant_colors *colors)
{
    const struct wd_octree *octree = &forest->world->octree;
    struct box *boxes = filled_boxes(forest);
    for (uint32_t i = 0; i < octree->count; i++) {
        const struct wd_octant *octant = &octree->octants[i];
        table[i] = (struct wd_impostor){
            .first_tree = any_tree(octree, i),
            .tree_count = octant->end - octant->begin,
            .look = colors->looks[i],
        };
        fit_box(&table[i], &boxes[i], octant->cube_size_m);
    }
    free(boxes);
}

/* By trees, so that an octant's cells are one range of its cluster's. */
static int by_tree(const void *a, const void *b)
{
    const struct wd_impostor *one = a, *other = b;
    if (one->first_tree != other->first_tree)
        return one->first_tree < other->first_tree ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        if (one->min_m[k] != other->min_m[k])
            return one->min_m[k] < other->min_m[k] ? -1 : 1;
    }
    return 0;
}

/* A cluster's cells, and boxes of all trees that reach into each; x runs fastest. */
struct grid {
    const struct wd_octant *octant;
    struct box *boxes; /* [size^3]: whole trees */
    uint32_t size;
    float cell_m;
};

/* The cell along an axis, the nearest where it is outside. */
static uint32_t cell_of(const struct grid *grid, int axis, float at_m)
{
    float cell = floorf((at_m - grid->octant->cube_min_m[axis]) / grid->cell_m);
    return (uint32_t)fminf(fmaxf(cell, 0.0f), (float)(grid->size - 1));
}

static struct box *box_of(const struct grid *grid, const uint32_t at[3])
{
    return &grid->boxes[(at[2] * grid->size + at[1]) * grid->size + at[0]];
}

static bool meets(const struct grid *grid, const float min_m[3], const float max_m[3])
{
    for (int axis = 0; axis < 3; axis++) {
        float low = grid->octant->cube_min_m[axis];
        if (min_m[axis] >= low + grid->octant->cube_size_m || max_m[axis] <= low)
            return false;
    }
    return true;
}

static void add_tree(struct grid *grid, const struct box *tree)
{
    uint32_t first[3], last[3], at[3];
    if (!meets(grid, tree->min_m, tree->max_m))
        return;
    for (int axis = 0; axis < 3; axis++) {
        first[axis] = cell_of(grid, axis, tree->min_m[axis]);
        last[axis] = cell_of(grid, axis, tree->max_m[axis]);
    }
    for (at[2] = first[2]; at[2] <= last[2]; at[2]++)
        for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
            for (at[0] = first[0]; at[0] <= last[0]; at[0]++)
                add_box(box_of(grid, at), tree->min_m, tree->max_m);
}

/* All trees that reach into the grid: of its octant's subtree, and larger ones above it. */
static void add_trees(struct grid *grid, const struct wd_forest_device *forest, uint32_t index)
{
    const struct wd_octree *octree = &forest->world->octree;
    const struct wd_octant *octant = &octree->octants[index];
    float max_m[3];
    for (int axis = 0; axis < 3; axis++)
        max_m[axis] = octant->cube_min_m[axis] + octant->cube_size_m;
    if (!meets(grid, octant->cube_min_m, max_m))
        return;
    for (uint32_t k = octant->tight_begin; k < octant->tight_end; k++) {
        struct box tree = whole_tree(forest, octree->tight_trees[k]);
        add_tree(grid, &tree);
    }
    uint32_t child = octant->first_child;
    for (uint32_t k = 0; k < octant->child_count; k++) {
        add_trees(grid, forest, child);
        child = octree->octants[child].next_sibling;
    }
}

/* `cells` of one cluster become impostors. */
static void fill_cluster(struct wd_impostor *table, const struct grid *grid,
                         const struct wd_cluster_cell *cells, uint32_t count,
                         const struct wd_cells *trees, const struct wd_world *world)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t at[3] = {cells[i].at & 0xffu, cells[i].at >> 8 & 0xffu,
                                cells[i].at >> 16 & 0xffu};
        float corner_m[3];
        for (int axis = 0; axis < 3; axis++)
            corner_m[axis] = grid->octant->cube_min_m[axis] + grid->cell_m * (float)at[axis];
        struct box box = within_cube(box_of(grid, at), corner_m, grid->cell_m);
        table[i] = (struct wd_impostor){.tree_count = 1, .look = cells[i].look};
        fit_box(&table[i], &box, grid->cell_m);
        table[i].first_tree = nearest_tree(trees, world, grid->octant,
                                           corner_m[0] + 0.5 * grid->cell_m,
                                           corner_m[1] + 0.5 * grid->cell_m);
    }
    qsort(table, count, sizeof *table, by_tree);
}

static struct grid grid_of(const struct wd_forest_device *forest, uint32_t octant, uint32_t size)
{
    struct grid grid = {.octant = &forest->world->octree.octants[octant], .size = size};
    uint32_t count = size * size * size;
    grid.cell_m = grid.octant->cube_size_m / (float)size;
    grid.boxes = wd_alloc_array(count, sizeof *grid.boxes);
    for (uint32_t i = 0; i < count; i++)
        grid.boxes[i] = NO_BOX;
    add_trees(&grid, forest, 0);
    return grid;
}

static void fill_clusters(struct impostors *impostors, struct wd_impostor *table, uint32_t first,
                          const struct wd_forest_device *forest, const uint32_t *chosen,
                          const struct wd_octant_clusters *clusters)
{
    const struct wd_world *world = forest->world;
    struct wd_cells trees;
    wd_cells_init(&trees, world, wd_cells_size(world, 1.0));
    impostors->cells_first = first;
    impostors->clusters = wd_alloc_array(clusters->octant_count, sizeof *impostors->clusters);
    impostors->cell_trees = wd_alloc_array(clusters->cell_count, sizeof *impostors->cell_trees);
    for (uint32_t i = 0; i < clusters->octant_count; i++) {
        struct grid grid = grid_of(forest, chosen[i], clusters->cluster_size);
        uint32_t begin = clusters->first_cell[i], end = clusters->first_cell[i + 1];
        impostors->clusters[i] = (struct cluster){begin, end - begin, grid.cell_m};
        fill_cluster(table + first + begin, &grid, clusters->cells + begin, end - begin, &trees,
                     world);
        free(grid.boxes);
    }
    for (uint32_t i = 0; i < clusters->cell_count; i++)
        impostors->cell_trees[i] = table[first + i].first_tree;
    wd_cells_finish(&trees);
}

static bool upload_table(struct impostors *impostors, struct wd_gpu *gpu,
                         const struct wd_impostor *table, size_t count)
{
    const struct wd_buffer_params params = {"impostors", count * sizeof *table,
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    uint32_t limit = gpu->properties.limits.maxStorageBufferRange;
    if (params.size > limit)
        return wd_error(gpu->log, "impostors: %zu MB are more than the %u MB that %s can bind at "
                                  "once: use smaller clusters or more trees a cluster",
                        (size_t)params.size >> 20, limit >> 20, gpu->properties.deviceName);
    return wd_buffer_init(&impostors->table, gpu, &params) &&
           wd_buffer_upload(gpu, &impostors->table, 0, table, params.size);
}

static bool impostor_use_forest(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest)
{
    struct impostors *impostors = state;
    const struct wd_octree *octree = &forest->world->octree;
    const struct wd_impostor_options *options = &forest->scene->methods.impostor;
    const struct wd_octant_bake_params params = {
        .cluster_size = (uint32_t)options->cluster_size,
        .least_alpha = (float)options->least_alpha,
        .average = options->faithful ? WD_OCTANT_PLAIN : WD_OCTANT_LAYERED,
        .progress = &forest->progress,
        .log = gpu->log,
    };
    struct wd_octant_colors colors = {0};
    struct wd_octant_clusters clusters = {0};
    if (!octree->count)
        return true;
    uint32_t *chosen = wd_alloc_array(octree->count, sizeof *chosen);
    uint32_t count = choose_clusters(impostors, octree, options, chosen);
    bool ok = wd_octant_colors_bake(&colors, gpu, forest, &params) &&
              (!count || wd_octant_clusters_bake(&clusters, gpu, forest, chosen, count, &params));
    if (ok) {
        size_t total = (size_t)octree->count + clusters.cell_count;
        struct wd_impostor *table = wd_alloc_array(total, sizeof *table);
        fill_octants(table, forest, &colors);
        if (count)
            fill_clusters(impostors, table, octree->count, forest, chosen, &clusters);
        ok = upload_table(impostors, gpu, table, total);
        free(table);
    }
    wd_octant_clusters_finish(&clusters);
    wd_octant_colors_finish(&colors);
    free(chosen);
    return ok;
}

static void impostor_drop_forest(void *state, struct wd_gpu *gpu)
{
    struct impostors *impostors = state;
    wd_buffer_finish(&impostors->table, gpu);
    wd_selection_finish(&impostors->selection);
    free(impostors->clusters);
    free(impostors->cell_trees);
    free(impostors->cluster_of);
    free(impostors->singles);
    free(impostors->drawn);
    struct wd_pipeline pipeline = impostors->pipeline;
    void *shadows = impostors->shadows;
    *impostors = (struct impostors){.pipeline = pipeline, .shadows = shadows};
}

/* --- choosing ---------------------------------------------------------------------------- */

struct visit {
    struct impostors *impostors;
    const struct wd_tree_draw *draw;
    struct wd_level_rule rule;
    float cards_m;   /* only billboards beyond */
    float area_px;
    bool whole;      /* a cluster shows or hides as a whole (--faithful) */
};

/* Cells of trees before this one, within a cluster. */
static uint32_t cells_before(const struct impostors *impostors, const struct cluster *cluster,
                             uint32_t tree)
{
    uint32_t low = cluster->first, high = cluster->first + cluster->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (impostors->cell_trees[middle] < tree)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool covers_less(const struct visit *v, float size_m, float distance_m)
{
    float side_px = size_m / distance_m * v->draw->view->pixels_per_radian;
    return side_px * side_px < v->area_px;
}

/* Draws an octant's part of a cluster where its cells are small enough. */
static bool draw_part(const struct visit *v, uint32_t cluster_index,
                      const struct wd_octant *octant, float distance_m)
{
    struct impostors *impostors = v->impostors;
    if (cluster_index == NO_CLUSTER ||
        !covers_less(v, impostors->clusters[cluster_index].cell_m, distance_m))
        return false;
    const struct cluster *cluster = &impostors->clusters[cluster_index];
    uint32_t first = cells_before(impostors, cluster, octant->begin);
    uint32_t end = cells_before(impostors, cluster, octant->end);
    if (first == end)
        return false; /* its trees are in its neighbours' cells */
    *wd_push(impostors->drawn, impostors->drawn_count, impostors->drawn_capacity) =
        (struct part){impostors->cells_first + first, end - first};
    return true;
}

/* `around`: the cluster of the least octant about this one that has one. */
static bool replace(const struct visit *v, uint32_t index, uint32_t around, float distance_m)
{
    struct impostors *impostors = v->impostors;
    const struct wd_octant *octant = &v->draw->forest->world->octree.octants[index];
    if (distance_m < v->cards_m)
        return false;
    if ((!v->whole && draw_part(v, around, octant, distance_m)) ||
        draw_part(v, impostors->cluster_of[index], octant, distance_m))
        return true;
    if (!covers_less(v, octant->cube_size_m, distance_m))
        return false;
    *wd_push(impostors->singles, impostors->single_count, impostors->single_capacity) = index;
    return true;
}

static void visit(const struct visit *v, uint32_t index, uint32_t around)
{
    const struct wd_octant *octants = v->draw->forest->world->octree.octants;
    const struct wd_octant *octant = &octants[index];
    const struct wd_view *view = v->draw->view;
    struct wd_selection *selection = &v->impostors->selection;
    float min[3], max[3], squared = 0.0f;
    bool empty = octant->begin == octant->end;
    if (empty && around != NO_CLUSTER)
        return; /* what reaches into it is in that cluster's cells */
    for (int k = 0; k < 3; k++) {
        float low = empty ? octant->cube_min_m[k] : octant->min_m[k];
        float high = empty ? low + octant->cube_size_m : octant->max_m[k];
        min[k] = (float)((double)low - view->eye_m[k]);
        max[k] = (float)((double)high - view->eye_m[k]);
        float outside = fmaxf(fmaxf(min[k], -max[k]), 0.0f);
        squared += outside * outside;
    }
    float distance_m = sqrtf(squared);
    if (wd_frustum_box(&view->frustum, min, max) == WD_OUTSIDE ||
        replace(v, index, around, distance_m))
        return;
    if (distance_m < v->cards_m) {
        for (uint32_t i = octant->begin; i < octant->own_end; i++)
            wd_selection_add_tree(selection, v->draw->forest, view, &v->rule, i);
    } else {
        wd_selection_add_range(selection, &(struct wd_range){octant->begin, octant->own_end,
                                                             WD_CARD_VERTICES});
    }
    uint32_t own = v->impostors->cluster_of[index];
    uint32_t child = octant->first_child;
    for (uint32_t i = 0; i < octant->child_count; i++, child = octants[child].next_sibling)
        visit(v, child, own == NO_CLUSTER ? around : own);
}

static void impostor_select(void *state, const struct wd_tree_draw *draw)
{
    struct impostors *impostors = state;
    const struct wd_impostor_options *options = &draw->forest->scene->methods.impostor;
    if (draw->pass == WD_PASS_SHADOW) {
        wd_method_octree.select(impostors->shadows, draw);
        return;
    }
    struct visit v = {
        .impostors = impostors,
        .draw = draw,
        .rule = wd_level_rule_of(draw->forest, draw->view, draw->pass),
        .area_px = (float)options->area_px,
        .whole = options->faithful,
    };
    v.cards_m = wd_level_card_distance(&v.rule, draw->forest->max_tree_height_m);
    wd_selection_clear(&impostors->selection);
    impostors->single_count = impostors->drawn_count = 0;
    visit(&v, 0, NO_CLUSTER);
    wd_cmd_use_buffer(draw->cmd, &impostors->table, WD_USE_SHADER_READ);
}

/* --- drawing ----------------------------------------------------------------------------- */

static void draw_impostors(const struct wd_tree_draw *draw, const struct wd_pipeline *pipeline,
                           struct wd_impostor_push *push, uint32_t first, uint32_t count)
{
    uint32_t vertices = push->cubes ? WD_CUBE_VERTICES : WD_SPRITE_VERTICES;
    uint32_t most = draw->forest->quads_a_draw * 4 / vertices;
    for (uint32_t at = 0; at < count; at += most) {
        uint32_t part = count - at < most ? count - at : most;
        push->first = first + at;
        wd_cmd_push(draw->cmd, pipeline, push, sizeof *push);
        wd_cmd_draw_indexed(
            draw->cmd,
            &(VkDrawIndexedIndirectCommand){part * vertices / 4 * 6, 1, 0,
                                            push->listed ? (int32_t)(at * vertices) : 0, 0});
        draw->stats->draw_calls++;
        draw->stats->triangles += (uint64_t)part * vertices / 2;
    }
}

static void impostor_draw(void *state, const struct wd_tree_draw *draw)
{
    struct impostors *impostors = state;
    const struct wd_impostor_options *options = &draw->forest->scene->methods.impostor;
    if (draw->pass == WD_PASS_SHADOW) {
        wd_method_octree.draw(impostors->shadows, draw);
        return;
    }
    wd_tree_draw_selection(draw, &impostors->selection, WD_DRAW_GROUPED);
    struct wd_binding list = WD_BIND_BUFFER(&impostors->table);
    uint32_t *memory = NULL;
    if (impostors->single_count) {
        memory = wd_cmd_upload(draw->cmd, impostors->single_count * sizeof *memory, &list);
        if (!memory)
            return;
        memcpy(memory, impostors->singles, impostors->single_count * sizeof *memory);
    }
    const struct wd_binding bindings[] = {draw->uniforms, WD_BIND_BUFFER(&impostors->table), list};
    struct wd_impostor_push push = {
        .cubes = options->shape == WD_IMPOSTOR_CUBE,
        .pixels_per_radian = draw->view->pixels_per_radian,
    };
    wd_cmd_bind(draw->cmd, &impostors->pipeline, bindings);
    wd_cmd_bind_indices(draw->cmd, &draw->forest->card_indices);
    for (size_t i = 0; i < impostors->drawn_count; i++)
        draw_impostors(draw, &impostors->pipeline, &push, impostors->drawn[i].first,
                       impostors->drawn[i].count);
    push.listed = 1;
    draw_impostors(draw, &impostors->pipeline, &push, 0, (uint32_t)impostors->single_count);
}

const struct wd_method wd_method_impostor = {
    .name = "impostor",
    .cards = true,
    .state_size = sizeof(struct impostors),
    .init = impostor_init,
    .finish = impostor_finish,
    .use_forest = impostor_use_forest,
    .drop_forest = impostor_drop_forest,
    .select = impostor_select,
    .draw = impostor_draw,
};
