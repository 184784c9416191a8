#include "api/forest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/dmath.h"
#include "base/log.h"
#include "base/memory.h"
#include "world/surroundings.h"

static const double DEGREE = WD_PI / 180.0;

const char *wd_forest_camera_name(const struct wd_forest *forest, uint32_t index)
{
    return index < forest->scene.camera_count ? forest->scene.cameras[index].name : NULL;
}

const char *wd_forest_path_name(const struct wd_forest *forest, uint32_t index)
{
    return index < forest->scene.path_count ? forest->scene.paths[index].name : NULL;
}

/* A place of the scene file in the local frame. */
static void local_place(const struct wd_terrain *terrain, const struct wd_scene_camera *camera,
                        const double from[3], double to[3])
{
    bool projected = camera->frame && strcmp(camera->frame, "projected") == 0;
    to[0] = from[0] - (projected ? terrain->origin_m[0] : 0.0);
    to[1] = from[1] - (projected ? terrain->origin_m[1] : 0.0);
    to[2] = from[2] + (camera->absolute ? 0.0 : wd_terrain_height(terrain, to[0], to[1]));
}

static void look_at(struct wd_camera *camera, const double target_m[3])
{
    double east = target_m[0] - camera->position_m[0], north = target_m[1] - camera->position_m[1];
    double up = target_m[2] - camera->position_m[2];
    camera->yaw_rad = atan2(east, north);
    camera->pitch_rad = atan2(up, hypot(east, north));
}

void wd_camera_look_at(struct wd_camera *camera, const double place_m[3])
{
    double yaw_rad = camera->yaw_rad;
    look_at(camera, place_m);
    if (place_m[0] == camera->position_m[0] && place_m[1] == camera->position_m[1])
        camera->yaw_rad = yaw_rad;
}

static double focal_px(const struct wd_camera *camera, uint32_t height)
{
    return 0.5 * height / tan(0.5 * camera->fov_rad);
}

bool wd_camera_project(const struct wd_camera *camera, uint32_t width, uint32_t height, const double place_m[3],
                       double pixel[2], double *depth_m)
{
    double right[3], ahead[3], up[3], along[3] = {0}; /* right, ahead, up */
    wd_camera_axes(camera, right, ahead, up);
    for (int k = 0; k < 3; k++) {
        double from_m = place_m[k] - camera->position_m[k];
        along[0] += from_m * right[k];
        along[1] += from_m * ahead[k];
        along[2] += from_m * up[k];
    }
    if (!(along[1] > 0))
        return false;
    double scale = focal_px(camera, height) / along[1];
    pixel[0] = 0.5 * width + scale * along[0];
    pixel[1] = 0.5 * height - scale * along[2];
    if (depth_m)
        *depth_m = along[1];
    return true;
}

void wd_camera_place(const struct wd_camera *camera, uint32_t width, uint32_t height, const double pixel[2],
                     double depth_m, double place_m[3])
{
    double right[3], ahead[3], up[3], scale = 1 / focal_px(camera, height);
    double x = scale * (pixel[0] - 0.5 * width), y = scale * (0.5 * height - pixel[1]);
    wd_camera_axes(camera, right, ahead, up);
    for (int k = 0; k < 3; k++)
        place_m[k] = camera->position_m[k] + depth_m * (ahead[k] + x * right[k] + y * up[k]);
}

static bool is_near(const struct wd_terrain *terrain, const struct wd_scene_camera *camera)
{
    double at[3];
    local_place(terrain, camera, camera->position_m, at);
    return camera->automatic || fmax(fmax(fabs(at[0]), fabs(at[1])), fabs(at[2])) < WD_MOST_PLACE_M;
}

static bool too_far(const struct wd_scene *scene, const struct wd_scene_camera *camera,
                    const char *key, const struct wd_log *log)
{
    const double *at = camera->position_m;
    return wd_error(log, "%s: %s.position_m: (%.10g, %.10g, %.10g) is %g km or more from the terrain's "
                    "south-west corner; is \"frame\": \"%s\" right?", scene->path, key, at[0], at[1],
                    at[2], WD_MOST_PLACE_M * 1e-3, camera->frame);
}

/* How far outside the ground a place is; 0 or less: over it. */
static double outside_m(const struct wd_terrain *terrain, const double at_m[3])
{
    double east_m = fmax(-at_m[0], at_m[0] - wd_terrain_extent_x_m(terrain));
    double north_m = fmax(-at_m[1], at_m[1] - wd_terrain_extent_y_m(terrain));
    return fmax(east_m, north_m);
}

