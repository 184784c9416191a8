/* The forest's trees. Expects `trees` (wd_packed_tree[]). */
wd_tree tree_at(uint index)
{
    return wd_tree_unpack(trees[WD_PACKED_AT(index)], wd_tree_block_of(trees[WD_PACKED_HEAD(index)]));
}
