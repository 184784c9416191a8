/* bench.h: `weald bench`: methods measured against each other and against the path tracer. */
#ifndef CLI_BENCH_H
#define CLI_BENCH_H

#include <stdio.h>

#include "cli.h"
#include "weald/compare.h"
#include "weald/reference.h"

/* Columns of the results; a value that was not measured is NaN. */
enum bench_column {
    BENCH_TREES,
    BENCH_START_S, /* from nothing to trees on the device; the same for all methods of a scene */
    BENCH_FRAME_MS, /* median of one sample, wall clock */
    BENCH_FRAME_P95_MS,
    BENCH_FRAME_P99_MS,
    BENCH_FRAMES, /* that these are of */
    BENCH_GPU_MS, /* all passes */
    BENCH_CPU_MS,
    BENCH_DRAWS,
    BENCH_TRIANGLES,
    BENCH_DEVICE_MB,
    BENCH_HOST_MB, /* peak of the program so far */
    BENCH_COMPARISON, /* the members of struct wd_comparison */
    BENCH_FLIP = BENCH_COMPARISON,
    BENCH_SSIM,
    BENCH_BLOCKS = BENCH_COMPARISON + 3,
    BENCH_BIAS, /* of radiance, trees and coverage, the last of the comparison */
    BENCH_NOISE_FLIP = BENCH_COMPARISON + 7, /* of the reference: what its picture is away from where
                                                more samples would bring it, by FLIP */
    BENCH_NOISE_BLOCKS,                      /* and by block_rmse_pct */
    BENCH_POPPING_MEAN,                      /* frame-to-frame change over the reference's own, of 4 x 4
                                                blocks, in percent of white */
    BENCH_POPPING_P999,
    BENCH_POPPING_STEP, /* the largest */
    BENCH_BOUNDARY_STEP, /* mean of a tree's blocks that change their level, of the tree where it is the
                            largest: full to reduced mesh, reduced to billboard, full to billboard,
                            billboard to canopy map */
    BENCH_COLUMNS = BENCH_BOUNDARY_STEP + 4,
};

enum { BENCH_BOUNDARIES = BENCH_COLUMNS - BENCH_BOUNDARY_STEP };

/* Names of the columns, BENCH_COLUMNS of them. */
const char *bench_column_name(uint32_t column);

struct bench_row {
    char scene[64], camera[64], method[32]; /* labels: bench_label */
    char forest[20]; /* its key, as hexadecimal digits */
    char passes[480]; /* "name=gpu_ms+cpu_ms;..." */
    double values[BENCH_COLUMNS];
};

/* How much work a run is. */
struct bench_effort {
    const char *name; /* "quick", "full" */
    uint32_t frames, width, height;                    /* timing */
    double budget_s;       /* frames end after so long */
    uint32_t least_frames; /* but not before there are so many */
    uint32_t samples, truth_samples, truth_width, truth_height; /* image error */
    uint32_t steps, step_samples, step_width, step_height;      /* popping */
    const char *settings[8]; /* of every scene, ended by NULL */
};

struct bench_suite {
    const char *name, *summary;
    const char *scenes[8];   /* in scenes/, without .json */
    const char *settings[8]; /* the first scene is measured with each; none: as it is */
    enum bench_cameras { BENCH_FIRST_CAMERA, BENCH_EVERY_CAMERA } cameras;
    /* measured beside the first camera, in scenes that have them; in full as large as this */
    struct bench_view { const char *camera; uint32_t width, height; } views[3];
    enum bench_measures { BENCH_TIME = 1, BENCH_ERROR = 2, BENCH_POPPING = 4 } measures;
    const char *methods; /* "A,B": those measured unless others are named; NULL: all */
    double budget_s;     /* of frames, where that is less than the effort's; 0: the effort's */
};

struct bench {
    struct cli_session *session;
    const struct bench_suite *suite;
    struct bench_effort effort;
    const char *directory;
    const char *methods[32]; /* ended by NULL */
    uint32_t metric;         /* the column of errors that plots and the table are about */
    char device[128];
    struct bench_row *rows;
    size_t row_count, row_capacity;
    size_t resumed;          /* rows taken over from an interrupted run */
};

