/* place.c: time to plant a million trees on one core: terrain heights, slope, altitude and patch
 * rules, species, sizes. Prints the median of several runs. */
#include "figures.h"

#include <stdio.h>

#include "base/clock.h"
#include "world/placement.h"

enum { RUNS = 7 };

static struct wd_string_pair files[] = {{"oak", ""}, {"spruce", ""}};
static struct wd_species species[] = {
    {.name = "oak", .typical_height_m = 22.0f,
     .allometry = {30.0, 0.03, 1.1, 1.0, 0.2, 0.9, "bench", 1.3}},
    {.name = "spruce", .typical_height_m = 26.0f,
     .allometry = {38.0, 0.04, 1.3, 0.8, 0.11, 0.9, "bench", 1.3}},
};
static struct wd_scene_share shares[] = {{"oak", 1.0}, {"spruce", 2.0}};
/* Rules refuse about half of the cells, as in a real valley. */
static struct wd_scene_layer layer = {
    .name = "forest", .placement = WD_PLACE_GRID, .species = shares, .species_count = 2,
    .spacing_m = 4.0, .jitter = 0.9, .density = 0.95,
    .slope_deg = {0.0f, 35.0f}, .slope_fade_deg = 8.0,
    .altitude_m = {50.0, 600.0}, .altitude_fade_m = 80.0,
    .patchiness = 0.7, .patch_size_m = 150.0,
    .height_m = {8.0f, 30.0f}, .aspect = {0.8f, 1.2f}, .tint = 0.4,
};
static const struct wd_scene scene = {
    .path = "bench", .seed = 1, .variants = 6,
    .terrain = {.kind = WD_TERRAIN_DIAMOND_SQUARE, .size_m = {6000.0, 6000.0}, .cell_m = 8.0,
                .relief_m = 700.0, .roughness = 1.0, .vertical_scale = 1.0},
    .species_files = files, .species_file_count = 2, .species = species,
    .layers = &layer, .layer_count = 1,
};

static bool run(const struct wd_placement_params *params, double *million_s, size_t *count)
{
    struct wd_placement placement;
    struct wd_tree_list list = {0};
    double start_s = wd_clock_s();
    bool ok = wd_placement_init(&placement, params, 0) &&
              wd_placement_fill(&placement, params, &list);
    *count = list.count;
    *million_s = (wd_clock_s() - start_s) * 1e6 / (double)(list.count ? list.count : 1);
    wd_placement_finish(&placement);
    wd_tree_list_finish(&list);
    return ok && *count > 0;
}

bool bench_place_million(const char *gpu)
{
    (void)gpu;
    struct wd_terrain terrain;
    if (!wd_terrain_init(&terrain, &scene, 1, 0, 0, NULL, NULL))
        return false;
    const struct wd_placement_params params = {.scene = &scene, .terrain = &terrain, .seed = 1,
                                               .threads = 1, .max_trees = UINT64_C(1) << 30};
    double million_s[RUNS];
    bool ok = true;
    for (int i = 0; ok && i < RUNS; i++) {
        size_t count;
        ok = run(&params, &million_s[i], &count);
        printf("run %d: %zu trees, %.3f s a million\n", i + 1, count, million_s[i]);
    }
    if (ok)
        printf("place-million-s %.3f s\n", bench_median(million_s, RUNS));
    wd_terrain_finish(&terrain);
    return ok;
}
