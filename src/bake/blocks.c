#include "bake/blocks.h"

#include <math.h>
#include <stdbool.h>

enum { SIDE = 4, TEXELS = SIDE * SIDE, ALPHA_BYTES = 8, BLOCK_BYTES = 16, COLORS = 4, ALPHAS = 8 };
enum { POWER_STEPS = 6, REFINEMENTS = 2 };
static const float LEAST_WEIGHT = 0.02f; /* of texels that show nothing: filters read them */

struct block {
    float rgb[TEXELS][3];
    float weight[TEXELS];
    uint8_t alpha[TEXELS];
};

static uint32_t block_count(uint32_t texels)
{
    return (texels + SIDE - 1) / SIDE;
}

size_t wd_blocks_bytes(uint32_t width, uint32_t height)
{
    return (size_t)BLOCK_BYTES * block_count(width) * block_count(height);
}

size_t wd_alpha_blocks_bytes(uint32_t width, uint32_t height)
{
    return (size_t)ALPHA_BYTES * block_count(width) * block_count(height);
}

/* --- opacity ----------------------------------------------------------------------------- */

/* The eight steps between two ends, the first above the second; or, where it is not, six and 0, 255. */
static void alpha_steps(int steps[ALPHAS], int first, int second)
{
    steps[0] = first;
    steps[1] = second;
    int parts = first > second ? 7 : 5;
    for (int i = 1; i < parts; i++)
        steps[i + 1] = ((parts - i) * first + i * second) / parts;
    if (first <= second) {
        steps[6] = 0;
        steps[7] = 255;
    }
}

/* Indices of the nearest steps; returns the squared error. */
static int choose_alphas(uint64_t *indices, const struct block *block, int first, int second)
{
    int steps[ALPHAS], error = 0;
    alpha_steps(steps, first, second);
    *indices = 0;
    for (int i = 0; i < TEXELS; i++) {
        int best = 0, least = 1 << 20;
        for (int k = 0; k < ALPHAS; k++) {
            int off = block->alpha[i] - steps[k];
            if (off * off < least) {
                least = off * off;
                best = k;
            }
        }
        error += least;
        *indices |= (uint64_t)best << (3 * i);
    }
    return error;
}

/* Both ways that a block can be read: between the ends of all texels, or of those between. */
static void pack_alpha(uint8_t *out, const struct block *block)
{
    int low = 255, high = 0, inner_low = 255, inner_high = 0;
    for (int i = 0; i < TEXELS; i++) {
        int a = block->alpha[i];
        low = a < low ? a : low;
        high = a > high ? a : high;
        if (a > 0 && a < 255) {
            inner_low = a < inner_low ? a : inner_low;
            inner_high = a > inner_high ? a : inner_high;
        }
    }
    if (inner_low > inner_high)
        inner_low = inner_high = 0;
    uint64_t all, inner;
    int all_error = choose_alphas(&all, block, high, low);
    int inner_error = choose_alphas(&inner, block, inner_low, inner_high);
    bool use_inner = inner_error < all_error;
    uint64_t bits = (use_inner ? (uint64_t)inner_low | (uint64_t)inner_high << 8 | inner << 16
                               : (uint64_t)high | (uint64_t)low << 8 | all << 16);
    for (int i = 0; i < ALPHA_BYTES; i++)
        out[i] = (uint8_t)(bits >> (8 * i));
}

/* --- colour ------------------------------------------------------------------------------ */

static int to_bits(float value, int most)
{
    float scaled = value * (float)most / 255 + 0.5f;
    return scaled < 0 ? 0 : scaled > (float)most ? most : (int)scaled;
}

static uint32_t pack_565(const float rgb[3])
{
    return (uint32_t)(to_bits(rgb[0], 31) << 11 | to_bits(rgb[1], 63) << 5 | to_bits(rgb[2], 31));
}

static void unpack_565(int rgb[3], uint32_t packed)
{
    int r = (int)(packed >> 11 & 31), g = (int)(packed >> 5 & 63), b = (int)(packed & 31);
    rgb[0] = r << 3 | r >> 2;
    rgb[1] = g << 2 | g >> 4;
    rgb[2] = b << 3 | b >> 2;
}

/* BC3 always has four colours. */
static void color_steps(int steps[COLORS][3], uint32_t first, uint32_t second)
{
    unpack_565(steps[0], first);
    unpack_565(steps[1], second);
    for (int k = 0; k < 3; k++) {
        steps[2][k] = (2 * steps[0][k] + steps[1][k]) / 3;
        steps[3][k] = (steps[0][k] + 2 * steps[1][k]) / 3;
    }
}

static float choose_colors(uint32_t *indices, const struct block *block, uint32_t first,
                           uint32_t second)
{
    int steps[COLORS][3];
    float error = 0;
    color_steps(steps, first, second);
    *indices = 0;
    for (int i = 0; i < TEXELS; i++) {
        uint32_t best = 0;
        float least = INFINITY;
        for (uint32_t k = 0; k < COLORS; k++) {
            float off = 0;
            for (int c = 0; c < 3; c++) {
                float d = block->rgb[i][c] - (float)steps[k][c];
                off += d * d;
            }
            if (off < least) {
                least = off;
                best = k;
            }
        }
        error += block->weight[i] * least;
        *indices |= best << (2 * i);
    }
    return error;
}

