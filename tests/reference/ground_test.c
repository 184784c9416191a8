/* The ground as rays meet it, and unfinished pictures on disk. */
#include "made_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "reference/checkpoint.h"
#include "shared/hash.h"
#include "tree/vec.h"

enum { SIDE = 40 };

struct hills {
    struct wd_terrain terrain;
    float heights[SIDE * SIDE];
    uint8_t holes[SIDE * SIDE];
};

static void make_hills(struct hills *hills, int holes)
{
    *hills = (struct hills){0};
    hills->terrain = (struct wd_terrain){.width = SIDE,
                                         .height = SIDE,
                                         .cell_m = 2.5,
                                         .height_m = hills->heights,
                                         .hole = holes ? hills->holes : NULL,
                                         .min_m = 100,
                                         .max_m = 112};
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        hills->heights[i] = 100 + 12 * wd_hash_unit(wd_hash1(i));
}

static float random_in(uint32_t key, float low, float high)
{
    return low + (high - low) * wd_hash_unit(wd_hash1(key));
}

/* Every ray that comes down over the ground ends on it, and not before. */
static void test_hits_lie_on_the_ground(void **state)
{
    (void)state;
    struct hills hills;
    make_hills(&hills, 0);
    RTCDevice device = rtcNewDevice("threads=1");
    const double origin_m[3] = {1000.25, -500, 90};
    struct wd_trace_ground ground;
    wd_trace_ground_init(&ground, device, &hills.terrain, origin_m);
    for (uint32_t i = 0; i < 20000; i++) {
        struct wd_vec3 from = {random_in(7 * i, 5, 90), random_in(7 * i + 1, 5, 90), 115};
        struct wd_vec3 to = {random_in(7 * i + 2, 1, 96), random_in(7 * i + 3, 1, 96), 90};
        if (i % 10 == 0)
            to = WD_V3(from.x, from.y, 90); /* straight down */
        if (i % 10 == 1)
            to.x = from.x = 2.5f * (float)(i % 39); /* along a line of samples */
        struct wd_vec3 d = wd_v3_unit(wd_v3_sub(to, from));
        struct RTCRayHit ray = {.ray = {.org_x = (float)((double)from.x - origin_m[0]),
                                        .org_y = (float)((double)from.y - origin_m[1]),
                                        .org_z = (float)((double)from.z - origin_m[2]),
                                        .dir_x = d.x, .dir_y = d.y, .dir_z = d.z,
                                        .tfar = INFINITY, .mask = UINT32_MAX},
                                .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
        struct RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        struct RTCRay shadow = ray.ray;
        rtcIntersect1(ground.scene, &context, &ray);
        rtcOccluded1(ground.scene, &context, &shadow);
        assert_true(ray.hit.geomID != RTC_INVALID_GEOMETRY_ID);
        assert_true(shadow.tfar < 0);
        double x = (double)(ray.ray.org_x + d.x * ray.ray.tfar) + origin_m[0];
        double y = (double)(ray.ray.org_y + d.y * ray.ray.tfar) + origin_m[1];
        double z = (double)(ray.ray.org_z + d.z * ray.ray.tfar) + origin_m[2];
        assert_true(fabs(z - (double)wd_terrain_height(&hills.terrain, x, y)) < 0.005);
        for (int k = 1; k < 40; k++) { /* nothing of it lies under the ground before */
            double t = (double)ray.ray.tfar * k / 40.5;
            double ground_m = (double)wd_terrain_height(&hills.terrain, (double)from.x + (double)d.x * t,
                                                        (double)from.y + (double)d.y * t);
            assert_true((double)from.z + (double)d.z * t > ground_m - 0.005);
        }
    }
    wd_trace_ground_finish(&ground);
    rtcReleaseDevice(device);
}

static void test_holes(void **state)
{
    (void)state;
    struct hills hills;
    make_hills(&hills, 1);
    hills.holes[20 * SIDE + 20] = 1;
    const uint32_t all[4] = {0, 0, SIDE - 1, SIDE - 1};
    const double down[3] = {0, 0, -1};
    for (uint32_t i = 0; i < 2000; i++) {
        const double from[3] = {random_in(2 * i, 40, 60), random_in(2 * i + 1, 40, 60), 120};
        struct wd_ground_hit hit;
        bool found = wd_trace_ground_hit(&hills.terrain, from, down, all, 0, INFINITY, &hit);
        assert_int_equal(found, wd_terrain_contains(&hills.terrain, from[0], from[1]));
    }
}

static void test_checkpoint(void **state)
{
    (void)state;
    char path[] = "/tmp/weald-checkpoint-XXXXXX";
    close(mkstemp(path));
    struct wd_trace_sums sums, back, other;
    assert_true(wd_trace_sums_init(&sums, 40, 20));
    assert_true(wd_trace_sums_init(&back, 40, 20));
    assert_true(wd_trace_sums_init(&other, 20, 40));
    for (size_t i = 0; i < (size_t)40 * 20 * 3; i++)
        sums.radiance[i] = (float)i * 0.25f;
    for (size_t i = 0; i < 6; i++)
        sums.tile_samples[i] = (uint32_t)i + 3;
    struct wd_log quiet = {0};
    assert_true(wd_checkpoint_write(path, 77, &sums, &quiet));
    assert_true(wd_checkpoint_read(path, 77, &back, &quiet));
    assert_memory_equal(sums.radiance, back.radiance, (size_t)40 * 20 * 3 * sizeof(float));
    assert_memory_equal(sums.tile_samples, back.tile_samples, 6 * sizeof(uint32_t));
    assert_false(wd_checkpoint_read(path, 78, &back, &quiet));
    assert_false(wd_checkpoint_read(path, 77, &other, &quiet));
    FILE *file = fopen(path, "r+");
    assert_true(file && fseek(file, 300, SEEK_SET) == 0 && fputc(0x5a, file) == 0x5a);
    fclose(file);
    assert_false(wd_checkpoint_read(path, 77, &back, &quiet)); /* damaged */
    assert_int_equal(truncate(path, 100), 0);
    assert_false(wd_checkpoint_read(path, 77, &back, &quiet));
    assert_int_equal(truncate(path, 4), 0);
    assert_false(wd_checkpoint_read(path, 77, &back, &quiet));
    unlink(path);
    wd_trace_sums_finish(&sums);
    wd_trace_sums_finish(&back);
    wd_trace_sums_finish(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hits_lie_on_the_ground),
        cmocka_unit_test(test_holes),
        cmocka_unit_test(test_checkpoint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
