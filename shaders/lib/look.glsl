/* Relief of bark and leaves close by. Expects `look_details` and lib/tree.glsl. */

/* Distances from the camera over which relief gives way to the vertices' own smooth normals. */
const float RELIEF_WHOLE_M = 4.0, RELIEF_NONE_M = 20.0;

struct wd_relief {
    vec3 normal;
    float rest; /* of look_details: A */
};

/* How texture coordinates run over the surface seen at this pixel (Schueler, GPU Pro 4: followup
 * normal mapping without precomputed tangents). */
mat3 look_frame(vec3 normal, vec3 rel, vec2 uv)
{
    vec3 px = dFdx(rel), py = dFdy(rel);
    vec2 ux = dFdx(uv), uy = dFdy(uv);
    vec3 across = cross(py, normal), along = cross(normal, px);
    vec3 t = across * ux.x + along * uy.x, b = across * ux.y + along * uy.y;
    float longest = max(max(dot(t, t), dot(b, b)), 1e-30);
    return mat3(t * inversesqrt(max(dot(t, t), 1e-6 * longest)),
                b * inversesqrt(max(dot(b, b), 1e-6 * longest)), normal);
}

/* Whether a sheet's upper side is seen: its texture then runs as it was drawn. */
bool look_upper(vec2 uv, bool mirrored)
{
    vec2 ux = dFdx(uv), uy = dFdy(uv);
    return (ux.x * uy.y - ux.y * uy.x < 0.0) != mirrored;
}

/* The sheet's own normal, turned to the viewer. */
vec3 look_face(vec3 rel)
{
    vec3 face = cross(dFdx(rel), dFdy(rel));
    face *= inversesqrt(max(dot(face, face), 1e-30));
    return dot(face, rel) > 0.0 ? -face : face;
}

wd_relief look_relief(sampler2DArray look_details, mat3 frame_of_uv, vec3 uv)
{
    vec4 detail = texture(look_details, uv);
    vec2 slope = detail.xy * 2.0 - 1.0;
    wd_relief relief;
    relief.normal = normalize(frame_of_uv
                              * vec3(slope, sqrt(max(1.0 - dot(slope, slope), 0.05))));
    relief.rest = detail.a;
    return relief;
}
