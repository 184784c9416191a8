/* fall.h: leaves on their way down, alike for all that draws them. */
#ifndef WD_SHARED_FALL_H
#define WD_SHARED_FALL_H

#include "shared/hash.h"
#include "shared/tree_pose.h"

/* Where a leaf's foot has come to and how the leaf has turned about it, in the model's frame. */
struct wd_leaf_fall {
    WD_VECTOR foot_m;
    WD_VECTOR about; /* unit */
    float turn_cos, turn_sin;
};

/* Of a leaf whose foot is at `foot_m` at time 0: down, and when it has come to the ground in again at
 * the top, in a spiral, tumbling, with the wind. `random` is the leaf's own: of its number and its
 * tree's. */
WD_FUNC WD_STRUCT wd_leaf_fall wd_leaf_fall_of(WD_VECTOR foot_m, WD_STRUCT wd_model model,
                                               WD_STRUCT wd_tree_pose pose,
                                               WD_STRUCT wd_wind wind, uint32_t random,
                                               float time_s)
{
    WD_STRUCT wd_leaf_fall fall;
    float own = wd_hash_unit(random), speed_mps = model.fall_mps * (0.7f + 0.6f * own);
    float falls = time_s * wd_wind_rate(speed_mps / model.height_m);
    float left_m = wd_fract(foot_m.z / model.height_m - falls) * model.height_m;
    float way_m = model.height_m - left_m, turn = (2.0f + 3.0f * own) * way_m + 40.0f * own;
    float drift_m = 0.35f * wind.speed_mps / speed_mps * (way_m - 0.5f * model.height_m);
    float east_m = wind.toward_x * drift_m, north_m = wind.toward_y * drift_m;
    float x_m = (east_m * pose.turn_cos + north_m * pose.turn_sin) * pose.mirror / pose.across;
    float y_m = (north_m * pose.turn_cos - east_m * pose.turn_sin) / pose.across;
    fall.foot_m = WD_V3(foot_m.x + 0.18f * WD_COS(turn * 0.7f) + x_m,
                        foot_m.y + 0.18f * WD_SIN(turn * 0.7f) + y_m, left_m);
    fall.about = wd_v3_normalize(WD_V3(WD_COS(turn * 0.37f), WD_SIN(turn * 0.37f), 0.4f));
    fall.turn_cos = WD_COS(turn);
    fall.turn_sin = WD_SIN(turn);
    return fall;
}

/* A direction of the leaf as it was at time 0, turned (Rodrigues). */
WD_FUNC WD_VECTOR wd_leaf_fall_turn(WD_STRUCT wd_leaf_fall fall, WD_VECTOR v)
{
    WD_VECTOR k = fall.about;
    WD_VECTOR across = WD_V3(k.y * v.z - k.z * v.y, k.z * v.x - k.x * v.z, k.x * v.y - k.y * v.x);
    WD_VECTOR turned = wd_v3_add(wd_v3_scale(v, fall.turn_cos), wd_v3_scale(across, fall.turn_sin));
    return wd_v3_add(turned, wd_v3_scale(k, wd_v3_dot(k, v) * (1.0f - fall.turn_cos)));
}

#endif
