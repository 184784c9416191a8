/* ground_litter.h: what lies on the ground close by: leaves, blades and twigs, scattered one a cell of
 * a grid, several grids deep. Shaders declare `frame` before they include this. */
#ifndef WD_SHARED_GROUND_LITTER_H
#define WD_SHARED_GROUND_LITTER_H

#include "shared/noise.h"

/* A thing reaches at most half a cell into the next ones: its half length, as a share of a cell. */
#define WD_STREWN_REACH 0.75f

/* Flat things of one kind: lens-shaped, pointed at both ends, with twigs among them. Lengths are shares of a cell. */
struct wd_strewn {
    int32_t bits;       /* a cell is 2^bits mm */
    int32_t layers;     /* one thing a cell in each; 0: none */
    float half_length;  /* at most WD_STREWN_REACH */
    float half_width;
    float least;        /* size of the smallest, of the largest's */
    float chance;       /* that a cell has one */
    float twigs;        /* that it is a twig; below `chance` */
    uint32_t salt;
};

/* What is seen of them at a place. */
struct wd_strewn_hit {
    float rank;        /* of what lies here: the highest is seen; 0: nothing does */
    float depth;       /* 0 the uppermost layer .. 1 the lowest */
    float random;      /* of the thing, 0..1 */
    float rib;         /* 1 on its middle line .. 0 at its edge */
    float shade;       /* 0 .. 1 right beside a thing that lies higher, and in the crack below it */
    float shade_rank;  /* of that thing */
    bool twig;
    float tilt_east, tilt_north; /* slope of its surface */
};

/* The thing of one cell; `hit` is overwritten where it lies over the place. */
WD_FUNC WD_STRUCT wd_strewn_hit wd_strewn_cell(WD_STRUCT wd_strewn_hit hit,
                                               WD_STRUCT wd_lattice at, int32_t east, int32_t north,
                                               WD_STRUCT wd_strewn things, int32_t layer)
{
    uint32_t h = wd_lattice_hash(at.column + east, at.row + north,
                                 things.salt + WD_UINT(layer) * 0x3c6ef372u);
    uint32_t g = h * 0x9e3779b1u ^ h >> 15;
    float x = at.east - WD_FLOAT(east) - 0.25f - WD_FLOAT(h & 255u) * (0.5f / 255.0f);
    float y = at.north - WD_FLOAT(north) - 0.25f - WD_FLOAT(h >> 8 & 255u) * (0.5f / 255.0f);
    float turn = WD_FLOAT(h >> 16 & 255u) * (6.2831853f / 256.0f);
    float size = WD_MIX(things.least, 1.0f, WD_FLOAT(h >> 24) * (1.0f / 255.0f));
    float lot = WD_FLOAT(g >> 8 & 255u) * (1.0f / 255.0f); /* of all cells those below `chance` have one */
    bool twig = lot < things.twigs;
    float half_length = twig ? WD_STREWN_REACH : things.half_length * size;
    float half_width = twig ? 0.045f * size : things.half_width * size;
    float c = WD_COS(turn), s = WD_SIN(turn);
    float along = (c * x + s * y) / half_length;
    float across = (c * y - s * x) / half_width;
    /* bent to one side, as few leaves lie straight */
    across += (WD_FLOAT(g & 255u) * (1.0f / 255.0f) - 0.5f) * 0.8f * (along * along - 0.3f);
    float inside = 1.0f - along * along - WD_ABS(across);
    bool there = lot < things.chance;
    float rank = WD_FLOAT(layer) + 0.5f + WD_FLOAT(h & 0xffffu) * (0.5f / 65536.0f);
    float beside = WD_CLAMP(1.0f + 0.8f * inside, 0.0f, 1.0f);
    if (inside <= 0.0f && there && rank > hit.rank && beside > hit.shade) {
        hit.shade = beside;
        hit.shade_rank = rank;
    }
    if (inside > 0.0f && there && rank > hit.rank) {
        float lean = (WD_FLOAT(g >> 16 & 255u) * (1.0f / 255.0f) - 0.5f) * 0.9f;
        float curl = across * 0.55f + lean;
        hit.rank = rank;
        hit.shade = hit.shade_rank > rank ? hit.shade : 0.0f;
        hit.twig = twig;
        hit.depth = 1.0f - WD_FLOAT(layer + 1) / WD_FLOAT(things.layers);
        hit.random = WD_FLOAT(g >> 24) * (1.0f / 255.0f);
        hit.rib = 1.0f - WD_MIN(WD_ABS(across) / (1.0f - along * along), 1.0f);
        hit.tilt_east = s * curl + c * along * 0.3f;
        hit.tilt_north = -c * curl + s * along * 0.3f;
    }
    return hit;
}

WD_FUNC WD_STRUCT wd_strewn_hit wd_strewn_at(WD_FRAME_IN float east_m, float north_m,
                                             WD_STRUCT wd_strewn things)
{
    WD_STRUCT wd_strewn_hit hit;
    hit.rank = hit.random = hit.rib = hit.shade = hit.shade_rank = hit.tilt_east = hit.tilt_north = 0.0f;
    hit.twig = false;
    hit.depth = 1.0f;
    for (int32_t layer = 0; layer < things.layers; layer++) {
        /* each grid lies shifted, so that no cell's edge shows through */
        float shift_m = WD_FLOAT(layer) * 0.37f * WD_FLOAT(1 << things.bits) * 0.001f;
        WD_STRUCT wd_lattice at = wd_lattice_at(WD_FRAME_PASS east_m + shift_m,
                                                north_m - shift_m * 0.7f, things.bits);
        int32_t east = at.east < 0.5f ? -1 : 1, north = at.north < 0.5f ? -1 : 1;
        for (int32_t k = 0; k < 4; k++)
            hit = wd_strewn_cell(hit, at, (k & 1) != 0 ? 0 : east, (k & 2) != 0 ? 0 : north, things,
                                 layer);
    }
    return hit;
}

#endif
