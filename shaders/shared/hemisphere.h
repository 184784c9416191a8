/* hemisphere.h: directions on the upper hemisphere that a model is seen from: the order of views,
 * the nearest view of a direction, and the three views around it with weights.
 *
 * Every layout is a flat lattice of square cells, each cut into two triangles; a direction is a
 * place on it, and weights are the barycentric coordinates there. They are continuous over the
 * hemisphere but at the zenith of WD_VIEWS_RINGS, where all views of the last ring look alike.
 * Directions below the horizon count as lying in it. */
#ifndef WD_SHARED_HEMISPHERE_H
#define WD_SHARED_HEMISPHERE_H

#include "shared/vec.h"

#ifdef __STDC_VERSION__
#include <stdbool.h>
#define WD_ATAN2(y, x) atan2f(y, x)
#else
#define WD_ATAN2(y, x) atan(y, x)
#endif

/* Elevation x azimuth (Sterling and Justin; row R3): `rows` rings from the horizon to the zenith
 * of `columns` views each. Views crowd at the zenith. */
#define WD_VIEWS_RINGS 1
/* Octahedral map of the hemisphere, `rows` x `rows` views (Engelhardt and Dachsbacher 2008). */
#define WD_VIEWS_OCTAHEDRAL 2
/* The zenith, then `rows` rings of 4, 8, 12 ... views down to the horizon: 2 N (N + 1) + 1 views,
 * nearly evenly spread (Bruneton and Neyret 2012). */
#define WD_VIEWS_EVEN 0

struct wd_hemisphere {
    uint32_t kind; /* WD_VIEWS_* */
    uint32_t rows, columns; /* rows >= 2; columns (of rings only) >= 3 */
};

struct wd_direction {
    float x, y, z; /* unit: from the model toward the viewer */
};

struct wd_view_blend {
    uint32_t view[3];
    float weight[3]; /* sum 1 */
};

/* A place on the lattice: cell coordinates, and which quarter of WD_VIEWS_EVEN. */
struct wd_view_place {
    float a, b;
    uint32_t quarter;
};

WD_FUNC uint32_t wd_hemisphere_count(WD_STRUCT wd_hemisphere h)
{
    return h.kind == WD_VIEWS_RINGS        ? h.rows * h.columns
           : h.kind == WD_VIEWS_OCTAHEDRAL ? h.rows * h.rows
                                           : 2u * h.rows * (h.rows + 1u) + 1u;
}

WD_FUNC WD_STRUCT wd_direction wd_direction_of_angles(float zenith_rad, float azimuth_rad)
{
    WD_STRUCT wd_direction d;
    float sine = WD_SIN(zenith_rad);
    d.x = sine * WD_COS(azimuth_rad);
    d.y = sine * WD_SIN(azimuth_rad);
    d.z = WD_COS(zenith_rad);
    return d;
}

WD_FUNC WD_STRUCT wd_direction wd_octahedral_direction(float u, float v)
{
    WD_STRUCT wd_direction d;
    d.x = 0.5f * (u + v);
    d.y = 0.5f * (u - v);
    d.z = WD_MAX(1.0f - WD_ABS(d.x) - WD_ABS(d.y), 0.0f);
    float scale = 1.0f / WD_SQRT(d.x * d.x + d.y * d.y + d.z * d.z);
    d.x *= scale;
    d.y *= scale;
    d.z *= scale;
    return d;
}

/* Where the model is seen from in a view. */
WD_FUNC WD_STRUCT wd_direction wd_hemisphere_direction(WD_STRUCT wd_hemisphere h, uint32_t view)
{
    const float quarter = 1.57079632679f;
    if (h.kind == WD_VIEWS_OCTAHEDRAL) {
        float step = 2.0f / WD_FLOAT(h.rows - 1u);
        return wd_octahedral_direction(WD_FLOAT(view % h.rows) * step - 1.0f,
                                       WD_FLOAT(view / h.rows) * step - 1.0f);
    }
    if (h.kind == WD_VIEWS_RINGS) {
        float up = WD_FLOAT(view / h.columns) / WD_FLOAT(h.rows - 1u);
        float around = WD_FLOAT(view % h.columns) / WD_FLOAT(h.columns);
        return wd_direction_of_angles((1.0f - up) * quarter, around * 4.0f * quarter);
    }
    uint32_t ring = 0u;
    for (uint32_t k = 1u; k <= h.rows && view >= 2u * k * (k - 1u) + 1u; k++)
        ring = k;
    if (ring == 0u)
        return wd_direction_of_angles(0.0f, 0.0f);
    uint32_t place = view - (2u * ring * (ring - 1u) + 1u);
    return wd_direction_of_angles(quarter * WD_FLOAT(ring) / WD_FLOAT(h.rows),
                                  quarter * WD_FLOAT(place) / WD_FLOAT(ring));
}

