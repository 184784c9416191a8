/* Expects lib/splat.glsl, `splat_trees` and `items`. */

/* Of a splat's pixel (id, depth), whose depth's last bit says whether it was brought nearer: discs that nothing of
 * their tree hides are only sorted as if they were nearer. */
float splat_true_depth(uvec2 pixel, float near_m)
{
    uint tree = splat_item_at(items, (pixel.x - 1u) / WD_ITEM_SPLATS).tree;
    float nearer_m = splat_tree_nearer_m(splat_trees, tree) * float(pixel.y & 1u);
    float depth = uintBitsToFloat(pixel.y);
    return depth / (1.0 + nearer_m * depth / near_m);
}
