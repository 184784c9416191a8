#include "world/inventory.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* What a column may be called: by the scene, else usually. */
struct wish {
    enum wd_inventory_column column;
    const char *what, *wanted;
};

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

/* The first of the usual names that is there; one with a unit, in their order, before one without. Numbers of trees are
 * not worth an error. */
static bool find_usual(const struct wd_csv *csv, const struct wish *wish, const struct wd_log *log,
                       int *column)
{
    for (const char *const *usual = wd_inventory_usual_names(wish->column); *usual && *column < 0; usual++) {
        const struct wd_column_unit *best = NULL, *unit;
        size_t twin = 0;
        for (size_t i = 0; i < csv->column_count; i++) {
            if (!wd_inventory_has_name(csv->header[i], *usual, wish->column, &unit))
                continue;
            if (*column >= 0 && unit == best) {
                twin = twin ? twin : i;
            } else if (*column < 0 || (unit && (!best || unit < best))) {
                *column = (int)i;
                best = unit;
                twin = 0;
            }
        }
        if (twin && wish->column != WD_COLUMN_ID)
            return two_columns(csv, wish->what, (size_t)*column, twin, log);
    }
    return true;
}

/* Names such as E and N, where no other says x or y. */
static void find_place_pair(const struct wd_csv *csv, int *x, int *y)
{
    for (size_t i = 0; wd_inventory_place_pairs[i][0] && *x < 0 && *y < 0; i++) {
        const struct wd_column_unit *unit;
        int found[2] = {-1, -1};
        for (size_t k = 0; k < csv->column_count; k++)
            for (int side = 0; side < 2; side++)
                if (wd_inventory_has_name(csv->header[k], wd_inventory_place_pairs[i][side], WD_COLUMN_X, &unit))
                    found[side] = (int)k;
        if (found[0] >= 0 && found[1] >= 0) {
            *x = found[0];
            *y = found[1];
        }
    }
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

static const struct wd_column_unit *find_given(const char *name, const struct wd_column_unit *units)
{
    for (; units->name; units++)
        if (strcasecmp(name, units->name) == 0)
            return units;
    return NULL;
}

/* A unit that is written counts or is told of: it is never taken for another in silence. */
static bool check_unit_known(const struct wd_csv *csv, const char *key, int column, enum wd_inventory_column which,
                             const struct wd_column_unit *named, const struct wd_log *log)
{
    char *units = wd_inventory_list_units(which), *bracketed = wd_inventory_bracketed(csv->header[column]);
    bool known = !named || named->factor > 0.0;
    if (!known)
        wd_error(log, "%s:1: column %s: %s is no unit that is read; known are %s; convert the column%s%s", csv->path,
                 csv->header[column], named->name, units, *key ? ", or say what it is in " : "", key);
    else if (!named && bracketed)
        wd_warn(log, "%s:1: column %s: \"%s\" is no unit that is known (%s), so it counts as %s%s%s", csv->path,
                csv->header[column], bracketed, units, wd_inventory_units(which)->name,
                *key ? "; say what it is in " : "", key);
    free(units);
    free(bracketed);
    return known;
}

/* What the scene says counts before the unit that ends the column's name, that before the usual. */
static bool find_unit(const struct wd_csv *csv, const char *key, const char *wanted, int column,
                      enum wd_inventory_column which, const struct wd_log *log, double *factor)
{
    size_t length;
    const struct wd_column_unit *units = wd_inventory_units(which);
    const struct wd_column_unit *named = column >= 0 ? wd_inventory_unit_of(csv->header[column], which, &length) : NULL;
    const struct wd_column_unit *given = wanted ? find_given(wanted, units) : NULL;
    if (wanted && (!given || given->factor == 0.0))
        return wd_error(log, "%s: %s: \"%s\" is not a unit for it; the usual one is \"%s\"", csv->path,
                        key, wanted, units[0].name);
    if (given && named && given->factor != named->factor)
        wd_warn(log, "%s:1: the name of column %s says %s, but the scene's %s says %s, which counts",
                csv->path, csv->header[column], named->name, key, wanted);
    *factor = given ? given->factor : named ? named->factor : units[0].factor;
    return column < 0 || given || check_unit_known(csv, key, column, which, named, log);
}

/* A place by angle and distance from a plot's middle has to become x and y first. */
static bool is_polar(const struct wd_csv *csv, const struct wd_log *log)
{
    int azimuth = wd_inventory_find_usual(csv, WD_COLUMN_AZIMUTH), distance = wd_inventory_find_usual(csv, WD_COLUMN_DISTANCE);
    if (azimuth < 0 || distance < 0)
        return false;
    wd_error(log, "%s:1: columns %s and %s tell places from a plot's middle, but x and y are wanted: convert them first, "
             "x = middle's x + distance sin(azimuth), y = middle's y + distance cos(azimuth)", csv->path,
             csv->header[azimuth], csv->header[distance]);
    return true;
}

static bool need(const struct wd_csv *csv, const char *what, int column, const struct wd_log *log)
{
    if (column >= 0)
        return true;
    if (is_polar(csv, log))
        return false;
    char *names = wd_csv_names(csv);
    wd_error(log, "%s:1: no column for %s was recognised; name it in columns.%s; the header has: %s%s",
             csv->path, what, what, names,
             csv->column_count == 1 ? "; a single column: is the delimiter right?" : "");
    free(names);
    return false;
}

bool wd_inventory_uses(const struct wd_inventory_columns *columns, size_t column)
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
        if (wd_inventory_begins_as(csv->header[i], wish->column) && !wd_inventory_uses(columns, i)) {
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
        others |= !wd_inventory_uses(columns, i);
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

static void warn_of_girth(const struct wd_csv *csv, const struct wd_inventory_columns *columns, const struct wd_log *log)
{
    int girth = wd_inventory_find_usual(csv, WD_COLUMN_GIRTH);
    if (girth >= 0 && (columns->dbh == girth || (columns->dbh < 0 && !wd_inventory_uses(columns, (size_t)girth))))
        wd_warn(log, "%s:1: column %s reads as a girth, %s; divide it by 3.1416, and name it dbh", csv->path,
                csv->header[girth], columns->dbh == girth ? "but counts as a diameter" : "which is not read");
}

static bool find_units(struct wd_inventory_columns *columns, const struct wd_csv *csv,
                       const struct wd_scene_inventory *wanted, const struct wd_log *log)
{
    size_t length;
    columns->dbh_told = wanted->dbh_unit ||
                        (columns->dbh >= 0 && wd_inventory_unit_of(csv->header[columns->dbh], WD_COLUMN_DBH, &length));
    columns->height_told = wanted->height_unit || (columns->height >= 0 && wd_inventory_unit_of(
                                                       csv->header[columns->height], WD_COLUMN_HEIGHT, &length));
    columns->id_told = wanted->columns.id != NULL;
    return find_unit(csv, "dbh_unit", wanted->dbh_unit, columns->dbh, WD_COLUMN_DBH, log, &columns->dbh_cm) &&
           find_unit(csv, "height_unit", wanted->height_unit, columns->height, WD_COLUMN_HEIGHT, log,
                     &columns->height_m) &&
           find_unit(csv, "", NULL, columns->crown, WD_COLUMN_CROWN, log, &columns->crown_m);
}

bool wd_inventory_find_columns(struct wd_inventory_columns *columns, const struct wd_csv *csv,
                               const struct wd_scene_inventory *wanted, const struct wd_log *log)
{
    const struct {
        struct wish wish;
        int *column;
    } wishes[] = {
        {{WD_COLUMN_X, "x", wanted->columns.x}, &columns->x},
        {{WD_COLUMN_Y, "y", wanted->columns.y}, &columns->y},
        {{WD_COLUMN_SPECIES, "species", wanted->columns.species}, &columns->species},
        {{WD_COLUMN_DBH, "dbh", wanted->columns.dbh}, &columns->dbh},
        {{WD_COLUMN_HEIGHT, "height", wanted->columns.height}, &columns->height},
        {{WD_COLUMN_CROWN, "crown_diameter", wanted->columns.crown_diameter}, &columns->crown},
        {{WD_COLUMN_ID, "id", wanted->columns.id}, &columns->id},
        {{WD_COLUMN_STATUS, "status", wanted->columns.status}, &columns->status},
    };
    for (size_t i = 0; i < sizeof wishes / sizeof *wishes; i++)
        if (!find(csv, &wishes[i].wish, log, wishes[i].column))
            return false;
    find_place_pair(csv, &columns->x, &columns->y);
    if (!need(csv, "x", columns->x, log) || !need(csv, "y", columns->y, log) || !check_apart(columns, csv, log))
        return false;
    warn_of_no_sizes(csv, columns, log);
    warn_of_girth(csv, columns, log);
    for (size_t i = 0; i < sizeof wishes / sizeof *wishes; i++)
        if (*wishes[i].column < 0 && (wishes[i].column == &columns->dbh || wishes[i].column == &columns->height))
            warn_of_like(csv, columns, &wishes[i].wish, log);
    return find_units(columns, csv, wanted, log);
}

static bool is_degrees(const struct wd_csv *csv, int column)
{
    static const char *const names[] = {"lon", "long", "lng", "longitude", "longitud", "lat", "latitude", "latitud"};
    const struct wd_column_unit *unit;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (wd_inventory_has_name(csv->header[column], names[i], WD_COLUMN_ID, &unit))
            return true;
    return false;
}

static bool check_place_units(const struct wd_inventory_columns *columns, const struct wd_csv *csv, const struct wd_log *log)
{
    size_t length;
    const struct wd_column_unit *x = wd_inventory_unit_of(csv->header[columns->x], WD_COLUMN_X, &length);
    const struct wd_column_unit *y = wd_inventory_unit_of(csv->header[columns->y], WD_COLUMN_Y, &length);
    return (!x || check_unit_known(csv, "", columns->x, WD_COLUMN_X, x, log)) &&
           (!y || check_unit_known(csv, "", columns->y, WD_COLUMN_Y, y, log));
}

/* The units of a frame that is named are its own. */
bool wd_inventory_check_frame(const struct wd_inventory_columns *columns, const struct wd_csv *csv,
                              const struct wd_scene_inventory *wanted, const struct wd_log *log)
{
    if (wd_inventory_frame(wanted) == WD_FRAME_CRS)
        return true;
    if (!is_degrees(csv, columns->x) && !is_degrees(csv, columns->y))
        return check_place_units(columns, csv, log);
    return wd_error(log, "%s:1: columns %s and %s read as degrees, but the frame \"%s\" is in metres; say "
                    "\"frame\": \"EPSG:4326\", or name the columns in metres in columns.x and columns.y",
                    csv->path, csv->header[columns->x], csv->header[columns->y],
                    wanted->frame ? wanted->frame : "local");
}
