/* placement_canopy.c: trees where a canopy-height raster has its local maxima.
 *
 * A cell is a tree top when nothing is higher within a window that grows with the height, as
 * crowns do: radius 0.5 m + 0.06 h, within the range that Popescu and Wynne (2004) and Plowright's
 * ForestTools use. Tops nearer than the layer's spacing to a higher one are left out. */
#include "world/placement.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
#include "base/memory.h"

static const float least_top_m = 2.0f, most_top_m = 120.0f;

struct top {
    float height_m;
    uint32_t column, row;
    double x_m, y_m;
};
struct top_list {
    struct top *tops;
    size_t count, capacity;
};
struct search {
    const struct wd_raster *raster;
    struct top_list *rows;
    size_t first_row;
};

static bool is_higher(const struct wd_raster *raster, long column, long row, size_t here)
{
    if (column < 0 || row < 0 || column >= (long)raster->width || row >= (long)raster->height)
        return false;
    size_t there = (size_t)row * raster->width + (size_t)column;
    float height_m = raster->values[there], own_m = raster->values[here];
    /* of equal cells, the first is the top */
    return height_m <= most_top_m && (height_m > own_m || (height_m == own_m && there < here));
}

static bool is_top(const struct wd_raster *raster, long column, long row)
{
    size_t here = (size_t)row * raster->width + (size_t)column;
    double radius_m = 0.5 + 0.06 * (double)raster->values[here];
    long columns = (long)fmax(radius_m / raster->cell_x_m, 1.0);
    long rows = (long)fmax(radius_m / raster->cell_y_m, 1.0);
    double limit = fmax(radius_m * radius_m, 2.001 * raster->cell_x_m * raster->cell_y_m);
    for (long j = -rows; j <= rows; j++)
        for (long i = -columns; i <= columns; i++) {
            double x_m = (double)i * raster->cell_x_m, y_m = (double)j * raster->cell_y_m;
            if (x_m * x_m + y_m * y_m <= limit && is_higher(raster, column + i, row + j, here))
                return false;
        }
    return true;
}

static void search_row(void *user, size_t index)
{
    struct search *search = user;
    const struct wd_raster *raster = search->raster;
    struct top_list *list = &search->rows[index];
    uint32_t row = (uint32_t)(search->first_row + index);
    for (uint32_t column = 0; column < raster->width; column++) {
        float height_m = raster->values[(size_t)row * raster->width + column];
        if (!(height_m >= least_top_m && height_m <= most_top_m) || !is_top(raster, column, row))
            continue;
        struct top *top = wd_push(list->tops, list->count, list->capacity);
        *top = (struct top){height_m, column, row, ((double)column + 0.5) * raster->cell_x_m,
                            ((double)row + 0.5) * raster->cell_y_m};
    }
}

static bool find_tops(struct top_list *found, const struct wd_raster *raster,
                      const struct wd_placement_params *params)
{
    enum { ROWS_A_BATCH = 64 };
    struct top_list rows[ROWS_A_BATCH] = {0};
    struct search search = {.raster = raster, .rows = rows};
    bool ok = true;
    while (ok && search.first_row < raster->height) {
        size_t left = raster->height - search.first_row;
        size_t count = left < ROWS_A_BATCH ? left : ROWS_A_BATCH;
        wd_jobs_run(params->threads, count, search_row, &search);
        for (size_t i = 0; i < count; i++) {
            for (size_t k = 0; k < rows[i].count; k++) {
                struct top *top = wd_push(found->tops, found->count, found->capacity);
                *top = rows[i].tops[k];
            }
            rows[i].count = 0;
        }
        search.first_row += count;
        ok = wd_progress_report(params->progress, "canopy rows", search.first_row, raster->height);
    }
    for (size_t i = 0; i < ROWS_A_BATCH; i++)
        free(rows[i].tops);
    return ok;
}

static int higher_first(const void *first, const void *second)
{
    const struct top *a = first, *b = second;
    if (a->height_m != b->height_m)
        return a->height_m > b->height_m ? -1 : 1;
    if (a->row != b->row)
        return a->row < b->row ? -1 : 1;
    return a->column < b->column ? -1 : a->column > b->column;
}

/* Tops kept so far, in square bins at least as wide as the spacing: a bin holds the index + 1 of its first
 * top, and each top that of the next. */
