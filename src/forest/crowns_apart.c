#include "forest/crowns_apart.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "shared/light.h"

/* Whether ground is free is looked up at so many dots each way of a square; crowns are counted in blocks of so many
 * squares each way, some hundred trees. */
enum { DOTS = 8, BLOCK = 8 };

static const double LEAST_APART = 0.4, MOST_APART = 2; /* of blocks where next to nothing or all is covered */
/* What is known of all blocks counts in each as much as so many layers of crowns over one square. */
static const double COMMON = 4;

struct dots {
    uint8_t *covered; /* 1: by a crown */
    long width, height;
    double apart_m;
    double from_m[2];
};

static void cover_row(const struct dots *dots, long row, double x_m, double half_m)
{
    long first = (long)ceil((x_m - half_m) / dots->apart_m - 0.5);
    long last = (long)floor((x_m + half_m) / dots->apart_m - 0.5);
    first = first > 0 ? first : 0;
    last = last < dots->width - 1 ? last : dots->width - 1;
    for (long column = first; column <= last; column++)
        dots->covered[row * dots->width + column] = 1;
}

static void cover_crown(const struct dots *dots, const struct wd_tree *tree)
{
    double radius_m = 0.5 * (double)WD_TREE_CROWN_M(*tree), x_m = tree->x_mm * 0.001 - dots->from_m[0],
           y_m = tree->y_mm * 0.001 - dots->from_m[1];
    long first = (long)ceil((y_m - radius_m) / dots->apart_m - 0.5);
    long last = (long)floor((y_m + radius_m) / dots->apart_m - 0.5);
    first = first > 0 ? first : 0;
    last = last < dots->height - 1 ? last : dots->height - 1;
    for (long row = first; row <= last; row++) {
        double off_m = ((double)row + 0.5) * dots->apart_m - y_m;
        cover_row(dots, row, x_m, sqrt(fmax(radius_m * radius_m - off_m * off_m, 0)));
    }
}

static struct dots cover_dots(const struct wd_world *world, const struct wd_crown_grid *grid)
{
    struct dots dots = {.width = (long)grid->width * DOTS, .height = (long)grid->height * DOTS,
                        .apart_m = grid->cell_m / DOTS,
                        .from_m = {grid->from_m[0], grid->from_m[1]}};
    dots.covered = wd_alloc_array((size_t)(dots.width * dots.height), sizeof *dots.covered);
    for (size_t i = 0; i < world->tree_count; i++)
        if (WD_TREE_HEIGHT_M(world->trees[i]) >= WD_HERB_M)
            cover_crown(&dots, &world->trees[i]);
    return dots;
}

/* A block's squares. */
struct block {
    double layers[BLOCK * BLOCK];
    double sum;     /* of these */
    double covered; /* of the ground, in squares */
    int count;
};

static double covered_of(const struct dots *dots, uint32_t column, uint32_t row)
{
    int covered = 0;
    const uint8_t *first = dots->covered + (size_t)row * DOTS * (size_t)dots->width + (size_t)column * DOTS;
    for (int y = 0; y < DOTS; y++)
        for (int x = 0; x < DOTS; x++)
            covered += first[(size_t)y * (size_t)dots->width + (size_t)x];
    return (double)covered / (DOTS * DOTS);
}

static struct block block_at(const struct wd_crown_grid *grid, const struct dots *dots, uint32_t i, uint32_t j)
{
    struct block block = {0};
    for (uint32_t row = j * BLOCK; row < (j + 1) * BLOCK && row < grid->height; row++)
        for (uint32_t column = i * BLOCK; column < (i + 1) * BLOCK && column < grid->width; column++) {
            double layers = (double)grid->outline[(size_t)row * grid->width + column];
            block.layers[block.count++] = layers;
            block.sum += layers;
            block.covered += covered_of(dots, column, row);
        }
    return block;
}

/* By Newton's method: covered ground falls short of all by a sum of exponentials. */
static double apart_of(const struct block *block)
{
    double apart = 1;
    for (int round = 0; round < 8; round++) {
        double covered = 0, slope = 0;
        for (int i = 0; i < block->count; i++) {
            double free_share = exp(-apart * block->layers[i]);
            covered += 1 - free_share;
            slope += block->layers[i] * free_share;
        }
        apart += (block->covered - covered) / fmax(slope, 1e-9);
        apart = fmin(fmax(apart, LEAST_APART), MOST_APART);
    }
    return apart;
}

/* Between the middles of blocks. */
static float between(const double *blocks, uint32_t across, uint32_t up, double x, double y)
{
    x = fmin(fmax(x, 0), across - 1);
    y = fmin(fmax(y, 0), up - 1);
    uint32_t i = (uint32_t)x, j = (uint32_t)y;
    uint32_t i1 = i + 1 < across ? i + 1 : i, j1 = j + 1 < up ? j + 1 : j;
    double right = x - i, above = y - j;
    double low = blocks[(size_t)j * across + i] * (1 - right) + blocks[(size_t)j * across + i1] * right;
    double high = blocks[(size_t)j1 * across + i] * (1 - right) + blocks[(size_t)j1 * across + i1] * right;
    return (float)(low * (1 - above) + high * above);
}

float *wd_crowns_apart(const struct wd_world *world, const struct wd_crown_grid *grid)
{
    uint32_t across = (grid->width + BLOCK - 1) / BLOCK, up = (grid->height + BLOCK - 1) / BLOCK;
    double *blocks = wd_alloc_array((size_t)across * up, sizeof *blocks);
    double *weights = wd_alloc_array((size_t)across * up, sizeof *weights);
    struct dots dots = cover_dots(world, grid);
    double common = 0, weight = 0;
    for (uint32_t n = 0; n < across * up; n++) {
        struct block block = block_at(grid, &dots, n % across, n / across);
        blocks[n] = block.sum > 0 ? apart_of(&block) : 1;
        weights[n] = block.sum;
        common += blocks[n] * block.sum;
        weight += block.sum;
    }
    free(dots.covered);
    common = weight > 0 ? common / weight : 1;
    for (uint32_t n = 0; n < across * up; n++)
        blocks[n] = (blocks[n] * weights[n] + common * COMMON) / (weights[n] + COMMON);
    float *apart = wd_alloc_array((size_t)grid->width * grid->height, sizeof *apart);
    for (size_t cell = 0; cell < (size_t)grid->width * grid->height; cell++)
        apart[cell] = between(blocks, across, up, ((double)(cell % grid->width) + 0.5) / BLOCK - 0.5,
                              ((double)(cell / grid->width) + 0.5) / BLOCK - 0.5);
    free(weights);
    free(blocks);
    return apart;
}

/* What that is in seven scenes whose trees the program plants. */
float wd_planted_apart(float outline)
{
    return fminf(1.2f + 0.24f * outline, 1.6f);
}
