/* schemas.h: the schemas that docs/ publishes. */
#ifndef WD_TESTS_SCENE_SCHEMAS_H
#define WD_TESTS_SCENE_SCHEMAS_H

#include "scene/scene.h"

static const struct {
    const char *name, *file;
    const struct wd_keys *table;
} schemas[] = {
    {"scene", "scene.schema.json", &wd_scene_keys},
    {"species", "species.schema.json", &wd_species_keys},
    {"model", "model.schema.json", &wd_species_model_keys},
};
enum { SCHEMA_COUNT = sizeof schemas / sizeof *schemas };

#endif
