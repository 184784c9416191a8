/* inventory.c: rows of a CSV file as living trees. */
#include "world/inventory.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    struct wd_inventory_dead dead;
    struct wd_inventory_plots plots;
    int plot; /* column; -1: none */
};

enum wd_csv_value wd_inventory_read_size(const struct wd_csv *csv, const struct wd_inventory_columns *columns,
                                         enum wd_inventory_size which, float *size)
{
    const struct {
        int column;
        double factor, most;
        const char *unit, *hint;
    } sizes[] = {{columns->dbh, columns->dbh_cm, most_dbh_cm, "cm", " \"dbh_unit\" can say another"},
                 {columns->height, columns->height_m, most_height_m, "m", " \"height_unit\" can say another"},
                 {columns->crown, columns->crown_m, most_crown_m, "m", ""}};
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
             "a tree (is the unit right?%s)", csv->path, csv->line, csv->header[column], csv->fields[column],
             value < 0.0 ? "negative" : "too much", most, sizes[which].unit, value < 0.0 ? "" : sizes[which].hint);
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

/* A file of one species needs no column for it; text in another column may say that there are more. */
static void warn_of_text(const struct reader *reader)
{
    const struct wd_csv *csv = &reader->csv;
    size_t text = 0;
    for (size_t i = 0; i < csv->column_count && text == 0; i++) {
        bool letters = strcspn(csv->fields[i], "0123456789") == strlen(csv->fields[i]) && strlen(csv->fields[i]) > 2;
        if (letters && !wd_csv_is_missing(csv->fields[i]) && !wd_inventory_uses(&reader->columns, i))
            text = i + 1;
    }
    if (text == 0 || reader->inventory->wanted->species_count == 0)
        return;
    char *header = wd_csv_names(csv);
    wd_warn(reader->log, "%s:1: no column for the species was recognised, so all trees are of one; if %s has it, say so: "
            "\"columns\": {\"species\": \"%s\"}; the header has: %s", csv->path, csv->header[text - 1],
            csv->header[text - 1], header);
    free(header);
}

static bool read_tree(struct reader *reader)
{
    struct wd_inventory *inventory = reader->inventory;
    const struct wd_inventory_columns *columns = &reader->columns;
    struct wd_inventory_tree tree = {.row = (uint32_t)reader->csv.line};
    bool present;
    if (inventory->report.rows++ == 0 && columns->species < 0)
        warn_of_text(reader);
    if (columns->status >= 0 && wd_inventory_is_dead(&reader->dead, reader->csv.fields[columns->status])) {
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
    if (reader->plot >= 0)
        wd_inventory_plots_add(&reader->plots, reader->csv.fields[reader->plot], tree.x, tree.y);
    if (columns->id >= 0 && !wd_csv_is_missing(reader->csv.fields[columns->id]))
        wd_tree_tags_set(&inventory->tags, inventory->count - 1, reader->csv.fields[columns->id]);
    return true;
}

static int by_text(const void *first, const void *second)
{
    return strcmp(*(const char *const *)first, *(const char *const *)second);
}

/* A column that was guessed to hold the trees' numbers does only where no two are the same. */
static void check_tags(struct reader *reader)
{
    struct wd_inventory *inventory = reader->inventory;
    size_t count = inventory->tags.count;
    const char **tags = wd_alloc_array(count + 1, sizeof *tags);
    bool unique = true;
    for (size_t i = 0; i < count; i++)
        tags[i] = wd_tree_tags_get(&inventory->tags, i);
    qsort(tags, count, sizeof *tags, by_text);
    for (size_t i = 1; i < count; i++)
        unique &= *tags[i] == 0 || strcmp(tags[i], tags[i - 1]) != 0;
    free(tags);
    inventory->tags_tell_apart = reader->columns.id_told;
    if (!unique && !reader->columns.id_told)
        wd_tree_tags_finish(&inventory->tags);
}

static bool read_rows(struct reader *reader)
{
    enum wd_csv_row row;
    reader->plot = wd_inventory_find_usual(&reader->csv, WD_COLUMN_PLOT);
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
    wd_inventory_dead_warn(&reader->dead, &reader->csv, reader->columns.status, report->dead);
    wd_inventory_warn_of_sizes(reader->inventory, &reader->columns, reader->names.scene, reader->log);
    if (reader->plot >= 0)
        wd_inventory_plots_warn(&reader->plots, reader->csv.path, reader->csv.header[reader->plot], reader->log);
    check_tags(reader);
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
    wd_inventory_dead_init(&reader.dead, inventory->wanted);
    reader.names = (struct wd_species_names){.scene = scene, .wanted = inventory->wanted};
    bool ok = wd_csv_open(&reader.csv, inventory->path, inventory->wanted->delimiter, log) &&
              wd_inventory_find_columns(&reader.columns, &reader.csv, inventory->wanted, log) &&
              wd_inventory_check_frame(&reader.columns, &reader.csv, inventory->wanted, log) &&
              (reader.columns.species >= 0 || wd_species_names_without_column(&reader.names, &reader.csv)) &&
              read_rows(&reader);
    wd_inventory_dead_finish(&reader.dead);
    wd_inventory_plots_finish(&reader.plots);
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
