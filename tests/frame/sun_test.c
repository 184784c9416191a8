/* Sun and sky, the field of shadow heights, and the wind: mathematics that C and GLSL share. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "world/sun.h"
#include "shared/air.h"
#include "frame/sun_field.h"
#include "frame/view.h"
#include "shared/hash.h"
#include "shared/turn.h"
#include "shared/waves.h"

static struct wd_frame_uniforms sun_at(double azimuth_deg, double elevation_deg)
{
    struct wd_scene scene = {0};
    struct wd_frame_uniforms uniforms = {0};
    scene.sun.azimuth_deg = azimuth_deg;
    scene.sun.elevation_deg = elevation_deg;
    scene.sun.angular_diameter_deg = 0.53;
    scene.sun.strength = scene.sky.strength = 1;
    scene.sky.turbidity = 2.5;
    wd_sun_fill(&uniforms, &scene, NULL, NULL);
    return uniforms;
}

/* Sun over sky on level ground, in green. */
static float sun_over_sky(double elevation_deg)
{
    struct wd_frame_uniforms u = sun_at(180, elevation_deg);
    return u.sun_irradiance[1] * u.sun_direction[2] / u.sky_irradiance[1];
}

static void test_direction(void **state)
{
    (void)state;
    struct wd_frame_uniforms east = sun_at(90, 30), south = sun_at(180, 0);
    assert_float_equal(east.sun_direction[0], cosf(0.5235988f), 1e-5);
    assert_float_equal(east.sun_direction[1], 0, 1e-5);
    assert_float_equal(east.sun_direction[2], 0.5, 1e-5);
    assert_float_equal(south.sun_direction[1], -1, 1e-5);
}

static void test_sun_and_sky(void **state)
{
    (void)state;
    assert_true(sun_over_sky(60) > 3.2f && sun_over_sky(60) < 5);
    assert_true(sun_over_sky(6) < 1);
    for (int elevation = 2; elevation < 90; elevation += 4)
        assert_true(sun_over_sky(elevation) < sun_over_sky(elevation + 1));
    struct wd_frame_uniforms noon = sun_at(180, 60), evening = sun_at(270, 4);
    assert_true(noon.sky_irradiance[2] > 1.5f * noon.sky_irradiance[0]);
    assert_true(noon.sun_irradiance[2] > 0.6f * noon.sun_irradiance[0]);
    assert_true(evening.sun_irradiance[2] < 0.2f * evening.sun_irradiance[0]);
}

/* Less light with every degree down to the moon, and never none. */
static void test_nightfall(void **state)
{
    (void)state;
    float before = INFINITY;
    for (int elevation = 90; elevation >= -9; elevation--) {
        struct wd_frame_uniforms u = sun_at(270, elevation);
        float light = u.sky_irradiance[1] + fmaxf(u.sun_direction[2], 0) * u.sun_irradiance[1];
        assert_true(light > 0 && light < before);
        before = light;
    }
    struct wd_frame_uniforms night = sun_at(270, -40);
    float moonlight = night.sky_irradiance[1] + night.sun_direction[2] * night.sun_irradiance[1];
    assert_true(moonlight > 1e-7f && moonlight < before);
    assert_true(night.sun_direction[2] > 0 && night.sun_direction[0] > 0); /* across from the sun */
    assert_true(night.sky_irradiance[2] > night.sky_irradiance[0]);
}

/* Irradiance of a wall that faces a unit vector level with the ground: summed up over the sky. */
static float wall_summed(const struct wd_frame_uniforms *frame, float x, float y)
{
    enum { STEPS = 96 };
    double sum = 0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        float rise = ((float)(i / STEPS) + 0.5f) / STEPS, across = sqrtf(1 - rise * rise);
        float turn = ((float)(i % STEPS) + 0.5f) * (6.2831853f / STEPS);
        struct wd_vec3 toward = {across * cosf(turn), across * sinf(turn), rise};
        float facing = toward.x * x + toward.y * y;
        if (facing > 0)
            sum += (double)(facing * wd_sky_toward(frame, toward).y);
    }
    return (float)(sum * 6.2831853 / (STEPS * STEPS));
}

/* Shading's polynomial and the light about the sun keep to the sum on every side of a wall, also that turned
 * from the sun. */
static void test_walls(void **state)
{
    (void)state;
    for (int elevation = 5; elevation <= 75; elevation += 10)
        for (int turn = 0; turn <= 180; turn += 30) {
            struct wd_frame_uniforms u = sun_at(90 - turn, elevation);
            float told = u.sky_form[0][1] + u.sky_form[8][1] + u.sky_form[1][1] +
                         u.circumsolar[1] * fmaxf(u.sun_direction[0], 0);
            float summed = wall_summed(&u, 1, 0);
            /* 0.91 to 1.02; one that the sun grazes, 0.84, has light from about it that is told as the sun's */
            float least = turn == 90 ? 0.82f : 0.9f;
            assert_true(told > least * summed && told < 1.05f * summed);
        }
}

