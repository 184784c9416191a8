/* tree_pose.h: how a standing tree's model is turned, mirrored, scaled, tinted and blown, alike for
 * everything that draws it. */
#ifndef WD_SHARED_TREE_POSE_H
#define WD_SHARED_TREE_POSE_H

#include "shared/forest.h"
#include "shared/vec.h"
#include "shared/wind.h"

/* offset = (turn (mirror x, y) across, z up) */
struct wd_tree_pose {
    float turn_cos, turn_sin;
    float mirror; /* of x: -1 mirrored */
    float across, up;
};

WD_FUNC WD_STRUCT wd_tree_pose wd_tree_pose_of(WD_STRUCT wd_tree tree, WD_STRUCT wd_model model)
{
    WD_STRUCT wd_tree_pose pose;
    float yaw = WD_FLOAT(tree.look & 0xffffu) * (6.28318530718f / 65536.0f);
    pose.turn_cos = WD_COS(yaw);
    pose.turn_sin = WD_SIN(yaw);
    pose.mirror = (tree.look & 0x1000000u) != 0u ? -1.0f : 1.0f;
    pose.across = WD_TREE_CROWN_M(tree) / model.crown_m;
    pose.up = WD_TREE_HEIGHT_M(tree) / model.height_m;
    return pose;
}

/* Each tree's own brightness and hue about the species' colour. */
WD_FUNC WD_VECTOR wd_tree_tint(WD_STRUCT wd_tree tree)
{
    float spread = WD_FLOAT((tree.look >> 16) & 0xffu) * (1.0f / 128.0f) - 1.0f;
    float other = WD_FLOAT(tree.random >> 24) * (1.0f / 128.0f) - 1.0f;
    return WD_V3(1.0f + 0.30f * spread + 0.10f * other * WD_ABS(spread), 1.0f + 0.22f * spread,
                 1.0f + 0.16f * spread - 0.08f * other * WD_ABS(spread));
}

/* What the wind needs to know of a tree. */
WD_FUNC WD_STRUCT wd_wind_tree wd_wind_tree_of(WD_STRUCT wd_tree tree, float flexibility)
{
    WD_STRUCT wd_wind_tree swaying;
    swaying.x_m = WD_FLOAT(tree.x_mm) * 0.001f;
    swaying.y_m = WD_FLOAT(tree.y_mm) * 0.001f;
    swaying.height_m = WD_TREE_HEIGHT_M(tree);
    swaying.flexibility = flexibility;
    swaying.random = tree.random;
    return swaying;
}

#endif
