/* method_table.c: options of the methods. Defaults are the papers' own values where they name one;
 * `row` is the row of docs/methods.md that an option stands for. */
#include "scene/methods.h"

#define OPTION(method, member) offsetof(struct wd_##method##_options, member)
#define TABLE(method) {#method, method##_keys, sizeof(struct wd_##method##_options), NULL}

static const struct wd_key octree_keys[] = {
    {"max_depth", WD_KEY_INTEGER, OPTION(octree, max_depth), 1, 15, "8",
     "Greatest depth of the octree over all trees.", .row = "G1"},
    {"leaf_trees", WD_KEY_INTEGER, OPTION(octree, leaf_trees), 1, 65536, "64",
     "Octants with fewer trees than this are not split.", .row = "G1"},
    {"max_cull_depth", WD_KEY_INTEGER, OPTION(octree, max_cull_depth), 1, 16, "7",
     "Depth down to which octants that are seen in part are split.", .row = "G5"},
    {"sorted_trees", WD_KEY_INTEGER, OPTION(octree, sorted_trees), 0, 1e9, "512",
     "Octants with more trees than this are split, so that near ones are drawn first; 0: never, as "
     "in the paper.", .row = "G5"},
    {"faithful", WD_KEY_BOOL, OPTION(octree, faithful), .fallback = "false",
     .doc = "Levels are blended at the same time, not one after the other: the background leaks "
            "through.", .row = "G7"},
    {0},
};
static const struct wd_keys octree_table = TABLE(octree);

static const struct wd_key no_keys[] = {{0}};
static const struct wd_keys separate_table = {"separate", no_keys, 0, NULL};

static const struct wd_key grid_keys[] = {
    {"trees_per_cell", WD_KEY_INTEGER, OPTION(grid, trees_per_cell), 1, 1e6, "100",
     "Mean number of trees in a cell.", .row = "G9"},
    {0},
};
static const struct wd_keys grid_table = TABLE(grid);

static const struct wd_key continuum_keys[] = {
    {"density", WD_KEY_DOUBLE, OPTION(continuum, density), 0.01, 64, "0.5",
     "Splats for each pixel that a crown covers.", .row = "continuum"},
    {"shadow_density", WD_KEY_DOUBLE, OPTION(continuum, shadow_density), 0.01, 64, "0.35",
     "Splats for each texel of a shadow map that a crown covers; a shadow is looked up in several "
     "texels.", .row = "continuum"},
    {"min_splats", WD_KEY_INTEGER, OPTION(continuum, min_splats), 8, 1024, "16",
     "Splats of a tree, however small it is on screen.", .row = "continuum"},
    {"wood_px", WD_KEY_DOUBLE, OPTION(continuum, wood_px), 1, 1e6, "32",
     "Trees taller than this many pixels have their stem and boughs drawn as triangles.",
     .row = "continuum"},
    {"near_leaves_m", WD_KEY_DOUBLE, OPTION(continuum, near_leaves_m), 0, 1000, "1.5",
     "Trees whose crowns are nearer than this, in metres, are drawn leaf by leaf; up to a quarter as "
     "far again in part. 0: none.", .row = "continuum"},
    {"near_px", WD_KEY_DOUBLE, OPTION(continuum, near_px), 0, 1e6, "10",
     "So are trees whose mesh has triangles that would be so many pixels across if they were "
     "squares; down to a quarter of that for plants of few triangles. In pictures of n samples "
     "so many over n^0.87, a tenth at least. 0: none.", .row = "continuum"},
    {0},
};
static const struct wd_keys continuum_table = TABLE(continuum);

