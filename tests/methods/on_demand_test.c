/* Worlds whose trees are planted on demand: what the device holds is what the CPU says, every part of
 * the ground is in one page, pictures depend on the view alone, a jump shows all at once. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "frame_test.h"

enum { OVER, WALK };

static const char *root;

/* 2.4 km of dense forest: enough for four levels of pages. */
static const char *const WOODS[] = {
    "planting=on_demand",          "terrain.size_m=[2400,2400]",
    "terrain.cell_m=20",           "layers.0.spacing_m=5",
    "layers.1.spacing_m=6",        "layers.0.patchiness=0.8",
    "layers.0.patch_size_m=300",   "cameras.0.position_m=[200,-40,40]",
    "cameras.0.look_at_m=[900,900,0]", "cameras.1.position_m=[1200,1200,1.7]",
    "quality.shadow_distance_m=800", NULL,
};

static size_t pixels_of(const struct frame_picture *picture)
{
    return (size_t)picture->width * picture->height;
}

/* --- pages on the CPU ---------------------------------------------------------------------- */

static struct wd_page_cell cell_of(const struct wd_world *world, uint32_t level, uint32_t column,
                                   uint32_t row, uint32_t index)
{
    const struct wd_page page = {0, level, column, row};
    return wd_page_cell_of(&world->demand.layers[0].placement.input, page, index);
}

/* Pages of the finest level hold every cell once; each coarser one a quarter of what its children
 * hold, and these come first in their clusters. */
static void pages_are_nested_samples(void **state)
{
    enum { SIDE = 8 * WD_PAGE_SIDE };
    struct frame_test *test = *state;
    uint8_t *level_of = wd_alloc(SIDE * SIDE);
    memset(level_of, 255, SIDE * SIDE);
    for (uint32_t level = 0; level < 4; level++) {
        uint32_t pages = 8u >> level, found = 0;
        for (uint32_t i = 0; i < pages * pages * WD_PAGE_TREES; i++) {
            uint32_t page = i / WD_PAGE_TREES, index = i % WD_PAGE_TREES;
            struct wd_page_cell cell =
                cell_of(&test->world, level, page % pages, page / pages, index);
            assert_true(cell.column < SIDE && cell.row < SIDE);
            uint8_t *at = &level_of[cell.row * SIDE + cell.column];
            assert_int_equal(*at, level ? level - 1 : 255); /* once, and held by the finer level */
            *at = (uint8_t)level;
            found++;
        }
        assert_int_equal(found, SIDE * SIDE >> (2 * level));
    }
    /* the first quarter of a cluster, in the order of reversed bits, stands for coarser blocks */
    for (uint32_t index = 0; index < WD_PAGE_TREES; index++) {
        struct wd_page_cell cell = cell_of(&test->world, 0, 0, 0, index);
        bool first_quarter = (index & 3u) == 0;
        assert_int_equal(level_of[cell.row * SIDE + cell.column] >= 1, first_quarter);
    }
    free(level_of);
}

static void ids_name_trees(void **state)
{
    struct frame_test *test = *state;
    const struct wd_demand *demand = &test->world.demand;
    assert_int_equal(demand->count, 2);
    assert_int_equal(test->world.tree_count, 0);
    size_t trees = 0;
    for (uint32_t layer = 0; layer < demand->count; layer++) {
        const struct wd_page page = {layer, 1, 1, 2};
        for (uint32_t i = 0; i < WD_PAGE_TREES; i++) {
            struct wd_tree tree, found;
            if (!wd_demand_tree(demand, &page, i, &tree))
                continue;
            trees++;
            assert_true(wd_world_find_tree(&test->world, tree.id, &found));
            assert_memory_equal(&tree, &found, sizeof tree);
        }
    }
    assert_true(trees > WD_PAGE_TREES / 2);
    /* ids go on where 32 bits end, and none is 0 */
    struct wd_demand_layer *last = &test->world.demand.layers[1];
    struct wd_tree tree;
    uint32_t first_id = last->first_id;
    last->first_id = UINT32_MAX - 1000u;
    for (uint32_t i = 0; i < WD_PAGE_TREES; i++)
        if (wd_demand_tree(demand, &(struct wd_page){1, 0, 0, 0}, i, &tree))
            assert_int_not_equal(tree.id, 0);
    last->first_id = first_id;
}

