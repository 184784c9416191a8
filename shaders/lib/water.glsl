/* A level water: reflection of the sky, glint of the sun, and what shows through.
 * Expects `frame`, lib/noise.glsl, lib/sky.glsl and lib/view.glsl. */

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
    float tangent2 = (1.0 - cosine * cosine) / (cosine * cosine);
    float spread = exp(-tangent2 / (2.0 * variance)) / (6.2831853 * variance * (cosine * cosine * cosine * cosine));
    float facing = max(dot(half_way, frame.sun_direction), 0.0);
    float fresnel = 0.02 + 0.98 * pow(1.0 - facing, 5.0);
    return frame.sun_irradiance * (fresnel * spread / (4.0 * max(-direction.z, 0.06)));
}

/* `below` is the radiance of what lies under the surface, `depth_m` the way to it in water. */
vec3 water_radiance(vec3 below, vec3 direction, float distance_m, float depth_m, float sun_share)
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
    vec3 through = exp(-depth_m / (frame.water_clarity_m * vec3(0.55, 1.0, 0.85)));
    float lit = max(frame.sun_direction.z, 0.0) * sun_share;
    vec3 body = frame.water_color * (frame.sun_irradiance * lit + frame.sky_irradiance) / 3.14159;
    vec3 glint = water_glint(normal, direction, max(hidden, 0.0008)) * sun_share;
    return mix(mix(body, below, through), sky, fresnel) + glint;
}
