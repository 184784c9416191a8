#include "tree/grow.h"

#include "base/color.h"
#include "tree/look.h"
#include "tree/random.h"

/* Value noise that repeats after `period` lattice steps along each axis, 0..1. */
static float tile_noise(uint32_t key, float x, float y, int period_x, int period_y)
{
    float fx = floorf(x), fy = floorf(y), u = x - fx, v = y - fy, row[2];
    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    for (int j = 0; j < 2; j++) {
        float value[2];
        for (int i = 0; i < 2; i++) {
            int cx = ((int)fx + i) % period_x, cy = ((int)fy + j) % period_y;
            cx += cx < 0 ? period_x : 0;
            cy += cy < 0 ? period_y : 0;
            value[i] = wd_hash_unit(wd_hash3(key, (uint32_t)cx, (uint32_t)cy));
        }
        row[j] = wd_mixf(value[0], value[1], u);
    }
    return wd_mixf(row[0], row[1], v);
}

/* Four octaves over the unit square, tileable; `nx`, `ny`: lattice steps of the first. */
static float tile_fractal(uint32_t key, float u, float v, int nx, int ny)
{
    float sum = 0, share = 0.5f;
    for (uint32_t octave = 0; octave < 4; octave++) {
        sum += share * tile_noise(key + octave, u * (float)nx, v * (float)ny, nx, ny);
        nx *= 2;
        ny *= 2;
        share *= 0.5f;
    }
    return sum / 0.9375f;
}

struct bark_point {
    float plate;   /* 0 crack .. 1 plate */
    float shade;   /* factor of the plate's brightness */
    float dark;    /* birch: lenticels and black diamonds */
};

/* Distances to the nearest and second nearest of jittered points on a tiled grid: their difference
 * draws the joints between plates. *which names the plate. */
static float cell_edge(uint32_t key, float x, float y, int nx, int ny, uint32_t *which)
{
    float first = 1e9f, second = 1e9f;
    int cx = (int)floorf(x), cy = (int)floorf(y);
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            uint32_t tx = (uint32_t)((cx + i + nx) % nx), ty = (uint32_t)((cy + j + ny) % ny);
            uint32_t h = wd_hash3(key, tx, ty);
            float px = (float)(cx + i) + 0.15f + 0.7f * wd_hash_unit(h);
            float py = (float)(cy + j) + 0.15f + 0.7f * wd_hash_unit(wd_hash1(h));
            float d = sqrtf((px - x) * (px - x) + (py - y) * (py - y));
            if (d < first) {
                second = first;
                first = d;
                *which = h;
            } else if (d < second) {
                second = d;
            }
        }
    return second - first;
}

static int repeats(float over_m, float scale_cm)
{
    int count = (int)(over_m * 100 / scale_cm + 0.5f);
    return count < 2 ? 2 : count > 64 ? 64 : count;
}

/* Long ridges that part and join again, broken across here and there. */
static struct bark_point fissured(uint32_t key, float u, float v, int across)
{
    float bend = 2.2f * (tile_fractal(key, u, v, 5, 3) - 0.5f) / (float)across +
                 0.9f * (tile_fractal(key ^ 0x77, u, v, 24, 12) - 0.5f) / (float)across;
    float x = (u + bend) * (float)across;
    int along = across / 6 < 2 ? 2 : across / 6;
    x -= floorf(x / (float)across) * (float)across;
    uint32_t plate = 0;
    float edge = cell_edge(key ^ 0xf15, x, v * (float)along, across, along, &plate);
    float rough = tile_fractal(key ^ 0x9, u, v, 48, 16);
    float fine = tile_fractal(key ^ 0x19, u, v, 96, 24);
    return (struct bark_point){wd_smoothf(0.0f, 0.5f, edge + 0.5f * (rough - 0.5f)),
                               0.55f + 0.45f * rough + 0.35f * fine + 0.1f * wd_hash_unit(plate),
                               0};
}

static struct bark_point scaly(uint32_t key, float u, float v, int across)
{
    float bend_u = 0.10f * (tile_fractal(key, u, v, 8, 8) - 0.5f);
    float bend_v = 0.10f * (tile_fractal(key ^ 5, u, v, 8, 8) - 0.5f);
    int along = across * 2 / 3 < 2 ? 2 : across * 2 / 3;
    float x = (u + bend_u) * (float)across, y = (v + bend_v) * (float)along;
    x -= floorf(x / (float)across) * (float)across;
    y -= floorf(y / (float)along) * (float)along;
    uint32_t plate = 0;
    float edge = cell_edge(key ^ 0x5ca, x, y, across, along, &plate);
    float rough = tile_fractal(key ^ 0x9, u, v, 40, 40);
    return (struct bark_point){wd_smoothf(0.02f, 0.16f, edge + 0.1f * (rough - 0.5f)),
                               0.65f + 0.35f * wd_hash_unit(plate) + 0.25f * rough, 0};
}

static struct bark_point smooth(uint32_t key, float u, float v)
{
    float patches = tile_fractal(key, u, v, 5, 4), lines = tile_fractal(key ^ 3, u, v, 6, 60);
    float spots = tile_noise(key ^ 7, u * 40, v * 50, 40, 50);
    return (struct bark_point){wd_smoothf(0.10f, 0.35f, lines),
                               0.72f + 0.45f * patches + 0.1f * lines,
                               0.35f * wd_smoothf(0.88f, 1.0f, spots)};
}

