#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/clock.h"
#include "base/memory.h"
#include "shared/hash.h"
#include "world/octree.h"

static struct wd_tree *make_trees(size_t count, uint32_t seed, uint32_t extent_mm,
                                  uint32_t most_height_cm)
{
    struct wd_tree *trees = wd_alloc_array(count, sizeof *trees);
    for (size_t i = 0; i < count; i++) {
        uint32_t n = (uint32_t)i;
        trees[i] = (struct wd_tree){
            .x_mm = (int32_t)(wd_hash3(seed, n, 0) % extent_mm),
            .y_mm = (int32_t)(wd_hash3(seed, n, 1) % extent_mm) - 5000,
            .z_mm = (int32_t)(wd_hash3(seed, n, 2) % 40000),
            .id = n + 1,
            .size = (1 + wd_hash3(seed, n, 3) % most_height_cm) |
                    (1 + wd_hash3(seed, n, 4) % (most_height_cm / 2)) << 16,
        };
    }
    return trees;
}

struct check {
    const struct wd_octree *octree;
    const struct wd_tree *trees;
    uint32_t visited;
    uint32_t *owners; /* times each tree is somebody's own */
};

static void check_loose(const struct wd_octant *octant, const struct wd_tree *tree)
{
    float min_m[3], max_m[3], half_m = 0.5f * octant->cube_size_m;
    wd_tree_bounds(tree, min_m, max_m);
    for (int axis = 0; axis < 3; axis++) {
        float low_m = octant->cube_min_m[axis], high_m = low_m + octant->cube_size_m;
        float centre_m = 0.5f * (min_m[axis] + max_m[axis]);
        assert_true(centre_m >= low_m - 0.01f && centre_m <= high_m + 0.01f);
        assert_true(min_m[axis] >= low_m - half_m - 0.01f);
        assert_true(max_m[axis] <= high_m + half_m + 0.01f);
        assert_true(min_m[axis] >= octant->min_m[axis] && max_m[axis] <= octant->max_m[axis]);
    }
}

static bool touches(const struct wd_octant *octant, const struct wd_tree *tree, float slack_m)
{
    float min_m[3], max_m[3];
    wd_tree_bounds(tree, min_m, max_m);
    for (int axis = 0; axis < 3; axis++)
        if (max_m[axis] < octant->cube_min_m[axis] - slack_m ||
            min_m[axis] > octant->cube_min_m[axis] + octant->cube_size_m + slack_m)
            return false;
    return true;
}

static void check_child(const struct wd_octant *parent, const struct wd_octant *child)
{
    assert_int_equal(child->depth, parent->depth + 1);
    assert_true(child->begin >= parent->own_end && child->end <= parent->end);
    for (int axis = 0; axis < 3; axis++) {
        assert_true(child->cube_min_m[axis] >= parent->cube_min_m[axis] - 0.01f);
        assert_true(child->cube_min_m[axis] + child->cube_size_m <=
                    parent->cube_min_m[axis] + parent->cube_size_m + 0.01f);
        if (child->begin < child->end) {
            assert_true(child->min_m[axis] >= parent->min_m[axis]);
            assert_true(child->max_m[axis] <= parent->max_m[axis]);
        }
        assert_true(child->min_m[axis] <= child->max_m[axis]);
    }
}

/* Octants are met in depth-first order: each has the index that the walk counts. */
static void walk(struct check *check, uint32_t index)
{
    const struct wd_octant *octant = &check->octree->octants[index];
    assert_int_equal(index, check->visited++);
    assert_true(octant->begin <= octant->own_end && octant->own_end <= octant->end);
    assert_true(octant->begin < octant->end || octant->child_count > 0 ||
                octant->tight_begin < octant->tight_end);
    for (uint32_t i = octant->begin; i < octant->own_end; i++) {
        check->owners[i]++;
        check_loose(octant, &check->trees[i]);
    }
    uint32_t next = octant->own_end, children = 0;
    for (uint32_t child = octant->first_child; child != 0;
         child = check->octree->octants[child].next_sibling) {
        const struct wd_octant *below = &check->octree->octants[child];
        check_child(octant, below);
        assert_int_equal(below->begin, next);
        next = below->end;
        children++;
        walk(check, child);
    }
    assert_int_equal(next, octant->end);
    assert_int_equal(children, octant->child_count);
}

