/* sky_map.h: an environment map as the sky: radiance by longitude and latitude (shared/sky_map.h), the
 * sun taken out of it, and what light needs of it. */
#ifndef WD_WORLD_SKY_MAP_H
#define WD_WORLD_SKY_MAP_H

#include "scene/scene.h"
#include "world/skylight.h"

/* `{0}`: there is none, the sky is computed. */
struct wd_sky_map {
    uint32_t width, height;
    float *rgb;              /* radiance, rows from the zenith; without the sun if that was found */
    float turn;              /* clockwise, in whole turns */
    enum wd_sky_sun sun;     /* whose sun it is */
    float sun_direction[3];  /* unit; WD_SKY_SUN_FILE: of what is brightest above the horizon */
    float sun_irradiance[3]; /* of what was taken out; 0: there is no sun in the map */
    float horizon[3];        /* mean radiance of the lowest five degrees */
    float means[WD_SKYLIGHT_RINGS][WD_SKYLIGHT_BEARINGS][3]; /* of parts of the upper hemisphere */
    uint32_t columns, rows;  /* of a smaller map, to choose directions by */
    float *shares;           /* chance of each of its texels */
    float *row_ends, *column_ends; /* running sums of rows' chances, and within each row */
};

/* Largest width that is kept; larger maps are halved until they fit. */
#define WD_SKY_MAP_MAX_WIDTH 4096

/* Takes `rgb` (width * height * 3, finite, none below 0; free()d with the map). width is twice the
 * height and even. */
void wd_sky_map_init(struct wd_sky_map *map, float *rgb, uint32_t width, uint32_t height,
                     const struct wd_scene *scene);
void wd_sky_map_finish(struct wd_sky_map *map);

/* Radiance toward a unit direction: bilinear, as samplers do it. */
struct wd_vec3 wd_sky_map_toward(const struct wd_sky_map *map, struct wd_vec3 direction);

/* Mean over the direction's part of the upper hemisphere, for wd_skylight_fill. */
struct wd_vec3 wd_sky_map_mean(const void *map, struct wd_vec3 direction);

/* A direction chosen by brightness from four numbers 0 <= point < 1, and the density, per
 * steradian, with which it and any other direction is chosen. */
struct wd_vec3 wd_sky_map_sample(const struct wd_sky_map *map, const float part[2],
                                 const float within[2]);
float wd_sky_map_density(const struct wd_sky_map *map, struct wd_vec3 direction);

#endif
