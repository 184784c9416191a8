#include "forest/octant_colors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "forest/octant_pictures.h"
#include "shared/tree_pose.h"

enum { MAX_PIXELS = 64, MAX_TILE = 2048 };
static const float LEAST_ALPHA = 0.02f;

static bool check(const struct wd_octant_bake_params *params, uint32_t pixels, uint32_t cells)
{
    if (pixels > MAX_PIXELS)
        return wd_error(params->log, "octants: pictures of %u pixels; allowed are 1 to %d", pixels,
                        MAX_PIXELS);
    if (cells > WD_CLUSTER_SIZE_MAX)
        return wd_error(params->log, "octants: clusters of %u cells a side; allowed are 2 to %d",
                        cells, WD_CLUSTER_SIZE_MAX);
    if (pixels * cells > MAX_TILE)
        return wd_error(params->log, "octants: %u cells of %u pixels; %u pixels are possible",
                        cells, pixels, MAX_TILE);
    return true;
}

/* --- octants ----------------------------------------------------------------------------- */

static void take_octant(void *user, uint32_t owner, const struct wd_octant_picture *picture,
                        const struct wd_octant_mean *means)
{
    struct wd_octant_look *look = (struct wd_octant_look *)user + owner;
    wd_octant_mean_pack(means, look, picture->side);
}

/* Puts `below`, of which `share` of the side is seen, under what is there. */
static void add_below(struct wd_octant_mean *sum, const struct wd_octant_mean *below, float share)
{
    for (int k = 0; k < 3; k++) {
        sum->color[k] += share * below->color[k];
        sum->normal[k] += share * below->normal[k];
    }
    for (int k = 0; k < WD_MIXED_KINDS; k++)
        sum->leaves[k] += share * below->leaves[k];
    sum->openness += share * below->openness;
    sum->leaf += share * below->leaf;
    sum->coverage += share * below->coverage;
}

/* Which of a parent's eight parts a child fills: bit k is set in the upper half along axis k. */
static uint32_t part_of(const struct wd_octant *parent, const struct wd_octant *child)
{
    uint32_t part = 0;
    for (uint32_t k = 0; k < 3; k++)
        part |= (uint32_t)(child->cube_min_m[k] > parent->cube_min_m[k] +
                                                      0.25f * parent->cube_size_m) << k;
    return part;
}

/* What a side of the children shows: four columns of a near and a far part, or the plain mean. */
static struct wd_octant_mean side_of_children(const struct wd_octant_look *const parts[8],
                                              uint32_t side, enum wd_octant_average average)
{
    struct wd_octant_mean sum = {0};
    uint32_t axis = side / 2, near_bit = side % 2 == 0 ? 1u << axis : 0;
    for (uint32_t part = 0; part < 8; part++) {
        if (!parts[part])
            continue;
        struct wd_octant_mean mean = wd_octant_mean_of(parts[part], side);
        const struct wd_octant_look *front = parts[part ^ 1u << axis];
        float seen = 0.25f;
        if (average == WD_OCTANT_PLAIN)
            seen = 0.125f;
        else if ((part & 1u << axis) != near_bit && front)
            seen *= 1.0f - wd_octant_coverage(front->color[side]);
        add_below(&sum, &mean, seen);
    }
    return sum;
}

/* Children come after their parents: from the last to the first, each is whole when it is used. */
static void add_children(struct wd_octant_look *looks, const struct wd_octree *octree,
                         enum wd_octant_average average)
{
    for (uint32_t i = octree->count; i-- > 0;) {
        const struct wd_octant *octant = &octree->octants[i];
        const struct wd_octant_look *parts[8] = {NULL};
        uint32_t child = octant->first_child;
        for (uint32_t k = 0; k < octant->child_count; k++) {
            parts[part_of(octant, &octree->octants[child])] = &looks[child];
            child = octree->octants[child].next_sibling;
        }
        for (uint32_t side = 0; side < WD_OCTANT_SIDES && octant->child_count; side++) {
            struct wd_octant_mean own = wd_octant_mean_of(&looks[i], side);
            struct wd_octant_mean below = side_of_children(parts, side, average);
            struct wd_octant_mean both = {0};
            /* trees of both levels stand among each other: each hides half of where they cross */
            add_below(&both, &own, 1.0f - 0.5f * below.coverage);
            add_below(&both, &below, 1.0f - 0.5f * own.coverage);
            wd_octant_mean_pack(&both, &looks[i], side);
        }
    }
}

