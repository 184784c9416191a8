/* Leaves next to the eye are the twigs that they stand for, others are as the model has them. */
#include "made_scene.h"

#include <math.h>

#include "reference/surface.h"
#include "tree/vec.h"

static const float LEAF_M = 0.5f, TWIG_M = 0.6f, PLAIN_M = 0.65f, EDGE_M = 0.08f; /* heights; within the leaf's rim */

/* A quad of the leaf's twig, in units of the leaf. */
static void make_twig(struct made_scene *made, struct wd_tree_mesh *twig, float wide, float above)
{
    made_scene_add_quad(made, WD_V3(-0.5f * wide, -0.5f * wide, above), WD_V3(wide, 0, 0), WD_V3(0, wide, 0),
                        WD_VERTEX_LEAF);
    *twig = made->model.grown.full;
    made->model.grown.full = (struct wd_tree_mesh){0};
}

/* A leaf 0.2 m wide, level, which stands for a smaller one a little higher; a plain one of `plain` of its width is
 * higher yet. */
static void make_model(struct made_scene *made, struct wd_tree_leaf *leaf, float plain)
{
    const struct wd_leaf_stand stand = {.position_m = {0, 0, LEAF_M},
                                        .axis = {0, 1, 0},
                                        .normal = {0, 0, 1},
                                        .shading = {0, 0, 1},
                                        .size_m = 0.2f,
                                        .tint = 0x80ffffffu};
    struct wd_tree_model *grown = &made->model.grown;
    made_scene_init(made);
    made_scene_set_look(made, 128, 128);
    grown->leaf_box = wd_leaf_box_of(&stand, 1);
    *leaf = wd_leaf_pack(&stand, &grown->leaf_box);
    grown->leaves = leaf;
    grown->leaf_count = 1;
    grown->spray_reach = 1;
    grown->spray_forms = 1;
    grown->sets[0][WD_SET_LEAVES] =
        (struct wd_leaf_set){.corner_count = 4, .index_count = 6, .leaf_count = 1};
    make_twig(made, &grown->spray, 0.5f, 0.5f);
    make_twig(made, &grown->spray_shade, plain, 0.75f);
    made_scene_add_quad(made, WD_V3(-0.1f, -0.1f, LEAF_M), WD_V3(0.2f, 0, 0), WD_V3(0, 0.2f, 0),
                        WD_VERTEX_LEAF);
}

static void finish(struct made_scene *made)
{
    wd_tree_mesh_finish(&made->model.grown.spray);
    wd_tree_mesh_finish(&made->model.grown.spray_shade);
    made_scene_finish(made);
}

/* How high over the foot of a tree a ray from above meets it. */
static float height_at(const struct made_scene *made, const struct wd_tree *tree, float beside_m)
{
    const struct wd_vec3 from = {0.001f * (float)tree->x_mm + beside_m, 0.001f * (float)tree->y_mm,
                                 0.001f * (float)tree->z_mm + 2};
    const struct wd_trace_ray ray = {from, {0, 0, -1}, 9};
    struct wd_trace_hit hit = wd_trace_nearest(&made->traced, &ray);
    if (hit.at_m >= INFINITY)
        return 0;
    struct wd_surface surface;
    wd_surface_at(&surface, &made->traced, &ray, &hit, 0);
    assert_float_equal(surface.flat.z, 1, 1e-3);
    assert_float_equal(surface.outward.z, 1, 1e-2);
    assert_true(surface.albedo.x > 0.2f && surface.transmittance.x == 0);
    return 2 - hit.at_m;
}

static void leaves_by_the_eye_are_twigs(void **state)
{
    (void)state;
    struct made_scene made;
    struct wd_tree_leaf leaf;
    make_model(&made, &leaf, 0.5f);
    made_scene_add_tree(&made, 30, 0, -1);
    made_scene_add_tree(&made, 1, 2, -1);
    made_scene_add_tree(&made, -30, 0, -1);
    made_scene_build(&made);
    assert_int_equal(made.traced.near.count, 1);
    assert_float_equal(height_at(&made, &made.trees[0], 0), LEAF_M, 1e-3);
    assert_float_equal(height_at(&made, &made.trees[0], EDGE_M), LEAF_M, 1e-3);
    assert_float_equal(height_at(&made, &made.trees[1], 0), TWIG_M, 1e-3);
    assert_float_equal(height_at(&made, &made.trees[1], EDGE_M), 0, 0);
    assert_float_equal(height_at(&made, &made.trees[2], 0), LEAF_M, 1e-3);
    finish(&made);
}

/* What a picture does not show is as the model has it, so that what it shows can all be twigs: of trees behind
 * and beside the eye only what throws its shadow ahead of it is. */
static void twigs_are_where_the_picture_shows_them(void **state)
{
    (void)state;
    static const struct {
        struct wd_vec3 sun; /* toward it */
        float behind_m, beside_m;
    } cases[] = {{{0, 0, 1}, LEAF_M, LEAF_M},
                 {{0, -0.97f, 0.243f}, TWIG_M, TWIG_M},
                 {{0, 0.97f, 0.243f}, LEAF_M, LEAF_M},
                 {{0.97f, 0, 0.243f}, LEAF_M, TWIG_M}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct made_scene made;
        struct wd_tree_leaf leaf;
        make_model(&made, &leaf, 0.5f);
        made.frame.sun_direction[0] = cases[i].sun.x;
        made.frame.sun_direction[1] = cases[i].sun.y;
        made.frame.sun_direction[2] = cases[i].sun.z;
        made.frame.sun_irradiance[1] = 1;
        made_scene_add_tree(&made, 0, -2, -0.5);
        made_scene_add_tree(&made, 3, 1, -0.5);
        made_scene_add_tree(&made, 0, 2, -0.5);
        made_scene_build(&made);
        assert_float_equal(height_at(&made, &made.trees[0], 0), cases[i].behind_m, 1e-3);
        assert_float_equal(height_at(&made, &made.trees[1], 0), cases[i].beside_m, 1e-3);
        assert_float_equal(height_at(&made, &made.trees[2], 0), TWIG_M, 1e-3);
        finish(&made);
    }
}

/* Pixels are 0.9 / 32 rad: 2.3 m off half of one is 3 cm wide. */
static void twigs_of_leaves_that_pixels_cannot_show_are_plain(void **state)
{
    (void)state;
    const float wide[2] = {0.25f, 0.1f}, high_m[2] = {TWIG_M, PLAIN_M};
    for (int i = 0; i < 2; i++) {
        struct made_scene made;
        struct wd_tree_leaf leaf;
        make_model(&made, &leaf, wide[i]);
        made_scene_add_tree(&made, 1, 2, -1);
        made_scene_build(&made);
        assert_float_equal(height_at(&made, &made.trees[0], 0), high_m[i], 1e-3);
        finish(&made);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(leaves_by_the_eye_are_twigs),
                                       cmocka_unit_test(twigs_of_leaves_that_pixels_cannot_show_are_plain),
                                       cmocka_unit_test(twigs_are_where_the_picture_shows_them)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
