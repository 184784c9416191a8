/* A forest of specimens: the same renderer as for any scene, on ground that draws no attention. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/arguments.h"
#include "api/forest.h"
#include "api/specimen.h"
#include "base/memory.h"

enum { GROUND_M = 4000 };

static const char scene_text[] =
    "{\"name\": \"specimens\", \"variants\": 1, \"method\": \"octree\","
    " \"terrain\": {\"kind\": \"flat\", \"size_m\": [4000, 4000]},"
    " \"sun\": {\"azimuth_deg\": 228, \"elevation_deg\": 42}, \"wind\": {\"speed_mps\": 0},"
    " \"fog\": {\"visibility_m\": 60000},"
    " \"ground\": {\"grass\": [0.105, 0.12, 0.075], \"soil\": [0.125, 0.13, 0.09],"
    " \"litter\": [0.11, 0.118, 0.08], \"rock\": [0.15, 0.15, 0.14]},"
    " \"quality\": {\"samples\": 16, \"shadow_size\": 2048, \"shadow_taps\": 9,"
    " \"exposure_ev\": 0.6}}";

/* --- cameras ----------------------------------------------------------------------------- */

struct row {
    double left_m, right_m, height_m, depth_m;
    double leafy_m; /* above the ground: the lowest crown of leaves */
};

static struct row measure(const struct wd_specimen *const *specimens, uint32_t count)
{
    struct row row = {.leafy_m = 1e9};
    for (uint32_t i = 0; i < count; i++) {
        const struct wd_tree_mesh *mesh = &specimens[i]->model.full;
        double at = wd_specimen_place_m(specimens, i);
        row.left_m = fmin(row.left_m, at + (double)mesh->min_m[0]);
        row.right_m = fmax(row.right_m, at + (double)mesh->max_m[0]);
        row.height_m = fmax(row.height_m, (double)mesh->max_m[2]);
        row.depth_m = fmax(row.depth_m, -(double)mesh->min_m[1]);
        if (specimens[i]->model.leaf_area_m2 > 0)
            row.leafy_m = fmin(row.leafy_m, (double)specimens[i]->model.crown_base_m);
    }
    return row;
}

static void place_camera(struct wd_scene_camera *camera, const char *name, const struct row *row,
                         double distance_m, double eye_m, double target_m, double fov_deg,
                         struct wd_arena *arena)
{
    double middle = 0.5 * GROUND_M + 0.5 * (row->left_m + row->right_m);
    *camera = (struct wd_scene_camera){
        .name = name,
        .frame = "local",
        .position_m = {middle, 0.5 * GROUND_M - distance_m, eye_m},
        .look_at_m = wd_arena_alloc(arena, 3 * sizeof(double)),
        .look_at_count = 3,
        .fov_deg = fov_deg,
    };
    camera->look_at_m[0] = middle;
    camera->look_at_m[1] = 0.5 * GROUND_M;
    camera->look_at_m[2] = target_m;
}

/* "fit" stands off far enough for the nearest leaves, at two fifths of the height and level, so
 * that the stem stays upright; "eye" looks up only as far as a head would. */
static double make_cameras(struct wd_scene *scene, const struct row *row, double aspect,
                           double distance_m)
{
    const double fov_deg = 30, margin = 1.07, slope = tan(0.5 * fov_deg * (3.14159265358979 / 180));
    double half_width = 0.5 * (row->right_m - row->left_m), half_height = 0.5 * row->height_m;
    double fit = margin * fmax(half_height / slope, half_width / (slope * aspect)) + row->depth_m;
    double eye = fmin(1.65, 0.6 * row->height_m), near = distance_m > 0 ? distance_m : fit;
    scene->cameras = wd_arena_alloc(&scene->arena, 2 * sizeof *scene->cameras);
    scene->camera_count = 2;
    place_camera(&scene->cameras[0], "fit", row, fit, half_height, half_height, fov_deg,
                 &scene->arena);
    place_camera(&scene->cameras[1], "eye", row, near, eye,
                 fmin(half_height, eye + 0.4 * near), 50, &scene->arena);
    /* the meter takes a picture filled with leaves for a dim day */
    double leafy = fmax(1 - row->leafy_m / (eye + 0.8 * near), 0);
    scene->quality.exposure_ev -= 1.1 * leafy * fmax(1 - 2 * near / fit, 0);
    return fmax(fit, near);
}

/* Distances of quality.* are for trees of 20 m and shrink with the height; a low plant is looked at
 * from within twelve metres, or not at all. */
static void hold_low_plants(struct wd_scene *scene, const struct row *row)
{
    const double whole_m = 12;
    scene->quality.mesh_distance_m =
        fmax(scene->quality.mesh_distance_m, whole_m * 20 / fmax(row->height_m, 0.1));
}

/* --- the forest -------------------------------------------------------------------------- */

