/* species_parts.h: the two kinds of species files: grown ones and artists' models. */
#ifndef WD_SCENE_SPECIES_PARTS_H
#define WD_SCENE_SPECIES_PARTS_H

#include "scene/species.h"

/* Whether a species file's text has the key "model" at its root. */
bool wd_species_text_has_model(const char *path, const char *text, size_t size);

/* A species of nothing but a model. */
bool wd_species_of_model_file(struct wd_species *species, const char *path, struct wd_arena *arena,
                              const struct wd_log *log);

#endif
