#include "world/far_sward.h"

#include <math.h>

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

void wd_far_sward_init(struct wd_world *world, const struct wd_scene *scene)
{
    struct wd_far_sward *sward = &world->far_sward;
    double area = 0, fading = 0, sums[3] = {0};
    *sward = (struct wd_far_sward){0};
    for (size_t i = 0; i < world->tree_count; i++) {
        const struct wd_tree *tree = &world->trees[i];
        double crown_m = WD_TREE_CROWN_M(*tree), own = crown_m * crown_m;
        if ((tree->size & 0xffffu) >= WD_CANOPY_CM)
            continue;
        area += own;
        if (!fades(scene, world, i))
            continue;
        const struct wd_species *species = &scene->species[WD_TREE_SPECIES(*tree)];
        fading += own;
        for (int k = 0; k < 3; k++)
            sums[k] += own * deep_albedo((double)(species->leaf.color[k] + species->leaf.transmittance[k]));
    }
    for (int k = 0; k < 3 && fading > 0; k++)
        sward->albedo[k] = (float)(sums[k] / fading);
    sward->share = fading > 0 ? (float)(fading / area) : 0;
    set_fade(sward, scene);
}

float wd_sward_layers_at(const struct wd_world *world, double x_m, double y_m)
{
    return world->sward ? wd_cover_grid_at(world, world->sward, x_m, y_m) / WD_SWARD_LAYER : 0;
}
