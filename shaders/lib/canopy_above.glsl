/* Share of the canopy's leaves that lie over a height: what lies above a plane through an ellipsoid. */
float canopy_above(vec2 layer_m, float height_m)
{
    float above = 1.0 - smoothstep(layer_m.x, max(layer_m.y, layer_m.x + 0.5), height_m);
    return above * above;
}
