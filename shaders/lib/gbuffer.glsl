/* What the G-buffer says of a pixel. Expects `frame` and the four images. */
#include "lib/pixel.glsl"
#include "lib/disc.glsl"

wd_pixel gbuffer_pixel(ivec2 at, float depth)
{
    wd_pixel pixel;
    pixel.ray = pixel_ray(at);
    pixel.direction = normalize(pixel.ray);
    pixel.axis_m = frame.near_m / max(depth, 1e-30);
    pixel.rel = pixel.ray * pixel.axis_m;
    vec4 albedo = texelFetch(gbuffer_albedo, at, 0);
    vec4 normal = texelFetch(gbuffer_normal, at, 0);
    pixel.albedo = albedo.rgb;
    pixel.openness = albedo.a;
    pixel.material = uint(normal.w * 3.0 + 0.5);
    pixel.surface = texelFetch(gbuffer_surface, at, 0).x;
    bool disc = pixel.material == WD_MATERIAL_GROUND && pixel.surface != 0u;
    pixel_set_normal(pixel, disc ? disc_normal(normal) : normal.xyz * 2.0 - 1.0);
    float told = disc_told(normal);
    uint kind = disc_kind(told);
    bool bark = disc && kind == DISC_BARK;
    if (disc)
        pixel.material = bark || kind == DISC_WOOD ? WD_MATERIAL_WOOD : WD_MATERIAL_LEAF;
    else if (ALL_SINGLE)
        pixel.material = pixel.surface != 0u ? WD_MATERIAL_WOOD : WD_MATERIAL_GROUND;
    pixel.snow_up = bark ? disc_snow_up(told) : pixel.snow_up;
    pixel.lit = disc && !bark ? disc_lit(told) : -1.0;
    pixel.above = kind >= DISC_LEAF_ABOVE ? 1.0 : 0.0;
    pixel.mirrors = disc_mirrors(kind);
    pixel_lay_snow(pixel);
    return pixel;
}
