/* small_scene.h: a scene made by hand, for tests that need no files. */
#ifndef WD_TESTS_SMALL_SCENE_H
#define WD_TESTS_SMALL_SCENE_H

#include "scene/scene.h"

enum { SMALL_SPECIES = 3, SMALL_LAYERS = 4, SMALL_INVENTORIES = 2 };

struct small_scene {
    struct wd_scene scene;
    struct wd_string_pair files[SMALL_SPECIES];
    struct wd_species species[SMALL_SPECIES];
    struct wd_scene_layer layers[SMALL_LAYERS];
    struct wd_scene_share shares[SMALL_LAYERS][SMALL_SPECIES];
    struct wd_scene_inventory inventories[SMALL_INVENTORIES];
};

/* Flat ground of 400 x 300 m, three species, no layers yet. Must not be moved in memory. */
static inline void small_scene_init(struct small_scene *small)
{
    static const char *const names[SMALL_SPECIES] = {"oak", "spruce", "birch"};
    static const char *const latin[SMALL_SPECIES] = {"Quercus robur", "Picea abies",
                                                     "Betula pendula"};
    static const struct wd_allometry allometry[SMALL_SPECIES] = {
        {30.0, 0.03, 1.1, 1.0, 0.2, 0.9, "test", 1.3},
        {38.0, 0.04, 1.3, 0.8, 0.11, 0.9, "test", 1.3},
        {26.0, 0.06, 1.1, 0.7, 0.15, 0.9, "test", 1.3},
    };
    *small = (struct small_scene){0};
    for (int i = 0; i < SMALL_SPECIES; i++) {
        small->files[i] = (struct wd_string_pair){names[i], "none"};
        small->species[i] = (struct wd_species){.name = names[i], .latin = latin[i],
                                                .typical_height_m = 20.0f,
                                                .height_range_m = {1.0f, 40.0f},
                                                .allometry = allometry[i]};
    }
    small->scene = (struct wd_scene){
        .path = "small.json",
        .seed = 7,
        .terrain = {.kind = WD_TERRAIN_FLAT, .size_m = {400.0, 300.0}, .base_m = 100.0,
                    .vertical_scale = 1.0, .band = 1},
        .species_files = small->files,
        .species_file_count = SMALL_SPECIES,
        .species = small->species,
        .variants = 6,
        .layers = small->layers,
        .inventories = small->inventories,
    };
}

/* Hills: 2 km square, 300 m of relief. */
static inline void small_scene_hills(struct small_scene *small)
{
    small->scene.terrain.kind = WD_TERRAIN_DIAMOND_SQUARE;
    small->scene.terrain.size_m[0] = small->scene.terrain.size_m[1] = 2000.0;
    small->scene.terrain.cell_m = 10.0;
    small->scene.terrain.relief_m = 300.0;
    small->scene.terrain.roughness = 1.0;
}

/* A grid layer of all species with even shares; change what it returns. */
static inline struct wd_scene_layer *small_scene_layer(struct small_scene *small)
{
    size_t index = small->scene.layer_count++;
    struct wd_scene_layer *layer = &small->layers[index];
    for (int i = 0; i < SMALL_SPECIES; i++)
        small->shares[index][i] = (struct wd_scene_share){small->files[i].name, 1.0};
    *layer = (struct wd_scene_layer){
        .name = "layer",
        .placement = WD_PLACE_GRID,
        .species = small->shares[index],
        .species_count = SMALL_SPECIES,
        .spacing_m = 4.0,
        .jitter = 1.0,
        .density = 1.0,
        .slope_deg = {0.0f, 90.0f},
        .altitude_m = {-10000.0, 10000.0},
        .map.value_range = {0.0f, 1.0f},
        .map.band = 1,
        .height_m = {10.0f, 20.0f},
        .aspect = {0.9f, 1.1f},
        .tint = 0.5,
    };
    return layer;
}

static inline struct wd_scene_inventory *small_scene_inventory(struct small_scene *small,
                                                               const char *file)
{
    static struct wd_string_pair any = {"*", "oak"};
    struct wd_scene_inventory *inventory = &small->inventories[small->scene.inventory_count++];
    *inventory = (struct wd_scene_inventory){.file = file, .species = &any, .species_count = 1};
    return inventory;
}

#endif
