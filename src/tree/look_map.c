#include "tree/look_map.h"

#include <stdlib.h>

#include "base/color.h"
#include "base/memory.h"
#include "tree/import.h"
#include "tree/leaf_outline.h"
#include "tree/look.h"
#include "tree/look_point.h"
#include "tree/vec.h"

/* A wall within one texel says nothing of the surface beside it. */
#define STEEPEST 2.0f

/* Bark's cracks and plates have edges sharper than texels, which are means of places: so many each way, and no more than
 * so many in a tile, which finer maps show by themselves. */
enum { BARK_PLACES = 3, BARK_TILE_PLACES = 768 };

/* Everything of a layer before it is put into bytes. */
struct canvas {
    const struct wd_species *species;
    uint32_t layer;
    uint32_t size;
    struct wd_look_point *points;
};

/* Needles stand all around their shoot, whose sides show as many upper faces as lower ones: each face
 * is their mean, or shoots drawn as one sheet would be darker from above than with all needles. */
static float leaf_color(const struct wd_species *species, bool back, int channel)
{
    float upper = species->leaf.color[channel], lower = species->leaf.back_color[channel];
    return species->leaf.shape == WD_LEAF_NEEDLES ? 0.5f * (upper + lower) : back ? lower : upper;
}

void wd_look_color(const struct wd_species *species, uint32_t layer, float color[3])
{
    if (layer == WD_LOOK_BARK) {
        wd_bark_texture_color(species, color);
        return;
    }
    for (int i = 0; i < 3; i++)
        color[i] = layer == WD_LOOK_FLOWER
                       ? species->flower.color[i]
                       : leaf_color(species, layer == WD_LOOK_LEAF_BACK, i) / WD_LEAF_TINT_MEAN;
}

/* The lower side: veins stand out, colour is paler and more even. */
static struct wd_look_point back_point(const struct wd_species *species, float u, float v,
                                       float soft)
{
    struct wd_look_point point = wd_leaf_point(species, u, v, soft);
    point.height_m *= -1.6f;
    point.roughness = 0.75f;
    for (int i = 0; i < 3; i++) {
        float shade = species->leaf.color[i] > 0 ? point.albedo[i] / species->leaf.color[i] : 1;
        point.albedo[i] = species->leaf.back_color[i] * (0.35f + 0.65f * shade);
    }
    return point;
}

static struct wd_look_point layer_point(const struct canvas *canvas, float u, float v)
{
    float soft = 1 / (float)canvas->size;
    switch (canvas->layer) {
    case WD_LOOK_BARK:
        return wd_bark_point(canvas->species, u, v);
    case WD_LOOK_LEAF_BACK:
        return back_point(canvas->species, u, v, soft);
    case WD_LOOK_FLOWER:
        return wd_flower_point(canvas->species, u, v, soft);
    default:
        return wd_leaf_point(canvas->species, u, v, soft);
    }
}

static void add_point(struct wd_look_point *sum, const struct wd_look_point *point, float weight)
{
    for (int i = 0; i < 3; i++)
        sum->albedo[i] += weight * point->albedo[i];
    sum->height_m += weight * point->height_m;
    sum->roughness += weight * point->roughness;
    sum->coverage += weight * point->coverage;
    sum->through += weight * point->through;
}

static struct wd_look_point texel_point(const struct canvas *canvas, uint32_t x, uint32_t y)
{
    bool bark = canvas->layer == WD_LOOK_BARK && BARK_PLACES * canvas->size <= BARK_TILE_PLACES;
    int places = bark ? BARK_PLACES : 1;
    float step = 1 / (float)places, size = (float)canvas->size;
    struct wd_look_point mean = {0};
    for (int i = 0; i < places * places; i++) {
        float u = ((float)x + ((float)(i % places) + 0.5f) * step) / size;
        float v = ((float)y + ((float)(i / places) + 0.5f) * step) / size;
        struct wd_look_point point = layer_point(canvas, u, v);
        add_point(&mean, &point, step * step);
    }
    return mean;
}

/* Metres that the square covers. */
static void layer_extent(const struct canvas *canvas, float extent_m[2])
{
    const struct wd_species *species = canvas->species;
    if (canvas->layer == WD_LOOK_BARK) {
        extent_m[0] = WD_BARK_TILE_WIDTH_M;
        extent_m[1] = WD_BARK_TILE_HEIGHT_M;
    } else if (canvas->layer == WD_LOOK_FLOWER) {
        extent_m[0] = extent_m[1] = fmaxf(0.005f * species->flower.size_cm, 0.005f);
    } else {
        struct wd_leaf_size size = wd_leaf_blade_size(species);
        extent_m[0] = size.width_m;
        extent_m[1] = size.length_m;
    }
}

