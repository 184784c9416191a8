/* How far reduced forms are from the full mesh: coverage, mean radiance and picture error.
 *
 * Rows of one species, tall enough for each height in pixels, are drawn by the renderer itself in
 * each form, with one light for all (no cast shadows), from a low and a high viewpoint. The
 * reference is the full mesh with 64 samples a pixel. Forms are drawn one sample a pixel, several
 * times with the camera shifted by parts of a pixel, so that the bias is not lost in noise. */
#include "figures.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bias.h"

struct lod_bench {
    struct wd_renderer *renderer;
    struct bias_shown reference[BIAS_HEIGHTS][BIAS_VIEWS];
    struct bias worst; /* of forms where they are used */
};

static void keep_worst(double *worst, double found)
{
    if (fabs(found) > fabs(*worst))
        *worst = found;
}

/* One species of each kind is measured at all heights, the others where two forms meet. */
static bool is_measured(const char *species, int height)
{
    static const char *const whole[] = {"oak", "beech", "pine", "spruce", "coconut"};
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        if (strcmp(whole[i], species) == 0)
            return true;
    return bias_height_px[height] == 128 || bias_height_px[height] == 32;
}

static bool measure_form(struct lod_bench *bench, const struct bias_stand *stand,
                         const char *species, int form)
{
    for (int height = 0; height < BIAS_HEIGHTS; height++)
        for (int view = 0; view < BIAS_VIEWS; view++) {
            struct bias_shown *reference = &bench->reference[height][view];
            struct bias bias;
            if (!is_measured(species, height))
                continue;
            if (form == 0) {
                if (!bias_show_reference(reference, bench->renderer, stand, height, view))
                    return false;
                continue;
            }
            if (!bias_measure(&bias, bench->renderer, stand, height, view, reference))
                return false;
            bool used = bias_forms[form].used[height];
            printf("%-14s %-8s %4d px %3.0f deg  coverage %+6.1f%%  radiance %+6.1f%%  "
                   "error %5.1f%%%s\n",
                   species, bias_forms[form].name, bias_height_px[height], bias_elevation_deg[view],
                   bias.coverage_pct, bias.radiance_pct, bias.error_pct, used ? "  used" : "");
            if (used) {
                keep_worst(&bench->worst.coverage_pct, bias.coverage_pct);
                keep_worst(&bench->worst.radiance_pct, bias.radiance_pct);
            }
        }
    return true;
}

static bool run_form(struct lod_bench *bench, const struct bias_stand *stand, const char *species,
                     int form)
{
    struct wd_forest *forest = bias_forest(stand, &bias_forms[form]);
    bool ok = forest && wd_renderer_set_forest(bench->renderer, forest) == WD_OK &&
              measure_form(bench, stand, species, form);
    wd_renderer_set_forest(bench->renderer, NULL);
    wd_forest_destroy(&forest);
    return ok;
}

/* The name of a species' file without its ending. */
static void name_of(char name[64], const char *path)
{
    const char *slash = strrchr(path, '/');
    snprintf(name, 64, "%.63s", slash ? slash + 1 : path);
    name[strcspn(name, ".")] = 0;
}

static bool run_species(struct lod_bench *bench, const char *path)
{
    struct bias_stand stand;
    char name[64];
    name_of(name, path);
    bool ok = bias_stand_init(&stand, path);
    for (int form = 0; form < BIAS_FORMS && ok; form++)
        ok = run_form(bench, &stand, name, form);
    fflush(stdout);
    for (int i = 0; i < BIAS_HEIGHTS * BIAS_VIEWS; i++) {
        free(bench->reference[i / BIAS_VIEWS][i % BIAS_VIEWS].luminance);
        bench->reference[i / BIAS_VIEWS][i % BIAS_VIEWS] = (struct bias_shown){0};
    }
    if (stand.folder[0])
        bias_stand_finish(&stand);
    return ok;
}

static int is_species(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot && strcmp(dot, ".json") == 0;
}

static bool run(struct bias *worst, const char *gpu)
{
    const struct wd_renderer_params params = {.gpu = gpu};
    struct lod_bench bench = {0};
    struct dirent **entries;
    int count = scandir("species", &entries, is_species, alphasort);
    if (count <= 0) {
        fprintf(stderr, "bench: no species files in ./species\n");
        return false;
    }
    bool ok = wd_renderer_create(&bench.renderer, &params) == WD_OK;
    for (int i = 0; i < count; i++) {
        char path[300];
        snprintf(path, sizeof path, "species/%s", entries[i]->d_name);
        fprintf(stderr, "%d of %d: %s\n", i + 1, count, path);
        ok = ok && run_species(&bench, path);
        free(entries[i]);
    }
    free(entries);
    wd_renderer_destroy(&bench.renderer);
    *worst = bench.worst;
    return ok;
}

bool bench_lod_coverage(const char *gpu)
{
    struct bias worst;
    bool ok = run(&worst, gpu);
    if (ok)
        printf("lod-coverage-bias-pct %.1f %%\n", fabs(worst.coverage_pct));
    return ok;
}

bool bench_lod_radiance(const char *gpu)
{
    struct bias worst;
    bool ok = run(&worst, gpu);
    if (ok)
        printf("lod-radiance-bias-pct %.1f %%\n", fabs(worst.radiance_pct));
    return ok;
}
