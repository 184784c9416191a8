/* octant_pictures.h: cubes of a forest rendered from six sides into one large atlas, which is read
 * back when it is full and averaged cell by cell (Guerrero 2006, rows G2 and G4). */
#ifndef WD_FOREST_OCTANT_PICTURES_H
#define WD_FOREST_OCTANT_PICTURES_H

#include "forest/forest.h"
#include "shared/mixed.h"
#include "shared/octant.h"

/* Mean of what a cell shows: sums over its pixels, colours linear. */
struct wd_octant_mean {
    float color[3], normal[3], openness, leaf; /* weighted by coverage */
    float coverage;                            /* 0..1 */
    float leaves[WD_MIXED_KINDS];              /* colour and openness of leaves alone */
};
struct wd_octant_mean wd_octant_mean_of(const struct wd_octant_look *look, uint32_t side);
void wd_octant_mean_pack(const struct wd_octant_mean *mean, struct wd_octant_look *look,
                         uint32_t side);

/* A cube and who asked for it. */
struct wd_octant_cube {
    float min_m[3], size_m;
    uint32_t owner;
};

struct wd_octant_pictures {
    struct wd_gpu *gpu;
    struct wd_forest_device *forest;
    struct wd_frames frames;
    struct wd_pipeline pipeline;
    struct wd_image albedo, normal, depth; /* the atlas */
    struct wd_image card_depth;
    uint8_t *albedo_bytes, *normal_bytes;
    struct wd_octant_picture *pictures; /* waiting */
    uint32_t *owners;                   /* parallel to pictures */
    struct wd_octant_entry *entries;
    size_t picture_count, picture_capacity, owner_capacity, entry_count, entry_capacity;
    uint32_t cells, pixels, columns; /* a picture's cells a side; a cell's pixels; tiles */
    uint32_t renders;
    /* Called with cells * cells means, rows from the top, of one finished picture. */
    void (*take)(void *user, uint32_t owner, const struct wd_octant_picture *picture,
                 const struct wd_octant_mean *means);
    void *user;
};
/* Set cells, pixels, take and user before. */
bool wd_octant_pictures_init(struct wd_octant_pictures *pictures, struct wd_gpu *gpu,
                             struct wd_forest_device *forest);
void wd_octant_pictures_finish(struct wd_octant_pictures *pictures);

/* Takes 6 * cells pictures of the cube with those trees (octree order; more than touch it may be
 * given). May render what has been waiting. */
bool wd_octant_pictures_add(struct wd_octant_pictures *pictures, const struct wd_octant_cube *cube,
                            const uint32_t *trees, size_t tree_count);
bool wd_octant_pictures_flush(struct wd_octant_pictures *pictures);

#endif
