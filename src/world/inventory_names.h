/* inventory_names.h: what the columns of inventories are usually called, and the units that their names end with. */
#ifndef WD_WORLD_INVENTORY_NAMES_H
#define WD_WORLD_INVENTORY_NAMES_H

#include "world/csv.h"

enum wd_inventory_column {
    WD_COLUMN_X, WD_COLUMN_Y, WD_COLUMN_SPECIES, WD_COLUMN_DBH, WD_COLUMN_HEIGHT, WD_COLUMN_CROWN, WD_COLUMN_ID,
    WD_COLUMN_STATUS, WD_COLUMN_PLOT, WD_COLUMN_AZIMUTH, WD_COLUMN_DISTANCE, WD_COLUMN_GIRTH, WD_INVENTORY_COLUMNS
};

/* A unit of a column, the usual one first; factor 0: a unit, but not read. */
struct wd_column_unit {
    const char *name;
    double factor;
};

/* Usual names of such a column, small and without accents, blanks and dashes, the more telling first, to NULL. */
const char *const *wd_inventory_usual_names(enum wd_inventory_column column);
/* To a name of NULL. */
const struct wd_column_unit *wd_inventory_units(enum wd_inventory_column column);
/* Names of x and y that say what they are only where both are there: to NULL, NULL. */
extern const char *const wd_inventory_place_pairs[][2];

/* The unit that ends a column's name, as in "DBH [cm]", dbh.cm or "Height m", and how much of the name stands before
 * it; NULL: none. */
const struct wd_column_unit *wd_inventory_unit_of(const char *name, enum wd_inventory_column column, size_t *length);
/* What the brackets hold that end a name, without them; NULL: there are none, or they hold a number, as in "D (1.3 m)".
 * free() it. */
char *wd_inventory_bracketed(const char *name);

/* Whether the column has the usual name, before a unit; `unit` is NULL where the name has none. */
bool wd_inventory_has_name(const char *name, const char *usual, enum wd_inventory_column column,
                           const struct wd_column_unit **unit);
/* Whether the name begins with one of the usual names of two letters or more. */
bool wd_inventory_begins_as(const char *name, enum wd_inventory_column column);
/* The first of the columns with a usual name; -1: none. Says nothing of others. */
int wd_inventory_find_usual(const struct wd_csv *csv, enum wd_inventory_column column);
/* The names of the units that are read, for a message; free() it. */
char *wd_inventory_list_units(enum wd_inventory_column column);

#endif
