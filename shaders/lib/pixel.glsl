/* What is known of a surface at a pixel before it is lit. Expects `frame`. */
#include "lib/view.glsl"

struct wd_pixel {
    vec3 ray;         /* rel of a point on the pixel's ray at 1 m along the view axis */
    vec3 direction;   /* unit */
    float axis_m;     /* distance along the view axis; infinite for the sky */
    vec3 rel;
    vec3 albedo;
    float openness;
    vec3 normal;      /* unit */
    vec3 facing;      /* mean of the normals of what the pixel shows: the shorter, the more they spread */
    uint material;
    uint surface;     /* tree + 1, or 0 */
};

/* `mean` is of 8-bit numbers: what may have been of unit length is. */
void pixel_set_normal(inout wd_pixel pixel, vec3 mean)
{
    float length_of_mean = max(length(mean), 1e-4);
    pixel.normal = (mean + vec3(0.0, 0.0, 1e-6)) / length_of_mean;
    pixel.facing = pixel.normal * min(1.005 * length_of_mean, 1.0);
}
