/* A level water: reflection of sky and shores, glint of the sun, and what shows through.
 * Expects `frame`, `push`, the G-buffer, lib/noise.glsl, lib/sky.glsl and lib/view.glsl. */

/* Slopes of the waves that a pixel resolves; `hidden` is the variance of those it does not (Cox and
 * Munk 1954: 0.003 + 0.00512 wind speed in all). Waves travel with the wind. */
vec2 water_slope(vec2 rel, float footprint_m, out float hidden)
{
    float variance = min(0.0015 + 0.0020 * frame.wind_speed_mps, 0.03);
    vec2 drift = frame.wind_toward * frame.time_s;
    vec2 slope = vec2(0.0);
    hidden = variance;
    float share = noise_share(footprint_m, 12);
    if (share > 0.0) {
        slope += gradient_noise(lattice_at(rel - drift * 1.6, 12), 21u).yz * share;
        hidden -= 0.4 * variance * share;
    }
    share = noise_share(footprint_m, 10);
    if (share > 0.0) {
        slope += gradient_noise(lattice_at(rel - drift * 1.0, 10), 22u).yz * share;
        slope += gradient_noise(lattice_at(rel.yx + drift.yx * 0.3, 9), 23u).zy * share * 0.7;
        hidden -= 0.5 * variance * share;
    }
    return slope * sqrt(variance) * 0.7;
}

/* Sun in a surface of Gaussian slopes. */
vec3 water_glint(vec3 normal, vec3 direction, float variance)
{
    vec3 half_way = normalize(frame.sun_direction - direction);
    float cosine = max(dot(half_way, normal), 1e-3);
    float cosine2 = cosine * cosine;
    float tangent2 = (1.0 - cosine2) / cosine2;
    float spread = exp(-tangent2 / (2.0 * variance)) / (6.2831853 * variance * cosine2 * cosine2);
    float facing = max(dot(half_way, frame.sun_direction), 0.0);
    float fresnel = 0.02 + 0.98 * pow(1.0 - facing, 5.0);
    return frame.sun_irradiance * (fresnel * spread / (4.0 * max(-direction.z, 0.06)));
}

/* A lake ends where the terrain ends; a sea does not. */
bool water_reaches(vec3 rel)
{
    vec2 local_m = rel.xy + push.camera_m;
    return push.is_sea != 0u || (all(greaterThan(local_m, vec2(0.0)))
                                 && all(lessThan(local_m, push.extent_m)));
}

/* Light of a surface in the picture, roughly: as if half of it stood in the sun. */
vec3 mirrored_surface(ivec2 at)
{
    vec4 albedo = texelFetch(gbuffer_albedo, at, 0);
    vec3 normal = texelFetch(gbuffer_normal, at, 0).xyz * 2.0 - 1.0;
    float facing = 0.15 + 0.3 * max(dot(normal, frame.sun_direction), 0.0);
    vec3 light = frame.sun_irradiance * facing * albedo.a + frame.sky_irradiance * (0.6 * albedo.a);
    return albedo.rgb * light * 0.318309886;
}

/* What a mirrored ray meets in the picture: steps that grow with distance, from 1.5 m to 2 km;
 * w: 1 where it meets something. */
vec4 mirrored_shore(vec3 rel, vec3 mirrored, float noise)
{
    vec4 found = vec4(0.0);
    float way_m = 1.5 * (0.7 + 0.6 * noise), step_m = way_m;
    for (int i = 0; i < 18; i++) {
        vec4 clip = frame.clip_from_rel * vec4(rel + mirrored * way_m, 1.0);
        vec2 screen = (clip.xy / max(clip.w, 1e-3) * 0.5 + 0.5) * vec2(frame.width, frame.height);
        ivec2 at = ivec2(clamp(screen, vec2(0.0), vec2(frame.width, frame.height) - 1.0));
        bool inside = clip.w > 0.1 && vec2(at) == floor(screen);
        float axis_m = frame.near_m / max(texelFetch(gbuffer_depth, at, 0).x, 1e-9);
        float behind_m = clip.w - axis_m;
        if (found.w == 0.0 && inside && behind_m > 0.0 && behind_m < step_m * 2.5 + 8.0)
            found = vec4(mirrored_surface(at), 1.0);
        step_m = way_m * 0.5;
        way_m += step_m;
    }
    return found;
}

/* `below` is the radiance of what lies under the surface, `depth_m` the way to it in water. */
vec3 water_radiance(vec3 below, vec3 direction, float distance_m, float depth_m, float sun_share,
                    float noise)
{
    float footprint_m = distance_m * 2.0 / (float(frame.height) * max(-direction.z, 0.02));
    float hidden;
    vec2 slope = water_slope(direction.xy * distance_m, footprint_m, hidden);
    vec3 normal = normalize(vec3(-slope, 1.0));
    float cosine = clamp(-dot(normal, direction), 0.02, 1.0);
    float fresnel = 0.02 + 0.98 * pow(1.0 - cosine, 5.0) / (1.0 + 20.0 * hidden);
    vec3 mirrored = reflect(direction, normal);
    mirrored.z = max(mirrored.z, 0.02);
    vec3 sky = sky_radiance(normalize(mirrored + vec3(0.0, 0.0, 2.0 * hidden)));
    vec4 shore = mirrored_shore(direction * distance_m, normalize(mirrored), noise);
    sky = mix(sky, apply_fog(shore.rgb, direction, distance_m, 1.0), shore.w);
    vec3 through = exp(-depth_m / (frame.water_clarity_m * vec3(0.55, 1.0, 0.85)));
    float lit = max(frame.sun_direction.z, 0.0) * sun_share;
    vec3 body = frame.water_color * (frame.sun_irradiance * lit + frame.sky_irradiance) / 3.14159;
    vec3 glint = water_glint(normal, direction, max(hidden, 0.0008)) * sun_share;
    return mix(mix(body, below, through), sky, fresnel) + glint;
}
