#include "forest/canopy_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/dmath.h"
#include "base/jobs.h"
#include "base/memory.h"
#include "forest/crowns_apart.h"
#include "shared/light.h"
#include "shared/sky_rings.h"
#include "shared/tree_pose.h"
#include "tree/four.h"
#include "tree/vec.h"

static const float PI = (float)WD_PI;

/* --- the stand ----------------------------------------------------------------------------- */

enum { CELLS_A_SIDE = 384 /* of a square */, MOST_CELLS = 4096 /* a side */, QUARTERS = 4, SIDES = 3 };

enum { RINGS = WD_SKY_RINGS };
static const float rises[RINGS] = {WD_SKY_RING_SINES};
static const float highs[RINGS] = {WD_SKY_RINGS_HIGH}, lows[RINGS] = {WD_SKY_RINGS_LOW};
static const float levels[RINGS] = {WD_SKY_RINGS_LEVEL};
static const float turns_deg[RINGS] = {-34, 11, -11, 34, -22, 5}; /* off the middles of quarters: at several bearings */

/* Cells that lie beside each other from west to east are asked together. */
enum { FOUR = 4 };

/* Crowns of each cell as a layer of leaves over the ground. A row's cells have FOUR on both sides that are none, so that
 * cell i of row j is stands_place(i, j). */
struct stands {
    float *ground_m, *base_m, *middle_m; /* above the world's zero */
    float *per_half_m;                   /* one over half its depth */
    float *depth[RINGS];                 /* optical, of rays of each ring */
    float *stems_per_m;                  /* extinction of level ways below crowns */
    float *block;                        /* all of these */
    size_t row;                          /* cells with those that are none */
    float highest_m;                     /* of all tops */
};

static const double LEAST_CELL_M = 8;
/* Of plots on level ground, which are small and whose edges are near, two crowns, but no less than this. */
static const double LEAST_PLOT_CELL_M = 4, PLOT_CROWNS = 2;
static const double MARGIN_HEIGHTS = 4; /* about a plot, of its tallest tree: beyond, nearly all light comes in */
static const float LEVEL_M = 1;       /* from the lowest to the highest ground */
static const float STEP_M = 3;        /* up, */
static const float STEP_CELLS = 0.7f; /* and level, at most, close by */
static const float FARTHEST_M = 3000; /* hills beyond are left to the sun's own shadow */
static const float DARK = 6;          /* optical depth that ends a ray */

struct ray {
    float east, north, rise; /* unit */
    int ring;
};

struct work {
    struct wd_canopy_field *field;
    const struct wd_world *world;
    const struct wd_canopy_field_params *params;
    struct stands stands;
    struct ray rays[QUARTERS][RINGS];
};

static void stands_init(struct stands *stands, const struct wd_canopy_field *field)
{
    float **const parts[] = {&stands->ground_m, &stands->base_m, &stands->middle_m, &stands->per_half_m,
                             &stands->stems_per_m};
    const size_t others = sizeof parts / sizeof *parts;
    stands->row = field->width + 2 * FOUR;
    const size_t count = stands->row * field->height;
    stands->block = wd_alloc_array((others + RINGS) * count, sizeof *stands->block);
    for (size_t i = 0; i < others; i++)
        *parts[i] = stands->block + i * count;
    for (size_t i = 0; i < RINGS; i++)
        stands->depth[i] = stands->block + (others + i) * count;
}

static size_t stands_place(const struct stands *stands, size_t i, size_t j)
{
    return j * stands->row + FOUR + i;
}

/* Of a cell's trees, by its share of the ground: the area of crowns' outlines from above; what they
 * cover, seen level, from half above and from above; how wide stems are; by what
 * is covered from above, first and second moments of the leaves' heights. Herbs are apart. */
struct sums {
    float outline, seen[SIDES], stems_m;
    float leaves_m, leaves_m2;
    float herbs, herbs_m; /* layers of herbs, by them the mean of their tops */
};

/* An ellipsoid's variance of height is a twentieth of its squared depth. */
static void add_heights(struct sums *sums, float above, float base_m, float top_m)
{
    float middle_m = 0.5f * (base_m + top_m), deep_m = top_m - base_m;
    sums->leaves_m += above * middle_m;
    sums->leaves_m2 += above * (middle_m * middle_m + deep_m * deep_m / 20);
}

