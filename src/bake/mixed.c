#include "bake/mixed.h"

#include <math.h>
#include <stdbool.h>

enum { HALVINGS = 12 };

/* What leaves would have if wood had `ratio` times as much. */
static double leaves_at(const struct wd_mixed_sums *sums, int kind, double ratio)
{
    double leaves = 0;
    for (int i = 0; i < 256; i++) {
        double leaf = i / 255.0;
        leaves += sums->all[i][kind] * leaf / (leaf + (1 - leaf) * ratio);
    }
    return leaves;
}

/* The more wood has, the less leaves. */
static uint32_t find_ratio(const struct wd_mixed_sums *sums, int kind)
{
    double low = -3, high = 3, least = leaves_at(sums, kind, 8), most = leaves_at(sums, kind, 0.125);
    if (most - least <= 1e-3 * most)
        return 128;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (low + high);
        bool more = leaves_at(sums, kind, exp2(middle)) > sums->leaves[kind];
        low = more ? middle : low;
        high = more ? high : middle;
    }
    return wd_mixed_byte((float)exp2(low));
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

void wd_mixed_put(uint8_t bytes[WD_MIXED_BYTES], uint32_t ratios)
{
    for (int k = 0; k < WD_MIXED_BYTES; k++)
        bytes[k] = (uint8_t)(ratios >> (8 * k));
}

uint32_t wd_mixed_get(const uint8_t bytes[WD_MIXED_BYTES])
{
    uint32_t ratios = 0;
    for (int k = 0; k < WD_MIXED_BYTES; k++)
        ratios |= (uint32_t)bytes[k] << (8 * k);
    return ratios;
}