/* The horizon's glow takes up where the sky ends. */
static void test_horizon(void **state)
{
    (void)state;
    struct wd_frame_uniforms u = sun_at(180, 25);
    for (int channel = 0; channel < 3; channel++)
        assert_true(u.sky_horizon[channel] > 0.02f && u.sky_horizon[channel] < 1 &&
                    u.sky_glow[channel] > 0);
}

/* --- shadow heights ------------------------------------------------------------------------- */

enum { SIDE = 48 };

static float terrain_at(const float *height_m, float x, float y)
{
    int i = (int)fminf(fmaxf(x, 0), SIDE - 2), j = (int)fminf(fmaxf(y, 0), SIDE - 2);
    float u = x - i, v = y - j;
    const float *at = height_m + j * SIDE + i;
    float south = at[0] + u * (at[1] - at[0]);
    float north = at[SIDE] + u * (at[SIDE + 1] - at[SIDE]);
    return south + v * (north - south);
}

/* The height below which sample (i, j) is hidden, by marching toward the sun. */
static float marched(const float *height_m, int i, int j, float dx, float dy, float rise,
                     float cell)
{
    float highest = -1e9f;
    for (float way = 1; way < 2 * SIDE; way += 0.05f) {
        float x = i + way * dx, y = j + way * dy;
        if (x < 0 || y < 0 || x > SIDE - 1 || y > SIDE - 1)
            break;
        highest = fmaxf(highest, terrain_at(height_m, x, y) - way * cell * rise);
    }
    return highest;
}

static void test_sun_field(void **state)
{
    (void)state;
    static float height_m[SIDE * SIDE], field[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++)
        height_m[i] = 12 * sinf((i % SIDE) * 0.31f) * cosf((i / SIDE) * 0.23f);
    float sum = 0, worst = 0;
    int count = 0;
    for (int bearing = 0; bearing < 360; bearing += 23) {
        float dx = sinf(bearing * 0.0174533f), dy = cosf(bearing * 0.0174533f);
        wd_sun_field_sweep(field, height_m, SIDE, SIDE, 5, dx, dy, 0.4f);
        for (int j = 10; j < SIDE - 10; j += 3) {
            for (int i = 10; i < SIDE - 10; i += 3) {
                float stray = field[j * SIDE + i] - marched(height_m, i, j, dx, dy, 0.4f, 5);
                sum += fabsf(stray);
                worst = fmaxf(worst, fabsf(stray));
                count++;
            }
        }
    }
    /* mixing between samples blurs the edges of shadows, of a relief of 24 m here */
    assert_true(sum / count < 0.35f);
    assert_true(worst < 2.5f);
}

/* Level ground has all of the sun, however few and large its cells are. */
static void test_sun_field_of_level_ground(void **state)
{
    (void)state;
    enum { MOST = 4 };
    static const float sizes_m[] = {1, 100, 1000, 9000}, rises[] = {0.02f, 0.3f, 1, 6};
    const float level[MOST * MOST] = {0};
    float field[MOST * MOST];
    for (uint32_t side = 2; side <= MOST; side++)
        for (size_t i = 0; i < 16; i++) {
            float cell_m = sizes_m[i / 4] / (float)(side - 1), rise = rises[i % 4];
            wd_sun_field_sweep(field, level, side, side, cell_m, 0.5f, -0.866f, rise);
            for (uint32_t k = 0; k < side * side; k++)
                assert_true(-field[k] >= wd_sun_field_soft_m(cell_m, rise));
        }
}

/* --- wind ------------------------------------------------------------------------------------- */

static void test_wind(void **state)
{
    (void)state;
    const struct wd_wind wind = {8, 0.5f, 0.6f, 0.8f}, calm = {0, 0.5f, 0.6f, 0.8f};
    float along = 0;
    for (uint32_t i = 0; i < 500; i++) {
        const struct wd_wind_tree tree = {i * 3.7f, i * 1.9f, 20, 0.04f, wd_hash1(i)};
        struct wd_wind_shift top = wd_wind_offset(wind, tree, 20, i * 0.37f);
        struct wd_wind_shift next = wd_wind_offset(wind, tree, 20, i * 0.37f + 0.001f);
        struct wd_wind_shift foot = wd_wind_offset(wind, tree, 0, i * 0.37f);
        struct wd_wind_shift still = wd_wind_offset(calm, tree, 20, i * 0.37f);
        assert_true(foot.x_m == 0 && foot.y_m == 0 && foot.z_m == 0);
        assert_true(still.x_m == 0 && still.y_m == 0 && still.z_m == 0);
        float shift = hypotf(top.x_m, top.y_m);
        assert_true(shift < 2 * 20 * 0.04f && top.z_m <= 0 && top.z_m > -shift);
        assert_true(hypotf(next.x_m - top.x_m, next.y_m - top.y_m) < 0.01f);
        struct wd_wind_shift later = wd_wind_offset(wind, tree, 20, i * 0.37f + WD_WIND_PERIOD_S);
        assert_true(hypotf(later.x_m - top.x_m, later.y_m - top.y_m) < 0.01f);
        along += top.x_m * wind.toward_x + top.y_m * wind.toward_y;
    }
    assert_float_equal(along / 500, 0.6 * 0.04 * 0.8 * 20, 0.08); /* the mean tilt, downwind */
    assert_true(wd_wind_begin_s(3999.99) == 0 && wd_wind_begin_s(86400.5) == 84000 && wd_wind_begin_s(-1) == -4000);
}

