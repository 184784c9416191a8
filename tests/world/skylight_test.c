/* The sky summed up for shading: harmonics, quarters and slants against integrals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "world/skylight.h"

static const float PI = 3.14159265f;

static struct wd_vec3 gray(float value)
{
    return WD_V3(value, value, value);
}

static struct wd_vec3 even(const void *user, struct wd_vec3 d)
{
    (void)user, (void)d;
    return WD_V3(1, 2, 3);
}

/* Of the first and second order: the harmonics hold all of it but the horizon's edge. */
static struct wd_vec3 tilted(const void *user, struct wd_vec3 d)
{
    (void)user;
    return gray(1 + 0.5f * d.x + 0.4f * d.z * d.z);
}

static struct wd_vec3 southern(const void *user, struct wd_vec3 d)
{
    (void)user;
    return gray(d.y < 0 ? 1 : 0);
}

static struct wd_vec3 low(const void *user, struct wd_vec3 d)
{
    (void)user;
    return gray(d.z < 0.3f ? 1 : 0);
}

/* As shaders have it (lib/shade.glsl). */
static float harmonics(const struct wd_frame_uniforms *frame, struct wd_vec3 n)
{
    const float forms[9] = {1,         n.x,       n.y,       n.z,                  n.x * n.y,
                            n.y * n.z, n.z * n.z, n.x * n.z, n.x * n.x - n.y * n.y};
    float sum = 0;
    for (int i = 0; i < 9; i++)
        sum += frame->sky_form[i][0] * forms[i];
    return sum;
}

/* Irradiance of a surface by the midpoint rule. */
static float integral(wd_skylight_radiance *radiance, struct wd_vec3 n)
{
    enum { SIDE = 200 };
    double sum = 0;
    for (int i = 0; i < SIDE; i++) {
        for (int j = 0; j < 2 * SIDE; j++) {
            float z = ((float)i + 0.5f) / SIDE, turn = ((float)j + 0.5f) * PI / SIDE;
            float across = sqrtf(1 - z * z);
            struct wd_vec3 d = {across * cosf(turn), across * sinf(turn), z};
            sum += (double)(fmaxf(wd_v3_dot(n, d), 0) * radiance(NULL, d).x);
        }
    }
    return (float)sum * PI / (SIDE * SIDE);
}

static void test_level_ground(void **state)
{
    (void)state;
    struct wd_frame_uniforms frame = {.sun_direction = {0, 0, 1}};
    wd_skylight_fill(&frame, even, NULL);
    for (int k = 0; k < 3; k++)
        assert_float_equal(frame.sky_irradiance[k], PI * (float)(k + 1), 0.01);
    for (int quarter = 0; quarter < 4; quarter++) {
        assert_float_equal(frame.sky_quarters[quarter][1], PI / 2, 0.01);
        assert_float_equal(frame.sky_slant[quarter], 1, 1e-3);
        assert_float_equal(frame.sunward[quarter], 0.25, 1e-6);
    }
}

/* A second-order fit of half a sphere's light is off by some percent of the whole (Ramamoorthi and
 * Hanrahan 2001: 9% at most, 1% in the mean). */
static void test_every_normal(void **state)
{
    (void)state;
    static wd_skylight_radiance *const skies[] = {tilted, southern};
    for (int sky = 0; sky < 2; sky++) {
        struct wd_frame_uniforms frame = {.sun_direction = {0, 0, 1}};
        wd_skylight_fill(&frame, skies[sky], NULL);
        double off = 0, whole = 0;
        for (int i = 0; i < 48; i++) {
            float z = ((float)i + 0.5f) / 24 - 1, turn = 2.4f * (float)i;
            struct wd_vec3 n = {sqrtf(1 - z * z) * cosf(turn), sqrtf(1 - z * z) * sinf(turn), z};
            float wanted = integral(skies[sky], n);
            assert_float_equal(harmonics(&frame, n), wanted, 0.09f * PI);
            off += (double)fabsf(harmonics(&frame, n) - wanted);
            whole += (double)wanted;
        }
        assert_true(off < 0.06 * whole);
    }
}

