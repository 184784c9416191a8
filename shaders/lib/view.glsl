/* Rays through pixels. Expects `frame` (wd_frame_uniforms). */

/* rel of the point on a pixel's ray that is 1 m off along the view axis */
vec3 pixel_ray(ivec2 at)
{
    vec2 clip = (vec2(at) + 0.5) / vec2(frame.width, frame.height) * 2.0 - 1.0;
    return (frame.rel_from_clip * vec4(clip, 0.0, 1.0)).xyz;
}

bool pixel_is_sky(float depth)
{
    return depth <= 0.0;
}

/* A world without water has its level deeper than this. */
const float WATER_NONE_M = 1e8;

/* How often the ray fits between the eye and the water's surface, or a negative number. No branch
 * hangs on the eye's height alone: llvmpipe makes a shader anew for each such value. */
float water_distance(vec3 ray)
{
    float drop = frame.water_level_m - float(frame.camera_mm[2]) * 0.001 - frame.camera_frac_m.z;
    float at = drop / ray.z;
    bool is_water = frame.water_level_m > -WATER_NONE_M; /* rays are as long as they like */
    return is_water && ray.z < -1e-6 && at > 0.0 && at < WATER_NONE_M ? at : -1.0;
}
