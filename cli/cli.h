/* cli.h: what the commands of the program share: options, messages, progress. */
#ifndef CLI_CLI_H
#define CLI_CLI_H

#include <stdatomic.h>
#include <signal.h>
#include <pthread.h>

#include "weald/renderer.h"

enum cli_status {
    CLI_OK = 0,
    CLI_FAILED = 1,
    CLI_USAGE = 2,
    CLI_NO_DISPLAY = 3, /* `view` found no display to open a window on */
};

/* Commands as bits: an option says which of them know it. */
enum cli_command_bit {
    CLI_RENDER = 1 << 0,
    CLI_VIEW = 1 << 1,
    CLI_INFO = 1 << 2,
    CLI_CHECK = 1 << 3,
    CLI_SCHEMA = 1 << 4,
    CLI_DEVICES = 1 << 5,
    CLI_MANUAL = 1 << 6,
    CLI_METHODS = 1 << 7,
    CLI_GROW = 1 << 8,
    CLI_EXPORT = 1 << 9,
    CLI_BENCH = 1 << 10,
    CLI_BATCH = 1 << 11,
    CLI_EVERY = (1 << 12) - 1,
};

enum { CLI_MAX_SIZE_PX = WD_MOST_SIZE_PX, CLI_MAX_WORDS = 32 };

/* What an option that may be given more than once was given. */
struct cli_words {
    const char *words[CLI_MAX_WORDS];
    uint32_t count;
};

/* Values of all options; those not given are 0, NULL or false. */
struct cli_options {
    char **operands;
    int operand_count;
    const char *output, *camera, *path, *clock, *only, *method, *seed, *data, *gpu;
    const char *screenshots, *report;
    const char *suite, *metric, *methods, *against;
    uint32_t size_px[2];
    uint32_t samples, frames, threads, bounces;
    uint32_t variants, max_trees, grow_seed;
    double frames_per_second, time_s, max_error_px, budget_ms, max_fps;
    double height_m, dbh_cm, age_years, openness, detail, month, distance_m; /* of grow */
    const char *season, *form, *clip, *layers;
    struct cli_words settings, method_options;
    enum wd_view_mode view;
    bool help, json, quiet, quick, reference, times, gpu_validate, walk, single, sheet,
         faithful, skip_existing;
};

/* The bar on standard error, or plain lines at every quarter where that is no terminal. Silent in
 * the first two seconds. */
struct cli_meter {
    double begin_s;
    double drawn_s;
    bool terminal, quiet, bar_shown;
    const char *stage; /* of the newest plain line */
    unsigned quarter;
    uint64_t frame, frame_count; /* of a film; frame_count 0: no film */
};

/* Waits for SIGINT and SIGTERM on a thread of its own, which answers the first; the second ends the program at once. */
struct cli_interrupt {
    atomic_int signal; /* 0: none came */
    pthread_t thread;
    sigset_t signals;
};

/* What one line of `batch` leaves to the next, and what it was opened with. */
struct cli_kept {
    struct wd_renderer *renderer;
    const char *gpu;
    bool gpu_validate;
    uint32_t threads;
    struct wd_forest *forest;
    char *forest_text;             /* all that it was made of */
    const struct wd_forest *shown; /* what the renderer has on its device: NULL or `forest` */
};

struct cli_session {
    const struct cli_options *options;
    struct cli_kept *kept; /* of batch; NULL: renderers and forests are closed after use */
    struct cli_meter meter;
    struct cli_interrupt interrupt;
    struct wd_log log;
    struct wd_progress progress;
};

struct cli_command {
    const char *name;
    unsigned bit;
    const char *operands; /* as the usage line shows them */
    int operands_min, operands_max;
    const char *summary; /* one line */
    const char *description;
    const char *examples; /* lines of "command  # what for" */
    enum cli_status (*run)(struct cli_session *session);
};

/* All commands, ended by one without a name. */
const struct cli_command *cli_commands(void);
const struct cli_command *cli_command_find(const char *name); /* NULL: there is none */

bool cli_session_start(struct cli_session *session, const struct cli_options *options);
/* Goes on with other options, as if started anew. */
void cli_session_take(struct cli_session *session, const struct cli_options *options);
/* Only after a successful start. */
void cli_session_finish(struct cli_session *session);
bool cli_session_interrupted(const struct cli_session *session);
/* What the program exits with after `result`. */
enum cli_status cli_session_status(const struct cli_session *session, enum wd_result result);
/* A film's frames become the outer measure of progress, a frame's samples the inner one. */
void cli_session_film_progress(struct cli_session *session, uint64_t frame, uint64_t frame_count);
/* Takes the bar off the screen before something else is printed. */
void cli_meter_clear(struct cli_meter *meter);
double cli_seconds(void);
/* `key` with a text hashed into it (FNV-1a). */
uint64_t cli_key_text(uint64_t key, const char *text);

__attribute__((format(printf, 2, 3))) void cli_say(struct cli_session *session, const char *format,
                                                   ...); /* standard output unless --quiet */
__attribute__((format(printf, 2, 3))) bool cli_fail(struct cli_session *session, const char *format,
                                                    ...); /* returns false */

/* The forest that the scene operand and the options ask for, or the kept one; close it after use.
 * Its method is --method only where options of that method are given. */
enum wd_result cli_forest_open(struct cli_session *session, struct wd_forest **forest);
void cli_forest_close(struct cli_session *session, struct wd_forest **forest);
/* A renderer on the device that the options ask for, or the kept one; close it after use. */
enum wd_result cli_renderer_open(struct cli_session *session, struct wd_renderer **renderer);
void cli_renderer_close(struct cli_session *session, struct wd_renderer **renderer);
/* As wd_renderer_set_forest, with nothing to do where the kept renderer has it. */
enum wd_result cli_renderer_show(struct cli_session *session, struct wd_renderer *renderer,
                                 const struct wd_forest *forest);
/* The next line reads its files anew. */
void cli_kept_drop_forest(struct cli_kept *kept);
void cli_kept_finish(struct cli_kept *kept);
/* Whether there is a method of that name; complains if not. */
bool cli_method_known(struct cli_session *session, const char *name);
/* Tells a wrong --method from a right one before any long work. */
bool cli_method_check(struct cli_session *session);
/* Whether at most one of --max-error and --budget-ms is given. */
bool cli_error_check(struct cli_session *session);
/* Whether the method in use has the error bound that --max-error or --budget-ms ask for. */
bool cli_bound_check(struct cli_session *session, const struct wd_forest *forest);
/* The same for --camera and --path. */
bool cli_places_check(struct cli_session *session, const struct wd_forest *forest);
/* That of --camera, of the scene or saved by the viewer; the scene's first. */
enum wd_result cli_camera(const struct cli_session *session, const struct wd_forest *forest, struct wd_camera *camera);

enum cli_status cli_render(struct cli_session *session);
enum cli_status cli_grow(struct cli_session *session);
enum cli_status cli_export(struct cli_session *session);
enum cli_status cli_view(struct cli_session *session);
enum cli_status cli_info(struct cli_session *session);
enum cli_status cli_check(struct cli_session *session);
enum cli_status cli_batch(struct cli_session *session);
enum cli_status cli_schema(struct cli_session *session);
enum cli_status cli_devices(struct cli_session *session);
enum cli_status cli_bench(struct cli_session *session);
enum cli_status cli_manual(struct cli_session *session);
enum cli_status cli_methods(struct cli_session *session);

#endif
