#version 460
/* Depth of a cascade from the visibility buffer, a word a texel. */

layout(set = 0, binding = 1) uniform usamplerBuffer pixels; /* of two words */

layout(location = 0) flat in uvec2 in_row;

void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy) >> in_row.y;
    uint word = at.y * in_row.x + at.x;
    uvec2 pair = texelFetch(pixels, int(word >> 1)).xy;
    gl_FragDepth = uintBitsToFloat((word & 1u) != 0u ? pair.y : pair.x);
}
