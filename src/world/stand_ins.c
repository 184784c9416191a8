#include "world/stand_ins.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
#include "base/memory.h"

enum { SECTORS = 12, TREES_A_JOB = 1024, CELL_MM = 8000, LEAST_CM = 150 };

/* Where the crown's middle is, as a share of the height; tops so steep over it (tangents) leave all of a sector's light,
 * and none; half a sector's width (tangent); half a top's, as a share of its crown. */
static const float MIDDLE = 0.4f, FREE = 0.6f, SHUT = 1.6f, SECTOR_HALF = 0.268f, TOP_WIDE = 1.0f / 6;
/* What is farther off is asked no more, nor are more than so many: plots may have all their trees at one place. */
static const float REACH_M = 48;
enum { MOST_ASKED = 512 };

/* East and north of the middle of each sector. */
static const float ways_east[SECTORS] = {1, 0.8660254f, 0.5f, 0, -0.5f, -0.8660254f, -1, -0.8660254f, -0.5f, 0, 0.5f, 0.8660254f};
static const float ways_north[SECTORS] = {0, 0.5f, 0.8660254f, 1, 0.8660254f, 0.5f, 0, -0.5f, -0.8660254f, -1, -0.8660254f, -0.5f};

/* Trees above the herbs, cell by cell of a grid. */
struct stand {
    const struct wd_tree *trees;
    size_t count;
    int32_t from_mm[2];
    int64_t cell_mm;
    size_t columns, rows;
    size_t *first;     /* of each cell in `members`; one more at the end */
    uint32_t *members; /* indices of trees */
};

static bool is_above_herbs(const struct wd_tree *tree)
{
    return WD_TREE_HEIGHT_CM(*tree) >= LEAST_CM;
}

static size_t column_of(const struct stand *stand, const struct wd_tree *tree)
{
    return (size_t)(((int64_t)tree->x_mm - stand->from_mm[0]) / stand->cell_mm);
}

static size_t row_of(const struct stand *stand, const struct wd_tree *tree)
{
    return (size_t)(((int64_t)tree->y_mm - stand->from_mm[1]) / stand->cell_mm);
}

static size_t cell_of(const struct stand *stand, const struct wd_tree *tree)
{
    return row_of(stand, tree) * stand->columns + column_of(stand, tree);
}

/* Cells are wider where there would be many more of them than trees. */
static void lay_out(struct stand *stand)
{
    int32_t most_mm[2] = {INT32_MIN, INT32_MIN};
    stand->from_mm[0] = stand->from_mm[1] = INT32_MAX;
    for (size_t i = 0; i < stand->count; i++) {
        const int32_t at_mm[2] = {stand->trees[i].x_mm, stand->trees[i].y_mm};
        for (int k = 0; k < 2; k++) {
            stand->from_mm[k] = at_mm[k] < stand->from_mm[k] ? at_mm[k] : stand->from_mm[k];
            most_mm[k] = at_mm[k] > most_mm[k] ? at_mm[k] : most_mm[k];
        }
    }
    stand->cell_mm = CELL_MM / 2;
    do {
        stand->cell_mm *= 2;
        stand->columns = (size_t)(((int64_t)most_mm[0] - stand->from_mm[0]) / stand->cell_mm) + 1;
        stand->rows = (size_t)(((int64_t)most_mm[1] - stand->from_mm[1]) / stand->cell_mm) + 1;
    } while (stand->columns * stand->rows > 16 * stand->count + 4096);
}