/* Storms bend trees more than their speed alone, and lay no grass below the ground. */
static void test_storms(void **state)
{
    (void)state;
    assert_float_equal(wd_wind_bend(0.02f, 5), 0.01, 1e-6);
    assert_float_equal(wd_wind_bend(0.02f, 24), 0.02 * pow(2.4, 1.5), 1e-6);
    float before = 0;
    for (float speed_mps = 0; speed_mps <= 60; speed_mps += 0.5f) {
        const struct wd_wind wind = {speed_mps, 1, 1, 0};
        const struct wd_wind_tree blade = {3, 5, 0.5f, 0.3f, 77};
        float bend = wd_wind_bend(0.3f, speed_mps);
        assert_true(bend >= before && bend < 0.6f);
        for (uint32_t i = 0; i < 50; i++)
            assert_true(wd_wind_offset(wind, blade, 0.5f, i * 0.21f).z_m > -0.5f);
        before = bend;
    }
}

/* Waves go on where a new period begins. */
static void test_waves(void **state)
{
    (void)state;
    struct wd_frame_uniforms before = {.wind_speed_mps = 6, .wind_toward = {0.6f, 0.8f}, .time_s = WD_WIND_PERIOD_S};
    struct wd_frame_uniforms after = before;
    after.time_s = 0;
    after.wind_period = 1;
    for (int i = 0; i < 50; i++) {
        struct wd_waves a = wd_waves_at(&before, i * 1.7f, i * -0.9f, 0.01f);
        struct wd_waves b = wd_waves_at(&after, i * 1.7f, i * -0.9f, 0.01f);
        struct wd_vec3 apart = wd_v3_sub(a.normal, b.normal);
        assert_true(wd_v3_dot(apart, apart) < 1e-4f);
        after.wind_period = 250000; /* 1e9 s: no number overflows */
        assert_true(isfinite(wd_waves_at(&after, i * 1.7f, i * -0.9f, 0.01f).normal.z));
        after.wind_period = 1;
    }
}

/* --- cascades --------------------------------------------------------------------------------- */

/* Where a cascade has the place 5 m ahead of `from`. */
static void place_in_cascade(float at[3], const struct wd_view *cascade, const double from_m[3])
{
    const double place_m[3] = {from_m[0], from_m[1] + 5.0, from_m[2]};
    for (int row = 0; row < 3; row++) {
        at[row] = cascade->clip_from_rel[3][row];
        for (int k = 0; k < 3; k++)
            at[row] += cascade->clip_from_rel[k][row] * (float)(place_m[k] - cascade->eye_m[k]);
    }
}

/* An eye that a lens moves finds the same place of the same map, kept ones too. */
static void test_cascades_of_moved_eyes(void **state)
{
    (void)state;
    struct wd_view view, cascades[2][WD_CASCADES];
    struct wd_frame_uniforms uniforms = sun_at(240, 38);
    const struct wd_view_params camera = {
        .camera = {.position_m = {60, 58, 4.4}, .fov_rad = 0.42}, .width = 320, .height = 180,
        .near_m = 0.1f};
    wd_view_init(&view, &camera);
    for (int calm = 0; calm < 2; calm++) {
        for (int i = 0; i < 50; i++) {
            const double eye_m[3] = {60 + 0.1 * i, 58 - 0.07 * i, 4.4 + 0.05 * i};
            struct wd_cascades_params params = {.view = &view, .distance_m = 700, .near_m = 0.1f,
                                                .nearest_m = 2, .size = 2048, .max_z_m = 30,
                                                .max_height_m = 10, .calm_m = calm ? 1e-6 : 0};
            memcpy(params.sun_direction, uniforms.sun_direction, sizeof params.sun_direction);
            wd_cascades_init(cascades[0], &uniforms, &params);
            params.eye_m = eye_m;
            wd_cascades_init(cascades[1], &uniforms, &params);
            for (int c = 0; c < WD_CASCADES; c++) {
                float at[2][3];
                assert_memory_equal(&cascades[0][c].box, &cascades[1][c].box,
                                    sizeof cascades[0][c].box);
                place_in_cascade(at[0], &cascades[0][c], camera.camera.position_m);
                place_in_cascade(at[1], &cascades[1][c], camera.camera.position_m);
                for (int k = 0; k < 3; k++)
                    assert_float_equal(at[0][k], at[1][k], 1e-5);
            }
        }
    }
}

