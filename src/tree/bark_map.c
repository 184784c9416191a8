#include "shared/hash.h"
#include "tree/look_map.h"
#include "tree/look_point.h"
#include "tree/tile_noise.h"
#include "tree/vec.h"

/* What a pattern says of a point. */
struct bark_point {
    float plate;    /* 0 crack .. 1 plate */
    float shade;    /* factor of the plate's brightness */
    float dark;     /* share that has the crack's colour all the same: lenticels, scars */
    float height_m; /* of the relief */
    float roughness;
};

static int repeats(float over_m, float scale_cm)
{
    int count = (int)(over_m * 100 / scale_cm + 0.5f);
    return count < 2 ? 2 : count > 64 ? 64 : count;
}

/* The lattice place of `x`, brought back into [0, period). */
static float wrap(float x, int period)
{
    return x - floorf(x / (float)period) * (float)period;
}

/* Long ridges that part and join again, broken across here and there, each of corky layers. */
static struct bark_point fissured(uint32_t key, float u, float v, float scale_cm)
{
    int across = repeats(WD_BARK_TILE_WIDTH_M, scale_cm), along = across / 7 < 2 ? 2 : across / 7;
    float tall = (float)across * WD_BARK_TILE_HEIGHT_M / ((float)along * WD_BARK_TILE_WIDTH_M);
    float bend = 1.5f * (wd_tile_fractal(key, u, v, 5, 2) - 0.5f) +
                 0.5f * (wd_tile_fractal(key ^ 0x77, u, v, 30, 9) - 0.5f);
    float row = 2.5f * wd_tile_noise(key ^ 0x51, u * (float)across, 0, across, 1);
    uint32_t plate = 0;
    float joint = wd_tile_joint(key ^ 0xf15, wrap(u * (float)across + bend, across),
                                wrap(v * (float)along + row, along), across, along, tall, &plate);
    float rough = wd_tile_fractal(key ^ 0x9, u, v, 48, 16);
    float fine = wd_tile_fractal(key ^ 0x19, u, v, 160, 40);
    float ridge = wd_smoothf(0.02f, 0.36f, joint + 0.3f * (rough - 0.5f));
    float depth_m = 0.0032f * scale_cm;
    return (struct bark_point){ridge, 0.5f + 0.45f * rough + 0.4f * fine +
                                          0.2f * wd_hash_unit(plate), 0,
                               depth_m * (ridge * (0.8f + 0.2f * rough) + 0.16f * fine), 0.9f};
}

/* Flakes that lift at their lower edge, half as long again as wide. */
static struct bark_point scaly(uint32_t key, float u, float v, float scale_cm)
{
    int across = repeats(WD_BARK_TILE_WIDTH_M, scale_cm);
    int along = across * 4 / 9 < 2 ? 2 : across * 4 / 9;
    float bend_u = 0.10f * (wd_tile_fractal(key, u, v, 8, 8) - 0.5f) +
                   0.022f * (wd_tile_fractal(key ^ 0x33, u, v, 40, 40) - 0.5f);
    float bend_v = 0.10f * (wd_tile_fractal(key ^ 5, u, v, 8, 8) - 0.5f) +
                   0.022f * (wd_tile_fractal(key ^ 0x35, u, v, 40, 40) - 0.5f);
    uint32_t plate = 0;
    float edge = wd_tile_cells(key ^ 0x5ca, wrap((u + bend_u) * (float)across, across),
                               wrap((v + bend_v) * (float)along, along), across, along, &plate);
    float rough = wd_tile_fractal(key ^ 0x9, u, v, 40, 40);
    float fine = wd_tile_fractal(key ^ 0x19, u, v, 170, 90);
    float flake = wd_smoothf(0.02f, 0.16f, edge + 0.1f * (rough - 0.5f));
    float layer = wd_hash_unit(plate);
    float depth_m = 0.0009f * scale_cm;
    return (struct bark_point){flake, 0.6f + 0.3f * layer + 0.25f * rough + 0.25f * fine, 0,
                               depth_m * (flake * (0.55f + 0.45f * layer) + 0.3f * edge +
                                          0.25f * fine), 0.85f};
}

/* Thin grey skin: clouds of algae and lichen, wrinkles across, wart-like lenticels. */
static struct bark_point smooth(uint32_t key, float u, float v)
{
    float patches = wd_tile_fractal(key, u, v, 5, 4), lines = wd_tile_fractal(key ^ 3, u, v, 6, 60);
    float spots = wd_tile_noise(key ^ 7, u * 40, v * 50, 40, 50);
    float wart = wd_smoothf(0.88f, 1.0f, spots);
    float fine = wd_tile_fractal(key ^ 0x19, u, v, 120, 120);
    return (struct bark_point){wd_smoothf(0.10f, 0.35f, lines),
                               0.62f + 0.45f * patches + 0.1f * lines + 0.2f * fine, 0.35f * wart,
                               0.0012f * lines + 0.0006f * fine + 0.0012f * wart, 0.7f};
}

