/* tree-preview SPECIES.json OUT.png [key=value ...]: a grown tree as full and reduced mesh, near,
 * at 100 m and at 500 m (as on a screen of 1080 lines with 60 degrees), beside a 2 m bar.
 * Keys: seed, height, openness, detail, elevation (degrees), near (pixels a metre of the large
 * picture), rise (metres of the tree below the large picture's lower edge), hedge (height of a box
 * to clip to). */
#include <math.h>
#include <spng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/color.h"
#include "base/memory.h"
#include "raster.h"
#include "tree/look_map.h"

enum { SAMPLES = 2, TEXTURE = 512 };

struct options {
    struct wd_grow_params params;
    float elevation_deg, near, rise, hedge_m;
    struct wd_clip_volume clip;
};

static bool read_option(struct options *options, const char *text)
{
    const struct {
        const char *name;
        float *value;
    } keys[] = {{"height=", &options->params.height_m}, {"openness=", &options->params.openness},
                {"detail=", &options->params.detail}, {"elevation=", &options->elevation_deg},
                {"near=", &options->near}, {"rise=", &options->rise},
                {"hedge=", &options->hedge_m}};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (!strncmp(text, keys[i].name, strlen(keys[i].name))) {
            *keys[i].value = strtof(text + strlen(keys[i].name), NULL);
            return true;
        }
    if (strncmp(text, "seed=", 5))
        return false;
    options->params.seed = (uint32_t)strtoul(text + 5, NULL, 10);
    return true;
}

static void paint_ground(struct wd_raster *raster, int horizon)
{
    for (int y = 0; y < raster->height; y++)
        for (int x = 0; x < raster->width; x++) {
            float *rgb = &raster->rgb[3 * ((size_t)y * (size_t)raster->width + (size_t)x)];
            float t = (float)y / (float)raster->height;
            const float sky[3] = {0.14f + 0.12f * t, 0.22f + 0.12f * t, 0.36f + 0.1f * t};
            const float grass[3] = {0.08f, 0.10f, 0.04f};
            memcpy(rgb, y < horizon ? sky : grass, sizeof sky);
        }
}

static void paint_bar(struct wd_raster *raster, float x, float y, float pixels_per_m)
{
    int x0 = (int)x, x1 = (int)(x + fmaxf(0.4f * pixels_per_m, 1));
    for (int row = (int)(y - 2 * pixels_per_m); row < (int)y; row++)
        for (int column = x0; column <= x1; column++)
            if (row >= 0 && column >= 0 && row < raster->height && column < raster->width) {
                float *rgb = &raster->rgb[3 * ((size_t)row * (size_t)raster->width +
                                               (size_t)column)];
                rgb[0] = 0.7f, rgb[1] = 0.1f, rgb[2] = 0.05f;
            }
}

static bool write_png(const char *path, const struct wd_raster *raster)
{
    int width = raster->width / SAMPLES, height = raster->height / SAMPLES;
    size_t size = (size_t)width * (size_t)height * 3;
    uint8_t *pixels = wd_alloc(size);
    for (size_t i = 0; i < size; i++) {
        size_t x = i / 3 % (size_t)width * SAMPLES, y = i / 3 / (size_t)width * SAMPLES;
        float sum = 0;
        for (size_t j = 0; j < SAMPLES * SAMPLES; j++) {
            size_t at = (y + j / SAMPLES) * (size_t)raster->width + x + j % SAMPLES;
            float light = 2.0f * raster->rgb[3 * at + i % 3];
            sum += light * (2.51f * light + 0.03f) / (light * (2.43f * light + 0.59f) + 0.14f);
        }
        pixels[i] = wd_srgb_encode(fminf(sum / (SAMPLES * SAMPLES), 1));
    }
    FILE *file = fopen(path, "wb");
    spng_ctx *context = spng_ctx_new(SPNG_CTX_ENCODER);
    struct spng_ihdr header = {.width = (uint32_t)width, .height = (uint32_t)height,
                               .bit_depth = 8, .color_type = SPNG_COLOR_TYPE_TRUECOLOR};
    bool ok = file && !spng_set_png_file(context, file) && !spng_set_ihdr(context, &header) &&
              !spng_encode_image(context, pixels, size, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    spng_ctx_free(context);
    free(pixels);
    return (!file || fclose(file) == 0) && ok;
}

static void paint_all(struct wd_raster *raster, const struct wd_tree_model *model,
                      const struct wd_raster_looks *looks, const struct options *options)
{
    float ground = 0.965f * (float)raster->height, width = (float)raster->width;
    float fit = 0.92f * (float)raster->height / model->height_m;
    float near = options->near > 0 ? options->near * SAMPLES : fit;
    const struct {
        const struct wd_tree_mesh *mesh;
        float x, scale, rise;
    } panels[] = {{&model->full, 0.24f, near, options->rise},
                  {&model->full, 0.57f, 0.5f * fit, 0},
                  {&model->reduced, 0.75f, 0.5f * fit, 0},
                  {&model->full, 0.86f, 9.35f * SAMPLES, 0},
                  {&model->reduced, 0.93f, 9.35f * SAMPLES, 0},
                  {&model->full, 0.97f, 1.87f * SAMPLES, 0},
                  {&model->reduced, 0.988f, 1.87f * SAMPLES, 0}};
    for (size_t i = 0; i < sizeof panels / sizeof *panels; i++) {
        float foot = ground + panels[i].rise * panels[i].scale;
        struct wd_raster_view view = {panels[i].x * width, foot, panels[i].scale, 0.7f,
                                      options->elevation_deg * 0.01745329f};
        float offset = fminf(0.75f * model->crown_radius_m, 3.0f) * panels[i].scale;
        paint_bar(raster, view.x - offset, foot, panels[i].scale);
        wd_raster_tree(raster, panels[i].mesh, looks, &view);
    }
}

static void paint_swatches(struct wd_raster *raster, const struct wd_raster_looks *looks)
{
    enum { SIZE = 150 * SAMPLES };
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < 2 * SIZE; x++) {
            const uint8_t *look = x < SIZE ? looks->bark : looks->leaf;
            size_t tx = (size_t)(x % SIZE) * TEXTURE / SIZE, ty = (size_t)y * TEXTURE / SIZE;
            size_t at = (size_t)(y + 8) * (size_t)raster->width +
                        (size_t)(raster->width - 2 * SIZE - 8 + x);
            for (size_t i = 0; i < 3; i++)
                raster->rgb[3 * at + i] =
                    2 * wd_srgb_decode(look[4 * (ty * TEXTURE + tx) + i]);
        }
}

