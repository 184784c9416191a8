/* A level water: reflection of sky and shores, glint of the sun, and what shows through.
 * Expects `frame`, `push`, the G-buffer, lib/noise.glsl, lib/sky.glsl and lib/view.glsl. */
#include "shared/waves.h"

/* A lake ends where the terrain ends; a sea does not. */
bool water_reaches(vec3 rel)
{
    vec2 local_m = rel.xy + push.camera_m;
    return push.is_sea != 0u || (all(greaterThan(local_m, vec2(0.0)))
                                 && all(lessThan(local_m, push.extent_m)));
}

/* Light of a surface in the picture, roughly: as if most of it stood in the sun. */
vec3 mirrored_surface(ivec2 at)
{
    vec4 albedo = texelFetch(gbuffer_albedo, at, 0);
    vec3 normal = texelFetch(gbuffer_normal, at, 0).xyz * 2.0 - 1.0;
    float facing = 0.25 + 0.5 * max(dot(normal, frame.sun_direction), 0.0);
    vec3 light = frame.sun_irradiance * facing * albedo.a + frame.sky_irradiance * (0.6 * albedo.a);
    return albedo.rgb * light * 0.318309886;
}

/* What a mirrored ray meets in the picture: steps that grow with distance, from 1.5 m to 2 km;
 * w: 1 where it meets something. */
vec4 mirrored_shore(vec3 rel, vec3 mirrored, float noise)
{
    ivec2 met = ivec2(-1);
    float way_m = 1.5 * (0.7 + 0.6 * noise), step_m = way_m;
    vec4 from = frame.clip_from_rel * vec4(rel, 1.0);
    vec4 per_m = frame.clip_from_rel * vec4(mirrored, 0.0);
    for (int i = 0; i < 18; i++) {
        vec4 clip = from + per_m * way_m;
        vec2 screen = (clip.xy / max(clip.w, 1e-3) * 0.5 + 0.5) * vec2(frame.width, frame.height);
        ivec2 at = ivec2(clamp(screen, vec2(0.0), vec2(frame.width, frame.height) - 1.0));
        float axis_m = frame.near_m / max(texelFetch(gbuffer_depth, at, 0).x, 1e-9);
        float behind_m = clip.w - axis_m;
        bool inside = all(bvec3(clip.w > 0.1, equal(vec2(at), floor(screen))));
        bool meets = all(bvec4(met.x < 0, inside, behind_m > 0.0, behind_m < step_m * 2.5 + 8.0));
        met = mix(met, at, bvec2(meets));
        step_m = way_m * 0.5;
        way_m += step_m;
    }
    return met.x < 0 ? vec4(0.0) : vec4(mirrored_surface(met), 1.0);
}

/* `below` is the radiance of what lies under the surface, `depth_m` the way to it in water. */
vec3 water_radiance(vec3 below, vec3 direction, float distance_m, float depth_m, float sun_share,
                    float noise)
{
    float footprint_m = distance_m * 2.0 / (float(frame.height) * max(-direction.z, 0.02));
    wd_waves waves = wd_waves_at(direction.x * distance_m, direction.y * distance_m, footprint_m);
    vec3 normal = waves.normal;
    float hidden = waves.hidden;
    float fresnel = wd_water_fresnel(waves, direction);
    vec3 mirrored = reflect(direction, normal);
    mirrored.z = max(mirrored.z, 0.02);
    vec3 sky = sky_radiance(normalize(mirrored + vec3(0.0, 0.0, 2.0 * hidden)));
    vec4 shore = mirrored_shore(direction * distance_m, normalize(mirrored), noise);
    sky = mix(sky, apply_fog(shore.rgb, direction, distance_m, 1.0), shore.w);
    vec3 through = wd_water_through(depth_m);
    vec3 body = wd_water_body(sun_share);
    vec3 glint = wd_water_glint(waves, direction) * sun_share;
    return mix(mix(body, below, through), sky, fresnel) + glint;
}
