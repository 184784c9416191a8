/* Popping along a slow walk: how much more each block of the picture changes from frame to frame
 * than the same block of the truth, over all, and where a tree changes its level of detail. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 4, LEAST_BLOCKS = 6 }; /* of a tree, for its step to be more than noise */

/* Levels as WD_VIEW_LOD colours them: bits of what of a tree shows in a block. */
enum level { FULL = 1, REDUCED = 2, BILLBOARD = 4, CANOPY = 8 };
enum { CANOPY_BOUNDARY = BENCH_BOUNDARIES - 1 };

/* What a block shows. */
struct seen {
    uint32_t tree;   /* that fills most of it; 0: none does */
    uint32_t levels; /* of that tree */
    uint32_t any;    /* levels of all its trees, if they fill most of it; else 0 */
};

/* One frame in blocks. */
struct frame {
    double *truth, *drawn; /* luma, 0..100 */
    struct seen *seen;
};

struct popping {
    uint32_t columns, rows;
    struct frame frames[2]; /* the frame before and this one, by step % 2 */
    double *excess;
    size_t count;
    double step[BENCH_BOUNDARIES]; /* NaN where no tree crossed that boundary */
};

/* --- blocks ----------------------------------------------------------------------------- */

static void add_luma(const struct wd_picture *picture, const struct popping *popping, double *means)
{
    memset(means, 0, (size_t)popping->columns * popping->rows * sizeof *means);
    for (uint32_t y = 0; y < popping->rows * BLOCK; y++)
        for (uint32_t x = 0; x < popping->columns * BLOCK; x++) {
            const uint8_t *p = picture->display + 4 * ((size_t)y * picture->width + x);
            means[y / BLOCK * popping->columns + x / BLOCK] +=
                (0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]) * (100.0 / 255 / (BLOCK * BLOCK));
        }
}

/* The level whose colour is nearest in hue; 0 for what has none, as continuum's discs. */
static uint32_t level_of(const float color[3])
{
    static const struct {
        float color[3];
        uint32_t level;
    } known[] = {
        {{0.85f, 0.08f, 0.05f}, FULL},      {{0.85f, 0.65f, 0.05f}, REDUCED},
        {{0.05f, 0.25f, 0.85f}, BILLBOARD}, {{0.45f, 0.10f, 0.55f}, CANOPY},
        {{0.50f, 0.30f, 0.10f}, 0},         {{0.10f, 0.60f, 0.15f}, 0},
    };
    float sum = color[0] + color[1] + color[2], least = INFINITY;
    uint32_t level = 0;
    for (size_t i = 0; sum > 0 && i < sizeof known / sizeof *known; i++) {
        const float *c = known[i].color;
        float total = c[0] + c[1] + c[2], distance = 0;
        for (int k = 0; k < 3; k++)
            distance += fabsf(color[k] / sum - c[k] / total);
        if (distance < least) {
            least = distance;
            level = known[i].level;
        }
    }
    return level;
}

/* A block counts for the tree that fills most of it. */
static struct seen see_block(const struct wd_picture *levels, uint32_t column, uint32_t row)
{
    struct seen seen = {0};
    uint32_t pixels = 0;
    for (uint32_t i = 0; i < BLOCK * BLOCK && pixels <= BLOCK * BLOCK / 2; i++) {
        size_t first =
            (size_t)(row * BLOCK + i / BLOCK) * levels->width + column * BLOCK + i % BLOCK;
        seen = (struct seen){.tree = levels->tree_id[first]};
        pixels = 0;
        for (uint32_t k = 0; k < BLOCK * BLOCK; k++) {
            size_t at =
                (size_t)(row * BLOCK + k / BLOCK) * levels->width + column * BLOCK + k % BLOCK;
            if (levels->tree_id[at] != seen.tree)
                continue;
            pixels++;
            seen.levels |= level_of(levels->color + 3 * at);
        }
    }
    return pixels > BLOCK * BLOCK / 2 ? seen : (struct seen){0};
}

/* The far canopy shows a tree by lot in each pixel: no tree fills a block of it. */
static uint32_t see_any(const struct wd_picture *levels, uint32_t column, uint32_t row)
{
    uint32_t pixels = 0, any = 0;
    for (uint32_t k = 0; k < BLOCK * BLOCK; k++) {
        size_t at = (size_t)(row * BLOCK + k / BLOCK) * levels->width + column * BLOCK + k % BLOCK;
        if (levels->tree_id[at] == 0)
            continue;
        pixels++;
        any |= level_of(levels->color + 3 * at);
    }
    return pixels > BLOCK * BLOCK / 2 ? any : 0;
}

