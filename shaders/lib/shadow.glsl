/* Shadows of trees (cascaded maps) and of the ground (a field of shadow heights).
 * Expects `frame`, `push` (wd_light_push), `shadow_map` (sampler2DArrayShadow) and, for the ground's,
 * SUN_HEIGHT_AT(index). Where SHADOW_DEPTH names the same maps without comparison, penumbras widen with
 * the way from the caster; with SHADOW_COMPARES these are all that is asked, and `shadow_map` may be another. */

/* Of five values that of a cascade, chosen: software devices index a block lane by lane. */
vec4 of_cascade(vec4 first, vec4 second, vec4 third, vec4 fourth, vec4 fifth, uint cascade)
{
    bvec4 odd = bvec4((cascade & 1u) != 0u);
    vec4 four = mix(mix(first, second, odd), mix(third, fourth, odd), bvec4(cascade > 1u));
    return mix(four, fifth, bvec4(cascade > 3u));
}

vec4 shadow_column(uint column, uint cascade)
{
    return of_cascade(frame.shadow_from_rel[0][column], frame.shadow_from_rel[1][column],
                      frame.shadow_from_rel[2][column], frame.shadow_from_rel[3][column],
                      frame.shadow_from_rel[4][column], cascade);
}

/* A cascade's numbers (WD_CASCADE_*); beyond the last those of that. */
vec4 cascade_numbers(uint cascade)
{
    return of_cascade(frame.cascades[0], frame.cascades[1], frame.cascades[2], frame.cascades[3],
                      frame.cascades[4], cascade);
}

mat4 shadow_from_rel(uint cascade)
{
    return mat4(shadow_column(0u, cascade), shadow_column(1u, cascade), shadow_column(2u, cascade),
                shadow_column(3u, cascade));
}

/* The cascade for a distance along the view axis; WD_CASCADES beyond the last. Where slices overlap
 * noise picks one of both, so that no seam shows. */
uint shadow_cascade(float axis_m, float noise)
{
    uint cascade = 0u;
    for (uint i = 0u; i < WD_CASCADES; i++) {
        float end_m = frame.cascades[i][WD_CASCADE_FAR_M] - (1.0 - noise) * frame.cascades[i][WD_CASCADE_FADE_M];
        cascade += uint(axis_m >= end_m);
    }
    return cascade;
}

/* How much nearer the sun a sheet is a texture coordinate to the right and up of a place on it: without
 * that, the tilted sheet shadows itself in stripes. */
vec2 sheet_slope(vec3 sheet, mat4 m)
{
    vec3 right = vec3(m[0].x, m[1].x, m[2].x), up = vec3(m[0].y, m[1].y, m[2].y);
    vec3 toward = vec3(m[0].z, m[1].z, m[2].z);
    float facing = max(dot(sheet, toward) * inversesqrt(dot(toward, toward)), 0.25);
    return -vec2(dot(sheet, right) / dot(right, right), dot(sheet, up) / dot(up, up))
           * (length(toward) / facing);
}

/* The same of an offset in a map. What bulges as stems do lies below the plane that touches it: toward the sun that plane
 * is asked, or it would shade itself as wide as its penumbra, away from it the place's own depth. */
float sheet_nearer(vec2 slope, vec2 off, float bulges)
{
    float nearer = dot(slope, off);
    return mix(nearer, max(nearer, 0.0), bulges);
}

#ifdef SHADOW_DEPTH
/* Casters are looked for as wide about a place as the penumbra of one so far off may be; maps whose
 * texels are coarser than this make softer edges than the sun. */
const float CASTER_FAR_M = 60.0;
const float CASTER_TEXEL_M = 0.2;
const uint CASTER_PLACES = 4u;
const float CASTER_NEAR_M = 0.05;

/* Way from a place in a map to what casts a shadow there (Fernando 2005, percentage-closer soft
 * shadows), from four texels at each of `places`; 0: nothing does. The harmonic mean keeps the edge
 * of a trunk's shadow close by where crowns farther off hide the sun, too. `range_m`: depth of the
 * map; `widest`: of the search, in texture coordinates. */
float caster_m(vec3 at, uint cascade, float range_m, vec2 slope, float bulges, vec2 spin, float widest,
               uint places)
{
    float per_m = 0.0, count = 0.0;
    uint i = 0u;
    if (places == 0u)
        return 0.0;
    do {
        vec2 off = spin * (widest * sqrt((float(i) + 0.5) / float(CASTER_PLACES)));
        vec4 depth = textureGather(SHADOW_DEPTH, vec3(at.xy + off, float(cascade)));
        vec4 way_m = (depth - at.z - sheet_nearer(slope, off, bulges)) * range_m;
        vec4 casts = step(vec4(0.0), way_m);
        per_m += dot(casts, 1.0 / max(way_m, vec4(CASTER_NEAR_M)));
        count += dot(casts, vec4(1.0));
        spin = vec2(-spin.y, spin.x);
    } while (++i < places);
    return count == 0.0 ? 0.0 : count / per_m;
}
#endif

