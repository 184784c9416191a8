/* inventory.c: rows of a CSV file as living trees. */
#include "world/inventory.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/memory.h"

/* The tallest, thickest and widest trees known are about 116 m, 1100 cm and 60 m; wider crowns than these are
 * not stored. */
static const double most_dbh_cm = 1500.0, most_height_m = 130.0, most_crown_m = WD_TREE_CROWN_MOST_CM / 100.0;

struct reader {
    struct wd_inventory *inventory;
    struct wd_csv csv;
    struct wd_inventory_columns columns;
    struct wd_species_names names;
    const struct wd_log *log;
    uint64_t first_invalid_line, zero_sizes;
    uint64_t *dead_rows; /* by wanted->dead */
};

static bool is_dead(const struct reader *reader)
{
    const struct wd_scene_inventory *wanted = reader->inventory->wanted;
    if (reader->columns.status < 0)
        return false;
    const char *status = reader->csv.fields[reader->columns.status];
    if (wanted->dead_count == 0)
        return strcasecmp(status, "dead") == 0;
    bool dead = false;
    for (size_t i = 0; i < wanted->dead_count; i++)
        if (strcasecmp(status, wanted->dead[i]) == 0) {
            reader->dead_rows[i]++;
            dead = true;
        }
    return dead;
}

/* Nothing is taken away by a word that is misspelt. */
static void warn_of_no_dead(const struct reader *reader)
{
    const struct wd_scene_inventory *wanted = reader->inventory->wanted;
    for (size_t i = 0; i < wanted->dead_count && reader->columns.status >= 0; i++)
        if (reader->dead_rows[i] == 0)
            wd_warn(reader->log, "%s: no row has the status \"%s\" in column %s, so none is left out by it; is "
                    "the word in \"dead\" right?", reader->csv.path, wanted->dead[i],
                    reader->csv.header[reader->columns.status]);
}

