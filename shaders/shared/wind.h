/* wind.h: how trees sway, alike in vertex shaders, motion vectors and tests on the CPU.
 *
 * The wind is a mean plus gusts that travel with it (Jia, Wang, Song: "Lots of dynamic trees"): the
 * crown tilts by theta = |v| * stiffness term, its heading (yaw) is kept. The gusts are two waves
 * of 61 m and 23 m carried along at the mean speed. Each tree rings at its own frequency, which
 * falls with height (about 0.3 Hz at 20 m; Moore and Maguire 2004), with its own phase.
 * The stem bends like a cantilever: displacement grows with the square of height, and a displaced
 * point comes down by d^2 / 2h so that nothing stretches. Displacement grows with speed, above 10 m/s
 * with its power of 1.5: drag is by the square, less what crowns give way (Vogel 1989). */
#ifndef WD_SHARED_WIND_H
#define WD_SHARED_WIND_H

#include "shared/vec.h"

/* The wind of a scene, as in struct wd_frame_uniforms. */
struct wd_wind {
    float speed_mps, gust;
    float toward_x, toward_y; /* unit */
};

/* What the wind needs to know of a tree. */
struct wd_wind_tree {
    float x_m, y_m;     /* its foot, local frame (for the phase of gusts: centimetres suffice) */
    float height_m;
    float flexibility;  /* top displacement over height at 10 m/s (struct wd_species) */
    uint32_t random;    /* wd_tree_random */
};

struct wd_wind_shift {
    float x_m, y_m, z_m;
};

/* All that sways does so a whole number of times in this, so times may be taken modulo it: as 32-bit floats
 * those of a day would be off by eighths of a frame. */
#define WD_WIND_PERIOD_S 4000.0f

/* The nearest rate, a second, at which that is so. */
WD_FUNC float wd_wind_rate(float hertz)
{
    return WD_FLOOR(hertz * WD_WIND_PERIOD_S + 0.5f) * (1.0f / WD_WIND_PERIOD_S);
}

/* Times that something at such a rate comes round in it. */
WD_FUNC int32_t wd_wind_turns(float rate)
{
    return WD_INT(WD_FLOOR(rate * WD_WIND_PERIOD_S + 0.5f));
}

#ifdef __STDC_VERSION__
/* How many periods are taken off a time, and others of about that time. */
static inline int32_t wd_wind_period_of(double time_s)
{
    return (int32_t)floor(time_s / (double)WD_WIND_PERIOD_S);
}

static inline double wd_wind_begin_s(double time_s)
{
    return wd_wind_period_of(time_s) * (double)WD_WIND_PERIOD_S;
}
#endif

/* A wave of period 1 between -1 and 1 with continuous slope: a smoothed triangle (Sousa 2007). */
WD_FUNC float wd_wind_wave(float x)
{
    float triangle = WD_ABS((x - WD_FLOOR(x)) * 2.0f - 1.0f);
    return triangle * triangle * (6.0f - 4.0f * triangle) - 1.0f;
}

/* Wind speed over the mean at a place, as a factor of the mean: -gust .. +gust. */
WD_FUNC float wd_wind_gust(WD_STRUCT wd_wind wind, float x_m, float y_m, float time_s)
{
    float along = x_m * wind.toward_x + y_m * wind.toward_y;
    float across = y_m * wind.toward_x - x_m * wind.toward_y;
    float slowly = along * (1.0f / 61.0f) - wd_wind_rate(wind.speed_mps * (1.0f / 61.0f)) * time_s;
    float quickly = along * (1.0f / 23.0f) - wd_wind_rate(wind.speed_mps * (1.0f / 23.0f)) * time_s;
    float slow = wd_wind_wave(slowly + 0.3f * wd_wind_wave(across * 0.013f));
    float fast = wd_wind_wave(quickly - across * 0.017f);
    return wind.gust * (0.65f * slow + 0.35f * fast);
}

/* Displacement of the top over height by the mean wind; what lies down already is bent no further. */
WD_FUNC float wd_wind_bend(float flexibility, float speed_mps)
{
    float bend = flexibility * speed_mps * 0.1f;
    if (speed_mps > 10.0f)
        bend *= WD_SQRT(0.1f * speed_mps);
    float over = bend - 0.35f;
    return over > 0.0f ? 0.35f + over / (1.0f + 4.0f * over) : bend;
}

/* Where a point of the stem or crown, `height_m` above the foot, goes from its place at rest. */
WD_FUNC WD_STRUCT wd_wind_shift wd_wind_offset(WD_STRUCT wd_wind wind,
                                               WD_STRUCT wd_wind_tree tree, float height_m,
                                               float time_s)
{
    WD_STRUCT wd_wind_shift shift;
    float phase = tree.random & 0xffffu, pitch = (tree.random >> 16) & 0xffu;
    float hertz = 6.0f / (tree.height_m + 1.0f) * (0.85f + pitch * (0.3f / 255.0f));
    float gust = wd_wind_gust(wind, tree.x_m, tree.y_m, time_s);
    float ringing = wd_wind_wave(time_s * wd_wind_rate(hertz) + phase * (1.0f / 65536.0f));
    float sideways = wd_wind_wave(time_s * wd_wind_rate(hertz * 0.83f) + phase * (7.0f / 65536.0f));
    float share = height_m > 0.0f ? height_m / tree.height_m : 0.0f;
    float bend = wd_wind_bend(tree.flexibility, wind.speed_mps) * tree.height_m * share * share;
    float push = bend * (0.6f + 0.6f * gust + 0.4f * wind.gust * ringing);
    float sway = bend * 0.25f * wind.gust * sideways;
    float sum = push * push + sway * sway;
    shift.x_m = push * wind.toward_x - sway * wind.toward_y;
    shift.y_m = push * wind.toward_y + sway * wind.toward_x;
    shift.z_m = height_m > 0.01f ? -0.5f * sum / height_m : 0.0f;
    return shift;
}

/* Flutter of leaves and twigs besides the sway, metres along the leaf's normal. `flexibility` is
 * that of the vertex, 0..1; `phase` differs between leaves, e.g. a sum of its coordinates. */
WD_FUNC float wd_wind_flutter(WD_STRUCT wd_wind wind, float flexibility, float phase,
                              float time_s)
{
    float strength = wind.speed_mps < 12.0f ? wind.speed_mps : 12.0f;
    float wave = wd_wind_wave(time_s * 1.7f + phase) + 0.5f * wd_wind_wave(time_s * 2.9f - phase);
    return 0.004f * strength * flexibility * flexibility * wave;
}

#endif