/* What is nearest and farthest moves with every frame of a flight; where slices end seldom does. */
static void test_cascades_that_end_in_steps(void **state)
{
    (void)state;
    struct wd_view view, cascades[WD_CASCADES];
    struct wd_frame_uniforms uniforms = sun_at(240, 38);
    const struct wd_view_params camera = {.camera = {.position_m = {0, 0, 900}, .pitch_rad = -0.7, .fov_rad = 0.02},
                                          .width = 320, .height = 180, .near_m = 0.1f};
    float ends[WD_CASCADES] = {0};
    int changes = 0;
    wd_view_init(&view, &camera);
    for (int i = 0; i < 100; i++) {
        struct wd_cascades_params params = {.view = &view, .distance_m = 5000, .near_m = 0.1f,
                                            .nearest_m = 1380 + 0.05f * (float)i, .farthest_m = 1420 + 0.06f * (float)i,
                                            .size = 1024, .max_z_m = 30, .max_height_m = 20};
        memcpy(params.sun_direction, uniforms.sun_direction, sizeof params.sun_direction);
        wd_cascades_init(cascades, &uniforms, &params);
        assert_true(uniforms.cascades[0][WD_CASCADE_FAR_M] > params.nearest_m);
        assert_true(uniforms.cascades[0][WD_CASCADE_TEXEL_M] < 0.12f);
        for (int c = 0; c < WD_CASCADES; c++) {
            changes += ends[c] != uniforms.cascades[c][WD_CASCADE_FAR_M];
            ends[c] = uniforms.cascades[c][WD_CASCADE_FAR_M];
        }
    }
    assert_true(changes <= 4 * WD_CASCADES);
}

static int by_size(const void *a, const void *b)
{
    return (*(const float *)a > *(const float *)b) - (*(const float *)a < *(const float *)b);
}

/* The widest gap between turns on a circle, over what it would be if all lay evenly. */
static float widest_gap(float *turns, int count)
{
    qsort(turns, (size_t)count, sizeof *turns, by_size);
    float widest = turns[0] + 1 - turns[count - 1];
    for (int i = 1; i < count; i++)
        widest = fmaxf(widest, turns[i] - turns[i - 1]);
    return widest * (float)count;
}

/* Five look-ups of a disc, each the golden angle on, in as many samples: by a golden turn of each sample too there would be
 * eight directions instead of twenty. */
static void test_look_ups_turn(void **state)
{
    (void)state;
    enum { TAPS = 5, SAMPLES = 4, WIDE = 2 };
    double means[4] = {0};
    for (uint32_t y = 0; y < 64; y += WIDE)
        for (uint32_t x = 0; x < 64; x += WIDE) {
            float ring[WIDE * WIDE * SAMPLES], disc[TAPS * SAMPLES];
            for (uint32_t i = 0; i < WIDE * WIDE * SAMPLES; i++) {
                float turn = wd_pixel_turn(x + i % 2, y + i / 2 % 2, i / 4);
                ring[i] = turn - floorf(turn);
                means[(int)(4 * ring[i])]++;
            }
            for (uint32_t i = 0; i < TAPS * SAMPLES; i++) {
                float turn = wd_pixel_turn(x, y, i / TAPS) + 0.381966f * (float)(i % TAPS);
                disc[i] = turn - floorf(turn);
            }
            assert_true(widest_gap(ring, WIDE * WIDE * SAMPLES) < 1.01f);
            assert_true(widest_gap(disc, TAPS * SAMPLES) < 2.5f);
        }
    for (int quarter = 0; quarter < 4; quarter++)
        assert_float_equal(means[quarter], 64 * 64, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_direction), cmocka_unit_test(test_sun_and_sky),
        cmocka_unit_test(test_nightfall), cmocka_unit_test(test_horizon),
        cmocka_unit_test(test_sun_field), cmocka_unit_test(test_sun_field_of_level_ground),
        cmocka_unit_test(test_wind),
        cmocka_unit_test(test_storms),
        cmocka_unit_test(test_waves), cmocka_unit_test(test_walls),
        cmocka_unit_test(test_cascades_of_moved_eyes),
        cmocka_unit_test(test_cascades_that_end_in_steps),
        cmocka_unit_test(test_look_ups_turn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