/* What is to be expected is what there is. */
static void counts_are_expected(void **state)
{
    struct frame_test *test = *state;
    const struct wd_demand *demand = &test->world.demand;
    for (uint32_t k = 0; k < demand->count; k++) {
        const struct wd_place_input *input = &demand->layers[k].placement.input;
        double trees = 0.0;
        for (uint32_t row = 0; row < input->layer.rows; row++)
            for (uint32_t column = 0; column < input->layer.columns; column++)
                trees += wd_page_tree(input, 1, (struct wd_page_cell){column, row}).size != 0;
        print_message("%s: %.0f trees, %.0f expected\n", demand->layers[k].placement.name, trees,
                      demand->layers[k].trees);
        assert_true(fabs(trees / demand->layers[k].trees - 1.0) < 0.02);
    }
}

/* --- pages on the device ------------------------------------------------------------------- */

static bool sees_all(const void *view, const float min[3], const float max[3])
{
    (void)view;
    return min[0] <= max[0];
}

/* Chooses pages as continuum does, for an eye that sees all around. */
static void choose(struct frame_test *test, const struct wd_pages_query *query,
                   struct wd_buffer *clusters, struct wd_page_list *list)
{
    struct wd_cmd cmd;
    assert_true(wd_frame_begin(&test->frame.ring, &cmd));
    wd_forest_device_use(&test->forest, &cmd);
    wd_pages_select(&test->forest.pages, &cmd, query, &test->forest.trees, clusters, 0, list);
    assert_true(wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE));
    assert_true(wd_frames_wait(&test->frame.ring));
}

/* Cells of the first layer, of which each must be in one page of the list. */
static void assert_each_cell_once(const struct frame_test *test, const struct wd_page_list *list)
{
    const struct wd_place_layer *layer = &test->world.demand.layers[0].placement.input.layer;
    uint8_t *seen = wd_alloc((size_t)layer->columns * layer->rows);
    for (size_t i = 0; i < list->count; i++) {
        const struct wd_page *page = &test->forest.pages.slots[list->slots[i]].page;
        uint32_t side = WD_PAGE_SIDE << page->level;
        for (uint32_t j = 0; page->layer == 0 && j < side * side; j++) {
            uint32_t column = page->column * side + j % side, row = page->row * side + j / side;
            if (column < layer->columns && row < layer->rows)
                seen[(size_t)row * layer->columns + column]++;
        }
    }
    for (size_t i = 0; i < (size_t)layer->columns * layer->rows; i++)
        assert_int_equal(seen[i], 1);
    free(seen);
}

static void open_pages(struct frame_test *test, struct wd_buffer *clusters)
{
    frame_test_init(test, root, &(struct frame_test_params){.settings = WOODS});
    const struct wd_buffer_params params = {
        "clusters", (VkDeviceSize)test->forest.pages.capacity * WD_PAGE_CLUSTERS * 32,
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, WD_MEMORY_DEVICE};
    assert_true(wd_buffer_init(clusters, test->gpu, &params));
}

