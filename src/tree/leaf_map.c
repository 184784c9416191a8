#include "shared/hash.h"
#include "tree/leaf_outline.h"
#include "tree/look.h"
#include "tree/look_map.h"
#include "tree/look_point.h"
#include "tree/tile_noise.h"
#include "tree/vec.h"

/* How strongly a place is midrib, side vein, or of the net between them: 0..1 each. */
struct veins {
    float midrib, side, net;
};

/* 1 on the line, 0 `width` away from it. */
static float line(float distance, float width)
{
    return 1 - wd_smoothf(0.25f * width, width, distance);
}

/* Side veins rise from the midrib in pairs and bend forward toward the edge. */
static float pinnate_veins(const struct wd_leaf_outline *shape, float across, float y)
{
    float from = y - shape->vein_rise * across * (1 + 0.5f * across);
    float place = from * (shape->vein_pairs + 1), near = fabsf(place - floorf(place) - 0.5f);
    if (from < 0.02f || from > 0.97f)
        return 0;
    return line(near / (shape->vein_pairs + 1), 0.014f * (1.1f - 0.6f * across));
}

/* Main veins run from the foot into the lobes, or spread evenly where there are none. */
static float palmate_veins(const struct wd_leaf_outline *shape, float across, float y)
{
    float strength = 0;
    int pairs = (int)shape->vein_pairs;
    for (int i = 0; i < pairs; i++) {
        float tip_x = i ? 1 : 0.62f, tip_y = i ? 0.56f : 0.04f;
        if (shape->count == 4) { /* a heart: side veins rise in bows */
            tip_x = 0.95f - 0.12f * (float)i;
            tip_y = 0.16f + 0.2f * (float)i;
        }
        float start = shape->count == 4 ? 0.14f * (float)i : 0;
        float dx = tip_x, dy = tip_y - shape->foot - start, length = sqrtf(dx * dx + dy * dy);
        float along = (across * dx + (y - shape->foot - start) * dy) / length;
        float off = fabsf(across * dy - (y - shape->foot - start) * dx) / length;
        if (along > 0 && along < length)
            strength = fmaxf(strength, line(0.5f * off, 0.016f * (1.15f - 0.6f * along / length)));
    }
    return strength;
}

static struct veins veins_at(const struct wd_leaf_outline *shape, uint32_t key, float u, float v)
{
    float across = fabsf(u - 0.5f) * 2;
    struct veins veins = {.midrib = line(0.5f * across, 0.026f * (1.15f - 0.75f * v))};
    if (shape->veins == WD_VEINS_PARALLEL) {
        float place = across * shape->vein_pairs, near = fabsf(place - floorf(place) - 0.5f) * 2;
        veins.side = 0.6f * line(1 - near, 0.45f);
        return veins;
    }
    veins.side = shape->veins == WD_VEINS_PALMATE ? palmate_veins(shape, across, v)
                                                  : pinnate_veins(shape, across, v);
    uint32_t cell;
    float bend = 0.5f * wd_tile_noise(key ^ 1, u * 24, v * 30, 24, 30);
    veins.net = line(wd_tile_cells(key, u * 26 + bend, v * 34, 27, 34, &cell), 0.3f);
    return veins;
}

/* Height of the upper side: veins sunk, the fields between them arched. */
static float relief_m(const struct veins *veins, float length_m)
{
    float sunk = fmaxf(veins->midrib, fmaxf(0.6f * veins->side, 0.22f * veins->net));
    return -0.006f * length_m * sunk;
}

struct wd_look_point wd_leaf_point(const struct wd_species *species, float u, float v, float soft)
{
    const struct wd_leaf_outline *shape = wd_leaf_outline_of(species);
    uint32_t key = wd_hash2((uint32_t)species->leaf.shape, 0x1eaf);
    struct wd_leaf_size size = wd_leaf_blade_size(species);
    float width = size.width_m / size.length_m;
    float inside = wd_leaf_outline_inside(shape, width, (u - 0.5f) * width, v);
    struct veins veins = veins_at(shape, key, u, v);
    float mottle = wd_tile_fractal(key ^ 0x9, u, v, 10, 10);
    float fine = wd_tile_fractal(key ^ 0x19, u, v, 60, 60);
    float edge = inside > 0 ? line(inside, 0.02f) : 1;
    float shade = 0.86f + 0.16f * mottle + 0.08f * fine + 0.10f * veins.net - 0.08f * edge;
    shade += 0.55f * veins.midrib + 0.26f * veins.side;
    float pale = 0.3f * fmaxf(veins.midrib, 0.6f * veins.side);
    struct wd_look_point point = {
        .height_m = relief_m(&veins, size.length_m),
        .roughness = wd_leaf_roughness(species) + 0.12f * veins.side +
                     0.06f * (fine - 0.5f),
        .coverage = wd_clampf(0.5f + inside / fmaxf(soft, 1e-6f), 0, 1),
        /* thick veins are dark against the light */
        .through = fmaxf(1.06f - 0.75f * veins.midrib - 0.5f * veins.side - 0.14f * veins.net, 0.1f),
    };
    const float yellow[3] = {1.25f, 1.0f, 0.95f};
    for (int i = 0; i < 3; i++)
        point.albedo[i] = species->leaf.color[i] * shade * wd_mixf(1, yellow[i], pale);
    return point;
}

/* A petal from the flower's middle (v = 0) to its rim; of a panicle, many small florets. */
struct wd_look_point wd_flower_point(const struct wd_species *species, float u, float v, float soft)
{
    const uint32_t key = 0xf10e;
    float across = fabsf(u - 0.5f) * 2;
    float rim = 1 - across * across * (0.4f + 0.6f * (1 - v)) - v * v * v * 0.12f;
    float streak = wd_tile_fractal(key, u, v, 24, 3), mottle = wd_tile_fractal(key ^ 1, u, v, 7, 7);
    float center = species->flower.petals ? 1 - wd_smoothf(0.08f, 0.2f, v)
                                          : wd_smoothf(0.62f, 0.72f, mottle);
    struct wd_look_point point = {
        .height_m = 0.0006f * streak + 0.002f * across * across,
        .roughness = 0.6f,
        .coverage = wd_clampf(0.5f + 0.5f * rim / fmaxf(soft, 1e-6f), 0, 1),
        .through = 0.9f + 0.2f * streak,
    };
    for (int i = 0; i < 3; i++)
        point.albedo[i] = wd_mixf(species->flower.color[i] * (0.82f + 0.14f * streak +
                                                              0.14f * mottle + 0.06f * v),
                                  species->flower.center_color[i], center);
    return point;
}
