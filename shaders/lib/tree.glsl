/* Standing trees: from a model's frame to the camera-relative one, with wind.
 * Expects `frame` (wd_frame_uniforms). */
#include "shared/tree_pose.h"

vec3 tree_foot_rel(wd_tree tree)
{
    ivec3 foot_mm = ivec3(tree.x_mm, tree.y_mm, tree.z_mm);
    ivec3 camera_mm = ivec3(frame.camera_mm[0], frame.camera_mm[1], frame.camera_mm[2]);
    return vec3(foot_mm - camera_mm) * 0.001 - frame.camera_frac_m;
}

/* Cosine and sine of the tree's yaw; scale in x and y (x mirrored), scale in z. */
struct tree_pose {
    vec2 turn;
    vec2 mirror; /* x: -1 mirrored */
    float across, up;
};

tree_pose tree_pose_of(wd_tree tree, wd_model model)
{
    wd_tree_pose pose = wd_tree_pose_of(tree, model);
    return tree_pose(vec2(pose.turn_cos, pose.turn_sin), vec2(pose.mirror, 1.0), pose.across,
                     pose.up);
}

vec2 tree_turn(tree_pose pose, vec2 v)
{
    v *= pose.mirror;
    return vec2(pose.turn.x * v.x - pose.turn.y * v.y, pose.turn.y * v.x + pose.turn.x * v.y);
}

/* A model's point as an offset from the tree's foot. */
vec3 tree_offset(tree_pose pose, vec3 model_m)
{
    return vec3(tree_turn(pose, model_m.xy) * pose.across, model_m.z * pose.up);
}

/* A model's normal in world axes: the inverse transpose of the pose. */
vec3 tree_normal(tree_pose pose, vec3 normal)
{
    return normalize(vec3(tree_turn(pose, normal.xy) * pose.up, normal.z * pose.across));
}

/* A direction of the world, seen from the model. */
vec3 tree_toward(tree_pose pose, vec3 v)
{
    vec2 turned = vec2(pose.turn.x * v.x + pose.turn.y * v.y, pose.turn.x * v.y - pose.turn.y * v.x);
    return normalize(vec3(pose.up * turned * pose.mirror, pose.across * v.z));
}

wd_wind tree_wind()
{
    return wd_wind(frame.wind_speed_mps, frame.wind_gust, frame.wind_toward.x, frame.wind_toward.y);
}

/* In any wind, by no branch: llvmpipe reads storage buffers lane by lane in one. */
vec3 tree_bend(wd_wind wind, wd_tree tree, float flexibility, float height_m, float time_s)
{
    wd_wind_tree swaying = wd_wind_tree_of(tree, flexibility);
    wd_wind_shift shift = wd_wind_offset(wind, swaying, height_m, time_s);
    return vec3(shift.x_m, shift.y_m, shift.z_m);
}

vec3 tree_sway_in(wd_wind wind, wd_tree tree, float flexibility, float height_m, float time_s)
{
    if (frame.wind_speed_mps <= 0.0)
        return vec3(0.0);
    return tree_bend(wind, tree, flexibility, height_m, time_s);
}

vec3 tree_sway(wd_tree tree, float flexibility, float height_m, float time_s)
{
    return tree_sway_in(tree_wind(), tree, flexibility, height_m, time_s);
}

vec3 tree_tint(wd_tree tree, wd_model model)
{
    return wd_tree_tint(tree, model);
}

vec3 level_color(uint level)
{
    return level == WD_LEVEL_MESH      ? vec3(0.85, 0.08, 0.05)
           : level == WD_LEVEL_REDUCED ? vec3(0.85, 0.65, 0.05)
                                       : vec3(0.05, 0.25, 0.85);
}

vec4 shadow_clip(uint cascade, vec3 rel)
{
    vec4 at = frame.shadow_from_rel[cascade] * vec4(rel, 1.0);
    return vec4(at.xy * 2.0 - at.w, at.z, at.w);
}

/* Where the noise lies that a tree's cards ask (card_shows): fixed to the pixel of its foot, and
 * another for each tree. */
uint card_noise_shift(wd_tree tree, vec3 foot)
{
    vec4 clip = frame.steady_clip_from_rel * vec4(foot, 1.0); /* samples share their noise */
    vec2 size = vec2(frame.width, frame.height);
    vec2 at = clamp((clip.xy / max(clip.w, 0.01) * 0.5 + 0.5) * size, -1e6, 1e6);
    uint random = wd_tree_random(tree);
    uvec2 shift = uvec2(random & 255u, random >> 8) - uvec2(ivec2(floor(at)));
    return (shift.x & 255u) << 24 | (shift.y & 255u) << 16;
}
