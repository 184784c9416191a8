#include "world/sun.h"

#include <math.h>
#include <string.h>

#include "base/dmath.h"
#include "shared/air.h"
#include "world/skylight.h"

static const float DEGREE = (float)WD_PI / 180.0f;

/* Full moon over sun (Kieffer and Stone 2005: some 1 / 400,000), a little redder in truth, but eyes
 * (and films) expect it blue. Where the sun's twilight has become fainter, the moon takes over. */
static const float MOON_SHARE = 2.5e-6f;
static const float MOON_TINT[3] = {0.75f, 0.95f, 1.25f};
static const float MOON_FROM_ELEVATION_DEG = -9.5f;
static const float MOON_ELEVATION_DEG = 35.0f;

static void set_direction(float direction[3], double azimuth_deg, double elevation_deg)
{
    double azimuth = azimuth_deg * (double)DEGREE, elevation = elevation_deg * (double)DEGREE;
    direction[0] = (float)(sin(azimuth) * cos(elevation));
    direction[1] = (float)(cos(azimuth) * cos(elevation));
    direction[2] = (float)sin(elevation);
}

struct sky {
    struct wd_sky_band band;
    float sun[3];
    float sun_air_mass;
};

static struct wd_vec3 radiance_of(const void *user, struct wd_vec3 direction)
{
    return wd_sky_toward(user, direction);
}

/* Share of the disc over the horizon. */
static float disc_share(float elevation_deg, float radius_deg)
{
    float x = elevation_deg / fmaxf(radius_deg, 0.01f);
    return x <= -1 ? 0 : x >= 1 ? 1 : 0.5f + 0.75f * x - 0.25f * x * x * x;
}

/* Radiance at the horizon is linear in the haze's phase function: what is left at phase 0, and what
 * each unit of it adds. The air's own phase is taken as its mean. */
static void set_horizon(struct wd_frame_uniforms *uniforms, const struct sky *sky, int channel,
                        float strength)
{
    float air_phase = 0.25f / (180.0f * DEGREE), mass = wd_air_mass(0);
    float without = wd_sky_radiance(sky->band, mass, sky->sun_air_mass, air_phase, 0, sky->sun[2]);
    float with = wd_sky_radiance(sky->band, mass, sky->sun_air_mass, air_phase, 1, sky->sun[2]);
    uniforms->sky_horizon[channel] = without * strength;
    uniforms->sky_glow[channel] = (with - without) * strength;
}

/* Light that clouds and fog have mixed: some 6800 K. */
static const float MIXED_TINT[3] = {0.96f, 1.0f, 1.06f};

/* Clouds take the place of sun and sky, and send back what is left of a clear day's light, mixed. */
static void add_clouds(struct wd_frame_uniforms *uniforms, float cover)
{
    static const float weight[3] = {0.2126f, 0.7152f, 0.0722f};
    const float zenith_per_irradiance = 9.0f / (7.0f * 180.0f * DEGREE);
    float clear = 0;
    for (int channel = 0; channel < 3; channel++)
        clear += weight[channel] * (uniforms->sky_irradiance[channel] +
                                    uniforms->sun_irradiance[channel] *
                                        fmaxf(uniforms->sun_direction[2], 0));
    float clouds = clear * fmaxf(wd_cloud_through(cover) - (1 - cover), 0);
    for (int channel = 0; channel < 3; channel++) {
        float own = clouds * MIXED_TINT[channel];
        uniforms->sky_cloud[channel] = own * zenith_per_irradiance;
        uniforms->sun_irradiance[channel] *= 1 - cover;
        uniforms->sky_glow[channel] *= 1 - cover;
        uniforms->sky_horizon[channel] = (1 - cover) * uniforms->sky_horizon[channel] +
                                         uniforms->sky_cloud[channel] * wd_cloud_gradient(0);
    }
    uniforms->sky_strength *= 1 - cover;
    wd_skylight_fill(uniforms, radiance_of, uniforms);
}

/* Haze of this depth straight up is the computed sky's own. */
static const float OF_THE_SKY = 0.4f;

/* Asymmetry of what drops of fog scatter (Hess, Koepke and Schult 1998). */
static const float DROPS_G = 0.85f;

/* Share of the sun's light that comes down through fog, scattered or not (Eddington's approximation). */
static float sun_below_fog(float depth, float rise)
{
    float lit = 0.6667f + rise + (0.6667f - rise) * expf(-depth / fmaxf(rise, 0.01f));
    return lit / (1.3333f + (1 - DROPS_G) * depth);
}

