#include "world/inventory.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* In plain words; a unit may follow each. */
static const char *const x_names[] = {"x", "east", "easting", "x_utm", "utm_x", "utm_e", "gx", "px",
                                      "xcoord", "x_coord", "coord_x", "point_x", "lon", "long",
                                      "longitude", "rechtswert", NULL};
static const char *const y_names[] = {"y", "north", "northing", "y_utm", "utm_y", "utm_n", "gy", "py",
                                      "ycoord", "y_coord", "coord_y", "point_y", "lat", "latitude",
                                      "hochwert", NULL};
static const char *const species_names[] = {"species", "sp", "spp", "species_name", "taxon",
                                            "scientific_name", "latin", "latin_name",
                                            "tree_species", "baumart", NULL};
static const char *const dbh_names[] = {"dbh", "d", "bhd", "d130", "d1_3", "d_b_h", "diam", "diameter",
                                        "stem_diameter", NULL};
static const char *const height_names[] = {"height", "h", "ht", "total_height", "tree_height",
                                           "hoehe", "h\303\266he", "h\303\226he", "ho\314\210he", "hauteur", NULL};
static const char *const crown_names[] = {"crown_diameter", "crown", "crown_width", "crown_d", NULL};
static const char *const status_names[] = {"status", "state", "condition", NULL};
static const char *const id_names[] = {NULL};

struct unit {
    const char *name;
    double factor;
};
static const struct unit no_units[] = {{NULL, 0.0}};
static const struct unit place_units[] = {{"m", 1.0}, {NULL, 0.0}};
static const struct unit dbh_units[] = {{"cm", 1.0},    {"mm", 0.1},      {"m", 100.0}, {"in", 2.54},
                                        {"inch", 2.54}, {"inches", 2.54}, {NULL, 0.0}};
static const struct unit height_units[] = {{"m", 1.0},       {"cm", 0.01},    {"ft", 0.3048},
                                           {"feet", 0.3048}, {"metres", 1.0}, {"meters", 1.0},
                                           {NULL, 0.0}};

/* What a column may be called: by the scene, else usually. */
struct wish {
    const char *what, *wanted;
    const char *const *usual;
    const struct unit *units;
};

static bool is_gap(char letter)
{
    return letter != 0 && strchr(" \t_.-/()[]", letter) != NULL;
}

/* The unit that ends a column's name, as in "DBH [cm]", dbh.cm or "Height m", and how much of the
 * name stands before it; NULL: none. In "DBH at 1.3 m" the number says that the place is meant. */
static const struct unit *unit_of_name(const char *name, const struct unit *units, size_t *length)
{
    size_t end = strlen(name);
    while (end > 0 && is_gap(name[end - 1]))
        end--;
    size_t first = end;
    while (first > 0 && !is_gap(name[first - 1]))
        first--;
    *length = end;
    bool place = first > 1 && strchr(" .", name[first - 1]) && isdigit((unsigned char)name[first - 2]);
    for (const struct unit *unit = units; unit->name && first > 0 && !place; unit++)
        if (strlen(unit->name) == end - first && strncasecmp(unit->name, name + first, end - first) == 0) {
            *length = first;
            return unit;
        }
    return NULL;
}

/* Lower case, the words with one "_" between. */
static bool reads_as(const char *name, size_t length, const char *plain)
{
    bool gap = false;
    for (const char *at = name, *begin = plain; at < name + length; at++) {
        if (is_gap(*at)) {
            gap = plain > begin;
            continue;
        }
        if (gap && *plain++ != '_')
            return false;
        gap = false;
        if (*plain == 0 || tolower((unsigned char)*at) != (unsigned char)*plain++)
            return false;
    }
    return *plain == 0;
}

/* Whether the column has the usual name; `unit` is NULL where the name has none. */
static bool has_name(const struct wd_csv *csv, size_t column, const char *usual,
                     const struct unit *units, const struct unit **unit)
{
    size_t length;
    *unit = unit_of_name(csv->header[column], units, &length);
    return reads_as(csv->header[column], length, usual);
}

static bool two_columns(const struct wd_csv *csv, const char *what, size_t first, size_t second,
                        const struct wd_log *log)
{
    const char *name = csv->header[first], *other = csv->header[second];
    if (strcmp(name, other) == 0)
        return wd_error(log, "%s:1: column %s is there twice; rename the one that is not the trees' %s",
                        csv->path, name, what);
    return wd_error(log, "%s:1: columns %s and %s can both be the trees' %s; say which it is in columns.%s",
                    csv->path, name, other, what, what);
}

