#include "weald/compare.h"

#include <math.h>
#include <stdlib.h>

#include "api/arguments.h"
#include "api/shown.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/exr.h"
#include "output/flip.h"
#include "output/ssim.h"
#include "reference/display.h"

enum { BLOCK = 16 };

/* --- names ----------------------------------------------------------------------------------- */

const char *const *wd_comparison_names(void)
{
    static const char *const names[] = {"flip",          "ssim",          "rmse_pct",
                                        "block_rmse_pct", "radiance_bias_pct", "tree_bias_pct",
                                        "coverage_bias_pct", NULL};
    return names;
}

double wd_comparison_value(const struct wd_comparison *c, uint32_t index)
{
    const double values[] = {c->flip,          c->ssim,          c->rmse_pct,         c->block_rmse_pct,
                             c->radiance_bias_pct, c->tree_bias_pct, c->coverage_bias_pct};
    return index < sizeof values / sizeof *values ? values[index] : 0;
}

/* --- measures -------------------------------------------------------------------------------- */

static double rmse_of(const float *a, const float *b, size_t count)
{
    double squares = 0;
    for (size_t i = 0; i < count; i++) {
        double apart = (double)a[i] - (double)b[i];
        squares += apart * apart;
    }
    return count ? sqrt(squares / (double)count) : 0;
}

/* Means of whole blocks; what is left over at the edges is left out. */
static float *block_means(const struct wd_picture *picture, size_t *count)
{
    uint32_t columns = picture->width / BLOCK, rows = picture->height / BLOCK;
    *count = (size_t)columns * rows * 3;
    float *means = wd_alloc_array(*count, sizeof *means);
    for (uint32_t y = 0; y < rows * BLOCK; y++)
        for (uint32_t x = 0; x < columns * BLOCK; x++)
            for (uint32_t k = 0; k < 3; k++)
                means[((size_t)(y / BLOCK) * columns + x / BLOCK) * 3 + k] +=
                    picture->color[((size_t)y * picture->width + x) * 3 + k] / (BLOCK * BLOCK);
    return means;
}

static double block_rmse(const struct wd_picture *a, const struct wd_picture *b)
{
    size_t count;
    float *means_a = block_means(a, &count), *means_b = block_means(b, &count);
    double rmse = rmse_of(means_a, means_b, count);
    free(means_a);
    free(means_b);
    return rmse;
}

static double over_pct(double value, double reference)
{
    return reference > 0 ? 100 * (value / reference - 1) : 0;
}

static void compare_radiance(struct wd_comparison *comparison, const struct wd_picture *reference,
                             const struct wd_picture *picture)
{
    size_t pixels = (size_t)reference->width * reference->height;
    double sum[2] = {0}, trees[2] = {0}, covered[2] = {0};
    for (size_t i = 0; i < pixels; i++) {
        bool tree = reference->tree_id[i] && picture->tree_id[i];
        covered[0] += reference->tree_id[i] != 0;
        covered[1] += picture->tree_id[i] != 0;
        for (size_t k = 3 * i; k < 3 * i + 3; k++) {
            sum[0] += (double)reference->color[k];
            sum[1] += (double)picture->color[k];
            trees[0] += tree ? (double)reference->color[k] : 0;
            trees[1] += tree ? (double)picture->color[k] : 0;
        }
    }
    double mean = sum[0] / (3 * (double)pixels), over = mean > 0 ? 100 / mean : 0;
    comparison->rmse_pct = rmse_of(reference->color, picture->color, 3 * pixels) * over;
    comparison->block_rmse_pct = block_rmse(reference, picture) * over;
    comparison->radiance_bias_pct = over_pct(sum[1], sum[0]);
    comparison->tree_bias_pct = over_pct(trees[1], trees[0]);
    comparison->coverage_bias_pct = over_pct(covered[1], covered[0]);
}

static bool check_colors(const struct wd_picture *picture, const char *name, const struct wd_log *log)
{
    size_t values = 3 * (size_t)picture->width * picture->height;
    for (size_t i = 0; i < values; i++)
        if (!isfinite(picture->color[i]))
            return wd_error(log, "the %s has a colour that is no finite number, in column %zu of row %zu", name,
                            i / 3 % picture->width, i / 3 / picture->width);
    return true;
}

static bool check(const struct wd_picture *reference, const struct wd_picture *picture,
                  const struct wd_log *log)
{
    if (!wd_given(reference, log) || !wd_given(picture, log))
        return false;
    if (reference->width != picture->width || reference->height != picture->height)
        return wd_error(log, "the reference has %u x %u pixels, the picture %u x %u: both must have "
                             "the same size",
                        reference->width, reference->height, picture->width, picture->height);
    if (!reference->width || !reference->height)
        return wd_error(log, "pictures without pixels cannot be compared");
    if (!reference->color || !picture->color)
        return wd_error(log, "pictures are compared by their colour layer, which one lacks");
    return check_colors(reference, "reference", log) && check_colors(picture, "picture", log);
}