static void stand_init(struct stand *stand, const struct wd_tree *trees, size_t count)
{
    *stand = (struct stand){.trees = trees, .count = count};
    lay_out(stand);
    size_t cells = stand->columns * stand->rows, members = 0;
    stand->first = wd_alloc_array(cells + 1, sizeof *stand->first);
    stand->members = wd_alloc_array(count, sizeof *stand->members);
    for (size_t i = 0; i < count; i++)
        stand->first[cell_of(stand, &trees[i])] += is_above_herbs(&trees[i]);
    for (size_t cell = 0; cell < cells; cell++) {
        size_t here = stand->first[cell];
        stand->first[cell] = members;
        members += here;
    }
    for (size_t i = 0; i < count; i++)
        if (is_above_herbs(&trees[i]))
            stand->members[stand->first[cell_of(stand, &trees[i])]++] = (uint32_t)i;
    memmove(stand->first + 1, stand->first, cells * sizeof *stand->first); /* each was moved to the next one's */
    stand->first[0] = 0;
}

static void stand_finish(struct stand *stand)
{
    free(stand->first);
    free(stand->members);
}

/* --- light from the sides --------------------------------------------------------------------- */

struct sides {
    const struct wd_tree *tree;
    uint32_t asked;
    float steepest[SECTORS]; /* tangents of tops over the tree's middle */
};

static float share_of(const struct sides *sides)
{
    float sum = 0;
    for (int k = 0; k < SECTORS; k++)
        sum += WD_CLAMP((SHUT - sides->steepest[k]) / (SHUT - FREE), 0, 1);
    return sum / SECTORS;
}

/* Without branches in the loop, which is most of what all of it takes. */
static void add_neighbour(struct sides *sides, const struct wd_tree *other)
{
    const struct wd_tree *tree = sides->tree;
    float east_m = (float)(other->x_mm - (int64_t)tree->x_mm) * 0.001f;
    float north_m = (float)(other->y_mm - (int64_t)tree->y_mm) * 0.001f;
    float foot_m = (float)(other->z_mm - (int64_t)tree->z_mm) * 0.001f;
    float rise_m = foot_m + WD_TREE_HEIGHT_M(*other) - MIDDLE * WD_TREE_HEIGHT_M(*tree);
    float far_m = WD_MAX(sqrtf(east_m * east_m + north_m * north_m), 0.5f);
    float steep = rise_m / far_m, half_m = TOP_WIDE * WD_TREE_CROWN_M(*other);
    if (steep <= FREE || far_m > REACH_M)
        return;
    for (int k = 0; k < SECTORS; k++) {
        float along_m = east_m * ways_east[k] + north_m * ways_north[k];
        float across_m = fabsf(north_m * ways_east[k] - east_m * ways_north[k]);
        bool within = along_m > 0 && across_m <= half_m + SECTOR_HALF * along_m;
        float here = within ? steep : 0;
        sides->steepest[k] = here > sides->steepest[k] ? here : sides->steepest[k];
    }
}

static void add_cell(struct sides *sides, const struct stand *stand, long column, long row)
{
    if (column < 0 || row < 0 || column >= (long)stand->columns || row >= (long)stand->rows)
        return;
    size_t cell = (size_t)row * stand->columns + (size_t)column;
    for (size_t i = stand->first[cell]; i < stand->first[cell + 1] && sides->asked < MOST_ASKED; i++, sides->asked++)
        if (&stand->trees[stand->members[i]] != sides->tree)
            add_neighbour(sides, &stand->trees[stand->members[i]]);
}

/* The cells at so many steps from the tree's. */
static void add_ring(struct sides *sides, const struct stand *stand, long ring)
{
    long column = (long)column_of(stand, sides->tree), row = (long)row_of(stand, sides->tree);
    for (long j = -ring; j <= ring; j++)
        for (long i = -ring; i <= ring; i += labs(j) == ring || ring == 0 ? 1 : 2 * ring)
            add_cell(sides, stand, column + i, row + j);
}

/* The share; once it cannot be above `least`, any that is not. */
static float side_light(const struct stand *stand, const struct wd_tree *tree, float least)
{
    struct sides sides = {.tree = tree};
    long rings = (long)ceilf(REACH_M * 1000 / (float)stand->cell_mm);
    float share = 1;
    for (long ring = 0; ring <= rings && share > least; ring++) {
        add_ring(&sides, stand, ring);
        share = share_of(&sides);
    }
    return share;
}

