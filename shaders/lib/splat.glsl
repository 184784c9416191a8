/* Where a visible tree's splats lie on screen, and the tables of them, fetched as texels: llvmpipe reads
 * storage buffers lane by lane. */

wd_splat splat_at(usamplerBuffer table, uint index)
{
    uvec2 texel = texelFetch(table, int(index)).xy;
    return wd_splat(texel.x, texel.y);
}

wd_splat_corner splat_corner_at(usamplerBuffer table, uint index)
{
    uvec4 texel = texelFetch(table, int(index));
    return wd_splat_corner(wd_splat(texel.x, texel.y), texel.z, texel.w);
}

/* Corners of a triangle of the model whose triangles begin at `first`. */
uvec3 splat_wood_at(usamplerBuffer table, uint first, uint triangle)
{
    const uint mask = (1u << WD_WOOD_BITS) - 1u;
    uvec4 texel = texelFetch(table, int(first + triangle / WD_WOOD_TRIANGLES));
    uvec2 bits = triangle % WD_WOOD_TRIANGLES == 0u ? texel.xy : texel.zw;
    return first - (uvec3(bits.x, bits.x >> WD_WOOD_BITS | bits.y << (32u - WD_WOOD_BITS),
                          bits.y >> (2u * WD_WOOD_BITS - 32u)) & mask);
}

wd_splat_item splat_item_at(usamplerBuffer table, uint index)
{
    uvec2 texel = texelFetch(table, int(index)).xy;
    return wd_splat_item(texel.x, texel.y);
}

wd_splat_tree splat_tree_at(usamplerBuffer table, uint index)
{
    int first = int(index) * WD_SPLAT_TREE_TEXELS;
    vec4 sway = uintBitsToFloat(texelFetch(table, first + 3));
    vec4 facing = uintBitsToFloat(texelFetch(table, first + 4));
    uvec4 from = texelFetch(table, first + 5), look = texelFetch(table, first + 6);
    uvec4 light = texelFetch(table, first + 7);
    return wd_splat_tree(uintBitsToFloat(texelFetch(table, first)),
                         uintBitsToFloat(texelFetch(table, first + 1)),
                         uintBitsToFloat(texelFetch(table, first + 2)), sway.xyz, sway.w, facing.xyz,
                         facing.w, from.x, from.y, from.z, from.w, look.x, look.y, look.z, look.w,
                         light.x, light.y, light.z, uintBitsToFloat(light.w));
}

float splat_tree_nearer_m(usamplerBuffer table, uint index)
{
    return uintBitsToFloat(texelFetch(table, int(index) * WD_SPLAT_TREE_TEXELS + 7).w);
}

/* Stratum (x) of the tree's splat number `at`, and which of that stratum's window it is (y). */
uvec2 splat_turn(wd_splat_tree tree, uint at)
{
    uint strata = WD_TREE_STRATA(tree);
    uint turn = uint((float(at) + 0.5) / float(strata)); /* exact: at is less than 2^17 */
    uint of_turn = at - turn * strata;
    bool wood = of_turn + WD_TREE_WOOD_LAST(tree) >= strata;
    return uvec2(wood ? WD_LEAF_STRATA : WD_TREE_FIRST_STRATUM(tree) + of_turn, turn);
}

/* Index among all splats of the one in turn. */
uint splat_index(wd_splat_tree tree, uvec2 turn)
{
    bool wood = turn.x == WD_LEAF_STRATA;
    uint at = (tree.offset + turn.y) & ((wood ? WD_WOOD_SPLATS : WD_STRATUM_SPLATS) - 1u);
    at += wood ? WD_TREE_WOOD_HALF(tree) * WD_WOOD_SPLATS : 0u;
    return tree.first_splat + at * WD_SPLAT_STRATA + turn.x;
}

vec3 splat_place(wd_splat splat)
{
    return vec3(splat.xy & 0xffffu, splat.xy >> 16, splat.z_normal & 0xffffu) * (1.0 / 65535.0);
}

/* Not of unit length. */
vec3 octahedral(vec2 e)
{
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float below = max(-n.z, 0.0);
    n.xy -= sign(n.xy) * below;
    return n;
}

/* Its face, likewise. */
vec3 splat_normal(wd_splat splat)
{
    return octahedral(unpackSnorm4x8(splat.z_normal).zw);
}

/* The way along a leaf in the model's box, or the one back; not of unit length. */
vec3 splat_along(wd_splat splat)
{
    vec2 e = vec2(splat.z_normal & 15u, (splat.xy & 3u) | (splat.xy >> 14 & 12u)) * 0.125 - 0.9375;
    vec2 xy = 0.5 * vec2(e.x + e.y, e.x - e.y);
    return vec3(xy, 1.0 - abs(xy.x) - abs(xy.y));
}

/* Clip coordinates x, y and w (z of a cascade) of a place in the model's box. */
vec3 splat_clip(wd_splat_tree tree, vec3 p)
{
    return vec3(dot(tree.clip_x.xyz, p) + tree.clip_x.w, dot(tree.clip_y.xyz, p) + tree.clip_y.w,
                dot(tree.clip_w.xyz, p) + tree.clip_w.w) + tree.sway * (p.z * p.z);
}
