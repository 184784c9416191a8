/* Leaves on their way down, as shaders and the path tracer share them. */
#include "made_scene.h"

#include "reference/surface.h"
#include "shared/fall.h"
#include "tree/vec.h"

static const struct wd_model model = {.height_m = 14, .crown_m = 6, .fall_mps = 1};
static const struct wd_tree_pose upright = {.turn_cos = 1, .mirror = 1, .across = 1, .up = 1};
static const struct wd_wind calm = {0, 0, 1, 0}, east = {4, 0, 1, 0};

static struct wd_leaf_fall fall_at(struct wd_wind wind, struct wd_tree_pose pose, uint32_t leaf,
                                   float time_s)
{
    return wd_leaf_fall_of(WD_V3(1, 2, 9), model, pose, wind, wd_hash1(leaf), time_s);
}

static void leaves_come_down_and_in_again(void **state)
{
    (void)state;
    for (uint32_t leaf = 0; leaf < 20; leaf++) {
        float before_m = fall_at(calm, upright, leaf, 0).foot_m.z, jumps = 0;
        assert_float_equal(before_m, 9, 1e-4);
        for (float time_s = 0.1f; time_s < 40; time_s += 0.1f) {
            struct wd_vec3 foot = fall_at(calm, upright, leaf, time_s).foot_m;
            float down_m = before_m - foot.z;
            jumps += down_m < 0;
            assert_true(foot.z >= 0 && foot.z <= model.height_m);
            assert_true(down_m < 0 ? foot.z > 13.8f : down_m > 0.069f && down_m < 0.131f);
            assert_true(fabsf(foot.x - 1) < 0.181f && fabsf(foot.y - 2) < 0.181f);
            before_m = foot.z;
        }
        assert_in_range((int)jumps, 2, 4); /* 40 s at 0.7 to 1.3 m/s through 14 m */
    }
}

static void wind_carries_them_whichever_way_the_tree_is_turned(void **state)
{
    (void)state;
    const struct wd_tree_pose turned = {
        .turn_cos = 0.6f, .turn_sin = 0.8f, .mirror = -1, .across = 2, .up = 1};
    for (uint32_t leaf = 0; leaf < 20; leaf++) {
        struct wd_vec3 a = fall_at(calm, turned, leaf, 3).foot_m;
        struct wd_vec3 b = fall_at(east, turned, leaf, 3).foot_m;
        struct wd_vec3 c = fall_at(calm, upright, leaf, 3).foot_m;
        struct wd_vec3 d = fall_at(east, upright, leaf, 3).foot_m;
        float x = -2 * (b.x - a.x), y = 2 * (b.y - a.y); /* mirrored and widened as the pose does */
        assert_float_equal(0.6f * x - 0.8f * y, d.x - c.x, 1e-4);
        assert_float_equal(0.8f * x + 0.6f * y, 0, 1e-4);
        assert_true(fabsf(d.x - c.x) > 0.01f);
    }
}

static void turning_keeps_lengths_and_angles(void **state)
{
    (void)state;
    for (uint32_t leaf = 0; leaf < 20; leaf++) {
        struct wd_leaf_fall fall = fall_at(east, upright, leaf, 2.5f);
        struct wd_vec3 a = {0.3f, -1, 0.5f}, b = {2, 0.1f, -0.7f};
        struct wd_vec3 ta = wd_leaf_fall_turn(fall, a), tb = wd_leaf_fall_turn(fall, b);
        assert_float_equal(wd_v3_dot(ta, tb), wd_v3_dot(a, b), 1e-4);
        assert_float_equal(wd_v3_length(ta), wd_v3_length(a), 1e-4);
        struct wd_vec3 cross = wd_leaf_fall_turn(fall, wd_v3_cross(a, b));
        assert_float_equal(wd_v3_length(wd_v3_sub(cross, wd_v3_cross(ta, tb))), 0, 1e-4);
    }
}

/* A leaf 0.2 m wide, level at time 0, as its tree's only one. */
static void rays_meet_leaves_where_they_have_come_to(void **state)
{
    (void)state;
    for (int time_s = 0; time_s < 6; time_s++) {
        struct made_scene made;
        struct wd_tree_leaf leaf = {0};
        made_scene_init(&made);
        made_scene_set_look(&made, 128, 128);
        made_scene_add_quad(&made, WD_V3(-0.1f, -0.1f, 0.5f), WD_V3(0.2f, 0, 0), WD_V3(0, 0.2f, 0),
                            WD_VERTEX_LEAF);
        made.model.model.fall_mps = 1;
        made.model.grown.leaves = &leaf;
        made.model.grown.leaf_box.feet.least_m[2] = 0.5f;
        made.model.grown.sets[0][WD_SET_LEAVES] =
            (struct wd_leaf_set){.corner_count = 4, .leaf_count = 1};
        made.frame.time_s = 0.3f * (float)time_s;
        made_scene_add_tree(&made, 3, 5, 1);
        made_scene_build(&made);
        struct wd_leaf_fall fall = wd_leaf_fall_of(
            WD_V3(0, 0, 0.5f), made.model.model, wd_tree_pose_of(made.trees[0], made.model.model),
            calm, wd_hash2(0, wd_tree_random(made.trees[0])), made.frame.time_s);
        struct wd_vec3 normal = wd_leaf_fall_turn(fall, WD_V3(0, 0, 1));
        struct wd_vec3 place = wd_v3_add(WD_V3(3, 5, 1), fall.foot_m);
        const struct wd_trace_ray ray = {wd_v3_mad(place, normal, 2), wd_v3_scale(normal, -1), 9};
        struct wd_trace_hit hit = wd_trace_nearest(&made.traced, &ray);
        assert_float_equal(hit.at_m, 2, 1e-3);
        struct wd_surface surface;
        wd_surface_at(&surface, &made.traced, &ray, &hit, 0);
        assert_float_equal(wd_v3_dot(surface.flat, normal), 1, 1e-3);
        assert_float_equal(wd_v3_dot(surface.outward, normal), 1, 1e-3);
        made_scene_finish(&made);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leaves_come_down_and_in_again),
        cmocka_unit_test(wind_carries_them_whichever_way_the_tree_is_turned),
        cmocka_unit_test(turning_keeps_lengths_and_angles),
        cmocka_unit_test(rays_meet_leaves_where_they_have_come_to),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