/* --- what stands for trees -------------------------------------------------------------------- */

/* The species and the variant of it that is as high. */
static uint32_t kind_of(const struct wd_tree *tree, uint32_t species, const struct wd_placement_params *params)
{
    const struct wd_scene *scene = params->scene;
    uint32_t range_cm[2], random = wd_hash3(params->seed, tree->id, WD_FOR_VARIANT);
    uint32_t variants = scene->variants < 1 ? 1 : scene->variants > 256 ? 256 : (uint32_t)scene->variants;
    wd_variant_range_cm(&scene->species[species], range_cm);
    return species | wd_place_variant(random, variants, WD_TREE_HEIGHT_CM(*tree), range_cm[0], range_cm[1]) << 16;
}

/* Crowns are as wide by either species, which follow one allometry; those of given files may not be. */
static size_t grow_young(const struct wd_tree_list *list, const bool *fixed, const struct wd_placement_params *params)
{
    size_t changed = 0;
    for (size_t i = 0; i < list->count; i++) {
        struct wd_tree *tree = &list->trees[i];
        const struct wd_species *species = &params->scene->species[WD_TREE_SPECIES(*tree)];
        float grown_m = WD_HALF_GROWN * species->typical_height_m;
        if (fixed[i] || species->when_young == 0 || WD_TREE_HEIGHT_M(*tree) >= grown_m)
            continue;
        tree->kind = kind_of(tree, species->when_young - 1, params);
        changed++;
    }
    return changed;
}

struct asking {
    const struct stand *stand;
    const struct wd_scene *scene;
    const bool *fixed; /* trees that stay as they are */
    uint16_t *becomes; /* species of each tree */
};

/* From one to the next, as long as the light is nearer to that which the next has grown in. */
static uint32_t species_in(const struct asking *asking, const struct wd_tree *tree)
{
    const struct wd_species *all = asking->scene->species;
    uint32_t species = WD_TREE_SPECIES(*tree), next = all[species].in_the_open;
    float share = -1;
    while (next > 0) {
        float least = 0.5f * (all[species].openness + all[next - 1].openness);
        share = share < 0 ? side_light(asking->stand, tree, least) : share;
        if (share <= least)
            break;
        species = next - 1;
        next = all[species].in_the_open;
    }
    return species;
}

static void ask_some(void *user, size_t index)
{
    const struct asking *asking = user;
    const struct stand *stand = asking->stand;
    size_t first = index * TREES_A_JOB, end = first + TREES_A_JOB;
    for (size_t i = first; i < end && i < stand->count; i++) {
        bool fixed = asking->fixed[i];
        asking->becomes[i] = (uint16_t)(fixed ? WD_TREE_SPECIES(stand->trees[i]) : species_in(asking, &stand->trees[i]));
    }
}

/* Crowns by allometry, found once for each species and step of height: diameters of stems are sought for each. */
struct crowns {
    const struct wd_species *species;
    double *cm; /* 0: not asked yet */
};

enum { CROWN_STEPS = WD_TREE_HEIGHT_MOST_CM / WD_CROWN_STEP_CM + 2 };

static double crown_at(const struct crowns *crowns, uint32_t species, uint32_t step)
{
    double *cm = &crowns->cm[species * CROWN_STEPS + step];
    if (*cm == 0)
        *cm = wd_crown_cm(&crowns->species[species], step * WD_CROWN_STEP_CM);
    return *cm;
}

