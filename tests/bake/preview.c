/* preview-bake SPECIES.json OUT.png [rings|octahedral|even ROWS [COLUMNS]] [size=N] [samples=N]
 * [mip=N]: a view set of a grown tree, its three planes side by side (coverage over grey). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/cards.h"
#include "bake/views.h"
#include "base/clock.h"
#include "base/memory.h"
#include "device_mesh.h"
#include "output/image.h"
#include "tree/look_map.h"

struct options {
    struct wd_view_set_params params;
    uint32_t mip;
};

static void read_options(struct options *options, int count, char **texts)
{
    static const char *const kinds[] = {"even", "rings", "octahedral"};
    for (int i = 0; i < count; i++) {
        for (uint32_t kind = 0; kind < 3; kind++)
            if (strcmp(texts[i], kinds[kind]) == 0 && i + 1 < count) {
                options->params.hemisphere.kind = kind;
                options->params.hemisphere.rows = (uint32_t)atoi(texts[i + 1]);
                if (kind == WD_VIEWS_RINGS && i + 2 < count)
                    options->params.hemisphere.columns = (uint32_t)atoi(texts[i + 2]);
            }
        if (strncmp(texts[i], "size=", 5) == 0)
            options->params.size = (uint32_t)atoi(texts[i] + 5);
        if (strncmp(texts[i], "samples=", 8) == 0)
            options->params.samples = (uint32_t)atoi(texts[i] + 8);
        if (strncmp(texts[i], "mip=", 4) == 0)
            options->mip = (uint32_t)atoi(texts[i] + 4);
    }
}

static bool write_planes(const struct wd_view_set *set, uint32_t mip, const char *path)
{
    uint32_t side = wd_view_layer_size(&set->atlas, mip), width = WD_PLANES * side;
    size_t offset = wd_view_mip_offset(&set->atlas, mip);
    uint8_t *rgb = wd_alloc((size_t)3 * width * side);
    const uint8_t *albedo = set->planes[WD_PLANE_ALBEDO] + offset;
    for (uint32_t y = 0; y < side; y++) {
        for (uint32_t x = 0; x < width; x++) {
            size_t at = 4 * ((size_t)y * side + x % side);
            uint8_t *to = rgb + 3 * ((size_t)y * width + x);
            for (size_t k = 0; k < 3; k++)
                to[k] = (uint8_t)((set->planes[x / side][offset + at + k] * albedo[at + 3] +
                                   128 * (255 - albedo[at + 3])) / 255);
        }
    }
    bool ok = wd_png_write(path, rgb, width, side, NULL);
    free(rgb);
    return ok;
}

static bool bake(struct wd_gpu *gpu, const struct wd_tree_model *model, const uint8_t *looks,
                 struct options *options, const char *path)
{
    struct wd_baker baker = {0};
    struct device_mesh device = {0};
    struct wd_view_atlas atlas;
    struct wd_view_set set;
    const struct wd_card_extent extent = wd_card_extent_of(&model->full);
    const struct wd_view_model bounds = {extent.half_width_m, extent.bottom_m, extent.top_m, 0};
    bool ok = wd_view_atlas_init(&atlas, &options->params, gpu, NULL) &&
              wd_baker_init(&baker, gpu, NULL) &&
              device_mesh_init(&device, gpu, &model->full, looks, WD_LOOK_SIZE);
    double start = wd_clock_s();
    ok = ok && wd_view_set_bake(&set, &baker, &device.mesh, &bounds, &atlas, &options->params);
    if (ok) {
        printf("%u triangles, %u views of %u texels: %.2f s\n", model->full.index_count / 3,
               wd_hemisphere_count(atlas.hemisphere), atlas.size, wd_clock_s() - start);
        ok = write_planes(&set, options->mip, path);
        wd_view_set_finish(&set);
    }
    device_mesh_finish(&device, gpu);
    wd_baker_finish(&baker);
    return ok;
}

int main(int argc, char **argv)
{
    struct wd_arena arena = {0};
    struct wd_species species;
    struct wd_tree_model model = {0};
    struct wd_gpu gpu = {0};
    struct options options = {0};
    const struct wd_gpu_params params = {.name = "software"};
    size_t map_bytes = (size_t)4 * WD_LOOK_SIZE * WD_LOOK_SIZE;
    uint8_t *looks = wd_alloc(2 * map_bytes), *details = wd_alloc(map_bytes);
    if (argc < 3) {
        fprintf(stderr, "usage: preview-bake SPECIES.json OUT.png [OPTIONS]\n");
        return 2;
    }
    read_options(&options, argc - 3, argv + 3);
    bool ok = wd_species_load(&species, argv[1], &arena, NULL) &&
              wd_tree_grow(&model, &species, &(struct wd_grow_params){.seed = 1, .openness = 0.35f},
                           NULL) &&
              wd_gpu_init(&gpu, &params, NULL);
    for (uint32_t layer = 0; layer < 2 && ok; layer++) {
        const struct wd_look_map map = {WD_LOOK_SIZE, looks + layer * map_bytes, details};
        wd_look_map_fill(&map, &species, layer);
    }
    ok = ok && bake(&gpu, &model, looks, &options, argv[2]);
    wd_gpu_finish(&gpu);
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
    free(looks);
    free(details);
    return ok ? 0 : 1;
}
