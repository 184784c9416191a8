/* The pictures of docs/gallery.md: each drawn and path-traced from the same camera, and how far both
 * are apart. What is finished stays in the directory and is not made again.
 *   gallery DIR [--size WxH] [--samples N] [--paths N] [--data DIR] [--only NAME] [--gpu NAME]
 * For each picture NAME: NAME.exr and NAME.png (drawn), NAME-traced.exr and NAME-traced.png (half the
 * size: means of 2 x 2 pixels, whose fireflies are clamped to four times their brightest neighbour),
 * and NAME.txt (FLIP; mean radiance over the reference's, less 100). Ends with a line gallery-flip. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "weald/compare.h"
#include "weald/reference.h"

/* Pictures are compared at this width, of means of as many pixels as it takes: noise of the few
 * paths a pixel would count as difference otherwise. */
enum { COMPARED_WIDTH = 480 };

static const struct entry {
    const char *name, *scene, *camera;
    uint32_t sharper; /* samples are so many times more: of a lens */
    uint32_t darker;  /* and paths: where little light comes */
} entries[] = {
    {"dawn-fog", "scenes/gallery/dawn-fog.json", "valley", 1, 1},
    {"noon-overview", "scenes/gallery/noon-overview.json", "over", 1, 1},
    {"birches", "scenes/gallery/birches.json", "west", 1, 1},
    {"beech-hall", "scenes/gallery/beech-hall.json", "hall", 1, 3},
    {"pine-ridge", "scenes/gallery/pine-ridge.json", "ridge", 1, 1},
    {"lake", "scenes/gallery/lake.json", "shore", 1, 2},
    {"hedge-rows", "scenes/gallery/hedge-rows.json", "rows", 1, 1},
    {"winter-spruce", "scenes/gallery/winter-spruce.json", "glade", 1, 2},
    {"leaves", "scenes/gallery/leaves.json", "near", 4, 3},
    {"understory", "scenes/gallery/understory.json", "floor", 1, 4},
    {"bei", "scenes/bei.json", "stand", 1, 1},
    {"quesnel", "scenes/quesnel.json", "air", 1, 1},
};
enum { ENTRIES = sizeof entries / sizeof *entries };

struct options {
    const char *directory, *data, *only, *gpu;
    uint32_t width, height, samples, paths;
};

struct work {
    const struct options *options;
    const struct entry *entry;
    struct wd_forest *forest;
    struct wd_camera camera;
    char label[64];
};

/* --- progress -------------------------------------------------------------------------------- */

static bool report(void *user, const char *stage, uint64_t done, uint64_t total)
{
    const struct work *work = user;
    int percent = total ? (int)(100 * done / total) : 0;
    if (isatty(2))
        fprintf(stderr, "\r\033[K[%2d/%d] %s: %s %d%%", (int)(work->entry - entries) + 1, ENTRIES,
                work->label, stage, percent);
    return true;
}

static void path_of(char path[512], const struct work *work, const char *ending)
{
    snprintf(path, 512, "%s/%s%s", work->options->directory, work->entry->name, ending);
}

static bool is_there(const struct work *work, const char *ending)
{
    char path[512];
    path_of(path, work, ending);
    return !access(path, R_OK);
}

static bool write_picture(const struct work *work, const struct wd_picture *picture,
                          const char *ending)
{
    char path[512];
    path_of(path, work, ending);
    return wd_picture_write(picture, path, NULL) == WD_OK;
}

static bool read_picture(const struct work *work, struct wd_picture *picture, const char *ending)
{
    char path[512];
    path_of(path, work, ending);
    return wd_picture_read_exr(picture, path, NULL) == WD_OK;
}

/* --- the two pictures ------------------------------------------------------------------------ */

static bool open_forest(struct work *work)
{
    const struct wd_forest_params params = {.scene_path = work->entry->scene,
                                            .data_dir = work->options->data,
                                            .progress = {report, work}};
    if (work->forest)
        return true;
    return wd_forest_create(&work->forest, &params) == WD_OK &&
           wd_forest_get_camera(work->forest, work->entry->camera, &work->camera) == WD_OK;
}

static bool draw(struct work *work)
{
    const struct options *options = work->options;
    const struct wd_renderer_params renderer_params = {.gpu = options->gpu,
                                                       .progress = {report, work}};
    struct wd_render_params params = {.width = options->width,
                                      .height = options->height,
                                      .samples = options->samples * work->entry->sharper,
                                      .layers = WD_LAYER_DISPLAY | WD_LAYER_COLOR |
                                                WD_LAYER_TREE_ID};
    struct wd_renderer *renderer = NULL;
    struct wd_picture picture = {0};
    if (is_there(work, ".exr"))
        return true;
    snprintf(work->label, sizeof work->label, "%s, drawing", work->entry->name);
    bool ok = open_forest(work) && wd_renderer_create(&renderer, &renderer_params) == WD_OK &&
              wd_renderer_set_forest(renderer, work->forest) == WD_OK;
    params.camera = work->camera;
    ok = ok && wd_renderer_render(renderer, &params, &picture) == WD_OK &&
         write_picture(work, &picture, ".png") && write_picture(work, &picture, ".exr");
    wd_picture_finish(&picture);
    wd_renderer_destroy(&renderer);
    return ok;
}

