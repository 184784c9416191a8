#include "bake/mixed.h"

#include <math.h>
#include <stdbool.h>

enum { HALVINGS = 12 };

/* What leaves would have if wood had `ratio` times as much. */
static double leaves_at(const struct wd_mixed_sums *sums, int kind, float ratio)
{
    double leaves = 0;
    for (int i = 0; i < 256; i++) {
        float leaf = (float)i / 255;
        leaves += (double)(leaf * wd_mixed_leaf((float)sums->all[i][kind], leaf, ratio));
    }
    return leaves;
}

/* The more wood has, the less leaves. */
static uint32_t find_ratio(const struct wd_mixed_sums *sums, int kind)
{
    double least = leaves_at(sums, kind, 8), most = leaves_at(sums, kind, 0.125f);
    float low = -3, high = 3;
    if (most - least <= 1e-3 * most)
        return 128;
    for (int i = 0; i < HALVINGS; i++) {
        float middle = 0.5f * (low + high);
        bool more = leaves_at(sums, kind, exp2f(middle)) > sums->leaves[kind];
        low = more ? middle : low;
        high = more ? high : middle;
    }
    return wd_mixed_byte(exp2f(low));
}

uint32_t wd_mixed_ratios(const struct wd_mixed_sums *sums, uint32_t count)
{
    struct wd_mixed_sums sum = {0};
    uint32_t packed = 0;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < WD_MIXED_KINDS; k++) {
            sum.leaves[k] += sums[i].leaves[k];
            for (int leaf = 0; leaf < 256; leaf++)
                sum.all[leaf][k] += sums[i].all[leaf][k];
        }
    for (int k = 0; k < WD_MIXED_KINDS; k++)
        packed |= find_ratio(&sum, k) << (8 * k);
    return packed;
}
