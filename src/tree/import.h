/* import.h: a tree from an artist's model file, ready to be drawn like a grown one. */
#ifndef WD_TREE_IMPORT_H
#define WD_TREE_IMPORT_H

#include "tree/grow.h"
#include "tree/look_map.h"
#include "tree/model_look.h"

struct wd_tree_import {
    struct wd_tree_model model;
    struct wd_model_materials materials; /* of `file`: its names */
    struct wd_model_file file;           /* geometry no longer used; owns names */
    struct wd_look_sheet looks[2];       /* wood, leaves */
};

/* Reads species->model.file: splits wood from leaves, drops stray points, lines and triangles
 * without area (reported), turns it z up, brings it to species->model.height_m with the trunk's
 * foot at (0, 0, 0), makes the reduced mesh and the looks. On failure `{0}`: an unreadable or
 * empty file, positions that are not finite (the message names the mesh). */
bool wd_tree_import(struct wd_tree_import *import, const struct wd_species *species,
                    const struct wd_log *log);
void wd_tree_import_finish(struct wd_tree_import *import); /* accepts {0} */

/* Fills a layer of looks as wd_look_map_fill does for grown species; alpha below one half is a hole.
 * Backs of leaves are as their fronts, surfaces are smooth. */
void wd_tree_import_look(const struct wd_tree_import *import, const struct wd_look_map *map,
                         uint32_t layer);

/* Imports the model of every species that has one, and takes proportions and heights from it where
 * the species file says nothing; reads the meshes that hedges are cut to. Progress stage "reading
 * models". The imports belong to the
 * species: wd_species_drop_models. */
bool wd_species_import_models(struct wd_species *species, size_t count,
                              const struct wd_progress *progress, const struct wd_log *log);
void wd_species_drop_models(struct wd_species *species, size_t count);

#endif
