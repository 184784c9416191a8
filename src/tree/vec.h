/* vec.h: more of three floats (shared/vec.h). Only + - * / and sqrt, so results are the same on every compiler. */
#ifndef WD_TREE_VEC_H
#define WD_TREE_VEC_H

#include <math.h>

#include "base/dmath.h"
#include "shared/vec.h"

/* fmaxf and fminf for numbers: calls of the library cost more than what they do. */
static inline float wd_maxf(float a, float b)
{
    return a > b ? a : b;
}

static inline float wd_minf(float a, float b)
{
    return a < b ? a : b;
}

static inline float wd_max3f(float a, float b, float c)
{
    return wd_maxf(wd_maxf(a, b), c);
}

static inline float wd_min3f(float a, float b, float c)
{
    return wd_minf(wd_minf(a, b), c);
}

/* Of numbers; b's where a's is none. */
static inline struct wd_vec3 wd_v3_max(struct wd_vec3 a, struct wd_vec3 b)
{
    return WD_V3(wd_maxf(a.x, b.x), wd_maxf(a.y, b.y), wd_maxf(a.z, b.z));
}

static inline struct wd_vec3 wd_v3_min(struct wd_vec3 a, struct wd_vec3 b)
{
    return WD_V3(wd_minf(a.x, b.x), wd_minf(a.y, b.y), wd_minf(a.z, b.z));
}

/* a + b s */
static inline struct wd_vec3 wd_v3_mad(struct wd_vec3 a, struct wd_vec3 b, float s)
{
    return WD_V3(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}

static inline struct wd_vec3 wd_v3_cross(struct wd_vec3 a, struct wd_vec3 b)
{
    return WD_V3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline float wd_v3_length(struct wd_vec3 a)
{
    return sqrtf(wd_v3_dot(a, a));
}

/* The unit vector along `a`; `fallback` where `a` has no direction. */
static inline struct wd_vec3 wd_v3_unit_or(struct wd_vec3 a, struct wd_vec3 fallback)
{
    float length = wd_v3_length(a);
    return length > 1e-12f ? wd_v3_scale(a, 1 / length) : fallback;
}

static inline struct wd_vec3 wd_v3_unit(struct wd_vec3 a)
{
    return wd_v3_unit_or(a, WD_V3(0, 0, 1));
}

/* A unit vector square to the unit vector `d`, horizontal where `d` is not vertical. */
static inline struct wd_vec3 wd_v3_side(struct wd_vec3 d)
{
    return wd_v3_unit_or(WD_V3(d.y, -d.x, 0), WD_V3(1, 0, 0));
}

/* The part of `a` square to the unit vector `d`, of unit length. */
static inline struct wd_vec3 wd_v3_square(struct wd_vec3 a, struct wd_vec3 d)
{
    return wd_v3_unit_or(wd_v3_mad(a, d, -wd_v3_dot(a, d)), wd_v3_side(d));
}

/* cos(angle) a + sin(angle) b */
static inline struct wd_vec3 wd_v3_turn(struct wd_vec3 a, struct wd_vec3 b, float angle_rad)
{
    double s, c;
    wd_dsincos(angle_rad, &s, &c);
    return wd_v3_add(wd_v3_scale(a, (float)c), wd_v3_scale(b, (float)s));
}

#endif
