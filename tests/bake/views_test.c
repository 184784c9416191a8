/* Bakes meshes whose pictures can be told by hand, on a real device with validation. */
#include "gpu_test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/cards.h"
#include "bake/views.h"
#include "base/color.h"
#include "base/memory.h"
#include "device_mesh.h"
#include "shared/mixed.h"

enum { SIZE = 32, LOOK_SIZE = 2 };

static const uint8_t BARK[4] = {200, 100, 50, 255}, LEAF[4] = {60, 160, 40, 255};

struct fixture {
    struct gpu_test *test;
    struct wd_baker baker;
    struct device_mesh device;
};

static void add_quad(struct wd_tree_mesh *mesh, float corners[4][3], const float normal[3],
                     uint32_t kind)
{
    uint32_t at[4];
    for (int i = 0; i < 4; i++) {
        struct wd_tree_vertex vertex = {
            .normal = wd_pack_normal(normal),
            .uv = wd_pack_uv((float)(i & 1), (float)(i / 2)),
            .tint = 0xffffffffu,
            .kind = kind,
        };
        memcpy(vertex.position_m, corners[i], sizeof vertex.position_m);
        at[i] = wd_tree_mesh_add_vertex(mesh, &vertex);
    }
    wd_tree_mesh_add_triangle(mesh, at[0], at[1], at[2]);
    wd_tree_mesh_add_triangle(mesh, at[2], at[1], at[3]);
}

/* A cube of 2 m on the ground, its walls 1 m from the axis. */
static void add_cube(struct wd_tree_mesh *mesh)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int side = -1; side <= 1; side += 2) {
            float corners[4][3], normal[3] = {0, 0, 0};
            normal[axis] = (float)side;
            for (int i = 0; i < 4; i++) {
                corners[i][axis] = (float)side;
                corners[i][(axis + 1) % 3] = i & 1 ? 1.0f : -1.0f;
                corners[i][(axis + 2) % 3] = i & 2 ? 1.0f : -1.0f;
                corners[i][2] += 1.0f;
            }
            add_quad(mesh, corners, normal, 0);
        }
    }
    mesh->wood_index_count = mesh->index_count;
}

/* A ball of leaves, 1 m in radius about (0, 0, 1). */
static void add_ball(struct wd_tree_mesh *mesh)
{
    enum { ROWS = 24, COLUMNS = 48 };
    for (int row = 0; row < ROWS; row++) {
        for (int column = 0; column < COLUMNS; column++) {
            float corners[4][3], normal[3];
            for (int i = 0; i <= 4; i++) {
                float up = (float)row + (i == 4 ? 0.5f : (float)(i / 2));
                float turn = (float)column + (i == 4 ? 0.5f : (float)(i & 1));
                float zenith = up / ROWS * 3.14159265f, azimuth = turn / COLUMNS * 6.2831853f;
                float *to = i == 4 ? normal : corners[i];
                to[0] = sinf(zenith) * cosf(azimuth);
                to[1] = sinf(zenith) * sinf(azimuth);
                to[2] = cosf(zenith) + (i == 4 ? 0.0f : 1.0f);
            }
            add_quad(mesh, corners, normal, WD_VERTEX_LEAF);
        }
    }
}

/* Bars before the ball, narrower than a texel. */
static void add_bars(struct wd_tree_mesh *mesh)
{
    static const float normal[3] = {1, 0, 0};
    for (int bar = -8; bar < 8; bar++) {
        float from = 0.125f * (float)bar, to = from + 0.03f;
        float corners[4][3] = {{1.3f, from, 0}, {1.3f, to, 0}, {1.3f, from, 2}, {1.3f, to, 2}};
        add_quad(mesh, corners, normal, 0);
    }
    mesh->wood_index_count = mesh->index_count;
}

static void make(struct fixture *f, void **state, void (*add)(struct wd_tree_mesh *mesh),
                 void (*more)(struct wd_tree_mesh *mesh))
{
    *f = (struct fixture){.test = *state};
    struct wd_tree_mesh mesh = {0};
    uint8_t looks[2 * LOOK_SIZE * LOOK_SIZE * 4];
    for (int i = 0; i < LOOK_SIZE * LOOK_SIZE; i++) {
        memcpy(looks + 4 * i, BARK, 4);
        memcpy(looks + 4 * (LOOK_SIZE * LOOK_SIZE + i), LEAF, 4);
    }
    add(&mesh);
    if (more)
        more(&mesh);
    assert_true(wd_baker_init(&f->baker, &f->test->gpu, &f->test->log));
    assert_true(device_mesh_init(&f->device, &f->test->gpu, &mesh, looks, LOOK_SIZE));
    wd_tree_mesh_finish(&mesh);
}

