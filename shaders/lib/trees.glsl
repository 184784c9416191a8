/* The forest's trees. Expects `trees`: wd_packed_tree[] or, with TREE_TEXELS, its usamplerBuffer. */
wd_packed_tree tree_record(uint index)
{
#ifdef TREE_TEXELS
    uvec4 texel = texelFetch(trees, int(index));
    return wd_packed_tree(texel.x, texel.y, texel.z, texel.w);
#else
    return trees[index];
#endif
}

wd_tree tree_at(uint index)
{
    return wd_tree_unpack(tree_record(WD_PACKED_AT(index)),
                          wd_tree_block_of(tree_record(WD_PACKED_HEAD(index))));
}
