/* points.h: a tree's surface as points in progressive order, for drawing it from afar.
 *
 * Every point stands for the same area of the full mesh, so the first n of N points, each with
 * N / n times its area, are a fair sample of it, whatever n: leaves and wood by their area, colours
 * and normals as often as they occur, well spread over the tree (stratified along a Hilbert curve
 * by an Owen-scrambled sequence). So is each window of n points from a multiple of n on, n a power
 * of two: the next window each frame gives the whole tree in time. */
#ifndef WD_TREE_POINTS_H
#define WD_TREE_POINTS_H

#include "scene/species.h"
#include "tree/mesh.h"

/* What a gain keeps: the coverage of the whole tree, by points of wood and leaves, or by points of
 * leaves alone about wood that is drawn as triangles. */
enum wd_point_use { WD_POINTS_ALL, WD_POINTS_LEAVES, WD_POINT_USES };
/* From where: elevation 0 and from straight above; in between, by the sine squared. */
enum wd_point_view { WD_POINTS_LEVEL, WD_POINTS_ABOVE, WD_POINT_VIEWS };

struct wd_tree_points {
    struct wd_tree_point *points;
    size_t count;
    float leaf_area_m2, wood_area_m2; /* one side; wood as far as it faces outward: all of it */
    /* See WD_POINT_LEAST. Points that are one-sided and seen from behind are not drawn. */
    float gain[WD_POINT_USES][WD_POINT_VIEWS][WD_POINT_GAINS];
};

/* Mean linear albedo of the look textures, to be multiplied with the vertices' tints. */
struct wd_point_look {
    float bark[3], leaf[3];
};
/* Of textures of `size` x `size` RGBA8 texels. */
struct wd_point_look wd_point_look_of(const uint8_t *bark, const uint8_t *leaf, uint32_t size);
/* The same from the species alone, with textures generated for it. */
struct wd_point_look wd_point_look_of_species(const struct wd_species *species);

/* Samples `count` points of the mesh and calibrates the gains. False, with {0}, for a mesh without
 * area or count 0. `mesh` has its bounds set. The same mesh gives the same points on any machine. */
bool wd_tree_points_build(struct wd_tree_points *points, const struct wd_tree_mesh *mesh,
                          const struct wd_point_look *look, size_t count);
void wd_tree_points_finish(struct wd_tree_points *points); /* accepts {0} */

/* Radius of the discs when `count` points of the order are drawn, seen from elevation asin(sine). */
float wd_tree_points_radius_m(const struct wd_tree_points *points, enum wd_point_use use,
                              size_t count, float sine);

/* Fills the gains; called by wd_tree_points_build. */
void wd_tree_points_calibrate(struct wd_tree_points *points, const struct wd_tree_mesh *mesh);

#endif
