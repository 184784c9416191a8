/* Light as it must be: furnace, sky, transmission, convergence, threads. */
#include "made_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shared/air.h"
#include "tree/vec.h"
#include "world/sun.h"

static void assert_near(float value, float expected, float tolerance)
{
    if (!(fabsf(value - expected) <= tolerance * fabsf(expected) + 1e-7f))
        fail_msg("%g is not within %g%% of %g", (double)value, (double)tolerance * 100,
                 (double)expected);
}

/* A room without its southern wall, 2 m a side, its middle 3 m north of the eye. */
static void add_room(struct made_scene *made, uint32_t kind)
{
    const struct wd_vec3 x = {2, 0, 0}, y = {0, 2, 0}, z = {0, 0, 2};
    made_scene_add_quad(made, WD_V3(-1, -1, -1), x, y, kind);
    made_scene_add_quad(made, WD_V3(-1, -1, 1), x, y, kind);
    made_scene_add_quad(made, WD_V3(-1, -1, -1), y, z, kind);
    made_scene_add_quad(made, WD_V3(1, -1, -1), y, z, kind);
    made_scene_add_quad(made, WD_V3(-1, 1, -1), x, z, kind);
    made_scene_add_tree(made, 0, 3, 0);
}

/* White matter under a white sky cannot be told from the sky. */
static void test_white_furnace(void **state)
{
    (void)state;
    struct made_scene made;
    made_scene_init(&made);
    made_scene_set_look(&made, 255, 0);
    made.tracer.sky = made_sky_white;
    made.tracer.bounces = 100000;
    add_room(&made, 0);
    made_scene_build(&made);
    for (int i = 0; i < 8; i++) {
        struct wd_vec3 seen =
            made_scene_look(&made, WD_V3(0.25f * (float)(i % 3 - 1), 1, 0.06f * (float)i - 0.2f), 64);
        assert_near(seen.x, 1, 1e-4f);
        assert_near(seen.z, 1, 1e-4f);
    }
    made_scene_finish(&made);
}

/* Half of the light reflected, half let through, with the sheen of wax on one side: all of it but
 * what would leave the wax only after a second reflection between its facets. */
static void test_leaf_furnace(void **state)
{
    (void)state;
    struct made_scene made;
    made_scene_init(&made);
    made_scene_set_look(&made, 188, 128);
    made.model.model.transmittance[0] = made.model.model.transmittance[1] =
        made.model.model.transmittance[2] = 10; /* more than is left: what is left is let through */
    made.tracer.sky = made_sky_white;
    made.tracer.bounces = 100000;
    add_room(&made, WD_VERTEX_LEAF);
    made_scene_build(&made);
    for (int i = 0; i < 4; i++) {
        struct wd_vec3 seen = made_scene_look(
            &made, WD_V3(0.2f * (float)(i % 2), 1, 0.15f * (float)i - 0.25f), 2048);
        assert_near(seen.y, 1, 0.025f);
    }
    made_scene_finish(&made);
}

static struct wd_vec3 upper_sky(const struct wd_frame_uniforms *frame, struct wd_vec3 direction)
{
    return direction.z > 0.5f ? made_sky_white(frame, direction) : made_sky_black(frame, direction);
}

/* Level white ground returns what sun and sky bring it, over pi. */
static void test_sky_energy(void **state)
{
    (void)state;
    static const double elevations_deg[] = {60, 25, 8};
    for (size_t i = 0; i < 3; i++) {
        struct made_scene made;
        made_scene_init(&made);
        made_scene_set_look(&made, 255, 0);
        made.scene.sun.elevation_deg = elevations_deg[i];
        made.scene.sun.angular_diameter_deg = 0.53;
        made.scene.sun.strength = made.scene.sky.strength = 1;
        made.scene.sky.turbidity = 3;
        wd_sun_fill(&made.frame, &made.scene, NULL, NULL);
        made.tracer.sky = wd_sky_toward;
        made_scene_add_quad(&made, WD_V3(-9, -9, 0), WD_V3(18, 0, 0), WD_V3(0, 18, 0), 0);
        made_scene_add_tree(&made, 0, 0, -2);
        made_scene_build(&made);
        struct wd_vec3 seen = made_scene_look(&made, WD_V3(0.3f, 0.1f, -1), 16384);
        const float radiance[3] = {seen.x, seen.y, seen.z};
        for (int k = 0; k < 3; k++) {
            float expected = made.frame.sun_irradiance[k] * made.frame.sun_direction[2] +
                             made.frame.sky_irradiance[k];
            assert_near(radiance[k], expected / 3.14159265f, 0.015f);
        }
        made_scene_finish(&made);
    }
}