static void check_octree(const struct wd_octree *octree, const struct wd_tree *trees, size_t count)
{
    struct check check = {.octree = octree, .trees = trees};
    check.owners = wd_alloc_array(count, sizeof *check.owners);
    assert_int_equal(octree->octants[0].begin, 0);
    assert_int_equal(octree->octants[0].end, count);
    assert_int_equal(octree->octants[0].depth, 0);
    walk(&check, 0);
    assert_int_equal(check.visited, octree->count);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(check.owners[i], 1);
    free(check.owners);
}

/* Every octant against every tree of the same depth; `listed` marks pairs. */
static void check_tight(const struct wd_octree *octree, const struct wd_tree *trees, size_t count)
{
    uint32_t *depths = wd_alloc_array(count, sizeof *depths);
    for (uint32_t k = 0; k < octree->count; k++)
        for (uint32_t i = octree->octants[k].begin; i < octree->octants[k].own_end; i++)
            depths[i] = octree->octants[k].depth;
    bool *listed = wd_alloc(count);
    for (uint32_t k = 0; k < octree->count; k++) {
        const struct wd_octant *octant = &octree->octants[k];
        memset(listed, 0, count);
        for (uint32_t i = octant->tight_begin; i < octant->tight_end; i++) {
            assert_false(listed[octree->tight_trees[i]]);
            listed[octree->tight_trees[i]] = true;
        }
        for (size_t i = 0; i < count; i++) {
            bool same = depths[i] == octant->depth;
            if (listed[i])
                assert_true(same && touches(octant, &trees[i], 0.005f));
            else
                assert_false(same && touches(octant, &trees[i], -0.005f));
        }
    }
    free(listed);
    free(depths);
}

/* A tree's box is covered by the cubes that list it: no part of a crown is lost. */
static void check_cover(const struct wd_octree *octree, const struct wd_tree *trees, size_t count)
{
    double *covered_m3 = wd_alloc_array(count, sizeof *covered_m3);
    for (uint32_t k = 0; k < octree->count; k++) {
        const struct wd_octant *octant = &octree->octants[k];
        for (uint32_t i = octant->tight_begin; i < octant->tight_end; i++) {
            float min_m[3], max_m[3];
            double volume_m3 = 1.0;
            wd_tree_bounds(&trees[octree->tight_trees[i]], min_m, max_m);
            for (int axis = 0; axis < 3; axis++) {
                double low_m = octant->cube_min_m[axis], high_m = low_m + octant->cube_size_m;
                low_m = min_m[axis] > low_m ? min_m[axis] : low_m;
                high_m = max_m[axis] < high_m ? max_m[axis] : high_m;
                volume_m3 *= high_m > low_m ? high_m - low_m : 0.0;
            }
            covered_m3[octree->tight_trees[i]] += volume_m3;
        }
    }
    for (size_t i = 0; i < count; i++) {
        float min_m[3], max_m[3];
        wd_tree_bounds(&trees[i], min_m, max_m);
        double whole_m3 = 1.0;
        for (int axis = 0; axis < 3; axis++)
            whole_m3 *= (double)max_m[axis] - min_m[axis];
        assert_true(covered_m3[i] > 0.995 * whole_m3 - 0.01);
    }
    free(covered_m3);
}

