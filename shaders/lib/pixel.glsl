/* What is known of a surface at a pixel before it is lit. Expects `frame`. */
#include "lib/view.glsl"

struct wd_pixel {
    vec3 ray;         /* rel of a point on the pixel's ray at 1 m along the view axis */
    vec3 direction;   /* unit */
    float axis_m;     /* distance along the view axis; infinite for the sky */
    vec3 rel;
    vec3 albedo;
    float openness;
    vec3 normal;
    uint material;
    uint surface;     /* tree + 1, or 0 */
};
