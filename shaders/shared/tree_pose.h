/* tree_pose.h: how a standing tree's model is turned, mirrored, scaled, tinted and blown, alike for
 * everything that draws it. */
#ifndef WD_SHARED_TREE_POSE_H
#define WD_SHARED_TREE_POSE_H

#include "shared/forest.h"
#include "shared/vec.h"
#include "shared/wind.h"

#ifdef __STDC_VERSION__
#define WD_MODEL_V3(model, member) wd_v3_of((model).member)
#else
#define WD_MODEL_V3(model, member) (model).member
#endif

/* offset = (turn (mirror x, y) across, z up) */
struct wd_tree_pose {
    float turn_cos, turn_sin;
    float mirror; /* of x: -1 mirrored */
    float across, up;
};

WD_FUNC WD_STRUCT wd_tree_pose wd_tree_pose_of(WD_STRUCT wd_tree tree, WD_STRUCT wd_model model)
{
    WD_STRUCT wd_tree_pose pose;
    float yaw = WD_TREE_YAW(tree);
    pose.turn_cos = WD_COS(yaw);
    pose.turn_sin = WD_SIN(yaw);
    pose.mirror = WD_TREE_IS_MIRRORED(tree) ? -1.0f : 1.0f;
    pose.across = WD_TREE_CROWN_M(tree) / model.crown_m;
    pose.up = WD_TREE_HEIGHT_M(tree) / model.height_m;
    return pose;
}

/* Area that a model covers seen from elevation asin(sine), `across` as wide and `up` as high. Under a
 * scaling M areas' vectors go with det M times the inverse of M, and so does the direction from which the
 * model is seen. */
WD_FUNC float wd_tree_seen_m2(WD_STRUCT wd_model model, float across, float up, float sine)
{
    float level = WD_SQRT(WD_MAX(1.0f - sine * sine, 0.0f)) / across, above = sine / up;
    float long_by = WD_SQRT(level * level + above * above);
    WD_VECTOR seen = WD_MODEL_V3(model, seen_m2);
    return across * across * up * long_by
           * wd_seen_m2(seen.x, seen.y, seen.z, above / long_by);
}

/* How far a tree's leaves are ahead of its species' in the season, -1..1: by its individual's, for
 * neighbours alike (their soil and their frosts are), and by chance. */
WD_FUNC float wd_tree_phase(WD_STRUCT wd_tree tree, WD_STRUCT wd_model model)
{
    float x = WD_FLOAT(tree.x_mm) * 0.001f, y = WD_FLOAT(tree.y_mm) * 0.001f;
    float place = WD_SIN(x * 0.043f + 2.1f * WD_SIN(y * 0.031f)) * WD_SIN(y * 0.037f + 1.7f);
    float own = WD_FLOAT((wd_tree_random(tree) >> 12) & 0xffu) * (1.0f / 127.5f) - 1.0f;
    return WD_CLAMP(0.6f * model.phase + 0.35f * place + 0.4f * own, -1.0f, 1.0f);
}

/* Each tree's own brightness and hue about the species' colour. */
WD_FUNC WD_VECTOR wd_tree_tint(WD_STRUCT wd_tree tree, WD_STRUCT wd_model model)
{
    float phase = wd_tree_phase(tree, model);
    WD_VECTOR season = wd_v3_mix(WD_V3(1.0f, 1.0f, 1.0f),
                                 phase < 0.0f ? WD_MODEL_V3(model, behind)
                                              : WD_MODEL_V3(model, ahead),
                                 WD_ABS(phase));
    float spread = WD_FLOAT(WD_TREE_TINT(tree)) * (1.0f / 128.0f) - 1.0f;
    float other = WD_FLOAT(wd_tree_random(tree) >> 24) * (1.0f / 128.0f) - 1.0f;
    return wd_v3_mul(season, WD_V3(1.0f + 0.30f * spread + 0.10f * other * WD_ABS(spread),
                                   1.0f + 0.22f * spread,
                                   1.0f + 0.16f * spread - 0.08f * other * WD_ABS(spread)));
}

/* What the wind needs to know of a tree. */
WD_FUNC WD_STRUCT wd_wind_tree wd_wind_tree_of(WD_STRUCT wd_tree tree, float flexibility)
{
    WD_STRUCT wd_wind_tree swaying;
    swaying.x_m = WD_FLOAT(tree.x_mm) * 0.001f;
    swaying.y_m = WD_FLOAT(tree.y_mm) * 0.001f;
    swaying.height_m = WD_TREE_HEIGHT_M(tree);
    swaying.flexibility = flexibility;
    swaying.random = wd_tree_random(tree);
    return swaying;
}

#endif
