/* The albedo target, sRGB, is stored to as what it holds. */
vec4 stored_albedo(vec4 linear)
{
    vec3 c = clamp(linear.rgb, 0.0, 1.0);
    vec3 curve = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
    return vec4(mix(curve, 12.92 * c, lessThan(c, vec3(0.0031308))), linear.a);
}
