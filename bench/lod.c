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
#include <unistd.h>

#include "base/memory.h"
#include "scene/species.h"

enum { FORMS = 4, HEIGHTS = 4, VIEWS = 2, MAX_TREES = 64, REFERENCE_ZOOM = 4 };

static const struct form {
    const char *name;
    const char *method, *mesh_m, *reduced_m;
    bool used[HEIGHTS]; /* drawn there by default; FORM_FULL is the reference */
} forms[FORMS] = {
    {"full", "method=octree", "quality.mesh_distance_m=1000000",
     "quality.reduced_distance_m=1000000", {false, false, false, false}},
    {"reduced", "method=octree", "quality.mesh_distance_m=0",
     "quality.reduced_distance_m=1000000", {false, true, false, false}},
    {"cards", "method=octree", "quality.mesh_distance_m=0", "quality.reduced_distance_m=0",
     {false, false, true, true}},
    {"splats", "method=continuum", "quality.mesh_distance_m=0", "quality.reduced_distance_m=0",
     {false, true, true, true}},
};
static const int height_px[HEIGHTS] = {512, 128, 32, 8};
static const int tree_counts[HEIGHTS] = {1, 4, 16, MAX_TREES};
static const int shifts[HEIGHTS] = {1, 2, 4, 4}; /* squared: pictures a form */
static const double elevation_deg[VIEWS] = {4, 40};

struct stand {
    char folder[32], scene[64];
    double height_m, spacing_m;
};

/* What trees show in a picture: pixels and radiance. */
struct shown {
    double covered; /* pixels of the form's own size */
    double radiance; /* mean of covered pixels, luminance */
    float *luminance; /* a pixel, 0 where no tree is */
    uint32_t width, height;
};

struct bias {
    double coverage_pct, radiance_pct, error_pct;
};

static bool write_scene(struct stand *stand, const char *species)
{
    char path[80], root[1024];
    snprintf(stand->folder, sizeof stand->folder, "/tmp/weald-lod-XXXXXX");
    if (!getcwd(root, sizeof root) || !mkdtemp(stand->folder)) {
        fprintf(stderr, "bench: no temporary directory can be made in /tmp\n");
        return false;
    }
    snprintf(path, sizeof path, "%s/trees.csv", stand->folder);
    snprintf(stand->scene, sizeof stand->scene, "%s/scene.json", stand->folder);
    FILE *trees = fopen(path, "w"), *scene = fopen(stand->scene, "w");
    bool ok = trees && scene;
    double side = 2 * MAX_TREES * stand->spacing_m;
    if (ok) {
        fprintf(trees, "x_m,y_m,species,height_m\n");
        for (int i = 0; i < MAX_TREES; i++)
            fprintf(trees, "%.2f,%.2f,tree,%.2f\n",
                    0.5 * side + (i - 0.5 * (MAX_TREES - 1)) * stand->spacing_m, 0.5 * side,
                    stand->height_m);
        fprintf(scene, "{\"name\": \"lod\", \"variants\": 2,\n"
                       "\"terrain\": {\"kind\": \"flat\", \"size_m\": [%g, %g], \"cell_m\": 100},\n"
                       "\"species\": {\"tree\": \"%s/%s\"},\n"
                       "\"inventories\": [{\"file\": \"trees.csv\", \"frame\": \"local\"}],\n"
                       "\"sun\": {\"azimuth_deg\": 215, \"elevation_deg\": 40},\n"
                       "\"wind\": {\"speed_mps\": 0}, \"fog\": {\"visibility_m\": 10000000},\n"
                       "\"quality\": {\"shadow_distance_m\": 1, \"shadow_size\": 16}}\n",
                side, side, root, species);
    }
    ok = (!trees || fclose(trees) == 0) && (!scene || fclose(scene) == 0) && ok;
    if (!ok)
        fprintf(stderr, "bench: %s cannot be written\n", stand->folder);
    return ok;
}

static void remove_scene(const struct stand *stand)
{
    char path[80];
    snprintf(path, sizeof path, "%s/trees.csv", stand->folder);
    unlink(path);
    unlink(stand->scene);
    rmdir(stand->folder);
}