/* What a tree covers seen from each side, times `part`. */
static void seen_of(float seen[SIDES], const struct wd_model *model, float height_m, float radius_m,
                    float part)
{
    static const float sines[SIDES] = {0, 0.70710678f, 1};
    for (int side = 0; side < SIDES; side++)
        seen[side] = part * wd_tree_seen_m2(*model, 2 * radius_m / model->crown_m,
                                            height_m / model->height_m, sines[side]);
}

static void add_tree(struct sums *sums, const struct wd_canopy_field *field,
                     const struct wd_canopy_field_params *params, const struct wd_tree *tree)
{
    uint32_t variant = WD_TREE_VARIANT(*tree) % params->variants;
    const struct wd_model *model =
        &params->models[WD_TREE_SPECIES(*tree) * params->variants + variant];
    float height_m = WD_TREE_HEIGHT_M(*tree), radius_m = 0.5f * WD_TREE_CROWN_M(*tree);
    float base_m = model->crown_base_m * height_m / model->height_m;
    float per_m2 = (float)(1 / (field->cell_m * field->cell_m)), seen[SIDES];
    float outline = PI * radius_m * radius_m * per_m2;
    float stem_m = params->grown[model - params->models].dbh_m * 2 * radius_m / model->crown_m;
    seen_of(seen, model, height_m, radius_m, per_m2);
    double x = (tree->x_mm * 0.001 - field->from_m[0]) / field->cell_m - 0.5;
    double y = (tree->y_mm * 0.001 - field->from_m[1]) / field->cell_m - 0.5;
    double i0 = floor(x), j0 = floor(y);
    for (int corner = 0; corner < 4; corner++) {
        double i = i0 + (corner & 1), j = j0 + (corner >> 1);
        float part =
            (float)((corner & 1 ? x - i0 : 1 - (x - i0)) * (corner >> 1 ? y - j0 : 1 - (y - j0)));
        if (i < 0 || j < 0 || i >= field->width || j >= field->height)
            continue;
        struct sums *to = &sums[(size_t)j * field->width + (size_t)i];
        float above = part * seen[SIDES - 1];
        if (height_m < WD_HERB_M) {
            bool sward = model->roughness < 0; /* the ground's own openness holds those */
            to->herbs += sward ? 0 : above;
            to->herbs_m += sward ? 0 : above * height_m;
            continue;
        }
        to->outline += part * outline;
        for (int side = 0; side < SIDES; side++)
            to->seen[side] += part * seen[side];
        to->stems_m += part * per_m2 * stem_m;
        add_heights(to, above, base_m, height_m);
    }
}

/* Mean canopy cover about a place. */
static float cover_at(const struct wd_world *world, double x_m, double y_m, double cell_m)
{
    long reach = (long)fmax(0.5 * cell_m / world->cover_cell_m, 1);
    long column = (long)(x_m / world->cover_cell_m), row = (long)(y_m / world->cover_cell_m);
    float sum = 0, count = 0;
    for (long j = row - reach; j < row + reach; j++)
        for (long i = column - reach; i < column + reach; i++)
            if (i >= 0 && j >= 0 && i < (long)world->cover_width && j < (long)world->cover_height) {
                sum += world->cover[(size_t)j * world->cover_width + (size_t)i];
                count++;
            }
    return count > 0 ? sum / (255 * count) : 0;
}

/* Trees that are planted only when somebody looks: their mean, as many as the cover says. */
static struct sums sums_on_demand(const struct work *work, float cover)
{
    const struct wd_canopy_field_params *params = work->params;
    const struct wd_demand_layer *layer = &work->world->demand.layers[0];
    const struct wd_model *model = &params->models[0];
    float height_m = layer->mean_height_m, radius_m = sqrtf((float)layer->crown_area_m2 / PI);
    float base_m = height_m * model->crown_base_m / model->height_m;
    float outline = -logf(1 - cover), per_m2 = outline / fmaxf((float)layer->crown_area_m2, 0.1f);
    struct sums sums = {.outline = outline};
    seen_of(sums.seen, model, height_m, radius_m, per_m2);
    add_heights(&sums, sums.seen[SIDES - 1], base_m, height_m);
    return sums;
}