static const struct wd_key lod_keys[] = {
    {"full_m", WD_KEY_DOUBLE, OPTION(lod, full_m), 0, 1e6, "30",
     "Full meshes nearer than this, in metres, in a picture of 600 lines that is 60 degrees high, "
     "as all of these distances.", .row = "O1"},
    {"reduced_m", WD_KEY_DOUBLE, OPTION(lod, reduced_m), 0, 1e6, "80",
     "Reduced meshes nearer than this, in metres; billboards beyond.", .row = "O1"},
    {"blend", WD_KEY_DOUBLE, OPTION(lod, blend), 0, 0.9, "0.15",
     "Share of a distance over which levels blend.", .row = "O1"},
    {"faithful", WD_KEY_BOOL, OPTION(lod, faithful), .fallback = "false",
     .doc = "Levels change at once, as switch nodes of a scene graph do: they pop. Distances are the "
            "same for every picture.", .row = "O1"},
    {0},
};
static const struct wd_keys lod_table = TABLE(lod);

static const char *const patch_orders[] = {"analytic", "exact", NULL};
static const struct wd_key patch_keys[] = {
    {"cells", WD_KEY_INTEGER, OPTION(patch, cells), 1, 1024, "128",
     "Cells of a patch along a side.", .row = "I1"},
    {"cell_m", WD_KEY_DOUBLE, OPTION(patch, cell_m), 0, 1e5, "0",
     "Size of a cell in metres; 0: that of the densest grid of plants.", .row = "I1"},
    {"order", WD_KEY_ENUM, OPTION(patch, order), .fallback = "\"analytic\"",
     .choices = patch_orders, .row = "I2",
     .doc = "Back to front by arithmetic on cells, or by a sort of the trees themselves."},
    {"near_begin_m", WD_KEY_DOUBLE, OPTION(patch, near_begin_m), 0, 1e6, "30.48",
     "Billboards begin to fade in at this distance, in metres (100 ft), in a picture of 600 lines "
     "that is 60 degrees high.", .row = "I7"},
    {"near_end_m", WD_KEY_DOUBLE, OPTION(patch, near_end_m), 0, 1e6, "60.96",
     "Billboards are whole from this distance on, where meshes begin to go, in metres (200 ft). "
     "A layer's mesh_distance_m goes before it.", .row = "I7"},
    {"resident_patches", WD_KEY_INTEGER, OPTION(patch, resident_patches), 1, 1e6, "256",
     "Patches that are kept populated; those in view always are.", .row = "I1"},
    {"faithful", WD_KEY_BOOL, OPTION(patch, faithful), .fallback = "false",
     .doc = "Fades are whole numbers, as in the sample: billboards pop. Distances are the same for every "
            "picture.", .row = "I7"},
    {0},
};
static const struct wd_keys patch_table = TABLE(patch);

static const struct wd_key dissolve_keys[] = {
    {"billboard_m", WD_KEY_DOUBLE, OPTION(dissolve, billboard_m), 0, 1e6, "60",
     "Trees dissolve into billboards from this horizontal distance on, in metres, in a picture of "
     "600 lines that is 60 degrees high, as all of these distances.", .row = "W6"},
    {"overlap_m", WD_KEY_DOUBLE, OPTION(dissolve, overlap_m), 0, 1e5, "10",
     "Over this span they do, in metres.", .row = "W6"},
    {"leaves_begin_m", WD_KEY_DOUBLE, OPTION(dissolve, leaves_begin_m), 0, 1e6, "10",
     "Leaves begin to thin out at this distance, in metres.", .row = "W5"},
    {"leaves_end_m", WD_KEY_DOUBLE, OPTION(dissolve, leaves_end_m), 0, 1e6, "50",
     "Fewest leaves from this distance on, in metres.", .row = "W5"},
    {"least_leaves", WD_KEY_DOUBLE, OPTION(dissolve, least_leaves), 0.01, 1, "0.25",
     "Share of the leaves that is never removed.", .row = "W5"},
    {"keep_area", WD_KEY_BOOL, OPTION(dissolve, keep_area), .fallback = "true", .row = "W5",
     .doc = "Leaves that stay grow, so that the crown keeps its leaf area."},
    {"branches_m", WD_KEY_DOUBLE, OPTION(dissolve, branches_m), 0, 1e6, "25",
     "Branches are reduced, the thinnest dropped, beyond this distance, in metres.", .row = "W4"},
    {"faithful", WD_KEY_BOOL, OPTION(dissolve, faithful), .fallback = "false",
     .doc = "Bare crowns, every side of a tree the same picture, billboards from above, both levels "
            "at once while dissolving, distances the same for every picture.", .row = "W6"},
    {0},
};
static const struct wd_keys dissolve_table = TABLE(dissolve);

