/* Water: what its surface mirrors of sky and shores, glint of the sun, and what shows through.
 * Expects `frame`, `push`, the G-buffer, `radiance_image` with all pixels that show no water, and the
 * libraries of noise, sky, view and river. */
#include "shared/waves.h"

/* A lake ends where the terrain ends; a sea does not. */
bool water_reaches(vec3 rel)
{
    vec2 local_m = rel.xy + push.camera_m;
    return push.is_sea != 0u || (all(greaterThan(local_m, vec2(0.0)))
                                 && all(lessThan(local_m, push.extent_m)));
}

/* How far off the eye meets water before what is `distance_m` off; negative: it does not. */
float water_ahead_m(vec3 direction, float distance_m)
{
    float at_m = water_distance(direction);
    if (at_m >= distance_m || !water_reaches(direction * at_m))
        at_m = -1.0;
    if (push.has_rivers == 0u || distance_m >= WD_SKY_M)
        return at_m;
    vec3 end = direction * distance_m;
    float zero_m = float(frame.camera_mm[2]) * 0.001 + frame.camera_frac_m.z;
    float surface_m = river_level(end.xy + push.camera_m) - zero_m;
    if (surface_m <= end.z || surface_m >= 0.0)
        return at_m;
    float share = wd_river_share(end.z, surface_m);
    float nearer_m = river_level(end.xy * share + push.camera_m);
    if (nearer_m > 0.5 * WD_NO_WATER_M)
        share = wd_river_share_between(end.z, surface_m, nearer_m - zero_m);
    return at_m > 0.0 ? min(at_m, distance_m * share) : distance_m * share;
}

/* --- what is mirrored ----------------------------------------------------------------------- */

/* A ray in the picture: place (-1..1) and depth, which is near_m over the distance along the axis and
 * so linear in u, too, from 0 at its beginning to 1, where it leaves the picture or ends. */
struct wd_screen_ray {
    vec3 from, along;
    bool whole; /* it does not leave the picture */
};

const float MIRROR_FAR_M = 2e4;

wd_screen_ray screen_ray(vec3 rel, vec3 direction)
{
    vec4 from = frame.clip_from_rel * vec4(rel, 1.0);
    vec4 per_m = frame.clip_from_rel * vec4(direction, 0.0);
    float far_m = per_m.w < 0.0 ? min(MIRROR_FAR_M, -0.9 * from.w / per_m.w) : MIRROR_FAR_M;
    vec4 to = from + per_m * far_m;
    wd_screen_ray ray;
    ray.from = vec3(from.xy, frame.near_m) / from.w;
    ray.along = vec3(to.xy, frame.near_m) / to.w - ray.from;
    vec2 way = sign(ray.along.xy) * max(abs(ray.along.xy), vec2(1e-6));
    vec2 room = (sign(way) - ray.from.xy) / way;
    float within = min(room.x, room.y);
    ray.whole = within >= 1.0;
    ray.along *= clamp(within, 0.0, 1.0);
    return ray;
}

ivec2 screen_texel(vec3 place)
{
    vec2 size = vec2(frame.width, frame.height);
    return ivec2(clamp((place.xy * 0.5 + 0.5) * size, vec2(0.0), size - 1.0));
}

bool screen_behind(vec3 place)
{
    return texelFetch(gbuffer_depth, screen_texel(place), 0).x > place.z;
}

/* Halves the step in which the ray has gone behind what the picture shows. */
ivec2 screen_meeting(wd_screen_ray ray, float before, float behind)
{
    for (int i = 0; i < 4; i++) {
        float middle = 0.5 * (before + behind);
        bool is_behind = screen_behind(ray.from + ray.along * middle);
        before = is_behind ? before : middle;
        behind = is_behind ? middle : behind;
    }
    return screen_texel(ray.from + ray.along * behind);
}

/* The next pixel: where a ray has met the bed of shallow water, that of the shore. */
ivec2 screen_onward(wd_screen_ray ray, ivec2 from)
{
    vec2 size = vec2(frame.width, frame.height), way = ray.along.xy * size;
    vec2 on = vec2(from) + way / max(length(way), 1e-6);
    return ivec2(clamp(round(on), vec2(0.0), size - 1.0));
}

/* What the eye sees at a pixel, as from the water at `water_m`: the same air lies before both, which is
 * taken off here and comes back with the water's own. w: 0 where water covers it. */
vec4 mirrored_pixel(ivec2 at, vec3 direction, float water_m)
{
    float axis_m = frame.near_m / max(texelFetch(gbuffer_depth, at, 0).x, 1e-9);
    vec3 ray = pixel_ray(at);
    bool covered = water_ahead_m(normalize(ray), length(ray) * axis_m) > 0.0;
    vec4 sum = imageLoad(radiance_image, at);
    vec3 haze = apply_haze(vec3(0.0), direction, water_m, 1.0);
    vec3 through = wd_fog_through(direction, water_m);
    vec3 light = max(sum.rgb / max(sum.a, 1.0) - haze, vec3(0.0)) / max(through, vec3(0.05));
    return vec4(light, covered ? 0.0 : 1.0);
}

/* Where the picture does not tell: woods as high as hides what the water lacks of the sky. Below a
 * horizon at the height h lies sin2 h of the light that comes to level ground. */