static void records_are_the_trees_of_their_pages(void **state)
{
    (void)state;
    struct frame_test test;
    struct wd_buffer clusters;
    struct wd_page_list list = {0};
    open_pages(&test, &clusters);
    const struct wd_pages_query query = {
        .sees = sees_all, .eye_m = {300, 300, 40}, .pixels = 200, .whole_px = 6.3f, .most = 1000};
    choose(&test, &query, &clusters, &list);
    assert_each_cell_once(&test, &list);
    uint32_t levels = 0, trees = 0;
    struct wd_packed_tree *there = wd_alloc_array(WD_PAGE_TREES + 1, sizeof *there);
    for (size_t i = 0; i < list.count; i++) {
        uint32_t slot = list.slots[i];
        levels |= 1u << test.forest.pages.slots[slot].page.level;
        assert_true(wd_buffer_read(test.gpu, &test.forest.trees,
                                   WD_PACKED_HEAD((VkDeviceSize)slot * WD_PAGE_TREES) *
                                       sizeof *there,
                                   there, (WD_PAGE_TREES + 1) * sizeof *there));
        struct wd_tree_block block = wd_tree_block_of(there[0]);
        for (uint32_t k = 0; k < WD_PAGE_TREES; k++) {
            struct wd_tree here;
            bool stands = wd_forest_tree_at(&test.forest, slot * WD_PAGE_TREES + k, &here);
            struct wd_tree tree = wd_tree_unpack(there[k + 1], block);
            assert_int_equal((tree.size & 0xffffu) != 0, stands);
            if (!stands)
                continue;
            assert_int_equal(WD_TREE_LAYER(tree), 1 + test.forest.pages.slots[slot].page.layer);
            tree.look = WD_TREE_LOOK_OF_LAYER(tree.look, 0u);
            tree.id = here.id;
            assert_memory_equal(&tree, &here, sizeof here);
            trees++;
        }
    }
    print_message("%zu pages of levels %x, %u trees\n", list.count, levels, trees);
    assert_true((levels & 7u) == 7u && trees > 10000);
    free(there);
    wd_page_list_finish(&list);
    wd_buffer_finish(&clusters, test.gpu);
    frame_test_finish(&test);
}

/* A cap on pages holds, and so does what a frame may plant; the ground is covered all the same. */
static void caps_hold(void **state)
{
    (void)state;
    struct frame_test test;
    struct wd_buffer clusters;
    struct wd_page_list list = {0};
    open_pages(&test, &clusters);
    struct wd_pages_query query = {
        .sees = sees_all, .eye_m = {300, 300, 40}, .pixels = 200, .whole_px = 6.3f, .most = 40};
    choose(&test, &query, &clusters, &list);
    assert_in_range(list.count, 8, 40);
    assert_each_cell_once(&test, &list);
    query.most = 1000;
    choose(&test, &query, &clusters, &list);
    size_t refined = list.count;
    wd_pages_forget(&test.forest.pages);
    query.budget = (uint32_t)refined / 6; /* coarser pages come before finer ones */
    for (int frame = 0; frame < 10; frame++) {
        uint64_t before = test.forest.pages.planted;
        choose(&test, &query, &clusters, &list);
        assert_true(test.forest.pages.planted - before <= query.budget + 2); /* two roots */
        assert_each_cell_once(&test, &list);
        print_message("frame %d: %zu of %zu pages\n", frame, list.count, refined);
    }
    assert_int_equal(list.count, refined);
    wd_page_list_finish(&list);
    wd_buffer_finish(&clusters, test.gpu);
    frame_test_finish(&test);
}

/* --- pictures ------------------------------------------------------------------------------ */

static uint32_t id_at(const struct frame_test *test, uint32_t surface)
{
    struct wd_tree tree;
    return surface && wd_forest_tree_at(&test->forest, surface - 1, &tree) ? tree.id : 0;
}

static uint32_t *ids_of(const struct frame_test *test, const struct frame_picture *picture)
{
    uint32_t *ids = wd_alloc_array(pixels_of(picture), sizeof *ids);
    for (size_t i = 0; i < pixels_of(picture); i++)
        ids[i] = id_at(test, picture->surface[i]);
    return ids;
}

