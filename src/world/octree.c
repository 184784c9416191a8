/* octree.c: keys by octant path, radix sort, then one pass over the sorted keys. A key holds four
 * bits a level from the root: 1 + the octant's number, or 0 where the tree stays; so the sorted
 * order is depth-first and an octant's own trees come before those of its children. */
#include "world/octree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { MAX_DEPTH = 15, DEFAULT_DEPTH = 8, DEFAULT_LEAF_TREES = 64 };

struct box {
    int64_t min_mm[3], max_mm[3];
};

static struct box box_of(const struct wd_tree *tree)
{
    int64_t radius_mm = (int64_t)WD_TREE_CROWN_CM(*tree) * 5, height_mm = WD_TREE_HEIGHT_CM(*tree) * 10;
    return (struct box){
        .min_mm = {tree->x_mm - radius_mm, tree->y_mm - radius_mm, tree->z_mm},
        .max_mm = {tree->x_mm + radius_mm, tree->y_mm + radius_mm, tree->z_mm + height_mm},
    };
}

void wd_tree_bounds(const struct wd_tree *tree, float min_m[3], float max_m[3])
{
    struct box box = box_of(tree);
    for (int axis = 0; axis < 3; axis++) {
        min_m[axis] = (float)((double)box.min_mm[axis] * 0.001);
        max_m[axis] = (float)((double)box.max_mm[axis] * 0.001);
    }
}

/* The root cube: cells of the deepest level have whole millimetres. */
struct space {
    int64_t min_mm[3];
    int64_t cell_mm;
    uint32_t depth;
};

static struct space space_of(const struct wd_tree *trees, size_t count, uint32_t depth)
{
    struct box all = box_of(&trees[0]);
    for (size_t i = 1; i < count; i++) {
        struct box box = box_of(&trees[i]);
        for (int axis = 0; axis < 3; axis++) {
            if (box.min_mm[axis] < all.min_mm[axis])
                all.min_mm[axis] = box.min_mm[axis];
            if (box.max_mm[axis] > all.max_mm[axis])
                all.max_mm[axis] = box.max_mm[axis];
        }
    }
    struct space space = {.depth = depth};
    int64_t extent_mm = 0;
    for (int axis = 0; axis < 3; axis++) {
        space.min_mm[axis] = all.min_mm[axis];
        if (all.max_mm[axis] - all.min_mm[axis] > extent_mm)
            extent_mm = all.max_mm[axis] - all.min_mm[axis];
    }
    space.cell_mm = (extent_mm >> depth) + 1;
    return space;
}

/* An octant of a level by its position along each axis. */
struct address {
    uint32_t at[3];
    uint32_t depth;
};

static uint64_t key_of(const struct address *address)
{
    uint64_t key = 0;
    for (uint32_t level = 1; level <= MAX_DEPTH; level++) {
        uint64_t digit = 0;
        if (level <= address->depth) {
            uint32_t bit = address->depth - level;
            digit = 1 + ((address->at[0] >> bit & 1) | (address->at[1] >> bit & 1) << 1 |
                         (address->at[2] >> bit & 1) << 2);
        }
        key = key << 4 | digit;
    }
    return key;
}

static uint32_t digit_at(uint64_t key, uint32_t level)
{
    return (uint32_t)(key >> 4 * (MAX_DEPTH - level)) & 15;
}

static uint64_t key_cut(uint64_t key, uint32_t depth)
{
    return key & ~((UINT64_C(1) << 4 * (MAX_DEPTH - depth)) - 1);
}

/* The deepest octant that a tree fits in when its cube is doubled: the cube that holds the box's
 * centre, at the deepest level whose cubes are no smaller than the box. */
static struct address loose_address(const struct space *space, const struct wd_tree *tree)
{
    struct box box = box_of(tree);
    struct address address = {.depth = space->depth};
    int64_t extent_mm = 0;
    for (int axis = 0; axis < 3; axis++)
        if (box.max_mm[axis] - box.min_mm[axis] > extent_mm)
            extent_mm = box.max_mm[axis] - box.min_mm[axis];
    while (address.depth > 0 && space->cell_mm << (space->depth - address.depth) < extent_mm)
        address.depth--;
    int64_t size_mm = space->cell_mm << (space->depth - address.depth);
    for (int axis = 0; axis < 3; axis++) {
        int64_t centre_mm = (box.min_mm[axis] + box.max_mm[axis]) / 2 - space->min_mm[axis];
        int64_t at = centre_mm / size_mm;
        address.at[axis] = at > 0 ? (uint32_t)at : 0;
    }
    return address;
}

struct entry {
    uint64_t key;
    uint32_t tree;
};