/* The camera that shows the middle trees of the row `height_px` tall, shifted by parts of one of
 * its pixels; far away, so that all are seen alike. */
static struct wd_render_params view_of(const struct stand *stand, int height, int view, int zoom,
                                       double shift_x, double shift_y)
{
    const double pi = 3.14159265358979323846;
    double pixels_per_m = zoom * height_px[height] / stand->height_m;
    double elevation = elevation_deg[view] * pi / 180, distance = 120 * stand->height_m;
    double wide = tree_counts[height] * stand->spacing_m;
    double tall = 1.15 * (stand->height_m * cos(elevation) + stand->spacing_m * sin(elevation));
    struct wd_render_params params = {.samples = 1, .layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID};
    params.width = (uint32_t)ceil(wide * pixels_per_m / zoom) * (uint32_t)zoom;
    params.height = (uint32_t)ceil(tall * pixels_per_m / zoom) * (uint32_t)zoom;
    double middle = MAX_TREES * stand->spacing_m, x = shift_x / pixels_per_m;
    double y = shift_y / pixels_per_m;
    params.camera = (struct wd_camera){
        .position_m = {middle + x, middle - distance * cos(elevation) - y * sin(elevation),
                       0.5 * stand->height_m + distance * sin(elevation) + y * cos(elevation)},
        .pitch_rad = -elevation,
        .fov_rad = 2 * atan(0.5 * params.height / pixels_per_m / distance),
    };
    return params;
}

static bool show(struct shown *shown, struct wd_renderer *renderer,
                 const struct wd_render_params *params)
{
    struct wd_picture picture;
    if (wd_renderer_render(renderer, params, &picture) != WD_OK)
        return false;
    size_t pixels = (size_t)params->width * params->height;
    *shown = (struct shown){.width = params->width, .height = params->height,
                            .luminance = wd_alloc_array(pixels, sizeof(float))};
    for (size_t i = 0; i < pixels; i++) {
        if (!picture.tree_id[i])
            continue;
        const float *c = picture.color + 3 * i;
        shown->luminance[i] = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
        shown->covered += 1;
        shown->radiance += (double)shown->luminance[i];
    }
    shown->radiance /= shown->covered > 0 ? shown->covered : 1;
    wd_picture_finish(&picture);
    return true;
}

static void add_reference(struct shown *sum, struct shown *part)
{
    enum { Z = REFERENCE_ZOOM };
    sum->width = part->width / Z;
    sum->height = part->height / Z;
    if (!sum->luminance)
        sum->luminance = wd_alloc_array((size_t)sum->width * sum->height, sizeof(float));
    for (size_t y = 0; y < part->height; y++)
        for (size_t x = 0; x < part->width; x++)
            sum->luminance[y / Z * sum->width + x / Z] +=
                part->luminance[y * part->width + x] / (4 * Z * Z);
    sum->radiance += part->radiance * part->covered;
    sum->covered += part->covered;
    free(part->luminance);
}

/* 64 samples a pixel: four pictures, four times as fine. */
static bool show_reference(struct shown *sum, struct wd_renderer *renderer,
                           const struct stand *stand, int height, int view)
{
    *sum = (struct shown){0};
    for (int i = 0; i < 4; i++) {
        struct shown part;
        struct wd_render_params params = view_of(stand, height, view, REFERENCE_ZOOM,
                                                 0.5 * (i % 2) - 0.25, 0.5 * (i / 2) - 0.25);
        if (!show(&part, renderer, &params))
            return false;
        add_reference(sum, &part);
    }
    sum->radiance /= sum->covered > 0 ? sum->covered : 1;
    sum->covered /= 4 * REFERENCE_ZOOM * REFERENCE_ZOOM;
    return true;
}

/* Root mean square of what one picture differs by, over the mean radiance of trees. */
static double picture_error(const struct shown *form, const struct shown *reference)
{
    double sum = 0, pixels = 0;
    for (size_t i = 0; i < (size_t)form->width * form->height; i++) {
        double difference = (double)(form->luminance[i] - reference->luminance[i]);
        sum += difference * difference;
        pixels += form->luminance[i] > 0 || reference->luminance[i] > 0;
    }
    return sqrt(sum / fmax(pixels, 1)) / fmax(reference->radiance, 1e-12);
}