/* Turns counter-clockwise from east, times `parts`: 0 .. parts. */
WD_FUNC float wd_direction_turn(WD_STRUCT wd_direction d, float parts)
{
    float turn = WD_ATAN2(d.y, d.x) * (1.0f / 6.28318530718f);
    turn = turn < 0.0f ? turn + 1.0f : turn;
    return WD_MIN(turn, 0.9999999f) * parts;
}

WD_FUNC WD_STRUCT wd_view_place wd_hemisphere_place(WD_STRUCT wd_hemisphere h,
                                                    WD_STRUCT wd_direction d)
{
    const float last = 1e-4f; /* keeps the far edge within the last cell */
    WD_STRUCT wd_view_place place;
    place.quarter = 0u;
    d.z = WD_MAX(d.z, 0.0f);
    float level = WD_SQRT(d.x * d.x + d.y * d.y);
    if (level < 1e-6f)
        d.x = level = 1e-6f;
    if (h.kind == WD_VIEWS_OCTAHEDRAL) {
        float sum = WD_ABS(d.x) + WD_ABS(d.y) + d.z, cells = WD_FLOAT(h.rows - 1u);
        place.a = WD_MIN((0.5f + 0.5f * (d.x + d.y) / sum) * cells, cells - last);
        place.b = WD_MIN((0.5f + 0.5f * (d.x - d.y) / sum) * cells, cells - last);
        place.a = WD_MAX(place.a, 0.0f);
        place.b = WD_MAX(place.b, 0.0f);
        return place;
    }
    float zenith = WD_ATAN2(level, d.z) * (1.0f / 1.57079632679f);
    if (h.kind == WD_VIEWS_RINGS) {
        float cells = WD_FLOAT(h.rows - 1u);
        place.a = WD_MIN((1.0f - zenith) * cells, cells - last);
        place.b = wd_direction_turn(d, WD_FLOAT(h.columns));
        return place;
    }
    float around = wd_direction_turn(d, 4.0f), whole = WD_FLOOR(around);
    float ring = WD_MIN(zenith * WD_FLOAT(h.rows), WD_FLOAT(h.rows) - last);
    place.quarter = WD_UINT(whole);
    place.b = ring * (around - whole);
    place.a = ring - place.b;
    return place;
}

/* The view at a corner of the lattice. */
WD_FUNC uint32_t wd_hemisphere_corner(WD_STRUCT wd_hemisphere h, uint32_t quarter, uint32_t i,
                                      uint32_t j)
{
    if (h.kind == WD_VIEWS_OCTAHEDRAL)
        return j * h.rows + i;
    if (h.kind == WD_VIEWS_RINGS)
        return i * h.columns + j % h.columns;
    uint32_t ring = i + j;
    return ring == 0u ? 0u : 2u * ring * (ring - 1u) + 1u + (quarter * ring + j) % (4u * ring);
}

/* The three views around a direction and their weights. */
WD_FUNC WD_STRUCT wd_view_blend wd_hemisphere_blend(WD_STRUCT wd_hemisphere h,
                                                    WD_STRUCT wd_direction d)
{
    WD_STRUCT wd_view_place place = wd_hemisphere_place(h, d);
    float floor_a = WD_FLOOR(place.a), floor_b = WD_FLOOR(place.b);
    float a = place.a - floor_a, b = place.b - floor_b;
    uint32_t i = WD_UINT(floor_a), j = WD_UINT(floor_b);
    WD_STRUCT wd_view_blend blend;
    bool beyond = a + b > 1.0f;
    blend.view[0] = beyond ? wd_hemisphere_corner(h, place.quarter, i + 1u, j + 1u)
                           : wd_hemisphere_corner(h, place.quarter, i, j);
    blend.view[1] = wd_hemisphere_corner(h, place.quarter, i + 1u, j);
    blend.view[2] = wd_hemisphere_corner(h, place.quarter, i, j + 1u);
    blend.weight[0] = beyond ? a + b - 1.0f : 1.0f - a - b;
    blend.weight[1] = beyond ? 1.0f - b : a;
    blend.weight[2] = beyond ? 1.0f - a : b;
    return blend;
}

/* The view seen from most nearly the same direction: the nearest corner of the cell. */
WD_FUNC uint32_t wd_hemisphere_nearest(WD_STRUCT wd_hemisphere h, WD_STRUCT wd_direction d)
{
    WD_STRUCT wd_view_place place = wd_hemisphere_place(h, d);
    uint32_t i = WD_UINT(place.a), j = WD_UINT(place.b), best = 0u;
    uint32_t corners = h.kind == WD_VIEWS_EVEN && i + j + 2u > h.rows ? 3u : 4u;
    float best_cosine = -2.0f;
    d.z = WD_MAX(d.z, 0.0f);
    for (uint32_t k = 0u; k < corners; k++) {
        uint32_t view = wd_hemisphere_corner(h, place.quarter, i + k % 2u, j + k / 2u);
        WD_STRUCT wd_direction other = wd_hemisphere_direction(h, view);
        float cosine = d.x * other.x + d.y * other.y + d.z * other.z;
        if (cosine > best_cosine) {
            best_cosine = cosine;
            best = view;
        }
    }
    return best;
}

#endif
