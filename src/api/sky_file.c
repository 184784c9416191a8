#include "api/sky_file.h"

#include <math.h>
#include <stdlib.h>

#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/exr.h"

enum { LEAST_WIDTH = 4 };

/* Messages of the reader, with the scene's file and key before them. */
struct keyed_log {
    const struct wd_log *log;
    const char *scene;
};

static void keyed_sink(void *user, enum wd_log_level level, const char *message)
{
    const struct keyed_log *keyed = user;
    if (level == WD_LOG_ERROR)
        wd_error(keyed->log, "%s: sky.file: %s", keyed->scene, message);
}

/* The planes of red, green and blue. */
static bool find_planes(const struct wd_exr_image *image, const float *planes[3], const char *path,
                        const struct wd_log *log)
{
    static const char *const names[3] = {"R", "G", "B"};
    for (int k = 0; k < 3; k++) {
        const struct wd_exr_plane *plane = wd_exr_find(image, names[k]);
        if (!plane || plane->type == WD_EXR_UINT)
            return wd_error(log, "%s: found %zu channels, the first \"%s\", but no %s of half or "
                            "float; a sky needs R, G and B", path, image->plane_count,
                            image->planes[0].name, names[k]);
        planes[k] = plane->data;
    }
    return true;
}

static bool check_size(const struct wd_exr_image *image, const char *path, const struct wd_log *log)
{
    if (image->width != 2 * image->height || image->width < LEAST_WIDTH || image->height % 2)
        return wd_error(log, "%s: found %u x %u pixels; a map by longitude and latitude is twice "
                        "as wide as high, at least 4 x 2, its height even", path, image->width,
                        image->height);
    return true;
}

static bool copy_pixels(float *rgb, const struct wd_exr_image *image, const float *const planes[3],
                        const char *path, const struct wd_log *log)
{
    size_t count = (size_t)image->width * image->height;
    float most = 0;
    for (size_t at = 0; at < count; at++) {
        for (size_t k = 0; k < 3; k++) {
            float value = planes[k][at];
            if (!(value >= 0 && isfinite(value)))
                return wd_error(log, "%s: found %g in channel %c at column %zu, row %zu; radiance is a "
                                "finite number from 0", path, (double)value, "RGB"[k],
                                at % image->width, at / image->width);
            rgb[3 * at + k] = value;
            most = fmaxf(most, value);
        }
    }
    return most > 0 || wd_error(log, "%s: all pixels are black; a sky gives light", path);
}

/* All three in one block, which the map takes over. */
static enum wd_result take_pixels(struct wd_sky_map *map, const struct wd_scene *scene,
                                  const struct wd_exr_image *image, const char *path,
                                  const struct wd_log *log)
{
    const float *planes[3];
    if (!check_size(image, path, log) || !find_planes(image, planes, path, log))
        return WD_ERROR_INPUT;
    float *rgb = wd_try_array((size_t)image->width * image->height, 3 * sizeof *rgb);
    if (!rgb) {
        wd_error(log, "%s: out of memory: a sky of %u x %u pixels cannot be held", path, image->width,
                 image->height);
        return WD_ERROR_MEMORY;
    }
    if (!copy_pixels(rgb, image, planes, path, log)) {
        free(rgb);
        return WD_ERROR_INPUT;
    }
    wd_sky_map_init(map, rgb, image->width, image->height, scene);
    return WD_OK;
}

static enum wd_result load(struct wd_sky_map *map, const struct wd_scene *scene, const char *path,
                           const struct wd_log *log)
{
    struct wd_exr_image image;
    if (!wd_exr_read(&image, path, log))
        return image.no_memory ? WD_ERROR_MEMORY : WD_ERROR_INPUT;
    enum wd_result result = take_pixels(map, scene, &image, path, log);
    wd_exr_image_finish(&image);
    return result;
}

enum wd_result wd_sky_file_load(struct wd_sky_map *map, const struct wd_scene *scene,
                                const struct wd_log *log)
{
    *map = (struct wd_sky_map){0};
    if (!scene->sky.file)
        return WD_OK;
    struct keyed_log keyed = {log, scene->path};
    const struct wd_log with_key = {keyed_sink, &keyed};
    char *path = wd_path_beside(scene->path, scene->sky.file);
    enum wd_result result = load(map, scene, path, &with_key);
    free(path);
    return result;
}
