/* shown.c: what a picture tells of itself, and what all that make pictures do alike with its layers. */
#include "api/shown.h"

#include <jansson.h>
#include <math.h>

#include "base/memory.h"
#include "world/surroundings.h"

static json_t *vector(const double *v, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(array, json_real(v[i]));
    return array;
}

/* Season, weather and light, by the scene's own keys. */
static json_t *conditions(const struct wd_scene *scene, const struct wd_sun *sun)
{
    bool own = sun->azimuth_deg == scene->sun.azimuth_deg && sun->elevation_deg == scene->sun.elevation_deg;
    return json_pack("{s:{s:s?, s:s?}, s:{s:f, s:f}, s:{s:f}, s:{s:f}, s:{s:f, s:f}, s:{s:f}}",
                     "time", "date", scene->time.date, "clock", own ? scene->time.clock : NULL,
                     "sun", "azimuth_deg", sun->azimuth_deg, "elevation_deg", sun->elevation_deg,
                     "sky", "cover", scene->sky.cover, "fog", "visibility_m", scene->fog.visibility_m,
                     "wind", "speed_mps", scene->wind.speed_mps, "direction_deg", scene->wind.direction_deg,
                     "ground", "snow", scene->ground.snow);
}

static char *about(const struct wd_picture *picture, const struct wd_forest *forest)
{
    const struct wd_camera *camera = &picture->camera;
    const struct wd_terrain *terrain = &forest->world.terrain;
    json_t *species = json_array();
    for (size_t i = 0; i < forest->scene.species_file_count; i++)
        json_array_append_new(species, json_string(forest->scene.species_files[i].name));
    json_t *root = json_pack("{s:s?, s:I, s:f, s:{s:o, s:f, s:f, s:f}, s:o, s:s?, s:o, s:o}",
                             "scene", forest->scene.name, "seed", (json_int_t)forest->world.seed,
                             "time_s", picture->time_s, "camera",
                             "position_m", vector(camera->position_m, 3), "yaw_rad", camera->yaw_rad,
                             "pitch_rad", camera->pitch_rad, "fov_rad", camera->fov_rad,
                             "origin_m", vector(terrain->origin_m, 2), "crs", terrain->crs,
                             "species", species, "conditions", conditions(&forest->scene, &picture->sun));
    char *text = root ? json_dumps(root, JSON_COMPACT) : NULL;
    json_decref(root);
    return text;
}

void wd_rays_init(struct wd_rays *rays, const struct wd_camera *camera, uint32_t width, uint32_t height)
{
    double right[3], forward[3], up[3], tall = tan(0.5 * camera->fov_rad), wide = tall * width / height;
    wd_camera_axes(camera, right, forward, up);
    for (int k = 0; k < 3; k++) {
        rays->right[k] = (float)(2 * wide / width * right[k]);
        rays->down[k] = (float)(-2 * tall / height * up[k]);
        rays->first[k] = (float)(forward[k] + wide * (1.0 / width - 1) * right[k] + tall * (1 - 1.0 / height) * up[k]);
    }
}

struct wd_vec3 wd_ray_through(const struct wd_rays *rays, uint32_t x, uint32_t y)
{
    struct wd_vec3 row = wd_v3_add(wd_v3_of(rays->first), wd_v3_scale(wd_v3_of(rays->down), (float)y));
    return wd_v3_add(row, wd_v3_scale(wd_v3_of(rays->right), (float)x));
}

void wd_picture_settle(struct wd_picture *picture, const struct wd_forest *forest, const struct wd_camera *camera,
                       const struct wd_sun *sun, double time_s)
{
    picture->camera = *camera;
    picture->sun = *sun;
    picture->time_s = time_s;
    picture->about = about(picture, forest);
}

void wd_picture_camera_matrix(float m[4][4], const struct wd_camera *camera)
{
    double axes[3][3]; /* right, up, back */
    double forward[3];
    wd_camera_axes(camera, axes[0], forward, axes[1]);
    for (int k = 0; k < 3; k++)
        axes[2][k] = -forward[k];
    for (int column = 0; column < 3; column++) {
        double moved = 0;
        for (int row = 0; row < 3; row++) {
            m[row][column] = (float)axes[column][row];
            moved -= axes[column][row] * camera->position_m[row];
        }
        m[3][column] = (float)moved;
        m[column][3] = 0;
    }
    m[3][3] = 1;
}

/* --- its memory ---------------------------------------------------------------------------- */

static bool no_memory(uint32_t width, uint32_t height, size_t bytes_a_pixel, const struct wd_log *log)
{
    return wd_error(log, "out of memory: a picture of %u x %u pixels wants %.1f MiB, which cannot be had",
                    width, height, (double)width * height * (double)bytes_a_pixel / (1 << 20));
}

bool wd_picture_make_room(struct wd_picture *picture, uint32_t width, uint32_t height,
                          uint32_t layers, const struct wd_log *log)
{
    *picture = (struct wd_picture){.width = width, .height = height};
    const struct {
        void **array;
        size_t bytes; /* a pixel */
        uint32_t layer;
    } arrays[] = {
        {(void **)&picture->display, 4, WD_LAYER_DISPLAY},
        {(void **)&picture->color, 12, WD_LAYER_COLOR},
        {(void **)&picture->depth_m, 4, WD_LAYER_DEPTH},
        {(void **)&picture->normal, 12, WD_LAYER_NORMAL},
        {(void **)&picture->albedo, 12, WD_LAYER_ALBEDO},
        {(void **)&picture->species, 4, WD_LAYER_SPECIES},
        {(void **)&picture->tree_id, 4, WD_LAYER_TREE_ID},
        {(void **)&picture->velocity_px, 8, WD_LAYER_VELOCITY},
        {(void **)&picture->rank_tree, 4 * WD_RANKS, WD_LAYER_CRYPTOMATTE},
        {(void **)&picture->rank_share, 4 * WD_RANKS, WD_LAYER_CRYPTOMATTE},
    };
    size_t bytes = 0;
    bool ok = true;
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        if (!(layers & arrays[i].layer))
            continue;
        bytes += arrays[i].bytes;
        *arrays[i].array = ok ? wd_try_array((size_t)width * height, arrays[i].bytes) : NULL;
        ok = ok && *arrays[i].array;
    }
    if (!ok)
        wd_picture_finish(picture);
    return ok || no_memory(width, height, bytes, log);
}

void *wd_picture_try_scratch(uint32_t width, uint32_t height, size_t bytes_a_pixel,
                             const struct wd_log *log)
{
    void *scratch = wd_try_array((size_t)width * height, bytes_a_pixel);
    if (!scratch)
        no_memory(width, height, bytes_a_pixel, log);
    return scratch;
}
