#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shared/hash.h"
#include "shared/view_set.h"

static const struct wd_hemisphere layouts[] = {
    {WD_VIEWS_RINGS, 10, 30}, {WD_VIEWS_RINGS, 2, 3},     {WD_VIEWS_OCTAHEDRAL, 12, 0},
    {WD_VIEWS_OCTAHEDRAL, 2, 0}, {WD_VIEWS_EVEN, 9, 0}, {WD_VIEWS_EVEN, 1, 0},
};
enum { LAYOUTS = sizeof layouts / sizeof *layouts, TRIES = 20000 };

static float dot(struct wd_direction a, struct wd_direction b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct wd_direction unit(float x, float y, float z)
{
    float length = sqrtf(x * x + y * y + z * z);
    return (struct wd_direction){x / length, y / length, z / length};
}

/* Evenly spread over the hemisphere. */
static struct wd_direction some_direction(uint32_t i)
{
    float z = wd_hash_unit(wd_hash1(2 * i)), turn = wd_hash_unit(wd_hash1(2 * i + 1)) * 6.2831853f;
    float level = sqrtf(1.0f - z * z);
    return (struct wd_direction){level * cosf(turn), level * sinf(turn), z};
}

static void views_are_counted(void **state)
{
    (void)state;
    assert_int_equal(wd_hemisphere_count((struct wd_hemisphere){WD_VIEWS_RINGS, 10, 30}), 300);
    assert_int_equal(wd_hemisphere_count((struct wd_hemisphere){WD_VIEWS_EVEN, 9, 0}), 181);
    assert_int_equal(wd_hemisphere_count((struct wd_hemisphere){WD_VIEWS_OCTAHEDRAL, 12, 0}), 144);
}

static void directions_are_unit_and_above_the_horizon(void **state)
{
    (void)state;
    for (int k = 0; k < LAYOUTS; k++) {
        for (uint32_t view = 0; view < wd_hemisphere_count(layouts[k]); view++) {
            struct wd_direction d = wd_hemisphere_direction(layouts[k], view);
            assert_float_equal(dot(d, d), 1.0, 1e-5);
            assert_true(d.z >= -1e-6f);
        }
    }
}

/* A view's own direction leads back to it, alone. */
static void a_views_direction_is_its_own(void **state)
{
    (void)state;
    for (int k = 0; k < LAYOUTS; k++) {
        for (uint32_t view = 0; view < wd_hemisphere_count(layouts[k]); view++) {
            struct wd_direction d = wd_hemisphere_direction(layouts[k], view);
            uint32_t nearest = wd_hemisphere_nearest(layouts[k], d);
            assert_true(dot(wd_hemisphere_direction(layouts[k], nearest), d) > 0.99999f);
            struct wd_view_blend blend = wd_hemisphere_blend(layouts[k], d);
            float own = 0.0f;
            for (int i = 0; i < 3; i++)
                if (dot(wd_hemisphere_direction(layouts[k], blend.view[i]), d) > 0.99999f)
                    own += blend.weight[i];
            assert_float_equal(own, 1.0, 2e-3);
        }
    }
}

static void weights_are_shares(void **state)
{
    (void)state;
    for (int k = 0; k < LAYOUTS; k++) {
        for (uint32_t i = 0; i < TRIES; i++) {
            struct wd_view_blend blend = wd_hemisphere_blend(layouts[k], some_direction(i));
            float sum = 0.0f;
            for (int j = 0; j < 3; j++) {
                assert_true(blend.view[j] < wd_hemisphere_count(layouts[k]));
                assert_true(blend.weight[j] >= -1e-6f && blend.weight[j] <= 1.000001f);
                sum += blend.weight[j];
            }
            assert_float_equal(sum, 1.0, 1e-5);
        }
    }
}

/* The mean direction of the three views lies near the asked one. */
static void blends_lie_around_the_direction(void **state)
{
    (void)state;
    static const float least[LAYOUTS] = {0.993f, -1.0f, 0.985f, -1.0f, 0.993f, -1.0f};
    for (int k = 0; k < LAYOUTS; k++) {
        for (uint32_t i = 0; i < TRIES; i++) {
            struct wd_direction d = some_direction(i), mean = {0, 0, 0};
            struct wd_view_blend blend = wd_hemisphere_blend(layouts[k], d);
            for (int j = 0; j < 3; j++) {
                struct wd_direction v = wd_hemisphere_direction(layouts[k], blend.view[j]);
                mean.x += blend.weight[j] * v.x;
                mean.y += blend.weight[j] * v.y;
                mean.z += blend.weight[j] * v.z;
            }
            if (least[k] > 0.0f)
                assert_true(dot(unit(mean.x, mean.y, mean.z), d) > least[k]);
        }
    }
}

static float weight_of(struct wd_view_blend blend, uint32_t view)
{
    float sum = 0.0f;
    for (int i = 0; i < 3; i++)
        sum += blend.view[i] == view ? blend.weight[i] : 0.0f;
    return sum;
}

/* A small step changes weights by no more than a small step does: nothing pops. */
static void weights_are_continuous(void **state)
{
    (void)state;
    const float step = 1e-4f;
    for (int k = 0; k < LAYOUTS; k++) {
        for (uint32_t i = 0; i < TRIES; i++) {
            struct wd_direction d = some_direction(i);
            if (layouts[k].kind == WD_VIEWS_RINGS && d.z > 0.98f)
                continue; /* around the zenith, rings turn fast by nature */
            struct wd_direction next = unit(d.x + step * (wd_hash_unit(wd_hash1(i)) - 0.5f),
                                            d.y + step, d.z);
            struct wd_view_blend from = wd_hemisphere_blend(layouts[k], d);
            struct wd_view_blend to = wd_hemisphere_blend(layouts[k], next);
            for (int j = 0; j < 3; j++)
                assert_float_equal(weight_of(from, from.view[j]), weight_of(to, from.view[j]),
                                   0.01);
        }
    }
}

static void the_nearest_view_is_the_nearest(void **state)
{
    (void)state;
    for (int k = 0; k < LAYOUTS; k++) {
        uint32_t count = wd_hemisphere_count(layouts[k]), wrong = 0;
        for (uint32_t i = 0; i < 2000; i++) {
            struct wd_direction d = some_direction(i);
            float best = -1.0f;
            for (uint32_t view = 0; view < count; view++)
                best = fmaxf(best, dot(wd_hemisphere_direction(layouts[k], view), d));
            uint32_t found = wd_hemisphere_nearest(layouts[k], d);
            float cosine = dot(wd_hemisphere_direction(layouts[k], found), d);
            wrong += cosine < best - 1e-5f;
            assert_true(acosf(fminf(cosine, 1.0f)) - acosf(fminf(best, 1.0f)) < 0.02f);
        }
        assert_true(wrong < 60); /* the lattice's edges, 3% */
    }
}

/* B&N's order is even: no view answers for much more of the sky than another. */
static void even_views_are_evenly_spread(void **state)
{
    (void)state;
    const struct wd_hemisphere even = {WD_VIEWS_EVEN, 9, 0};
    float least = 1.0f;
    for (uint32_t i = 0; i < TRIES; i++) {
        struct wd_direction d = some_direction(i);
        uint32_t view = wd_hemisphere_nearest(even, d);
        least = fminf(least, dot(wd_hemisphere_direction(even, view), d));
    }
    assert_true(acosf(least) < 0.145f); /* 8.3 degrees; 181 hexagons would need 6.5 */
}

static void below_the_horizon_counts_as_the_horizon(void **state)
{
    (void)state;
    for (int k = 0; k < LAYOUTS; k++) {
        struct wd_direction low = {0.6f, 0.64f, -0.48f}, level = unit(0.6f, 0.64f, 0.0f);
        assert_int_equal(wd_hemisphere_nearest(layouts[k], low),
                         wd_hemisphere_nearest(layouts[k], level));
        struct wd_view_blend a = wd_hemisphere_blend(layouts[k], low);
        struct wd_view_blend b = wd_hemisphere_blend(layouts[k], level);
        for (int i = 0; i < 3; i++)
            assert_float_equal(weight_of(b, a.view[i]), weight_of(a, a.view[i]), 1e-3);
        wd_hemisphere_nearest(layouts[k], (struct wd_direction){0.0f, 0.0f, -1.0f});
    }
}

static void pictures_hold_the_whole_cylinder(void **state)
{
    (void)state;
    const struct wd_view_model model = {3.0f, -0.5f, 20.0f, 0};
    for (uint32_t i = 0; i < TRIES; i++) {
        struct wd_view_frame frame = wd_view_frame_of(model, some_direction(i));
        float turn = wd_hash_unit(wd_hash1(i + 7)) * 6.2831853f;
        float share = wd_hash_unit(wd_hash1(i + 9));
        struct wd_view_point p =
            wd_view_project(frame, model.radius_m * cosf(turn), model.radius_m * sinf(turn),
                            model.bottom_m + share * (model.top_m - model.bottom_m));
        assert_true(p.x > -1e-4f && p.x < 1.0001f && p.y > -1e-4f && p.y < 1.0001f);
        assert_true(p.depth > -1e-4f && p.depth < 1.0001f);
    }
    /* seen from the east, south is left, the top is up and the east side is near */
    struct wd_view_frame east = wd_view_frame_of(model, (struct wd_direction){1, 0, 0});
    struct wd_view_point top = wd_view_project(east, 3.0f, -3.0f, 20.0f);
    assert_float_equal(top.x, 0.0, 1e-6);
    assert_float_equal(top.y, 0.0, 1e-6);
    assert_float_equal(top.depth, 1.0, 1e-6);
}

static void tiles_keep_to_themselves(void **state)
{
    (void)state;
    const struct wd_view_atlas atlas = {{WD_VIEWS_EVEN, 9, 0}, 64, 14, 5};
    const struct wd_view_point corner = {1.5f, -0.2f, 0.5f};
    for (uint32_t view = 0; view < 181; view++) {
        struct wd_view_point p = wd_view_texel(atlas, view, corner, 2.0f);
        float texels = 14.0f * 64.0f / 4.0f; /* of the layer at mip 2 */
        assert_float_equal(p.x * texels, (float)(view % 14 * 16) + 15.5f, 1e-3);
        assert_float_equal(p.y * texels, (float)(view / 14 * 16) + 0.5f, 1e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_are_counted),
        cmocka_unit_test(directions_are_unit_and_above_the_horizon),
        cmocka_unit_test(a_views_direction_is_its_own),
        cmocka_unit_test(weights_are_shares),
        cmocka_unit_test(blends_lie_around_the_direction),
        cmocka_unit_test(weights_are_continuous),
        cmocka_unit_test(the_nearest_view_is_the_nearest),
        cmocka_unit_test(even_views_are_evenly_spread),
        cmocka_unit_test(below_the_horizon_counts_as_the_horizon),
        cmocka_unit_test(pictures_hold_the_whole_cylinder),
        cmocka_unit_test(tiles_keep_to_themselves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