struct bins {
    uint32_t *first, *next;
    uint32_t width, height;
    double size_m, spacing_m;
};

static bool is_crowded(const struct bins *bins, const struct top *tops, const struct top *top)
{
    uint32_t column = (uint32_t)(top->x_m / bins->size_m), row = (uint32_t)(top->y_m / bins->size_m);
    for (uint32_t j = row ? row - 1 : 0; j <= row + 1 && j < bins->height; j++)
        for (uint32_t i = column ? column - 1 : 0; i <= column + 1 && i < bins->width; i++)
            for (uint32_t k = bins->first[(size_t)j * bins->width + i]; k != 0;
                 k = bins->next[k - 1]) {
                double x_m = tops[k - 1].x_m - top->x_m, y_m = tops[k - 1].y_m - top->y_m;
                if (x_m * x_m + y_m * y_m < bins->spacing_m * bins->spacing_m)
                    return true;
            }
    return false;
}

/* Keeps, from the highest down, the tops that have no kept one within the spacing. */
static void keep_spaced(struct top_list *list, double spacing_m, double x_m, double y_m)
{
    if (!(spacing_m > 0.0) || list->count == 0)
        return;
    double size_m = fmax(spacing_m, fmax(x_m, y_m) / 4096.0);
    struct bins bins = {.size_m = size_m, .spacing_m = spacing_m,
                        .width = (uint32_t)(x_m / size_m) + 2,
                        .height = (uint32_t)(y_m / size_m) + 2};
    bins.first = wd_alloc_array((size_t)bins.width * bins.height, sizeof *bins.first);
    bins.next = wd_alloc_array(list->count, sizeof *bins.next);
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        struct top top = list->tops[i];
        if (is_crowded(&bins, list->tops, &top))
            continue;
        uint32_t column = (uint32_t)(top.x_m / size_m), row = (uint32_t)(top.y_m / size_m);
        uint32_t *first = &bins.first[(size_t)row * bins.width + column];
        list->tops[kept] = top;
        bins.next[kept] = *first;
        *first = (uint32_t)++kept;
    }
    list->count = kept;
    free(bins.first);
    free(bins.next);
}

/* Within its raster cell a top stands by the layer's jitter. */
static int32_t jittered_mm(double centre_m, double cell_m, double jitter, uint32_t random,
                           int32_t extent_mm)
{
    double offset = ((double)random / 4294967296.0 - 0.5) * jitter * cell_m;
    double mm = floor((centre_m + offset) * 1000.0 + 0.5);
    return mm < 0.0 ? 0 : mm > extent_mm ? extent_mm : (int32_t)mm;
}

static bool plant_tops(const struct wd_placement *placement, const struct top_list *list,
                       const struct wd_raster *raster, const struct wd_placement_params *params,
                       struct wd_tree_list *trees)
{
    const struct wd_place_layer *layer = &placement->input.layer;
    size_t before = trees->count;
    for (size_t i = 0; i < list->count; i++) {
        const struct top *top = &list->tops[i];
        uint32_t key = wd_hash3(layer->key, top->column, top->row);
        int32_t x_mm = jittered_mm(top->x_m, raster->cell_x_m, placement->layer->jitter,
                                   wd_hash2(key, WD_FOR_EAST), layer->extent_mm[0]);
        int32_t y_mm = jittered_mm(top->y_m, raster->cell_y_m, placement->layer->jitter,
                                   wd_hash2(key, WD_FOR_NORTH), layer->extent_mm[1]);
        struct wd_place_verdict verdict = wd_place_judge(&placement->input, key, x_mm, y_mm);
        if (!verdict.accepted)
            continue;
        if (trees->count >= params->max_trees)
            return wd_too_many_trees(params, placement->name);
        uint32_t height_cm = (uint32_t)((double)top->height_m * 100.0 + 0.5);
        struct wd_tree tree = wd_place_grow(&placement->input, key, x_mm, y_mm, verdict.z_mm,
                                            height_cm);
        wd_tree_list_add(trees, &tree);
    }
    size_t left_out = list->count - (trees->count - before);
    if (left_out)
        wd_info(params->log, "%s: %zu of %zu tops left out by the layer's rules (slope_deg, altitude_m, map, patchiness), "
                "by water or by holes of the ground", placement->name, left_out, list->count);
    return true;
}