static int by_size(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static float middle_of(float *sizes, size_t count)
{
    qsort(sizes, count, sizeof *sizes, by_size);
    return count ? sizes[count / 2] : 0.0f;
}

/* Medians of diameters, and of heights over diameters where a tree has both; 0 where none has. */
static void measure(const struct wd_inventory *inventory, float *dbh_cm, float *slender)
{
    float *sizes = wd_alloc_array(inventory->count + 1, sizeof *sizes);
    size_t count = 0;
    for (size_t i = 0; i < inventory->count; i++)
        if (inventory->trees[i].dbh_cm > 0.0f)
            sizes[count++] = inventory->trees[i].dbh_cm;
    *dbh_cm = middle_of(sizes, count);
    count = 0;
    for (size_t i = 0; i < inventory->count; i++)
        if (inventory->trees[i].dbh_cm > 0.0f && inventory->trees[i].height_m > 0.0f)
            sizes[count++] = 100.0f * inventory->trees[i].height_m / inventory->trees[i].dbh_cm;
    *slender = middle_of(sizes, count);
    free(sizes);
}

/* Stems of forests are 15 to 250 times as long as they are thick, and few plots have a median of more than 1.6 m. */
static void warn_of_dbh_unit(const struct reader *reader)
{
    float dbh_cm, slender;
    measure(reader->inventory, &dbh_cm, &slender);
    bool thick = slender > 0.0f ? slender < 12.0f : dbh_cm > 160.0f;
    bool thin = slender > 0.0f ? slender > 1000.0f : dbh_cm < 0.9f;
    if (reader->columns.dbh_told || dbh_cm <= 0.0f || !(thick || thin))
        return;
    char *shape = slender > 0.0f ? wd_format(" and %.3g times as long as thick", (double)slender) : wd_strdup("");
    wd_warn(reader->log, "%s: column %s names no unit and counts as cm: the middle one of the stems would be %.3g cm "
            "thick%s; if it is in %s, say \"dbh_unit\": \"%s\"", reader->csv.path,
            reader->csv.header[reader->columns.dbh], (double)dbh_cm, shape, thick ? "mm" : "metres", thick ? "mm" : "m");
    free(shape);
}

enum wd_csv_value wd_inventory_read_size(const struct wd_csv *csv, const struct wd_inventory_columns *columns,
                                         enum wd_inventory_size which, float *size)
{
    const struct {
        int column;
        double factor, most;
        const char *unit;
    } sizes[] = {{columns->dbh, columns->dbh_cm, most_dbh_cm, "cm"},
                 {columns->height, columns->height_m, most_height_m, "m"},
                 {columns->crown, columns->crown_m, most_crown_m, "m"}};
    int column = sizes[which].column;
    double value, most = sizes[which].most;
    *size = 0.0f;
    if (column < 0)
        return WD_CSV_MISSING;
    enum wd_csv_value kind = wd_csv_number(csv, column, &value);
    if (kind != WD_CSV_NUMBER)
        return kind;
    *size = (float)(value * sizes[which].factor);
    if (value >= 0.0 && value * sizes[which].factor <= most)
        return kind;
    wd_error(csv->log, "%s:%" PRIu64 ": column %s: %s is %s; above 0 and up to %g %s is "
             "a tree (is the unit right?)", csv->path, csv->line, csv->header[column], csv->fields[column],
             value < 0.0 ? "negative" : "too much", most, sizes[which].unit);
    return WD_CSV_BAD;
}

static bool read_size(struct reader *reader, enum wd_inventory_size which, float *size)
{
    enum wd_csv_value kind = wd_inventory_read_size(&reader->csv, &reader->columns, which, size);
    reader->zero_sizes += kind == WD_CSV_NUMBER && *size == 0.0f;
    return kind != WD_CSV_BAD;
}

/* A row without a position cannot be planted, but is no reason to stop. */
static bool read_position(struct reader *reader, struct wd_inventory_tree *tree, bool *present)
{
    enum wd_csv_value x = wd_csv_number(&reader->csv, reader->columns.x, &tree->x);
    if (x == WD_CSV_BAD)
        return false;
    enum wd_csv_value y = wd_csv_number(&reader->csv, reader->columns.y, &tree->y);
    if (y == WD_CSV_BAD)
        return false;
    *present = x == WD_CSV_NUMBER && y == WD_CSV_NUMBER;
    if (!*present && reader->inventory->report.invalid++ == 0)
        reader->first_invalid_line = reader->csv.line;
    return true;
}

static bool read_tree(struct reader *reader)
{
    struct wd_inventory *inventory = reader->inventory;
    const struct wd_inventory_columns *columns = &reader->columns;
    struct wd_inventory_tree tree = {.row = (uint32_t)reader->csv.line};
    bool present;
    inventory->report.rows++;
    if (is_dead(reader)) {
        inventory->report.dead++;
        return true;
    }
    if (!read_position(reader, &tree, &present) ||
        !read_size(reader, WD_SIZE_DBH, &tree.dbh_cm) || !read_size(reader, WD_SIZE_HEIGHT, &tree.height_m) ||
        !read_size(reader, WD_SIZE_CROWN, &tree.crown_m))
        return false;
    const char *name = columns->species >= 0 ? reader->csv.fields[columns->species] : "";
    tree.name = (uint32_t)wd_species_names_find(&reader->names, name, reader->csv.line);
    int species = reader->names.names[tree.name].species;
    if (!present || species < 0)
        return true; /* names that are not found are reported together */
    tree.species = (uint32_t)species;
    struct wd_inventory_tree *added = wd_push(inventory->trees, inventory->count,
                                              inventory->capacity);
    *added = tree;
    if (columns->id >= 0 && !wd_csv_is_missing(reader->csv.fields[columns->id]))
        wd_tree_tags_set(&inventory->tags, inventory->count - 1, reader->csv.fields[columns->id]);
    return true;
}

/* Without a species column every tree is of the scene's only species, or of "*". */
static bool check_species_column(struct reader *reader, const struct wd_scene *scene)
{
    if (reader->columns.species >= 0)
        return true;
    if (scene->species_file_count == 1) {
        struct wd_species_name *only = wd_push(reader->names.names, reader->names.count,
                                               reader->names.capacity);
        *only = (struct wd_species_name){.name = wd_strdup("")};
        return true;
    }
    size_t any = wd_species_names_find(&reader->names, "", 1);
    if (reader->names.names[any].species >= 0)
        return true;
    char *names = wd_csv_names(&reader->csv);
    wd_error(reader->log, "%s:1: no column for the species was recognised; name it in "
             "columns.species, or give one species for all as \"*\"; the header has: %s",
             reader->csv.path, names);
    free(names);
    return false;
}

static bool read_rows(struct reader *reader)
{
    enum wd_csv_row row;
    while ((row = wd_csv_next(&reader->csv)) == WD_CSV_ROW)
        if (!read_tree(reader))
            return false;
    if (row == WD_CSV_ERROR)
        return false;
    const struct wd_inventory_report *report = &reader->inventory->report;
    if (report->rows == 0)
        return wd_error(reader->log, "%s: has a header but no trees", reader->csv.path);
    const char *column = reader->columns.species >= 0 ? reader->csv.header[reader->columns.species] : "";
    if (!wd_species_names_check(&reader->names, reader->csv.path, column, reader->log))
        return false;
    if (report->invalid > 0)
        wd_warn(reader->log, "%s:%" PRIu64 ": %" PRIu64 " rows have no position and are left out; "
                "this is the first", reader->csv.path, reader->first_invalid_line, report->invalid);
    if (reader->zero_sizes > 0)
        wd_warn(reader->log, "%s: %" PRIu64 " sizes are 0 and count as not measured",
                reader->csv.path, reader->zero_sizes);
    warn_of_no_dead(reader);
    warn_of_dbh_unit(reader);
    if (reader->inventory->count == 0)
        return wd_error(reader->log, "%s: no living tree with a position among %" PRIu64 " rows",
                        reader->csv.path, report->rows);
    return true;
}

bool wd_inventory_load(struct wd_inventory *inventory, const struct wd_scene *scene, size_t index,
                       const struct wd_log *log)
{
    *inventory = (struct wd_inventory){.wanted = &scene->inventories[index]};
    inventory->path = wd_path_beside(scene->path, inventory->wanted->file);
    struct reader reader = {.inventory = inventory, .log = log};
    reader.dead_rows = wd_alloc_array(inventory->wanted->dead_count + 1, sizeof *reader.dead_rows);
    reader.names = (struct wd_species_names){.scene = scene, .wanted = inventory->wanted};
    bool ok = wd_csv_open(&reader.csv, inventory->path, inventory->wanted->delimiter, log) &&
              wd_inventory_find_columns(&reader.columns, &reader.csv, inventory->wanted, log) &&
              wd_inventory_check_frame(&reader.columns, &reader.csv, inventory->wanted, log) &&
              check_species_column(&reader, scene) && read_rows(&reader);
    free(reader.dead_rows);
    wd_csv_close(&reader.csv);
    wd_species_names_finish(&reader.names);
    if (!ok)
        wd_inventory_finish(inventory);
    return ok;
}

void wd_inventory_finish(struct wd_inventory *inventory)
{
    free(inventory->path);
    free(inventory->trees);
    wd_tree_tags_finish(&inventory->tags);
    *inventory = (struct wd_inventory){0};
}
