/* Where a visible tree's splats lie on screen. Expects `splats` (wd_splat[]). */

/* Index among all splats of the tree's splat number `at`. */
uint splat_index(wd_splat_tree tree, uint at)
{
    uint stratum = at / tree.per_stratum, i = at - stratum * tree.per_stratum;
    return tree.first_splat + stratum * WD_STRATUM_SPLATS
           + ((tree.offset + i) & (WD_STRATUM_SPLATS - 1u));
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
