/* Leaves on their way down. Expects `frame`, lib/tree.glsl and lib/tree_mesh.glsl. */

/* Moves and turns the corner of a leaf whose foot is at `foot_m` in the model's frame: down, and when it
 * has come to the ground in again at the top, in a spiral, tumbling about its own foot, with the wind. */
void leaf_falls(inout mesh_corner corner, vec3 foot_m, wd_model model, tree_pose pose, uint random)
{
    float own = wd_hash_unit(random), speed_mps = model.fall_mps * (0.7 + 0.6 * own);
    float left_m = mod(foot_m.z - speed_mps * frame.time_s, model.height_m);
    float way_m = model.height_m - left_m, turn = (2.0 + 3.0 * own) * way_m + 40.0 * own;
    vec2 drift = frame.wind_toward * (0.35 * frame.wind_speed_mps / speed_mps
                                      * (way_m - 0.5 * model.height_m));
    vec2 back = vec2(dot(drift, pose.turn), dot(drift, vec2(-pose.turn.y, pose.turn.x)));
    vec3 about = normalize(vec3(cos(turn * 0.37), sin(turn * 0.37), 0.4));
    vec3 arm = corner.position_m - foot_m;
    float c = cos(turn), s = sin(turn);
    arm = arm * c + cross(about, arm) * s + about * (dot(about, arm) * (1.0 - c));
    corner.normal = corner.normal * c + cross(about, corner.normal) * s
                    + about * (dot(about, corner.normal) * (1.0 - c));
    vec2 spiral = 0.18 * vec2(cos(turn * 0.7), sin(turn * 0.7));
    corner.position_m = vec3(foot_m.xy + spiral + back * pose.mirror / pose.across, left_m) + arm;
}