/* Share of the four texels about a place that are no nearer the sun than it, as samplers find it. */
float map_lit(vec2 at, uint cascade, float depth)
{
#ifdef SHADOW_DEPTH
    if (SHADOW_COMPARES) {
        vec2 share = fract(at * vec2(textureSize(SHADOW_DEPTH, 0).xy) - 0.5);
        vec4 lit = step(textureGather(SHADOW_DEPTH, vec3(at, float(cascade))), vec4(depth));
        vec2 column = mix(lit.wx, lit.zy, share.x);
        return mix(column.x, column.y, share.y);
    }
#endif
    return texture(shadow_map, vec4(at, float(cascade), depth));
}

/* Share of the sun that trees let through to `rel`. The disc of taps (Vogel 1979), turned by `circles`, is as wide as
 * the penumbra of what casts the shadow, at least a texel and a half. `sheet`: normal of the flat thing
 * that the place is on, toward the sun, or none. `bulges`: 1 of what has its normal for one, but bends away. */
float tree_shadow(vec3 rel, vec3 normal, vec3 sheet, float bulges, uint cascade, float circles)
{
    if (cascade >= WD_CASCADES || frame.shadow_taps == 0u)
        return 1.0;
    mat4 m = shadow_from_rel(cascade);
    float w = (m * vec4(rel, 1.0)).w;
    vec4 numbers = cascade_numbers(cascade) * w;
    float texel_m = numbers[WD_CASCADE_TEXEL_M];
    float flat_on = dot(sheet, sheet);
    vec3 off = mix(normal * 1.2, sheet * 0.5, flat_on) + frame.sun_direction * mix(0.8, 0.4, flat_on);
    vec3 from = rel + off * texel_m;
    vec4 clip = m * vec4(from, 1.0);
    vec3 at = clip.xyz / clip.w;
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0))))
        return 1.0;
    float texel = 1.0 / float(textureSize(shadow_map, 0).x);
    float turn = circles * 6.2831853;
    vec2 spin = vec2(cos(turn), sin(turn));
    vec2 slope = sheet_slope(mix(sheet, normal, bulges), m);
    float penumbra_m = 0.05; /* of a caster some 10 m off */
#ifdef SHADOW_DEPTH
    float sun_tan = sqrt(max(1.0 / (frame.sun_cos_radius * frame.sun_cos_radius) - 1.0, 0.0));
    bool fine = texel_m < CASTER_TEXEL_M; /* by no branch: software devices leave loops alone early */
    float way_m = caster_m(at, cascade, numbers[WD_CASCADE_DEPTH_M], slope, bulges, spin,
                           sun_tan * CASTER_FAR_M / texel_m * texel, fine ? CASTER_PLACES : 0u);
    penumbra_m = fine ? sun_tan * way_m : penumbra_m;
#endif
    float radius = max(1.5, penumbra_m / texel_m) * texel;
    float lit = 0.0;
    uint i = 0u;
    do {
        float r = sqrt((float(i) + 0.5) / float(frame.shadow_taps)) * radius;
        lit += map_lit(at.xy + spin * r, cascade, at.z + sheet_nearer(slope, spin * r, bulges));
        spin = vec2(-0.7373688 * spin.x - 0.6754903 * spin.y,
                    0.6754903 * spin.x - 0.7373688 * spin.y); /* the golden angle on */
    } while (++i < frame.shadow_taps);
    return lit / float(frame.shadow_taps);
}

#ifdef SUN_HEIGHT_AT
/* Share of the sun's disc over the ground's own horizon. The field says below which height a place
 * lies in the shadow of ground farther toward the sun. */
float ground_shadow(vec3 rel)
{
    vec2 at = clamp((rel.xy + push.camera_m) / push.sun_cell_m, vec2(0.0),
                    vec2(push.sun_width - 1u, push.sun_height - 1u) - 0.001);
    uvec2 cell = uvec2(at);
    vec2 share = at - vec2(cell);
    uint first = cell.y * push.sun_width + cell.x;
    float south = mix(SUN_HEIGHT_AT(first), SUN_HEIGHT_AT(first + 1u), share.x);
    first += push.sun_width;
    float north = mix(SUN_HEIGHT_AT(first), SUN_HEIGHT_AT(first + 1u), share.x);
    float height_m = rel.z + float(frame.camera_mm[2]) * 0.001 + frame.camera_frac_m.z;
    float above_m = height_m - mix(south, north, share.y);
    return smoothstep(-push.sun_soft_m, push.sun_soft_m, above_m);
}
#endif
