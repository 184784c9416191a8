/* Unpacking of struct wd_tree_vertex. */

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
