#include "frame/passes/terrain_patches.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "shared/ground_cover.h"

/* Why nothing comes apart: distances are measured across (plus one height for the whole frame), so
 * a patch of level k, whose parent comes within range[k - 1 + 1], ends before range[k] + the
 * parent's diagonal. Level k + 1 begins to morph only beyond that, level k has morphed fully at
 * range[k], and range[k + 1] - range[k] exceeds a diagonal: neighbours differ by one level at most,
 * and where they meet the finer one has become the coarser one's edge, which does not move. */

/* Ranges in units of the next level's patch width: at least what the above asks for; at most what
 * keeps a picture within some 450 patches (58,000 triangles). */
static const double LEAST_RANGE = 2.9, MOST_RANGE = 6.0;
static const double MORPH_SHARE = 0.35; /* of the span in which morphing may happen */

struct selection {
    struct wd_patch_list *list;
    const struct wd_patch_ranges *ranges;
    const struct wd_ground *ground;
    const struct wd_view *view;
};

void wd_patch_list_finish(struct wd_patch_list *list)
{
    free(list->items);
    *list = (struct wd_patch_list){0};
}

static double patch_width_m(const struct wd_ground *ground, uint32_t level)
{
    return (double)((uint64_t)WD_PATCH_CELLS << level) * ground->terrain->cell_m;
}

void wd_patch_ranges_init(struct wd_patch_ranges *ranges, const struct wd_ground *ground,
                          const struct wd_view *view, float error_px)
{
    ranges->above_m = fmax(view->eye_m[2] - ground->terrain->max_m, 0.0);
    double before = 0, px_per_error = view->pixels_per_radian / fmax(error_px, 0.01);
    for (uint32_t k = 0; k < WD_TERRAIN_LEVELS; k++) {
        double parent = patch_width_m(ground, k + 1);
        uint32_t next = k + 1 < ground->level_count ? k + 1 : ground->level_count - 1;
        double wanted = ground->levels[next].error_m * px_per_error;
        double range = fmin(fmax(wanted, LEAST_RANGE * parent), MOST_RANGE * parent);
        range = fmax(range, before + 1.45 * parent);
        ranges->range_m[k] = (float)range;
        before = range;
    }
}

/* --- selection ----------------------------------------------------------------------------- */

static double outside(double low, double high, double at)
{
    return at < low ? low - at : at > high ? at - high : 0;
}

static void add_patch(struct selection *s, bool detailed, struct wd_terrain_patch patch)
{
    struct wd_patch_list *list = s->list;
    struct wd_terrain_patch *to = wd_push(list->items, list->count, list->capacity);
    if (detailed) {
        *to = list->items[list->detailed];
        to = &list->items[list->detailed++];
    }
    *to = patch;
}

static void add_with_curtains(struct selection *s, double distance_m, uint32_t level,
                              uint32_t column, uint32_t row)
{
    float sample_rad = wd_sample_footprint(s->view->samples) / s->view->pixels_per_radian;
    bool detailed = distance_m < (double)(WD_STREWN_NONE_M / sample_rad);
    const struct wd_terrain *terrain = s->ground->terrain;
    uint32_t size = WD_PATCH_CELLS << level;
    bool edges[5] = {[WD_EDGE_NONE] = true,
                     [WD_EDGE_SOUTH] = row == 0,
                     [WD_EDGE_EAST] = column + size >= terrain->width - 1,
                     [WD_EDGE_NORTH] = row + size >= terrain->height - 1,
                     [WD_EDGE_WEST] = column == 0};
    for (uint32_t edge = WD_EDGE_NONE; edge <= WD_EDGE_WEST; edge++)
        if (edges[edge])
            add_patch(s, detailed, (struct wd_terrain_patch){column, row, level, edge});
}

