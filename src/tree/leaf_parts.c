#include "tree/leaf_parts.h"

#include "base/memory.h"

struct wd_blade_place wd_blade_place(struct wd_vec3 foot, struct wd_vec3 along, struct wd_vec3 up,
                                     float length, float width)
{
    struct wd_vec3 above = wd_v3_square(up, along);
    return (struct wd_blade_place){foot, wd_v3_cross(along, above), along, above, length, width, 0};
}

uint32_t wd_leaf_add_corner(struct wd_leaf_template *leaf, struct wd_vec3 p, struct wd_vec3 n,
                            float u, float v, float stiff)
{
    *wd_push(leaf->corners, leaf->corner_count, leaf->corner_capacity) =
        (struct wd_leaf_corner){p, n, u, v, stiff, WD_VERTEX_LEAF};
    return (uint32_t)leaf->corner_count - 1;
}

void wd_leaf_add_triangle(struct wd_leaf_template *leaf, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    for (int i = 0; i < 3; i++)
        *wd_push(leaf->indices, leaf->index_count, leaf->index_capacity) = corners[i];
}

/* A point of the blade: `x` in half widths, `y` in lengths. */
static uint32_t add_blade_corner(struct wd_leaf_template *leaf,
                                 const struct wd_leaf_outline *outline,
                                 const struct wd_blade_place *place, float x, float y)
{
    float across = 0.5f * place->width * x, curl = outline->curl * place->length;
    struct wd_vec3 p = wd_v3_mad(place->foot, place->along, place->length * y);
    p = wd_v3_mad(p, place->across, across);
    p = wd_v3_mad(p, place->above, outline->fold * fabsf(across) - curl * y * y);
    float side = x > 0 ? 1.0f : x < 0 ? -1.0f : 0.0f;
    struct wd_vec3 n = wd_v3_mad(place->above, place->across, -outline->fold * side);
    n = wd_v3_unit(wd_v3_mad(n, place->along, 2 * outline->curl * y));
    return wd_leaf_add_corner(leaf, p, n, 0.5f + 0.5f * x, y, wd_mixf(place->stiff, 1, y));
}

static float turn_of(struct wd_vec3 a, struct wd_vec3 b, struct wd_vec3 c)
{
    return wd_v3_cross(wd_v3_sub(b, a), wd_v3_sub(c, a)).z;
}

/* Whether the corner between `before` and `after` can be cut off: it turns left and holds no
 * other. */
static bool is_ear(const struct wd_vec3 *points, const int *ring, int count, int at)
{
    int before = ring[(at + count - 1) % count], tip = ring[at], after = ring[(at + 1) % count];
    if (turn_of(points[before], points[tip], points[after]) <= 0)
        return false;
    for (int i = 0; i < count; i++) {
        int k = ring[i];
        if (k != before && k != tip && k != after &&
            turn_of(points[before], points[tip], points[k]) >= 0 &&
            turn_of(points[tip], points[after], points[k]) >= 0 &&
            turn_of(points[after], points[before], points[k]) >= 0)
            return false;
    }
    return true;
}

/* Ear clipping of one half, from the foot round to the tip and back along the midrib. */
static void add_half(struct wd_leaf_template *leaf, const struct wd_vec3 *points,
                     const uint32_t *corners, int count, bool mirrored)
{
    int ring[WD_OUTLINE_POINTS + 2];
    for (int i = 0; i < count; i++)
        ring[i] = i;
    while (count > 2) {
        int at = 0;
        while (at < count - 1 && !is_ear(points, ring, count, at))
            at++;
        uint32_t a = corners[ring[(at + count - 1) % count]], b = corners[ring[at]];
        uint32_t c = corners[ring[(at + 1) % count]];
        wd_leaf_add_triangle(leaf, a, mirrored ? c : b, mirrored ? b : c);
        for (int i = at; i + 1 < count; i++)
            ring[i] = ring[i + 1];
        count--;
    }
}

void wd_leaf_add_blade(struct wd_leaf_template *leaf, const struct wd_leaf_outline *outline,
                       const struct wd_blade_place *place)
{
    struct wd_vec3 points[WD_OUTLINE_POINTS + 2] = {0};
    uint32_t corners[WD_OUTLINE_POINTS + 2] = {0};
    int count = outline->count + 2;
    for (int i = 0; i < count; i++) {
        points[i] = wd_leaf_outline_corner(outline, i);
        corners[i] = add_blade_corner(leaf, outline, place, points[i].x, points[i].y);
    }
    add_half(leaf, points, corners, count, false);
    for (int i = 1; i < count - 1; i++)
        corners[i] = add_blade_corner(leaf, outline, place, -points[i].x, points[i].y);
    add_half(leaf, points, corners, count, true);
}

void wd_leaf_add_kite(struct wd_leaf_template *leaf, const struct wd_leaf_outline *outline,
                      const struct wd_blade_place *place)
{
    float at = wd_leaf_outline_widest(outline);
    struct wd_blade_place kite = *place;
    kite.width *= 2 * wd_leaf_outline_area(outline);
    uint32_t foot = add_blade_corner(leaf, outline, &kite, 0, 0);
    uint32_t tip = add_blade_corner(leaf, outline, &kite, 0, 1);
    uint32_t right = add_blade_corner(leaf, outline, &kite, 1, at);
    uint32_t left = add_blade_corner(leaf, outline, &kite, -1, at);
    wd_leaf_add_triangle(leaf, foot, right, tip);
    wd_leaf_add_triangle(leaf, foot, tip, left);
}

void wd_leaf_add_stalk(struct wd_leaf_template *leaf, struct wd_vec3 from, struct wd_vec3 to,
                       struct wd_vec3 across, float width)
{
    struct wd_vec3 n = wd_v3_unit(wd_v3_cross(across, wd_v3_sub(to, from)));
    /* the midrib's colour */
    uint32_t a = wd_leaf_add_corner(leaf, wd_v3_mad(from, across, 0.5f * width), n, 0.501f, 0, 0);
    uint32_t b = wd_leaf_add_corner(leaf, wd_v3_mad(from, across, -0.5f * width), n, 0.499f, 0, 0);
    uint32_t c = wd_leaf_add_corner(leaf, to, n, 0.5f, 0.06f, 0);
    wd_leaf_add_triangle(leaf, a, c, b);
}

void wd_leaf_add_needle(struct wd_leaf_template *leaf, struct wd_vec3 foot,
                        struct wd_vec3 direction, struct wd_vec3 across, float length, float width)
{
    struct wd_vec3 n = wd_v3_unit(wd_v3_cross(across, direction));
    uint32_t a = wd_leaf_add_corner(leaf, wd_v3_mad(foot, across, -0.5f * width), n, 0, 0, 0.3f);
    uint32_t b = wd_leaf_add_corner(leaf, wd_v3_mad(foot, across, 0.5f * width), n, 1, 0, 0.3f);
    uint32_t c = wd_leaf_add_corner(leaf, wd_v3_mad(foot, direction, length), n, 0.5f, 1, 1);
    wd_leaf_add_triangle(leaf, a, b, c);
}