static void test_quarters(void **state)
{
    (void)state;
    struct wd_frame_uniforms frame = {.sun_direction = {-0.6f, 0, 0.8f}};
    wd_skylight_fill(&frame, southern, NULL);
    assert_float_equal(frame.sky_irradiance[0], PI / 2, 0.01);
    assert_float_equal(frame.sky_quarters[1][0], 0, 1e-6);           /* north */
    assert_float_equal(frame.sky_quarters[3][0], PI / 4, 0.01);      /* south: half */
    assert_float_equal(frame.sky_quarters[0][0], frame.sky_quarters[2][0], 1e-4);
    assert_float_equal(frame.sunward[2], 1, 1e-6);
}

/* Low light meets more leaves than an even sky's: a layer dims it by a higher power. */
static void test_slants(void **state)
{
    (void)state;
    struct wd_frame_uniforms frame = {.sun_direction = {0, 0, 1}};
    wd_skylight_fill(&frame, low, NULL);
    for (int quarter = 0; quarter < 4; quarter++)
        assert_true(frame.sky_slant[quarter] > 1.5f);
}

static struct wd_vec3 bright_south(const void *user, struct wd_vec3 d)
{
    (void)user;
    return gray(0.8f * d.z - 0.6f * d.y > 0.95f ? 11 : 1);
}

/* What is brighter about the sun goes to it, as much as level ground has of it; without a sun all is sky. */
static void test_circumsolar(void **state)
{
    (void)state;
    struct wd_frame_uniforms frame = {.sun_direction = {0, -0.6f, 0.8f}};
    wd_skylight_fill(&frame, bright_south, NULL);
    float whole = frame.sky_irradiance[0], wanted = whole - PI;
    assert_true(wanted > 0.1f && frame.circumsolar[0] == 0);
    for (int k = 0; k < 3; k++)
        frame.sun_irradiance[k] = 1;
    wd_skylight_fill(&frame, bright_south, NULL);
    assert_float_equal(frame.sky_irradiance[0], whole, 1e-4);
    assert_float_equal(frame.circumsolar[0] * 0.8f, wanted, 0.05f * wanted);
    assert_float_equal(harmonics(&frame, WD_V3(0, 0, 1)), PI, 0.02);
    assert_float_equal(frame.sky_quarters[3][0], PI / 4, 0.02);
}

static struct wd_vec3 red_low(const void *user, struct wd_vec3 d)
{
    (void)user;
    return d.z < 0.3f ? WD_V3(2, 1, 1) : WD_V3(1, 1, 1);
}

/* Below a forest level ground gets what it would, upright surfaces less, and less of low light's colour. */
static void test_under_leaves(void **state)
{
    (void)state;
    struct wd_frame_uniforms frame = {.sun_direction = {0, 0, 1}};
    wd_skylight_fill(&frame, even, NULL);
    float(*open)[3] = frame.sky_form, (*under)[3] = frame.sky_under;
    for (int k = 0; k < 3; k++) {
        float level = open[0][k] + open[3][k] + open[6][k];
        assert_float_equal(under[0][k] + under[3][k] + under[6][k], level, 0.001f * level);
        assert_true(under[0][k] + under[8][k] < 0.8f * (open[0][k] + open[8][k]));
        assert_float_equal(frame.sky_under_tint[k], 1, 1e-4);
    }
    wd_skylight_fill(&frame, red_low, NULL);
    assert_true(frame.sky_under_tint[0] < 0.95f);
    assert_float_equal(frame.sky_under_tint[2], 1, 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_level_ground),
        cmocka_unit_test(test_every_normal),
        cmocka_unit_test(test_quarters),
        cmocka_unit_test(test_circumsolar),
        cmocka_unit_test(test_slants),
        cmocka_unit_test(test_under_leaves),
    };
    return cmocka_run_group_tests_name("skylight", tests, NULL, NULL);
}
