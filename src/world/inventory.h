/* inventory.h: measured trees from CSV files. */
#ifndef WD_WORLD_INVENTORY_H
#define WD_WORLD_INVENTORY_H

#include "world/csv.h"
#include "world/inventory_names.h"
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
    bool tags_tell_apart;     /* rows of other tags are no duplicates */
    struct wd_inventory_report report; /* rows, dead and invalid so far */
};

bool wd_inventory_load(struct wd_inventory *inventory, const struct wd_scene *scene, size_t index,
                       const struct wd_log *log);
void wd_inventory_finish(struct wd_inventory *inventory);

/* Adds the trees to the list, in the order of rows, and their tags and rows by id; completes and logs the
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
    bool dbh_told, height_told;       /* its unit, by the scene or the column's name */
    bool id_told;                     /* by the scene: its numbers tell trees apart */
};
bool wd_inventory_find_columns(struct wd_inventory_columns *columns, const struct wd_csv *csv,
                               const struct wd_scene_inventory *wanted, const struct wd_log *log);
/* Whether the column is one of them. */
bool wd_inventory_uses(const struct wd_inventory_columns *columns, size_t column);
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
    size_t *slots; /* by hash: index into names + 1; 0: free */
    size_t slot_count;
};
/* Its index in names->names, where it is added when it is new. `line`: of the row that has it. */
size_t wd_species_names_find(struct wd_species_names *names, const char *name, uint64_t line);
/* False, with an error that lists them, when any name was not found. `column`: their column's name. */
bool wd_species_names_check(const struct wd_species_names *names, const char *path, const char *column,
                            const struct wd_log *log);
/* What a file without a column of species means by the scene's mapping: the scene's only species, or that of "*". False,
 * logged, where several are meant. */
bool wd_species_names_without_column(struct wd_species_names *names, const struct wd_csv *csv);
void wd_species_names_finish(struct wd_species_names *names);

/* Which rows are dead. */
struct wd_inventory_dead {
    const struct wd_scene_inventory *wanted;
    uint64_t *rows; /* by wanted->dead */
    struct wd_living_word { /* words that count as living, the first of them */
        char *word;
        bool means_dead;
        uint64_t rows;
    } *living;
    size_t count, capacity;
};
void wd_inventory_dead_init(struct wd_inventory_dead *dead, const struct wd_scene_inventory *wanted);
bool wd_inventory_is_dead(struct wd_inventory_dead *dead, const char *status);
/* Nothing is taken away by a word that is misspelt, or where its column was not found: both are told, and so are
 * words that mean dead where the scene has none. `dead_rows`: how many were left out; `status`: column, -1: none. */
void wd_inventory_dead_warn(const struct wd_inventory_dead *dead, const struct wd_csv *csv, int status,
                            uint64_t dead_rows);
void wd_inventory_dead_finish(struct wd_inventory_dead *dead);

/* Where the trees of each plot of a file stand, by the column that says which plot it is. */
struct wd_inventory_plots {
    struct wd_inventory_plot {
        char *name;
        double min[2], max[2]; /* x, y */
    } *plots;
    size_t count, capacity;
};
void wd_inventory_plots_add(struct wd_inventory_plots *plots, const char *name, double x, double y);
/* Tells of plots that lie on one another. */
void wd_inventory_plots_warn(const struct wd_inventory_plots *plots, const char *path, const char *column,
                             const struct wd_log *log);
void wd_inventory_plots_finish(struct wd_inventory_plots *plots);

/* Tells of sizes that no such trees have, and the units that would make them right. */
void wd_inventory_warn_of_sizes(const struct wd_inventory *inventory, const struct wd_inventory_columns *columns,
                                const struct wd_scene *scene, const struct wd_log *log);

#endif