/* The first of the usual names that is there; one with a unit, in their order, before one without. */
static bool find_usual(const struct wd_csv *csv, const struct wish *wish, const struct wd_log *log,
                       int *column)
{
    for (const char *const *usual = wish->usual; *usual && *column < 0; usual++) {
        const struct unit *best = NULL, *unit;
        size_t twin = 0;
        for (size_t i = 0; i < csv->column_count; i++) {
            if (!has_name(csv, i, *usual, wish->units, &unit))
                continue;
            if (*column >= 0 && unit == best) {
                twin = twin ? twin : i;
            } else if (*column < 0 || (unit && (!best || unit < best))) {
                *column = (int)i;
                best = unit;
                twin = 0;
            }
        }
        if (twin)
            return two_columns(csv, wish->what, (size_t)*column, twin, log);
    }
    return true;
}

static bool find_wanted(const struct wd_csv *csv, const struct wish *wish, const struct wd_log *log,
                        int *column)
{
    *column = wd_csv_find(csv, wish->wanted);
    for (size_t i = 0; *column >= 0 && i < csv->column_count; i++)
        if (i != (size_t)*column && strcmp(csv->header[i], csv->header[*column]) == 0)
            return two_columns(csv, wish->what, (size_t)*column, i, log);
    if (*column >= 0)
        return true;
    char *names = wd_csv_names(csv);
    const char *nearest = wd_nearest_name(wish->wanted, csv->header, csv->column_count);
    wd_error(log, "%s:1: columns.%s: no column \"%s\"; the header has: %s%s%s%s%s", csv->path,
             wish->what, wish->wanted, names, nearest ? "; did you mean \"" : "",
             nearest ? nearest : "", nearest ? "\"?" : "",
             csv->column_count == 1 ? "; a single column: is the delimiter right?" : "");
    free(names);
    return false;
}

static bool find(const struct wd_csv *csv, const struct wish *wish, const struct wd_log *log, int *column)
{
    *column = -1;
    return wish->wanted ? find_wanted(csv, wish, log, column) : find_usual(csv, wish, log, column);
}

static const struct unit *find_given(const char *name, const struct unit *units)
{
    for (; units->name; units++)
        if (strcasecmp(name, units->name) == 0)
            return units;
    return NULL;
}