/* Where such a camera sees the forest's underside, or nothing. Writes what is to be told of it, "" if nothing is. */
static void describe_odd_place(const struct wd_terrain *terrain, const struct wd_scene_camera *camera, char *text,
                               size_t size)
{
    const double least_m = 0.01, far_m = 1000; /* small plots are seen from afar */
    double at_m[3], size_m[2] = {wd_terrain_extent_x_m(terrain), wd_terrain_extent_y_m(terrain)};
    local_place(terrain, camera, camera->position_m, at_m);
    double ground_m = wd_terrain_height(terrain, at_m[0], at_m[1]), off_m = outside_m(terrain, at_m);
    text[0] = '\0';
    if (camera->automatic)
        return;
    if (off_m > fmax(far_m, fmax(size_m[0], size_m[1])))
        snprintf(text, size, "stands at (%.10g, %.10g, %.10g), %.0f m outside the ground of %.0f x %.0f m, whose edge is "
                 "%.4g m high there", at_m[0], at_m[1], at_m[2], off_m, size_m[0], size_m[1], ground_m);
    else if (ground_m - at_m[2] > least_m && (off_m <= 0 || !camera->absolute))
        snprintf(text, size, "stands at (%.10g, %.10g, %.10g), %.4g m below the ground, which is %.4g m high there", at_m[0],
                 at_m[1], at_m[2], ground_m - at_m[2], ground_m);
}

enum { FEW_PLACES = 5 };
struct places {
    const struct wd_scene *scene;
    const struct wd_terrain *terrain;
    const struct wd_log *log;
    size_t odd; /* that are warned of, or would be were there fewer */
    bool ok;
};

/* `name` is for warnings, `key` for errors. */
static void check_place(struct places *places, const struct wd_scene_camera *camera, const char *name, const char *key)
{
    char text[256];
    if (!is_near(places->terrain, camera)) {
        places->ok = too_far(places->scene, camera, key, places->log);
        return;
    }
    describe_odd_place(places->terrain, camera, text, sizeof text);
    if (text[0] && ++places->odd <= FEW_PLACES)
        wd_warn(places->log, "%s: %s %s", places->scene->path, name, text);
}

bool wd_scene_check_places(const struct wd_scene *scene, const struct wd_terrain *terrain,
                           const struct wd_log *log)
{
    char key[64], name[128];
    struct places places = {scene, terrain, log, 0, true};
    for (size_t i = 0; i < scene->camera_count; i++) {
        snprintf(key, sizeof key, "cameras[%zu]", i);
        snprintf(name, sizeof name, "camera \"%.60s\"", scene->cameras[i].name);
        check_place(&places, &scene->cameras[i], name, key);
    }
    for (size_t i = 0; i < scene->path_count; i++) {
        const struct wd_scene_path *path = &scene->paths[i];
        for (size_t k = 0; k < path->key_count; k++) {
            snprintf(key, sizeof key, "paths[%zu].keys[%zu]", i, k);
            snprintf(name, sizeof name, "key %zu of path \"%.60s\"", k, path->name);
            check_place(&places, &path->keys[k], name, key);
        }
    }
    if (places.odd > FEW_PLACES)
        wd_warn(log, "%s: %zu more cameras and keys of paths stand below the ground or far outside it", scene->path,
                places.odd - FEW_PLACES);
    return places.ok;
}

/* Over the south-western corner, looking to the middle: for scenes that name no camera. */
static void overlook(const struct wd_forest *forest, struct wd_camera *camera)
{
    const struct wd_terrain *terrain = &forest->world.terrain;
    double east = wd_terrain_extent_x_m(terrain), north = wd_terrain_extent_y_m(terrain);
    double middle[3] = {0.5 * east, 0.5 * north, 0.0};
    middle[2] = wd_terrain_height(terrain, middle[0], middle[1]);
    camera->position_m[0] = 0.1 * east;
    camera->position_m[1] = 0.1 * north;
    double span = hypot(east, north);
    camera->position_m[2] =
        fmax(wd_terrain_height(terrain, camera->position_m[0], camera->position_m[1]) + 0.04 * span,
             middle[2] + 0.12 * span);
    look_at(camera, middle);
}

static void resolve(const struct wd_forest *forest, const struct wd_scene_camera *from,
                    struct wd_camera *camera)
{
    *camera = (struct wd_camera){
        .yaw_rad = from->yaw_deg * DEGREE,
        .pitch_rad = from->pitch_deg * DEGREE,
        .fov_rad = from->fov_deg * DEGREE,
    };
    if (from->automatic) {
        overlook(forest, camera);
        return;
    }
    local_place(&forest->world.terrain, from, from->position_m, camera->position_m);
    if (from->look_at_count == 3) {
        double target[3];
        local_place(&forest->world.terrain, from, from->look_at_m, target);
        look_at(camera, target);
    }
}