/* White skin with thin dark lenticels across and rough black diamonds. */
static struct bark_point birch(uint32_t key, float u, float v)
{
    float line = tile_noise(key, u * 7, v * 110, 7, 110);
    float long_line = tile_noise(key ^ 1, u * 4, v * 60, 4, 60);
    uint32_t cell = 0;
    float patch = tile_fractal(key ^ 2, u, v, 4, 5);
    float ragged = tile_fractal(key ^ 4, u, v, 24, 12);
    float scar = wd_smoothf(0.66f, 0.74f, patch + 0.25f * (ragged - 0.5f));
    float edge = cell_edge(key ^ 6, u * 10, v * 5, 10, 5, &cell);
    float band = tile_fractal(key ^ 8, u, v, 2, 9);
    float dark = fmaxf(0.8f * wd_smoothf(0.80f, 0.92f, line),
                       fmaxf(0.55f * wd_smoothf(0.84f, 0.95f, long_line), scar));
    return (struct bark_point){1, 0.82f + 0.22f * band + 0.04f * edge, dark};
}

static struct bark_point bark_at(const struct wd_species *species, uint32_t key, float u, float v)
{
    int across = repeats(1.4f, species->bark.scale_cm);
    switch (species->bark.pattern) {
    case WD_BARK_SCALY:
        return scaly(key, u, v, across);
    case WD_BARK_SMOOTH:
        return smooth(key, u, v);
    case WD_BARK_BIRCH:
        return birch(key, u, v);
    default:
        return fissured(key, u, v, across);
    }
}

static void put_texel(uint8_t *texel, const float rgb[3])
{
    for (int i = 0; i < 3; i++)
        texel[i] = wd_srgb_encode(rgb[i]);
    texel[3] = 255;
}

/* Brings the mean of the shades to 1, so that the texture's plates keep the species' albedo. */
#define SHADE_MEAN 1.0f

void wd_species_bark_texture(const struct wd_species *species, uint32_t size, uint8_t *rgba)
{
    uint32_t key = wd_hash2((uint32_t)species->bark.pattern, 0xba2c);
    float plate[3];
    wd_bark_texture_color(species, plate);
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++) {
            float u = ((float)x + 0.5f) / (float)size, v = ((float)y + 0.5f) / (float)size;
            struct bark_point point = bark_at(species, key, u, v);
            float green = 0.25f * wd_smoothf(0.55f, 0.75f, tile_fractal(key ^ 0x3055, u, v, 3, 3));
            float moss[3] = {0.75f, 1.12f, 0.6f}, rgb[3];
            if (species->bark.pattern == WD_BARK_BIRCH || species->form == WD_FORM_CONIFER)
                green *= 0.3f;
            for (int i = 0; i < 3; i++) {
                float light = plate[i] * point.shade * SHADE_MEAN * wd_mixf(1, moss[i], green);
                float crack = species->bark.crack_color[i];
                rgb[i] = wd_mixf(wd_mixf(crack, light, point.plate), crack, point.dark);
            }
            put_texel(&rgba[4 * ((size_t)y * size + x)], rgb);
        }
}

/* Brightness of a leaf at (u across, v along): pale midrib and side veins, darker rim. */
static float leaf_shade(float u, float v)
{
    float across = fabsf(u - 0.5f) * 2;
    float midrib = 1 - wd_smoothf(0.015f, 0.05f, across);
    float vein = v * 9 - across * 2.2f;
    vein = fabsf(vein - floorf(vein) - 0.5f) * 2;
    float side = (1 - wd_smoothf(0.05f, 0.22f, 1 - vein)) * (1 - 0.6f * across);
    return 0.92f + 0.45f * midrib + 0.18f * side - 0.10f * across + 0.08f * v;
}

/* Several needles side by side: dark gaps, a pale line along each. */
static float needle_shade(float u, float v)
{
    float place = u * 5, within = fabsf(place - floorf(place) - 0.5f) * 2;
    return 0.72f + 0.5f * (1 - wd_smoothf(0.35f, 1.0f, within)) + 0.18f * v;
}

/* Brightness at a texel, with fine mottling. */
static float leaf_texel(const struct wd_species *species, uint32_t key, float u, float v)
{
    bool needles = species->leaf.shape == WD_LEAF_NEEDLES;
    float shade = needles ? needle_shade(u, v) : leaf_shade(u, v);
    return shade * (0.94f + 0.12f * tile_fractal(key, u, v, 10, 10));
}

/* The mean of the texture times the mean tint is the species' albedo. */
void wd_species_leaf_texture(const struct wd_species *species, uint32_t size, uint8_t *rgba)
{
    enum { GRID = 64 };
    uint32_t key = wd_hash2((uint32_t)species->leaf.shape, 0x1eaf);
    float mean = 0;
    for (int i = 0; i < GRID * GRID; i++)
        mean += leaf_texel(species, key, ((float)(i % GRID) + 0.5f) / GRID,
                           ((float)(i / GRID) + 0.5f) / GRID) / (GRID * GRID);
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++) {
            float u = ((float)x + 0.5f) / (float)size, v = ((float)y + 0.5f) / (float)size, rgb[3];
            float shade = leaf_texel(species, key, u, v) / (mean * WD_LEAF_TINT_MEAN);
            for (int i = 0; i < 3; i++)
                rgb[i] = species->leaf.color[i] * shade;
            put_texel(&rgba[4 * ((size_t)y * size + x)], rgb);
        }
}
