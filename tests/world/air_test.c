/* Haze: contrast falls to 2% at the distance that a scene calls its visibility (Koschmieder 1924). Fog hides sun and sky. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shared/air.h"
#include "world/surroundings.h"

static const float FLAT_TERRAIN_M[4] = {0, 0, 0, 0};

static struct wd_frame_uniforms air_at(double visibility_m, double height_m, double elevation_deg, double camera_m)
{
    struct wd_scene scene = {0};
    struct wd_world world = {0};
    struct wd_frame_uniforms frame = {0};
    world.terrain.width = world.terrain.height = 2;
    world.terrain.height_m = (float *)FLAT_TERRAIN_M;
    scene.fog.visibility_m = visibility_m;
    scene.fog.height_m = height_m;
    scene.sun.elevation_deg = elevation_deg;
    scene.sun.angular_diameter_deg = 0.53;
    scene.sun.strength = scene.sky.strength = 1;
    scene.sky.turbidity = 2.5;
    wd_surroundings_set_camera(&frame, (const double[3]){0, 0, camera_m});
    wd_surroundings_fill(&frame, &scene, &world, NULL);
    return frame;
}

static struct wd_frame_uniforms air_of(double visibility_m, double height_m, double elevation_deg)
{
    return air_at(visibility_m, height_m, elevation_deg, 0);
}

/* Of something black before the horizon, over the horizon's own light; green. */
static float contrast(const struct wd_frame_uniforms *frame, float distance_m)
{
    struct wd_vec3 level = {0, 1, 0};
    struct wd_vec3 horizon = wd_horizon_toward(frame, level, 1);
    struct wd_vec3 black = wd_fog_apply(frame, WD_V3(0, 0, 0), level, distance_m, 1, 1, 1);
    return (horizon.y - black.y) / horizon.y;
}

static void test_visibility(void **state)
{
    (void)state;
    static const double visibilities_m[] = {200, 5000, 30000, 60000};
    for (int i = 0; i < 4; i++) {
        struct wd_frame_uniforms frame = air_of(visibilities_m[i], 1e6, 35);
        float at_m = (float)visibilities_m[i];
        assert_float_equal(contrast(&frame, at_m), 0.02, 0.0005);
        assert_float_equal(contrast(&frame, 0.5f * at_m), sqrtf(0.02f), 0.002);
        assert_float_equal(contrast(&frame, 0), 1, 1e-6);
    }
}

/* Far ridges fade step by step into the horizon, dark ones bluer than it; nothing overshoots. */
static void test_ridges_to_50_km(void **state)
{
    (void)state;
    struct wd_frame_uniforms frame = air_of(40000, 1200, 35);
    struct wd_vec3 level = {0.7071068f, 0.7071068f, 0}, dark = {0.01f, 0.015f, 0.008f};
    struct wd_vec3 horizon = wd_horizon_toward(&frame, level, 1);
    float before = 0;
    for (int km = 1; km <= 50; km++) {
        struct wd_vec3 seen = wd_fog_apply(&frame, dark, level, 1000.0f * (float)km, 1, 1, 1);
        assert_true(seen.y > before && seen.y < horizon.y);
        assert_true(seen.z / seen.x > horizon.z / horizon.x);
        before = seen.y;
    }
    assert_true(before > 0.95f * horizon.y);
}

/* From a mountain over the haze one sees farther, and as far up as down. */
static void test_height(void **state)
{
    (void)state;
    struct wd_frame_uniforms frame = air_of(20000, 800, 35);
    float below = contrast(&frame, 10000);
    frame.camera_mm[2] = 2000 * 1000;
    assert_true(contrast(&frame, 10000) > 2 * below);
    struct wd_vec3 down = {0, 0.9805807f, -0.1961161f}, up = {0, 0.9805807f, 0.1961161f};
    float there = wd_fog_through(&frame, down, 5000).y;
    frame.camera_mm[2] -= (int32_t)(5000 * 1000 * 0.1961161);
    assert_float_equal(wd_fog_through(&frame, up, 5000).y, there, 1e-4);
}

/* Haze between the camera and what it sees, metres of air at full density, in many short steps. */
static double summed_path_m(double eye_m, double direction_z, double length_m, double height_m)
{
    enum { STEPS = 200000 };
    double sum_m = 0;
    for (int i = 0; i < STEPS; i++) {
        double z_m = eye_m + direction_z * length_m * (i + 0.5) / STEPS;
        sum_m += exp(-z_m / height_m) * length_m / STEPS;
    }
    return sum_m;
}

/* From far over the haze all of it lies before the ground; up from the ground it is as much. */
static void test_far_over_the_haze(void **state)
{
    (void)state;
    static const double heights[] = {0.5, 7, 10, 12, 20, 40};
    const double height_m = 1200, sine = 0.8;
    struct wd_frame_uniforms frame = air_of(30000, height_m, 35);
    struct wd_vec3 down = {0, 0.6f, -0.8f}, up = {0, 0.6f, 0.8f};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        double eye_m = heights[i] * height_m, length_m = eye_m / sine;
        double summed_m = summed_path_m(eye_m, -sine, length_m, height_m);
        frame.camera_mm[2] = (int32_t)(eye_m * 1000);
        assert_float_equal(wd_fog_path_m(&frame, down, (float)length_m), summed_m, 1e-3 * summed_m);
        double above_m = summed_path_m(eye_m, -sine, 0.5 * length_m, height_m);
        assert_float_equal(wd_fog_path_m(&frame, down, (float)(0.5 * length_m)), above_m,
                           1e-3 * above_m + 1e-3);
        frame.camera_mm[2] = 0;
        assert_float_equal(wd_fog_path_m(&frame, up, (float)length_m), summed_m, 1e-3 * summed_m);
    }
}

