#include "tree/tile_noise.h"

#include "shared/hash.h"
#include "tree/vec.h"

static uint32_t wrapped(int at, int period)
{
    at %= period;
    return (uint32_t)(at < 0 ? at + period : at);
}

float wd_tile_noise(uint32_t key, float x, float y, int period_x, int period_y)
{
    float fx = floorf(x), fy = floorf(y), u = x - fx, v = y - fy;
    uint32_t x0 = wrapped((int)fx, period_x), y0 = wrapped((int)fy, period_y);
    uint32_t x1 = x0 + 1 == (uint32_t)period_x ? 0 : x0 + 1;
    uint32_t y1 = y0 + 1 == (uint32_t)period_y ? 0 : y0 + 1;
    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    float low = wd_mixf(wd_hash_unit(wd_hash3(key, x0, y0)), wd_hash_unit(wd_hash3(key, x1, y0)),
                        u);
    float high = wd_mixf(wd_hash_unit(wd_hash3(key, x0, y1)), wd_hash_unit(wd_hash3(key, x1, y1)),
                         u);
    return wd_mixf(low, high, v);
}

float wd_tile_fractal(uint32_t key, float u, float v, int nx, int ny)
{
    float sum = 0, share = 0.5f;
    for (uint32_t octave = 0; octave < 4; octave++) {
        sum += share * wd_tile_noise(key + octave, u * (float)nx, v * (float)ny, nx, ny);
        nx *= 2;
        ny *= 2;
        share *= 0.5f;
    }
    return sum / 0.9375f;
}

float wd_tile_cells(uint32_t key, float x, float y, int nx, int ny, uint32_t *which)
{
    float first = 1e9f, second = 1e9f;
    int cx = (int)floorf(x), cy = (int)floorf(y);
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            uint32_t h = wd_hash3(key, wrapped(cx + i, nx), wrapped(cy + j, ny));
            float px = (float)(cx + i) + 0.15f + 0.7f * wd_hash_unit(h) - x;
            float py = (float)(cy + j) + 0.15f + 0.7f * wd_hash_unit(wd_hash1(h)) - y;
            float d = px * px + py * py;
            if (d < first) {
                second = first;
                first = d;
                *which = h;
            } else if (d < second) {
                second = d;
            }
        }
    return sqrtf(second) - sqrtf(first);
}
