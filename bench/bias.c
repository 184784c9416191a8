#include "bias.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "scene/species.h"

enum { MAX_TREES = 256, EYE_HEIGHTS = 120 /* away */ };
/* The ground is a strip about the row, in spacings: a square as long as the row has so large cells of canopy that
 * each tree would stand in a wood. */
enum { GROUND_LONG = MAX_TREES + 16, GROUND_WIDE = 32 };
/* Beyond 0.7 of the distance of shadows the canopy's mean begins to stand for them. */
static const double SHADOWS_OVER_EYE = 1.45;

#define MESHES "quality.mesh_distance_m=1000000", "quality.reduced_distance_m=1000000"
#define REDUCED "quality.mesh_distance_m=0", "quality.reduced_distance_m=1000000"
#define NO_MESHES "quality.mesh_distance_m=0", "quality.reduced_distance_m=0"
const struct bias_form bias_forms[BIAS_FORMS] = {
    {"reference", {"method=octree", MESHES, "quality.leaf_px=0"}, {false, false, false, false}},
    {"full", {"method=octree", MESHES}, {true, false, false, false}},
    {"reduced", {"method=octree", REDUCED}, {false, true, false, false}},
    {"cards", {"method=octree", NO_MESHES}, {false, false, true, true}},
    {"billboard", {"method=dissolve", "methods.dissolve.billboard_m=0", "methods.dissolve.overlap_m=0.01"},
     {false, false, true, true}},
    {"views", {"method=views", "methods.views.near_m=0", "methods.views.variants=0"},
     {false, true, true, true}},
    {"zfield", {"method=zfield", "methods.zfield.near_m=0", "methods.zfield.range_m=1000000",
                "methods.zfield.variants=0"}, {false, true, true, true}},
    {"octants", {"method=impostor", "methods.impostor.area_px=250",
                 "methods.impostor.cluster_size=1", "methods.octree.leaf_trees=1", NO_MESHES}, {false, false, false, true}},
    {"splats", {"method=continuum", "methods.continuum.near_px=0", NO_MESHES}, {false, true, true, true}},
};
const int bias_height_px[BIAS_HEIGHTS] = {512, 128, 32, 8};
static const int tree_counts[BIAS_HEIGHTS] = {1, 4, 24, 64}; /* in a picture */
/* Pictures of a form go on from one stretch of the row to the next: what a form leaves to chance is
 * drawn by each tree's own lot. */
static const int stretches[BIAS_HEIGHTS] = {1, 2, 2, 4};
/* 64 samples a pixel of the reference: squares of pictures that are so many times as fine. */
static const int reference_zoom[BIAS_HEIGHTS] = {4, 8, 8, 8};
/* Path-traced with one path through the middle of each pixel, so that few leave noise. */
static const int traced_zoom[BIAS_HEIGHTS] = {2, 4, 8, 16};
enum { QUICKER = 2 }; /* so much less fine are both where that is enough */
static const int reference_shifts[BIAS_HEIGHTS] = {2, 1, 1, 1};
static const int shifts[BIAS_HEIGHTS] = {1, 2, 4, 4}; /* squared: pictures a form */
/* What small trees leave to chance is drawn anew in each sample of a picture, while the first samples of
 * any two pictures draw the same lots: cover is the mean of so many. */
static const uint32_t cover_samples[BIAS_HEIGHTS] = {1, 1, 16, 64};
const double bias_elevation_deg[BIAS_VIEWS] = {4, 40};

static bool write_scene(struct bias_stand *stand, const char *species, bool clouds)
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
    double long_m = GROUND_LONG * stand->spacing_m, wide_m = GROUND_WIDE * stand->spacing_m;
    if (ok) {
        fprintf(trees, "x_m,y_m,species,height_m\n");
        for (int i = 0; i < MAX_TREES; i++)
            fprintf(trees, "%.2f,%.2f,tree,%.2f\n",
                    0.5 * long_m + (i - 0.5 * (MAX_TREES - 1)) * stand->spacing_m, 0.5 * wide_m,
                    stand->height_m);
        fprintf(scene, "{\"name\": \"lod\", \"variants\": 2,\n"
                       "\"terrain\": {\"kind\": \"flat\", \"size_m\": [%g, %g], \"cell_m\": 100},\n"
                       "\"species\": {\"tree\": \"%s/%s\"},\n"
                       "\"inventories\": [{\"file\": \"trees.csv\", \"frame\": \"local\"}],\n"
                       "\"sun\": {\"azimuth_deg\": 215, \"elevation_deg\": 40},\n"
                       "\"sky\": {\"cover\": %d}, \"wind\": {\"speed_mps\": 0}, \"fog\": {\"visibility_m\": 10000000},\n"
                       "\"quality\": {\"shadow_distance_m\": %g}}\n",
                long_m, wide_m, root, species, clouds, SHADOWS_OVER_EYE * EYE_HEIGHTS * stand->height_m);
    }
    ok = (!trees || fclose(trees) == 0) && (!scene || fclose(scene) == 0) && ok;
    if (!ok)
        fprintf(stderr, "bench: %s cannot be written\n", stand->folder);
    return ok;
}

