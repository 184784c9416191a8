#include "world/far_sward.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "world/cover.h"

/* The first layer's, where several fade: the ground has one. */
static void set_fade(struct wd_far_sward *sward, const struct wd_scene *scene)
{
    for (size_t i = 0; i < scene->layer_count; i++) {
        const struct wd_scene_layer *layer = &scene->layers[i];
        if (layer->height_m[1] * 100 >= WD_CANOPY_CM || layer->fade_far_m[1] <= 0)
            continue;
        for (int k = 0; k < 2; k++)
            sward->fade_m[k] = (float)layer->fade_far_m[k];
        return;
    }
}

/* Of leaves that lie too deep for light to reach the ground, by how much of it one reflects and lets through
 * (Hapke, Theory of Reflectance and Emittance Spectroscopy, 1993: isotropic scatterers, two streams). */
static double deep_albedo(double leaf)
{
    double absorbed = sqrt(1 - fmin(leaf, 0.99));
    return (1 - absorbed) / (1 + absorbed);
}

static bool fades(const struct wd_scene *scene, const struct wd_world *world, size_t tree)
{
    uint32_t layer = world->layer_of_tree[tree];
    return layer < scene->layer_count && scene->layers[layer].fade_far_m[1] > 0;
}

static void set_albedo(struct wd_far_sward *sward, const struct wd_scene *scene, const double *areas, double all)
{
    for (size_t i = 0; i < scene->species_file_count; i++)
        for (int k = 0; k < 3; k++) {
            double leaf = (double)(scene->species[i].leaf.color[k] + scene->species[i].leaf.transmittance[k]);
            sward->albedo[k] += (float)(areas[i] / all * deep_albedo(leaf));
        }
}

void wd_far_sward_init(struct wd_world *world, const struct wd_scene *scene)
{
    struct wd_far_sward *sward = &world->far_sward;
    double all = 0, fading = 0, *areas = wd_alloc_array(scene->species_file_count + 1, sizeof *areas);
    *sward = (struct wd_far_sward){0};
    for (size_t i = 0; i < world->tree_count; i++) {
        const struct wd_tree *tree = &world->trees[i];
        double crown_m = (double)WD_TREE_CROWN_M(*tree), own = crown_m * crown_m;
        if (WD_TREE_HEIGHT_CM(*tree) >= WD_CANOPY_CM)
            continue;
        all += own;
        if (fades(scene, world, i)) {
            fading += own;
            areas[WD_TREE_SPECIES(*tree)] += own;
        }
    }
    if (fading > 0) {
        sward->share = (float)(fading / all);
        set_albedo(sward, scene, areas, fading);
    }
    set_fade(sward, scene);
    free(areas);
}

float wd_sward_layers_at(const struct wd_world *world, double x_m, double y_m)
{
    return world->sward ? wd_cover_grid_at(world, world->sward, x_m, y_m) / WD_SWARD_LAYER : 0;
}