/* White skin with dark lenticels across, strips that peel, and rough black diamonds. */
static struct bark_point birch(uint32_t key, float u, float v)
{
    float line = wd_tile_noise(key, u * 7, v * 110, 7, 110);
    float long_line = wd_tile_noise(key ^ 1, u * 4, v * 60, 4, 60);
    float patch = wd_tile_fractal(key ^ 2, u, v, 4, 5);
    float ragged = wd_tile_fractal(key ^ 4, u, v, 24, 12);
    float scar = wd_smoothf(0.66f, 0.74f, patch + 0.25f * (ragged - 0.5f));
    float band = wd_tile_fractal(key ^ 8, u, v, 2, 9);
    float fine = wd_tile_fractal(key ^ 0x19, u, v, 20, 160);
    /* strips: steps of a height that falls slowly along the stem */
    float strip = band * 14 + 0.6f * ragged, step = strip - floorf(strip);
    float curl = wd_smoothf(0.82f, 0.98f, step);
    float lenticel = fmaxf(0.8f * wd_smoothf(0.80f, 0.92f, line),
                           0.55f * wd_smoothf(0.84f, 0.95f, long_line));
    return (struct bark_point){1, 0.76f + 0.22f * band + 0.12f * fine - 0.12f * curl,
                               fmaxf(lenticel, scar),
                               0.0006f * step + 0.0005f * lenticel + 0.0003f * fine +
                                   0.006f * scar * ragged,
                               wd_mixf(0.55f, 0.95f, scar)};
}

/* Scars of fallen fronds around a palm's stem, and cracks along it. */
static struct bark_point ringed(uint32_t key, float u, float v, float scale_cm)
{
    int rings = repeats(WD_BARK_TILE_HEIGHT_M, scale_cm);
    float sway = 0.9f * (wd_tile_fractal(key, u, v, 3, 2) - 0.5f) +
                 0.12f * (wd_tile_fractal(key ^ 3, u, v, 30, 8) - 0.5f);
    float place = v * (float)rings + sway, step = place - floorf(place);
    float groove = 1 - wd_smoothf(0.0f, 0.1f, step) * (1 - wd_smoothf(0.9f, 1.0f, step));
    float crack = wd_smoothf(0.72f, 0.86f, wd_tile_fractal(key ^ 6, u, v, 40, 5));
    float fine = wd_tile_fractal(key ^ 0x19, u, v, 120, 60);
    return (struct bark_point){1 - 0.75f * groove, 0.6f + 0.5f * fine + 0.25f * step,
                               0.7f * crack,
                               0.004f * step * (1 - groove) + 0.0012f * fine - 0.003f * crack,
                               0.85f};
}

/* Weathered wood: grain and drying cracks along the stem, turning slowly around it. */
static struct bark_point bare(uint32_t key, float u, float v)
{
    float turned = u + 0.04f * wd_tile_fractal(key, u, v, 3, 2);
    turned -= floorf(turned);
    float grain = wd_tile_fractal(key ^ 1, turned, v, 110, 3);
    float crack = wd_smoothf(0.66f, 0.78f, wd_tile_fractal(key ^ 2, turned, v, 34, 2));
    float stain = wd_tile_fractal(key ^ 3, u, v, 5, 4);
    return (struct bark_point){1 - crack, 0.55f + 0.5f * grain + 0.4f * stain, 0,
                               0.0015f * grain - 0.006f * crack, 0.8f};
}

static struct bark_point pattern_point(const struct wd_species *species, uint32_t key, float u,
                                       float v)
{
    float scale_cm = species->bark.scale_cm;
    switch (species->bark.pattern) {
    case WD_BARK_SCALY:
        return scaly(key, u, v, scale_cm);
    case WD_BARK_SMOOTH:
        return smooth(key, u, v);
    case WD_BARK_BIRCH:
        return birch(key, u, v);
    case WD_BARK_RINGED:
        return ringed(key, u, v, scale_cm);
    case WD_BARK_BARE:
        return bare(key, u, v);
    default:
        return fissured(key, u, v, scale_cm);
    }
}

struct wd_look_point wd_bark_point(const struct wd_species *species, float u, float v)
{
    uint32_t key = wd_hash2((uint32_t)species->bark.pattern, 0xba2c);
    struct bark_point point = pattern_point(species, key, u, v);
    struct wd_look_point look = {.height_m = point.height_m, .roughness = point.roughness,
                                 .coverage = 1, .through = 1};
    float plate[3];
    wd_look_color(species, WD_LOOK_BARK, plate);
    /* cracks keep their colour relative to the plates' own, not to the brightest part's */
    for (int i = 0; i < 3; i++) {
        float own = fmaxf(species->bark.color[i], 1e-4f);
        float crack = plate[i] * fminf(species->bark.crack_color[i] / own, 1);
        float light = wd_mixf(crack, plate[i] * point.shade, point.plate);
        look.albedo[i] = wd_mixf(light, crack, point.dark);
    }
    return look;
}
