#include "tree/tile_noise.h"

#include <math.h>

#include "shared/hash.h"
#include "tree/four.h"

/* Nearly all are asked for within the period, and a division takes longer than the rest. */
static uint32_t wrapped(int at, int period)
{
    if ((uint32_t)at < (uint32_t)period)
        return (uint32_t)at;
    at %= period;
    return (uint32_t)(at < 0 ? at + period : at);
}

static int floor_int(float x)
{
    int at = (int)x;
    return at - (x < (float)at);
}

static float between(uint32_t key, uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1, float u, float v)
{
    float low = wd_mixf(wd_hash_unit(wd_hash3(key, x0, y0)), wd_hash_unit(wd_hash3(key, x1, y0)), u);
    float high = wd_mixf(wd_hash_unit(wd_hash3(key, x0, y1)), wd_hash_unit(wd_hash3(key, x1, y1)), u);
    return wd_mixf(low, high, v);
}

/* The lattice's neighbours of four places, and how far each is from the first to the second, eased. */
static inline void cells_of(const float x[4], const int period[4], uint32_t first[4], uint32_t second[4], float eased[4])
{
    int at[4];
    uint32_t outside = 0;
    for (int i = 0; i < 4; i++) {
        at[i] = floor_int(x[i]);
        float u = x[i] - (float)at[i];
        eased[i] = u * u * (3 - 2 * u);
        outside |= (uint32_t)at[i] >= (uint32_t)period[i];
    }
    for (int i = 0; i < 4 && outside; i++)
        at[i] = (int)wrapped(at[i], period[i]);
    for (int i = 0; i < 4; i++) {
        first[i] = (uint32_t)at[i];
        second[i] = at[i] + 1 == period[i] ? 0 : (uint32_t)at[i] + 1;
    }
}

float wd_tile_noise(uint32_t key, float x, float y, int period_x, int period_y)
{
    uint32_t first[4], second[4];
    float eased[4];
    cells_of((float[4]){x, y}, (int[4]){period_x, period_y, 1, 1}, first, second, eased);
    return between(key, first[0], first[1], second[0], second[1], eased[0], eased[1]);
}

/* Octaves side by side, four lanes of one loop each. */
WD_FOUR_TWICE float wd_tile_fractal(uint32_t key, float u, float v, int nx, int ny)
{
    const int px[4] = {nx, 2 * nx, 4 * nx, 8 * nx}, py[4] = {ny, 2 * ny, 4 * ny, 8 * ny};
    uint32_t x0[4], y0[4], x1[4], y1[4];
    float x[4], y[4], s[4], t[4], noise[4], sum = 0, share = 0.5f;
    for (int i = 0; i < 4; i++) {
        x[i] = u * (float)px[i];
        y[i] = v * (float)py[i];
    }
    cells_of(x, px, x0, x1, s);
    cells_of(y, py, y0, y1, t);
    for (uint32_t i = 0; i < 4; i++)
        noise[i] = between(key + i, x0[i], y0[i], x1[i], y1[i], s[i], t[i]);
    for (int i = 0; i < 4; i++, share *= 0.5f)
        sum += share * noise[i];
    return sum / 0.9375f;
}

float wd_tile_cells(uint32_t key, float x, float y, int nx, int ny, uint32_t *which)
{
    float first = 1e9f, second = 1e9f;
    int cx = floor_int(x), cy = floor_int(y);
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

float wd_tile_joint(uint32_t key, float x, float y, int nx, int ny, float tall, uint32_t *which)
{
    enum { AROUND = 9 };
    float at[AROUND][2], nearest = 1e9f, joint = 1e9f;
    int cx = floor_int(x), cy = floor_int(y), own = 0;
    for (int k = 0; k < AROUND; k++) {
        int i = cx + k % 3 - 1, j = cy + k / 3 - 1;
        uint32_t h = wd_hash3(key, wrapped(i, nx), wrapped(j, ny));
        at[k][0] = (float)i + 0.15f + 0.7f * wd_hash_unit(h) - x;
        at[k][1] = (float)j + 0.15f + 0.7f * wd_hash_unit(wd_hash1(h)) - y;
        float d = at[k][0] * at[k][0] + at[k][1] * at[k][1];
        if (d < nearest) {
            nearest = d;
            own = k;
            *which = h;
        }
    }
    for (int k = 0; k < AROUND; k++) {
        float a = at[k][0] - at[own][0], b = at[k][1] - at[own][1];
        float off = 0.5f * (a * (at[k][0] + at[own][0]) + b * (at[k][1] + at[own][1]));
        if (k != own) /* the joint is a x + b y = off; a step along a plate is `tall` widths long */
            joint = fminf(joint, off / sqrtf(a * a + b * b / (tall * tall)));
    }
    return joint;
}