static void test_invariants(void **state)
{
    (void)state;
    const size_t counts[] = {1, 2, 63, 64, 65, 500, 5000};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        struct wd_tree *trees = make_trees(counts[k], (uint32_t)k, 600000, 3000);
        struct wd_octree octree;
        const struct wd_octree_params params = {.max_depth = 6, .leaf_trees = 4};
        wd_octree_init(&octree, trees, counts[k], k % 2 ? &params : NULL);
        check_octree(&octree, trees, counts[k]);
        check_tight(&octree, trees, counts[k]);
        check_cover(&octree, trees, counts[k]);
        wd_octree_finish(&octree);
        free(trees);
    }
}

static void test_sizes_choose_levels(void **state)
{
    (void)state;
    /* one huge tree among small ones lives near the root, they do not */
    struct wd_tree *trees = make_trees(1000, 9, 1000000, 200);
    trees[500].size = 60000u | 60000u << 16;
    struct wd_octree octree;
    wd_octree_init(&octree, trees, 1000, &(struct wd_octree_params){.leaf_trees = 2});
    check_octree(&octree, trees, 1000);
    check_tight(&octree, trees, 1000);
    uint32_t own = octree.octants[0].own_end - octree.octants[0].begin;
    assert_in_range(own, 1, 20);
    assert_int_equal(octree.depth, 8);
    wd_octree_finish(&octree);
    free(trees);
}

static void test_none(void **state)
{
    (void)state;
    struct wd_octree octree;
    wd_octree_init(&octree, NULL, 0, NULL);
    assert_null(octree.octants);
    assert_int_equal(octree.count, 0);
    wd_octree_finish(&octree);
}

static void test_all_at_one_place(void **state)
{
    (void)state;
    struct wd_tree *trees = make_trees(1, 3, 1000, 1000);
    trees = wd_realloc(trees, 1000 * sizeof *trees);
    for (uint32_t i = 1; i < 1000; i++) {
        trees[i] = trees[0];
        trees[i].id = i + 1;
    }
    struct wd_octree octree;
    wd_octree_init(&octree, trees, 1000, NULL);
    check_octree(&octree, trees, 1000);
    check_tight(&octree, trees, 1000);
    for (uint32_t i = 0; i < 1000; i++)
        assert_int_equal(trees[i].id, i + 1); /* equal places keep their order */
    wd_octree_finish(&octree);
    free(trees);
}

static void test_deep(void **state)
{
    (void)state;
    struct wd_tree *trees = make_trees(3000, 11, 2000000000, 100);
    struct wd_octree octree;
    wd_octree_init(&octree, trees, 3000, &(struct wd_octree_params){.max_depth = 40, .leaf_trees = 2});
    assert_true(octree.depth <= 15);
    struct check check = {.octree = &octree, .trees = trees};
    check.owners = wd_alloc_array(3000, sizeof *check.owners);
    /* floats are too coarse for 2000 km in the checks of boxes: ranges only */
    uint32_t own = 0;
    for (uint32_t k = 0; k < octree.count; k++)
        own += octree.octants[k].own_end - octree.octants[k].begin;
    assert_int_equal(own, 3000);
    free(check.owners);
    wd_octree_finish(&octree);
    free(trees);
}

static void test_million(void **state)
{
    (void)state;
    const size_t count = 1000000;
    struct wd_tree *trees = make_trees(count, 5, 10000000, 3000);
    struct wd_octree octree;
    double start_s = wd_clock_s();
    wd_octree_init(&octree, trees, count, NULL);
    double time_s = wd_clock_s() - start_s;
    print_message("octree over 1000000 trees: %.3f s, %u octants, %u tight entries\n", time_s,
                  octree.count, octree.tight_count);
    check_octree(&octree, trees, count);
    check_cover(&octree, trees, count);
    wd_octree_finish(&octree);
    free(trees);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_invariants),
        cmocka_unit_test(test_sizes_choose_levels),
        cmocka_unit_test(test_none),
        cmocka_unit_test(test_all_at_one_place),
        cmocka_unit_test(test_deep),
        cmocka_unit_test(test_million),
    };
    return cmocka_run_group_tests_name("octree", tests, NULL, NULL);
}
