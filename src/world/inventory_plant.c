/* inventory_plant.c: measured trees set on the ground, with the sizes that were not measured. */
#include "world/inventory.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/dmath.h"
#include "base/memory.h"

enum wd_inventory_frame wd_inventory_frame(const struct wd_scene_inventory *wanted)
{
    if (wanted->frame == NULL || strcasecmp(wanted->frame, "local") == 0)
        return WD_FRAME_LOCAL;
    return strcasecmp(wanted->frame, "projected") == 0 ? WD_FRAME_PROJECTED : WD_FRAME_CRS;
}

static void turn_points(const struct wd_inventory *inventory, double turn_rad, double *x, double *y)
{
    double cosine = wd_dcos(turn_rad), sine = wd_dsin(turn_rad);
    for (size_t i = 0; i < inventory->count; i++) {
        const struct wd_inventory_tree *tree = &inventory->trees[i];
        x[i] = tree->x * cosine - tree->y * sine;
        y[i] = tree->x * sine + tree->y * cosine;
    }
}

static void shift_points(const struct wd_inventory *inventory, double *x, double *y)
{
    for (size_t i = 0; i < inventory->count; i++) {
        x[i] += inventory->wanted->offset_m[0];
        y[i] += inventory->wanted->offset_m[1];
    }
}

static bool reproject(const struct wd_inventory *inventory, const char *crs, double *x, double *y,
                      const struct wd_log *log)
{
    const char *frame = inventory->wanted->frame;
    size_t placed;
    if (!crs)
        return wd_error(log, "%s: frame %s: the terrain has no coordinate system to reproject to",
                        inventory->path, frame);
    if (!wd_reproject_some(frame, crs, x, y, inventory->count, &placed, log))
        return false;
    return placed == inventory->count ||
           wd_error(log, "%s:%u: (%.9g, %.9g) is no place of %s, the inventory's frame, that the "
                    "terrain's coordinates have", inventory->path, inventory->trees[placed].row,
                    x[placed], y[placed], frame);
}

/* The offset is in metres: it goes to coordinates in metres, the frame's own or else the ground's. */
static bool place_by_crs(const struct wd_inventory *inventory, const char *crs, double *x, double *y,
                         const struct wd_log *log)
{
    char *subject = wd_format("%s: frame", inventory->path);
    bool metres, known = wd_crs_counts_metres(inventory->wanted->frame, subject, &metres, log);
    free(subject);
    if (known && metres)
        shift_points(inventory, x, y);
    if (!known || !reproject(inventory, crs, x, y, log))
        return false;
    if (!metres)
        shift_points(inventory, x, y);
    return true;
}

bool wd_inventory_points(const struct wd_inventory *inventory, const char *crs,
                         const struct wd_log *log, double **x, double **y)
{
    const struct wd_scene_inventory *wanted = inventory->wanted;
    enum wd_inventory_frame frame = wd_inventory_frame(wanted);
    *x = wd_alloc_array(inventory->count, sizeof **x);
    *y = wd_alloc_array(inventory->count, sizeof **y);
    turn_points(inventory, frame == WD_FRAME_LOCAL ? wanted->rotate_deg * (WD_PI / 180.0) : 0.0, *x, *y);
    if (frame != WD_FRAME_CRS)
        shift_points(inventory, *x, *y);
    else if (!place_by_crs(inventory, crs, *x, *y, log)) {
        free(*x);
        free(*y);
        *x = *y = NULL;
        return false;
    }
    return true;
}

static uint32_t whole_cm(double cm, uint32_t most)
{
    cm = floor(cm + 0.5);
    return cm < 1.0 ? 1 : cm > most ? most : (uint32_t)cm;
}

/* Measured, else by allometry from the diameter, else drawn from the inventory's range, else
 * typical of the species. */
static uint32_t height_cm_of(const struct wd_inventory *inventory,
                             const struct wd_inventory_tree *tree, const struct wd_species *species,
                             uint32_t key)
{
    if (tree->height_m > 0.0f)
        return whole_cm((double)tree->height_m * 100.0, WD_TREE_HEIGHT_MOST_CM);
    if (tree->dbh_cm > 0.0f)
        return whole_cm(wd_species_height_m(species, tree->dbh_cm) * 100.0,
                        WD_TREE_HEIGHT_MOST_CM);
    double low_m = inventory->wanted->height_m[0], high_m = inventory->wanted->height_m[1];
    if (!(low_m > 0.0 && high_m >= low_m))
        return whole_cm((double)species->typical_height_m * 100.0, WD_TREE_HEIGHT_MOST_CM);
    double share = (double)wd_hash2(key, WD_FOR_HEIGHT) / 4294967296.0;
    return whole_cm((low_m + (high_m - low_m) * share) * 100.0, WD_TREE_HEIGHT_MOST_CM);
}

