#include "api/tree_list.h"

#include "base/file.h"
#include "base/point_locale.h"

/* `text` between quotes, quotes in it doubled (RFC 4180). */
static void put_quoted(FILE *stream, const char *text)
{
    putc('"', stream);
    for (; text && *text; text++) {
        if (*text == '"')
            putc('"', stream);
        putc(*text, stream);
    }
    putc('"', stream);
}

/* What leads back to a tree of an inventory: its tag, file, line and measured diameter, each empty where there is
 * none. */
static void put_row(FILE *stream, const struct wd_forest *forest, uint32_t id)
{
    const struct wd_tree_tags *tags = &forest->world.tags;
    struct wd_tree_row row = wd_tree_tags_get_row(tags, id);
    if (*wd_tree_tags_get(tags, id))
        put_quoted(stream, wd_tree_tags_get(tags, id));
    putc(',', stream);
    if (row.line > 0)
        put_quoted(stream, forest->scene.inventories[row.inventory].file);
    putc(',', stream);
    if (row.line > 0)
        fprintf(stream, "%u", row.line);
    putc(',', stream);
    if (row.dbh_cm > 0.0f)
        fprintf(stream, "%.2f", (double)row.dbh_cm);
}

static void put_tree(FILE *stream, const struct wd_forest *forest, uint32_t id)
{
    const struct wd_world *world = &forest->world;
    const struct wd_scene *scene = &forest->scene;
    uint32_t index = world->tree_of_id[id], layer = world->layer_of_tree[index];
    const struct wd_tree *tree = &world->trees[index];
    const double *origin_m = world->terrain.origin_m;
    struct wd_point_locale point;
    wd_point_locale_enter(&point);
    fprintf(stream, "%u,", id);
    put_quoted(stream, scene->species_files[WD_TREE_SPECIES(*tree)].name);
    fprintf(stream, ",%.3f,%.3f,%.3f,%.2f,%.2f,", origin_m[0] + tree->x_mm * 0.001,
            origin_m[1] + tree->y_mm * 0.001, tree->z_mm * 0.001, WD_TREE_HEIGHT_M(*tree),
            WD_TREE_CROWN_M(*tree));
    put_quoted(stream, layer < scene->layer_count ? scene->layers[layer].name : "inventory");
    putc(',', stream);
    put_row(stream, forest, id);
    putc('\n', stream);
    wd_point_locale_leave(&point);
}

enum wd_result wd_tree_list_write(const struct wd_forest *forest, const char *path,
                                  const struct wd_progress *progress, const struct wd_log *log)
{
    enum { TREES_A_REPORT = 100000 };
    struct wd_output_file file = {0};
    size_t count = forest->world.tree_count;
    bool going = true;
    if (!wd_output_open(&file, path, log))
        return WD_ERROR_OUTPUT;
    fputs("id,species,x_m,y_m,z_m,height_m,crown_diameter_m,layer,tag,file,row,dbh_cm\n", file.stream);
    for (uint32_t id = 1; id <= count && going; id++) {
        if (id % TREES_A_REPORT == 0)
            going = wd_progress_report(progress, "writing trees", id, count);
        put_tree(file.stream, forest, id);
    }
    enum wd_result result = !going                          ? WD_ERROR_INTERRUPTED
                            : wd_output_commit(&file, log) ? WD_OK
                                                           : WD_ERROR_OUTPUT;
    wd_output_discard(&file);
    return result;
}
