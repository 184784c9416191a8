#include "base/memory.h"
#include "shared/hash.h"
#include "tree/silhouette.h"
#include "tree/thinning.h"
#include "tree_test.h"

static void packed_normals_come_back(void **state)
{
    (void)state;
    for (int i = 0; i < 2000; i++) {
        double z = 1 - (2 * i + 1) / 2000.0, r = sqrt(1 - z * z), a = 2.3999632 * i;
        float n[3] = {(float)(r * cos(a)), (float)(r * sin(a)), (float)z}, back[3];
        wd_unpack_normal(wd_pack_normal(n), back);
        double dot = 0;
        for (int k = 0; k < 3; k++)
            dot += (double)n[k] * (double)back[k];
        assert_true(dot > 0.999999);
    }
}

static void axes_pack_exactly(void **state)
{
    (void)state;
    for (int axis = 0; axis < 6; axis++) {
        float n[3] = {0}, back[3];
        n[axis / 2] = axis & 1 ? -1.0f : 1.0f;
        wd_unpack_normal(wd_pack_normal(n), back);
        for (int k = 0; k < 3; k++)
            assert_float_equal(n[k], back[k], 1e-6f);
    }
}

static void uv_packs_as_halves(void **state)
{
    (void)state;
    assert_int_equal(wd_pack_uv(0, 1), 0x3c000000u);
    assert_int_equal(wd_pack_uv(0.5f, -2), 0xc0003800u);
    assert_int_equal(wd_pack_uv(65504, 1e9f), 0x7bff7bffu);
    assert_int_equal(wd_pack_uv(1e-9f, 0.333251953125f), 0x35550000u);
}

static void mesh_grows_and_knows_its_bounds(void **state)
{
    (void)state;
    struct wd_tree_mesh mesh = {0};
    wd_tree_mesh_update_bounds(&mesh);
    assert_float_equal(mesh.max_m[2], 0, 0);
    for (uint32_t i = 0; i < 5000; i++) {
        struct wd_tree_vertex vertex = {.position_m = {(float)i, -(float)i, 7}};
        assert_int_equal(wd_tree_mesh_add_vertex(&mesh, &vertex), i);
        wd_tree_mesh_add_triangle(&mesh, i, 0, i / 2);
    }
    wd_tree_mesh_update_bounds(&mesh);
    assert_int_equal(mesh.vertex_count, 5000);
    assert_int_equal(mesh.index_count, 15000);
    assert_int_equal(mesh.indices[3 * 4999 + 2], 2499);
    assert_float_equal(mesh.min_m[1], -4999, 0);
    assert_float_equal(mesh.max_m[0], 4999, 0);
    assert_float_equal(mesh.min_m[2], 7, 0);
    wd_tree_mesh_finish(&mesh);
    wd_tree_mesh_finish(&mesh);
}

/* Those of the first `count` leaves of the reduced mesh, as methods draw them where the others are left
 * out; its vertices are `unscaled`. */
static void grow_leaves(struct wd_tree_model *model, const struct wd_tree_vertex *unscaled,
                        uint32_t count, float factor)
{
    const struct wd_leaf_set *set = &model->sets[1][WD_SET_LEAVES];
    uint32_t first = model->reduced.vertex_count - set->leaf_count * set->corner_count;
    for (uint32_t i = 0; i < count * set->corner_count; i++) {
        const struct wd_tree_leaf *leaf = &model->leaves[i / set->corner_count];
        struct wd_vec3 middle = wd_v3_mad(wd_leaf_foot(*leaf, model->leaf_box),
                                          wd_leaf_axes_of(leaf->turn).along,
                                          0.5f * wd_leaf_size_m(*leaf, model->leaf_box));
        const float *p = unscaled[first + i].position_m;
        struct wd_vec3 grown = wd_v3_mix(middle, WD_V3(p[0], p[1], p[2]), factor);
        memcpy(model->reduced.vertices[first + i].position_m, &grown, sizeof grown);
    }
}

enum { TURNS = 5 };

/* Pixels that the wood and the first leaves cover, over several sides. */
static double covered(const struct wd_tree_mesh *mesh, const struct wd_tree_mesh *frame,
                      uint32_t end, float sine)
{
    struct wd_silhouette views[TURNS];
    double sum = 0;
    for (int i = 0; i < TURNS; i++) {
        float turn = 1.1f + 6.2831853f * (float)i / TURNS, level = sqrtf(1 - sine * sine);
        wd_silhouette_init(&views[i], frame, WD_V3(level * cosf(turn), level * sinf(turn), sine));
    }
    wd_silhouette_cover(views, TURNS, mesh, 0, end);
    for (int i = 0; i < TURNS; i++)
        sum += (double)wd_silhouette_count(&views[i]);
    return sum;
}