vec3 mirrored_unseen(vec3 rel, vec3 mirrored, vec3 sky)
{
    vec4 field = CANOPY_LIGHT_AT(canopy_at(rel.xy + push.camera_m), 0.0);
    vec4 toward = max(vec4(mirrored.x, mirrored.y, -mirrored.x, -mirrored.y), vec4(0.0));
    vec4 share = toward * toward / max(dot(toward, toward), 1e-6);
    float hidden = 1.0 - dot(field * field, share);
    vec3 s = frame.leaf_scatter;
    vec3 light = 0.5 * frame.sun_irradiance * max(frame.sun_direction.z, 0.0) + frame.sky_irradiance;
    vec3 woods = (1.0 - s) / (1.0 + s) * light * 0.318309886;
    float height2 = mirrored.z * mirrored.z;
    return mix(woods, sky, smoothstep(0.7 * hidden, 1.3 * hidden + 1e-4, height2));
}

/* A shore lies so many times as far off as the water that mirrors it; what stands nearer is slender. */
const float FAR_SHORE = 2.0;

/* How far to the left and right of a slender thing what it hides is looked for, in halves of the picture's width. */
const float BESIDE = 0.08;
const int BESIDE_PLACES = 5;

/* Where the ray comes to in the end, or as near beside that as nothing stands before a far shore; `w`: 0 where all of it is
 * hidden, or shows water. */
vec4 mirrored_far(wd_screen_ray ray, vec3 rel, float first_m, vec3 sky)
{
    vec3 end = ray.from + ray.along;
    for (int i = 0; i < BESIDE_PLACES; i++) {
        vec2 beside = vec2(end.x + BESIDE * float((i + 1) / 2) * ((i & 1) == 0 ? 1.0 : -1.0), end.y);
        ivec2 at = screen_texel(vec3(beside, 0.0));
        float shown = texelFetch(gbuffer_depth, at, 0).x;
        if (abs(beside.x) < 1.0 && shown * FAR_SHORE * first_m < frame.near_m)
            return pixel_is_sky(shown) ? vec4(sky, 1.0) : mirrored_pixel(at, normalize(rel), length(rel));
    }
    return vec4(0.0);
}

/* Light that comes to the water at `rel` from `mirrored`; steps through the picture. A ray that has been
 * behind something near all the way has not met it; where it comes out behind a shore that lies beyond the
 * last place at which it was seen to be free, it has met that on the way. */
vec3 mirrored_light(vec3 rel, vec3 mirrored, float noise)
{
    const float STEPS = 20.0;
    vec3 sky = sky_radiance(mirrored);
    wd_screen_ray ray = screen_ray(rel, mirrored);
    bool told = ray.whole;
    float first_m = frame.near_m / ray.from.z, before_m = first_m, free_m = first_m;
    for (float i = 0.0; i < STEPS; i += 1.0) {
        vec3 place = ray.from + ray.along * ((i + noise) / STEPS);
        float shown = texelFetch(gbuffer_depth, screen_texel(place), 0).x;
        float at_m = frame.near_m / max(place.z, 1e-9);
        float behind_m = at_m - frame.near_m / max(shown, 1e-9);
        bool shore = at_m - behind_m > FAR_SHORE * first_m;
        float way_m = at_m - (shore ? free_m : before_m);
        if (behind_m > 0.0 && behind_m < 3.0 + 0.03 * at_m + way_m) {
            ivec2 met = screen_meeting(ray, max(i + noise - 1.0, 0.0) / STEPS, (i + noise) / STEPS);
            vec4 light = mirrored_pixel(met, normalize(rel), length(rel));
            if (light.w == 0.0)
                light = mirrored_pixel(screen_onward(ray, met), normalize(rel), length(rel));
            return mix(sky, light.rgb, light.w);
        }
        told = told && behind_m <= 0.0;
        free_m = behind_m <= 0.0 ? at_m : free_m;
        before_m = at_m;
    }
    if (told)
        return sky;
    vec4 far = ray.whole ? mirrored_far(ray, rel, first_m, sky) : vec4(0.0);
    return mix(mirrored_unseen(rel, mirrored, sky), far.rgb, far.w);
}

/* --- all together --------------------------------------------------------------------------- */

/* So many facets a pixel make its water even, over all its samples; by places of a plane that stay well
 * apart however many they are (Roberts 2018). */
const int FACETS = 9;
const vec2 FACET_STEP = vec2(0.75487767, 0.56984029);

/* `below` is the radiance of what lies under the surface, `depth_m` the way to it in water. */
vec3 water_radiance(uvec2 at, vec3 below, vec3 direction, float distance_m, float depth_m,
                    float sun_share)
{
    vec3 rel = direction * distance_m;
    float pixel_rad = length(pixel_ray(ivec2(0, 1)) - pixel_ray(ivec2(0, 0)));
    wd_waves waves = wd_waves_at(rel.x, rel.y,
                                 wd_water_footprint_m(direction, distance_m, pixel_rad));
    vec3 through = wd_water_through(depth_m);
    vec3 within = mix(wd_water_body(sun_share), below, through), light = vec3(0.0);
    int facets = clamp(FACETS / int(max(frame.sample_count, 1u)), 1, 3);
    vec2 place = vec2(dither(vec2(at)), dither(vec2(at.yx + 17u)));
    for (int i = 0; i < facets; i++) {
        uint salt = frame.sample_index * uint(facets) + uint(i);
        vec2 noise = fract(place + FACET_STEP * float(salt));
        vec3 facet = wd_water_facet(waves, direction, noise.x, noise.y);
        vec3 mirrored = mirrored_light(rel, wd_water_mirrored(facet, direction), noise.y);
        light += mix(within, mirrored, wd_water_fresnel(facet, direction));
    }
    return light / float(facets) + wd_water_glint(waves, direction) * sun_share;
}