static bool trace(struct work *work)
{
    char checkpoint[512];
    path_of(checkpoint, work, "-traced.partial");
    const struct wd_reference_params reference_params = {.progress = {report, work}};
    struct wd_reference_picture_params params = {.width = work->options->width,
                                                 .height = work->options->height,
                                                 .samples = work->options->paths * work->entry->darker,
                                                 .layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID,
                                                 .checkpoint = checkpoint};
    struct wd_reference *reference = NULL;
    struct wd_picture picture = {0};
    if (is_there(work, "-traced.exr"))
        return true;
    snprintf(work->label, sizeof work->label, "%s, tracing", work->entry->name);
    bool ok = open_forest(work) &&
              wd_reference_create(&reference, work->forest, &reference_params) == WD_OK;
    params.camera = work->camera;
    ok = ok && wd_reference_render(reference, &params, &picture) == WD_OK &&
         write_picture(work, &picture, "-traced.exr");
    wd_picture_finish(&picture);
    wd_reference_destroy(&reference);
    return ok;
}

/* --- side by side ---------------------------------------------------------------------------- */

static float luminance(const float *rgb)
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

static float brightest_neighbour(const struct wd_picture *picture, uint32_t x, uint32_t y)
{
    float most = 0;
    for (int32_t j = -1; j <= 1; j++)
        for (int32_t i = -1; i <= 1; i++) {
            int64_t column = (int64_t)x + i, row = (int64_t)y + j;
            if ((i || j) && column >= 0 && row >= 0 && column < picture->width &&
                row < picture->height)
                most = fmaxf(most, luminance(picture->color +
                                             3 * ((size_t)row * picture->width + (size_t)column)));
        }
    return most;
}

/* A pixel with one path that found the sun by chance outshines all around it. */
static void clamp_fireflies(struct wd_picture *picture)
{
    float *clamped = malloc((size_t)picture->width * picture->height * 3 * sizeof *clamped);
    for (uint32_t y = 0; y < picture->height && clamped; y++)
        for (uint32_t x = 0; x < picture->width; x++) {
            size_t at = 3 * ((size_t)y * picture->width + x);
            float own = luminance(picture->color + at);
            float most = 4 * brightest_neighbour(picture, x, y);
            for (size_t k = 0; k < 3; k++)
                clamped[at + k] = picture->color[at + k] * (own > most ? most / own : 1);
        }
    if (clamped) {
        free(picture->color);
        picture->color = clamped;
    }
}

/* Means of `step` x `step` pixels; of tree ids the first. */
static struct wd_picture shrink(const struct wd_picture *picture, uint32_t step)
{
    struct wd_picture small = {.width = picture->width / step, .height = picture->height / step};
    size_t pixels = (size_t)small.width * small.height;
    small.color = calloc(pixels, 3 * sizeof *small.color);
    small.tree_id = calloc(pixels, sizeof *small.tree_id);
    for (size_t i = 0; i < pixels * step * step && small.color && small.tree_id; i++) {
        size_t y = i / ((size_t)small.width * step), x = i % ((size_t)small.width * step);
        size_t to = y / step * small.width + x / step, from = y * picture->width + x;
        for (size_t k = 0; k < 3; k++)
            small.color[3 * to + k] += picture->color[3 * from + k] / (float)(step * step);
        if (x % step == 0 && y % step == 0)
            small.tree_id[to] = picture->tree_id[from];
    }
    return small;
}

static bool compare(const struct work *work, const struct wd_picture *drawn,
                    const struct wd_picture *traced)
{
    uint32_t step = drawn->width > COMPARED_WIDTH ? drawn->width / COMPARED_WIDTH : 1;
    struct wd_picture small[2] = {shrink(drawn, step), shrink(traced, step)};
    struct wd_comparison comparison;
    char path[512];
    path_of(path, work, ".txt");
    bool ok = wd_picture_compare(&comparison, &small[1], &small[0], NULL, NULL) == WD_OK;
    FILE *file = ok ? fopen(path, "w") : NULL;
    if (file)
        fprintf(file, "%.3f %+.1f\n", comparison.flip, comparison.radiance_bias_pct);
    ok = file && !fclose(file);
    wd_picture_finish(&small[0]);
    wd_picture_finish(&small[1]);
    return ok;
}