/* Stable, so that trees of one octant keep their order. */
static void sort_entries(struct entry **entries, size_t count)
{
    struct entry *from = *entries, *to = wd_alloc_array(count, sizeof *to);
    for (unsigned shift = 0; shift < 64; shift += 8) {
        size_t starts[257] = {0};
        for (size_t i = 0; i < count; i++)
            starts[(from[i].key >> shift & 255) + 1]++;
        if (starts[(from[0].key >> shift & 255) + 1] == count)
            continue;
        for (unsigned i = 0; i < 256; i++)
            starts[i + 1] += starts[i];
        for (size_t i = 0; i < count; i++)
            to[starts[from[i].key >> shift & 255]++] = from[i];
        struct entry *swap = from;
        from = to;
        to = swap;
    }
    free(to);
    *entries = from;
}

/* Trees below an octant that has few of them move up into it. */
static void gather_leaves(struct entry *entries, size_t count, uint32_t depth, uint32_t max_depth,
                          uint32_t leaf_trees)
{
    if (count < leaf_trees || depth == max_depth) {
        for (size_t i = 0; i < count; i++)
            entries[i].key = key_cut(entries[i].key, depth);
        return;
    }
    for (size_t begin = 0, end; begin < count; begin = end) {
        uint32_t digit = digit_at(entries[begin].key, depth + 1);
        for (end = begin; end < count && digit_at(entries[end].key, depth + 1) == digit;)
            end++;
        if (digit != 0)
            gather_leaves(entries + begin, end - begin, depth + 1, max_depth, leaf_trees);
    }
}

static struct entry *sort_trees(struct wd_tree *trees, size_t count, const struct space *space,
                                uint32_t leaf_trees)
{
    struct entry *entries = wd_alloc_array(count, sizeof *entries);
    for (size_t i = 0; i < count; i++) {
        struct address address = loose_address(space, &trees[i]);
        entries[i] = (struct entry){key_of(&address), (uint32_t)i};
    }
    sort_entries(&entries, count);
    gather_leaves(entries, count, 0, space->depth, leaf_trees);
    struct wd_tree *sorted = wd_alloc_array(count, sizeof *sorted);
    for (size_t i = 0; i < count; i++) {
        sorted[i] = trees[entries[i].tree];
        entries[i].tree = (uint32_t)i;
    }
    memcpy(trees, sorted, count * sizeof *trees);
    free(sorted);
    return entries;
}

static uint32_t depth_of(uint64_t key)
{
    uint32_t depth = 0;
    while (depth < MAX_DEPTH && digit_at(key, depth + 1) != 0)
        depth++;
    return depth;
}

struct tight_list {
    struct entry *entries;
    size_t count, capacity;
};

/* Lists a tree in every cube of its level that its box touches. */
static void add_tight(struct tight_list *list, const struct space *space,
                      const struct wd_tree *tree, const struct entry *entry)
{
    struct address address = {.depth = depth_of(entry->key)};
    int64_t size_mm = space->cell_mm << (space->depth - address.depth);
    struct box box = box_of(tree);
    uint32_t first[3], last[3];
    for (int axis = 0; axis < 3; axis++) {
        first[axis] = (uint32_t)((box.min_mm[axis] - space->min_mm[axis]) / size_mm);
        last[axis] = (uint32_t)((box.max_mm[axis] - space->min_mm[axis]) / size_mm);
    }
    for (address.at[2] = first[2]; address.at[2] <= last[2]; address.at[2]++)
        for (address.at[1] = first[1]; address.at[1] <= last[1]; address.at[1]++)
            for (address.at[0] = first[0]; address.at[0] <= last[0]; address.at[0]++) {
                struct entry *added = wd_push(list->entries, list->count, list->capacity);
                *added = (struct entry){key_of(&address), entry->tree};
            }
}

/* Sorted entries that begin with the octant's path. */
struct span {
    const struct entry *entries;
    size_t begin, end;
};

static struct span take_digit(struct span *span, uint32_t level, uint32_t digit)
{
    struct span part = {span->entries, span->begin, span->begin};
    while (part.end < span->end && digit_at(span->entries[part.end].key, level) == digit)
        part.end++;
    span->begin = part.end;
    return part;
}

struct builder {
    struct wd_octree *octree;
    size_t capacity;
    const struct space *space;
    const struct wd_tree *trees;
};

static void grow_bounds(float min_m[3], float max_m[3], const float other_min_m[3],
                        const float other_max_m[3])
{
    for (int axis = 0; axis < 3; axis++) {
        if (other_min_m[axis] < min_m[axis])
            min_m[axis] = other_min_m[axis];
        if (other_max_m[axis] > max_m[axis])
            max_m[axis] = other_max_m[axis];
    }
}

static void set_cube(struct wd_octant *octant, const struct space *space,
                     const struct address *address)
{
    int64_t size_mm = space->cell_mm << (space->depth - address->depth);
    octant->depth = address->depth;
    octant->cube_size_m = (float)((double)size_mm * 0.001);
    for (int axis = 0; axis < 3; axis++) {
        int64_t min_mm = space->min_mm[axis] + size_mm * address->at[axis];
        octant->cube_min_m[axis] = (float)((double)min_mm * 0.001);
    }
}

