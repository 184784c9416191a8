/* How far reduced forms are from the full mesh: coverage, mean radiance and picture error.
 *
 * Rows of one species, tall enough for each height in pixels, are drawn by the renderer itself in
 * each form, with one light for all and cast shadows, from a low and a high viewpoint. The
 * reference is the full mesh, none of its leaves left out, with 64 samples a pixel; how bright that
 * is the path tracer says. Forms are drawn one sample a pixel, several times with the camera shifted
 * by parts of a pixel, so that the bias is not lost in noise. */
#include "lod.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bias.h"
#include "figures.h"

struct lod_bench {
    const struct lod_choice *choice;
    struct wd_renderer *renderer;
    struct bias_shown reference[BIAS_HEIGHTS][BIAS_VIEWS];
    struct lod_worst worst;
};

static void keep_worst(struct lod_case *worst, double found, const char *name)
{
    if (worst->name[0] && fabs(found) <= fabs(worst->pct))
        return;
    worst->pct = found;
    snprintf(worst->name, sizeof worst->name, "%s", name);
}

static void note(struct lod_bench *bench, const char *species, const char *form, int height,
                 int view, const struct bias *bias, bool used)
{
    char name[64];
    snprintf(name, sizeof name, "%-14s %-9s %4d px %3.0f deg", species, form,
             bias_height_px[height], bias_elevation_deg[view]);
    printf("%s  coverage %+6.1f%%  radiance %+6.1f%%  error %5.1f%%%s\n", name,
           bias->coverage_pct, bias->radiance_pct, bias->error_pct, used ? "  used" : "");
    fflush(stdout);
    keep_worst(&bench->worst.coverage, bias->coverage_pct, name);
    keep_worst(&bench->worst.radiance, bias->radiance_pct, name);
    if (used) {
        keep_worst(&bench->worst.used_coverage, bias->coverage_pct, name);
        keep_worst(&bench->worst.used_radiance, bias->radiance_pct, name);
    }
}

/* The reference is, of the heights that are measured. */
static bool is_measured(const struct lod_bench *bench, int form, int height)
{
    return (bench->choice->heights >> height & 1) &&
           (form == 0 || !bench->choice->used || bias_forms[form].used[height]);
}

/* The reference's radiance is the path tracer's. */
static bool measure_reference(struct lod_bench *bench, struct wd_forest *forest,
                              const struct bias_stand *stand)
{
    const struct wd_reference_params params = {0};
    struct wd_reference *tracer = NULL;
    bool ok = wd_reference_create(&tracer, forest, &params) == WD_OK;
    for (int i = 0; i < BIAS_HEIGHTS * BIAS_VIEWS && ok; i++) {
        int height = i / BIAS_VIEWS, view = i % BIAS_VIEWS;
        struct bias_shown *reference = &bench->reference[height][view];
        struct bias_shown traced;
        if (!is_measured(bench, 0, height))
            continue;
        ok = bias_show_reference(reference, bench->renderer, stand, height, view) &&
             bias_trace(&traced, tracer, stand, height, view);
        if (ok)
            reference->radiance = traced.radiance;
    }
    wd_reference_destroy(&tracer);
    return ok;
}

static bool measure_form(struct lod_bench *bench, const struct bias_stand *stand,
                         const char *species, int form)
{
    for (int i = 0; i < BIAS_HEIGHTS * BIAS_VIEWS; i++) {
        int height = i / BIAS_VIEWS, view = i % BIAS_VIEWS;
        struct bias bias;
        if (!is_measured(bench, form, height))
            continue;
        if (!bias_measure(&bias, bench->renderer, stand, height, view,
                          &bench->reference[height][view]))
            return false;
        note(bench, species, bias_forms[form].name, height, view, &bias,
             bias_forms[form].used[height]);
    }
    return true;
}

static bool run_form(struct lod_bench *bench, const struct bias_stand *stand, const char *species,
                     int form)
{
    struct wd_forest *forest = bias_forest(stand, &bias_forms[form]);
    bool ok = forest && wd_renderer_set_forest(bench->renderer, forest) == WD_OK &&
              (form == 0 ? measure_reference(bench, forest, stand)
                         : measure_form(bench, stand, species, form));
    wd_renderer_set_forest(bench->renderer, NULL);
    wd_forest_destroy(&forest);
    return ok;
}

static bool run_species(struct lod_bench *bench, const char *species)
{
    struct bias_stand stand;
    char path[300];
    snprintf(path, sizeof path, "species/%s.json", species);
    bool ok = bias_stand_init(&stand, path, bench->choice->clouds);
    stand.quick = bench->choice->quick;
    for (int form = 0; form < BIAS_FORMS && ok; form++)
        if (form == 0 || bench->choice->forms >> form & 1)
            ok = run_form(bench, &stand, species, form);
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

/* Every species in ./species. */
static bool run_all(struct lod_bench *bench)
{
    struct dirent **entries;
    int count = scandir("species", &entries, is_species, alphasort);
    bool ok = count > 0;
    if (!ok)
        fprintf(stderr, "bench: no species files in ./species\n");
    for (int i = 0; i < count; i++) {
        entries[i]->d_name[strlen(entries[i]->d_name) - strlen(".json")] = 0;
        ok = ok && run_species(bench, entries[i]->d_name);
        free(entries[i]);
    }
    free(count >= 0 ? entries : NULL);
    return ok;
}

bool lod_run(struct lod_worst *worst, const struct lod_choice *choice)
{
    const struct wd_renderer_params params = {.gpu = choice->gpu};
    struct lod_bench bench = {.choice = choice};
    bool ok = wd_renderer_create(&bench.renderer, &params) == WD_OK;
    if (ok && !choice->species[0])
        ok = run_all(&bench);
    for (const char *const *species = choice->species; ok && *species; species++)
        ok = run_species(&bench, *species);
    wd_renderer_destroy(&bench.renderer);
    *worst = bench.worst;
    return ok;
}

/* One of each kind: broad leaves, small ones, brushes of needles, feathers, fronds, blades. */
static const char *const kinds[] = {"oak", "birch", "pine", "spruce", "coconut", "grass", NULL};

static bool run_kinds(struct lod_worst *worst, const char *gpu)
{
    return lod_run(worst, &(struct lod_choice){gpu, kinds, ~0u, ~0u, true});
}

static bool print_figure(bool measured, const char *name, const struct lod_case *worst)
{
    if (measured)
        printf("worst: %s\n%s %.1f %%\n", worst->name, name, fabs(worst->pct));
    return measured;
}

bool bench_lod_coverage(const char *gpu)
{
    struct lod_worst worst;
    bool ok = run_kinds(&worst, gpu);
    return print_figure(ok, "lod-coverage-bias-pct", &worst.used_coverage);
}

bool bench_lod_radiance(const char *gpu)
{
    struct lod_worst worst;
    bool ok = run_kinds(&worst, gpu);
    return print_figure(ok, "lod-radiance-bias-pct", &worst.used_radiance);
}