static const char *const impostor_shapes[] = {"sprite", "cube", NULL};
static const struct wd_key impostor_keys[] = {
    {"shape", WD_KEY_ENUM, OPTION(impostor, shape), .fallback = "\"sprite\"",
     .choices = impostor_shapes, .row = "G3",
     .doc = "A sprite that faces the eye, or a cube of six colours."},
    {"area_px", WD_KEY_DOUBLE, OPTION(impostor, area_px), 0, 1e6, "36",
     "An impostor stands for an octant, a cluster's cell for what is in it, where it covers fewer "
     "pixels than this.", .row = "G3"},
    {"cluster_size", WD_KEY_INTEGER, OPTION(impostor, cluster_size), 1, 32, "12",
     "Impostors of a cluster along a side; 1: no clusters.", .row = "G4"},
    {"cluster_trees", WD_KEY_INTEGER, OPTION(impostor, cluster_trees), 1, 1e6, "512",
     "Octants with at least as many trees, and fewer than 64 times as many, have a cluster; doubled "
     "until these are 512 octants at most.",
     .row = "G4"},
    {"least_alpha", WD_KEY_DOUBLE, OPTION(impostor, least_alpha), 0, 1, "0.02",
     "Cells of a cluster that cover less than this share of every side are dropped.",
     .row = "G4"},
    {"faithful", WD_KEY_BOOL, OPTION(impostor, faithful), .fallback = "false",
     .doc = "An octant's side is the plain mean of its children's: the far ones do not show through "
            "the near ones, and crowns thin out. A cluster shows or hides as a whole.", .row = "G2"},
    {0},
};
static const struct wd_keys impostor_table = TABLE(impostor);

static const char *const view_layouts[] = {"even", "rings", "octahedral", NULL};
static const char *const view_blends[] = {"nearest", "three", NULL};
static const struct wd_key views_keys[] = {
    {"layout", WD_KEY_ENUM, OPTION(views, layout), .fallback = "\"rings\"",
     .choices = view_layouts, .row = "R3",
     .doc = "Where views are taken from: elevation x azimuth as in the paper, an octahedral grid, "
            "or evenly spread rings (Bruneton and Neyret)."},
    {"rows", WD_KEY_INTEGER, OPTION(views, rows), 0, 64, "0",
     "Rings from the horizon to the zenith, or grid points a side; 0: 10 rings, 12 points, or 9 even "
     "rings.", .row = "R3"},
    {"columns", WD_KEY_INTEGER, OPTION(views, columns), 0, 360, "0",
     "Views of a ring; 0: 30, which makes the paper's 300 views.", .row = "R3"},
    {"size", WD_KEY_INTEGER, OPTION(views, size), 8, 256, "64",
     "Texels of a view along a side, a power of two.", .row = "R3"},
    {"samples", WD_KEY_INTEGER, OPTION(views, samples), 1, 8, "4",
     "Samples of a texel along a side while views are taken.", .row = "R3"},
    {"variants", WD_KEY_INTEGER, OPTION(views, variants), 0, 64, "1",
     "Individuals of a species that get pictures; 0: all.", .row = "R6"},
    {"blend", WD_KEY_ENUM, OPTION(views, blend), .fallback = "\"three\"", .choices = view_blends,
     .row = "R4", .doc = "The nearest view alone, or three views around blended."},
    {"near_m", WD_KEY_DOUBLE, OPTION(views, near_m), 0, 1e6, "40",
     "Meshes nearer than this, in metres, in a picture of 600 lines that is 60 degrees high.",
     .row = "R4"},
    {"faithful", WD_KEY_BOOL, OPTION(views, faithful), .fallback = "false",
     .doc = "As in the paper: no meshes, the nearest view: trees pop as the eye moves.",
     .row = "R4"},
    {0},
};
static const struct wd_keys views_table = TABLE(views);

