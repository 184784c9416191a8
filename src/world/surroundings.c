#include "world/surroundings.h"

#include <math.h>
#include <string.h>

#include "base/dmath.h"
#include "world/sun.h"

/* Haze scatters blue more than red; the drops of fog, in which one sees less than half a kilometre far, all colours alike. */
static void set_fog_bands(struct wd_frame_uniforms *uniforms, double visibility_m)
{
    static const float haze[3] = {0.80f, 1, 1.34f};
    static const double FOG_M = 500, HAZE_M = 1400;
    float share = (float)fmin(fmax((visibility_m - FOG_M) / (HAZE_M - FOG_M), 0), 1);
    for (int band = 0; band < 3; band++)
        uniforms->fog_bands[band] = 1 + (haze[band] - 1) * share;
}

static void fill_weather(struct wd_frame_uniforms *uniforms, const struct wd_scene *scene)
{
    /* Koschmieder: contrast falls to 2% at the visual range, ln 50 = 3.912. */
    uniforms->fog_per_m = (float)(3.912 / scene->fog.visibility_m);
    uniforms->fog_height_m = (float)scene->fog.height_m;
    uniforms->fog_base_m = (float)scene->fog.base_m;
    set_fog_bands(uniforms, scene->fog.visibility_m);
    uniforms->wind_speed_mps = (float)scene->wind.speed_mps;
    uniforms->wind_gust = (float)scene->wind.gust;
    double from = scene->wind.direction_deg * (WD_PI / 180.0);
    uniforms->wind_toward[0] = (float)-sin(from);
    uniforms->wind_toward[1] = (float)-cos(from);
    uniforms->water_level_m = scene->water.enabled ? (float)scene->water.level_m : -1e9f;
    uniforms->water_clarity_m = (float)scene->water.clarity_m;
    memcpy(uniforms->water_color, scene->water.color, sizeof uniforms->water_color);
}

static void fill_ground(struct wd_frame_uniforms *uniforms, const struct wd_scene *scene,
                        const struct wd_world *world)
{
    const struct wd_terrain *terrain = &world->terrain;
    memcpy(uniforms->grass, scene->ground.grass, sizeof uniforms->grass);
    memcpy(uniforms->soil, scene->ground.soil, sizeof uniforms->soil);
    memcpy(uniforms->rock, scene->ground.rock, sizeof uniforms->rock);
    memcpy(uniforms->litter, scene->ground.litter, sizeof uniforms->litter);
    uniforms->rock_slope = (float)tan(scene->ground.rock_slope_deg * (WD_PI / 180.0));
    uniforms->snow_line_m =
        scene->ground.snow_line_m > 0.0 ? (float)scene->ground.snow_line_m : 1e9f;
    uniforms->tree_line_m =
        scene->ground.tree_line_m > 0.0 ? (float)scene->ground.tree_line_m : 1e9f;
    uniforms->snow = (float)scene->ground.snow;
    memcpy(uniforms->sward, world->far_sward.albedo, sizeof uniforms->sward);
    uniforms->sward_share = world->far_sward.share;
    uniforms->sward_whole_m = world->far_sward.fade_m[0];
    uniforms->sward_gone_m = world->far_sward.fade_m[1];
    uniforms->terrain_cell_m = (float)terrain->cell_m;
    uniforms->terrain_width = terrain->width;
    uniforms->terrain_height = terrain->height;
}

void wd_surroundings_fill(struct wd_frame_uniforms *uniforms, const struct wd_scene *scene,
                          const struct wd_world *world, const struct wd_sun *sun)
{
    fill_weather(uniforms, scene);
    fill_ground(uniforms, scene, world);
    wd_sun_fill(uniforms, scene, sun, world->sky.width ? &world->sky : NULL);
}

void wd_surroundings_set_camera(struct wd_frame_uniforms *uniforms, const double position_m[3])
{
    for (int k = 0; k < 3; k++) {
        double mm = position_m[k] * 1000.0;
        uniforms->camera_mm[k] = (int32_t)floor(mm);
        uniforms->camera_frac_m[k] = (float)((mm - floor(mm)) * 0.001);
    }
}

void wd_camera_axes(const struct wd_camera *camera, double right[3], double forward[3],
                    double up[3])
{
    double sy = sin(camera->yaw_rad), cy = cos(camera->yaw_rad);
    double sp = sin(camera->pitch_rad), cp = cos(camera->pitch_rad);
    const double axes[3][3] = {{cy, -sy, 0.0}, {sy * cp, cy * cp, sp}, {-sy * sp, -cy * sp, cp}};
    memcpy(right, axes[0], sizeof axes[0]);
    memcpy(forward, axes[1], sizeof axes[1]);
    memcpy(up, axes[2], sizeof axes[2]);
}

bool wd_water_is_sea(const struct wd_terrain *terrain, float level_m)
{
    size_t last_row = (size_t)(terrain->height - 1) * terrain->width, under = 0;
    if (level_m <= terrain->min_m)
        return false;
    for (size_t i = 0; i < terrain->width; i++)
        under += (size_t)(terrain->height_m[i] < level_m) +
                 (size_t)(terrain->height_m[last_row + i] < level_m);
    for (size_t row = 0; row < terrain->height; row++)
        under += (size_t)(terrain->height_m[row * terrain->width] < level_m) +
                 (size_t)(terrain->height_m[(row + 1) * terrain->width - 1] < level_m);
    return under > (size_t)terrain->width + terrain->height;
}
