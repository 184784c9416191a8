/* sky_map_sun.h: the sun of an environment map, found and taken out. */
#ifndef WD_WORLD_SKY_MAP_SUN_H
#define WD_WORLD_SKY_MAP_SUN_H

#include "world/sky_map.h"

/* Fills sun_direction and sun_irradiance of a map with its pixels and puts the sky about the sun in
 * the sun's place. What is brightest above the horizon is the sun if it adds more than a
 * twentieth to the sky's light. */
void wd_sky_map_take_sun(struct wd_sky_map *map);

/* Direction of a texel's middle, and the solid angle of a texel of a row. */
struct wd_vec3 wd_sky_map_direction(const struct wd_sky_map *map, float column, float row);
float wd_sky_map_texel_sr(uint32_t width, uint32_t height, uint32_t row);

#endif