/* Scales albedo and light let through to their wanted means over what the outline covers. */
static void set_means(struct canvas *canvas)
{
    double sum[3] = {0}, through = 0, weight = 0;
    size_t count = (size_t)canvas->size * canvas->size;
    for (size_t i = 0; i < count; i++) {
        const struct wd_look_point *point = &canvas->points[i];
        for (int k = 0; k < 3; k++)
            sum[k] += (double)(point->coverage * point->albedo[k]);
        through += (double)(point->coverage * point->through);
        weight += (double)point->coverage;
    }
    float wanted[3];
    wd_look_color(canvas->species, canvas->layer, wanted);
    for (size_t i = 0; i < count && weight > 0; i++) {
        struct wd_look_point *point = &canvas->points[i];
        for (int k = 0; k < 3; k++)
            point->albedo[k] *= sum[k] > 0 ? (float)((double)wanted[k] * weight / sum[k]) : 0;
        point->through *= (float)(weight / through);
    }
}

/* Height at a texel; bark goes on at the other side, a leaf ends at the border. */
static float height_at(const struct canvas *canvas, int x, int y)
{
    int size = (int)canvas->size;
    if (canvas->layer == WD_LOOK_BARK) {
        x = (x + size) % size;
        y = (y + size) % size;
    }
    x = x < 0 ? 0 : x >= size ? size - 1 : x;
    y = y < 0 ? 0 : y >= size ? size - 1 : y;
    return canvas->points[(size_t)y * canvas->size + (size_t)x].height_m;
}

static struct wd_vec3 normal_at(const struct canvas *canvas, const float texel_m[2], int x, int y)
{
    float dx = height_at(canvas, x + 1, y) - height_at(canvas, x - 1, y);
    float dy = height_at(canvas, x, y + 1) - height_at(canvas, x, y - 1);
    dx /= 2 * texel_m[0];
    dy /= 2 * texel_m[1];
    float steep = sqrtf(dx * dx + dy * dy), limit = steep > STEEPEST ? STEEPEST / steep : 1;
    return wd_v3_unit(WD_V3(-dx * limit, -dy * limit, 1));
}

/* What to multiply a texel's albedo by where light comes through, so that what is let through is
 * the same from both sides. */
static float through_over_albedo(const struct canvas *canvas, const struct wd_look_point *point)
{
    float front[3];
    wd_look_color(canvas->species, WD_LOOK_LEAF, front);
    return point->albedo[1] > 0 ? point->through * front[1] / point->albedo[1] : 1;
}

struct range {
    float low, high;
};

static struct range height_range(const struct canvas *canvas)
{
    struct range range = {1e9f, -1e9f};
    for (size_t i = 0; i < (size_t)canvas->size * canvas->size; i++) {
        range.low = fminf(range.low, canvas->points[i].height_m);
        range.high = fmaxf(range.high, canvas->points[i].height_m);
    }
    return range;
}

static void encode(const struct canvas *canvas, const struct wd_look_map *map)
{
    float texel_m[2];
    struct range heights = height_range(canvas);
    float over = heights.high > heights.low ? 1 / (heights.high - heights.low) : 0;
    layer_extent(canvas, texel_m);
    for (int i = 0; i < 2; i++)
        texel_m[i] /= (float)canvas->size;
    for (uint32_t i = 0; i < canvas->size * canvas->size; i++) {
        const struct wd_look_point *point = &canvas->points[i];
        uint8_t *albedo = &map->albedo[4 * i], *detail = &map->detail[4 * i];
        struct wd_vec3 n = normal_at(canvas, texel_m, (int)(i % canvas->size),
                                     (int)(i / canvas->size));
        for (int k = 0; k < 3; k++)
            albedo[k] = wd_srgb_encode(wd_clampf(point->albedo[k], 0, 1));
        albedo[3] = wd_unorm_encode(point->coverage);
        detail[0] = wd_unorm_encode(0.5f * n.x + 0.5f);
        detail[1] = wd_unorm_encode(0.5f * n.y + 0.5f);
        detail[2] = wd_unorm_encode(wd_clampf(point->roughness, 0, 1));
        float rest = canvas->layer == WD_LOOK_BARK ? (point->height_m - heights.low) * over
                                                   : 0.5f * through_over_albedo(canvas, point);
        detail[3] = wd_unorm_encode(wd_clampf(rest, 0, 1));
    }
}

void wd_look_map_fill(const struct wd_look_map *map, const struct wd_species *species,
                      uint32_t layer)
{
    struct canvas canvas = {species, layer, map->size, NULL};
    if (species->imported) {
        wd_tree_import_look(species->imported, map, layer);
        return;
    }
    canvas.points = wd_alloc_array((size_t)map->size * map->size, sizeof *canvas.points);
    for (uint32_t i = 0; i < map->size * map->size; i++)
        canvas.points[i] = texel_point(&canvas, i % map->size, i / map->size);
    set_means(&canvas);
    encode(&canvas, map);
    free(canvas.points);
}