void bias_stand_finish(struct bias_stand *stand)
{
    char path[80];
    snprintf(path, sizeof path, "%s/trees.csv", stand->folder);
    unlink(path);
    unlink(stand->scene);
    rmdir(stand->folder);
}

/* The camera that shows trees near the row's middle `height_px` tall, shifted by parts of one of its
 * pixels; far away, so that all are seen alike. */
static struct wd_render_params view_of(const struct bias_stand *stand, int height, int view,
                                       int zoom, int stretch, double shift_x, double shift_y)
{
    const double pi = 3.14159265358979323846;
    double pixels_per_m = zoom * bias_height_px[height] / stand->height_m;
    double elevation = bias_elevation_deg[view] * pi / 180, distance = EYE_HEIGHTS * stand->height_m;
    double stretch_m = tree_counts[height] * stand->spacing_m;
    double wide = stretch_m - stand->spacing_m + stand->width_m;
    double tall = 1.15 * (stand->height_m * cos(elevation) + stand->width_m * sin(elevation));
    struct wd_render_params params = {.samples = 1, .layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID};
    params.width = (uint32_t)ceil(wide * pixels_per_m / zoom) * (uint32_t)zoom;
    params.height = (uint32_t)ceil(tall * pixels_per_m / zoom) * (uint32_t)zoom;
    double between = tree_counts[height] * stretches[height] % 2 ? 0.5 : 0; /* trees at the middle */
    double middle = (0.5 * GROUND_LONG + between) * stand->spacing_m +
                    (stretch - 0.5 * (stretches[height] - 1)) * stretch_m;
    double x = shift_x / pixels_per_m;
    double y = shift_y / pixels_per_m;
    params.camera = (struct wd_camera){
        .position_m = {middle + x, 0.5 * GROUND_WIDE * stand->spacing_m - distance * cos(elevation) - y * sin(elevation),
                       0.5 * stand->height_m + distance * sin(elevation) + y * cos(elevation)},
        .pitch_rad = -elevation,
        .fov_rad = 2 * atan(0.5 * params.height / pixels_per_m / distance),
    };
    return params;
}

/* Takes what the picture holds, which is finished. */
static void keep_shown(struct bias_shown *shown, struct wd_picture *picture)
{
    size_t pixels = (size_t)picture->width * picture->height;
    *shown = (struct bias_shown){.width = picture->width, .height = picture->height,
                            .luminance = wd_alloc_array(pixels, sizeof(float))};
    for (size_t i = 0; i < pixels; i++) {
        if (!picture->tree_id[i])
            continue;
        const float *c = picture->color + 3 * i;
        shown->luminance[i] = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
        shown->covered += 1;
        shown->radiance += (double)shown->luminance[i];
    }
    shown->radiance /= shown->covered > 0 ? shown->covered : 1;
    wd_picture_finish(picture);
}

static int zoom_of(const struct bias_stand *stand, const int zooms[BIAS_HEIGHTS], int height)
{
    return stand->quick ? zooms[height] / QUICKER : zooms[height];
}

static bool show(struct bias_shown *shown, struct wd_renderer *renderer,
                 const struct wd_render_params *params)
{
    struct wd_picture picture;
    if (wd_renderer_render(renderer, params, &picture) != WD_OK)
        return false;
    keep_shown(shown, &picture);
    return true;
}

static bool trace(struct bias_shown *shown, struct wd_reference *tracer,
                  const struct wd_render_params *params)
{
    const struct wd_reference_picture_params picture_params = {.camera = params->camera,
                                                               .width = params->width,
                                                               .height = params->height,
                                                               .samples = 1,
                                                               .layers = params->layers,
                                                               .places = WD_REFERENCE_MIDDLES};
    struct wd_picture picture;
    if (wd_reference_render(tracer, &picture_params, &picture) != WD_OK)
        return false;
    keep_shown(shown, &picture);
    return true;
}

bool bias_trace(struct bias_shown *sum, struct wd_reference *tracer, const struct bias_stand *stand,
                int height, int view)
{
    int zoom = zoom_of(stand, traced_zoom, height);
    *sum = (struct bias_shown){0};
    for (int i = 0; i < stretches[height]; i++) {
        struct bias_shown part;
        struct wd_render_params params = view_of(stand, height, view, zoom, i, 0, 0);
        if (!trace(&part, tracer, &params))
            return false;
        sum->radiance += part.radiance * part.covered;
        sum->covered += part.covered;
        free(part.luminance);
    }
    sum->radiance /= fmax(sum->covered, 1);
    sum->covered /= zoom * zoom * stretches[height];
    return true;
}

/* `pictures`: how many make the one that is kept; 0: this is not of it. */
static void add_reference(struct bias_shown *sum, struct bias_shown *part, int zoom, int pictures)
{
    size_t z = (size_t)zoom;
    float share = 1.0f / (float)(zoom * zoom * (pictures ? pictures : 1));
    sum->width = part->width / (uint32_t)zoom;
    sum->height = part->height / (uint32_t)zoom;
    if (!sum->luminance)
        sum->luminance = wd_alloc_array((size_t)sum->width * sum->height, sizeof(float));
    for (size_t y = 0; y < part->height && pictures; y++)
        for (size_t x = 0; x < part->width; x++)
            sum->luminance[y / z * sum->width + x / z] +=
                part->luminance[y * part->width + x] * share;
    sum->radiance += part->radiance * part->covered;
    sum->covered += part->covered;
    free(part->luminance);
}

