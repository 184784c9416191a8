/* Unpacking of struct wd_tree_vertex and struct wd_packed_vertex. */

vec3 octahedral_decode(vec2 e)
{
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (n.z < 0.0)
        n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return normalize(n);
}

vec3 tree_vertex_normal(wd_tree_vertex v)
{
    return octahedral_decode(unpackSnorm2x16(v.normal));
}

vec3 packed_vertex_normal(wd_packed_vertex v)
{
    return octahedral_decode(unpackSnorm4x8(v.normal_tint).xy);
}

vec4 packed_vertex_tint(wd_packed_vertex v)
{
    vec3 root = vec3(v.normal_tint >> 16 & 31u, v.normal_tint >> 21 & 63u, v.normal_tint >> 27)
                * (1.0 / vec3(31.0, 63.0, 31.0));
    return vec4(root * root, float(v.z_kind >> 26) * (1.0 / 63.0));
}