/* The direction in which colours differ most, by powers of their covariance. */
static void main_axis(float axis[3], const struct block *block, const float mean[3])
{
    float covariance[3][3] = {{0}};
    for (int i = 0; i < TEXELS; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                covariance[a][b] += block->weight[i] * (block->rgb[i][a] - mean[a]) *
                                    (block->rgb[i][b] - mean[b]);
    axis[0] = axis[1] = axis[2] = 1;
    for (int step = 0; step < POWER_STEPS; step++) {
        float next[3], longest = 0;
        for (int a = 0; a < 3; a++) {
            next[a] = covariance[a][0] * axis[0] + covariance[a][1] * axis[1] +
                      covariance[a][2] * axis[2];
            longest = fmaxf(longest, fabsf(next[a]));
        }
        for (int a = 0; a < 3 && longest > 0; a++)
            axis[a] = next[a] / longest;
    }
}

/* The ends of the colours along their main axis. */
static void find_ends(float ends[2][3], const struct block *block)
{
    float mean[3] = {0}, weight = 0, axis[3], low = INFINITY, high = -INFINITY;
    for (int i = 0; i < TEXELS; i++) {
        weight += block->weight[i];
        for (int c = 0; c < 3; c++)
            mean[c] += block->weight[i] * block->rgb[i][c];
    }
    for (int c = 0; c < 3; c++)
        mean[c] /= weight;
    main_axis(axis, block, mean);
    float squared = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
    for (int i = 0; i < TEXELS; i++) {
        if (block->weight[i] <= LEAST_WEIGHT)
            continue;
        float at = 0;
        for (int c = 0; c < 3; c++)
            at += (block->rgb[i][c] - mean[c]) * axis[c];
        low = fminf(low, at);
        high = fmaxf(high, at);
    }
    if (low > high)
        low = high = 0;
    for (int c = 0; c < 3; c++) {
        ends[0][c] = mean[c] + axis[c] * high / squared;
        ends[1][c] = mean[c] + axis[c] * low / squared;
    }
}

/* The ends that suit the chosen indices best: least squares. */
static bool refine_ends(float ends[2][3], const struct block *block, uint32_t indices)
{
    static const float share[COLORS] = {1, 0, 2.0f / 3, 1.0f / 3};
    float aa = 0, ab = 0, bb = 0, ax[3] = {0}, bx[3] = {0};
    for (int i = 0; i < TEXELS; i++) {
        float a = share[indices >> (2 * i) & 3], b = 1 - a, w = block->weight[i];
        aa += w * a * a;
        ab += w * a * b;
        bb += w * b * b;
        for (int c = 0; c < 3; c++) {
            ax[c] += w * a * block->rgb[i][c];
            bx[c] += w * b * block->rgb[i][c];
        }
    }
    float determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-4f))
        return false;
    for (int c = 0; c < 3; c++) {
        ends[0][c] = (ax[c] * bb - bx[c] * ab) / determinant;
        ends[1][c] = (bx[c] * aa - ax[c] * ab) / determinant;
    }
    return true;
}

static void pack_color(uint8_t *out, const struct block *block)
{
    float ends[2][3];
    find_ends(ends, block);
    uint32_t first = pack_565(ends[0]), second = pack_565(ends[1]), indices;
    float error = choose_colors(&indices, block, first, second);
    for (int step = 0; step < REFINEMENTS && refine_ends(ends, block, indices); step++) {
        uint32_t a = pack_565(ends[0]), b = pack_565(ends[1]), chosen;
        float found = choose_colors(&chosen, block, a, b);
        if (found >= error)
            break;
        error = found;
        first = a;
        second = b;
        indices = chosen;
    }
    out[0] = (uint8_t)first;
    out[1] = (uint8_t)(first >> 8);
    out[2] = (uint8_t)second;
    out[3] = (uint8_t)(second >> 8);
    for (int i = 0; i < 4; i++)
        out[4 + i] = (uint8_t)(indices >> (8 * i));
}

/* --- pictures ---------------------------------------------------------------------------- */

/* Texels beyond the edge repeat those at it. */
static void read_block(struct block *block, const uint8_t *rgba, uint32_t width, uint32_t height,
                       uint32_t x, uint32_t y)
{
    for (uint32_t i = 0; i < TEXELS; i++) {
        uint32_t column = x + i % SIDE, row = y + i / SIDE;
        column = column < width ? column : width - 1;
        row = row < height ? row : height - 1;
        const uint8_t *texel = rgba + 4 * ((size_t)row * width + column);
        for (int c = 0; c < 3; c++)
            block->rgb[i][c] = texel[c];
        block->alpha[i] = texel[3];
        block->weight[i] = texel[3] ? LEAST_WEIGHT + (float)texel[3] / 255 : LEAST_WEIGHT;
    }
}

void wd_blocks_pack(uint8_t *blocks, const uint8_t *rgba, uint32_t width, uint32_t height)
{
    for (uint32_t y = 0; y < height; y += SIDE)
        for (uint32_t x = 0; x < width; x += SIDE, blocks += BLOCK_BYTES) {
            struct block block;
            read_block(&block, rgba, width, height, x, y);
            pack_alpha(blocks, &block);
            pack_color(blocks + ALPHA_BYTES, &block);
        }
}

void wd_alpha_blocks_pack(uint8_t *blocks, const uint8_t *rgba, uint32_t width, uint32_t height)
{
    for (uint32_t y = 0; y < height; y += SIDE)
        for (uint32_t x = 0; x < width; x += SIDE, blocks += ALPHA_BYTES) {
            struct block block;
            read_block(&block, rgba, width, height, x, y);
            pack_alpha(blocks, &block);
        }
}
