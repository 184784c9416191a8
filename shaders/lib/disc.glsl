/* What the normal target holds of a single leaf, of bark close by or of a continuum's disc of wood: the normal, folded to
 * an octahedron, in R and G; in B what is seen and the share of the sun that its own tree lets through, in DISC_LIT_STEPS,
 * or of bark how much snow stays on its stem, for the normal is its relief's. */

const uint DISC_WOOD = 0u;
const uint DISC_LEAF_BELOW = 1u; /* a leaf's lower side */
const uint DISC_LEAF_ABOVE = 2u; /* its upper side, and above this in DISC_MIRRORS_MOST steps the share of what its
                                    wax mirrors that lies beyond its own tree */
const uint DISC_MIRRORS_MOST = 15u;
const uint DISC_BARK = DISC_LEAF_ABOVE + DISC_MIRRORS_MOST + 1u; /* of a mesh, in as many steps as 10 bits leave */
const float DISC_BARK_TOP = 15.0;
const float DISC_LIT_STEPS = 56.0, DISC_LIT_TOP = 55.0;

vec2 disc_fold(vec3 normal)
{
    vec2 e = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    vec2 folded = (1.0 - abs(e.yx)) * vec2(e.x < 0.0 ? -1.0 : 1.0, e.y < 0.0 ? -1.0 : 1.0);
    return (normal.z < 0.0 ? folded : e) * 0.5 + 0.5;
}

vec4 disc_pack(vec3 normal, uint kind, float lit)
{
    float share = floor(clamp(lit, 0.0, 1.0) * DISC_LIT_TOP + 0.5);
    return vec4(disc_fold(normal), (float(kind) * DISC_LIT_STEPS + share) / 1023.0, 0.0);
}

vec4 disc_pack_bark(vec3 normal, float snow_up)
{
    float share = floor(sqrt(snow_up) * DISC_BARK_TOP + 0.5); /* finest for upright stems, which are dark */
    return vec4(disc_fold(normal), (float(DISC_BARK) * DISC_LIT_STEPS + share) / 1023.0, 0.0);
}

/* Of a leaf's mesh, whose shade the maps hold. */
const float DISC_LIT_MESH = 1.0;
const float DISC_LIT_LEAST = 1.0 / DISC_LIT_TOP, DISC_LIT_MOST = 1.0 - DISC_LIT_LEAST;

uint disc_above(float mirrors)
{
    return DISC_LEAF_ABOVE + uint(mirrors * float(DISC_MIRRORS_MOST) + 0.5);
}

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

/* Its kind and what is lit of it, before they are told apart. */
float disc_told(vec4 packed)
{
    return floor(packed.z * 1023.0 + 0.5);
}

uint disc_kind(float told)
{
    return uint((told + 0.5) * (1.0 / DISC_LIT_STEPS));
}

float disc_lit(float told)
{
    float steps = told - float(disc_kind(told)) * DISC_LIT_STEPS;
    return steps < DISC_LIT_TOP ? steps * (1.0 / DISC_LIT_TOP) : DISC_LIT_MESH;
}

float disc_mirrors(uint kind)
{
    return float(max(kind, DISC_LEAF_ABOVE) - DISC_LEAF_ABOVE) * (1.0 / float(DISC_MIRRORS_MOST));
}

float disc_snow_up(float told)
{
    float share = (told - float(DISC_BARK) * DISC_LIT_STEPS) * (1.0 / DISC_BARK_TOP);
    return share * share;
}