/* The camera has been elsewhere, and pages lie in other slots: the picture is the same. */
static void pictures_know_no_past(void **state)
{
    (void)state;
    struct frame_test test, other;
    frame_test_init(&test, root, &(struct frame_test_params){.settings = WOODS});
    frame_test_init(&other, root, &(struct frame_test_params){.settings = WOODS});
    struct frame_picture fresh, between, later;
    frame_test_draw(&test, "continuum", OVER, &fresh);
    frame_test_draw(&other, "continuum", WALK, &between);
    frame_picture_finish(&between);
    frame_test_draw(&other, "continuum", OVER, &later);
    uint32_t *ids = ids_of(&test, &fresh), *later_ids = ids_of(&other, &later);
    size_t trees = 0, different = 0;
    for (size_t i = 0; i < pixels_of(&fresh); i++) {
        trees += ids[i] != 0;
        assert_true(!fresh.surface[i] || ids[i]);
        assert_true(fresh.depth[i] == later.depth[i]);
        different += ids[i] != later_ids[i] || fresh.albedo[i] != later.albedo[i];
    }
    print_message("%zu pixels of trees, %zu different\n", trees, different);
    assert_true(trees > pixels_of(&fresh) / 5);
    assert_in_range(different, 0, pixels_of(&fresh) / 1000); /* equal depths: any of the splats */
    free(ids);
    free(later_ids);
    frame_picture_finish(&fresh);
    frame_picture_finish(&later);
    frame_test_finish(&test);
    frame_test_finish(&other);
}

static size_t covered(const struct frame_picture *picture)
{
    size_t count = 0;
    for (size_t i = 0; i < pixels_of(picture); i++)
        count += picture->surface[i] != 0;
    return count;
}

/* A live camera that jumps sees forest everywhere at once, and within ten frames the same picture as
 * one that waited for it. */
static void jumps_show_all_and_refine(void **state)
{
    (void)state;
    struct frame_test test, live;
    frame_test_init(&test, root, &(struct frame_test_params){.settings = WOODS});
    frame_test_init(&live, root, &(struct frame_test_params){.settings = WOODS});
    struct frame_picture whole, jumped;
    frame_test_draw(&test, "continuum", OVER, &whole);
    live.page_budget = 24;
    frame_test_draw(&live, "continuum", WALK, &jumped);
    for (int frame = 0; frame < 10; frame++) {
        frame_picture_finish(&jumped);
        frame_test_draw(&live, "continuum", OVER, &jumped);
        double share = (double)covered(&jumped) / (double)covered(&whole);
        print_message("frame %d: %.3f of the trees' pixels\n", frame, share);
        assert_true(share > 0.8 && share < 1.25);
    }
    size_t different = 0; /* by what the frame before is taken to have hidden */
    for (size_t i = 0; i < pixels_of(&whole); i++)
        different += whole.depth[i] != jumped.depth[i];
    print_message("%zu pixels different\n", different);
    assert_in_range(different, 0, pixels_of(&whole) / 1000);
    frame_picture_finish(&whole);
    frame_picture_finish(&jumped);
    frame_test_finish(&test);
    frame_test_finish(&live);
}

/* Nothing of the first frames' cascades is planted on demand, then the camera plants what they have read: validation
 * ends the program if these are not told apart. */
static void far_views_plant_after_cascades(void **state)
{
    (void)state;
    struct frame_test test;
    frame_test_init(&test, root, &(struct frame_test_params){.settings = WOODS});
    test.scene.quality.shadow_distance_m = 5.0;
    struct frame_picture picture;
    frame_test_draw(&test, "continuum", OVER, &picture);
    assert_true(test.forest.pages.planted > 0);
    assert_true(covered(&picture) > pixels_of(&picture) / 5);
    frame_picture_finish(&picture);
    frame_test_finish(&test);
}

