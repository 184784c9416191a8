/* Whether something so near may show at a pixel, for all that is there by now. Pixels' depths only grow
 * while splats are drawn, so that an old one costs an atomic operation too many and never one too few;
 * a fetch is cheaper than that. Expects `drawn`, the visibility buffer as texels, and ORTHOGRAPHIC. */
bool may_show(uint pixel, uint depth_bits)
{
    return ORTHOGRAPHIC != 0u || imageLoad(drawn, int(pixel)).y <= depth_bits;
}