static void finish(struct fixture *f)
{
    device_mesh_finish(&f->device, &f->test->gpu);
    wd_baker_finish(&f->baker);
}

/* Four views on the horizon from east, north, west, south, and four from above. */
static struct wd_view_set bake(struct fixture *f, struct wd_view_model model,
                               enum wd_bake_parts parts)
{
    struct wd_view_set_params params = {{WD_VIEWS_RINGS, 2, 4}, SIZE, 4, parts};
    struct wd_view_atlas atlas;
    struct wd_view_set set;
    assert_true(wd_view_atlas_init(&atlas, &params, &f->test->gpu, &f->test->log));
    assert_true(wd_view_set_bake(&set, &f->baker, &f->device.mesh, &model, &atlas, &params));
    return set;
}

static const uint8_t *texel(const struct wd_view_set *set, int plane, uint32_t view, uint32_t x,
                            uint32_t y)
{
    uint32_t columns = set->atlas.columns, side = wd_view_layer_size(&set->atlas, 0);
    size_t at = (size_t)(view / columns * SIZE + y) * side + view % columns * SIZE + x;
    return set->planes[plane] + 4 * at;
}

static double coverage(const struct wd_view_set *set, uint32_t view)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < SIZE * SIZE; i++)
        sum += texel(set, WD_PLANE_ALBEDO, view, i % SIZE, i / SIZE)[3] / 255.0;
    return sum / (SIZE * SIZE);
}

static void assert_texel(const struct wd_view_set *set, int plane, uint32_t view, const int want[4])
{
    const uint8_t *found = texel(set, plane, view, SIZE / 2, SIZE / 2);
    for (int k = 0; k < 4; k++)
        if (abs(found[k] - want[k]) > 1)
            fail_msg("plane %d, view %u, byte %d is %d, expected %d", plane, view, k, found[k],
                     want[k]);
}

static void a_cube_is_seen_as_a_cube(void **state)
{
    const float radius = sqrtf(2.0f);
    struct fixture f;
    make(&f, state, add_cube, NULL);
    struct wd_view_set set = bake(&f, (struct wd_view_model){radius, 0.0f, 2.0f, 0}, WD_BAKE_ALL);
    static const int normals[5][4] = {{255, 128, 128, 255},
                                      {128, 255, 128, 255},
                                      {0, 128, 128, 255},
                                      {128, 0, 128, 255},
                                      {128, 128, 255, 255}};
    int front = (int)(255.0f * (0.5f + 0.5f / radius) + 0.5f);
    for (uint32_t view = 0; view < 4; view++) {
        assert_float_equal(coverage(&set, view), 1.0 / radius, 0.01);
        assert_texel(&set, WD_PLANE_ALBEDO, view, (int[]){BARK[0], BARK[1], BARK[2], 255});
        assert_texel(&set, WD_PLANE_NORMAL, view, normals[view]);
        assert_texel(&set, WD_PLANE_DEPTH, view, (int[]){front, 255 - front, 0, 0});
    }
    assert_float_equal(coverage(&set, 4), 0.5, 0.01); /* the square in its circle's square */
    assert_texel(&set, WD_PLANE_NORMAL, 4, normals[4]);
    assert_texel(&set, WD_PLANE_DEPTH, 4, (int[]){255, 0, 0, 0});
    wd_view_set_finish(&set);
    finish(&f);
}

static void a_ball_is_round_from_everywhere(void **state)
{
    struct fixture f;
    make(&f, state, add_ball, NULL);
    struct wd_view_set_params params = {{WD_VIEWS_EVEN, 3, 0}, SIZE, 4, WD_BAKE_ALL};
    const struct wd_view_model model = {1.0f, 0.0f, 2.0f, 0};
    struct wd_view_atlas atlas;
    struct wd_view_set set;
    assert_true(wd_view_atlas_init(&atlas, &params, &f.test->gpu, &f.test->log));
    assert_true(wd_view_set_bake(&set, &f.baker, &f.device.mesh, &model, &atlas, &params));
    for (uint32_t view = 0; view < wd_hemisphere_count(atlas.hemisphere); view++) {
        struct wd_direction d = wd_hemisphere_direction(atlas.hemisphere, view);
        struct wd_view_frame frame = wd_view_frame_of(model, d);
        double whole = 4.0 * (double)frame.half_width_m * (double)frame.half_height_m;
        assert_float_equal(coverage(&set, view) * whole, 3.14159, 0.05);
        double reach = 127.5 / (double)frame.half_depth_m;
        int sheets = (int)(255 * (1 - exp(-0.5)));
        const uint8_t *depth = texel(&set, WD_PLANE_DEPTH, view, SIZE / 2, SIZE / 2);
        assert_float_equal(depth[0], 127.5 + reach, 2.0);
        assert_float_equal(depth[1], 127.5 - reach, 2.0);
        assert_in_range(depth[2], sheets - 8, sheets + 22); /* the pole counts twice */
        assert_int_equal(depth[3], 255);
        const uint8_t *normal = texel(&set, WD_PLANE_NORMAL, view, SIZE / 2, SIZE / 2);
        assert_float_equal(normal[0] / 127.5 - 1.0, (double)d.x, 0.12);
        assert_float_equal(normal[1] / 127.5 - 1.0, (double)d.y, 0.12);
        assert_float_equal(normal[2] / 127.5 - 1.0, (double)d.z, 0.12);
    }
    wd_view_set_finish(&set);
    finish(&f);
}