/* What the raster's cells say of its unit. */
struct heights {
    size_t known, plants, too_high; /* cells; of those with a height, those from 2 m up; of these, those over 120 m */
    float least_m, most_m;
};

static struct heights heights_of(const struct wd_raster *raster)
{
    struct heights heights = {.least_m = INFINITY, .most_m = -INFINITY};
    size_t count = (size_t)raster->width * raster->height;
    for (size_t i = 0; i < count; i++) {
        float height_m = raster->values[i];
        if (isnan(height_m))
            continue;
        heights.known++;
        heights.plants += height_m >= least_top_m;
        heights.too_high += height_m > most_top_m;
        heights.least_m = fminf(heights.least_m, height_m);
        heights.most_m = fmaxf(heights.most_m, height_m);
    }
    return heights;
}

/* Decimetres taken for metres, or heights above the sea, leave the rims of crowns as tops: that is no forest. A few
 * cells are birds and pylons. */
static bool check_heights(const struct wd_placement *placement, const struct heights *heights, const struct wd_log *log)
{
    const double most_share = 0.05, least_of_all = 0.005;
    static const char *const what =
        "%s: %s: %.3g %% of its cells from 2 m up are over 120 m, up to %.4g m, and no tree is. Wanted are metres above "
        "the ground: of other units write the scale into the file (gdal_translate -a_scale 0.1 for decimetres), from a "
        "surface model subtract the terrain; numbers that mean no data are to be its nodata value (-a_nodata)%s";
    double share = heights->plants ? (double)heights->too_high / (double)heights->plants : 0;
    if (share > most_share && (double)heights->too_high > least_of_all * (double)heights->known)
        return wd_error(log, what, placement->name, placement->layer->canopy.file, 100 * share, (double)heights->most_m, "");
    if (share > 0)
        wd_warn(log, what, placement->name, placement->layer->canopy.file, 100 * share, (double)heights->most_m,
                "; they are passed over");
    return true;
}

/* A raster without any data has been told of. */
static void warn_of_no_top(const struct wd_placement *placement, const struct heights *heights, const struct wd_log *log)
{
    if (heights->known)
        wd_warn(log, "%s: %s has no top of 2 to 120 m on the terrain: no tree stands; its heights are %.4g to %.4g m",
                placement->name, placement->layer->canopy.file, (double)heights->least_m, (double)heights->most_m);
}

static bool load_tops(struct top_list *tops, struct wd_raster *raster, const struct wd_placement *placement,
                      const struct wd_placement_params *params)
{
    const struct wd_scene_layer *layer = placement->layer;
    *raster = (struct wd_raster){0};
    if (layer->canopy.file == NULL)
        return wd_error(params->log, "%s: placement \"canopy\" needs canopy.file, a raster "
                        "of canopy heights in metres", placement->name);
    if (!wd_raster_load(raster, params->scene, &layer->canopy, params->terrain, WD_RESAMPLE_MAX, UINT64_C(1) << 26,
                        params->log))
        return false;
    struct heights heights = heights_of(raster);
    if (!check_heights(placement, &heights, params->log) || !find_tops(tops, raster, params))
        return false;
    if (tops->count == 0)
        warn_of_no_top(placement, &heights, params->log);
    return true;
}

bool wd_canopy_check(const struct wd_placement *placement, const struct wd_placement_params *params)
{
    struct wd_raster raster;
    struct top_list tops = {0};
    bool ok = load_tops(&tops, &raster, placement, params);
    free(tops.tops);
    wd_raster_finish(&raster);
    return ok;
}

bool wd_canopy_fill(const struct wd_placement *placement, const struct wd_placement_params *params,
                    struct wd_tree_list *list)
{
    struct wd_raster raster;
    struct top_list tops = {0};
    bool ok = load_tops(&tops, &raster, placement, params);
    if (ok && tops.count) {
        qsort(tops.tops, tops.count, sizeof *tops.tops, higher_first);
        keep_spaced(&tops, placement->layer->spacing_m, wd_terrain_extent_x_m(params->terrain),
                    wd_terrain_extent_y_m(params->terrain));
        ok = plant_tops(placement, &tops, &raster, params, list);
    }
    free(tops.tops);
    wd_raster_finish(&raster);
    return ok;
}
