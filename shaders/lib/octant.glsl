/* A tree in a picture of an octant: a rectangle that its card fills. Expects `tree_at`, `models`,
 * `pictures` and `push`. Places in a picture are metres from its lower left far corner. */
#include "shared/octant.h"
#include "shared/tree_pose.h"

struct octant_tree {
    wd_octant_picture picture;
    wd_octant_frame axes;
    wd_tree tree;
    wd_model model;
    wd_tree_pose pose;
    vec3 foot; /* right, up, toward the viewer */
};

octant_tree octant_tree_of(uint tree, uint picture)
{
    octant_tree t;
    t.picture = pictures[picture];
    t.axes = wd_octant_frame_of(t.picture.side);
    t.tree = tree_at(tree);
    t.model = models[WD_TREE_SPECIES(t.tree) * push.variants
                     + WD_TREE_VARIANT(t.tree) % push.variants];
    t.pose = wd_tree_pose_of(t.tree, t.model);
    ivec3 corner_mm = ivec3(t.picture.corner_mm[0], t.picture.corner_mm[1], t.picture.corner_mm[2]);
    vec3 rel = vec3(ivec3(t.tree.x_mm, t.tree.y_mm, t.tree.z_mm) - corner_mm) * 0.001;
    t.foot = vec3(dot(rel, t.axes.right), dot(rel, t.axes.up), dot(rel, t.axes.toward));
    /* axes that run against the world's begin at the cube's far side */
    t.foot += t.picture.size_m
              * vec3(lessThan(vec3(dot(t.axes.right, vec3(1.0)), dot(t.axes.up, vec3(1.0)),
                                   dot(t.axes.toward, vec3(1.0))),
                              vec3(0.0)));
    return t;
}

bool octant_level(octant_tree t)
{
    return t.picture.side >= 4u;
}

/* The rectangle's lower left (xy) and upper right (zw) corner, as far as the picture goes; half a pixel
 * more all around, for pixels look up a place anywhere within them. */
vec4 octant_rectangle(octant_tree t)
{
    float reach = t.pose.across
                  * (octant_level(t) ? 1.42 * t.model.half_depth_m : t.model.half_width_m);
    vec4 box = octant_level(t)
                   ? t.foot.xyxy + vec4(-reach, -reach, reach, reach)
                   : vec4(t.foot.x - reach, t.foot.y + t.model.bottom_m * t.pose.up,
                          t.foot.x + reach, t.foot.y + t.model.top_m * t.pose.up);
    float more_m = 0.5 * t.picture.size_m / float(push.tile_pixels);
    return clamp(box + more_m * vec4(-1.0, -1.0, 1.0, 1.0), 0.0, t.picture.size_m);
}

/* A world direction in the model's axes, level part. */
vec2 octant_model_axis(octant_tree t, vec2 v)
{
    return vec2((v.x * t.pose.turn_cos + v.y * t.pose.turn_sin) * t.pose.mirror,
                v.y * t.pose.turn_cos - v.x * t.pose.turn_sin);
}