/* A cascade of trees on demand that is kept is the one that would be drawn. */
static void kept_cascades_are_as_if_drawn(void **state)
{
    (void)state;
    struct frame_test test;
    void *maps[2][WD_CASCADES];
    frame_test_init(&test, root, &(struct frame_test_params){.settings = WOODS});
    test.scene.wind.speed_mps = 6.0;
    test.scene.wind.gust = 0.5;
    uint32_t kept = 0;
    for (int i = 0; i < 2; i++) {
        for (int frame = 0; frame < 2; frame++) { /* the second one keeps what it may */
            struct frame_picture picture;
            if (i == 1)
                memset(test.frame.kept, 0, sizeof test.frame.kept);
            test.time_s = 0.3 * frame;
            frame_test_draw(&test, "continuum", OVER, &picture);
            frame_picture_finish(&picture);
        }
        for (uint32_t k = 0; k < WD_CASCADES; k++) {
            struct wd_image *shadow = &test.frame.targets.shadow;
            size_t size = (size_t)4 * shadow->width * shadow->height;
            maps[i][k] = wd_alloc(size);
            assert_true(wd_image_read(test.gpu, shadow, k, 0, maps[i][k], size));
            bool calm = test.frame.kept[k].method && test.frame.kept[k].box.calm;
            kept += calm;
            if (i == 1 && calm)
                assert_memory_equal(maps[0][k], maps[1][k], size);
        }
    }
    print_message("%u of %d cascades may be kept\n", kept / 2, WD_CASCADES);
    assert_true(kept > 0);
    for (uint32_t k = 0; k < 2 * WD_CASCADES; k++)
        free(maps[k / WD_CASCADES][k % WD_CASCADES]);
    frame_test_finish(&test);
}

static void assert_same_pictures(const struct frame_picture *picture, const struct frame_picture *other)
{
    size_t different = 0;
    assert_true(covered(picture) > pixels_of(picture) / 5);
    for (size_t i = 0; i < pixels_of(picture); i++) {
        assert_true(picture->depth[i] == other->depth[i]);
        different += picture->albedo[i] != other->albedo[i];
    }
    assert_in_range(different, 0, pixels_of(picture) / 1000);
}

static uint8_t *read_display(struct frame_test *test)
{
    struct wd_image *display = &test->frame.targets.display;
    size_t size = (size_t)4 * display->width * display->height;
    uint8_t *bytes = wd_alloc(size);
    assert_true(wd_image_read(test->gpu, display, 0, 0, bytes, size));
    return bytes;
}

/* What an abandoned frame would have planted, swept, drawn into maps and kept is not taken to be there. */
static void abandoned_frames_leave_nothing(void **state)
{
    (void)state;
    struct frame_test test;
    struct frame_picture before, after, fresh;
    const char *steep[sizeof WOODS / sizeof *WOODS + 1] = {"terrain.relief_m=400"};
    memcpy(steep + 1, WOODS, sizeof WOODS);
    frame_test_init(&test, root, &(struct frame_test_params){.settings = steep});
    frame_test_draw(&test, "continuum", WALK, &before);
    test.scene.sun.azimuth_deg = 20; /* hills stand before it */
    test.scene.sun.elevation_deg = 5;
    frame_test_abandon(&test, "continuum", OVER);
    frame_test_draw(&test, "continuum", OVER, &after);
    uint8_t *display = read_display(&test);
    wd_frame_drop_forest(&test.frame);
    frame_test_draw(&test, "continuum", OVER, &fresh);
    uint8_t *expected = read_display(&test);
    assert_same_pictures(&after, &fresh);
    size_t different = 0;
    for (size_t i = 0; i < 4 * pixels_of(&after); i++)
        different += abs(display[i] - expected[i]) > 2;
    print_message("%zu bytes of light differ\n", different);
    assert_in_range(different, 0, pixels_of(&after) / 1000);
    free(display);
    free(expected);
    frame_picture_finish(&before);
    frame_picture_finish(&after);
    frame_picture_finish(&fresh);
    frame_test_finish(&test);
}

