#include "world/packed_trees.h"

static uint32_t variant_bits(uint32_t variants)
{
    uint32_t bits = 0;
    while (1u << bits < variants)
        bits++;
    return bits;
}

bool wd_packed_models_fit(size_t species, uint32_t variants)
{
    return species <= (size_t)1 << (WD_MODEL_BITS - variant_bits(variants));
}

static uint32_t step_mm(int64_t span_mm, uint32_t most)
{
    return span_mm > most ? (uint32_t)((span_mm + most - 1) / most) : 1;
}

struct wd_tree_block wd_tree_block_in(const int64_t least_mm[3], const int64_t most_mm[3],
                                      uint32_t variants)
{
    int64_t east_mm = most_mm[0] - least_mm[0], north_mm = most_mm[1] - least_mm[1];
    uint32_t across = step_mm(east_mm > north_mm ? east_mm : north_mm, WD_ACROSS_MOST);
    return (struct wd_tree_block){
        (int32_t)least_mm[0], (int32_t)least_mm[1], (int32_t)least_mm[2],
        across | step_mm(most_mm[2] - least_mm[2], WD_UP_MOST) << 12 | variant_bits(variants) << 28};
}

static struct wd_tree_block block_of(const struct wd_tree *trees, size_t count, uint32_t variants)
{
    int64_t least_mm[3] = {trees->x_mm, trees->y_mm, trees->z_mm};
    int64_t most_mm[3] = {trees->x_mm, trees->y_mm, trees->z_mm};
    for (size_t i = 1; i < count; i++) {
        const int32_t at_mm[3] = {trees[i].x_mm, trees[i].y_mm, trees[i].z_mm};
        for (int k = 0; k < 3; k++) {
            least_mm[k] = at_mm[k] < least_mm[k] ? at_mm[k] : least_mm[k];
            most_mm[k] = at_mm[k] > most_mm[k] ? at_mm[k] : most_mm[k];
        }
    }
    return wd_tree_block_in(least_mm, most_mm, variants);
}

size_t wd_packed_count(size_t trees)
{
    return trees + (trees + WD_BLOCK_TREES - 1) / WD_BLOCK_TREES;
}

void wd_trees_pack(struct wd_packed_tree *packed, const struct wd_tree *trees, size_t count,
                   uint32_t variants)
{
    for (size_t first = 0; first < count; first += WD_BLOCK_TREES) {
        size_t size = count - first < WD_BLOCK_TREES ? count - first : WD_BLOCK_TREES;
        struct wd_tree_block block = block_of(trees + first, size, variants);
        *packed++ = wd_tree_block_record(block);
        for (size_t i = 0; i < size; i++)
            *packed++ = wd_tree_pack(trees[first + i], block);
    }
}