/* Fog over the camera hides sun and sky, and is as bright as what comes down through it; in thin fog, through which
 * the sun shines, as haze before the horizon is. */
static void add_fog(struct wd_frame_uniforms *uniforms)
{
    float camera_m = (float)uniforms->camera_mm[2] * 0.001f, rise = fmaxf(uniforms->sun_direction[2], 0);
    float depth = uniforms->fog_per_m * uniforms->fog_height_m * wd_fog_density(uniforms, camera_m) - OF_THE_SKY;
    if (!(depth > 0))
        return;
    float sun_through = expf(-depth * wd_air_mass(uniforms->sun_direction[2]));
    float sky_below = 1 / (1 + 0.75f * (1 - DROPS_G) * depth);
    for (int channel = 0; channel < 3; channel++) {
        float below = uniforms->sun_irradiance[channel] * rise * sun_below_fog(depth, rise) +
                      uniforms->sky_irradiance[channel] * sky_below;
        uniforms->sky_horizon[channel] = sun_through * uniforms->sky_horizon[channel] +
                                         (1 - sun_through) * MIXED_TINT[channel] * below / (float)WD_PI;
        uniforms->sky_glow[channel] *= sun_through;
        uniforms->sun_irradiance[channel] *= sun_through;
    }
    uniforms->fog_over = depth;
    wd_skylight_fill(uniforms, radiance_of, uniforms);
}

/* The map in place of the computed sky; haze fades into its horizon. */
static void set_map(struct wd_frame_uniforms *uniforms, const struct wd_scene *scene,
                    const struct wd_sky_map *map)
{
    uniforms->sky_is_map = 1;
    uniforms->sky_turn = map->turn;
    uniforms->sky_strength = 0;
    for (int k = 0; k < 3; k++) {
        uniforms->sky_horizon[k] = map->horizon[k];
        uniforms->sky_glow[k] = 0;
    }
    for (int k = 0; k < 3 && map->sun == WD_SKY_SUN_FILE; k++) {
        uniforms->sun_direction[k] = map->sun_direction[k];
        uniforms->sun_irradiance[k] = map->sun_irradiance[k] * (float)scene->sun.strength;
    }
    wd_skylight_fill(uniforms, wd_sky_map_mean, map);
}

struct wd_sun wd_sun_of(const struct wd_scene *scene)
{
    return (struct wd_sun){scene->sun.azimuth_deg, scene->sun.elevation_deg};
}

void wd_sun_fill(struct wd_frame_uniforms *uniforms, const struct wd_scene *scene, const struct wd_sun *at,
                 const struct wd_sky_map *map)
{
    const struct wd_sun sun = at ? *at : wd_sun_of(scene);
    float elevation_deg = (float)sun.elevation_deg;
    double azimuth_deg = sun.azimuth_deg;
    bool moon = elevation_deg < MOON_FROM_ELEVATION_DEG;
    if (moon) {
        elevation_deg = MOON_ELEVATION_DEG;
        azimuth_deg += 180.0;
    }
    float radius_deg = 0.5f * (float)scene->sun.angular_diameter_deg;
    float source = (float)scene->sun.strength * (moon ? MOON_SHARE : 1.0f);
    struct sky sky;
    set_direction(sky.sun, azimuth_deg, elevation_deg);
    sky.sun_air_mass = wd_air_mass(sky.sun[2]);
    memcpy(uniforms->sun_direction, sky.sun, sizeof sky.sun);
    uniforms->sun_cos_radius = cosf(fmaxf(radius_deg, 0.05f) * DEGREE);
    uniforms->sky_turbidity = (float)scene->sky.turbidity;
    uniforms->fog_over = 0;
    uniforms->sky_strength = source * (float)scene->sky.strength;
    for (int channel = 0; channel < 3; channel++) {
        sky.band = wd_sky_band_of(channel, uniforms->sky_turbidity);
        float tint = moon ? MOON_TINT[channel] : 1.0f;
        uniforms->sun_irradiance[channel] = WD_SUN_OUTSIDE * source * tint *
                                            wd_sun_through(sky.band, sky.sun_air_mass) *
                                            disc_share(elevation_deg, radius_deg);
        set_horizon(uniforms, &sky, channel, uniforms->sky_strength);
    }
    if (map) {
        set_map(uniforms, scene, map);
        return;
    }
    wd_skylight_fill(uniforms, radiance_of, uniforms);
    if (scene->sky.cover > 0)
        add_clouds(uniforms, (float)scene->sky.cover);
    if (uniforms->fog_per_m > 0)
        add_fog(uniforms);
}