/* Of trees: their slant by what they cover, summed. */
struct slant {
    float sum, weight;
};

static struct slant slant_of(const struct wd_forest_device *forest, uint32_t tree)
{
    const struct wd_tree *t = &forest->world->trees[tree];
    const struct wd_model *model = &forest->host_models[wd_forest_model_of(forest, t)];
    float across = WD_TREE_CROWN_M(*t) / model->crown_m;
    float up = WD_TREE_HEIGHT_M(*t) / model->height_m;
    float level = wd_tree_seen_m2(*model, across, up, 0.0f);
    float above = wd_tree_seen_m2(*model, across, up, 1.0f);
    return (struct slant){wd_tree_seen_m2(*model, across, up, 0.70710678f),
                          sqrtf(0.5f * (level * level + above * above))};
}

static void pack_slant(struct wd_octant_look *look, struct slant slant)
{
    float byte = slant.weight > 0 ? 128.0f * slant.sum / slant.weight + 0.5f : 128.0f;
    look->leaf[1] = (look->leaf[1] & 0xffffu) | (uint32_t)fminf(byte, 255.0f) << 16;
}

/* Children come after their parents, whose trees are theirs as well. */
static void add_slants(struct wd_octant_look *looks, const struct wd_forest_device *forest)
{
    const struct wd_octree *octree = &forest->world->octree;
    struct slant *slants = wd_alloc_array(octree->count, sizeof *slants);
    for (uint32_t i = octree->count; i-- > 0;) {
        const struct wd_octant *octant = &octree->octants[i];
        uint32_t child = octant->first_child;
        for (uint32_t k = octant->tight_begin; k < octant->tight_end; k++) {
            struct slant tree = slant_of(forest, octree->tight_trees[k]);
            slants[i].sum += tree.sum;
            slants[i].weight += tree.weight;
        }
        for (uint32_t k = 0; k < octant->child_count; k++) {
            slants[i].sum += slants[child].sum;
            slants[i].weight += slants[child].weight;
            child = octree->octants[child].next_sibling;
        }
        pack_slant(&looks[i], slants[i]);
    }
    free(slants);
}

static struct wd_octant_cube cube_of(const struct wd_octree *octree, uint32_t octant,
                                     uint32_t owner)
{
    struct wd_octant_cube cube = {.size_m = octree->octants[octant].cube_size_m, .owner = owner};
    memcpy(cube.min_m, octree->octants[octant].cube_min_m, sizeof cube.min_m);
    return cube;
}

static bool render_octants(struct wd_octant_pictures *pictures,
                           const struct wd_octant_bake_params *params)
{
    const struct wd_octree *octree = &pictures->forest->world->octree;
    for (uint32_t i = 0; i < octree->count; i++) {
        const struct wd_octant *octant = &octree->octants[i];
        const struct wd_octant_cube cube = cube_of(octree, i, i);
        if (!wd_progress_report(params->progress, "baking octants", i, octree->count) ||
            !wd_octant_pictures_add(pictures, &cube, octree->tight_trees + octant->tight_begin,
                                    octant->tight_end - octant->tight_begin))
            return false;
    }
    return wd_octant_pictures_flush(pictures);
}

bool wd_octant_colors_bake(struct wd_octant_colors *colors, struct wd_gpu *gpu,
                           struct wd_forest_device *forest,
                           const struct wd_octant_bake_params *params)
{
    double start = wd_clock_s();
    const struct wd_octree *octree = &forest->world->octree;
    *colors = (struct wd_octant_colors){.count = octree->count};
    if (!check(params, params->pixels, 1))
        return false;
    colors->looks = wd_alloc_array(octree->count, sizeof *colors->looks);
    struct wd_octant_pictures pictures = {
        .cells = 1,
        .pixels = params->pixels ? params->pixels : WD_OCTANT_PIXELS,
        .take = take_octant,
        .user = colors->looks,
    };
    bool ok = octree->count == 0 || (wd_octant_pictures_init(&pictures, gpu, forest) &&
                                     render_octants(&pictures, params));
    colors->renders = pictures.renders;
    wd_octant_pictures_finish(&pictures);
    if (!ok) {
        wd_octant_colors_finish(colors);
        return false;
    }
    add_children(colors->looks, octree, params->average);
    add_slants(colors->looks, forest);
    colors->bytes = octree->count * sizeof *colors->looks;
    colors->baked_us = (uint64_t)((wd_clock_s() - start) * 1e6);
    return true;
}