/* The traced picture at the exposure that it asks for, as the drawn one has its own. */
static bool show_traced(const struct work *work, struct wd_picture *traced)
{
    clamp_fireflies(traced);
    struct wd_picture half = shrink(traced, 2), same = shrink(traced, 2);
    bool ok = wd_picture_expose_alike(&half, &same, NULL) == WD_OK &&
              write_picture(work, &half, "-traced.png");
    wd_picture_finish(&half);
    wd_picture_finish(&same);
    return ok;
}

static bool set_side_by_side(const struct work *work)
{
    struct wd_picture drawn = {0}, traced = {0};
    if (is_there(work, ".txt"))
        return true;
    bool ok = read_picture(work, &drawn, ".exr") && read_picture(work, &traced, "-traced.exr") &&
              compare(work, &drawn, &traced) && show_traced(work, &traced);
    wd_picture_finish(&drawn);
    wd_picture_finish(&traced);
    return ok;
}

/* --- all ------------------------------------------------------------------------------------- */

static bool make(const struct options *options, const struct entry *entry, double *flip)
{
    struct work work = {.options = options, .entry = entry};
    char path[512];
    double bias_pct = 0;
    bool ok = draw(&work) && trace(&work) && set_side_by_side(&work);
    wd_forest_destroy(&work.forest);
    path_of(path, &work, ".txt");
    FILE *file = ok ? fopen(path, "r") : NULL;
    ok = file && fscanf(file, "%lf %lf", flip, &bias_pct) == 2;
    if (file)
        fclose(file);
    if (isatty(2))
        fprintf(stderr, "\r\033[K");
    if (ok)
        printf("%-14s FLIP %.3f, mean radiance %+.1f%%\n", entry->name, *flip, bias_pct);
    else
        fprintf(stderr, "gallery: %s was not made\n", entry->name);
    fflush(stdout);
    return ok;
}

static bool make_all(const struct options *options)
{
    double sum = 0, flip;
    int made = 0, failed = 0, left_out = 0;
    for (int i = 0; i < ENTRIES; i++) {
        bool needs_data = strstr(entries[i].scene, "gallery/") == NULL;
        if (options->only && strcmp(options->only, entries[i].name))
            continue;
        if (needs_data && !options->data) {
            printf("%-14s left out: it needs --data\n", entries[i].name);
            left_out++;
        } else if (make(options, &entries[i], &flip)) {
            sum += flip;
            made++;
        } else {
            failed++;
        }
    }
    if (failed || !made)
        return false;
    printf("mean of %d pictures of %u x %u, %u samples against %u paths a pixel and more, compared at "
           "%u pixels across\n",
           made, options->width, options->height, options->samples, options->paths,
           options->width > COMPARED_WIDTH ? options->width / (options->width / COMPARED_WIDTH)
                                           : options->width);
    printf("gallery-flip %.3f 1\n", sum / made);
    return true;
}

static bool read_options(struct options *options, int argc, char **argv)
{
    *options = (struct options){.width = 480, .height = 270, .samples = 4, .paths = 32};
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        bool known = true;
        if (argv[i][0] != '-') {
            options->directory = argv[i];
            continue;
        }
        if (!strcmp(argv[i], "--size"))
            known = sscanf(value, "%ux%u", &options->width, &options->height) == 2;
        else if (!strcmp(argv[i], "--samples"))
            known = sscanf(value, "%u", &options->samples) == 1;
        else if (!strcmp(argv[i], "--paths"))
            known = sscanf(value, "%u", &options->paths) == 1;
        else if (!strcmp(argv[i], "--data"))
            options->data = value;
        else if (!strcmp(argv[i], "--only"))
            options->only = value;
        else if (!strcmp(argv[i], "--gpu"))
            options->gpu = value;
        else
            known = false;
        if (!known || !*value) {
            fprintf(stderr, "gallery: cannot read %s %s\n", argv[i], value);
            return false;
        }
        i++;
    }
    if (!options->directory || options->width < 2 || options->height < 2)
        fprintf(stderr, "usage: gallery DIR [--size WxH] [--samples N] [--paths N] [--data DIR] "
                        "[--only NAME] [--gpu NAME]\n");
    if (options->directory && access(options->directory, W_OK) != 0) {
        fprintf(stderr, "gallery: %s is no directory that can be written to\n", options->directory);
        return false;
    }
    return options->directory && options->width >= 2 && options->height >= 2;
}

int main(int argc, char **argv)
{
    struct options options;
    if (!read_options(&options, argc, argv))
        return 2;
    return make_all(&options) ? 0 : 1;
}