/* The ellipsoid whose leaves have the mean height and variance of all trees' of the cell. */
static void settle_layer(struct wd_canopy_field *field, size_t cell, const struct sums *sums)
{
    float above = sums->seen[SIDES - 1];
    if (above <= 0)
        return;
    float middle_m = sums->leaves_m / above;
    float variance_m2 = fmaxf(sums->leaves_m2 / above - middle_m * middle_m, 0);
    float half_m = sqrtf(5 * variance_m2);
    field->layer_m[cell][0] = fmaxf(middle_m - half_m, 0);
    field->layer_m[cell][1] = middle_m + half_m;
}

/* Crowns that stand at random let e^-a of a ray's light through where they cover a of the area
 * across it. Those that are planted keep apart and hide so much more, most where many lie over one another: by the
 * floors of path-traced stands under an even sky, whose crowns have outlines of 0.56, 0.85, 1.5 and 1.8 times the
 * ground together. Mapped ones, which may stand in groups, hide less, by the floors of three plots. */
static float crowns_apart(float outline, float on_map)
{
    float planted = fminf(1.155f + 0.3f * fmaxf(outline - 1.1f, 0), 1.41f);
    return planted * powf(on_map / wd_planted_apart(outline), 0.5f);
}

static void settle_stand(struct work *work, size_t cell, struct sums sums, float on_map)
{
    const struct wd_canopy_field *field = work->field;
    double x_m = field->from_m[0] + ((double)(cell % field->width) + 0.5) * field->cell_m;
    double y_m = field->from_m[1] + ((double)(cell / field->width) + 0.5) * field->cell_m;
    struct stands *stands = &work->stands;
    const size_t at = stands_place(stands, cell % field->width, cell / field->width);
    stands->ground_m[at] = stands->base_m[at] = wd_terrain_height(&work->world->terrain, x_m, y_m);
    if (sums.outline <= 0 && work->world->demand.count) {
        sums = sums_on_demand(work, fminf(cover_at(work->world, x_m, y_m, field->cell_m), 0.98f));
        on_map = wd_planted_apart(sums.outline);
    }
    field->herbs[cell][0] = sums.herbs;
    field->herbs[cell][1] = sums.herbs > 0 ? sums.herbs_m / sums.herbs : 0;
    settle_layer(work->field, cell, &sums);
    if (sums.outline <= 0)
        return;
    const float *layer_m = field->layer_m[cell];
    float deep_m = fmaxf(layer_m[1] - layer_m[0], 1);
    stands->base_m[at] += layer_m[0];
    stands->middle_m[at] = stands->base_m[at] + 0.5f * deep_m;
    stands->per_half_m[at] = 2 / deep_m;
    float apart = crowns_apart(sums.outline, on_map);
    stands->stems_per_m[at] = sums.stems_m;
    for (int ring = 0; ring < RINGS; ring++) {
        float rise = rises[ring], seen = wd_seen_m2(sums.seen[0], sums.seen[1], sums.seen[2], rise);
        stands->depth[ring][at] = apart * seen / rise;
    }
    stands->highest_m = fmaxf(stands->highest_m, stands->base_m[at] + deep_m);
}

/* Cells without trees take the layer of those beside them, into which crowns reach out. */
static void spread_layer(struct wd_canopy_field *field)
{
    uint32_t width = field->width, height = field->height;
    float(*spread)[2] = wd_alloc_array((size_t)width * height, sizeof *spread);
    for (size_t cell = 0; cell < (size_t)width * height; cell++) {
        long i0 = (long)(cell % width), j0 = (long)(cell / width);
        float sum[2] = {0}, count = 0;
        for (long j = j0 - 1; j <= j0 + 1; j++)
            for (long i = i0 - 1; i <= i0 + 1; i++) {
                if (i < 0 || j < 0 || i >= (long)width || j >= (long)height)
                    continue;
                const float *beside = field->layer_m[(size_t)j * width + (size_t)i];
                sum[0] += beside[0];
                sum[1] += beside[1];
                count += beside[1] > 0;
            }
        bool empty = field->layer_m[cell][1] <= 0 && count > 0;
        for (int k = 0; k < 2; k++)
            spread[cell][k] = empty ? sum[k] / count : field->layer_m[cell][k];
    }
    free(field->layer_m);
    field->layer_m = spread;
}