/* One scene with its device, while its rows are measured. */
struct bench_stage {
    struct bench *bench;
    const char *scene; /* label in the results */
    struct wd_forest *forest;
    uint64_t forest_key, reference_key;
    struct wd_renderer *renderer;
    struct wd_reference *reference; /* NULL until a picture of it is needed */
    double start_s;
};

/* Rows of results on disk: results.csv, a line as soon as it is measured. */
bool bench_results_load(struct bench *bench);
/* Rows of the run that --against names; free() them. What it measured otherwise is told. */
bool bench_results_load_earlier(struct bench *earlier, const struct bench *bench);
bool bench_results_add(struct bench *bench, const struct bench_row *row);
/* Whether the rows that are there of the stage's scene, if any, were measured in its forest; else it is said. */
bool bench_results_fit(const struct bench_stage *stage);
const struct bench_row *bench_results_find(const struct bench *bench, const char *scene,
                                           const char *camera, const char *method);

/* Pixels of the frames that are timed from a camera. */
void bench_frame_size(const struct bench *bench, const char *camera, uint32_t size_px[2]);

/* Measures into `*row`. WD_ERROR_INTERRUPTED when asked to stop. */
enum wd_result bench_measure_time(struct bench_stage *stage, const struct wd_camera *camera,
                                  struct bench_row *row);
enum wd_result bench_measure_error(struct bench_stage *stage, const struct wd_camera *camera,
                                   struct bench_row *row);
enum wd_result bench_measure_popping(struct bench_stage *stage, const struct wd_camera *camera,
                                     struct bench_row *row);

/* Keeps DIRECTORY/pictures/SCENE-CAMERA-WHAT as PNG and small as JPEG. */
enum wd_result bench_keep_picture(struct bench_stage *stage, const struct wd_picture *picture,
                                  const struct bench_row *row, const char *what);
/* Replaces what the picture shows by its errors, 0..1. */
void bench_map_error(struct wd_picture *picture, const float *error);

/* The path-traced picture, from DIRECTORY/reference if it has been traced before. */
enum wd_result bench_truth(struct bench_stage *stage, const char *name,
                           const struct wd_reference_picture_params *params,
                           struct wd_picture *picture);

void bench_print_table(const struct bench *bench);
void bench_print_against(const struct bench *bench, const struct bench *earlier);
bool bench_write_json(const struct bench *bench);
bool bench_write_html(const struct bench *bench);

/* Parts of the report. A plot of what was measured at one place: time across, `column` up, a dot a
 * method. The best, than which none is both faster and nearer, are joined by a line; a dashed line is
 * the reference's own noise where that is known. */
void bench_print_plot(FILE *to, const struct bench *bench, const struct bench_row *place,
                      uint32_t column);
/* Trees across, `column` up, both logarithmic, a line a method, over all places of the suite's first
 * scene. */
void bench_print_growth(FILE *to, const struct bench *bench, uint32_t column);
/* Bars of a place's passes. */
void bench_print_passes(FILE *to, const struct bench *bench, const struct bench_row *place);
/* The column's name in words: "frame p95, ms". */
void bench_column_title(uint32_t column, char title[64]);
/* Which of the style sheet's colours a method has. */
uint32_t bench_method_color(const char *method);
bool bench_same_place(const struct bench_row *a, const struct bench_row *b);
/* What the better of two values in `column` is: "lower", "higher" or "nearer to 0". */
const char *bench_better(uint32_t column);
/* Whether no method at that place is both faster and better in `column`. */
bool bench_is_best(const struct bench *bench, const struct bench_row *row, uint32_t column);

/* A name as it stands in columns of results and in files' names. */
void bench_label(char label[64], const char *name);
/* DIRECTORY/NAME appears with what `print` says, whole or not at all. */
bool bench_write(const struct bench *bench, const char *name,
                 void (*print)(FILE *to, const struct bench *bench));
/* DIRECTORY/NAME as printf's; free() it. */
__attribute__((format(printf, 2, 3))) char *bench_path(const struct bench *bench,
                                                       const char *format, ...);
/* Whether results that are there, if any, are of the same device; else it is said. Writes down what this machine is. */
bool bench_machine_fits(const struct bench *bench);
/* Words of the machine and device, a line each; free() it. */
char *bench_machine_text(const struct bench *bench);
double bench_percentile(double *values, size_t count, double share); /* sorts them */

#endif