static uint32_t crown_cm_of(const struct wd_inventory_tree *tree, const struct wd_species *species,
                            uint32_t height_cm)
{
    if (tree->crown_m > 0.0f)
        return whole_cm((double)tree->crown_m * 100.0, WD_TREE_CROWN_MOST_CM);
    if (tree->dbh_cm > 0.0f)
        return whole_cm(wd_species_crown_m(species, tree->dbh_cm) *
                        wd_species_open_crown(species, (double)species->openness) * 100.0,
                        WD_TREE_CROWN_MOST_CM);
    return whole_cm(wd_crown_cm(species, height_cm), WD_TREE_CROWN_MOST_CM);
}

struct planting {
    struct wd_inventory *inventory;
    const struct wd_placement_params *params;
    struct wd_ground_input ground;
    uint32_t index; /* of the inventory in the scene */
    uint32_t key;
    uint32_t *planted; /* index of the inventory's tree for each one in the list */
    struct wd_tree_list trees;
};

/* Whether a tree there is to stand; outside the ground the inventory's rule decides. */
static bool check_place(struct planting *planting, const struct wd_inventory_tree *tree,
                        const double at_mm[2], bool *stands)
{
    const struct wd_inventory *inventory = planting->inventory;
    const struct wd_place_ground *ground = &planting->ground.ground;
    *stands = true;
    bool inside = at_mm[0] >= 0.0 && at_mm[1] >= 0.0 && at_mm[0] <= ground->extent_mm[0] &&
                  at_mm[1] <= ground->extent_mm[1];
    if (inside) {
        struct wd_ground_place place = wd_ground_locate(&planting->ground, (int32_t)at_mm[0],
                                                        (int32_t)at_mm[1]);
        inside = !wd_ground_is_hole(&planting->ground, place);
    }
    if (inside)
        return true;
    planting->inventory->report.outside++;
    if (inventory->wanted->outside == WD_OUTSIDE_ERROR)
        return wd_error(planting->params->log, "%s:%u: stands at (%.3f, %.3f), outside the ground: "
                        "local (%.3f, %.3f), the ground reaches to (%.3f, %.3f)", inventory->path,
                        tree->row, tree->x, tree->y, at_mm[0] * 1e-3, at_mm[1] * 1e-3,
                        ground->extent_mm[0] * 1e-3, ground->extent_mm[1] * 1e-3);
    bool near = fabs(at_mm[0]) < 2e9 && fabs(at_mm[1]) < 2e9;
    *stands = inventory->wanted->outside == WD_OUTSIDE_KEEP && near;
    return true;
}

static void plant_tree(struct planting *planting, size_t index, const double at_mm[2])
{
    const struct wd_inventory_tree *from = &planting->inventory->trees[index];
    const struct wd_scene *scene = planting->params->scene;
    const struct wd_species *species = &scene->species[from->species];
    uint32_t key = wd_hash2(planting->key, from->row);
    uint32_t variants = scene->variants < 1     ? 1
                        : scene->variants > 256 ? 256
                                                : (uint32_t)scene->variants;
    struct wd_tree tree = {.x_mm = (int32_t)at_mm[0], .y_mm = (int32_t)at_mm[1]};
    struct wd_ground_place place = wd_ground_locate(&planting->ground, tree.x_mm, tree.y_mm);
    uint32_t height_cm = height_cm_of(planting->inventory, from, species, key);
    tree.z_mm = wd_ground_mm(wd_ground_height(&planting->ground, place));
    uint32_t range_cm[2];
    wd_variant_range_cm(species, range_cm);
    tree.kind = from->species | wd_place_variant(wd_hash2(key, WD_FOR_VARIANT), variants,
                                                 height_cm, range_cm[0], range_cm[1]) << 16;
    tree.size = height_cm | crown_cm_of(from, species, height_cm) << 16;
    tree.look = wd_place_look(key, 64, WD_PLACE_ANY_TURN);
    planting->planted[planting->trees.count] = (uint32_t)index;
    wd_tree_list_add(&planting->trees, &tree);
}

static bool plant_all(struct planting *planting, const double *x, const double *y,
                      const double origin_m[2])
{
    for (size_t i = 0; i < planting->inventory->count; i++) {
        const double at_mm[2] = {floor((x[i] - origin_m[0]) * 1000.0 + 0.5),
                                 floor((y[i] - origin_m[1]) * 1000.0 + 0.5)};
        bool stands;
        if (!check_place(planting, &planting->inventory->trees[i], at_mm, &stands))
            return false;
        if (stands)
            plant_tree(planting, i, at_mm);
    }
    return true;
}

/* A planted tree beside its row. */
struct stand {
    int32_t x_mm, y_mm;
    const struct wd_inventory_tree *tree;
    const char *tag;
    uint32_t index; /* in the list */
};

/* By place, then by what was measured, then by its number; 0: the same tree twice. */
static int compare_measured(const struct stand *a, const struct stand *b)
{
    if (a->x_mm != b->x_mm)
        return a->x_mm < b->x_mm ? -1 : 1;
    if (a->y_mm != b->y_mm)
        return a->y_mm < b->y_mm ? -1 : 1;
    if (a->tree->name != b->tree->name)
        return a->tree->name < b->tree->name ? -1 : 1;
    if (a->tree->dbh_cm != b->tree->dbh_cm)
        return a->tree->dbh_cm < b->tree->dbh_cm ? -1 : 1;
    if (a->tree->height_m != b->tree->height_m)
        return a->tree->height_m < b->tree->height_m ? -1 : 1;
    if (a->tree->crown_m != b->tree->crown_m)
        return a->tree->crown_m < b->tree->crown_m ? -1 : 1;
    return strcmp(a->tag, b->tag);
}

