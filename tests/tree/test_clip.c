#include "tree_test.h"

#include "tree/clip.h"
#include "tree/random.h"

/* An octahedron: six corners at `radius` from (0, 0, middle). */
struct octahedron {
    float positions_m[18];
    uint32_t indices[24];
};

static struct wd_clip_volume octahedron(struct octahedron *mesh, float radius, float middle)
{
    static const uint32_t faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                       2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    *mesh = (struct octahedron){0};
    for (int i = 0; i < 6; i++) {
        mesh->positions_m[3 * i + i / 2] = i & 1 ? -radius : radius;
        mesh->positions_m[3 * i + 2] += middle;
    }
    memcpy(mesh->indices, faces, sizeof faces);
    return (struct wd_clip_volume){.positions_m = mesh->positions_m, .indices = mesh->indices,
                                   .vertex_count = 6, .triangle_count = 8};
}

static void inside_is_inside(void **state)
{
    (void)state;
    struct octahedron mesh;
    struct wd_clip_volume volume = octahedron(&mesh, 2, 2);
    static struct wd_clip_grid grid;
    assert_true(wd_clip_grid_init(&grid, &volume, NULL));
    assert_float_equal(grid.area_m2, 8, 0.4);
    int wrong = 0, inside = 0;
    for (int i = 0; i < 20000; i++) {
        struct wd_random random = wd_random_of((uint32_t)i, 5);
        struct wd_vec3 p = wd_v3_scale(wd_random_vec3(&random), 2.2f);
        float sum = fabsf(p.x) + fabsf(p.y) + fabsf(p.z);
        p.z += 2;
        inside += wd_clip_inside(&grid, p);
        wrong += fabsf(sum - 2) > 0.12f && wd_clip_inside(&grid, p) != (sum < 2);
    }
    assert_int_equal(wrong, 0);
    assert_true(inside > 1500);
}

/* Leaves reach past the cut by no more than their length; they lie along every face. */
static void check_hedge(const char *name, const struct wd_clip_volume *clip, bool box)
{
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, name);
    struct wd_grow_params params = {.seed = 2, .clip = clip};
    struct wd_tree_model model;
    static struct wd_clip_grid grid;
    assert_true(wd_clip_grid_init(&grid, clip, NULL));
    assert_true(wd_tree_grow(&model, &species, &params, NULL));
    float low[3], high[3], margin = 0.5f * grid.max_m[2];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = grid.min_m[axis] - margin;
        high[axis] = grid.max_m[axis] + margin;
        if (box && axis < 2) { /* it fills what it is cut to */
            assert_true(model.full.min_m[axis] < 0.8f * grid.min_m[axis]);
            assert_true(model.full.max_m[axis] > 0.8f * grid.max_m[axis]);
        }
    }
    uint32_t beyond = 0;
    for (uint32_t i = 0; i < model.full.vertex_count; i++)
        for (int axis = 0; axis < 3; axis++) {
            float p = model.full.vertices[i].position_m[axis];
            assert_true(p >= low[axis] && p <= high[axis]);
            beyond += p > grid.max_m[axis] + 0.12f || (axis < 2 && p < grid.min_m[axis] - 0.12f);
        }
    assert_true(beyond < model.full.vertex_count / 20);
    assert_true(model.full.max_m[2] > (box ? 0.9f : 0.7f) * grid.max_m[2]);
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
}

static void hedges_fill_their_box(void **state)
{
    (void)state;
    struct octahedron mesh;
    struct wd_clip_volume box = {.min_m = {-0.6f, -0.4f, 0.05f}, .max_m = {0.6f, 0.4f, 1.6f}};
    struct wd_clip_volume diamond = octahedron(&mesh, 1.2f, 1.2f);
    static const char *const names[] = {"beech", "hazel", "camellia-red", "maple"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        check_hedge(names[i], &box, true);
        check_hedge(names[i], &diamond, false);
    }
}

static void broken_volumes_are_refused(void **state)
{
    (void)state;
    struct octahedron mesh[4];
    struct wd_clip_volume open = octahedron(&mesh[0], 1, 1), far = octahedron(&mesh[1], 1, 1);
    struct wd_clip_volume broken = octahedron(&mesh[2], 1, 1), sized = octahedron(&mesh[3], 1, 1);
    open.triangle_count = 7;
    mesh[1].indices[5] = 77;
    mesh[2].positions_m[4] = NAN;
    struct wd_clip_volume flat = {.min_m = {-1, -1, 0}, .max_m = {1, -1, 2}};
    struct wd_clip_volume high = {.min_m = {-1, -1, 5}, .max_m = {1, 1, 6}};
    const struct {
        struct wd_grow_params params;
        const char *say;
    } cases[] = {{{.clip = &open}, "not closed"},    {{.clip = &far}, "index 2 of triangle 1"},
                 {{.clip = &broken}, "finite"},      {{.clip = &flat}, "along y"},
                 {{.clip = &high}, "above the foot"},
                 {{.clip = &sized, .height_m = 3}, "one of the two"}};
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "hazel");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct test_log log;
        struct wd_tree_model model;
        test_log_init(&log);
        assert_false(wd_tree_grow(&model, &species, &cases[i].params, &log.log));
        assert_int_equal(log.count, 1);
        if (!strstr(log.message, cases[i].say))
            fail_msg("\"%s\" does not say \"%s\"", log.message, cases[i].say);
        wd_tree_model_finish(&model);
    }
    wd_arena_finish(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inside_is_inside),
        cmocka_unit_test(hedges_fill_their_box),
        cmocka_unit_test(broken_volumes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