static float *apart_on_map(const struct work *work, const struct sums *sums)
{
    const struct wd_canopy_field *field = work->field;
    size_t count = (size_t)field->width * field->height;
    float *outline = wd_alloc_array(count, sizeof *outline);
    for (size_t cell = 0; cell < count; cell++)
        outline[cell] = sums[cell].outline;
    const struct wd_crown_grid grid = {.outline = outline, .width = field->width, .height = field->height,
                                       .cell_m = field->cell_m, .from_m = {field->from_m[0], field->from_m[1]}};
    float *apart = wd_crowns_apart(work->world, &grid);
    free(outline);
    return apart;
}

static void settle_stands(struct work *work)
{
    size_t count = (size_t)work->field->width * work->field->height;
    struct sums *sums = wd_alloc_array(count, sizeof *sums);
    for (size_t i = 0; i < work->world->tree_count; i++)
        add_tree(sums, work->field, work->params, &work->world->trees[i]);
    work->stands.highest_m = work->world->terrain.min_m;
    float *apart = apart_on_map(work, sums);
    for (size_t cell = 0; cell < count; cell++)
        settle_stand(work, cell, sums[cell], apart[cell]);
    free(apart);
    free(sums);
    spread_layer(work->field);
}

/* --- rays ---------------------------------------------------------------------------------- */

static bool is_any(wd_four_ints where)
{
    uint64_t pairs[FOUR / 2];
    memcpy(pairs, &where, sizeof pairs);
    return pairs[0] | pairs[1];
}

/* Share of a layer's leaves below a height, as in an ellipsoid that is as deep. `over`: of its middle, in halves of its
 * depth. */
static wd_four leaves_below(wd_four over)
{
    over = wd_four_min(wd_four_max(over, wd_four_of(-1)), wd_four_of(1));
    return 0.25f * over * (3 - over * over) + 0.5f;
}

/* Shares of the light along a ray to places half a metre over the ground of cells from `column` on; through crowns by Beer's
 * law, stopped by hills. */
static wd_four ray_through(const struct work *work, uint32_t column, uint32_t row, const struct ray *ray)
{
    static const wd_four_ints lanes = {0, 1, 2, 3};
    const struct stands *stands = &work->stands;
    const int32_t width = (int32_t)work->field->width;
    const float height = (float)work->field->height, cells_a_m = (float)(1 / work->field->cell_m);
    const float free_m = wd_maxf(stands->highest_m, work->world->terrain.max_m);
    const float across = sqrtf(1 - ray->rise * ray->rise);
    const wd_four none = {0};
    float x = 0.5f, y = (float)row + 0.5f, gone_m = 0; /* x from the cells' western edge */
    float step_m = wd_minf(STEP_M / ray->rise, STEP_CELLS / (cells_a_m * across));
    wd_four z = wd_four_load(stands->ground_m + stands_place(stands, column, row)) + 0.5f, depth = none;
    wd_four_ints live = lanes + (int32_t)column < width, stopped = {0};
    for (; gone_m < FARTHEST_M; gone_m += step_m) {
        step_m = wd_maxf(step_m, 0.08f * gone_m);
        float half = 0.5f * step_m * cells_a_m;
        float at_y = y + half * ray->north;
        int32_t at_x = (int32_t)floorf(x + half * ray->east) + (int32_t)column;
        live &= (lanes + at_x >= 0) & (lanes + at_x < width) & (z <= free_m) & (depth < DARK);
        if (!(at_y >= 0 && at_y < height) || !is_any(live))
            break;
        const ptrdiff_t place = (ptrdiff_t)stands_place(stands, 0, (size_t)at_y) + at_x;
        wd_four low = z, high = z + step_m * ray->rise, ground_m = wd_four_load(stands->ground_m + place);
        wd_four middle_m = wd_four_load(stands->middle_m + place), per_half_m = wd_four_load(stands->per_half_m + place);
        wd_four_ints hill = live & (0.5f * (low + high) < ground_m - 2);
        stopped |= hill;
        live &= ~hill;
        wd_four within = leaves_below((high - middle_m) * per_half_m) - leaves_below((low - middle_m) * per_half_m);
        wd_four below = wd_four_min(high, wd_four_load(stands->base_m + place)) - wd_four_max(low, ground_m);
        wd_four more = within * wd_four_load(stands->depth[ray->ring] + place) +
                     wd_four_max(below, none) * wd_four_load(stands->stems_per_m + place) * across / ray->rise;
        depth += wd_four_choose(live, more, none);
        x += 2 * half * ray->east;
        y += 2 * half * ray->north;
        z = high;
    }
    for (int lane = 0; lane < FOUR; lane++)
        depth[lane] = stopped[lane] ? 0 : expf(-depth[lane]);
    return depth;
}

