/* inventory.h: measured trees from CSV files. */
#ifndef WD_WORLD_INVENTORY_H
#define WD_WORLD_INVENTORY_H

#include "world/csv.h"
#include "world/placement.h"
#include "world/tree_tags.h"
#include "world/world.h"

/* A living tree as its row says. */
struct wd_inventory_tree {
    double x, y;        /* in the file's frame */
    uint32_t species;   /* index into scene->species */
    uint32_t name;      /* number of the species' name in the file */
    uint32_t row;       /* line in the file */
    float dbh_cm, height_m, crown_m; /* 0: not given */
};
struct wd_inventory {
    const struct wd_scene_inventory *wanted;
    char *path;
    struct wd_inventory_tree *trees;
    size_t count, capacity;
    struct wd_tree_tags tags; /* by index into trees */
    struct wd_inventory_report report; /* rows, dead and invalid so far */
};

bool wd_inventory_load(struct wd_inventory *inventory, const struct wd_scene *scene, size_t index,
                       const struct wd_log *log);
void wd_inventory_finish(struct wd_inventory *inventory);

/* Adds the trees to the list, in the order of rows, and their tags by id; completes and logs the
 * report. `fitted`: the ground was made round the inventories, so local coordinates count from its
 * origin too. */
bool wd_inventory_plant(struct wd_inventory *inventory, const struct wd_placement_params *params,
                        size_t index, bool fitted, struct wd_tree_list *list,
                        struct wd_tree_tags *tags);

enum wd_inventory_frame { WD_FRAME_LOCAL, WD_FRAME_PROJECTED, WD_FRAME_CRS };
enum wd_inventory_frame wd_inventory_frame(const struct wd_scene_inventory *wanted);

/* Rotation, offset and reprojection to `crs` (may be NULL unless the frame is a CRS):
 * coordinates in the ground's projected frame, or local ones for a local frame. free() them. */
bool wd_inventory_points(const struct wd_inventory *inventory, const char *crs,
                         const struct wd_log *log, double **x, double **y);

/* The terrain of the scene; made-up ground is laid under inventories with real coordinates, and
 * flat ground of size 0 is made to fit all of them. */
bool wd_world_make_terrain(struct wd_terrain *terrain, const struct wd_inventory *inventories,
                           const struct wd_placement_params *params, bool *fitted);

/* Columns of a file by what they hold; -1: absent. */
struct wd_inventory_columns {
    int x, y, species, dbh, height, crown, id, status;
    double dbh_cm, height_m, crown_m; /* of one unit */
    bool dbh_told;                    /* its unit, by the scene or the column's name */
};
bool wd_inventory_find_columns(struct wd_inventory_columns *columns, const struct wd_csv *csv,
                               const struct wd_scene_inventory *wanted, const struct wd_log *log);
/* Sizes of trees. */
enum wd_inventory_size { WD_SIZE_DBH, WD_SIZE_HEIGHT, WD_SIZE_CROWN };
/* The row's, in cm (dbh) or m: WD_CSV_NUMBER, or WD_CSV_MISSING and 0. WD_CSV_BAD, logged, where it is no number,
 * negative or more than any tree's. */
enum wd_csv_value wd_inventory_read_size(const struct wd_csv *csv, const struct wd_inventory_columns *columns,
                                         enum wd_inventory_size which, float *size);
/* False, logged, where columns called longitude or latitude would count as metres. */
bool wd_inventory_check_frame(const struct wd_inventory_columns *columns, const struct wd_csv *csv,
                              const struct wd_scene_inventory *wanted, const struct wd_log *log);

/* Finds species by the names in a file. Names that are not found are counted for the error. */
struct wd_species_names {
    const struct wd_scene *scene;
    const struct wd_scene_inventory *wanted;
    struct wd_species_name {
        char *name;
        int species; /* -1: not found */
        bool any;    /* as "*" says */
        uint64_t count, line; /* rows that have it, and the first of them */
    } *names;
    size_t count, capacity;
};
/* Its index in names->names, where it is added when it is new. `line`: of the row that has it. */
size_t wd_species_names_find(struct wd_species_names *names, const char *name, uint64_t line);
/* False, with an error that lists them, when any name was not found. `column`: their column's name. */
bool wd_species_names_check(const struct wd_species_names *names, const char *path, const char *column,
                            const struct wd_log *log);
void wd_species_names_finish(struct wd_species_names *names);

#endif
