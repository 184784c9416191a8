/* variant.h: the grown individuals that stand for a species, `variants` of each; individual i of a
 * scene is variant i % variants of species i / variants. */
#ifndef WD_TREE_VARIANT_H
#define WD_TREE_VARIANT_H

#include "scene/scene.h"
#include "shared/forest.h"
#include "tree/grow.h"

/* How individual `index` of the scene is grown, and from what: its species with as many leaves as it
 * has at this time, for taller individuals are ahead in the season. Shares the lists of the scene's
 * species. */
struct wd_species wd_variant_species(const struct wd_scene *scene, uint32_t index);
struct wd_grow_params wd_variant_params(const struct wd_scene *scene, uint32_t index);

/* Grows individual `index` of the scene; false, logged, where its species file does not allow it. */
bool wd_variant_grow(struct wd_tree_model *model, const struct wd_scene *scene, uint32_t index,
                     const struct wd_log *log);

/* What whoever draws it needs to know of it, but for its cards. */
void wd_variant_describe(struct wd_model *model, const struct wd_scene *scene, uint32_t index,
                         const struct wd_tree_model *grown);

/* And what its light follows from. `species`: of the model. */
void wd_variant_describe_light(struct wd_lit_model *lit, const struct wd_species *species,
                               const struct wd_model *model, const struct wd_tree_model *grown);

#endif
