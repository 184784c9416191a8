#include "world/inventory.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char *const x_names[] = {"x_m", "x", "east", "easting", "east_m", "easting_m", "x_utm",
                                      "utm_x", "utm_e", "gx", "px", "xcoord", "x_coord", "coord_x",
                                      "point_x", "lon", "long", "longitude", NULL};
static const char *const y_names[] = {"y_m", "y", "north", "northing", "north_m", "northing_m",
                                      "y_utm", "utm_y", "utm_n", "gy", "py", "ycoord", "y_coord",
                                      "coord_y", "point_y", "lat", "latitude", NULL};
static const char *const species_names[] = {"species", "sp", "spp", "species_name", "taxon",
                                            "scientific_name", "latin", "latin_name",
                                            "tree_species", NULL};
static const char *const dbh_names[] = {"dbh_cm", "dbh", "d", "d_cm", "diameter_cm", "diameter",
                                        "dbh_mm", "dbh_m", "dbh_in", NULL};
static const char *const height_names[] = {"height_m", "height", "h", "h_m", "ht", "ht_m",
                                           "total_height", "tree_height", "height_cm", "height_ft",
                                           NULL};
static const char *const crown_names[] = {"crown_diameter_m", "crown_diameter", "crown_m",
                                          "crown_width_m", "crown_width", "crown_d", "crown", NULL};
static const char *const status_names[] = {"status", "state", "condition", NULL};

static bool find(const struct wd_csv *csv, const char *what, const char *wanted,
                 const char *const *usual, const struct wd_log *log, int *column)
{
    *column = -1;
    if (wanted == NULL) {
        for (; *usual && *column < 0; usual++)
            *column = wd_csv_find(csv, *usual);
        return true;
    }
    *column = wd_csv_find(csv, wanted);
    if (*column >= 0)
        return true;
    char *names = wd_csv_names(csv);
    const char *nearest = wd_nearest_name(wanted, csv->header, csv->column_count);
    wd_error(log, "%s:1: columns.%s: no column \"%s\"; the header has: %s%s%s%s%s", csv->path, what,
             wanted, names, nearest ? "; did you mean \"" : "", nearest ? nearest : "",
             nearest ? "\"?" : "",
             csv->column_count == 1 ? "; a single column: is the delimiter right?" : "");
    free(names);
    return false;
}

struct unit {
    const char *name;
    double factor;
};

/* A unit that ends the name of a column that was found by itself counts where none is given. */
static bool find_unit(const struct wd_csv *csv, const char *key, const char *wanted, int column,
                      const struct unit *units, const struct wd_log *log, double *factor)
{
    *factor = units[0].factor;
    const char *suffix = column >= 0 ? strrchr(csv->header[column], '_') : NULL;
    if (suffix && (wanted == NULL || strcmp(wanted, units[0].name) == 0)) {
        for (const struct unit *unit = units; unit->name; unit++)
            if (strcasecmp(suffix + 1, unit->name) == 0)
                *factor = unit->factor;
        return true;
    }
    if (wanted == NULL)
        return true;
    for (const struct unit *unit = units; unit->name; unit++)
        if (strcasecmp(wanted, unit->name) == 0) {
            *factor = unit->factor;
            return true;
        }
    return wd_error(log, "%s: %s: \"%s\" is not a unit for it; the usual one is \"%s\"", csv->path,
                    key, wanted, units[0].name);
}

static bool need(const struct wd_csv *csv, const char *what, int column, const struct wd_log *log)
{
    if (column >= 0)
        return true;
    char *names = wd_csv_names(csv);
    wd_error(log, "%s:1: no column for %s was recognised; name it in columns.%s; the header has: %s%s",
             csv->path, what, what, names,
             csv->column_count == 1 ? "; a single column: is the delimiter right?" : "");
    free(names);
    return false;
}

bool wd_inventory_find_columns(struct wd_inventory_columns *columns, const struct wd_csv *csv,
                               const struct wd_scene_inventory *wanted, const struct wd_log *log)
{
    static const struct unit dbh_units[] = {{"cm", 1.0}, {"mm", 0.1}, {"m", 100.0}, {"in", 2.54},
                                            {NULL, 0.0}};
    static const struct unit height_units[] = {{"m", 1.0}, {"cm", 0.01}, {"ft", 0.3048},
                                               {NULL, 0.0}};
    columns->crown_m = 1.0;
    return find(csv, "x", wanted->columns.x, x_names, log, &columns->x) &&
           find(csv, "y", wanted->columns.y, y_names, log, &columns->y) &&
           need(csv, "x", columns->x, log) && need(csv, "y", columns->y, log) &&
           find(csv, "species", wanted->columns.species, species_names, log, &columns->species) &&
           find(csv, "dbh", wanted->columns.dbh, dbh_names, log, &columns->dbh) &&
           find(csv, "height", wanted->columns.height, height_names, log, &columns->height) &&
           find(csv, "crown_diameter", wanted->columns.crown_diameter, crown_names, log,
                &columns->crown) &&
           find(csv, "id", wanted->columns.id, (const char *const[]){NULL}, log, &(int){0}) &&
           find(csv, "status", wanted->columns.status, status_names, log, &columns->status) &&
           find_unit(csv, "dbh_unit", wanted->dbh_unit, columns->dbh, dbh_units, log,
                     &columns->dbh_cm) &&
           find_unit(csv, "height_unit", wanted->height_unit, columns->height, height_units, log,
                     &columns->height_m);
}
