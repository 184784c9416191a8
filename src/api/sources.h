/* sources.h: the files that scenes and trees are read from, which no output may replace. */
#ifndef WD_API_SOURCES_H
#define WD_API_SOURCES_H

#include "scene/scene.h"

/* False, logged, where `output` is a file that the scene or its species were read from, by whatever
 * name: devices and inodes are compared. Models have been imported. */
bool wd_scene_check_output(const struct wd_scene *scene, const char *output,
                           const struct wd_log *log);

#endif