/* Night: whatever the sun's depth, light is finite, above nothing, and far below day's. */
static void test_night(void **state)
{
    (void)state;
    for (int elevation = 5; elevation >= -90; elevation--) {
        struct wd_frame_uniforms frame = air_of(30000, 1200, elevation);
        for (int i = 0; i < 64; i++) {
            float z = (float)(i % 8) / 8, turn = 0.8f * (float)i;
            struct wd_vec3 d = {sqrtf(1 - z * z) * cosf(turn), sqrtf(1 - z * z) * sinf(turn), z};
            struct wd_vec3 sky = wd_sky_toward(&frame, d);
            struct wd_vec3 far = wd_fog_apply(&frame, sky, d, 20000, 1, 1, 1);
            assert_true(isfinite(sky.x + sky.y + sky.z + far.x + far.y + far.z));
            assert_true(sky.x > 0 && sky.y > 0 && sky.z > 0 && far.x > 0 && far.z > 0);
            if (elevation < -9)
                assert_true(sky.y < 1e-4f);
        }
    }
}

/* On level ground; of the sun and the sky, green. */
static float light_below(const struct wd_frame_uniforms *frame)
{
    return frame->sky_irradiance[1] + frame->sun_irradiance[1] * frame->sun_direction[2];
}

/* Haze that a sky holds itself changes nothing; through thin fog the sun shines, dimmed by Beer's law; thick fog is the
 * same on all sides, without a sun, and lets through what Eddington's approximation says. */
static void test_fog_hides_sun_and_sky(void **state)
{
    (void)state;
    const double height_m = 100, elevation_deg = 40;
    struct wd_frame_uniforms clear = air_of(30000, height_m, elevation_deg);
    assert_float_equal(clear.fog_over, 0, 0);
    struct wd_frame_uniforms thin = air_of(3.912 * height_m / 0.9, height_m, elevation_deg);
    assert_float_equal(thin.fog_over, 0.5, 1e-4);
    assert_float_equal(thin.sun_irradiance[1] / clear.sun_irradiance[1], expf(-0.5f * wd_air_mass(clear.sun_direction[2])),
                       1e-4);
    struct wd_vec3 away = {-clear.sun_direction[0], -clear.sun_direction[1], clear.sun_direction[2]};
    assert_true(wd_sky_toward(&thin, away).y > 1.2f * wd_sky_toward(&clear, away).y);
    assert_true(light_below(&thin) > 0.8f * light_below(&clear) && light_below(&thin) < light_below(&clear));
    struct wd_frame_uniforms thick = air_of(3.912 * height_m / 20.4, height_m, elevation_deg);
    struct wd_vec3 up = {0, 0, 1}, level = {1, 0, 0};
    float rise = clear.sun_direction[2], sun = (0.6667f + rise) / (1.3333f + 0.15f * 20), sky = 1 / (1 + 0.1125f * 20);
    float wanted = clear.sky_irradiance[1] * sky + clear.sun_irradiance[1] * rise * sun;
    assert_float_equal(light_below(&thick) / wanted, 1, 0.02);
    assert_float_equal(wd_sky_toward(&thick, up).y / wd_sky_toward(&thick, level).y, 1, 1e-3);
    assert_true(thick.sun_irradiance[1] < 1e-9f * clear.sun_irradiance[1]);
}

/* Light and sky over the fog are those of a clear day; on the way up they become so step by step. */
static void test_above_the_fog(void **state)
{
    (void)state;
    struct wd_frame_uniforms clear = air_at(1e7, 60, 30, 0), over = air_at(150, 60, 30, 400);
    struct wd_vec3 up = {0, 0, 1};
    assert_float_equal(over.fog_over, 0, 0);
    assert_float_equal(wd_sky_toward(&over, up).y, wd_sky_toward(&clear, up).y, 0);
    float before = 0;
    for (int z_m = 0; z_m < 80; z_m++) {
        struct wd_frame_uniforms frame = air_at(150, 60, 30, z_m);
        assert_true(frame.sun_irradiance[1] > before);
        before = frame.sun_irradiance[1];
    }
    assert_float_equal(before / clear.sun_irradiance[1], 1, 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_visibility),
        cmocka_unit_test(test_ridges_to_50_km),
        cmocka_unit_test(test_height),
        cmocka_unit_test(test_far_over_the_haze),
        cmocka_unit_test(test_night),
        cmocka_unit_test(test_fog_hides_sun_and_sky),
        cmocka_unit_test(test_above_the_fog),
    };
    return cmocka_run_group_tests_name("air", tests, NULL, NULL);
}