/* A roof's lower side, which ground about it lights, and the ground: as often as light may be scattered. */
static void test_bounces(void **state)
{
    (void)state;
    struct made_scene made;
    made_scene_init(&made);
    made_scene_set_look(&made, 188, 0);
    made_scene_add_quad(&made, WD_V3(-50, -50, -1), WD_V3(100, 0, 0), WD_V3(0, 100, 0), 0);
    made_scene_add_quad(&made, WD_V3(-1, -1, 1), WD_V3(2, 0, 0), WD_V3(0, 2, 0), 0);
    made_scene_add_tree(&made, 0, 0, 0);
    made_scene_build(&made);
    const struct wd_vec3 roof = {0.1f, 0.2f, 1}, lit = {3, 4, -1};
    for (int sky = 0; sky < 2; sky++) {
        made.tracer.sky = sky ? upper_sky : made_sky_black;
        for (int k = 0; k < 3; k++)
            made.frame.sun_irradiance[k] = sky ? 0 : 2;
        made.tracer.bounces = 1;
        float once = made_scene_look(&made, lit, 256).y;
        assert_true(once > 0.25f);
        assert_true(made_scene_look(&made, roof, 256).y == 0);
        made.tracer.bounces = 2;
        assert_near(made_scene_look(&made, lit, 256).y, once, 0.01f);
        assert_true(made_scene_look(&made, roof, 256).y > 0.05f);
    }
    made_scene_finish(&made);
}

/* The sun through a leaf, seen from below, and on its dull lower side. */
static void test_transmission(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        struct made_scene made;
        made_scene_init(&made);
        made_scene_set_look(&made, 128, 102);
        float albedo = powf((128 / 255.0f + 0.055f) / 1.055f, 2.4f);
        float through = albedo * 0.7f * 2 * 102 / 255;
        for (int k = 0; k < 3; k++) {
            made.model.model.transmittance[k] = 0.7f;
            made.frame.sun_irradiance[k] = 2;
        }
        struct wd_vec3 sun = wd_v3_unit(WD_V3(0.5f, 0.2f, turned ? -1.0f : 1.0f));
        made.frame.sun_direction[0] = sun.x;
        made.frame.sun_direction[1] = sun.y;
        made.frame.sun_direction[2] = sun.z;
        made_scene_add_quad(&made, WD_V3(-5, -5, 0), WD_V3(10, 0, 0), WD_V3(0, 10, 0),
                            WD_VERTEX_LEAF);
        made_scene_add_tree(&made, 0, 0, 2);
        made_scene_build(&made);
        struct wd_vec3 seen = made_scene_look(&made, WD_V3(0.1f, 0.3f, 1), 4096);
        float share = turned ? albedo : through;
        assert_near(seen.y, share * 2 * fabsf(sun.z) / 3.14159265f, 0.004f);
        made_scene_finish(&made);
    }
}

/* The waxed side shows the sun's mirror image, blurred, and nothing else gets brighter. */
static void test_gloss(void **state)
{
    (void)state;
    struct made_scene made;
    made_scene_init(&made);
    made_scene_set_look(&made, 60, 128);
    for (int k = 0; k < 3; k++)
        made.frame.sun_irradiance[k] = 3;
    struct wd_vec3 sun = wd_v3_unit(WD_V3(0, 1, 1));
    made.frame.sun_direction[1] = sun.y;
    made.frame.sun_direction[2] = sun.z;
    made_scene_add_quad(&made, WD_V3(-9, -9, 0), WD_V3(18, 0, 0), WD_V3(0, 18, 0), WD_VERTEX_LEAF);
    made_scene_add_tree(&made, 0, 0, -2);
    made_scene_build(&made);
    struct wd_vec3 mirror = made_scene_look(&made, WD_V3(0, 1, -1), 1024);
    struct wd_vec3 aside = made_scene_look(&made, WD_V3(0, -1, -1), 1024);
    assert_true(mirror.y > 1.5f * aside.y);
    float albedo = powf((60 / 255.0f + 0.055f) / 1.055f, 2.4f);
    assert_true(aside.y < 1.05f * albedo * 3 * sun.z / 3.14159265f);
    made_scene_finish(&made);
}

