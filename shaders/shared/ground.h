/* ground.h: the height of the ground at a place, as C and as GLSL, alike to the bit.
 *
 * The ground is a grid of samples; between them lie two flat triangles a cell, split along the
 * diagonal from south-west to north-east. Places are whole millimetres, and a place becomes a
 * cell and a 24-bit share of it by one 32 x 32 bit multiplication: no rounding differs.
 *
 * A shader includes place_layer.h, declares its buffers, and defines before it includes this:
 * WD_GROUND(member), WD_HEIGHT_AT(index) in metres and WD_HOLE_AT(index), nonzero where the ground
 * is cut out. */
#ifndef WD_SHARED_GROUND_H
#define WD_SHARED_GROUND_H

#include "shared/place_layer.h"
#include "shared/vec.h"

#ifdef __STDC_VERSION__
#define WD_MULTIPLY_HIGH(a, b) ((uint32_t)(((uint64_t)(a) * (b)) >> 32))
#else
uint WD_MULTIPLY_HIGH(uint a, uint b)
{
    uint high, low;
    umulExtended(a, b, high, low);
    return high;
}
#endif

#ifdef __STDC_VERSION__
struct wd_ground_input {
    struct wd_place_ground ground;
    const float *height_m;
    const uint8_t *hole; /* NULL where has_holes is 0 */
};
#define WD_GROUND_IN const struct wd_ground_input *ground_input,
#define WD_GROUND_PASS ground_input,
#define WD_GROUND(member) (ground_input->ground.member)
#define WD_HEIGHT_AT(index) (ground_input->height_m[index])
#define WD_HOLE_AT(index) (ground_input->hole[index])
#else
#define WD_GROUND_IN
#define WD_GROUND_PASS
#endif

WD_FUNC uint32_t wd_axis_cell(WD_STRUCT wd_axis axis, uint32_t mm)
{
    return WD_MULTIPLY_HIGH(mm, axis.inverse) >> axis.shift;
}

/* The share of the cell, 0..2^24 - 1. */
WD_FUNC uint32_t wd_axis_share(WD_STRUCT wd_axis axis, uint32_t mm)
{
    uint32_t high = WD_MULTIPLY_HIGH(mm, axis.inverse), low = mm * axis.inverse;
    uint32_t share = axis.shift < 24u ? (high << (24u - axis.shift)) | (low >> (8u + axis.shift))
                                      : high >> (axis.shift - 24u);
    return share & 0xffffffu;
}

/* A place on the ground: the cell's south-west sample and the shares east and north of it. */
struct wd_ground_place {
    uint32_t column, row;
    float east, north;
};

WD_FUNC uint32_t wd_ground_clamp(int32_t mm, int32_t extent_mm)
{
    return mm < 0 ? 0u : WD_UINT(mm > extent_mm ? extent_mm : mm);
}

/* Places outside are moved to the edge. */
WD_FUNC WD_STRUCT wd_ground_place wd_ground_locate(WD_GROUND_IN int32_t x_mm, int32_t y_mm)
{
    WD_STRUCT wd_ground_place place;
    uint32_t x = wd_ground_clamp(x_mm, WD_GROUND(extent_mm[0]));
    uint32_t y = wd_ground_clamp(y_mm, WD_GROUND(extent_mm[1]));
    place.column = wd_axis_cell(WD_GROUND(axis), x);
    place.row = wd_axis_cell(WD_GROUND(axis), y);
    place.east = WD_FLOAT(wd_axis_share(WD_GROUND(axis), x)) * 5.9604644775390625e-8f; /* 2^-24 */
    place.north = WD_FLOAT(wd_axis_share(WD_GROUND(axis), y)) * 5.9604644775390625e-8f;
    if (place.column > WD_GROUND(width) - 2u) {
        place.column = WD_GROUND(width) - 2u;
        place.east = 1.0f;
    }
    if (place.row > WD_GROUND(height) - 2u) {
        place.row = WD_GROUND(height) - 2u;
        place.north = 1.0f;
    }
    return place;
}

