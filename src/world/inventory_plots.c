/* inventory_plots.c: files of several plots, whose places may count from each plot's own corner. */
#include "world/inventory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { MOST_PLOTS = 64 }; /* that many tell what the others are */

void wd_inventory_plots_add(struct wd_inventory_plots *plots, const char *name, double x, double y)
{
    size_t i = 0;
    while (i < plots->count && strcmp(plots->plots[i].name, name) != 0)
        i++;
    if (i == MOST_PLOTS)
        return;
    if (i == plots->count)
        *wd_push(plots->plots, plots->count, plots->capacity) = (struct wd_inventory_plot){wd_strdup(name), {x, y}, {x, y}};
    struct wd_inventory_plot *plot = &plots->plots[i];
    plot->min[0] = fmin(plot->min[0], x);
    plot->min[1] = fmin(plot->min[1], y);
    plot->max[0] = fmax(plot->max[0], x);
    plot->max[1] = fmax(plot->max[1], y);
}

/* Whether they share more than half of the smaller one: neighbours that are turned share a quarter at most. */
static bool lie_on_one_another(const struct wd_inventory_plot *a, const struct wd_inventory_plot *b)
{
    double shared = 1.0, first = 1.0, second = 1.0;
    for (int i = 0; i < 2; i++) {
        shared *= fmax(fmin(a->max[i], b->max[i]) - fmax(a->min[i], b->min[i]), 0.0);
        first *= a->max[i] - a->min[i];
        second *= b->max[i] - b->min[i];
    }
    return shared > 0.5 * fmin(first, second);
}

void wd_inventory_plots_warn(const struct wd_inventory_plots *plots, const char *path, const char *column,
                             const struct wd_log *log)
{
    size_t on_first = 0, other = 0;
    for (size_t i = 1; i < plots->count; i++)
        if (lie_on_one_another(&plots->plots[0], &plots->plots[i])) {
            on_first++;
            other = other ? other : i;
        }
    if (on_first > 0 && on_first >= plots->count / 2)
        wd_warn(log, "%s: %s %s and %s lie on one another; if x and y count from each plot's own corner, make each plot an "
                "inventory, moved by its \"offset_m\"", path, column, plots->plots[0].name, plots->plots[other].name);
}

void wd_inventory_plots_finish(struct wd_inventory_plots *plots)
{
    for (size_t i = 0; i < plots->count; i++)
        free(plots->plots[i].name);
    free(plots->plots);
    *plots = (struct wd_inventory_plots){0};
}
