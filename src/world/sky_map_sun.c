#include "world/sky_map_sun.h"

#include <math.h>

#include "base/dmath.h"

static const float PI = (float)WD_PI;

/* The sun and its glare on film lie within this of the brightest place; beyond, up to the second,
 * is the sky about it. */
static const float SUN_COS = 0.9986295f;    /* 3 degrees */
static const float AROUND_COS = 0.9945219f; /* 6 degrees */
static const float LEAST_SHARE = 0.05f;     /* of the sky's light on level ground */

static float luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

struct wd_vec3 wd_sky_map_direction(const struct wd_sky_map *map, float column, float row)
{
    float bearing = ((column + 0.5f) / (float)map->width - 0.5f + map->turn) * 2 * PI;
    float from_zenith = (row + 0.5f) / (float)map->height * PI, across = sinf(from_zenith);
    return WD_V3(across * sinf(bearing), across * cosf(bearing), cosf(from_zenith));
}

float wd_sky_map_texel_sr(uint32_t width, uint32_t height, uint32_t row)
{
    float from = (float)row / (float)height * PI, to = (float)(row + 1) / (float)height * PI;
    return (cosf(from) - cosf(to)) * 2 * PI / (float)width;
}

/* The brightest texel above the horizon; `*level`: luminance that the upper sky brings to level
 * ground. */
static struct wd_vec3 brightest(const struct wd_sky_map *map, float *level)
{
    uint32_t at[2] = {0, 0};
    float most = -1;
    double sum = 0;
    for (uint32_t j = 0; j < map->height / 2; j++) {
        float rise = cosf(((float)j + 0.5f) / (float)map->height * PI);
        float weight = rise * wd_sky_map_texel_sr(map->width, map->height, j);
        for (uint32_t i = 0; i < map->width; i++) {
            float value = luminance(&map->rgb[3 * ((size_t)j * map->width + i)]);
            sum += (double)(value * weight);
            if (value > most) {
                most = value;
                at[0] = i;
                at[1] = j;
            }
        }
    }
    *level = (float)sum;
    return wd_sky_map_direction(map, (float)at[0], (float)at[1]);
}

/* Calls for each texel within the ring [nearest, farthest] (cosines) of a direction. */
typedef void texel_function(void *user, float *rgb, struct wd_vec3 direction, float sr);

static void each_near(struct wd_sky_map *map, struct wd_vec3 middle, float cos_inner,
                      float cos_outer, texel_function *call, void *user)
{
    for (uint32_t j = 0; j < map->height; j++) {
        float from_zenith = ((float)j + 0.5f) / (float)map->height * PI;
        if (cosf(from_zenith - acosf(middle.z)) < cos_outer)
            continue;
        float sr = wd_sky_map_texel_sr(map->width, map->height, j);
        for (uint32_t i = 0; i < map->width; i++) {
            struct wd_vec3 d = wd_sky_map_direction(map, (float)i, (float)j);
            float cosine = wd_v3_dot(d, middle);
            if (cosine >= cos_outer && cosine < cos_inner)
                call(user, &map->rgb[3 * ((size_t)j * map->width + i)], d, sr);
        }
    }
}

struct sum {
    double rgb[3], sr, toward[3];
    float around[3]; /* radiance of the sky about the sun */
};

static void add_radiance(void *user, float *rgb, struct wd_vec3 direction, float sr)
{
    struct sum *sum = user;
    (void)direction;
    for (int k = 0; k < 3; k++)
        sum->rgb[k] += (double)(rgb[k] * sr);
    sum->sr += (double)sr;
}

static void add_excess(void *user, float *rgb, struct wd_vec3 direction, float sr)
{
    struct sum *sum = user;
    const float toward[3] = {direction.x, direction.y, direction.z};
    float excess[3];
    for (int k = 0; k < 3; k++) {
        excess[k] = fmaxf(rgb[k] - sum->around[k], 0) * sr;
        sum->rgb[k] += (double)excess[k];
    }
    for (int k = 0; k < 3; k++)
        sum->toward[k] += (double)(toward[k] * luminance(excess));
}

static void replace(void *user, float *rgb, struct wd_vec3 direction, float sr)
{
    const struct sum *sum = user;
    (void)direction, (void)sr;
    for (int k = 0; k < 3; k++)
        rgb[k] = fminf(rgb[k], sum->around[k]);
}

void wd_sky_map_take_sun(struct wd_sky_map *map)
{
    float level;
    struct wd_vec3 middle = brightest(map, &level);
    struct sum around = {0}, sun = {0};
    each_near(map, middle, SUN_COS, AROUND_COS, add_radiance, &around);
    for (int k = 0; k < 3 && around.sr > 0; k++)
        sun.around[k] = (float)(around.rgb[k] / around.sr);
    each_near(map, middle, 2, SUN_COS, add_excess, &sun);
    const float irradiance[3] = {(float)sun.rgb[0], (float)sun.rgb[1], (float)sun.rgb[2]};
    /* without surroundings texels are larger than those */
    bool found = around.sr > 0 && luminance(irradiance) * middle.z > LEAST_SHARE * level;
    if (found) {
        each_near(map, middle, 2, SUN_COS, replace, &sun);
        middle = wd_v3_normalize(WD_V3(sun.toward[0], sun.toward[1], sun.toward[2]));
    }
    const float direction[3] = {middle.x, middle.y, middle.z};
    for (int k = 0; k < 3; k++) {
        map->sun_direction[k] = direction[k];
        map->sun_irradiance[k] = found ? irradiance[k] : 0;
    }
}