static double crown_cm_of(const struct crowns *crowns, uint32_t species, uint32_t height_cm, double dbh_cm)
{
    const struct wd_species *of = &crowns->species[species];
    uint32_t step = height_cm / WD_CROWN_STEP_CM, rest = height_cm % WD_CROWN_STEP_CM;
    if (dbh_cm > 0)
        return wd_species_crown_m(of, dbh_cm) * wd_species_open_crown(of, (double)of->openness) * 100;
    double low = crown_at(crowns, species, step), high = crown_at(crowns, species, step + 1);
    return low + (high - low) * rest / WD_CROWN_STEP_CM;
}

static void become(struct wd_tree *tree, uint32_t species, struct wd_tree_row row, const struct crowns *crowns,
                   const struct wd_placement_params *params)
{
    uint32_t height_cm = WD_TREE_HEIGHT_CM(*tree), crown_cm = WD_TREE_CROWN_CM(*tree);
    double dbh_cm = (double)row.dbh_cm;
    if (!row.crown_measured) {
        double wider = crown_cm_of(crowns, species, height_cm, dbh_cm) /
                       crown_cm_of(crowns, WD_TREE_SPECIES(*tree), height_cm, dbh_cm);
        crown_cm = (uint32_t)fmin(fmax(floor(crown_cm * wider + 0.5), 1), WD_TREE_CROWN_MOST_CM);
    }
    tree->kind = kind_of(tree, species, params);
    tree->size = height_cm | crown_cm << 16;
}

static void apply(const struct wd_tree_list *list, const struct asking *asking, const struct wd_tree_tags *tags,
                  const struct wd_placement_params *params)
{
    size_t changed = 0, asked = 0, steps = params->scene->species_file_count * CROWN_STEPS;
    struct crowns crowns = {params->scene->species, wd_alloc_array(steps, sizeof *crowns.cm)};
    for (size_t i = 0; i < list->count; i++) {
        struct wd_tree *tree = &list->trees[i];
        asked += params->scene->species[WD_TREE_SPECIES(*tree)].in_the_open > 0;
        if (asking->becomes[i] == WD_TREE_SPECIES(*tree))
            continue;
        become(tree, asking->becomes[i], wd_tree_tags_get_row(tags, tree->id), &crowns, params);
        changed++;
    }
    free(crowns.cm);
    wd_info(params->log, "in the open: %zu of %zu trees", changed, asked);
}

static void find_wanted(const struct wd_scene *scene, bool *young, bool *open)
{
    *young = *open = false;
    for (size_t i = 0; i < scene->species_file_count; i++) {
        *young = *young || scene->species[i].when_young > 0;
        *open = *open || scene->species[i].in_the_open > 0;
    }
}

static bool open_up(const struct wd_tree_list *list, const bool *fixed, const struct wd_tree_tags *tags,
                    const struct wd_placement_params *params)
{
    struct stand stand;
    stand_init(&stand, list->trees, list->count);
    struct asking asking = {&stand, params->scene, fixed, wd_alloc_array(list->count, sizeof *asking.becomes)};
    size_t jobs = (list->count + TREES_A_JOB - 1) / TREES_A_JOB;
    bool ok = wd_jobs_run_told(params->threads, jobs, ask_some, &asking, params->progress, "asking neighbours");
    if (ok)
        apply(list, &asking, tags, params);
    free(asking.becomes);
    stand_finish(&stand);
    return ok;
}

bool wd_trees_stand_in(struct wd_tree_list *list, size_t inventory_end, const struct wd_tree_tags *tags,
                       const struct wd_placement_params *params)
{
    bool young, open, ok = true;
    find_wanted(params->scene, &young, &open);
    if (list->count == 0 || (!young && !open))
        return true;
    bool *fixed = wd_alloc_array(list->count, sizeof *fixed);
    for (size_t i = 0; i < inventory_end; i++)
        fixed[i] = wd_tree_tags_get_row(tags, i + 1).line == 0;
    if (young)
        wd_info(params->log, "young: %zu trees", grow_young(list, fixed, params));
    if (open)
        ok = open_up(list, fixed, tags, params);
    free(fixed);
    return ok;
}
