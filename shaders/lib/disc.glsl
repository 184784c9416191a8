/* What the normal target holds of a continuum's disc: the normal, folded to an octahedron, in R and G; in B
 * two bits of what is seen over eight of the share of the sun that its own tree lets through. */

const uint DISC_WOOD = 0u;
const uint DISC_LEAF_ABOVE = 1u; /* a leaf's upper side */
const uint DISC_LEAF_BELOW = 2u;

vec4 disc_pack(vec3 normal, uint kind, float lit)
{
    vec2 e = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    vec2 folded = (1.0 - abs(e.yx)) * vec2(e.x < 0.0 ? -1.0 : 1.0, e.y < 0.0 ? -1.0 : 1.0);
    e = normal.z < 0.0 ? folded : e;
    float share = floor(clamp(lit, 0.0, 1.0) * 255.0 + 0.5);
    return vec4(e * 0.5 + 0.5, (float(kind << 8) + share) / 1023.0, 0.0);
}

/* Of a leaf's mesh, whose shade the maps hold. */
const float DISC_LIT_MESH = 1.0;
const float DISC_LIT_LEAST = 1.0 / 255.0, DISC_LIT_MOST = 254.0 / 255.0;

/* `face`: across the leaf, out of the side that the eye sees; `normal` is turned as the path tracer turns
 * it. Where the sun is on one side of the leaf and on the other of that normal, none of its light goes
 * on to the eye: 0. */
vec4 disc_pack_seen(vec3 normal, vec3 face, vec3 eye, vec3 sun, uint kind, float lit)
{
    normal = dot(normal, face) < 0.0 ? -normal : normal;
    normal = dot(normal, eye) <= 0.0 ? face : normal;
    bool lost = dot(normal, sun) * dot(face, sun) < 0.0;
    return disc_pack(normal, kind, lost ? 0.0 : lit);
}

vec3 disc_normal(vec4 packed)
{
    vec2 e = packed.xy * 2.0 - 1.0;
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float below = max(-n.z, 0.0);
    n.xy -= vec2(n.x < 0.0 ? -below : below, n.y < 0.0 ? -below : below);
    return normalize(n);
}

uint disc_kind(vec4 packed)
{
    return uint(packed.z * 1023.0 + 0.5) >> 8;
}

float disc_lit(vec4 packed)
{
    return float(uint(packed.z * 1023.0 + 0.5) & 255u) * (1.0 / 255.0);
}
