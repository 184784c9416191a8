/* How far leaves mirror what lies beyond their tree. Expects lib/tree.glsl and shared/sun_ways.h. */
#include "lib/wax.glsl"
#include "lib/flat_mirrors.glsl"

/* Share of the lobe: `open` has a bit for each way past the leaf's own tree, `face` is the flat leaf's (`normal` is
 * turned to the eye, and may look beyond it). Ways toward the ground count as level ones. */
float mirrors_beyond(uint open, tree_pose pose, vec3 direction, vec3 normal, vec3 face)
{
    vec3 way = wax_mirror(direction, normal);
    float over = dot(face, way) * (dot(face, direction) > 0.0 ? -1.0 : 1.0);
    return smoothstep(-LOBE_SINE, 0.5 * LOBE_SINE, over) * wd_sun_lit(open, wd_sun_mix(tree_toward(pose, way)));
}
