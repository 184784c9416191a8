/* sky_file.h: the scene's environment map from its file. */
#ifndef WD_API_SKY_FILE_H
#define WD_API_SKY_FILE_H

#include "world/sky_map.h"

/* Reads the scene's sky.file, if it names one, into `*map`, which is {0} otherwise and on failure:
 * WD_ERROR_INPUT, WD_ERROR_MEMORY. */
enum wd_result wd_sky_file_load(struct wd_sky_map *map, const struct wd_scene *scene,
                                const struct wd_log *log);

#endif