enum wd_result wd_picture_compare(struct wd_comparison *comparison,
                                  const struct wd_picture *reference,
                                  const struct wd_picture *picture, float *error_map,
                                  const struct wd_log *log)
{
    if (!check(reference, picture, log))
        return WD_ERROR_INPUT;
    if (!reference->tree_id || !picture->tree_id) {
        wd_error(log, "pictures are compared by their tree ids, too, which one lacks");
        return WD_ERROR_INPUT;
    }
    uint32_t width = reference->width, height = reference->height;
    size_t pixels = (size_t)width * height;
    float exposure = wd_display_exposure(reference->color, width, height);
    uint8_t *shown[2] = {wd_alloc_array(pixels, 4), wd_alloc_array(pixels, 4)};
    float *map = error_map ? error_map : wd_alloc_array(pixels, sizeof *map);
    wd_display_map_at(reference->color, width, height, exposure, shown[0]);
    wd_display_map_at(picture->color, width, height, exposure, shown[1]);
    *comparison = (struct wd_comparison){
        .flip = wd_flip(map, shown[0], shown[1], width, height, 4, WD_FLIP_PIXELS_PER_DEGREE),
        .ssim = wd_ssim(shown[0], shown[1], width, height, 4),
    };
    compare_radiance(comparison, reference, picture);
    if (map != error_map)
        free(map);
    free(shown[0]);
    free(shown[1]);
    return WD_OK;
}

enum wd_result wd_picture_expose_alike(struct wd_picture *reference, struct wd_picture *picture,
                                       const struct wd_log *log)
{
    if (!check(reference, picture, log))
        return WD_ERROR_INPUT;
    float exposure = wd_display_exposure(reference->color, reference->width, reference->height);
    struct wd_picture *both[] = {reference, picture};
    for (int i = 0; i < 2; i++) {
        size_t pixels = (size_t)both[i]->width * both[i]->height;
        if (!both[i]->display)
            both[i]->display = wd_alloc_array(pixels, 4);
        wd_display_map_at(both[i]->color, both[i]->width, both[i]->height, exposure,
                          both[i]->display);
    }
    return WD_OK;
}

/* --- reading --------------------------------------------------------------------------------- */

/* NULL where there is none. False, logged, where there is not so much memory. */
static bool take_color(float **color, const struct wd_exr_image *image, const struct wd_log *log)
{
    static const char *const names[] = {"R", "G", "B"};
    const struct wd_exr_plane *planes[3];
    *color = NULL;
    for (int k = 0; k < 3; k++) {
        planes[k] = wd_exr_find(image, names[k]);
        if (!planes[k] || planes[k]->type == WD_EXR_UINT)
            return true;
    }
    size_t pixels = (size_t)image->width * image->height;
    *color = wd_picture_try_scratch(image->width, image->height, 3 * sizeof **color, log);
    for (size_t i = 0; *color && i < pixels; i++)
        for (size_t k = 0; k < 3; k++)
            (*color)[3 * i + k] = ((const float *)planes[k]->data)[i];
    return *color != NULL;
}

/* Takes the plane's memory over; NULL where there is none of that name and type. */
static void *take_plane(struct wd_exr_image *image, const char *name, bool whole_numbers)
{
    const struct wd_exr_plane *found = wd_exr_find(image, name);
    if (!found || (found->type == WD_EXR_UINT) != whole_numbers)
        return NULL;
    struct wd_exr_plane *plane = &image->planes[found - image->planes];
    void *data = plane->data;
    plane->data = NULL;
    return data;
}

enum wd_result wd_picture_read_exr(struct wd_picture *picture, const char *path,
                                   const struct wd_log *log)
{
    struct wd_exr_image image;
    float *color;
    *picture = (struct wd_picture){0};
    if (!wd_given(path, log))
        return WD_ERROR_INPUT;
    if (!wd_exr_read(&image, path, log))
        return image.no_memory ? WD_ERROR_MEMORY : WD_ERROR_INPUT;
    if (!take_color(&color, &image, log)) {
        wd_exr_image_finish(&image);
        return WD_ERROR_MEMORY;
    }
    *picture = (struct wd_picture){
        .width = image.width,
        .height = image.height,
        .color = color,
        .depth_m = take_plane(&image, "Z", false),
        .species = take_plane(&image, "species", true),
        .tree_id = take_plane(&image, "tree_id", true),
    };
    wd_exr_image_finish(&image);
    return WD_OK;
}
