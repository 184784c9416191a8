#include "cameras.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "message.h"

#define DEGREES (180 / M_PI)

/* SCENE without ".json", with ".cameras.json". */
static char *file_beside(const char *scene_path)
{
    char *path = NULL;
    size_t length = strlen(scene_path);
    if (length > 5 && !strcmp(scene_path + length - 5, ".json"))
        length -= 5;
    return asprintf(&path, "%.*s.cameras.json", (int)length, scene_path) < 0 ? NULL : path;
}

/* The file's name in the working directory, or NULL if `path` is there already. */
static const char *name_here(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : NULL;
}

/* Beside the scene, unless there is none there but one in the working directory. */
static char *choose_path(const char *scene_path)
{
    char *path = file_beside(scene_path);
    const char *here = path ? name_here(path) : NULL;
    if (!here || !access(path, F_OK) || access(here, F_OK))
        return path;
    char *chosen = strdup(here);
    free(path);
    return chosen;
}

static bool read_camera(const json_t *item, struct viewer_saved_camera *saved)
{
    const char *name;
    double yaw_deg, pitch_deg, fov_deg;
    double *position_m = saved->camera.position_m;
    if (json_unpack((json_t *)item, "{s:s, s:[F,F,F], s:F, s:F, s:F}", "name", &name, "position_m",
                    &position_m[0], &position_m[1], &position_m[2], "yaw_deg", &yaw_deg,
                    "pitch_deg", &pitch_deg, "fov_deg", &fov_deg))
        return false;
    if (!(fov_deg >= WD_LEAST_FOV_DEG && fov_deg <= WD_MOST_FOV_DEG))
        return false;
    saved->camera.yaw_rad = yaw_deg / DEGREES;
    saved->camera.pitch_rad = pitch_deg / DEGREES;
    saved->camera.fov_rad = fov_deg / DEGREES;
    saved->name = strdup(name);
    return saved->name != NULL;
}

static bool read_cameras(struct viewer_cameras *cameras)
{
    json_error_t error;
    if (access(cameras->path, F_OK))
        return true;
    json_t *root = json_load_file(cameras->path, 0, &error);
    if (!root)
        return viewer_error(cameras->log, "%s:%d:%d: %s", cameras->path, error.line, error.column,
                            error.text);
    const json_t *list = json_object_get(root, "cameras");
    size_t count = json_array_size(list);
    bool ok = json_is_array(list);
    cameras->saved = calloc(count + 1, sizeof *cameras->saved);
    for (size_t i = 0; ok && cameras->saved && i < count; i++) {
        ok = read_camera(json_array_get(list, i), &cameras->saved[i]);
        cameras->count += ok;
        if (!ok)
            viewer_error(cameras->log,
                         "%s: cameras[%zu] needs name, position_m of three numbers, yaw_deg, "
                         "pitch_deg and fov_deg within %g to %g",
                         cameras->path, i, WD_LEAST_FOV_DEG, WD_MOST_FOV_DEG);
    }
    if (!json_is_array(list))
        viewer_error(cameras->log, "%s: a list \"cameras\" is missing", cameras->path);
    json_decref(root);
    return ok && cameras->saved;
}

bool viewer_cameras_init(struct viewer_cameras *cameras, const char *scene_path,
                         const struct wd_log *log)
{
    *cameras = (struct viewer_cameras){.log = log, .path = choose_path(scene_path)};
    if (cameras->path && read_cameras(cameras))
        return true;
    viewer_cameras_finish(cameras);
    return false;
}

void viewer_cameras_finish(struct viewer_cameras *cameras)
{
    for (size_t i = 0; i < cameras->count; i++)
        free(cameras->saved[i].name);
    free(cameras->saved);
    free(cameras->path);
    *cameras = (struct viewer_cameras){0};
}

static json_t *to_json(const struct viewer_cameras *cameras)
{
    json_t *list = json_array();
    for (size_t i = 0; i < cameras->count; i++) {
        const struct wd_camera *camera = &cameras->saved[i].camera;
        json_array_append_new(
            list, json_pack("{s:s, s:[f,f,f], s:f, s:f, s:f, s:b}", "name", cameras->saved[i].name,
                            "position_m", camera->position_m[0], camera->position_m[1],
                            camera->position_m[2], "yaw_deg", camera->yaw_rad * DEGREES,
                            "pitch_deg", camera->pitch_rad * DEGREES, "fov_deg",
                            camera->fov_rad * DEGREES, "absolute", 1));
    }
    return json_pack("{s:o}", "cameras", list);
}

/* Whole or not at all: a full disk must not cost the cameras saved before. */
static bool write_file(const struct viewer_cameras *cameras, const char *path)
{
    char *temporary = NULL;
    if (asprintf(&temporary, "%s.new", path) < 0)
        return false;
    json_t *root = to_json(cameras);
    bool ok = root && !json_dump_file(root, temporary, JSON_INDENT(2) | JSON_REAL_PRECISION(12)) &&
              !rename(temporary, path);
    int error = errno;
    if (!ok)
        unlink(temporary);
    errno = error;
    json_decref(root);
    free(temporary);
    return ok;
}

/* A folder of scenes that cannot be written gives way to the working directory. */
static bool write_cameras(struct viewer_cameras *cameras)
{
    const char *here = name_here(cameras->path);
    if (write_file(cameras, cameras->path))
        return true;
    if (!here || !write_file(cameras, here))
        return viewer_error(cameras->log, "%s cannot be written: %s", cameras->path,
                            strerror(errno));
    char *path = strdup(here);
    if (!path)
        return viewer_error(cameras->log, "out of memory");
    free(cameras->path);
    cameras->path = path;
    return true;
}

const struct viewer_saved_camera *viewer_cameras_find(const struct viewer_cameras *cameras, const char *name)
{
    for (size_t i = 0; i < cameras->count; i++)
        if (!strcmp(cameras->saved[i].name, name))
            return &cameras->saved[i];
    return NULL;
}

/* Lines may have been taken out of the file. */
static char *fresh_name(const struct viewer_cameras *cameras)
{
    char *name = NULL;
    for (size_t i = cameras->count + 1;; i++) {
        if (asprintf(&name, "saved-%zu", i) < 0)
            return NULL;
        if (!viewer_cameras_find(cameras, name))
            return name;
        free(name);
    }
}

bool viewer_cameras_save(struct viewer_cameras *cameras, const struct wd_camera *camera)
{
    struct viewer_saved_camera *saved =
        realloc(cameras->saved, (cameras->count + 1) * sizeof *saved);
    if (!saved)
        return viewer_error(cameras->log, "out of memory");
    cameras->saved = saved;
    char *name = fresh_name(cameras);
    if (!name)
        return viewer_error(cameras->log, "out of memory");
    saved[cameras->count++] = (struct viewer_saved_camera){name, *camera};
    if (!write_cameras(cameras))
        return false;
    viewer_info(cameras->log, "camera %s saved in %s", name, cameras->path);
    return true;
}
