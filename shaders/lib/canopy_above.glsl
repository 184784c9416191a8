/* Share of the canopy's leaves that lie over a height: what lies above a plane through an ellipsoid. */
float canopy_above(vec2 layer_m, float height_m)
{
    float above = 1.0 - smoothstep(layer_m.x, max(layer_m.y, layer_m.x + 0.5), height_m);
    return above * above;
}

/* Of the leaves over a place beside those of its own tree, this power of their share hides the sky there. By
 * path-traced stands of five species, 5 and 8 m apart, under an even sky. */
const float NEIGHBOURS_OVER = 0.75;