void wd_octant_colors_finish(struct wd_octant_colors *colors)
{
    free(colors->looks);
    *colors = (struct wd_octant_colors){0};
}

/* --- clusters ---------------------------------------------------------------------------- */

/* The cluster that is being filled; pictures come in the order in which they were asked for. */
struct filling {
    struct wd_octant_clusters *clusters;
    struct wd_octant_look *grid; /* cells^3 */
    size_t cell_capacity;
    uint32_t octant, least_alpha;
};

/* Keeps what shows something, and clears the grid for the next. */
static void close_cluster(struct filling *f)
{
    struct wd_octant_clusters *clusters = f->clusters;
    uint32_t c = clusters->cluster_size;
    size_t count = clusters->cell_count;
    for (uint32_t i = 0; i < c * c * c; i++) {
        bool shows = false;
        for (int side = 0; side < WD_OCTANT_SIDES; side++)
            shows |= f->grid[i].color[side] >> 24 >= f->least_alpha;
        pack_slant(&f->grid[i], (struct slant){0});
        if (shows)
            *wd_push(clusters->cells, count, f->cell_capacity) = (struct wd_cluster_cell){
                i % c | i / c % c << 8 | i / (c * c) << 16, f->grid[i]};
    }
    clusters->cell_count = (uint32_t)count;
    clusters->first_cell[f->octant + 1] = clusters->cell_count;
    memset(f->grid, 0, (size_t)c * c * c * sizeof *f->grid);
}

static void close_up_to(struct filling *f, uint32_t octant)
{
    for (; f->octant < octant; f->octant++)
        close_cluster(f);
}

/* Index of the cell that lies `steps` along the picture's right, up and toward; axes that run
 * against the world's count from its far end. */
static uint32_t cell_index(const struct wd_octant_frame *axes, const uint32_t steps[3], uint32_t c)
{
    const struct wd_vec3 directions[3] = {axes->right, axes->up, axes->toward};
    const uint32_t strides[3] = {1, c, c * c};
    uint32_t index = 0;
    for (int k = 0; k < 3; k++) {
        const float along[3] = {directions[k].x, directions[k].y, directions[k].z};
        for (int axis = 0; axis < 3; axis++) {
            if (along[axis] > 0.5f)
                index += strides[axis] * steps[k];
            else if (along[axis] < -0.5f)
                index += strides[axis] * (c - 1 - steps[k]);
        }
    }
    return index;
}

static void take_slice(void *user, uint32_t owner, const struct wd_octant_picture *picture,
                       const struct wd_octant_mean *means)
{
    struct filling *f = user;
    uint32_t c = f->clusters->cluster_size, side = picture->side;
    const struct wd_octant_frame axes = wd_octant_frame_of(side);
    close_up_to(f, owner);
    for (uint32_t i = 0; i < c * c; i++) {
        const uint32_t steps[3] = {i % c, c - 1 - i / c, picture->slice};
        struct wd_octant_look *look = &f->grid[cell_index(&axes, steps, c)];
        wd_octant_mean_pack(&means[i], look, side);
    }
}

