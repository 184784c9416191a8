/* growth_cache.h: grown models and generated looks, kept on disk: growing a hundred trees takes
 * seconds, reading them back a fraction. */
#ifndef WD_BAKE_GROWTH_CACHE_H
#define WD_BAKE_GROWTH_CACHE_H

#include "bake/cache.h"
#include "tree/variant.h"

/* What names a species as growth and looks see it: the values of its file, not where they lie.
 * 0 for imported models, which are not kept. */
uint64_t wd_species_key(const struct wd_species *species);

/* Individual `index` of a scene (wd_variant_grow), from the cache or into it, without triangles of
 * leaves (wd_tree_model_add_leaves). `*key` names its content. */
bool wd_growth_get(struct wd_tree_model *model, uint64_t *key, struct wd_bake_cache *cache,
                   const struct wd_scene *scene, uint32_t index, const struct wd_log *log);

/* Whether `size` bytes of a species' looks were there. */
bool wd_looks_load(uint8_t *looks, size_t size, struct wd_bake_cache *cache,
                   const struct wd_species *species);
void wd_looks_store(const uint8_t *looks, size_t size, struct wd_bake_cache *cache,
                    const struct wd_species *species);

#endif
