#include "planted.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "forest/octant_colors.h"

/* Trees are baked once for all tests. */
static char *cache;

static int find_cache(void **state)
{
    (void)state;
    cache = wd_cache_directory();
    return 0;
}

static int free_cache(void **state)
{
    (void)state;
    free(cache);
    return 0;
}

static double alpha(uint32_t color)
{
    return (double)wd_octant_coverage(color);
}

/* Sum of the opacities of a block of 4 x 4 texels (BC3: two of them, then 3 bits a texel). */
static double block_alpha(const uint8_t *block)
{
    double levels[8] = {block[0], block[1], 0, 0, 0, 0, 0, 255}, sum = 0.0;
    int between = block[0] > block[1] ? 6 : 4;
    for (int k = 1; k <= between; k++)
        levels[k + 1] = (levels[0] * (between + 1 - k) + levels[1] * k) / (between + 1);
    uint64_t bits = 0;
    for (int k = 0; k < 6; k++)
        bits |= (uint64_t)block[2 + k] << (8 * k);
    for (int k = 0; k < 16; k++)
        sum += levels[bits >> (3 * k) & 7] / 255.0;
    return sum;
}

/* Square metres that a card of the first model shows, of a tree in the model's own size. */
static double card_area(struct planted *planted, uint32_t card)
{
    const size_t count = (size_t)WD_CARD_WIDTH * WD_CARD_HEIGHT;
    bool blocks = planted->test->gpu.features & WD_GPU_FEATURE_BLOCKS;
    size_t bytes = blocks ? count : 4 * count;
    const struct wd_model *model = &planted->forest.host_models[0];
    uint8_t *texels = wd_alloc(bytes);
    assert_true(
        wd_image_read(&planted->test->gpu, &planted->forest.card_albedo, card, 0, texels, bytes));
    double sum = 0.0;
    for (size_t i = 0; i < count && !blocks; i++)
        sum += texels[4 * i + 3] / 255.0;
    for (size_t i = 0; i < count && blocks; i += 16)
        sum += block_alpha(texels + i);
    free(texels);
    bool level = card == WD_CARD_SIDES;
    double width = (double)(level ? model->half_depth_m : model->half_width_m);
    double tall = level ? 2.0 * width : (double)(model->top_m - model->bottom_m);
    return sum / (double)count * 2.0 * width * tall;
}

static void one_trees_octant_shows_the_trees_area(void **state)
{
    struct planted planted;
    struct wd_octant_colors colors;
    const struct wd_octant_bake_params params = {.pixels = 64};
    planted_init(&planted, *state, "tests/forest/one.json", cache);
    assert_true(wd_octant_colors_bake(&colors, &planted.test->gpu, &planted.forest, &params));
    assert_int_equal(colors.count, 1);
    assert_int_equal(colors.renders, 6);
    assert_int_equal(colors.bytes, 80);
    const struct wd_model *model = &planted.forest.host_models[0];
    const struct wd_tree *tree = &planted.world.trees[0];
    double up = 0.01 * (tree->size & 0xffff) / (double)model->height_m;
    double across = 0.01 * (tree->size >> 16) / (double)model->crown_m;
    double face = pow((double)planted.world.octree.octants[0].cube_size_m, 2.0);
    double least = 1e9, most = 0.0;
    for (uint32_t card = 0; card < WD_CARD_SIDES; card++) {
        least = fmin(least, card_area(&planted, card) * up * across);
        most = fmax(most, card_area(&planted, card) * up * across);
    }
    for (uint32_t side = 0; side < 4; side++) {
        double area = alpha(colors.looks[0].color[side]) * face;
        assert_true(area > 0.88 * least && area < 1.12 * most);
    }
    double above = card_area(&planted, WD_CARD_SIDES) * across * across;
    /* some hundred pixels show it, each by chance: one standard deviation is a tenth */
    assert_float_equal(alpha(colors.looks[0].color[4]) * face / above, 1.0, 0.18);
    assert_float_equal(alpha(colors.looks[0].color[5]) * face / above, 1.0, 0.18);
    wd_octant_colors_finish(&colors);
    planted_finish(&planted);
}

static void sides_face_their_way_and_are_green(void **state)
{
    struct planted planted;
    struct wd_octant_colors colors;
    const struct wd_octant_bake_params params = {0};
    planted_init(&planted, *state, "tests/api/small.json", cache);
    assert_true(wd_octant_colors_bake(&colors, &planted.test->gpu, &planted.forest, &params));
    const struct wd_octant_look *root = &colors.looks[0];
    for (uint32_t side = 0; side < WD_OCTANT_SIDES; side++) {
        const struct wd_octant_frame axes = wd_octant_frame_of(side);
        const float toward[3] = {axes.toward.x, axes.toward.y, axes.toward.z};
        double facing = 0.0, squared = 0.0; /* a mean of normals that spread is short */
        for (int k = 0; k < 3; k++) {
            double n = (root->normal[side] >> (8 * k) & 0xff) / 127.5 - 1.0;
            facing += n * (double)toward[k];
            squared += n * n;
        }
        assert_true(squared > 0.01 && squared < 1.02);
        if (side != 5) /* from below, leaves are seen that face the sky */
            assert_true(facing > 0.2 * sqrt(squared));
        uint32_t color = root->color[side];
        assert_true((color >> 8 & 0xff) > (color & 0xff));
        assert_true((color >> 8 & 0xff) > (color >> 16 & 0xff));
        assert_true(alpha(color) > 0.02 && alpha(color) < 1.0);
    }
    /* every octant with trees shows something from above */
    for (uint32_t i = 0; i < colors.count; i++) {
        const struct wd_octant *octant = &planted.world.octree.octants[i];
        if (octant->end > octant->begin + 4)
            assert_true(alpha(colors.looks[i].color[4]) > 0.0);
    }
    wd_octant_colors_finish(&colors);
    planted_finish(&planted);
}