static void see_blocks(const struct wd_picture *levels, const struct popping *popping,
                       struct seen *seen)
{
    for (uint32_t i = 0; i < popping->columns * popping->rows; i++) {
        uint32_t column = i % popping->columns, row = i / popping->columns;
        seen[i] = see_block(levels, column, row);
        seen[i].any = see_any(levels, column, row);
    }
}

/* --- steps ------------------------------------------------------------------------------ */

static bool popping_init(struct popping *popping, const struct bench_effort *effort)
{
    *popping = (struct popping){.columns = effort->step_width / BLOCK,
                                .rows = effort->step_height / BLOCK};
    size_t blocks = (size_t)popping->columns * popping->rows;
    bool ok = (popping->excess = calloc(blocks * effort->steps, sizeof(double)));
    for (int i = 0; i < 2; i++) {
        struct frame *frame = &popping->frames[i];
        frame->truth = calloc(blocks, sizeof *frame->truth);
        frame->drawn = calloc(blocks, sizeof *frame->drawn);
        frame->seen = calloc(blocks, sizeof *frame->seen);
        ok = ok && frame->truth && frame->drawn && frame->seen;
    }
    for (int i = 0; i < BENCH_BOUNDARIES; i++)
        popping->step[i] = NAN;
    return ok;
}

static void popping_finish(struct popping *popping)
{
    for (int i = 0; i < 2; i++) {
        free(popping->frames[i].truth);
        free(popping->frames[i].drawn);
        free(popping->frames[i].seen);
    }
    free(popping->excess);
}

/* The boundary whose both sides a block shows in two frames one after the other, or
 * BENCH_BOUNDARIES: of one tree, or between trees and far canopy. */
static int boundary_of(const struct seen *before, const struct seen *now)
{
    static const uint32_t sides[CANOPY_BOUNDARY] = {FULL | REDUCED, REDUCED | BILLBOARD,
                                                    FULL | BILLBOARD};
    uint32_t levels = before->levels | now->levels;
    int boundary = 0;
    if (before->any && now->any && (before->any | now->any) == (BILLBOARD | CANOPY))
        return CANOPY_BOUNDARY;
    if (!now->tree || before->tree != now->tree)
        return BENCH_BOUNDARIES;
    while (boundary < CANOPY_BOUNDARY && levels != sides[boundary])
        boundary++;
    return boundary < CANOPY_BOUNDARY ? boundary : BENCH_BOUNDARIES;
}

/* How much more block `i` changed between the two frames than the truth's; below 0: less. */
static double excess_of(const struct popping *popping, size_t i)
{
    const struct frame *a = &popping->frames[0], *b = &popping->frames[1];
    return fabs(b->drawn[i] - a->drawn[i]) - fabs(b->truth[i] - a->truth[i]);
}

/* Mean excess of a tree's blocks that cross a boundary, or of all that turn to canopy: noise of
 * single blocks averages out. */
static void add_tree(struct popping *popping, uint32_t tree, int boundary)
{
    const struct seen *before = popping->frames[0].seen, *now = popping->frames[1].seen;
    uint32_t count = 0;
    double sum = 0;
    for (size_t i = 0; i < (size_t)popping->columns * popping->rows; i++)
        if ((boundary == CANOPY_BOUNDARY || now[i].tree == tree) &&
            boundary_of(&before[i], &now[i]) == boundary) {
            sum += excess_of(popping, i);
            count++;
        }
    if (count >= LEAST_BLOCKS)
        popping->step[boundary] = fmax(popping->step[boundary], sum / count);
}

static void add_crossings(struct popping *popping)
{
    const struct seen *before = popping->frames[0].seen, *now = popping->frames[1].seen;
    uint32_t last_tree = 0;
    int last = BENCH_BOUNDARIES;
    for (size_t i = 0; i < (size_t)popping->columns * popping->rows; i++) {
        int boundary = boundary_of(&before[i], &now[i]);
        bool same = boundary == last && (now[i].tree == last_tree || boundary == CANOPY_BOUNDARY);
        if (boundary < BENCH_BOUNDARIES && !same)
            add_tree(popping, last_tree = now[i].tree, last = boundary);
    }
}

