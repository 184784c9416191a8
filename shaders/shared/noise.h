/* noise.h: gradient noise (Perlin 2002) over the ground that does not swim or jitter: its lattice is
 * counted in whole millimetres of the world. Shaders declare `frame` before they include this. */
#ifndef WD_SHARED_NOISE_H
#define WD_SHARED_NOISE_H

#include "shared/frame.h"
#include "shared/vec.h"

/* A place on a lattice: its cell and where in it, 0..1. */
struct wd_lattice {
    int32_t column, row;
    float east, north;
};

/* The lattice of 2^bits mm at a camera-relative place. */
WD_FUNC WD_STRUCT wd_lattice wd_lattice_at(WD_FRAME_IN float east_m, float north_m, int32_t bits)
{
    int32_t mask = (1 << bits) - 1;
    float per_m = 1000.0f / WD_FLOAT(1 << bits);
    WD_VECTOR rest = WD_FRAME_V3(camera_frac_m);
    float east = (WD_FLOAT(WD_FRAME(camera_mm[0]) & mask) * 0.001f + rest.x + east_m) * per_m;
    float north = (WD_FLOAT(WD_FRAME(camera_mm[1]) & mask) * 0.001f + rest.y + north_m) * per_m;
    WD_STRUCT wd_lattice at;
    at.column = (WD_FRAME(camera_mm[0]) >> bits) + WD_INT(WD_FLOOR(east));
    at.row = (WD_FRAME(camera_mm[1]) >> bits) + WD_INT(WD_FLOOR(north));
    at.east = wd_fract(east);
    at.north = wd_fract(north);
    return at;
}

WD_FUNC uint32_t wd_lattice_hash(int32_t column, int32_t row, uint32_t salt)
{
    uint32_t h = WD_UINT(column) * 0x9e3779b1u ^ WD_UINT(row) * 0x85ebca77u ^ salt;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    return h ^ (h >> 13);
}

/* The gradient at a lattice point (x, y) and its product with the way there (z). */
WD_FUNC WD_VECTOR wd_lattice_gradient(WD_STRUCT wd_lattice at, int32_t east, int32_t north,
                                      uint32_t salt)
{
    uint32_t h = wd_lattice_hash(at.column + east, at.row + north, salt);
    float x = WD_FLOAT(h & 0xffffu) * (2.0f / 65535.0f) - 1.0f;
    float y = WD_FLOAT(h >> 16) * (2.0f / 65535.0f) - 1.0f;
    return WD_V3(x, y, x * (at.east - WD_FLOAT(east)) + y * (at.north - WD_FLOAT(north)));
}

/* x: noise, about -0.7..0.7; y, z: its gradient per lattice cell, east and north. */
WD_FUNC WD_VECTOR wd_gradient_noise(WD_STRUCT wd_lattice at, uint32_t salt)
{
    float x = at.east, y = at.north;
    float u = x * x * x * (x * (x * 6.0f - 15.0f) + 10.0f);
    float v = y * y * y * (y * (y * 6.0f - 15.0f) + 10.0f);
    float du = 30.0f * x * x * (x * (x - 2.0f) + 1.0f);
    float dv = 30.0f * y * y * (y * (y - 2.0f) + 1.0f);
    WD_VECTOR a = wd_lattice_gradient(at, 0, 0, salt), b = wd_lattice_gradient(at, 1, 0, salt);
    WD_VECTOR c = wd_lattice_gradient(at, 0, 1, salt), d = wd_lattice_gradient(at, 1, 1, salt);
    WD_VECTOR k = WD_V3(a.x - b.x - c.x + d.x, a.y - b.y - c.y + d.y, a.z - b.z - c.z + d.z);
    float east = a.x + u * (b.x - a.x) + v * (c.x - a.x) + u * v * k.x + du * (v * k.z + b.z - a.z);
    float north = a.y + u * (b.y - a.y) + v * (c.y - a.y) + u * v * k.y
                  + dv * (u * k.z + c.z - a.z);
    return WD_V3(a.z + u * (b.z - a.z) + v * (c.z - a.z) + u * v * k.z, east, north);
}

/* How much of a wave of 2^bits mm a pixel of this size may show before it would shimmer. */
WD_FUNC float wd_noise_share(float footprint_m, int32_t bits)
{
    return 1.0f - WD_SMOOTH(0.2f, 0.6f, footprint_m * (1000.0f / WD_FLOAT(1 << bits)));
}

#endif