static void print_figures(const struct wd_tree_model *model, double seconds)
{
    double crown = 3.14159265 * (double)(model->crown_radius_m * model->crown_radius_m);
    printf("full %u wood + %u leaf triangles, reduced %u + %u, %.1f ms\n",
           model->full.wood_index_count / 3,
           (model->full.index_count - model->full.wood_index_count) / 3,
           model->reduced.wood_index_count / 3,
           (model->reduced.index_count - model->reduced.wood_index_count) / 3, seconds * 1e3);
    printf("height %.1f m, dbh %.1f cm, crown radius %.2f m, base %.1f m, leaf area %.0f m2, "
           "LAI %.1f\n",
           (double)model->height_m, 100 * (double)model->dbh_m, (double)model->crown_radius_m,
           (double)model->crown_base_m, (double)model->leaf_area_m2,
           (double)model->leaf_area_m2 / crown);
}

static void fill_albedo(const struct wd_species *species, uint32_t layer, uint8_t *rgba)
{
    struct wd_look_map map = {TEXTURE, rgba, wd_alloc_array((size_t)TEXTURE * TEXTURE, 4)};
    wd_look_map_fill(&map, species, layer);
    free(map.detail);
    for (size_t i = 0; i < (size_t)TEXTURE * TEXTURE; i++)
        rgba[4 * i + 3] = 255;
}

int main(int argc, char **argv)
{
    struct options options = {.params = {.seed = 1}};
    for (int i = 3; i < argc; i++)
        if (!read_option(&options, argv[i]))
            argc = 0;
    if (argc < 3) {
        fprintf(stderr, "usage: tree-preview SPECIES.json OUT.png [seed=N] [height=M] "
                        "[openness=0..1] [detail=X] [elevation=DEG] [near=PX_PER_M] [rise=M] [hedge=M]\n");
        return 2;
    }
    float half = 0.4f * options.hedge_m;
    options.clip = (struct wd_clip_volume){.min_m = {-half, -half, 0.03f},
                                           .max_m = {half, half, options.hedge_m}};
    options.params.clip = half > 0 ? &options.clip : NULL;
    struct wd_arena arena = {0};
    struct wd_species species;
    struct wd_tree_model model = {0};
    bool ok = wd_species_load(&species, argv[1], &arena, NULL);
    double start = wd_clock_s();
    ok = ok && wd_tree_grow(&model, &species, &options.params, NULL);
    if (ok) {
        print_figures(&model, wd_clock_s() - start);
        struct wd_raster_looks looks = {TEXTURE, wd_alloc(4 * TEXTURE * TEXTURE),
                                        wd_alloc(4 * TEXTURE * TEXTURE), &species};
        fill_albedo(&species, WD_LOOK_BARK, looks.bark);
        fill_albedo(&species, WD_LOOK_LEAF, looks.leaf);
        struct wd_raster raster;
        wd_raster_init(&raster, 1600 * SAMPLES, 900 * SAMPLES);
        paint_ground(&raster, 850 * SAMPLES);
        paint_all(&raster, &model, &looks, &options);
        paint_swatches(&raster, &looks);
        ok = write_png(argv[2], &raster);
        wd_raster_finish(&raster);
        free(looks.bark);
        free(looks.leaf);
    }
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
    return ok ? 0 : 1;
}