bool bias_show_reference(struct bias_shown *sum, struct wd_renderer *renderer,
                         const struct bias_stand *stand, int height, int view)
{
    int side = reference_shifts[height], count = side * side, zoom = zoom_of(stand, reference_zoom, height);
    *sum = (struct bias_shown){0};
    for (int i = 0; i < count * stretches[height]; i++) {
        struct bias_shown part;
        double x = (i % side + 0.5) / side - 0.5, y = (i / side % side + 0.5) / side - 0.5;
        struct wd_render_params params = view_of(stand, height, view, zoom, i / count, x, y);
        if (!show(&part, renderer, &params))
            return false;
        add_reference(sum, &part, zoom, i < count ? count : 0);
    }
    sum->radiance /= sum->covered > 0 ? sum->covered : 1;
    sum->covered /= zoom * zoom * count * stretches[height];
    return true;
}

/* Root mean square of what one picture differs by, over the mean radiance of trees. */
static double picture_error(const struct bias_shown *form, const struct bias_shown *reference)
{
    double sum = 0, pixels = 0;
    for (size_t i = 0; i < (size_t)form->width * form->height; i++) {
        double difference = (double)(form->luminance[i] - reference->luminance[i]);
        sum += difference * difference;
        pixels += form->luminance[i] > 0 || reference->luminance[i] > 0;
    }
    return sqrt(sum / fmax(pixels, 1)) / fmax(reference->radiance, 1e-12);
}

/* Pixels that trees cover of a picture: the mean over its samples. */
static bool show_cover(double *covered, struct wd_renderer *renderer,
                       const struct wd_render_params *params)
{
    struct wd_picture picture;
    if (wd_renderer_render(renderer, params, &picture) != WD_OK)
        return false;
    for (size_t i = 0; i < (size_t)WD_RANKS * picture.width * picture.height; i++)
        *covered += (double)picture.rank_share[i] * (picture.rank_tree[i] > 0);
    wd_picture_finish(&picture);
    return true;
}

/* Mean of all stretches, each of many samples. */
static bool measure_cover(double *covered, struct wd_renderer *renderer,
                          const struct bias_stand *stand, int height, int view)
{
    *covered = 0;
    for (int i = 0; i < stretches[height]; i++) {
        struct wd_render_params params = view_of(stand, height, view, 1, i, 0, 0);
        params.samples = cover_samples[height];
        params.layers = WD_LAYER_CRYPTOMATTE;
        if (!show_cover(covered, renderer, &params))
            return false;
    }
    *covered /= stretches[height];
    return true;
}

bool bias_measure(struct bias *bias, struct wd_renderer *renderer, const struct bias_stand *stand,
                    int height, int view, const struct bias_shown *reference)
{
    double covered = 0, radiance = 0, error = 0;
    int side = shifts[height], count = side * side;
    for (int i = 0; i < count; i++) {
        struct bias_shown shown;
        struct wd_render_params params =
            view_of(stand, height, view, 1, i % stretches[height], (double)(i % side) / side,
                    (double)(i / side) / side);
        if (!show(&shown, renderer, &params))
            return false;
        if (i == 0 && reference->luminance)
            error = picture_error(&shown, reference);
        covered += shown.covered;
        radiance += shown.covered * shown.radiance;
        free(shown.luminance);
    }
    radiance /= covered > 0 ? covered : 1;
    covered /= count;
    if (cover_samples[height] > 1 && !measure_cover(&covered, renderer, stand, height, view))
        return false;
    bias->coverage_pct = 100 * (covered / reference->covered - 1);
    bias->radiance_pct = 100 * (radiance / reference->radiance - 1);
    bias->error_pct = 100 * error;
    return true;
}

bool bias_stand_init(struct bias_stand *stand, const char *path, bool clouds)
{
    struct wd_arena arena = {0};
    struct wd_species species;
    *stand = (struct bias_stand){0};
    if (!wd_species_load(&species, path, &arena, NULL))
        return false;
    double height_m = 0.8 * (double)species.typical_height_m;
    double reach_m = 1.5 * wd_species_crown_of_height_m(&species, height_m); /* boughs lean out */
    stand->height_m = height_m;
    stand->width_m = fmin(reach_m + 0.15 * height_m, 1.6 * height_m);
    stand->spacing_m = fmin(reach_m + 0.4 * height_m, 1.6 * height_m);
    wd_arena_finish(&arena);
    return write_scene(stand, path, clouds);
}

struct wd_forest *bias_forest(const struct bias_stand *stand, const struct bias_form *form)
{
    const struct wd_forest_params params = {.scene_path = stand->scene,
                                            .settings = form->settings};
    struct wd_forest *forest = NULL;
    return wd_forest_create(&forest, &params) == WD_OK ? forest : NULL;
}