/* Bounds of [begin, end): of the own trees here, of the rest by the children. An octant whose
 * trees all live elsewhere (it is only touched) has its cube's centre. */
static void set_own_bounds(struct wd_octant *octant, const struct wd_tree *trees)
{
    for (int axis = 0; axis < 3; axis++) {
        octant->min_m[axis] = octant->begin == octant->end
                                  ? octant->cube_min_m[axis] + 0.5f * octant->cube_size_m
                                  : 3.4e38f;
        octant->max_m[axis] = octant->begin == octant->end ? octant->min_m[axis] : -3.4e38f;
    }
    for (uint32_t i = octant->begin; i < octant->own_end; i++) {
        float min_m[3], max_m[3];
        wd_tree_bounds(&trees[i], min_m, max_m);
        grow_bounds(octant->min_m, octant->max_m, min_m, max_m);
    }
}

static uint32_t build(struct builder *builder, const struct address *address, struct span trees,
                      struct span tight);

static void build_children(struct builder *builder, uint32_t parent,
                           const struct address *address, struct span trees, struct span tight)
{
    struct wd_octree *octree = builder->octree;
    uint32_t previous = 0;
    for (uint32_t child = 0; child < 8; child++) {
        struct span child_trees = take_digit(&trees, address->depth + 1, child + 1);
        struct span child_tight = take_digit(&tight, address->depth + 1, child + 1);
        if (child_trees.begin == child_trees.end && child_tight.begin == child_tight.end)
            continue;
        struct address below = {.depth = address->depth + 1};
        for (int axis = 0; axis < 3; axis++)
            below.at[axis] = address->at[axis] << 1 | (child >> axis & 1);
        uint32_t index = build(builder, &below, child_trees, child_tight);
        if (previous != 0)
            octree->octants[previous].next_sibling = index;
        else
            octree->octants[parent].first_child = index;
        previous = index;
        octree->octants[parent].child_count++;
        const struct wd_octant *octant = &octree->octants[index];
        if (octant->begin < octant->end)
            grow_bounds(octree->octants[parent].min_m, octree->octants[parent].max_m,
                        octant->min_m, octant->max_m);
    }
}

static uint32_t build(struct builder *builder, const struct address *address, struct span trees,
                      struct span tight)
{
    struct wd_octree *octree = builder->octree;
    size_t count = octree->count;
    struct wd_octant *octant = wd_push(octree->octants, count, builder->capacity);
    uint32_t index = octree->count++;
    if (address->depth > octree->depth)
        octree->depth = address->depth;
    set_cube(octant, builder->space, address);
    octant->begin = (uint32_t)trees.begin;
    octant->end = (uint32_t)trees.end;
    octant->tight_begin = (uint32_t)tight.begin;
    bool deepest = address->depth == MAX_DEPTH;
    struct span own = deepest ? trees : take_digit(&trees, address->depth + 1, 0);
    struct span own_tight = deepest ? tight : take_digit(&tight, address->depth + 1, 0);
    octant->own_end = (uint32_t)own.end;
    octant->tight_end = (uint32_t)own_tight.end;
    set_own_bounds(octant, builder->trees);
    if (!deepest)
        build_children(builder, index, address, trees, tight);
    return index;
}

void wd_octree_init(struct wd_octree *octree, struct wd_tree *trees, size_t count,
                    const struct wd_octree_params *params)
{
    *octree = (struct wd_octree){0};
    if (count == 0)
        return;
    uint32_t depth = params && params->max_depth ? params->max_depth : DEFAULT_DEPTH;
    uint32_t leaf_trees = params && params->leaf_trees ? params->leaf_trees : DEFAULT_LEAF_TREES;
    struct space space = space_of(trees, count, depth < MAX_DEPTH ? depth : MAX_DEPTH);
    struct entry *entries = sort_trees(trees, count, &space, leaf_trees);
    struct tight_list tight = {0};
    for (size_t i = 0; i < count; i++)
        add_tight(&tight, &space, &trees[i], &entries[i]);
    sort_entries(&tight.entries, tight.count);
    struct builder builder = {.octree = octree, .space = &space, .trees = trees};
    struct address root = {0};
    build(&builder, &root, (struct span){entries, 0, count},
          (struct span){tight.entries, 0, tight.count});
    octree->tight_count = (uint32_t)tight.count;
    octree->tight_trees = wd_alloc_array(tight.count, sizeof *octree->tight_trees);
    for (size_t i = 0; i < tight.count; i++)
        octree->tight_trees[i] = tight.entries[i].tree;
    free(tight.entries);
    free(entries);
}

void wd_octree_finish(struct wd_octree *octree)
{
    free(octree->octants);
    free(octree->tight_trees);
    *octree = (struct wd_octree){0};
}

float wd_box_distance(const float min[3], const float max[3])
{
    float squared = 0.0f;
    for (int k = 0; k < 3; k++) {
        float outside = fmaxf(fmaxf(min[k], -max[k]), 0.0f);
        squared += outside * outside;
    }
    return sqrtf(squared);
}
