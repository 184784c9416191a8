/* points.h: a tree's surface as points in progressive order, for drawing it from afar.
 *
 * Every point stands for the same area of the full mesh (of petals, which lie over one another, of what they
 * cover), so the first n of N points, each with N / n times its area, are a fair sample of it, whatever n:
 * leaves and wood by their area, colours and normals as often as they occur, well spread over the tree
 * (stratified along a Hilbert curve by an Owen-scrambled sequence). So is each window of n points from a
 * multiple of n on, n a power of two: the next window each frame gives the whole tree in time. */
#ifndef WD_TREE_POINTS_H
#define WD_TREE_POINTS_H

#include "tree/mesh.h"
#include "tree/vec.h"

struct wd_tree_points {
    struct wd_tree_point *points;
    uint32_t *lit; /* parallel; NULL before wd_tree_points_light */
    size_t count;
    float leaf_area_m2, wood_area_m2; /* one side; of wood the outer */
};

/* A species' look textures: WD_LOOK_LAYERS of size x size RGBA8 (sRGB) texels, one after the
 * other. */
struct wd_point_look {
    const uint8_t *rgba;
    uint32_t size;
};

/* Samples `count` points of the mesh. False, with {0}, for a mesh without area or count 0. `mesh` has
 * its bounds set. The same mesh gives the same points on any machine. */
bool wd_tree_points_build(struct wd_tree_points *points, const struct wd_tree_mesh *mesh,
                          const struct wd_point_look *look, size_t count);
void wd_tree_points_finish(struct wd_tree_points *points); /* accepts {0} */

/* The way, or the one back, that the leaf points in whose surface this is; unit. */
struct wd_vec3 wd_point_along(const struct wd_tree_point *point);

/* A mesh seen from around and from half above. */
struct wd_tree_sides {
    struct wd_silhouette *frames;
    float *fronts; /* as of wd_silhouette_front */
};
void wd_tree_sides_init(struct wd_tree_sides *sides, const struct wd_tree_mesh *mesh);
void wd_tree_sides_finish(struct wd_tree_sides *sides); /* accepts {0} */

/* shares[points->count]: of what a point of wood shows to all sides, the share that nothing of the mesh
 * hides; 0 of leaves. Points need no more than places, normals and kinds. */
void wd_tree_points_seen(float *shares, const struct wd_tree_points *points,
                         const struct wd_tree_sides *sides);

/* Finds the ways of shared/sun_ways.h, a bit each, on which nothing of the mesh lies between a point and
 * the sky. */
void wd_tree_points_light(struct wd_tree_points *points, const struct wd_tree_mesh *mesh);

/* Fills open[points->count] alike for other ways, 32 at most, on which what is nearer than `clear_m` is let through. */
void wd_tree_points_open(uint32_t *open, const struct wd_tree_points *points, const struct wd_tree_mesh *mesh,
                         float clear_m, const struct wd_vec3 *ways, uint32_t count);

/* Points of one kind, in an order of which windows are drawn, and the surface that all stand for: discs
 * are as large as their faces seem, and what nothing of the tree hides is drawn before the rest. */
struct wd_disc_class {
    const struct wd_tree_points *discs; /* with what is lit */
    float area_m2;
    float share; /* of all discs of a tree those that are of this class */
};

/* What discs of a tree need to show what its mesh shows, seen from the sides of struct
 * wd_point_gains. */
struct wd_disc_fit {
    struct wd_point_gains wood, leaf; /* of their areas */
    struct wd_point_gains light, wood_light; /* of the openness to the sky of all that is seen, and of wood */
    float lower[WD_GAIN_SIDES];       /* share of the leaves seen that show their lower side */
    float past_bark[WD_GAIN_SIDES];   /* factors on leaves' gains where triangles stand for all wood */
    float thin[WD_GAIN_SIDES];        /* and on wood's where they stand for the thick */
    float bare_thin[2];               /* without leaves: factor on the gain of discs of wood beside all triangles, */
    float bark[2];                    /* and factors on the albedo of wood: level and from half above */
};

/* Finds the gains with which discs of both classes together cover as many pixels as the mesh, and as
 * many of them with wood, on average over windows that begin anywhere. Counts are those of both
 * classes together. `bark`: a mesh of the same tree whose wood is drawn as triangles in place of discs
 * where the tree is near enough; before that its largest triangles do, and `thin` discs for `thin_share` of the
 * wood that is seen. */
void wd_disc_fit(struct wd_disc_fit *fits, const struct wd_disc_class *wood,
                 const struct wd_disc_class *leaves, const struct wd_disc_class *thin, float thin_share,
                 const struct wd_tree_mesh *mesh, const struct wd_tree_mesh *bark);

#endif