static void visit(struct selection *s, uint32_t level, uint32_t i, uint32_t j)
{
    const struct wd_ground_level *grid = &s->ground->levels[level];
    if (i >= grid->columns || j >= grid->rows)
        return;
    const struct wd_terrain *terrain = s->ground->terrain;
    const double *eye = s->view->eye_m;
    struct wd_height_range range = grid->ranges[(size_t)j * grid->columns + i];
    double width = patch_width_m(s->ground, level);
    double west = i * width - eye[0], south = j * width - eye[1];
    double east = fmin((i + 1) * width, wd_terrain_extent_x_m(terrain)) - eye[0];
    double north = fmin((j + 1) * width, wd_terrain_extent_y_m(terrain)) - eye[1];
    const float min[3] = {(float)west, (float)south, (float)(range.min_m - eye[2])};
    const float max[3] = {(float)east, (float)north, (float)(range.max_m - eye[2])};
    if (wd_frustum_box(&s->view->frustum, min, max) == WD_OUTSIDE)
        return;
    double x = outside(west, east, 0), y = outside(south, north, 0), z = s->ranges->above_m;
    double distance = sqrt(x * x + y * y + z * z);
    if (level == 0 || distance >= s->ranges->range_m[level - 1]) {
        add_with_curtains(s, distance, level, (i * WD_PATCH_CELLS) << level,
                          (j * WD_PATCH_CELLS) << level);
        return;
    }
    /* nearest child first: what is behind fails the depth test early */
    uint32_t near_i = 0.5 * (west + east) < 0, near_j = 0.5 * (south + north) < 0;
    for (uint32_t child = 0; child < 4; child++)
        visit(s, level - 1, 2 * i + ((child & 1) ^ near_i), 2 * j + ((child >> 1) ^ near_j));
}

void wd_patches_select(struct wd_patch_list *list, const struct wd_patch_ranges *ranges,
                       const struct wd_ground *ground, const struct wd_view *view)
{
    struct selection selection = {list, ranges, ground, view};
    const struct wd_ground_level *top = &ground->levels[ground->level_count - 1];
    list->count = list->detailed = 0;
    for (uint32_t j = 0; j < top->rows; j++) {
        for (uint32_t i = 0; i < top->columns; i++)
            visit(&selection, ground->level_count - 1, i, j);
    }
}

/* --- for the shaders ------------------------------------------------------------------------ */

static void set_morph(struct wd_terrain_view *out, const struct wd_patch_ranges *ranges,
                      const struct wd_ground *ground)
{
    for (uint32_t k = 0; k < WD_TERRAIN_LEVELS; k++) {
        double diagonal = 1.4143 * patch_width_m(ground, k);
        double least = k ? ranges->range_m[k - 1] + diagonal : 0;
        double begin = ranges->range_m[k] - MORPH_SHARE * (ranges->range_m[k] - least);
        bool last = k + 1 >= ground->level_count;
        out->morph[k][0] = last ? 1e30f : (float)begin;
        out->morph[k][1] = last ? 0 : (float)(1 / (ranges->range_m[k] - begin));
    }
}

void wd_terrain_view_init(struct wd_terrain_view *out, const struct wd_patch_ranges *ranges,
                          const struct wd_ground *ground, const struct wd_view *view)
{
    const struct wd_terrain *terrain = ground->terrain;
    const struct wd_image *slopes = &ground->slopes, *cover = &ground->cover;
    double texel_m = ground->slopes_step * terrain->cell_m;
    *out = (struct wd_terrain_view){
        .cell_m = (float)terrain->cell_m,
        .above_m = (float)ranges->above_m,
        .curtain_m = wd_terrain_foot_m(terrain),
        .width = terrain->width,
        .height = terrain->height,
        .extent_m = {(float)wd_terrain_extent_x_m(terrain), (float)wd_terrain_extent_y_m(terrain)},
        .slopes_scale = {(float)(1 / (texel_m * slopes->width)),
                         (float)(1 / (texel_m * slopes->height))},
        .slopes_offset = {0.5f / (float)slopes->width, 0.5f / (float)slopes->height},
        .cover_scale = {(float)(1 / (ground->cover_cell_m * cover->width)),
                        (float)(1 / (ground->cover_cell_m * cover->height))},
        .camera_m = {(float)view->eye_m[0], (float)view->eye_m[1]},
        .slopes_texel_m = (float)texel_m,
        .cover_texel_m = (float)ground->cover_cell_m,
        .pixel_rad = 1 / view->pixels_per_radian,
        .sample_rad = wd_sample_footprint(view->samples) / view->pixels_per_radian,
    };
    for (int k = 0; k < 2; k++) {
        double cell = floor(view->eye_m[k] / terrain->cell_m);
        out->camera_cell[k] = (int32_t)cell;
        out->camera_offset_m[k] = (float)(view->eye_m[k] - cell * terrain->cell_m);
    }
    set_morph(out, ranges, ground);
}