static const struct wd_key zfield_keys[] = {
    {"rows", WD_KEY_INTEGER, OPTION(zfield, rows), 1, 22, "9",
     "Rings of views N: 2 N (N + 1) + 1 views are taken, 181 in the paper.", .row = "R6"},
    {"size", WD_KEY_INTEGER, OPTION(zfield, size), 8, 256, "128",
     "Texels of a view along a side, a power of two.", .row = "R6"},
    {"samples", WD_KEY_INTEGER, OPTION(zfield, samples), 1, 8, "4",
     "Samples of a texel along a side while views are taken.", .row = "R6"},
    {"variants", WD_KEY_INTEGER, OPTION(zfield, variants), 0, 64, "1",
     "Individuals of a species that get pictures; 0: all.", .row = "R6"},
    {"refine", WD_KEY_INTEGER, OPTION(zfield, refine), 0, 8, "1",
     "Times that depth is looked up again where it was found.", .row = "R6"},
    {"near_m", WD_KEY_DOUBLE, OPTION(zfield, near_m), 0, 1e6, "40",
     "Meshes nearer than this, in metres, in a picture of 600 lines that is 60 degrees high; the "
     "paper has none.", .row = "R6"},
    {"range_m", WD_KEY_DOUBLE, OPTION(zfield, range_m), 0, 1e6, "3000",
     "No tree is drawn by itself beyond this distance, in metres; 0: all are.", .row = "R6"},
    {"fade", WD_KEY_DOUBLE, OPTION(zfield, fade), 0, 1, "0.3",
     "Over this last share of the range trees give way to the canopy's map.", .row = "R6"},
    {"canopy_map", WD_KEY_BOOL, OPTION(zfield, canopy_map), .fallback = "true", .row = "R6",
     .doc = "Ground beyond the range shows the forest that stands on it (shader-maps)."},
    {0},
};
static const struct wd_keys zfield_table = TABLE(zfield);

#define METHOD(method, rows, summary)                                                              \
    {#method, WD_KEY_OBJECT, offsetof(struct wd_method_options, method), .table = &method##_table, \
     .doc = summary, .row = rows}
static const struct wd_key method_keys[] = {
    METHOD(octree, "G5-G8", "Billboards of whole octants as ranges of one soup, meshes near."),
    {"separate", WD_KEY_OBJECT, .table = &separate_table, .row = "G9",
     .doc = "Every tree by a draw call of its own: the baseline."},
    METHOD(grid, "G9", "Billboards by cells of a fixed grid, meshes near: the other baseline."),
    METHOD(lod, "O1", "Meshes of several levels by distances that the user sets, then billboards."),
    METHOD(patch, "I1-I9", "Billboards of patches, blended back to front in an order by arithmetic."),
    METHOD(dissolve, "W4-W7", "Leaves and branches that thin out, billboards of one view each far."),
    METHOD(impostor, "G2-G4", "Far octants as sprites, cubes or clusters of six colours."),
    METHOD(views, "R3-R6", "Every tree by pictures from all around it, one quad each."),
    METHOD(zfield, "R6", "Pictures with depth: trees meet the ground and each other by pixels."),
    METHOD(continuum, "continuum", "Splats whose number follows the pixels they cover, in compute."),
    {0},
};
const struct wd_keys wd_scene_method_keys = {"methods", method_keys,
                                             sizeof(struct wd_method_options), NULL};
const char *const wd_scene_method_names[] = {
    "octree",
    "separate",
    "grid",
    "lod",
    "patch",
    "dissolve",
    "impostor",
    "views",
    "zfield",
    "continuum",
    NULL,
};