static bool measure(struct bias *bias, struct wd_renderer *renderer, const struct stand *stand,
                    int height, int view, const struct shown *reference)
{
    double covered = 0, radiance = 0, error = 0;
    int side = shifts[height], count = side * side;
    for (int i = 0; i < count; i++) {
        struct shown shown;
        struct wd_render_params params =
            view_of(stand, height, view, 1, (double)(i % side) / side, (double)(i / side) / side);
        if (!show(&shown, renderer, &params))
            return false;
        if (i == 0)
            error = picture_error(&shown, reference);
        covered += shown.covered;
        radiance += shown.covered * shown.radiance;
        free(shown.luminance);
    }
    radiance /= covered > 0 ? covered : 1;
    bias->coverage_pct = 100 * (covered / count / reference->covered - 1);
    bias->radiance_pct = 100 * (radiance / reference->radiance - 1);
    bias->error_pct = 100 * error;
    return true;
}

struct lod_bench {
    struct wd_renderer *renderer;
    struct shown reference[HEIGHTS][VIEWS];
    struct bias worst; /* of forms where they are used */
};

static void keep_worst(double *worst, double found)
{
    if (fabs(found) > fabs(*worst))
        *worst = found;
}

static bool measure_form(struct lod_bench *bench, const struct stand *stand, const char *species,
                         int form)
{
    for (int height = 0; height < HEIGHTS; height++)
        for (int view = 0; view < VIEWS; view++) {
            struct shown *reference = &bench->reference[height][view];
            struct bias bias;
            if (form == 0) {
                if (!show_reference(reference, bench->renderer, stand, height, view))
                    return false;
                continue;
            }
            if (!measure(&bias, bench->renderer, stand, height, view, reference))
                return false;
            bool used = forms[form].used[height];
            printf("%-14s %-8s %4d px %3.0f deg  coverage %+6.1f%%  radiance %+6.1f%%  "
                   "error %5.1f%%%s\n",
                   species, forms[form].name, height_px[height], elevation_deg[view],
                   bias.coverage_pct, bias.radiance_pct, bias.error_pct, used ? "  used" : "");
            if (used) {
                keep_worst(&bench->worst.coverage_pct, bias.coverage_pct);
                keep_worst(&bench->worst.radiance_pct, bias.radiance_pct);
            }
        }
    return true;
}

static bool run_form(struct lod_bench *bench, const struct stand *stand, const char *species,
                     int form)
{
    const char *const settings[] = {forms[form].method, forms[form].mesh_m, forms[form].reduced_m,
                                    NULL};
    const struct wd_forest_params params = {.scene_path = stand->scene, .settings = settings};
    struct wd_forest *forest;
    bool ok = wd_forest_create(&forest, &params) == WD_OK &&
              wd_renderer_set_forest(bench->renderer, forest) == WD_OK &&
              measure_form(bench, stand, species, form);
    wd_renderer_set_forest(bench->renderer, NULL);
    wd_forest_destroy(&forest);
    return ok;
}

static bool run_species(struct lod_bench *bench, const char *path)
{
    struct wd_arena arena = {0};
    struct wd_species species;
    struct stand stand;
    if (!wd_species_load(&species, path, &arena, NULL))
        return false;
    stand.height_m = 0.8 * (double)species.typical_height_m;
    stand.spacing_m = 1.6 * stand.height_m;
    bool ok = write_scene(&stand, path);
    for (int form = 0; form < FORMS && ok; form++)
        ok = run_form(bench, &stand, species.name, form);
    fflush(stdout);
    for (int i = 0; i < HEIGHTS * VIEWS; i++) {
        free(bench->reference[i / VIEWS][i % VIEWS].luminance);
        bench->reference[i / VIEWS][i % VIEWS] = (struct shown){0};
    }
    remove_scene(&stand);
    wd_arena_finish(&arena);
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
