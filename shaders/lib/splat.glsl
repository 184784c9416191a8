/* Where a visible tree's splats lie on screen. Expects `splats` (wd_splat[]). */

/* Stratum (x) of the tree's splat number `at`, and which of that stratum's window it is (y). */
uvec2 splat_turn(wd_splat_tree tree, uint at)
{
    uint turn = uint((float(at) + 0.5) / float(tree.strata)); /* exact: at is less than 2^17 */
    return uvec2(at - turn * tree.strata, turn);
}

/* Index among all splats of the one in turn. */
uint splat_index(wd_splat_tree tree, uvec2 turn)
{
    bool wood = turn.x == WD_LEAF_STRATA;
    uint at = (tree.offset + turn.y) & ((wood ? WD_WOOD_SPLATS : WD_STRATUM_SPLATS) - 1u);
    at += wood ? (tree.offset >> 31) * WD_WOOD_SPLATS : 0u;
    return tree.first_splat + turn.x * WD_STRATUM_SPLATS + at;
}

vec3 splat_place(wd_splat splat)
{
    return vec3(splat.xy & 0xffffu, splat.xy >> 16, splat.z_normal & 0xffffu) * (1.0 / 65535.0);
}

/* Not of unit length. */
vec3 splat_normal(wd_splat splat)
{
    vec2 e = unpackSnorm4x8(splat.z_normal).zw;
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float below = max(-n.z, 0.0);
    n.xy -= sign(n.xy) * below;
    return n;
}

/* Clip coordinates x, y and w (z of a cascade) of a place in the model's box. */
vec3 splat_clip(wd_splat_tree tree, vec3 p)
{
    return vec3(dot(tree.clip_x.xyz, p) + tree.clip_x.w, dot(tree.clip_y.xyz, p) + tree.clip_y.w,
                dot(tree.clip_w.xyz, p) + tree.clip_w.w) + tree.sway * (p.z * p.z);
}
