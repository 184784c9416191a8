/* sources.h: the files that scenes and trees are read from, which no output may replace. */
#ifndef WD_API_SOURCES_H
#define WD_API_SOURCES_H

#include "scene/scene.h"

/* False, logged, where `output` is a file that the scene or its species were read from, by whatever
 * name: devices and inodes are compared. Models have been imported. */
bool wd_scene_check_output(const struct wd_scene *scene, const char *output,
                           const struct wd_log *log);

/* The same of one species: its file, its model with materials and textures, what it is cut to. */
bool wd_species_check_output(const struct wd_species *species, const char *output,
                             const struct wd_log *log);

/* The same of one file, the `what` of `of`; NULL is none. */
bool wd_source_check_output(const char *source, const char *what, const char *of,
                            const char *output, const struct wd_log *log);

#endif
