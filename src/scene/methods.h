/* methods.h: the methods that can draw trees and the options of each, as scenes give them. */
#ifndef WD_SCENE_METHODS_H
#define WD_SCENE_METHODS_H

#include "scene/keys.h"

struct wd_octree_options {
    int64_t max_depth, leaf_trees; /* of the octree over the world's trees */
    int64_t max_cull_depth;
    int64_t sorted_trees; /* 0: any octant may be one draw */
    bool faithful;
};

struct wd_grid_options {
    int64_t trees_per_cell;
};

struct wd_continuum_options {
    double density;     /* splats a pixel that a crown covers */
    double shadow_density; /* of a cascade's texel */
    int64_t min_splats; /* of a tree */
    double wood_px;     /* trees taller than this have wood of triangles */
    double near_leaves_m; /* crowns nearer than this are drawn leaf by leaf; 0: none */
    double near_px;       /* so are those whose mesh's triangles are so large on screen; 0: none */
};

struct wd_lod_options {
    double full_m, reduced_m, blend;
    bool faithful;
};

enum wd_patch_sort { WD_PATCH_ANALYTIC, WD_PATCH_EXACT };
struct wd_patch_options {
    int64_t cells;  /* along a side */
    double cell_m;  /* 0: the densest grid's */
    double near_begin_m, near_end_m;
    int order;      /* enum wd_patch_sort */
    int64_t resident_patches;
    bool faithful;
};

struct wd_dissolve_options {
    double billboard_m, overlap_m;       /* horizontal distance */
    double leaves_begin_m, leaves_end_m, least_leaves;
    double branches_m;
    bool keep_area, faithful;
};

enum wd_impostor_shape { WD_IMPOSTOR_SPRITE, WD_IMPOSTOR_CUBE };
struct wd_impostor_options {
    int shape;             /* enum wd_impostor_shape */
    double area_px;
    int64_t cluster_size;  /* 1: no clusters */
    int64_t cluster_trees; /* of the smallest octant with a cluster */
    double least_alpha;
    bool faithful;
};

enum wd_views_blend { WD_VIEWS_NEAREST, WD_VIEWS_THREE };
struct wd_views_options {
    int layout;            /* WD_VIEWS_* of shared/hemisphere.h */
    int64_t rows, columns; /* 0: the layout's own */
    int64_t size, samples; /* texels of a view, samples a texel's side */
    int64_t variants;      /* of a species that get pictures; 0: all */
    int blend;             /* enum wd_views_blend */
    double near_m;
    bool faithful;
};

struct wd_zfield_options {
    int64_t rows, size, samples, variants, refine;
    double near_m, range_m, fade;
    bool canopy_map;
};

/* By method; methods without options have no member. */
struct wd_method_options {
    struct wd_octree_options octree;
    struct wd_grid_options grid;
    struct wd_continuum_options continuum;
    struct wd_lod_options lod;
    struct wd_patch_options patch;
    struct wd_dissolve_options dissolve;
    struct wd_impostor_options impostor;
    struct wd_views_options views;
    struct wd_zfield_options zfield;
};

/* One key a method, in the order of wd_scene_method_names; `table` holds its options. */
extern const struct wd_keys wd_scene_method_keys;
extern const char *const wd_scene_method_names[]; /* ended by NULL */

#endif