/* Metres above the world's zero. */
WD_FUNC float wd_ground_height(WD_GROUND_IN WD_STRUCT wd_ground_place place)
{
    uint32_t south_west = place.row * WD_GROUND(width) + place.column;
    uint32_t north_west = south_west + WD_GROUND(width);
    float low = WD_HEIGHT_AT(south_west), high = WD_HEIGHT_AT(north_west + 1u);
    float corner = place.east >= place.north ? WD_HEIGHT_AT(south_west + 1u)
                                             : WD_HEIGHT_AT(north_west);
    float first = place.east >= place.north ? place.east : place.north;
    float second = place.east >= place.north ? place.north : place.east;
    WD_PRECISE float rise = first * (corner - low);
    WD_PRECISE float rest = second * (high - corner);
    WD_PRECISE float sum = rise + rest;
    WD_PRECISE float height_m = low + sum;
    return height_m;
}

/* Whole millimetres, rounded half up. */
WD_FUNC int32_t wd_ground_mm(float height_m)
{
    WD_PRECISE float mm = height_m * 1000.0f;
    WD_PRECISE float up = mm + 0.5f;
    return WD_INT(WD_FLOOR(up));
}

/* Rise over run eastward at a sample, by central differences (one-sided at the edge). */
WD_FUNC float wd_ground_gradient_east(WD_GROUND_IN uint32_t column, uint32_t row)
{
    uint32_t west = column > 0u ? column - 1u : 0u;
    uint32_t east = column + 1u < WD_GROUND(width) ? column + 1u : column;
    uint32_t first = row * WD_GROUND(width);
    float scale = WD_GROUND(half_per_m) * (east - west == 2u ? 1.0f : 2.0f);
    WD_PRECISE float rise = WD_HEIGHT_AT(first + east) - WD_HEIGHT_AT(first + west);
    WD_PRECISE float gradient = rise * scale;
    return gradient;
}

WD_FUNC float wd_ground_gradient_north(WD_GROUND_IN uint32_t column, uint32_t row)
{
    uint32_t south = row > 0u ? row - 1u : 0u;
    uint32_t north = row + 1u < WD_GROUND(height) ? row + 1u : row;
    float scale = WD_GROUND(half_per_m) * (north - south == 2u ? 1.0f : 2.0f);
    WD_PRECISE float rise = WD_HEIGHT_AT(north * WD_GROUND(width) + column)
                            - WD_HEIGHT_AT(south * WD_GROUND(width) + column);
    WD_PRECISE float gradient = rise * scale;
    return gradient;
}

WD_FUNC float wd_ground_mix(float a, float b, float share)
{
    WD_PRECISE float step = b - a;
    WD_PRECISE float part = step * share;
    WD_PRECISE float sum = a + part;
    return sum;
}

/* Squared rise over run: the samples' gradients, interpolated, so that no cell edge shows. */
WD_FUNC float wd_ground_slope_squared(WD_GROUND_IN WD_STRUCT wd_ground_place place)
{
    uint32_t i = place.column, j = place.row;
    float south = wd_ground_mix(wd_ground_gradient_east(WD_GROUND_PASS i, j),
                                wd_ground_gradient_east(WD_GROUND_PASS i + 1u, j), place.east);
    float north = wd_ground_mix(wd_ground_gradient_east(WD_GROUND_PASS i, j + 1u),
                                wd_ground_gradient_east(WD_GROUND_PASS i + 1u, j + 1u), place.east);
    float eastward = wd_ground_mix(south, north, place.north);
    south = wd_ground_mix(wd_ground_gradient_north(WD_GROUND_PASS i, j),
                          wd_ground_gradient_north(WD_GROUND_PASS i + 1u, j), place.east);
    north = wd_ground_mix(wd_ground_gradient_north(WD_GROUND_PASS i, j + 1u),
                          wd_ground_gradient_north(WD_GROUND_PASS i + 1u, j + 1u), place.east);
    float northward = wd_ground_mix(south, north, place.north);
    WD_PRECISE float east_squared = eastward * eastward;
    WD_PRECISE float north_squared = northward * northward;
    WD_PRECISE float sum = east_squared + north_squared;
    return sum;
}

/* A triangle with a corner that is cut out is a hole. */
WD_FUNC bool wd_ground_is_hole(WD_GROUND_IN WD_STRUCT wd_ground_place place)
{
    if (WD_GROUND(has_holes) == 0u)
        return false;
    uint32_t south_west = place.row * WD_GROUND(width) + place.column;
    uint32_t north_west = south_west + WD_GROUND(width);
    uint32_t corner = place.east >= place.north ? south_west + 1u : north_west;
    return WD_HOLE_AT(south_west) != 0 || WD_HOLE_AT(corner) != 0
           || WD_HOLE_AT(north_west + 1u) != 0;
}

#endif