static void fill_cells(const struct work *work, uint32_t column, uint32_t row)
{
    struct wd_canopy_field *field = work->field;
    for (int quarter = 0; quarter < QUARTERS; quarter++) {
        wd_four level = {0}, high = {0}, low = {0};
        for (int i = 0; i < RINGS; i++) {
            wd_four through = ray_through(work, column, row, &work->rays[quarter][i]);
            level += levels[i] * through;
            high += highs[i] * through;
            low += lows[i] * through;
        }
        for (uint32_t lane = 0; lane < FOUR && column + lane < field->width; lane++) {
            size_t cell = (size_t)row * field->width + column + lane;
            field->quarters[cell][quarter] = level[lane];
            field->high[cell][quarter] = high[lane];
            field->low[cell][quarter] = low[lane];
        }
    }
}

WD_FOUR_TWICE
static void fill_row(const struct work *work, uint32_t row)
{
    for (uint32_t column = 0; column < work->field->width; column += FOUR)
        fill_cells(work, column, row);
}

static void run_row(void *user, size_t row)
{
    fill_row(user, (uint32_t)row);
}

static void aim_rays(struct work *work)
{
    for (int quarter = 0; quarter < QUARTERS; quarter++)
        for (int i = 0; i < RINGS; i++) {
            float rise = rises[i], across = sqrtf(1 - rise * rise);
            float bearing = (90.0f * (float)quarter + turns_deg[i]) * (PI / 180);
            work->rays[quarter][i] = (struct ray){across * cosf(bearing), across * sinf(bearing), rise, i};
        }
}

struct trees {
    double low_m[2], high_m[2], tallest_m;
    double crown_m; /* mean diameter, of those that are no herbs */
    size_t count;   /* of these */
};

static struct trees trees_of(const struct wd_world *world)
{
    struct trees trees = {.low_m = {INFINITY, INFINITY}, .high_m = {-INFINITY, -INFINITY}};
    double crowns_m = 0;
    for (size_t i = 0; i < world->tree_count; i++) {
        const struct wd_tree *tree = &world->trees[i];
        const double place_m[2] = {tree->x_mm * 0.001, tree->y_mm * 0.001};
        for (int k = 0; k < 2; k++) {
            trees.low_m[k] = fmin(trees.low_m[k], place_m[k]);
            trees.high_m[k] = fmax(trees.high_m[k], place_m[k]);
        }
        trees.tallest_m = fmax(trees.tallest_m, (double)WD_TREE_HEIGHT_M(*tree));
        if (WD_TREE_HEIGHT_M(*tree) >= WD_HERB_M) {
            crowns_m += (double)WD_TREE_CROWN_M(*tree);
            trees.count++;
        }
    }
    trees.crown_m = crowns_m / (double)(trees.count ? trees.count : 1);
    return trees;
}

/* The field covers the terrain; where that is level, its stored trees and so much about them that nearly all
 * light comes in beyond. */
