/* The depth pyramid. Expects `view` (wd_splat_view) and `pyramid`: float[] or, with PYRAMID_TEXELS, its
 * samplerBuffer. */

uvec2 pyramid_size(uint level)
{
    uint texel = 2u << level;
    return (uvec2(view.width, view.height) + texel - 1u) >> (level + 1u);
}

float pyramid_at(uint level, uvec2 at)
{
    uint index = view_block.pyramid_first[level] + at.y * pyramid_size(level).x + at.x;
#ifdef PYRAMID_TEXELS
    return texelFetch(pyramid, int(index)).x;
#else
    return pyramid[index];
#endif
}
