/* What is known of a model's leaves and of the light that they send (shared/sunlit.h).
 * Expects `frame`, `lit_models`, PER_PI, angle_of, leaf_cloud and slenderness. */

/* Of a model's table (shared/sunlit.h), for this eye: where its eight entries stand, and their shares. */
struct wd_sunlit_mix {
    uint place, eye_ring, sun_ring;
    float eye, sun, turn;
    float wood_eye; /* `eye` of wood's light of the sun */
    float opposite; /* of half a turn, how far the eye is from the sun's side */
    float hot;
    vec2 cloud;     /* what the table's two numbers are over besides, */
    float wood;     /* and its number of many branches */
    float disc_hot;
};

/* The eye sees past a leaf's edge what the sun reaches past it, if both come nearly the same way: more than discs show,
 * whose own few ways are mixed. By path-traced rows of six species under suns 0 to 60 degrees from the eye. */
float disc_hot_spot(float apart)
{
    return 1.0 + 0.36 * exp(-9.5 * apart) + 0.10 * exp(-2.6 * apart);
}

wd_sunlit_mix sunlit_mix(vec3 eye)
{
    vec2 a = eye.xy, b = frame.sun_direction.xy;
    float cosine = dot(a, b) * inversesqrt(max(dot(a, a) * dot(b, b), 1e-12));
    float opposite = angle_of(cosine) * PER_PI, steps = opposite * float(WD_SUNLIT_TURNS - 1u);
    uint turn = min(uint(steps), WD_SUNLIT_TURNS - 2u);
    uint eye_ring = wd_sunlit_ring(eye.z), sun_ring = wd_sunlit_ring(max(frame.sun_direction.z, WD_SUN_RING_SINE(0u)));
    wd_sunlit_mix at;
    at.eye_ring = eye_ring & 255u;
    at.sun_ring = (sun_ring & 255u) - 1u;
    at.place = wd_sunlit_place(eye_ring & 255u, (sun_ring & 255u) - 1u, turn);
    at.wood_eye = float(eye_ring >> 8) * (1.0 / 65535.0);
    /* on the sun's side a level eye sees of leaves what one somewhat above sees, not below */
    at.eye = at.wood_eye;
    at.eye *= at.eye_ring == 0u ? mix(2.0 - at.eye, 1.0, opposite) : 1.0;
    at.opposite = opposite;
    at.sun = float(sun_ring >> 8) * (1.0 / 65535.0);
    at.turn = steps - float(turn);
    float toward_sun = dot(eye, frame.sun_direction), apart = angle_of(toward_sun);
    at.hot = wd_sunlit_hot(apart);
    at.cloud = leaf_cloud(toward_sun) + WD_CLOUD_LEAST;
    at.wood = wd_wood_reflects(toward_sun, apart, cosine, opposite * 3.14159265, sqrt(dot(a, a) * dot(b, b)));
    at.disc_hot = disc_hot_spot(apart);
    return at;
}

float leaf_roughness(wd_lit_leaves model)
{
    return fract(abs(unpackHalf2x16(model.rough_flat).x));
}

wd_lit_leaves lit_leaves(int model)
{
    vec4 a = uintBitsToFloat(texelFetch(lit_models, model)), b = uintBitsToFloat(texelFetch(lit_models, model + 1));
    return wd_lit_leaves(floatBitsToUint(a.x), floatBitsToUint(a.y), floatBitsToUint(a.z), floatBitsToUint(a.w),
                         floatBitsToUint(b.x), floatBitsToUint(b.y), floatBitsToUint(b.z), floatBitsToUint(b.w));
}

vec3 unpack_ratios(uint packed)
{
    return vec3(packed & 1023u, packed >> 10 & 1023u, packed >> 20 & 1023u) * (WD_PALER_MOST / WD_PALER_STEPS);
}

vec3 leaf_transmittance(wd_lit_leaves model)
{
    return unpack_ratios(model.through);
}

vec3 paler_below(wd_lit_leaves model)
{
    return unpack_ratios(model.paler);
}

vec2 sunlit_of_pair(uint here, uint turn_on, wd_sunlit_mix at)
{
    return mix(unpackHalf2x16(here), unpackHalf2x16(turn_on), at.turn);
}

/* An eye as high as the sun sees the most lit leaves: between rings, what both of a step on and neither say
 * counts most (a simplex's shares), which keeps that ridge; all four alike would level it. Opposite the sun light goes
 * by both heights together, and what the one or the other of a step on says counts most. */
