/* Growing trees on one core: ours, and beside it ez-tree (npm) where node is there. */
#include "figures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "tree/coverage.h"
#include "tree/grow.h"
#include "tree/openness.h"

enum { RUNS = 15, TRIANGLES = 25000 };
static const char SPECIES[] = "species/oak.json";

/* Of this thread alone: what else the machine does is not counted. */
static double cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static uint32_t triangles(const struct wd_tree_model *model)
{
    return model->full.index_count / 3;
}

/* The detail that makes trees of about TRIANGLES. */
static bool find_detail(const struct wd_species *species, float *detail)
{
    float low = 0.01f, high = 4;
    for (int i = 0; i < 14; i++) {
        struct wd_tree_model model;
        *detail = 0.5f * (low + high);
        const struct wd_grow_params params = {.seed = 1, .openness = 0.35f, .detail = *detail};
        if (!wd_tree_grow(&model, species, &params, NULL))
            return false;
        if (triangles(&model) < TRIANGLES)
            low = *detail;
        else
            high = *detail;
        wd_tree_model_finish(&model);
    }
    return true;
}

/* What a grown model is asked once more takes as long as when it grew, or a little less. */
static double measuring_ms(struct wd_tree_model *model)
{
    double start_s = wd_clock_s();
    wd_tree_model_fit_openness(model);
    wd_tree_mesh_fit_coverage(&model->reduced, &model->full, (float[WD_LEAF_SETS]){0});
    return 1e3 * (wd_clock_s() - start_s);
}

/* Growing is skeleton, leaves, full mesh and reduced mesh, the sky that leaves see measured in the
 * one and the size of leaves in the other: the median of CPU times and the least of times on the
 * wall; of the latter what these two measurements take. */
static bool grow_ms(double *median_ms, double *least_wall_ms, double *least_measuring_ms)
{
    struct wd_arena arena = {0};
    struct wd_species species;
    double times[RUNS];
    float detail;
    *least_wall_ms = *least_measuring_ms = INFINITY;
    bool ok = wd_species_load(&species, SPECIES, &arena, NULL) && find_detail(&species, &detail);
    for (int i = -1; ok && i < RUNS; i++) {
        struct wd_tree_model model;
        const struct wd_grow_params params = {.seed = (uint32_t)(i + 2), .openness = 0.35f,
                                              .detail = detail};
        double start = cpu_ms(), start_wall_s = wd_clock_s();
        ok = wd_tree_grow(&model, &species, &params, NULL);
        if (ok && i >= 0) {
            times[i] = cpu_ms() - start;
            *least_wall_ms = fmin(*least_wall_ms, 1e3 * (wd_clock_s() - start_wall_s));
            *least_measuring_ms = fmin(*least_measuring_ms, measuring_ms(&model));
        }
        if (ok && i == 0)
            printf("%s, detail %.2f: %u triangles, %u of them wood, and %u in reduced meshes\n",
                   SPECIES, (double)detail, triangles(&model), model.full.wood_index_count / 3,
                   model.reduced.index_count / 3);
        wd_tree_model_finish(&model);
    }
    if (ok)
        *median_ms = bench_median(times, RUNS);
    wd_arena_finish(&arena);
    return ok;
}

bool bench_grow(const char *gpu)
{
    double ms, wall_ms, measuring;
    (void)gpu;
    if (!grow_ms(&ms, &wall_ms, &measuring))
        return false;
    printf("grow-25k-ms %.1f ms\n", ms);
    return true;
}

/* Least of ten times of ez-tree's default tree, from bench/ez_tree.sh; 0 where it cannot be run, which it has
 * said. */
static bool ez_tree_ms(double *ms)
{
    FILE *pipe = popen("bench/ez_tree.sh", "r");
    char line[256];
    *ms = 0;
    if (!pipe) {
        fprintf(stderr, "bench: bench/ez_tree.sh cannot be started\n");
        return false;
    }
    while (fgets(line, sizeof line, pipe)) {
        fputs(line, stdout);
        const char *least = strstr(line, " min ");
        if (strncmp(line, "default", 7) == 0 && least)
            *ms = strtod(least + 5, NULL);
    }
    return pclose(pipe) == 0;
}

/* In turns, so that what else the machine does meets both; the least of each, as it can only slow a run down. */
bool bench_grow_ratio(const char *gpu)
{
    enum { TURNS = 3 };
    double ours = INFINITY, measuring = INFINITY, theirs = INFINITY;
    (void)gpu;
    for (int turn = 0; turn < TURNS && theirs > 0; turn++) {
        double median, our_turn, measuring_turn, their_turn;
        if (!ez_tree_ms(&their_turn) || !grow_ms(&median, &our_turn, &measuring_turn))
            return false;
        ours = fmin(ours, our_turn);
        measuring = fmin(measuring, measuring_turn);
        theirs = fmin(theirs, their_turn);
    }
    if (theirs > 0)
        printf("ours %.1f ms, of which %.1f for openness and the reduced mesh's cover; ez-tree, which "
               "has neither that mesh nor these, %.1f ms\ngrow-vs-ez-tree %.2f x\n",
               ours, measuring, theirs, ours / theirs);
    return true;
}
