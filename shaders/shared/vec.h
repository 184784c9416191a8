/* vec.h: three floats and the scalar functions that GLSL has built in, for mathematics that C and
 * GLSL share. Only + - * / and sqrt unless the name says otherwise, so that on the CPU results are
 * the same on every compiler. */
#ifndef WD_SHARED_VEC_H
#define WD_SHARED_VEC_H

#include "shared/types.h"

#ifdef __STDC_VERSION__
#include <math.h>

struct wd_vec3 {
    float x, y, z;
};

#define WD_STRUCT struct
#define WD_VECTOR struct wd_vec3
#define WD_V3(x, y, z) ((struct wd_vec3){(float)(x), (float)(y), (float)(z)})
#define WD_ABS(x) fabsf(x)
#define WD_FLOOR(x) floorf(x)
#define WD_SQRT(x) sqrtf(x)
#define WD_EXP(x) expf(x)
#define WD_COS(x) cosf(x)
#define WD_SIN(x) sinf(x)
#define WD_ACOS(x) acosf(x)
#define WD_ATAN2(y, x) atan2f(y, x)
#define WD_LOG2(x) log2f(x)
#define WD_EXP2(x) exp2f(x)
#define WD_POW(x, y) powf(x, y)
#define WD_MIN(x, y) fminf(x, y)
#define WD_MAX(x, y) fmaxf(x, y)
#define WD_CLAMP(x, low, high) wd_clampf(x, low, high)
#define WD_MIX(a, b, t) wd_mixf(a, b, t)
#define WD_SMOOTH(from, to, x) wd_smoothf(from, to, x)
#define WD_FLOAT(x) ((float)(x))
#define WD_INT(x) ((int32_t)(x))
#define WD_UINT(x) ((uint32_t)(x))

static inline float wd_mixf(float a, float b, float t)
{
    return a + (b - a) * t;
}

static inline float wd_clampf(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

static inline float wd_smoothf(float edge0, float edge1, float x)
{
    float t = wd_clampf((x - edge0) / (edge1 - edge0), 0, 1);
    return t * t * (3 - 2 * t);
}

static inline struct wd_vec3 wd_v3_of(const float v[3])
{
    return WD_V3(v[0], v[1], v[2]);
}

static inline struct wd_vec3 wd_v3_add(struct wd_vec3 a, struct wd_vec3 b)
{
    return WD_V3(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline struct wd_vec3 wd_v3_sub(struct wd_vec3 a, struct wd_vec3 b)
{
    return WD_V3(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline struct wd_vec3 wd_v3_scale(struct wd_vec3 a, float s)
{
    return WD_V3(a.x * s, a.y * s, a.z * s);
}

/* component by component */
static inline struct wd_vec3 wd_v3_mul(struct wd_vec3 a, struct wd_vec3 b)
{
    return WD_V3(a.x * b.x, a.y * b.y, a.z * b.z);
}

static inline struct wd_vec3 wd_v3_mix(struct wd_vec3 a, struct wd_vec3 b, float t)
{
    return wd_v3_add(wd_v3_scale(a, 1 - t), wd_v3_scale(b, t));
}

static inline float wd_v3_dot(struct wd_vec3 a, struct wd_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
#else
#define WD_STRUCT
#define WD_VECTOR vec3
#define WD_V3(x, y, z) vec3(x, y, z)
#define WD_ABS(x) abs(x)
#define WD_FLOOR(x) floor(x)
#define WD_SQRT(x) sqrt(x)
#define WD_EXP(x) exp(x)
#define WD_COS(x) cos(x)
#define WD_SIN(x) sin(x)
#define WD_ACOS(x) acos(x)
#define WD_ATAN2(y, x) atan(y, x)
#define WD_LOG2(x) log2(x)
#define WD_EXP2(x) exp2(x)
#define WD_POW(x, y) pow(x, y)
#define WD_MIN(x, y) min(x, y)
#define WD_MAX(x, y) max(x, y)
#define WD_CLAMP(x, low, high) clamp(x, low, high)
#define WD_MIX(a, b, t) mix(a, b, t)
#define WD_SMOOTH(from, to, x) smoothstep(from, to, x)
#define WD_FLOAT(x) float(x)
#define WD_INT(x) int(x)
#define WD_UINT(x) uint(x)
#define wd_v3_add(a, b) ((a) + (b))
#define wd_v3_sub(a, b) ((a) - (b))
#define wd_v3_scale(a, s) ((a) * (s))
#define wd_v3_mul(a, b) ((a) * (b))
#define wd_v3_mix(a, b, t) mix(a, b, t)
#define wd_v3_dot(a, b) dot(a, b)
#endif

/* Of unit length; (0, 0, 0) must not be asked for. */
WD_FUNC WD_VECTOR wd_v3_normalize(WD_VECTOR a)
{
    return wd_v3_scale(a, 1.0f / WD_SQRT(wd_v3_dot(a, a)));
}

WD_FUNC WD_VECTOR wd_v3_clamp(WD_VECTOR a, float low, float high)
{
    return WD_V3(WD_CLAMP(a.x, low, high), WD_CLAMP(a.y, low, high), WD_CLAMP(a.z, low, high));
}

WD_FUNC float wd_fract(float x)
{
    return x - WD_FLOOR(x);
}

/* The normal that a layer shows of what is seen along `direction`, which need not be a unit. A sheet's is that of the
 * side that is seen; what is solid has smooth normals that may look a little past the eye: not that far. */
WD_FUNC WD_VECTOR wd_normal_seen(WD_VECTOR normal, WD_VECTOR direction, bool sheet)
{
    float away = wd_v3_dot(normal, direction);
    if (away <= 0.0f)
        return normal;
    if (sheet)
        return wd_v3_scale(normal, -1.0f);
    return wd_v3_normalize(wd_v3_sub(normal, wd_v3_scale(direction, away / wd_v3_dot(direction, direction))));
}

#endif
