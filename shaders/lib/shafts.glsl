/* Shafts of sunlight in haze among trees: for each tile of pixels what the sun's light is, of that which haze on the
 * way would have without trees, up to each of some distances from the eye; most of these are near it.
 * Expects `frame`, `push` (wd_light_push) and lib/shadow.glsl. */

/* How far from the eye a way has left the maps of shadows. `axis`: of the way, along the view axis. */
float shafts_reach_m(float axis)
{
    return push.shafts_m / max(axis, 0.1);
}

float slice_end_m(float reach_m, uint slice)
{
    float part = float(slice + 1u) * (1.0 / float(WD_SHAFT_SLICES));
    return reach_m * part * part;
}

/* Share of the sun that trees let through to a place in the air, by one look at the maps. */
float sun_in_air(vec3 rel, float axis_m, float noise)
{
    uint cascade = min(shadow_cascade(axis_m, noise), WD_CASCADES - 1u);
    vec4 clip = shadow_from_rel(cascade) * vec4(rel, 1.0);
    vec3 at = clip.xyz / clip.w;
    bool outside = any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)));
    return outside ? 1.0 : map_lit(at.xy, cascade, at.z);
}
