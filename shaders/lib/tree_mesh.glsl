/* A vertex of a tree's mesh where it stands. Expects `frame` (of a storage buffer: see light_water.comp),
 * `push` (wd_tree_push), SHADOW and the libraries tree and tree_vertex. No branch: in one llvmpipe
 * reads the frame lane by lane. */

/* Of a mesh, in the model's frame. */
struct mesh_corner {
    vec3 position_m, normal;
    vec3 face; /* of a leaf as it lies */
    vec2 uv;
    vec4 tint;
    uint kind;
    uint name; /* what the triangle's random number comes from */
    uint open; /* of leaves: ways that the tree leaves open, */
    float lets; /* and share of light along them that it lets through */
};

layout(location = 0) out vec3 out_normal;
layout(location = 1) out vec3 out_uv; /* z: layer of the look */
layout(location = 2) out vec4 out_tint;
layout(location = 3) flat out uvec3 out_flat; /* surface, material (+ 4: mirrored, + 8: levels are shown;
                                                 from bit 4 on: how far wax mirrors what lies beyond the
                                                 tree), random of the triangle */
layout(location = 4) flat out vec4 out_sun_show; /* toward the sun; a: share of triangles that show */
layout(location = 5) out vec4 out_place; /* camera-relative; a: share that moss covers */

/* Moss keeps to the foot of the stem, to the side away from the midday sun and to what faces up. */
float moss_share(vec3 normal, float height_m)
{
    float shade = 0.35 + 0.65 * smoothstep(-0.4, 0.9, normal.y + 0.8 * max(normal.z, 0.0));
    return shade * (exp(-height_m * 0.9) + 0.12 * smoothstep(0.3, 0.9, normal.z));
}

void tree_mesh_vertex(wd_instance instance, wd_tree tree, wd_model model, mesh_corner v)
{
    tree_pose pose = tree_pose_of(tree, model);
    vec3 offset = tree_offset(pose, v.position_m);
    vec3 normal = tree_normal(pose, v.normal);
    bool leaf = (v.kind & WD_VERTEX_LEAF) != 0u;

    offset += tree_bend(tree_wind(), tree, model.flexibility, offset.z, frame.time_s);
    float phase = fract(dot(floor(v.position_m * 4.0), vec3(0.137, 0.311, 0.173)));
    float flutter_m = wd_wind_flutter(tree_wind(), float(v.kind & 0xffu) * (1.0 / 255.0), phase,
                                      frame.time_s);
    offset += normal * (leaf ? flutter_m : 0.0);
    vec3 rel = tree_foot_rel(tree) + offset;
    out_normal = normal;
    out_uv = vec3(v.uv, float(model.look_layer + wd_vertex_layer(v.kind)));
    out_tint = v.tint;
    out_tint.rgb *= leaf ? tree_tint(tree, model) : vec3(1.0);
    uint random = wd_hash2(v.name, wd_tree_random(tree));
    vec3 direction = normalize(rel);
    float beyond = v.lets * mirrors_beyond(v.open, pose, direction, dot(normal, direction) > 0.0 ? -normal : normal,
                                           tree_normal(pose, v.face));
    out_flat = uvec3(instance.tree + 1u, (leaf ? WD_MATERIAL_LEAF : WD_MATERIAL_WOOD)
                         | (pose.mirror.x < 0.0 ? 4u : 0u)
                         | (frame.view_mode == WD_MODE_LOD ? 8u : 0u) | pack_mirrors(beyond), random);
    out_sun_show = vec4(frame.sun_direction, instance.show);
    out_place = vec4(rel, leaf ? 0.0 : model.moss * moss_share(normal, offset.z));
    gl_Position = SHADOW != 0u ? shadow_clip(push.cascade, rel)
                               : frame.clip_from_rel * vec4(rel, 1.0);
}