/* W6: wood and leaves apart. The ball bulges out of the cube's walls. */
static void parts_come_apart(void **state)
{
    struct fixture f;
    make(&f, state, add_cube, add_ball);
    const struct wd_view_model model = {1.5f, 0.0f, 2.0f, 0};
    struct wd_view_set all = bake(&f, model, WD_BAKE_ALL);
    struct wd_view_set wood = bake(&f, model, WD_BAKE_WOOD);
    struct wd_view_set leaves = bake(&f, model, WD_BAKE_LEAVES);
    assert_float_equal(coverage(&wood, 0), 2.0 / 3.0, 0.01);
    assert_float_equal(coverage(&leaves, 0), 3.14159 / 6.0, 0.01);
    assert_float_equal(coverage(&all, 0), coverage(&wood, 0), 0.01);
    assert_int_equal(texel(&wood, WD_PLANE_DEPTH, 0, SIZE / 2, SIZE / 2)[3], 0);
    assert_int_equal(texel(&leaves, WD_PLANE_DEPTH, 0, SIZE / 2, SIZE / 2)[3], 255);
    assert_int_equal(texel(&wood, WD_PLANE_ALBEDO, 0, SIZE / 2, SIZE / 2)[0], BARK[0]);
    assert_int_equal(texel(&leaves, WD_PLANE_ALBEDO, 0, SIZE / 2, SIZE / 2)[0], LEAF[0]);
    /* where there is but the one, nothing is to be told apart */
    assert_int_equal(wood.model.mixed, WD_MIXED_EVEN);
    assert_int_equal(leaves.model.mixed, WD_MIXED_EVEN);
    wd_view_set_finish(&all);
    wd_view_set_finish(&wood);
    wd_view_set_finish(&leaves);
    finish(&f);
}

/* By what leaves alone show light can tell what bars and ball have where a texel holds both. */
static void mixed_texels_are_told_apart(void **state)
{
    struct fixture f;
    make(&f, state, add_bars, add_ball);
    struct wd_view_set set = bake(&f, (struct wd_view_model){1.5f, 0.0f, 2.0f, 0}, WD_BAKE_ALL);
    double green = (double)wd_srgb_decode(BARK[1]) / (double)wd_srgb_decode(LEAF[1]);
    assert_float_equal((double)wd_mixed_ratio(set.model.mixed, 1), green, 0.05 * green);
    assert_true(wd_mixed_ratio(set.model.mixed, 0) > 7.5f); /* it goes no further */
    wd_view_set_finish(&set);
    finish(&f);
}

static void baking_twice_gives_the_same(void **state)
{
    struct fixture f;
    make(&f, state, add_cube, add_ball);
    const struct wd_view_model model = {1.5f, 0.0f, 2.0f, 0};
    struct wd_view_set a = bake(&f, model, WD_BAKE_ALL), b = bake(&f, model, WD_BAKE_ALL);
    for (int plane = 0; plane < WD_PLANES; plane++)
        assert_memory_equal(a.planes[plane], b.planes[plane], wd_view_plane_bytes(&a.atlas));
    wd_view_set_finish(&a);
    wd_view_set_finish(&b);
    finish(&f);
}

