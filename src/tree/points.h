/* points.h: a tree's surface as points in progressive order, for drawing it from afar.
 *
 * Every point stands for the same area of the full mesh, so the first n of N points, each with
 * N / n times its area, are a fair sample of it, whatever n: leaves and wood by their area, colours
 * and normals as often as they occur, well spread over the tree (stratified along a Hilbert curve
 * by an Owen-scrambled sequence). So is each window of n points from a multiple of n on, n a power
 * of two: the next window each frame gives the whole tree in time. */
#ifndef WD_TREE_POINTS_H
#define WD_TREE_POINTS_H

#include "tree/mesh.h"

struct wd_tree_points {
    struct wd_tree_point *points;
    size_t count;
    float leaf_area_m2, wood_area_m2; /* one side; of wood the outer */
    /* Discs of wood cover what the mesh's wood covers; discs of leaves with them, or with wood
     * drawn as triangles, cover what the whole mesh covers. */
    struct wd_point_gains wood, leaf;
};

/* A species' look textures: WD_LOOK_LAYERS of size x size RGBA8 (sRGB) texels, one after the
 * other. */
struct wd_point_look {
    const uint8_t *rgba;
    uint32_t size;
};

/* Samples `count` points of the mesh and calibrates the gains. False, with {0}, for a mesh without
 * area or count 0. `mesh` has its bounds set. The same mesh gives the same points on any machine. */
bool wd_tree_points_build(struct wd_tree_points *points, const struct wd_tree_mesh *mesh,
                          const struct wd_point_look *look, size_t count);
void wd_tree_points_finish(struct wd_tree_points *points); /* accepts {0} */

/* Fills the gains; called by wd_tree_points_build. */
void wd_tree_points_calibrate(struct wd_tree_points *points, const struct wd_tree_mesh *mesh);

#endif