static void add_step(struct popping *popping, uint32_t step)
{
    if (step == 0)
        return;
    for (size_t i = 0; i < (size_t)popping->columns * popping->rows; i++)
        popping->excess[popping->count++] = fmax(excess_of(popping, i), 0);
    add_crossings(popping);
}

/* A slow walk ahead: half a degree of change a frame for things 25 m to the side. */
static struct wd_camera step_camera(const struct wd_camera *camera, uint32_t step)
{
    struct wd_camera moved = *camera;
    double way_m = 0.25 * step, level = cos(camera->pitch_rad);
    moved.position_m[0] += way_m * sin(camera->yaw_rad) * level;
    moved.position_m[1] += way_m * cos(camera->yaw_rad) * level;
    moved.position_m[2] += way_m * sin(camera->pitch_rad);
    return moved;
}

/* Both are shown at the exposure of the true frame. */
static enum wd_result draw_step(struct bench_stage *stage, const struct wd_render_params *params,
                                struct wd_picture *truth, struct popping *popping,
                                struct frame *frame)
{
    struct wd_render_params by_level = *params;
    struct wd_picture picture = {0}, levels = {0};
    by_level.view = WD_VIEW_LOD;
    by_level.samples = 1;
    enum wd_result result = wd_renderer_render(stage->renderer, params, &picture);
    if (result == WD_OK)
        result = wd_renderer_render(stage->renderer, &by_level, &levels);
    if (result == WD_OK)
        result = wd_picture_expose_alike(truth, &picture, &stage->bench->session->log);
    if (result == WD_OK) {
        add_luma(truth, popping, frame->truth);
        add_luma(&picture, popping, frame->drawn);
        see_blocks(&levels, popping, frame->seen);
    }
    wd_picture_finish(&picture);
    wd_picture_finish(&levels);
    return result;
}

static enum wd_result take_step(struct bench_stage *stage, const struct wd_camera *camera,
                                const struct bench_row *row, uint32_t step, struct popping *popping)
{
    const struct bench_effort *effort = &stage->bench->effort;
    const uint32_t layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID;
    const struct wd_camera moved = step_camera(camera, step);
    const struct wd_reference_picture_params trace = {.camera = moved,
                                                      .width = effort->step_width,
                                                      .height = effort->step_height,
                                                      .samples = effort->step_samples,
                                                      .layers = layers};
    const struct wd_render_params params = {.camera = moved,
                                            .width = effort->step_width,
                                            .height = effort->step_height,
                                            .samples = effort->samples,
                                            .method = row->method,
                                            .layers = layers};
    struct wd_picture truth = {0};
    char name[96];
    snprintf(name, sizeof name, "%s-step%u", row->camera, step);
    enum wd_result result = bench_truth(stage, name, &trace, &truth);
    if (result == WD_OK)
        result = draw_step(stage, &params, &truth, popping, &popping->frames[step % 2]);
    if (result == WD_OK)
        add_step(popping, step);
    wd_picture_finish(&truth);
    return cli_session_interrupted(stage->bench->session) ? WD_ERROR_INTERRUPTED : result;
}

static void describe_popping(const struct popping *popping, struct bench_row *row)
{
    double sum = 0;
    for (size_t i = 0; i < popping->count; i++)
        sum += popping->excess[i];
    row->values[BENCH_POPPING_MEAN] = popping->count ? sum / (double)popping->count : NAN;
    row->values[BENCH_POPPING_P999] = bench_percentile(popping->excess, popping->count, 0.999);
    row->values[BENCH_POPPING_STEP] = bench_percentile(popping->excess, popping->count, 1);
    for (uint32_t i = 0; i < BENCH_BOUNDARIES; i++)
        row->values[BENCH_BOUNDARY_STEP + i] = popping->step[i];
}

enum wd_result bench_measure_popping(struct bench_stage *stage, const struct wd_camera *camera,
                                     struct bench_row *row)
{
    const struct bench_effort *effort = &stage->bench->effort;
    struct popping popping;
    enum wd_result result = popping_init(&popping, effort) ? WD_OK : WD_ERROR_MEMORY;
    for (uint32_t step = 0; step < effort->steps && result == WD_OK; step++)
        result = take_step(stage, camera, row, step, &popping);
    if (result == WD_OK)
        describe_popping(&popping, row);
    popping_finish(&popping);
    return result;
}
