/* What the frame before hid, or in a second round this one so far. Expects `view`, `pyramid` and lib/pyramid.glsl. */

/* A rectangle of pixels of that frame and the nearest depth in it. */
struct wd_screen_box {
    vec2 low, high;
    float depth;
    bool known; /* the frame before saw all of it */
};

wd_screen_box clamp_screen_box(vec2 low, vec2 high, float nearest_m)
{
    vec2 size = vec2(view.width, view.height);
    wd_screen_box box;
    box.depth = view.near_m / nearest_m;
    box.low = clamp(low, vec2(0.0), size - 1.0);
    box.high = clamp(high, vec2(0.0), size - 1.0);
    bool inside = all(greaterThanEqual(low, vec2(-1.0))) && all(lessThanEqual(high, size));
    box.known = view.still != 0u || inside;
    return box;
}

/* Level at which the box is at most `texels` wide, give or take the one it begins in. */
uint box_level(float width_px, float texels)
{
    float level = ceil(log2(max(width_px / texels, 2.0))) - 1.0;
    return min(uint(level), WD_PYRAMID_LEVELS - 1u);
}

/* Bottom edge, in pixels, of the lowest row of texels that leaves something of the box to be seen;
 * negative: nothing. */
float lowest_seen(wd_screen_box box)
{
    uint level = box_level(box.high.x - box.low.x, 2.0);
    uvec2 low = uvec2(box.low) >> (level + 1u), high = uvec2(box.high) >> (level + 1u);
    uvec2 at = uvec2(low.x, high.y);
    float edge = -1.0;
    do {
        if (pyramid_at(level, at) < box.depth)
            edge = float((at.y + 1u) << (level + 1u));
        at = at.x < high.x ? uvec2(at.x + 1u, at.y) : uvec2(low.x, at.y - 1u);
    } while (edge < 0.0 && at.y + 1u > low.y);
    return edge;
}

/* Whether other things stood in front of all of a box. */
bool was_hidden(vec3 low, vec3 high)
{
    vec2 from = vec2(1e9), to = vec2(-1e9);
    float nearest_m = 1e9;
    for (uint i = 0u; i < 8u; i++) {
        bvec3 side = bvec3((i & 1u) != 0u, (i & 2u) != 0u, (i & 4u) != 0u);
        vec4 clip = view.history_from_rel * vec4(mix(low, high, side), 1.0);
        vec2 at = (clip.xy / max(clip.w, 1e-3) * 0.5 + 0.5) * vec2(view.width, view.height);
        from = min(from, at);
        to = max(to, at);
        nearest_m = min(nearest_m, clip.w);
    }
    if (nearest_m < 1.0)
        return false;
    wd_screen_box box = clamp_screen_box(from - 1.0, to + 1.0, nearest_m);
    return box.known && lowest_seen(box) < 0.0;
}