static void trace(struct made_scene *made, struct wd_trace_sums *sums, uint32_t samples,
                  unsigned threads)
{
    const struct wd_camera camera = {.fov_rad = 0.9};
    struct wd_trace_job job = {.tracer = &made->tracer,
                               .view = wd_trace_view_of(&camera, 48, 32),
                               .threads = threads};
    made->tracer.pixel_rad = wd_trace_pixel_rad(&job.view);
    assert_true(wd_trace_sums_init(sums, 48, 32));
    wd_trace_run(&job, sums, samples);
    assert_int_equal(job.counts.self_hits, 0);
}

static void init_noisy(struct made_scene *made)
{
    made_scene_init(made);
    made_scene_set_look(made, 200, 100);
    made->tracer.sky = made_sky_white;
    add_room(made, WD_VERTEX_LEAF);
    made_scene_build(made);
}

static double rms_error(const struct wd_trace_sums *sums, const struct wd_trace_sums *truth)
{
    size_t count = (size_t)sums->width * sums->height * 3;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double error = (double)sums->radiance[i] / sums->tile_samples[0] -
                       (double)truth->radiance[i] / truth->tile_samples[0];
        sum += error * error;
    }
    return sqrt(sum / (double)count);
}

/* At least as fast as 1 / sqrt(N), toward the same picture. */
static void test_convergence(void **state)
{
    (void)state;
    struct made_scene made;
    struct wd_trace_sums truth, sums;
    double error[3];
    init_noisy(&made);
    trace(&made, &truth, 2048, 0);
    for (int i = 0; i < 3; i++) {
        trace(&made, &sums, 4u << (2 * i), 0);
        error[i] = rms_error(&sums, &truth);
        wd_trace_sums_finish(&sums);
    }
    for (int i = 0; i < 2; i++)
        assert_true(error[i + 1] < 0.55 * error[i] && error[i + 1] > 0.15 * error[i]);
    wd_trace_sums_finish(&truth);
    made_scene_finish(&made);
}

static void test_threads(void **state)
{
    (void)state;
    struct made_scene made;
    struct wd_trace_sums one, other;
    init_noisy(&made);
    trace(&made, &one, 6, 1);
    static const unsigned threads[] = {2, 7};
    for (int i = 0; i < 2; i++) {
        trace(&made, &other, 6, threads[i]);
        assert_memory_equal(one.radiance, other.radiance, (size_t)48 * 32 * 3 * sizeof(float));
        wd_trace_sums_finish(&other);
    }
    wd_trace_sums_finish(&one);
    made_scene_finish(&made);
}

/* Each aligned run of 16 points has one in each of 16 squares, and in each of 16 strips. */
static void test_sampler(void **state)
{
    (void)state;
    for (uint32_t dimension = 0; dimension < 5; dimension++) {
        unsigned squares = 0, strips = 0;
        for (uint32_t i = 32; i < 48; i++) {
            struct wd_sampler sampler = wd_sampler_of(12, 5, 0, i);
            float point[2];
            sampler.dimension = dimension;
            wd_sampler_next(&sampler, point);
            assert_true(point[0] >= 0 && point[0] < 1 && point[1] >= 0 && point[1] < 1);
            squares |= 1u << ((unsigned)(point[0] * 4) * 4 + (unsigned)(point[1] * 4));
            strips |= 1u << (unsigned)(point[1] * 16);
        }
        assert_int_equal(squares, 0xffff);
        assert_int_equal(strips, 0xffff);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_white_furnace), cmocka_unit_test(test_leaf_furnace),
        cmocka_unit_test(test_sky_energy),    cmocka_unit_test(test_bounces),
        cmocka_unit_test(test_transmission),
        cmocka_unit_test(test_gloss),         cmocka_unit_test(test_convergence),
        cmocka_unit_test(test_threads),       cmocka_unit_test(test_sampler),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