static bool make_scene(struct wd_scene *scene, const struct wd_specimen *const *specimens,
                       uint32_t count, const struct wd_log *log)
{
    struct wd_arena arena = {0};
    const struct wd_scene_params params = {.planted = true};
    const struct wd_keys_input input = {.path = "specimens", .text = scene_text,
                                        .size = sizeof scene_text - 1, .user = &params};
    if (!wd_keys_read_input(&wd_scene_keys, &input, &arena, log, scene)) {
        wd_arena_finish(&arena);
        return false;
    }
    scene->arena = arena;
    struct wd_grow_params *individuals =
        wd_arena_alloc(&scene->arena, count * sizeof *individuals);
    scene->species_files = wd_arena_alloc(&scene->arena, count * sizeof *scene->species_files);
    scene->species = wd_arena_alloc(&scene->arena, count * sizeof *scene->species);
    scene->species_file_count = count;
    for (uint32_t i = 0; i < count; i++) {
        scene->species_files[i].name = specimens[i]->species.name;
        scene->species_files[i].value = specimens[i]->source;
        scene->species[i] = specimens[i]->species;
        individuals[i] = specimens[i]->params;
    }
    scene->individuals = individuals;
    return true;
}

static uint32_t whole_cm(double metres, uint32_t most)
{
    double cm = round(metres * 100);
    return cm < 1 ? 1 : cm > most ? most : (uint32_t)cm;
}

static struct wd_tree *make_trees(const struct wd_specimen *const *specimens, uint32_t count)
{
    struct wd_tree *trees = wd_alloc_array(count, sizeof *trees);
    for (uint32_t i = 0; i < count; i++) {
        const struct wd_tree_model *model = &specimens[i]->model;
        double x_m = 0.5 * GROUND_M + wd_specimen_place_m(specimens, i);
        trees[i] = (struct wd_tree){
            .x_mm = (int32_t)lround(x_m * 1000),
            .y_mm = GROUND_M / 2 * 1000,
            .kind = i,
            .size = whole_cm((double)model->height_m, WD_TREE_HEIGHT_MOST_CM) |
                    whole_cm(fmax(2 * (double)model->crown_radius_m, 0.1),
                             WD_TREE_CROWN_MOST_CM) << 16,
            .look = WD_TREE_LOOK(0u, 128u, 0u),
        };
    }
    return trees;
}

static bool check_view(double aspect, double distance_m, const struct wd_log *log)
{
    const double most_aspect = WD_MOST_SIZE_PX, most_m = 1e6;
    if (!(aspect >= 1 / most_aspect && aspect <= most_aspect))
        return wd_error(log, "aspect is %g: 1/%g to %g, as of pictures, is possible", aspect,
                        most_aspect, most_aspect);
    return (distance_m >= 0 && distance_m <= most_m) ||
           wd_error(log, "distance_m is %g: 0 (that of \"fit\") to %.0f is possible", distance_m,
                    most_m);
}

enum wd_result wd_forest_create_specimens(struct wd_forest **result,
                                          const struct wd_specimen *const *specimens,
                                          uint32_t count, double aspect, double distance_m,
                                          const struct wd_log *log)
{
    *result = NULL;
    if (!wd_specimens_check(specimens, count, log) || !check_view(aspect, distance_m, log))
        return WD_ERROR_INPUT;
    struct wd_forest *forest = wd_alloc(sizeof *forest);
    forest->log = log ? *log : (struct wd_log){0};
    bool ok = make_scene(&forest->scene, specimens, count, &forest->log);
    if (ok) {
        struct wd_tree *trees = make_trees(specimens, count);
        struct row row = measure(specimens, count);
        double far = make_cameras(&forest->scene, &row, aspect, distance_m), most_m = 1e6;
        ok = far <= most_m || wd_error(&forest->log, "aspect %g: all would be seen from %.3g m off; %.0f m is possible",
                                       aspect, far, most_m);
        hold_low_plants(&forest->scene, &row);
        forest->scene.quality.shadow_distance_m = far + 3 * row.height_m;
        const struct wd_world_params world = {
            .trees = trees, .tree_count = count, .log = &forest->log};
        ok = ok && wd_world_init(&forest->world, &forest->scene, &world);
        free(trees);
    }
    if (!ok) {
        wd_forest_destroy(&forest);
        return WD_ERROR_INPUT;
    }
    *result = forest;
    return WD_OK;
}

void wd_forest_set_specimen_form(struct wd_forest *forest, enum wd_specimen_form form)
{
    const double everywhere = 1e6;
    if (form == WD_SPECIMEN_AS_SEEN)
        return;
    forest->scene.quality.mesh_distance_m = form == WD_SPECIMEN_FULL ? everywhere : 0;
    forest->scene.quality.reduced_distance_m = form == WD_SPECIMEN_CARDS ? 0 : everywhere;
}
