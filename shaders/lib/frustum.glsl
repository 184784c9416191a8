/* Boxes against a view's half-spaces. Expects `frame` and `view` (wd_splat_view). */

vec3 rel_of_mm(ivec3 mm)
{
    ivec3 camera_mm = ivec3(frame.camera_mm[0], frame.camera_mm[1], frame.camera_mm[2]);
    return vec3(mm - camera_mm) * 0.001 - frame.camera_frac_m;
}

bool box_is_outside(vec3 low, vec3 high)
{
    bool outside;
    uint i = 0u;
    do {
        vec4 plane = view_block.planes[i];
        vec3 corner = mix(low, high, greaterThan(plane.xyz, vec3(0.0)));
        outside = dot(plane.xyz, corner) + plane.w < 0.0;
    } while (!outside && ++i < view.plane_count);
    return outside;
}