/* With 64-bit atomics the nearest surface and whose it is are found at once, else one by one. */
static void one_pass_and_two_give_the_same(void **state)
{
    struct gpu_test *test = *state;
    struct fixture once, twice;
    const struct wd_view_model model = {1.5f, 0.0f, 2.0f, 0};
    make(&once, state, add_cube, add_ball);
    assert_int_equal(once.baker.passes, 1);
    test->gpu.features &= ~(uint32_t)WD_GPU_FEATURE_INT64_ATOMICS;
    make(&twice, state, add_cube, add_ball);
    assert_int_equal(twice.baker.passes, 2);
    struct wd_view_set a = bake(&once, model, WD_BAKE_ALL), b = bake(&twice, model, WD_BAKE_ALL);
    for (int plane = 0; plane < WD_PLANES; plane++)
        assert_memory_equal(a.planes[plane], b.planes[plane], wd_view_plane_bytes(&a.atlas));
    wd_view_set_finish(&a);
    wd_view_set_finish(&b);
    finish(&once);
    finish(&twice);
}

/* Cards that keep no depth are drawn without it. */
static void cards_without_depth_show_the_same(void **state)
{
    struct fixture f;
    make(&f, state, add_cube, add_ball);
    const struct wd_card_extent extent = {2.0f, 2.0f, 0.0f, 2.0f};
    const struct wd_card_form with = {WD_BAKE_ALL, {WD_CARD_TEXELS, WD_CARD_TEXELS, WD_CARD_TEXELS}};
    const struct wd_card_form without = {WD_BAKE_ALL, {WD_CARD_TEXELS, WD_CARD_TEXELS, WD_CARD_ALPHA}};
    struct wd_cards a, b;
    assert_true(wd_cards_bake(&a, &f.baker, &f.device.mesh, &extent, &with));
    assert_true(wd_cards_bake(&b, &f.baker, &f.device.mesh, &extent, &without));
    for (int plane = 0; plane < WD_PLANE_DEPTH; plane++)
        assert_memory_equal(a.planes[plane], b.planes[plane], wd_card_plane_bytes(&with, plane));
    for (uint32_t card = 0; card < WD_CARDS; card++) {
        const uint8_t *depth = a.planes[WD_PLANE_DEPTH] + wd_card_offset(&with, WD_PLANE_DEPTH, card, WD_CARD_NORMAL_MIP);
        const uint8_t *leaf = b.planes[WD_PLANE_DEPTH] + wd_card_offset(&without, WD_PLANE_DEPTH, card, WD_CARD_NORMAL_MIP);
        for (size_t i = 0; i < (size_t)(WD_CARD_WIDTH / 2) * (WD_CARD_HEIGHT / 2); i++)
            assert_int_equal(leaf[i], depth[4 * i + 3]);
    }
    wd_cards_finish(&a);
    wd_cards_finish(&b);
    finish(&f);
}

static void cards_show_the_cube_from_three_sides_and_above(void **state)
{
    struct fixture f;
    make(&f, state, add_cube, NULL);
    const struct wd_card_extent extent = {2.0f, 2.0f, 0.0f, 2.0f};
    struct wd_cards cards;
    const struct wd_card_form form = {WD_BAKE_ALL,
                                      {WD_CARD_TEXELS, WD_CARD_BLOCKS, WD_CARD_TEXELS}};
    assert_true(wd_cards_bake(&cards, &f.baker, &f.device.mesh, &extent, &form));
    static const double widths[WD_CARDS] = {0.5, 0.683, 0.683, 0.25};
    for (uint32_t card = 0; card < WD_CARDS; card++) {
        size_t count = (size_t)WD_CARD_WIDTH * WD_CARD_HEIGHT;
        const uint8_t *albedo = cards.planes[WD_PLANE_ALBEDO] + wd_card_offset(&form, WD_PLANE_ALBEDO, card, 0);
        double sum = 0.0;
        for (size_t i = 0; i < count; i++)
            sum += albedo[4 * i + 3] / 255.0;
        assert_float_equal(sum / (double)count, widths[card], 0.01);
    }
    size_t middle = (size_t)4 * (WD_CARD_HEIGHT / 2 * WD_CARD_WIDTH + WD_CARD_WIDTH / 2);
    const uint8_t *side = cards.planes[WD_PLANE_DEPTH] + wd_card_offset(&form, WD_PLANE_DEPTH, 0, 0) + middle;
    const uint8_t *above = cards.planes[WD_PLANE_DEPTH] + wd_card_offset(&form, WD_PLANE_DEPTH, 3, 0) + middle;
    assert_in_range(side[0], 190, 192); /* the wall 1 m before the card that reaches 2 m */
    assert_in_range(side[1], 63, 65);
    assert_int_equal(above[0], 255);
    assert_int_equal(above[1], 0);
    wd_cards_finish(&cards);
    finish(&f);
}

