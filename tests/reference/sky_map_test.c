/* Environment maps as light: furnace, known gradients, turns, the sun in the map, chosen directions. */
#include "made_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/air.h"
#include "tree/vec.h"
#include "world/sky_map_sun.h"
#include "world/sun.h"

static const float PI = 3.14159265f;

static void assert_near(float value, float expected, float tolerance)
{
    if (!(fabsf(value - expected) <= tolerance))
        fail_msg("%g is not within %g of %g", (double)value, (double)tolerance, (double)expected);
}

typedef float radiance_function(struct wd_vec3 direction);

static float one(struct wd_vec3 direction)
{
    (void)direction;
    return 1;
}

static float upward(struct wd_vec3 direction)
{
    return fmaxf(direction.z, 0);
}

static float eastern(struct wd_vec3 direction)
{
    return direction.x > 0 ? 1 : 0;
}

/* A disc of 1.5 degrees south-east, 30 degrees up, in an even sky. */
static float sunny(struct wd_vec3 direction)
{
    struct wd_vec3 sun = {0.8660254f * 0.70710678f, -0.8660254f * 0.70710678f, 0.5f};
    return wd_v3_dot(direction, sun) > 0.99966f ? 2000 : 0.5f;
}

static void map_of(struct wd_sky_map *map, radiance_function *radiance, uint32_t width,
                   const struct wd_scene *scene)
{
    struct wd_sky_map bare = {.width = width, .height = width / 2};
    float *rgb = wd_alloc_array((size_t)width * bare.height, 3 * sizeof *rgb);
    for (uint32_t at = 0; at < width * bare.height; at++) {
        struct wd_vec3 d =
            wd_sky_map_direction(&bare, (float)(at % width), (float)(at / width));
        for (size_t k = 0; k < 3; k++)
            rgb[3 * at + k] = radiance(d);
    }
    wd_sky_map_init(map, rgb, width, bare.height, scene);
}

static struct wd_scene scene_of(int sun, double turn_deg)
{
    struct wd_scene scene = {0};
    scene.sky.strength = scene.sun.strength = 1;
    scene.sky.sun = sun;
    scene.sky.turn_deg = turn_deg;
    scene.sky.turbidity = 2.5;
    scene.sun.angular_diameter_deg = 0.53;
    return scene;
}

/* What white matter under the map looks like: level, seen from above, or a room open to the south. */
static struct wd_vec3 seen_under(const struct wd_sky_map *map, const struct wd_scene *scene,
                                 bool room, bool glossy, uint32_t samples)
{
    struct made_scene made;
    made_scene_init(&made);
    made_scene_set_look(&made, glossy ? 188 : 255, glossy ? 128 : 0);
    for (int k = 0; k < 3 && glossy; k++)
        made.model.model.transmittance[k] = 10; /* all that is not reflected is let through */
    wd_sun_fill(&made.frame, scene, NULL, map);
    made.tracer.sky_map = map;
    made.tracer.bounces = 100000;
    struct wd_vec3 toward = {0.3f, 0.1f, -1};
    if (room) {
        const struct wd_vec3 x = {2, 0, 0}, y = {0, 2, 0}, z = {0, 0, 2};
        uint32_t kind = glossy ? WD_VERTEX_LEAF : 0;
        made_scene_add_quad(&made, WD_V3(-1, -1, -1), x, y, kind);
        made_scene_add_quad(&made, WD_V3(-1, -1, 1), x, y, kind);
        made_scene_add_quad(&made, WD_V3(-1, -1, -1), y, z, kind);
        made_scene_add_quad(&made, WD_V3(1, -1, -1), y, z, kind);
        made_scene_add_quad(&made, WD_V3(-1, 1, -1), x, z, kind);
        made_scene_add_tree(&made, 0, 3, 0);
        toward = WD_V3(0.1f, 1, 0.07f);
    } else {
        made_scene_add_quad(&made, WD_V3(-9, -9, 0), WD_V3(18, 0, 0), WD_V3(0, 18, 0), 0);
        made_scene_add_tree(&made, 0, 0, -2);
    }
    made_scene_build(&made);
    struct wd_vec3 seen = made_scene_look(&made, toward, samples);
    made_scene_finish(&made);
    return seen;
}

static void test_white_furnace(void **state)
{
    (void)state;
    struct wd_scene scene = scene_of(WD_SKY_SUN_FILE, 0);
    struct wd_sky_map map;
    map_of(&map, one, 64, &scene);
    assert_near(map.sun_irradiance[1], 0, 0); /* an even sky has no sun */
    assert_near(seen_under(&map, &scene, false, false, 4096).x, 1, 0.004f);
    assert_near(seen_under(&map, &scene, true, false, 2048).y, 1, 0.02f);
    wd_sky_map_finish(&map);
}

