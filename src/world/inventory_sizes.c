/* inventory_sizes.c: whether the sizes of an inventory are those of its trees, and which units would make them so. */
#include "world/inventory.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* Medians; 0: not measured. */
struct middle {
    double dbh_cm, height_m;
    double slender; /* height over diameter, where a tree has both */
    double share;   /* of the greatest height of the tree's species */
};

static int by_size(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Of those above 0. */
static double middle_of(float *sizes, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (sizes[i] > 0.0f)
            sizes[kept++] = sizes[i];
    qsort(sizes, kept, sizeof *sizes, by_size);
    return kept ? (double)sizes[kept / 2] : 0.0;
}

static struct middle measure(const struct wd_inventory *inventory, const struct wd_scene *scene)
{
    size_t count = inventory->count;
    float *dbh = wd_alloc_array(4 * count + 1, sizeof *dbh), *height = dbh + count;
    float *slender = height + count, *share = slender + count;
    for (size_t i = 0; i < count; i++) {
        const struct wd_inventory_tree *tree = &inventory->trees[i];
        float greatest_m = scene->species[tree->species].height_range_m[1];
        dbh[i] = tree->dbh_cm;
        height[i] = tree->height_m;
        slender[i] = tree->dbh_cm > 0.0f ? 100.0f * tree->height_m / tree->dbh_cm : 0.0f;
        share[i] = greatest_m > 0.0f ? tree->height_m / greatest_m : 0.0f;
    }
    struct middle middle = {middle_of(dbh, count), middle_of(height, count), middle_of(slender, count),
                            middle_of(share, count)};
    free(dbh);
    return middle;
}

/* Stems of forests are 15 to 200 times as long as they are thick, and those of saplings up to 250; few plots have a
 * median of more than 1.6 m, and none one that is taller than the species grows. */
static bool is_right(struct middle middle)
{
    double most = middle.dbh_cm >= 5.0 ? 200.0 : 1000.0;
    bool slender = middle.slender <= 0.0 || (middle.slender >= 12.0 && middle.slender <= most);
    bool thick = middle.slender > 0.0 || middle.dbh_cm <= 0.0 || (middle.dbh_cm >= 0.9 && middle.dbh_cm <= 160.0);
    return slender && thick && middle.share <= 1.1;
}

static double far_from(double value, double usual, double spread)
{
    double off = value > 0.0 ? log(value / usual) / spread : 0.0;
    return off * off;
}

/* How unlike trees of a forest, which are 75 times as long as thick, and 60 % of the greatest height. */
static double oddness(struct middle middle)
{
    double thick = middle.slender > 0.0 ? 0.0 : far_from(middle.dbh_cm, 25.0, 1.0);
    return far_from(middle.slender, 75.0, 0.45) + far_from(middle.share, 0.6, 0.8) + thick;
}

/* Units that files have without a word; the first is what counts then. */
static const struct {
    const char *height, *dbh;
    double height_m, dbh_cm;
} guesses[] = {{"", "mm", 1.0, 0.1},       {"", "m", 1.0, 100.0},     {"", "in", 1.0, 2.54},    {"ft", "", 0.3048, 1.0},
               {"ft", "in", 0.3048, 2.54}, {"ft", "mm", 0.3048, 0.1}, {"dm", "", 0.1, 1.0},     {"dm", "mm", 0.1, 0.1},
               {"cm", "", 0.01, 1.0},      {"cm", "mm", 0.01, 0.1}};

enum { GUESSES = sizeof guesses / sizeof *guesses };

static struct middle in_units(struct middle middle, size_t guess)
{
    middle.height_m *= guesses[guess].height_m;
    middle.share *= guesses[guess].height_m;
    middle.dbh_cm *= guesses[guess].dbh_cm;
    middle.slender *= guesses[guess].height_m / guesses[guess].dbh_cm;
    return middle;
}

/* What to say in the scene; free() it. */
static char *say_units(size_t guess)
{
    const char *height = guesses[guess].height, *dbh = guesses[guess].dbh;
    return wd_format("%s%s%s%s%s%s%s", *height ? "\"height_unit\": \"" : "", height, *height ? "\"" : "",
                     *height && *dbh ? " and " : "", *dbh ? "\"dbh_unit\": \"" : "", dbh, *dbh ? "\"" : "");
}

/* How unlike usual trees those would be by each of the guesses; INFINITY: that is no guess here. */
static void judge(struct middle middle, const struct wd_inventory_columns *columns, double odd[GUESSES])
{
    for (size_t i = 0; i < GUESSES; i++) {
        bool height = *guesses[i].height, dbh = *guesses[i].dbh;
        bool open = !(height && (columns->height_told || middle.height_m <= 0.0)) &&
                    !(dbh && (columns->dbh_told || middle.dbh_cm <= 0.0));
        odd[i] = open && is_right(in_units(middle, i)) ? oddness(in_units(middle, i)) : (double)INFINITY;
    }
}

static size_t least_of(const double odd[GUESSES])
{
    size_t least = 0;
    for (size_t i = 1; i < GUESSES; i++)
        least = odd[i] < odd[least] ? i : least;
    return least;
}

/* The units that fit best, and others that fit almost as well; "": none fits better than those that count. free() it. */
static char *list_units(struct middle middle, const struct wd_inventory_columns *columns)
{
    double odd[GUESSES];
    judge(middle, columns, odd);
    size_t best = least_of(odd);
    double least = odd[best];
    if (!(least < oddness(middle)))
        return wd_strdup("");
    odd[best] = (double)INFINITY;
    size_t next = least_of(odd);
    char *first = say_units(best);
    if (!(odd[next] < least + 2.6))
        return first;
    char *second = say_units(next), *both = wd_format("%s, or %s", first, second);
    free(first);
    free(second);
    return both;
}

void wd_inventory_warn_of_sizes(const struct wd_inventory *inventory, const struct wd_inventory_columns *columns,
                                const struct wd_scene *scene, const struct wd_log *log)
{
    struct middle middle = measure(inventory, scene);
    bool told = (columns->dbh_told || middle.dbh_cm <= 0.0) && (columns->height_told || middle.height_m <= 0.0);
    if (is_right(middle) || told)
        return;
    char *units = list_units(middle, columns);
    char *thick = middle.dbh_cm > 0.0 ? wd_format(" %.3g cm thick", middle.dbh_cm) : wd_strdup("");
    char *tall = middle.height_m > 0.0 ? wd_format(" %.3g m high", middle.height_m) : wd_strdup("");
    char *slender = middle.slender > 0.0 ? wd_format(", %.3g times as long as thick", middle.slender) : wd_strdup("");
    char *share = middle.share > 1.1 ? wd_format(", %.2g times the species' greatest height", middle.share) : wd_strdup("");
    wd_warn(log, "%s: the middle one of the trees would be%s%s%s%s%s; %s%s", inventory->path, thick,
            *thick && *tall ? " and" : "", tall, slender, share,
            *units ? "it would be a usual tree with " : "are the units right, and the species?", units);
    free(units);
    free(thick);
    free(tall);
    free(slender);
    free(share);
}
