/* lod.h: errors of reduced forms, species by species. */
#ifndef WD_BENCH_LOD_H
#define WD_BENCH_LOD_H

#include "bias.h"

struct lod_choice {
    const char *gpu;
    const char *const *species; /* names, NULL after the last; none: all in ./species */
    unsigned forms;             /* bit i: bias_forms[i] */
    unsigned heights;           /* bit i: bias_height_px[i] */
    bool used;                  /* forms only where they are drawn by default */
    bool quick;                 /* of bias_stand */
    bool clouds;                /* not a clear sky */
};

struct lod_case {
    double pct;
    char name[64]; /* species, form, height and view */
};

struct lod_worst {
    struct lod_case coverage, radiance;           /* of every form and height */
    struct lod_case used_coverage, used_radiance; /* of forms where they are drawn by default */
};

/* Prints a line for each species, form, height and view. */
bool lod_run(struct lod_worst *worst, const struct lod_choice *choice);

#endif
