/* scene_parts.h: what the scene's tables, checks and species share. */
#ifndef WD_SCENE_SCENE_PARTS_H
#define WD_SCENE_SCENE_PARTS_H

#include "scene/scene.h"

/* One check a table; each sees its object once all of the object's own keys are right. */
bool wd_scene_check(void *object, const struct wd_keys_place *place);
bool wd_scene_check_terrain(void *object, const struct wd_keys_place *place);
bool wd_scene_check_map(void *object, const struct wd_keys_place *place);
bool wd_scene_check_layer(void *object, const struct wd_keys_place *place);
bool wd_scene_check_inventory(void *object, const struct wd_keys_place *place);
bool wd_scene_check_camera(void *object, const struct wd_keys_place *place);
bool wd_scene_check_path(void *object, const struct wd_keys_place *place);
bool wd_scene_check_sky(void *object, const struct wd_keys_place *place);
bool wd_scene_check_time(void *object, const struct wd_keys_place *place);

/* Sets the sun and the season of the loaded species from date, clock and place. */
bool wd_scene_apply_time(struct wd_scene *scene, const struct wd_keys_place *place);

/* Puts the data directory of wd_scene_params, which is the place's user, for ${data}. `*file` may
 * be NULL. */
bool wd_scene_expand_file(const char **file, const char *key, const struct wd_keys_place *place);

/* Finds and loads every species that the scene names. */
bool wd_scene_load_species(struct wd_scene *scene, const struct wd_keys_place *place);

extern const struct wd_keys wd_scene_layer_keys, wd_scene_inventory_keys, wd_scene_map_keys;

/* Rows of cameras and of the keys of paths, offsets in struct wd_scene_camera. */
extern const struct wd_keys wd_scene_camera_keys, wd_scene_path_keys;

#endif