/* What the scene says counts before the unit that ends the column's name, that before the usual. */
static bool find_unit(const struct wd_csv *csv, const char *key, const char *wanted, int column,
                      const struct unit *units, const struct wd_log *log, double *factor)
{
    size_t length;
    const struct unit *named = column >= 0 ? unit_of_name(csv->header[column], units, &length) : NULL;
    const struct unit *given = wanted ? find_given(wanted, units) : NULL;
    if (wanted && !given)
        return wd_error(log, "%s: %s: \"%s\" is not a unit for it; the usual one is \"%s\"", csv->path,
                        key, wanted, units[0].name);
    if (given && named && given->factor != named->factor)
        wd_warn(log, "%s:1: the name of column %s says %s, but the scene's %s says %s, which counts",
                csv->path, csv->header[column], named->name, key, wanted);
    *factor = given ? given->factor : named ? named->factor : units[0].factor;
    return true;
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

static bool is_used(const struct wd_inventory_columns *columns, size_t column)
{
    const int used[] = {columns->x, columns->y, columns->species, columns->dbh, columns->height, columns->crown,
                        columns->id, columns->status};
    for (size_t i = 0; i < sizeof used / sizeof *used; i++)
        if (used[i] == (int)column)
            return true;
    return false;
}

/* A size that no column was recognised for, where one begins with what such a column may be called: the years of
 * several measurements, as in DBH_2015, leave open which is meant. */
static void warn_of_like(const struct wd_csv *csv, const struct wd_inventory_columns *columns, const struct wish *wish,
                         const struct wd_log *log)
{
    for (size_t i = 0; i < csv->column_count; i++)
        for (const char *const *usual = wish->usual; *usual; usual++)
            if (strlen(*usual) > 1 && strncasecmp(csv->header[i], *usual, strlen(*usual)) == 0 && !is_used(columns, i)) {
                wd_warn(log, "%s:1: no column was recognised for the trees' %s; if %s is, say so: \"columns\": "
                        "{\"%s\": \"%s\"}", csv->path, wish->what, csv->header[i], wish->what, csv->header[i]);
                return;
            }
}

/* A file of places alone is as it is meant; other columns may well hold the sizes. */
static void warn_of_no_sizes(const struct wd_csv *csv, const struct wd_inventory_columns *columns,
                             const struct wd_log *log)
{
    bool others = false;
    for (size_t i = 0; i < csv->column_count; i++)
        others |= !is_used(columns, i);
    if (columns->dbh >= 0 || columns->height >= 0 || !others)
        return;
    char *names = wd_csv_names(csv);
    wd_warn(log, "%s:1: neither a stem diameter nor a height was recognised, so heights are made up; if "
            "a column has one, say which: \"columns\": {\"dbh\": \"...\"} or {\"height\": \"...\"}; the "
            "header has: %s", csv->path, names);
    free(names);
}

/* Whether no column counts as two places or sizes. */
static bool check_apart(const struct wd_inventory_columns *columns, const struct wd_csv *csv,
                        const struct wd_log *log)
{
    const struct {
        const char *what;
        int column;
    } numbers[] = {{"x", columns->x}, {"y", columns->y}, {"dbh", columns->dbh}, {"height", columns->height},
                   {"crown_diameter", columns->crown}};
    for (size_t i = 1; i < sizeof numbers / sizeof *numbers; i++)
        for (size_t k = 0; k < i; k++)
            if (numbers[i].column >= 0 && numbers[i].column == numbers[k].column)
                return wd_error(log, "%s:1: column %s counts as both %s and %s; say in columns.%s and "
                                "columns.%s which they are", csv->path, csv->header[numbers[i].column],
                                numbers[k].what, numbers[i].what, numbers[k].what, numbers[i].what);
    return true;
}

bool wd_inventory_find_columns(struct wd_inventory_columns *columns, const struct wd_csv *csv,
                               const struct wd_scene_inventory *wanted, const struct wd_log *log)
{
    const struct {
        struct wish wish;
        int *column;
    } wishes[] = {
        {{"x", wanted->columns.x, x_names, place_units}, &columns->x},
        {{"y", wanted->columns.y, y_names, place_units}, &columns->y},
        {{"species", wanted->columns.species, species_names, no_units}, &columns->species},
        {{"dbh", wanted->columns.dbh, dbh_names, dbh_units}, &columns->dbh},
        {{"height", wanted->columns.height, height_names, height_units}, &columns->height},
        {{"crown_diameter", wanted->columns.crown_diameter, crown_names, height_units}, &columns->crown},
        {{"id", wanted->columns.id, id_names, no_units}, &columns->id},
        {{"status", wanted->columns.status, status_names, no_units}, &columns->status},
    };
    for (size_t i = 0; i < sizeof wishes / sizeof *wishes; i++)
        if (!find(csv, &wishes[i].wish, log, wishes[i].column) ||
            (i < 2 && !need(csv, wishes[i].wish.what, *wishes[i].column, log)))
            return false;
    if (!check_apart(columns, csv, log))
        return false;
    warn_of_no_sizes(csv, columns, log);
    for (size_t i = 0; i < sizeof wishes / sizeof *wishes; i++)
        if (*wishes[i].column < 0 && (columns->dbh >= 0 || columns->height >= 0) &&
            (wishes[i].column == &columns->dbh || wishes[i].column == &columns->height))
            warn_of_like(csv, columns, &wishes[i].wish, log);
    size_t length;
    columns->dbh_told = wanted->dbh_unit ||
                        (columns->dbh >= 0 && unit_of_name(csv->header[columns->dbh], dbh_units, &length));
    return find_unit(csv, "dbh_unit", wanted->dbh_unit, columns->dbh, dbh_units, log, &columns->dbh_cm) &&
           find_unit(csv, "height_unit", wanted->height_unit, columns->height, height_units, log,
                     &columns->height_m) &&
           find_unit(csv, "", NULL, columns->crown, height_units, log, &columns->crown_m);
}

static bool is_degrees(const struct wd_csv *csv, int column)
{
    static const char *const names[] = {"lon", "long", "longitude", "lat", "latitude"};
    const char *name = csv->header[column];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (reads_as(name, strlen(name), names[i]))
            return true;
    return false;
}

bool wd_inventory_check_frame(const struct wd_inventory_columns *columns, const struct wd_csv *csv,
                              const struct wd_scene_inventory *wanted, const struct wd_log *log)
{
    if (wd_inventory_frame(wanted) == WD_FRAME_CRS ||
        (!is_degrees(csv, columns->x) && !is_degrees(csv, columns->y)))
        return true;
    return wd_error(log, "%s:1: columns %s and %s read as degrees, but the frame \"%s\" is in metres; say "
                    "\"frame\": \"EPSG:4326\", or name the columns in metres in columns.x and columns.y",
                    csv->path, csv->header[columns->x], csv->header[columns->y],
                    wanted->frame ? wanted->frame : "local");
}
