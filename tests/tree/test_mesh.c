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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_normals_come_back),
        cmocka_unit_test(axes_pack_exactly),
        cmocka_unit_test(uv_packs_as_halves),
        cmocka_unit_test(mesh_grows_and_knows_its_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