vec2 sunlit_of(int model, wd_sunlit_mix at)
{
    int first = model + int(WD_LIT_LEAVES_TEXELS + at.place);
    uvec4 low = texelFetch(lit_models, first);
    uvec4 high = texelFetch(lit_models, first + int(WD_EYE_RINGS * WD_SUNLIT_TURNS));
    float both = mix(min(at.eye, at.sun), max(at.eye + at.sun - 1.0, 0.0), at.opposite);
    vec2 known = sunlit_of_pair(low.x, low.y, at) * (1.0 - at.eye - at.sun + both)
                 + sunlit_of_pair(low.z, low.w, at) * (at.eye - both)
                 + sunlit_of_pair(high.x, high.y, at) * (at.sun - both)
                 + sunlit_of_pair(high.z, high.w, at) * both;
    return known * at.cloud * at.hot;
}

/* `first`: of leaves or of wood. */
vec4 skylit_of(int model, wd_sunlit_mix at, uint first)
{
    int place = model + int(WD_LIT_SKYLIT_TEXEL + first + at.eye_ring);
    uvec4 texel = texelFetch(lit_models, place);
    return mix(vec4(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y)),
               vec4(unpackHalf2x16(texel.z), unpackHalf2x16(texel.w)), at.eye);
}

/* How far a level eye is on the way from the lowest ring to the next. */
const float LEVEL_ON = -WD_EYE_RING_SINE(0u) / (WD_EYE_RING_SINE(1u) - WD_EYE_RING_SINE(0u));

/* Of what the model's table has in bytes for rings of the eye, this one's and of the next one's. */
float of_rings(uvec2 packed, uint ring, float on)
{
    return mix(WD_RING_SHARE(packed, ring), WD_RING_SHARE(packed, ring + 1u), on);
}

/* Share of upper sides among the leaves that an eye sees, among those that reflect and that transmit the sun to it, and that
 * reflect the sky's light; and among those of a picture that was taken level. */
struct wd_upper_sides {
    float seen, reflect, transmit, sky, level;
    float mirrors;     /* what wax mirrors of the sun over what cloud_wax tells, */
    float sky_mirrors; /* and of an even sky over what comes of that to the sides that are seen */
    float open;        /* how open leaves are that eyes see from half above */
};

wd_upper_sides upper_sides(int model, wd_sunlit_mix at)
{
    int first = model + int(WD_LIT_UPPER_TEXEL);
    uvec4 texel = texelFetch(lit_models, first + int(at.eye_ring)), level = texelFetch(lit_models, first);
    vec4 reflect = mix(unpackUnorm4x8(texel.x), unpackUnorm4x8(texel.y), at.wood_eye);
    vec4 transmit = mix(unpackUnorm4x8(texel.z), unpackUnorm4x8(texel.w), at.wood_eye);
    uint sun = min(at.sun_ring, WD_UPPER_SUNS - 1u), next = min(at.sun_ring + 1u, WD_UPPER_SUNS - 1u);
    wd_upper_sides upper;
    upper.seen = reflect[WD_UPPER_SUNS];
    upper.reflect = mix(reflect[sun], reflect[next], at.sun);
    upper.transmit = mix(transmit[sun], transmit[next], at.sun);
    upper.mirrors = WD_UPPER_MIRRORS_MOST * transmit[WD_UPPER_SUNS];
    uvec4 rings = texelFetch(lit_models, model + int(WD_LIT_RINGS_TEXEL));
    upper.sky_mirrors = WD_UPPER_SKY_WAX_MOST * of_rings(rings.xy, at.eye_ring, at.wood_eye);
    upper.open = of_rings(rings.zw, 2u, 0.0);
    upper.sky = reflect[WD_UPPER_SKY_RING];
    upper.level = mix(unpackUnorm4x8(level.x).w, unpackUnorm4x8(level.y).w, LEVEL_ON);
    return upper;
}

/* Pictures taken level show leaves as open as level eyes see them; this eye sees others. Factors on skylit_of. */
vec4 open_to_eye(int model, wd_sunlit_mix at)
{
    uvec2 rings = texelFetch(lit_models, model + int(WD_LIT_RINGS_TEXEL)).zw;
    float level = of_rings(rings, 0u, LEVEL_ON), seen = of_rings(rings, at.eye_ring, at.wood_eye);
    float above = wd_skylit_above(seen) / wd_skylit_above(level), below = wd_skylit_below(seen) / wd_skylit_below(level);
    return vec4(above, above, below, below);
}

/* Of the sun that reaches leaves of a crown, what they scatter comes to other ones, and to its boughs, again and again.
 * Irradiance of each side of leaves of such albedo and transmittance, over the sun's share; those that the eye sees lie
 * outside and get little of it, the least below: by path-traced rows of six species and a beech from below. */
const vec2 SCATTERED_AGAIN = vec2(0.23, 0.15);