/* What is up in the plant is to the left in its picture, what is to the right is up. */
static void cards_of_wide_plants_lie(void **state)
{
    struct fixture f;
    make(&f, state, add_cube, add_ball);
    static const struct wd_card_form form = {WD_BAKE_LEAVES, {WD_CARD_TEXELS, WD_CARD_TEXELS, WD_CARD_NOTHING}};
    static const struct wd_card_extent extents[] = {{1.4f, 1.4f, 0.0f, 3.0f}, {1.6f, 1.6f, 0.0f, 3.0f}};
    for (int lies = 0; lies < 2; lies++) {
        struct wd_cards cards;
        assert_true(wd_cards_bake(&cards, &f.baker, &f.device.mesh, &extents[lies], &form));
        const uint8_t *albedo = cards.planes[WD_PLANE_ALBEDO] + wd_card_offset(&form, WD_PLANE_ALBEDO, 0, 0);
        const uint8_t *normal = cards.planes[WD_PLANE_NORMAL]
                                + wd_card_offset(&form, WD_PLANE_NORMAL, 0, WD_CARD_NORMAL_MIP);
        /* the ball's right, and its top; metres right of the axis and above the ground */
        static const float places_m[2][2] = {{0.8f, 1.0f}, {0.0f, 1.8f}};
        for (int i = 0; i < 2; i++) {
            float right = 0.5f + 0.5f * places_m[i][0] / extents[lies].half_width_m, down = 1.0f - places_m[i][1] / 3.0f;
            size_t x = (size_t)(WD_CARD_WIDTH * (lies ? down : right));
            size_t y = (size_t)(WD_CARD_HEIGHT * (lies ? 1.0f - right : down));
            assert_int_equal(albedo[4 * (y * WD_CARD_WIDTH + x) + 3], 255);
            const uint8_t *n = normal + 4 * (y / 2 * (WD_CARD_WIDTH / 2) + x / 2);
            assert_in_range(n[i ? 2 : 0], 220, 240); /* 0.8 */
            assert_in_range(n[i ? 0 : 2], 117, 138); /* 0 */
        }
        size_t air = lies ? (size_t)4 * (WD_CARD_HEIGHT / 2 * WD_CARD_WIDTH + WD_CARD_WIDTH / 4)
                          : (size_t)4 * (WD_CARD_HEIGHT / 4 * WD_CARD_WIDTH + WD_CARD_WIDTH / 2);
        assert_int_equal(albedo[air + 3], 0);
        wd_cards_finish(&cards);
    }
    finish(&f);
}

static void bad_parameters_are_named(void **state)
{
    struct gpu_test *test = *state;
    static const struct {
        struct wd_view_set_params params;
        const char *says;
    } bad[] = {
        {{{7, 3, 3}, 32, 4, 0}, "layout 7"},
        {{{WD_VIEWS_RINGS, 1, 30}, 32, 4, 0}, "1 rows"},
        {{{WD_VIEWS_RINGS, 4, 2}, 32, 4, 0}, "2 views a ring"},
        {{{WD_VIEWS_EVEN, 65, 0}, 32, 4, 0}, "65 rows"},
        {{{WD_VIEWS_EVEN, 9, 0}, 48, 4, 0}, "48 texels"},
        {{{WD_VIEWS_EVEN, 9, 0}, 512, 4, 0}, "512 texels"},
        {{{WD_VIEWS_EVEN, 9, 0}, 64, 9, 0}, "9 samples"},
        {{{WD_VIEWS_EVEN, 64, 0}, 256, 4, 0}, "fewer or smaller views"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct wd_view_set_params params = bad[i].params;
        struct wd_view_atlas atlas;
        assert_false(wd_view_atlas_init(&atlas, &params, &test->gpu, &test->log));
        assert_logged(test, bad[i].says);
        clear_log(test);
    }
    struct wd_view_set_params usual = {0};
    struct wd_view_atlas atlas;
    assert_true(wd_view_atlas_init(&atlas, &usual, &test->gpu, &test->log));
    assert_int_equal(wd_hemisphere_count(atlas.hemisphere), 181);
    assert_int_equal(atlas.columns, 14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_cube_is_seen_as_a_cube, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(a_ball_is_round_from_everywhere, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(parts_come_apart, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(mixed_texels_are_told_apart, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(baking_twice_gives_the_same, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(one_pass_and_two_give_the_same, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(cards_without_depth_show_the_same, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(cards_show_the_cube_from_three_sides_and_above, gpu_setup,
                                        gpu_teardown),
        cmocka_unit_test_setup_teardown(cards_of_wide_plants_lie, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(bad_parameters_are_named, gpu_setup, gpu_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