/* Cameras or paths: the first of their names as a complaint about `name` lists them. */
static enum wd_result no_such(const struct wd_forest *forest, const char *kind, const char *name,
                              const char *(*name_of)(const struct wd_forest *, uint32_t),
                              size_t count)
{
    enum { FEW = 10 };
    const char **names = wd_alloc_array(count, sizeof *names);
    for (size_t i = 0; i < count; i++)
        names[i] = name_of(forest, (uint32_t)i);
    const char *nearest = wd_nearest_name(name, names, count);
    char *list = wd_join(names, count < FEW ? count : FEW, ", ");
    char *more = count > FEW ? wd_format(" and %zu more", count - FEW) : wd_strdup("");
    wd_error(&forest->log, "%s: no %s \"%.200s\"%s%s%s; there are: %s%s", forest->scene.path, kind, name,
             nearest ? ", did you mean \"" : "", nearest ? nearest : "", nearest ? "\"" : "",
             list, more);
    free(more);
    free(list);
    free(names);
    return WD_ERROR_INPUT;
}

enum wd_result wd_forest_get_camera(const struct wd_forest *forest, const char *name,
                                    struct wd_camera *camera)
{
    const struct wd_scene_camera *found =
        name ? wd_scene_find_camera(&forest->scene, name) : &forest->scene.cameras[0];
    if (!found)
        return no_such(forest, "camera", name, wd_forest_camera_name, forest->scene.camera_count);
    resolve(forest, found, camera);
    return WD_OK;
}

static double catmull_rom(const double p[4], double t)
{
    return p[1] + 0.5 * t *
                      ((p[2] - p[0]) + t * ((2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]) +
                                            t * (3.0 * (p[1] - p[2]) + p[3] - p[0])));
}

/* The turn from `from` to `to` the short way round. */
static double near_angle(double from, double to)
{
    return from + remainder(to - from, 2.0 * WD_PI);
}

static void interpolate(const struct wd_camera keys[4], double t, struct wd_camera *camera)
{
    double values[6][4];
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++)
            values[k][i] = keys[i].position_m[k];
        values[3][i] = keys[i].yaw_rad;
        values[4][i] = keys[i].pitch_rad;
        values[5][i] = keys[i].fov_rad;
    }
    for (int i = 1; i < 4; i++)
        values[3][i] = near_angle(values[3][i - 1], values[3][i]);
    for (int k = 0; k < 3; k++)
        camera->position_m[k] = catmull_rom(values[k], t);
    camera->yaw_rad = catmull_rom(values[3], t);
    /* the curve may leave the keys' range: not over the zenith, and no view without or beyond an angle */
    camera->pitch_rad = fmin(fmax(catmull_rom(values[4], t), -0.5 * WD_PI), 0.5 * WD_PI);
    camera->fov_rad = fmin(fmax(catmull_rom(values[5], t), fmin(values[5][1], values[5][2])),
                           fmax(values[5][1], values[5][2]));
}

static const struct wd_scene_path *find_path(const struct wd_forest *forest, const char *name)
{
    for (size_t i = 0; i < forest->scene.path_count; i++) {
        if (!name || strcmp(forest->scene.paths[i].name, name) == 0)
            return &forest->scene.paths[i];
    }
    return NULL;
}

enum wd_result wd_forest_get_path_camera(const struct wd_forest *forest, const char *name,
                                         double time_s, struct wd_camera *camera,
                                         double *duration_s)
{
    const struct wd_scene_path *path = find_path(forest, name);
    if (!forest->scene.path_count) {
        wd_error(&forest->log, "%s: the scene has no paths", forest->scene.path);
        return WD_ERROR_INPUT;
    }
    if (!path)
        return no_such(forest, "path", name, wd_forest_path_name, forest->scene.path_count);
    if (!isfinite(time_s)) {
        wd_error(&forest->log, "wd_forest_get_path_camera: time_s is %g: it must be finite", time_s);
        return WD_ERROR_INPUT;
    }
    if (duration_s)
        *duration_s = path->duration_s;
    double spans = (double)(path->key_count - 1);
    double at = fmin(fmax(time_s / path->duration_s, 0.0), 1.0) * spans;
    size_t span = (size_t)fmin(floor(at), spans - 1.0);
    struct wd_camera keys[4];
    for (int i = 0; i < 4; i++) {
        long key = (long)span + i - 1;
        key = key < 0 ? 0 : key > (long)spans ? (long)spans : key;
        resolve(forest, &path->keys[key], &keys[i]);
    }
    interpolate(keys, at - (double)span, camera);
    return WD_OK;
}
