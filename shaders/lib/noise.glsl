/* Gradient noise (Perlin 2002) over the ground that does not swim or jitter: its lattice is counted
 * in whole millimetres of the world. Expects `frame` (wd_frame_uniforms). */

struct wd_lattice {
    ivec2 cell;
    vec2 share;
};

/* The lattice of 2^bits mm at a camera-relative place. */
wd_lattice lattice_at(vec2 rel, int bits)
{
    ivec2 camera_mm = ivec2(frame.camera_mm[0], frame.camera_mm[1]);
    vec2 rest_m = vec2(camera_mm & ((1 << bits) - 1)) * 0.001 + frame.camera_frac_m.xy;
    vec2 at = (rest_m + rel) * (1000.0 / float(1 << bits));
    vec2 whole = floor(at);
    return wd_lattice((camera_mm >> bits) + ivec2(whole), at - whole);
}

uint lattice_hash(ivec2 cell, uint salt)
{
    uint h = uint(cell.x) * 0x9e3779b1u ^ uint(cell.y) * 0x85ebca77u ^ salt;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    return h ^ (h >> 13);
}

float lattice_random(ivec2 cell, uint salt)
{
    return float(lattice_hash(cell, salt) >> 8) * 5.9604645e-8;
}

vec2 lattice_gradient(ivec2 cell, uint salt)
{
    uint h = lattice_hash(cell, salt);
    return vec2(float(h & 0xffffu), float(h >> 16)) * (2.0 / 65535.0) - 1.0;
}

/* x: noise, about -0.7..0.7; yz: its gradient per lattice cell. */
vec3 gradient_noise(wd_lattice at, uint salt)
{
    vec2 f = at.share;
    vec2 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    vec2 du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    vec2 ga = lattice_gradient(at.cell, salt);
    vec2 gb = lattice_gradient(at.cell + ivec2(1, 0), salt);
    vec2 gc = lattice_gradient(at.cell + ivec2(0, 1), salt);
    vec2 gd = lattice_gradient(at.cell + ivec2(1, 1), salt);
    float a = dot(ga, f), b = dot(gb, f - vec2(1.0, 0.0));
    float c = dot(gc, f - vec2(0.0, 1.0)), d = dot(gd, f - vec2(1.0, 1.0));
    float k = a - b - c + d;
    vec2 slope = ga + u.x * (gb - ga) + u.y * (gc - ga) + u.x * u.y * (ga - gb - gc + gd)
                 + du * (u.yx * k + vec2(b, c) - a);
    return vec3(a + u.x * (b - a) + u.y * (c - a) + u.x * u.y * k, slope);
}

/* How much of a wave of 2^bits mm a pixel of this size may show before it would shimmer. */
float noise_share(float footprint_m, int bits)
{
    return 1.0 - smoothstep(0.2, 0.6, footprint_m * (1000.0 / float(1 << bits)));
}

/* White noise of a pixel and sample, for sampling patterns. */
float pixel_noise(uvec2 pixel, uint salt)
{
    /* interleaved gradient noise (Jimenez 2014), moved on by the golden ratio a sample */
    float phase = fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
    return fract(phase + 0.618033989 * float(salt));
}