static int compare_trees(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

struct tree_list {
    uint32_t *trees;
    size_t count, capacity;
};

static void add_tight(struct tree_list *list, const struct wd_octree *octree, uint32_t octant)
{
    const struct wd_octant *o = &octree->octants[octant];
    for (uint32_t i = o->tight_begin; i < o->tight_end; i++)
        *wd_push(list->trees, list->count, list->capacity) = octree->tight_trees[i];
}

static void add_subtree(struct tree_list *list, const struct wd_octree *octree, uint32_t octant)
{
    uint32_t child = octree->octants[octant].first_child;
    add_tight(list, octree, octant);
    for (uint32_t k = 0; k < octree->octants[octant].child_count; k++) {
        add_subtree(list, octree, child);
        child = octree->octants[child].next_sibling;
    }
}

/* Every tree that touches an octant's cube, once: of its subtree, and larger ones above it. */
static void gather(struct tree_list *list, const struct wd_octree *octree, const uint32_t *parents,
                   uint32_t octant)
{
    list->count = 0;
    add_subtree(list, octree, octant);
    while (octant) {
        octant = parents[octant];
        add_tight(list, octree, octant);
    }
    if (list->count)
        qsort(list->trees, list->count, sizeof *list->trees, compare_trees);
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++)
        if (kept == 0 || list->trees[kept - 1] != list->trees[i])
            list->trees[kept++] = list->trees[i];
    list->count = kept;
}

static uint32_t *parents_of(const struct wd_octree *octree)
{
    uint32_t *parents = wd_alloc_array(octree->count, sizeof *parents);
    for (uint32_t i = 0; i < octree->count; i++) {
        uint32_t child = octree->octants[i].first_child;
        for (uint32_t k = 0; k < octree->octants[i].child_count; k++) {
            parents[child] = i;
            child = octree->octants[child].next_sibling;
        }
    }
    return parents;
}

static bool render_clusters(struct wd_octant_pictures *pictures, const uint32_t *octants,
                            uint32_t count, const struct wd_octant_bake_params *params)
{
    const struct wd_octree *octree = &pictures->forest->world->octree;
    uint32_t *parents = parents_of(octree);
    struct tree_list list = {0};
    bool ok = true;
    for (uint32_t i = 0; i < count && ok; i++) {
        const struct wd_octant_cube cube = cube_of(octree, octants[i], i);
        gather(&list, octree, parents, octants[i]);
        ok = wd_progress_report(params->progress, "baking clusters", i, count) &&
             wd_octant_pictures_add(pictures, &cube, list.trees, list.count);
    }
    free(list.trees);
    free(parents);
    return ok && wd_octant_pictures_flush(pictures);
}

bool wd_octant_clusters_bake(struct wd_octant_clusters *clusters, struct wd_gpu *gpu,
                             struct wd_forest_device *forest, const uint32_t *octants,
                             uint32_t octant_count, const struct wd_octant_bake_params *params)
{
    double start = wd_clock_s();
    uint32_t c = params->cluster_size ? params->cluster_size : WD_CLUSTER_SIZE;
    uint32_t pixels = params->pixels ? params->pixels : WD_CLUSTER_PIXELS;
    float least = params->least_alpha > 0.0f ? params->least_alpha : LEAST_ALPHA;
    *clusters = (struct wd_octant_clusters){.octant_count = octant_count, .cluster_size = c};
    if (!check(params, pixels, c))
        return false;
    clusters->first_cell = wd_alloc_array((size_t)octant_count + 1, sizeof(uint32_t));
    struct filling filling = {
        .clusters = clusters,
        .grid = wd_alloc_array((size_t)c * c * c, sizeof *filling.grid),
        .least_alpha = (uint32_t)(sqrtf(fminf(least, 1.0f)) * 255.0f + 0.5f),
    };
    struct wd_octant_pictures pictures = {
        .cells = c, .pixels = pixels, .take = take_slice, .user = &filling};
    bool ok = octant_count == 0 ||
              (wd_octant_pictures_init(&pictures, gpu, forest) &&
               render_clusters(&pictures, octants, octant_count, params));
    if (ok)
        close_up_to(&filling, octant_count);
    clusters->renders = pictures.renders;
    clusters->bytes = clusters->cell_count * sizeof *clusters->cells;
    clusters->baked_us = (uint64_t)((wd_clock_s() - start) * 1e6);
    wd_octant_pictures_finish(&pictures);
    free(filling.grid);
    if (!ok)
        wd_octant_clusters_finish(clusters);
    return ok;
}

void wd_octant_clusters_finish(struct wd_octant_clusters *clusters)
{
    free(clusters->cells);
    free(clusters->first_cell);
    *clusters = (struct wd_octant_clusters){0};
}
