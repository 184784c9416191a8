/* forest.h: a world and its trees as device buffers, whatever method draws them. */
#ifndef WD_FOREST_FOREST_H
#define WD_FOREST_FOREST_H

#include "bake/cards.h"
#include "forest/ground.h"
#include "forest/meshes.h"
#include "forest/pages.h"
#include "gpu/command.h"
#include "shared/forest.h"
#include "world/world.h"

struct wd_forest_device {
    const struct wd_scene *scene;
    const struct wd_world *world;
    struct wd_ground ground;
    struct wd_buffer trees;    /* struct wd_packed_tree[], octree order, then pages; never empty */
    struct wd_pages pages;     /* of layers on demand */
    struct wd_buffer models;   /* struct wd_model[species * variants] */
    struct wd_buffer lit_models; /* struct wd_lit_model of each */
    struct wd_buffer card_indices; /* two triangles a quad */
    uint32_t quads_a_draw;         /* of those: enough for all trees, or for WD_CARD_BATCH of them */
    struct wd_buffer fades;    /* struct wd_layer_fade[1 + layers]; [0] is that of inventories */
    struct wd_image looks;     /* WD_LOOK_LAYERS of each species, sRGB */
    struct wd_image look_details; /* the same layers: normal, roughness, height (tree/look_map.h) */
    /* Cards of models, for methods that draw them (wd_forest_make_cards, forest/model_bakes.h): */
    struct wd_image card_albedo, card_normal; /* WD_CARDS layers a model */
    struct wd_image card_leaf;                /* share of leaves; mips as those of normals */
    struct wd_image canopy_light;   /* see forest/canopy_light.h */
    struct wd_image sky;            /* the world's map of the sky, or a black texel */
    float canopy_light_from_m[2];   /* its coordinates = (local metres - from) * scale */
    float canopy_light_scale[2];
    float leaf_scatter[3];          /* root of what leaves absorb: wd_frame_uniforms */
    VkSampler look_sampler, card_sampler, point_sampler; /* point: normals and shadows of cards */
    struct wd_forest_meshes meshes;
    struct wd_model *host_models;
    struct wd_crown_shade *crown_shades; /* of each */
    float *stem_radii_m; /* of each one's stem at breast height; 0: none that counts */
    uint64_t *model_keys;      /* what names each model's content in the cache */
    struct wd_bake_cache cache;
    struct wd_layer_fade *host_fades;
    struct wd_shared_log log;    /* for threads that make models */
    struct wd_progress progress; /* told while a method bakes what it needs; {0}: nobody is */
    uint32_t model_count, variants;
    float max_tree_height_m;
    bool falls; /* leaves of some model are on their way down */
};

struct wd_forest_device_params {
    const struct wd_scene *scene;
    const struct wd_world *world;
    const char *cache_dir; /* "" or NULL: none */
    unsigned threads;
    const struct wd_progress *progress;
    const struct wd_log *log;
};

/* Grows every model (or loads it) and uploads it all with the world's trees. `scene` and `world` must
 * outlive the result. */
bool wd_forest_device_init(struct wd_forest_device *forest, struct wd_gpu *gpu,
                           const struct wd_forest_device_params *params);
void wd_forest_device_finish(struct wd_forest_device *forest, struct wd_gpu *gpu);

/* Declares that the frame's passes read all of it. Once a frame, before any of them. */
void wd_forest_device_use(struct wd_forest_device *forest, struct wd_cmd *cmd);

/* Index into the fades of a tree (an index in octree order): its layer + 1; 0 for inventories and
 * for layers beyond the 127th. */
uint32_t wd_forest_fade_of(const struct wd_forest_device *forest, size_t tree);

/* The tree of a record on the device, as the newest frame saw it; false: there is none. */
bool wd_forest_tree_at(const struct wd_forest_device *forest, uint32_t record,
                       struct wd_tree *tree);

/* Index into models of a tree's model. */
uint32_t wd_forest_model_of(const struct wd_forest_device *forest, const struct wd_tree *tree);

#endif