vec3 scattered_again(vec3 leaf, wd_lit_leaves model, vec3 eye)
{
    vec3 again = unpackHalf2x16(model.again_low).x * min(leaf, vec3(0.95));
    float below = 1.0 - smoothstep(-0.2, 0.2, eye.z);
    return mix(SCATTERED_AGAIN.x, SCATTERED_AGAIN.y, below) * again / (1.0 - again);
}

/* Of light from the sky and the ground, what leaves of a tree that stands free scatter comes to its other leaves
 * (and its boughs, not to the stem beneath them), again and again: a photon that a leaf has scattered meets another
 * one by this chance (Smolander and Stenberg 2005). Those that the eye sees lie outside and meet the fewer: by
 * path-traced maples in October. */
const float SEEN_RECOLLISION = 0.9;

vec3 scattered_on(vec3 leaf, wd_lit_leaves model)
{
    float again = SEEN_RECOLLISION * unpackHalf2x16(model.again_low).x;
    return 1.0 / (1.0 - again * min(leaf, vec3(0.95)));
}

/* Of trees in closed stands an eye sees the tops, and neighbours' shade where the sun does not come from behind it: so
 * much of what a model's table says of the whole tree. The sides of slender crowns that face away from the sun lie in one
 * another's shade (Li and Strahler 1992). Of leaves that lie flatter (mean |z| of their faces) than oaks' those that are
 * seen from above are the better lit. Through open crowns a free tree is lit from behind, which neighbours hide. By
 * path-traced stands of five species under suns of 20 and 50 degrees, seen from eleven angles (docs/lighting.md). */
const float STAND_FLAT_FROM = 0.66, STAND_FLAT = 1.2, STAND_OPEN_FROM = 0.4, STAND_OPEN = 0.7;

float stand_sunlit(vec3 eye, wd_crown crown, wd_lit_leaves model, float open)
{
    float flatter = max(unpackHalf2x16(model.rough_flat).y - STAND_FLAT_FROM, 0.0);
    float apart = angle_of(dot(eye, frame.sun_direction));
    vec2 sunward = normalize(frame.sun_direction.xy + 1e-6);
    float above = smoothstep(0.82, 0.98, eye.z), low_sun = 1.0 - smoothstep(0.3, 0.8, frame.sun_direction.z);
    float dark = (1.0 - smoothstep(-0.35, 0.35, dot(eye.xy, sunward))) * smoothstep(0.6, 0.95, eye.z);
    float hot = mix(mix(0.79, 0.91, smoothstep(0.5, 0.8, eye.z)), 0.72, low_sun);
    float seen = mix(hot, mix(0.66, 0.69, low_sun), smoothstep(0.0, 1.4, apart));
    seen *= mix(1.0, mix(1.27, 1.6, low_sun), above) * mix(1.25, 1.0, smoothstep(0.1, 0.65, eye.z));
    seen *= 1.0 + STAND_FLAT * flatter * smoothstep(0.62, 0.8, eye.z);
    seen *= 1.0 - STAND_OPEN * max(open - STAND_OPEN_FROM, 0.0) * smoothstep(0.2, 1.6, apart);
    return seen * (1.0 - 0.6 * slenderness(crown) * dark);
}

/* Far off, reduced meshes of fewer leaves show some that lie deeper than those that an eye would see, the more so from above,
 * under a low sun and with the light: factors on the table's light of the sun and of the sky, by path-traced rows of six
 * species at 32 px under five suns and under the sky alone. */
vec2 reduced_light(vec3 eye, wd_lit_leaves model)
{
    float above = smoothstep(0.1, 0.6, eye.z);
    float high_sun = mix(1.04, 0.98, smoothstep(0.25, 0.95, frame.sun_direction.z));
    float ahead = mix(0.95, 1.0, smoothstep(-0.2, 0.3, dot(eye, frame.sun_direction)));
    vec2 light = vec2(mix(1.03, 1.07, above) * high_sun * ahead, mix(1.02, 1.05, above));
    return (model.through & WD_THROUGH_ALL_LEAVES) != 0u ? vec2(1.0) : light;
}

/* What of the sky's light a free tree sends to an eye, over what is known of its own leaves: of single ones, and of clouds
 * to eyes on their level and from above. By path-traced rows of five species under a clear sky, and so of trees in stands
 * whose neighbours are known. */
const float SKY_OVER_TABLE = 1.07;
const vec2 SKY_OVER_CLOUD = vec2(1.04, 0.98);

float sky_over_table(float eye_z, bool one_leaf)
{
    return one_leaf ? SKY_OVER_TABLE : mix(SKY_OVER_CLOUD.x, SKY_OVER_CLOUD.y, smoothstep(0.1, 0.6, eye_z));
}