static void baking_twice_gives_the_same(void **state)
{
    struct planted planted;
    struct wd_octant_colors a, b;
    const struct wd_octant_bake_params params = {.pixels = 8};
    planted_init(&planted, *state, "tests/api/small.json", cache);
    assert_true(wd_octant_colors_bake(&a, &planted.test->gpu, &planted.forest, &params));
    assert_true(wd_octant_colors_bake(&b, &planted.test->gpu, &planted.forest, &params));
    assert_memory_equal(a.looks, b.looks, a.bytes);
    wd_octant_colors_finish(&a);
    wd_octant_colors_finish(&b);
    planted_finish(&planted);
}

/* Share of the cube's top that cells cover, seen through each other. */
static double from_above(const struct wd_octant_clusters *clusters)
{
    uint32_t c = clusters->cluster_size;
    double *clear = wd_alloc_array((size_t)c * c, sizeof *clear), sum = 0.0;
    for (uint32_t i = 0; i < c * c; i++)
        clear[i] = 1.0;
    for (uint32_t i = 0; i < clusters->cell_count; i++) {
        uint32_t at = clusters->cells[i].at, x = at & 0xff, y = at >> 8 & 0xff, z = at >> 16;
        assert_true(x < c && y < c && z < c);
        clear[y * c + x] *= 1.0 - alpha(clusters->cells[i].look.color[4]);
    }
    for (uint32_t i = 0; i < c * c; i++)
        sum += 1.0 - clear[i];
    free(clear);
    return sum / (c * c);
}

static void a_cluster_covers_what_the_tree_covers(void **state)
{
    struct planted planted;
    struct wd_octant_clusters clusters;
    const struct wd_octant_bake_params cells = {.cluster_size = 12, .least_alpha = 0.004f};
    const uint32_t root = 0;
    planted_init(&planted, *state, "tests/forest/one.json", cache);
    assert_true(
        wd_octant_clusters_bake(&clusters, &planted.test->gpu, &planted.forest, &root, 1, &cells));
    assert_in_range(clusters.renders, 24, 72); /* 6 c, but for slices without the tree */
    assert_int_equal(clusters.first_cell[0], 0);
    assert_int_equal(clusters.first_cell[1], clusters.cell_count);
    assert_in_range(clusters.cell_count, 50, 12 * 12 * 12 - 1);
    const struct wd_model *model = &planted.forest.host_models[0];
    double across = 0.01 * (planted.world.trees[0].size >> 16) / (double)model->crown_m;
    double face = pow((double)planted.world.octree.octants[0].cube_size_m, 2.0);
    double above = card_area(&planted, WD_CARD_SIDES) * across * across;
    /* 0.75: leaves of a cell lie close together, and cells of one column are taken to hide by chance */
    assert_float_equal(from_above(&clusters) * face / above, 1.0, 0.27);
    wd_octant_clusters_finish(&clusters);
    planted_finish(&planted);
}

static void faint_cells_are_dropped(void **state)
{
    struct planted planted;
    struct wd_octant_clusters all, few;
    const struct wd_octant_bake_params params = {.cluster_size = 8, .least_alpha = 0.004f};
    const struct wd_octant_bake_params strict = {.cluster_size = 8, .least_alpha = 0.3f};
    const uint32_t root = 0;
    planted_init(&planted, *state, "tests/forest/one.json", cache);
    assert_true(
        wd_octant_clusters_bake(&all, &planted.test->gpu, &planted.forest, &root, 1, &params));
    assert_true(
        wd_octant_clusters_bake(&few, &planted.test->gpu, &planted.forest, &root, 1, &strict));
    assert_true(few.cell_count > 0 && few.cell_count < all.cell_count);
    wd_octant_clusters_finish(&all);
    wd_octant_clusters_finish(&few);
    planted_finish(&planted);
}

static void bad_parameters_are_named(void **state)
{
    struct planted planted;
    struct wd_octant_clusters clusters;
    const uint32_t root = 0;
    planted_init(&planted, *state, "tests/forest/one.json", cache);
    const struct {
        struct wd_octant_bake_params params;
        const char *says;
    } bad[] = {
        {{.pixels = 65, .log = &planted.test->log}, "65 pixels"},
        {{.cluster_size = 33, .log = &planted.test->log}, "33 cells"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_false(wd_octant_clusters_bake(&clusters, &planted.test->gpu, &planted.forest, &root,
                                             1, &bad[i].params));
        assert_logged(planted.test, bad[i].says);
        clear_log(planted.test);
    }
    planted_finish(&planted);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gpu_setup, gpu_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(one_trees_octant_shows_the_trees_area),
        TEST(sides_face_their_way_and_are_green),
        TEST(baking_twice_gives_the_same),
        TEST(a_cluster_covers_what_the_tree_covers),
        TEST(faint_cells_are_dropped),
        TEST(bad_parameters_are_named),
    };
    return cmocka_run_group_tests(tests, find_cache, free_cache);
}