static int compare_stands(const void *first, const void *second)
{
    const struct stand *a = first, *b = second;
    int order = compare_measured(a, b);
    return order != 0 ? order : a->index < b->index ? -1 : a->index > b->index;
}

/* Marks rows that repeat an earlier one's place, species, sizes and number, by size 0. Stems of other
 * sizes or numbers on the same place are neighbours that were mapped coarsely: they stay. */
static void drop_duplicates(struct planting *planting)
{
    struct wd_inventory *inventory = planting->inventory;
    size_t count = planting->trees.count;
    struct wd_tree *trees = planting->trees.trees;
    struct stand *stands = wd_alloc_array(count, sizeof *stands);
    for (size_t i = 0; i < count; i++)
        stands[i] = (struct stand){trees[i].x_mm, trees[i].y_mm,
                                   &inventory->trees[planting->planted[i]],
                                   inventory->tags_tell_apart
                                       ? wd_tree_tags_get(&inventory->tags, planting->planted[i]) : "", (uint32_t)i};
    qsort(stands, count, sizeof *stands, compare_stands);
    uint32_t first_line = 0;
    for (size_t i = 1; i < count; i++) {
        if (compare_measured(&stands[i], &stands[i - 1]) != 0)
            continue;
        uint32_t line = stands[i].tree->row;
        first_line = first_line == 0 || line < first_line ? line : first_line;
        trees[stands[i].index].size = 0;
        inventory->report.duplicates++;
    }
    free(stands);
    if (first_line > 0)
        wd_warn(planting->params->log, "%s:%u: %" PRIu64 " rows repeat the place, species and sizes "
                "of an earlier one and are left out; this is the first", inventory->path,
                first_line, inventory->report.duplicates);
}

static bool take(struct planting *planting, struct wd_tree_list *list, struct wd_tree_tags *tags)
{
    const struct wd_tree_tags *own = &planting->inventory->tags;
    struct wd_inventory_report *report = &planting->inventory->report;
    for (size_t i = 0; i < planting->trees.count; i++) {
        if (planting->trees.trees[i].size == 0)
            continue;
        if (list->count >= planting->params->max_trees)
            return wd_too_many_trees(planting->params, planting->inventory->path);
        wd_tree_list_add(list, &planting->trees.trees[i]);
        const struct wd_inventory_tree *from = &planting->inventory->trees[planting->planted[i]];
        wd_tree_tags_set(tags, list->count, wd_tree_tags_get(own, planting->planted[i]));
        wd_tree_tags_set_row(tags, list->count, (struct wd_tree_row){planting->index, from->row, from->dbh_cm, from->crown_m > 0});
        report->planted++;
    }
    wd_info(planting->params->log,
            "inventory %s: %" PRIu64 " rows, %" PRIu64 " planted, %" PRIu64 " dead, %" PRIu64
            " duplicates, %" PRIu64 " outside%s, %" PRIu64 " invalid",
            planting->inventory->path, report->rows, report->planted, report->dead,
            report->duplicates, report->outside,
            report->outside && planting->inventory->wanted->outside == WD_OUTSIDE_KEEP ? " (kept)"
                                                                                       : "",
            report->invalid);
    if (report->planted == 0)
        return wd_error(planting->params->log, "%s: no tree stands on the ground; is \"frame\" "
                        "right?", planting->inventory->path);
    if (report->outside > 0 && planting->inventory->wanted->outside == WD_OUTSIDE_DROP)
        wd_warn(planting->params->log, "%s: %" PRIu64 " trees stand outside the ground and are "
                "left out", planting->inventory->path, report->outside);
    return true;
}

bool wd_inventory_plant(struct wd_inventory *inventory, const struct wd_placement_params *params,
                        size_t index, bool fitted, struct wd_tree_list *list,
                        struct wd_tree_tags *tags)
{
    static const double zero[2] = {0.0, 0.0};
    struct planting planting = {
        .inventory = inventory,
        .params = params,
        .index = (uint32_t)index,
        .key = wd_hash2(params->seed, 0x80000000u + (uint32_t)index),
    };
    double *x, *y;
    if (!wd_ground_input_init(&planting.ground, params) ||
        !wd_inventory_points(inventory, params->terrain->crs, params->log, &x, &y))
        return false;
    bool local = wd_inventory_frame(inventory->wanted) == WD_FRAME_LOCAL && !fitted;
    planting.planted = wd_alloc_array(inventory->count, sizeof *planting.planted);
    bool ok = plant_all(&planting, x, y, local ? zero : params->terrain->origin_m);
    if (ok) {
        drop_duplicates(&planting);
        ok = take(&planting, list, tags);
    }
    wd_tree_list_finish(&planting.trees);
    free(planting.planted);
    free(x);
    free(y);
    return ok;
}