/* Skylight as it is drawn and as it is traced, and both as the integral has it: 2 pi / 3. */
static void test_gradient(void **state)
{
    (void)state;
    struct wd_scene scene = scene_of(WD_SKY_SUN_SCENE, 0);
    struct wd_frame_uniforms frame = {0};
    struct wd_sky_map map;
    map_of(&map, upward, 256, &scene);
    wd_sun_fill(&frame, &scene, NULL, &map);
    assert_near(frame.sky_irradiance[1], 2 * PI / 3, 0.005f);
    assert_near(seen_under(&map, &scene, false, false, 16384).y +
                    -frame.sun_irradiance[1] * frame.sun_direction[2] / PI,
                2 / 3.0f, 0.006f);
    wd_sky_map_finish(&map);
}

/* Light of the east comes from the south once the map is turned clockwise by 90 degrees. */
static void test_turn(void **state)
{
    (void)state;
    for (int quarters = 0; quarters < 4; quarters++) {
        static const int quarter_of[4] = {0, 3, 2, 1}; /* E, S, W, N among E, N, W, S */
        struct wd_scene scene = scene_of(WD_SKY_SUN_SCENE, 90.0 * quarters);
        struct wd_frame_uniforms frame = {0};
        struct wd_sky_map map;
        map_of(&map, eastern, 128, &scene);
        wd_sun_fill(&frame, &scene, NULL, &map);
        for (int k = 0; k < 4; k++)
            assert_true(k == quarter_of[quarters] ||
                        frame.sky_quarters[k][0] < frame.sky_quarters[quarter_of[quarters]][0]);
        assert_near(frame.sky_irradiance[0], PI / 2, 0.03f);
        wd_sky_map_finish(&map);
    }
}

static void test_sun_of_the_map(void **state)
{
    (void)state;
    struct wd_scene scene = scene_of(WD_SKY_SUN_FILE, 90);
    struct wd_frame_uniforms frame = {0};
    struct wd_sky_map map;
    map_of(&map, sunny, 1024, &scene);
    wd_sun_fill(&frame, &scene, NULL, &map);
    /* turned from south-east to south-west */
    assert_near(frame.sun_direction[0], -0.612372f, 0.004f);
    assert_near(frame.sun_direction[1], -0.612372f, 0.004f);
    assert_near(frame.sun_direction[2], 0.5f, 0.004f);
    float disc = 1999.5f * 2 * PI * (1 - 0.99966f);
    assert_near(frame.sun_irradiance[1], disc, 0.06f * disc);
    assert_near(frame.sky_irradiance[1], 0.5f * PI, 0.01f);
    struct wd_vec3 seen = seen_under(&map, &scene, false, false, 4096);
    float expected = frame.sun_irradiance[1] * 0.5f / PI + 0.5f;
    assert_near(seen.y, expected, 0.02f * expected);
    /* the same light where the map keeps it */
    scene.sky.sun = WD_SKY_SUN_SCENE;
    scene.sun.strength = 0;
    struct wd_sky_map whole;
    map_of(&whole, sunny, 1024, &scene);
    assert_near(seen_under(&whole, &scene, false, false, 16384).y, expected, 0.04f * expected);
    wd_sky_map_finish(&whole);
    wd_sky_map_finish(&map);
}

/* Chosen directions are as dense as told, and all densities sum to 1. */
static void test_chosen_directions(void **state)
{
    (void)state;
    struct wd_scene scene = scene_of(WD_SKY_SUN_SCENE, 30);
    struct wd_sky_map map;
    map_of(&map, sunny, 128, &scene);
    enum { POINTS = 60000 };
    double sphere = 0, disc = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        struct wd_sampler sampler = wd_sampler_of(1, 2, 0, i);
        float part[2], within[2];
        wd_sampler_next(&sampler, part);
        wd_sampler_next(&sampler, within);
        struct wd_vec3 d = wd_sky_map_sample(&map, part, within);
        assert_near(wd_v3_dot(d, d), 1, 1e-4f);
        double density = (double)wd_sky_map_density(&map, d);
        assert_true(density > 0);
        sphere += 1 / density / POINTS;
        disc += density > 1 ? 1.0 / POINTS : 0;
    }
    assert_near((float)sphere, 4 * PI, 0.02f * 4 * PI);
    assert_true(disc > 0.5); /* most choices fall where most light is */
    wd_sky_map_finish(&map);
}

/* Leaves, whose upper sides shine: white under a white sky, as without a map (path_test.c). */
static void test_leaf_furnace(void **state)
{
    (void)state;
    struct wd_scene scene = scene_of(WD_SKY_SUN_FILE, 0);
    struct wd_sky_map map;
    map_of(&map, one, 16, &scene);
    assert_near(seen_under(&map, &scene, true, true, 4096).y, 1, 0.03f);
    wd_sky_map_finish(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_white_furnace),  cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_turn),           cmocka_unit_test(test_sun_of_the_map),
        cmocka_unit_test(test_chosen_directions), cmocka_unit_test(test_leaf_furnace),
    };
    return cmocka_run_group_tests_name("sky map", tests, NULL, NULL);
}