/* A picture for whose lists memory does not do is followed by a smaller one as if nothing had been. */
static void lists_without_memory_are_made_anew(void **state)
{
    (void)state;
    enum { MANY_LINES = 16384, LITTLE = 1 << 24 };
    struct frame_test test;
    struct frame_picture before, after;
    frame_test_init(&test, root, &(struct frame_test_params){.settings = WOODS});
    uint32_t *range = &test.gpu->properties.limits.maxStorageBufferRange;
    *range *= 2; /* as if longer lists could be bound than the first */
    frame_test_draw(&test, "continuum", OVER, &before);
    uint64_t most = test.gpu->max_buffer_size;
    test.height = MANY_LINES;
    test.gpu->max_buffer_size = LITTLE;
    frame_test_abandon(&test, "continuum", OVER);
    test.height = 0;
    test.gpu->max_buffer_size = most;
    frame_test_draw(&test, "continuum", OVER, &after);
    *range /= 2;
    assert_same_pictures(&before, &after);
    frame_picture_finish(&before);
    frame_picture_finish(&after);
    frame_test_finish(&test);
}

/* As many of a picture's pixels show trees as where all trees are stored. */
static void cover_is_that_of_stored_trees(void **state)
{
    (void)state;
    const char *stored[sizeof WOODS / sizeof *WOODS];
    memcpy(stored, WOODS, sizeof WOODS);
    stored[0] = "planting=stored";
    struct frame_test test, other;
    frame_test_init(&test, root, &(struct frame_test_params){.settings = WOODS});
    frame_test_init(&other, root, &(struct frame_test_params){.settings = stored});
    for (uint32_t camera = OVER; camera <= WALK; camera++) {
        struct frame_picture paged, all;
        frame_test_draw(&test, "continuum", camera, &paged);
        frame_test_draw(&other, "continuum", camera, &all);
        double share = (double)covered(&paged) / (double)covered(&all);
        print_message("camera %u: %.4f\n", camera, share);
        assert_true(fabs(share - 1.0) < 0.02);
        frame_picture_finish(&paged);
        frame_picture_finish(&all);
    }
    frame_test_finish(&test);
    frame_test_finish(&other);
}

static void others_refuse(void **state)
{
    struct frame_test *test = *state;
    static const char *const names[] = {"octree", "separate", "grid",    "lod",     "patch",
                                        "views",  "zfield",   "dissolve", "impostor"};
    struct wd_frame_params params = {
        .forest = &test->forest, .width = 64, .height = 64, .samples = 1};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        params.method = wd_method_find(names[i]);
        assert_false(wd_frame_prepare(&test->frame, &params));
    }
    params.method = wd_method_find("continuum");
    assert_true(wd_frame_prepare(&test->frame, &params));
}

static struct frame_test woods; /* of the tests that change nothing in it */

static int open_woods(void **state)
{
    frame_test_init(&woods, root, &(struct frame_test_params){.settings = WOODS});
    *state = &woods;
    return 0;
}

static int close_woods(void **state)
{
    frame_test_finish(*state);
    return frame_tests_finish(state);
}

int main(int argc, char **argv)
{
    root = argc > 1 ? argv[1] : ".";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pages_are_nested_samples),
        cmocka_unit_test(ids_name_trees),
        cmocka_unit_test(counts_are_expected),
        cmocka_unit_test(records_are_the_trees_of_their_pages),
        cmocka_unit_test(caps_hold),
        cmocka_unit_test(pictures_know_no_past),
        cmocka_unit_test(jumps_show_all_and_refine),
        cmocka_unit_test(far_views_plant_after_cascades),
        cmocka_unit_test(kept_cascades_are_as_if_drawn),
        cmocka_unit_test(abandoned_frames_leave_nothing),
        cmocka_unit_test(lists_without_memory_are_made_anew),
        cmocka_unit_test(cover_is_that_of_stored_trees),
        cmocka_unit_test(others_refuse),
    };
    if (argc > 2)
        cmocka_set_test_filter(argv[2]);
    return cmocka_run_group_tests(tests, open_woods, close_woods);
}