static void few_leaves_cover_what_all_do_from_each_side(void **state)
{
    (void)state;
    static const float sines[WD_GAIN_SIDES] = {0.07f, 0.7071f, 1};
    struct wd_arena arena = {0};
    struct wd_species oak = test_species(&arena, "oak");
    const struct wd_grow_params params = {.seed = 5, .height_m = 10};
    struct wd_tree_model model;
    assert_true(wd_tree_grow(&model, &oak, &params, NULL));
    wd_tree_thinning_fit(&model);
    const struct wd_leaf_set *set = &model.sets[1][WD_SET_LEAVES];
    size_t bytes = model.reduced.vertex_count * sizeof *model.reduced.vertices;
    struct wd_tree_vertex *unscaled = wd_alloc(bytes);
    memcpy(unscaled, model.reduced.vertices, bytes);
    for (int side = 0; side < WD_GAIN_SIDES; side++) {
        double all = covered(&model.full, &model.full, model.full.index_count, sines[side]);
        for (uint32_t k = 0; k < WD_LEAF_GROWTHS; k += 3) {
            uint32_t count = set->leaf_count >> k;
            float area = sqrtf((float)set->leaf_count / (float)count);
            grow_leaves(&model, unscaled, count, area * model.leaf_growth[1].of[side][k]);
            double few = covered(&model.reduced, &model.full,
                                 model.reduced.wood_index_count + count * set->index_count,
                                 sines[side]);
            print_message("side %d, %u leaves: %+.1f %%\n", side, count, 100 * (few / all - 1));
            assert_true(fabs(few / all - 1) < 0.06); /* one tree, from other sides than were fitted */
        }
    }
    free(unscaled);
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
}

static bool reaches(const struct wd_silhouette *view, const struct wd_tree_vertex corners[3])
{
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        float at[2];
        wd_silhouette_project(view, corners[k].position_m, at);
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = fminf(low[axis], at[axis]);
            high[axis] = fmaxf(high[axis], at[axis]);
        }
    }
    return wd_silhouette_pixel(low[0]) < wd_silhouette_pixel(high[0]) &&
           wd_silhouette_pixel(low[1]) < wd_silhouette_pixel(high[1]);
}

/* Some of the size of pixels, most much smaller. */
static void triangles_that_reach_pixels_are_found(void **state)
{
    enum { TRIANGLES = 5000 };
    struct wd_tree_mesh mesh = {0};
    struct wd_silhouette view;
    uint32_t found[TRIANGLES], expected = 0, at = 0;
    (void)state;
    for (uint32_t i = 0; i < 3 * TRIANGLES; i++) {
        struct wd_tree_vertex vertex = {0};
        for (uint32_t k = 0; k < 3; k++)
            vertex.position_m[k] = 10 * wd_hash_unit(wd_hash2(i / 3, k)) +
                                   (i / 3 % 7 ? 0.02f : 0.3f) * wd_hash_unit(wd_hash2(i, 3 + k));
        wd_tree_mesh_add_vertex(&mesh, &vertex);
        if (i % 3 == 2)
            wd_tree_mesh_add_triangle(&mesh, i - 2, i - 1, i);
    }
    wd_tree_mesh_update_bounds(&mesh);
    wd_silhouette_init(&view, &mesh, WD_V3(0.6f, 0, 0.8f));
    uint32_t count = wd_silhouette_reach(found, &view, &mesh);
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        bool known = at < count && found[at] == i, reaching = reaches(&view, &mesh.vertices[3 * i]);
        assert_true(known || !reaching);
        at += known;
        expected += reaching;
    }
    assert_int_equal(at, count);
    assert_in_range(expected, 500, TRIANGLES / 2);
    assert_in_range(count, expected, expected + 50);
    wd_tree_mesh_finish(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_normals_come_back),
        cmocka_unit_test(axes_pack_exactly),
        cmocka_unit_test(uv_packs_as_halves),
        cmocka_unit_test(mesh_grows_and_knows_its_bounds),
        cmocka_unit_test(few_leaves_cover_what_all_do_from_each_side),
        cmocka_unit_test(triangles_that_reach_pixels_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
