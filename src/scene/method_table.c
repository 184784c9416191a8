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
    {"density", WD_KEY_DOUBLE, OPTION(continuum, density), 0.01, 64, "1",
     "Splats for each pixel that a crown covers.", .row = "continuum"},
    {"min_splats", WD_KEY_INTEGER, OPTION(continuum, min_splats), 8, 1024, "32",
     "Splats of a tree, however small it is on screen.", .row = "continuum"},
    {0},
};
static const struct wd_keys continuum_table = TABLE(continuum);

static const struct wd_key lod_keys[] = {
    {"full_m", WD_KEY_DOUBLE, OPTION(lod, full_m), 0, 1e6, "40",
     "Full meshes nearer than this, in metres.", .row = "O1"},
    {"reduced_m", WD_KEY_DOUBLE, OPTION(lod, reduced_m), 0, 1e6, "140",
     "Reduced meshes nearer than this, in metres; billboards beyond.", .row = "O1"},
    {"blend", WD_KEY_DOUBLE, OPTION(lod, blend), 0, 0.9, "0.15",
     "Share of a distance over which levels blend.", .row = "O1"},
    {"faithful", WD_KEY_BOOL, OPTION(lod, faithful), .fallback = "false",
     .doc = "Levels change at once, as switch nodes of a scene graph do: they pop.", .row = "O1"},
    {0},
};
static const struct wd_keys lod_table = TABLE(lod);

#define METHOD(method, rows, summary)                                                              \
    {#method, WD_KEY_OBJECT, offsetof(struct wd_method_options, method), .table = &method##_table, \
     .doc = summary, .row = rows}
static const struct wd_key method_keys[] = {
    METHOD(octree, "G5-G8", "Billboards of whole octants as ranges of one soup, meshes near."),
    {"separate", WD_KEY_OBJECT, .table = &separate_table, .row = "G9",
     .doc = "Every tree by a draw call of its own: the baseline."},
    METHOD(grid, "G9", "Billboards by cells of a fixed grid, meshes near: the other baseline."),
    METHOD(lod, "O1", "Meshes of several levels by distances that the user sets, then billboards."),
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
    "continuum",
    NULL,
};
