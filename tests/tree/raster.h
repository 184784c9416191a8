/* raster.h: a small CPU rasteriser for looking at trees and for measuring their silhouettes. */
#ifndef WD_TEST_TREE_RASTER_H
#define WD_TEST_TREE_RASTER_H

#include "tree/grow.h"

struct wd_raster_looks {
    uint32_t size; /* of both textures, pixels along an edge */
    uint8_t *bark, *leaf;
    const struct wd_species *species;
};

/* A canvas of linear colour with depth. */
struct wd_raster {
    int width, height;
    float *rgb, *depth;
    unsigned char *covered;
};

/* How a tree stands on the canvas: its foot at pixel (x, y), seen from the side at this azimuth
 * and elevation, orthographic. */
struct wd_raster_view {
    float x, y, pixels_per_m;
    float azimuth_rad, elevation_rad;
};

void wd_raster_init(struct wd_raster *raster, int width, int height);
void wd_raster_finish(struct wd_raster *raster);
/* Draws with sun (shadow-mapped), sky by the vertices' openness, and light through leaves. */
void wd_raster_tree(struct wd_raster *raster, const struct wd_tree_mesh *mesh,
                    const struct wd_raster_looks *looks, const struct wd_raster_view *view);
/* Covers what that would, without colour. */
void wd_raster_silhouette(struct wd_raster *raster, const struct wd_tree_mesh *mesh,
                          const struct wd_raster_view *view);
/* Share of the canvas that trees cover. */
double wd_raster_coverage(const struct wd_raster *raster);

#endif
