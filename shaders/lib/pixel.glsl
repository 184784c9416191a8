/* What is known of a surface at a pixel before it is lit. Expects `frame`. */
#include "lib/view.glsl"
#include "shared/snow.h"

/* Whether all leaves are single ones (lib/disc.glsl); then what is known of clouds of them is left out. */
#ifndef ALL_SINGLE
#define ALL_SINGLE false
#endif

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
    float lit;        /* share of the sun that a disc's own tree lets through; -1: not known */
    float above;      /* 1: the upper side of a disc's leaf */
    float mirrors;    /* share of what its wax mirrors that lies beyond its tree; the rest: the tree's leaves */
    uint surface;     /* tree + 1, or 0 */
    float snow_up;    /* share of snow that stays on what looks so */
    float snow;       /* share of a tree's surface that lies under snow */
};

/* `mean` is of 8-bit numbers: what may have been of unit length is. */
void pixel_set_normal(inout wd_pixel pixel, vec3 mean)
{
    float length_of_mean = max(length(mean), 1e-4);
    pixel.normal = (mean + vec3(0.0, 0.0, 1e-6)) / length_of_mean;
    pixel.facing = pixel.normal * min(1.005 * length_of_mean, 1.0);
    pixel.snow_up = wd_snow_up(pixel.normal.z);
}

/* Metres that a pixel spans where it shows something. */
float pixel_size_m(wd_pixel pixel)
{
    return pixel.axis_m * length(pixel_ray(ivec2(0, 1)) - pixel_ray(ivec2(0, 0)));
}

/* Snow on trees: it hides what it lies on, and its pads are smoother than leaves. */
void pixel_lay_snow(inout wd_pixel pixel)
{
    pixel.snow = 0.0;
    if (frame.snow == 0.0 || pixel.surface == 0u || frame.view_mode == WD_MODE_LOD)
        return;
    pixel.snow = wd_snow_share_on(pixel.rel, pixel.snow_up, pixel.openness, pixel_size_m(pixel));
    pixel.albedo = mix(pixel.albedo, WD_SNOW_ALBEDO, pixel.snow);
    pixel.normal = normalize(mix(pixel.normal, vec3(0.0, 0.0, 1.0), 0.5 * pixel.snow));
    pixel.facing = mix(pixel.facing, vec3(0.0, 0.0, length(pixel.facing)), 0.5 * pixel.snow);
}