static void lay_out(struct wd_canopy_field *field, const struct wd_world *world)
{
    const struct wd_terrain *terrain = &world->terrain;
    const struct trees trees = trees_of(world);
    bool is_plot = terrain->max_m - terrain->min_m < LEVEL_M && trees.count && !world->demand.count;
    double from_m[2] = {0}, to_m[2] = {wd_terrain_extent_x_m(terrain), wd_terrain_extent_y_m(terrain)};
    for (int k = 0; k < 2 && is_plot; k++) {
        from_m[k] = fmax(from_m[k], trees.low_m[k] - MARGIN_HEIGHTS * trees.tallest_m);
        to_m[k] = fmin(to_m[k], trees.high_m[k] + MARGIN_HEIGHTS * trees.tallest_m);
    }
    double x_m = to_m[0] - from_m[0], y_m = to_m[1] - from_m[1];
    double cell_m = fmax(sqrt(x_m * y_m) / CELLS_A_SIDE, fmax(x_m, y_m) / MOST_CELLS);
    double plot_cell_m = fmin(fmax(PLOT_CROWNS * trees.crown_m, LEAST_PLOT_CELL_M), LEAST_CELL_M);
    cell_m = fmax(cell_m, is_plot ? plot_cell_m : LEAST_CELL_M);
    *field = (struct wd_canopy_field){.width = (uint32_t)fmax(ceil(x_m / cell_m), 1),
                                      .height = (uint32_t)fmax(ceil(y_m / cell_m), 1),
                                      .cell_m = cell_m,
                                      .from_m = {from_m[0], from_m[1]}};
}

void wd_canopy_field_init(struct wd_canopy_field *field,
                          const struct wd_canopy_field_params *params)
{
    lay_out(field, params->world);
    size_t count = (size_t)field->width * field->height;
    field->quarters = wd_alloc_array(count, sizeof *field->quarters);
    field->high = wd_alloc_array(count, sizeof *field->high);
    field->low = wd_alloc_array(count, sizeof *field->low);
    field->layer_m = wd_alloc_array(count, sizeof *field->layer_m);
    field->herbs = wd_alloc_array(count, sizeof *field->herbs);
    struct work work = {.field = field, .world = params->world, .params = params};
    stands_init(&work.stands, field);
    settle_stands(&work);
    aim_rays(&work);
    wd_jobs_run(params->threads, field->height, run_row, &work);
    free(work.stands.block);
}

void wd_canopy_field_finish(struct wd_canopy_field *field)
{
    free(field->quarters);
    free(field->high);
    free(field->low);
    free(field->layer_m);
    free(field->herbs);
    *field = (struct wd_canopy_field){0};
}

/* --- upload -------------------------------------------------------------------------------- */

static uint8_t root_byte(float share)
{
    return (uint8_t)(sqrtf(fminf(share, 1)) * 255 + 0.5f);
}

/* Cells at the edge stand for those that it has more. */
bool wd_canopy_light_upload(struct wd_image *image, float scale[2], struct wd_gpu *gpu,
                            const struct wd_canopy_field *field)
{
    const struct wd_image_params params = {.name = "canopy light",
                                           .format = VK_FORMAT_R8G8B8A8_UNORM,
                                           .width = wd_image_odd_side(field->width),
                                           .height = wd_image_odd_side(field->height),
                                           .layers = 4,
                                           .mips = 1,
                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    size_t count = (size_t)params.width * params.height;
    uint8_t(*texels)[4] = wd_alloc_array(4 * count, sizeof *texels);
    for (size_t i = 0; i < count; i++) {
        size_t x = i % params.width, y = i / params.width;
        size_t cell = (y < field->height ? y : field->height - 1) * field->width +
                      (x < field->width ? x : field->width - 1);
        for (int k = 0; k < QUARTERS; k++) {
            texels[i][k] = root_byte(field->quarters[cell][k]);
            texels[2 * count + i][k] = root_byte(field->high[cell][k]);
            texels[3 * count + i][k] = root_byte(field->low[cell][k]);
        }
        for (int k = 0; k < 2; k++)
            texels[count + i][k] = root_byte(field->layer_m[cell][k] / WD_CANOPY_MOST_M);
        texels[count + i][2] = root_byte(field->herbs[cell][0] / WD_HERBS_MOST);
        texels[count + i][3] = root_byte(field->herbs[cell][1] / WD_HERB_M);
    }
    scale[0] = (float)(1 / (field->cell_m * params.width));
    scale[1] = (float)(1 / (field->cell_m * params.height));
    bool ok = wd_image_init(image, gpu, &params);
    for (uint32_t layer = 0; ok && layer < params.layers; layer++)
        ok = wd_image_upload(gpu, image, layer, 0, texels + layer * count, count * sizeof *texels);
    free(texels);
    return ok;
}
