#include "bench.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "args.h"

enum { NAME_SIZE = 41 }; /* of a scene in the results, where a setting may follow */

/* Quick: fewer and smaller views than the papers', baking them takes most of a first run. */
static const struct bench_effort QUICK = {
    .name = "quick",
    .frames = 9, .width = 320, .height = 240, .budget_s = 0.6, .least_frames = 1,
    .samples = 2, .truth_samples = 12, .truth_width = 128, .truth_height = 96,
    .steps = 6, .step_samples = 12, .step_width = 128, .step_height = 96,
    .settings = {"methods.views.rows=5", "methods.views.columns=16", "methods.views.samples=2",
                 "methods.zfield.rows=5", "methods.zfield.size=64", "methods.zfield.samples=2"},
};
static const struct bench_effort FULL = {
    .name = "full",
    .frames = 40, .width = 800, .height = 600, .budget_s = 5, .least_frames = 9,
    .samples = 8, .truth_samples = 128, .truth_width = 400, .truth_height = 300,
    .steps = 12, .step_samples = 32, .step_width = 240, .step_height = 180,
};

/* What grid and separate draw is octree's picture to the bit (row G9 of docs/methods.md). */
#define METHODS_BY_PICTURE "octree,lod,patch,dissolve,impostor,views,zfield,continuum"

static const struct bench_suite suites[] = {
    {"seeds", "the scenes of the seed documents, every method: time, memory, image error",
     {"guerrero", "rpi", "3dworld", "osg", "intel", "bruneton"},
     {NULL}, BENCH_FIRST_CAMERA, {{0}}, BENCH_TIME | BENCH_ERROR},
    {"scale", "10 thousand to a billion trees, and a road through trees and shrubs: continuum's time and memory",
     {"scale", "road"},
     {"terrain.size_m=[485,485]", "terrain.size_m=[1530,1530]", "terrain.size_m=[4850,4850]",
      "terrain.size_m=[15300,15300]", "terrain.size_m=[48500,48500]",
      "terrain.size_m=[153000,153000]"},
     BENCH_FIRST_CAMERA, {{"road", 1920, 1080}, {"9 km", 1920, 1080}}, BENCH_TIME, "continuum"},
    {"density", "one square kilometre with more and more trees: time and memory",
     {"bench75k"},
     {"layers.0.spacing_m=10", "layers.0.spacing_m=3.65", "layers.0.spacing_m=1.8"},
     BENCH_FIRST_CAMERA, {{0}}, BENCH_TIME},
    {"quality", "every camera of two forests: image error",
     {"bench75k", "valley"},
     {NULL}, BENCH_EVERY_CAMERA, {{0}}, BENCH_TIME | BENCH_ERROR, METHODS_BY_PICTURE, 2},
    {"popping", "slow camera paths: how much more frames change than the truth does",
     {"bench75k", "osg"},
     {NULL}, BENCH_EVERY_CAMERA, {{0}}, BENCH_TIME | BENCH_POPPING, METHODS_BY_PICTURE, 1},
};
enum { SUITES = sizeof suites / sizeof *suites };

/* --- choosing ---------------------------------------------------------------------------------- */

static bool complain_name(struct cli_session *session, const char *what, const char *word,
                          const char *const *names)
{
    char all[512] = "";
    const char *suggestion = cli_suggest(word, names);
    for (size_t i = 0; names[i]; i++)
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", i ? ", " : "", names[i]);
    return cli_fail(session, "there is no %s \"%s\"%s%s%s; there are %s", what, word,
                    suggestion ? ", did you mean " : "", suggestion ? suggestion : "",
                    suggestion ? "?" : "", all);
}

static bool choose_suite(struct bench *bench)
{
    const char *wanted = bench->session->options->suite, *names[SUITES + 1] = {0};
    for (size_t i = 0; i < SUITES; i++) {
        names[i] = suites[i].name;
        if (wanted && strcmp(wanted, suites[i].name) == 0)
            bench->suite = &suites[i];
    }
    if (!wanted)
        return cli_fail(bench->session, "no suite named: add --suite seeds, scale, density, "
                                        "quality or popping");
    return bench->suite || complain_name(bench->session, "suite", wanted, names);
}

static bool choose_metric(struct bench *bench)
{
    const char *wanted = bench->session->options->metric;
    const char *const *names = wd_comparison_names();
    bench->metric = bench->suite->measures & BENCH_POPPING ? BENCH_POPPING_MEAN : BENCH_FLIP;
    if (!wanted)
        return true;
    if (!(bench->suite->measures & BENCH_ERROR))
        return cli_fail(bench->session, "--metric is of errors against the reference, which the suite %s does not measure",
                        bench->suite->name);
    for (uint32_t i = 0; names[i]; i++) {
        if (strcmp(names[i], wanted) == 0) {
            bench->metric = BENCH_COMPARISON + i;
            return true;
        }
    }
    return complain_name(bench->session, "metric", wanted, names);
}

/* Names divided by commas, or all. */
static bool choose_methods(struct bench *bench)
{
    const char *const *names = wd_method_names();
    const char *wanted = bench->session->options->methods;
    if (!wanted)
        wanted = bench->suite->methods;
    char *list = wanted ? strdup(wanted) : NULL;
    size_t count = 0;
    char *rest = NULL;
    bool ok = true;
    if (!list)
        for (; count < 31 && names[count]; count++)
            bench->methods[count] = names[count];
    for (char *word = list ? strtok_r(list, ",", &rest) : NULL; word && ok && count < 31;
         word = strtok_r(NULL, ",", &rest)) {
        size_t i = 0;
        while (names[i] && strcmp(names[i], word) != 0)
            i++;
        if (names[i])
            bench->methods[count++] = names[i];
        else
            ok = complain_name(bench->session, "method", word, names);
    }
    if (ok && !count)
        ok = cli_fail(bench->session, "--methods names none");
    free(list);
    return ok;
}

void bench_label(char label[64], const char *name)
{
    snprintf(label, 64, "%.63s", name);
    for (char *at = label; (at = strpbrk(at, ",/\n"));)
        *at = ' '; /* commas and lines part results, strokes folders */
}

char *bench_path(const struct bench *bench, const char *format, ...)
{
    char name[256], *path = NULL;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    if (asprintf(&path, "%s/%s", bench->directory, name) < 0)
        abort();
    return path;
}

static bool make_directories(struct bench *bench)
{
    static const char *const names[] = {"", "reference", "pictures"};
    for (size_t i = 0; i < 3; i++) {
        char *path = bench_path(bench, "%s", names[i]);
        bool ok = mkdir(path, 0777) == 0 || errno == EEXIST;
        if (!ok)
            cli_fail(bench->session, "%s: %s", path, strerror(errno));
        free(path);
        if (!ok)
            return false;
    }
    return true;
}

/* Until the program ends. File systems without locks go without. */
static bool lock_directory(const struct bench *bench)
{
    int directory = open(bench->directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0 || flock(directory, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
        return true;
    close(directory);
    return cli_fail(bench->session, "%s: another process is at work in this directory", bench->directory);
}

/* What results call a scene. */
static void name_of(const char *path, char name[NAME_SIZE])
{
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path, *dot = strrchr(base, '.');
    snprintf(name, NAME_SIZE, "%.*s", (int)(dot ? dot - base : (ptrdiff_t)strlen(base)), base);
}

static bool check_names(const struct bench *bench)
{
    const struct cli_options *options = bench->session->options;
    for (int i = 1; i < options->operand_count; i++)
        for (int k = 0; k < i; k++) {
            char name[NAME_SIZE], other[NAME_SIZE];
            name_of(options->operands[i], name);
            name_of(options->operands[k], other);
            if (strcmp(name, other) == 0)
                return cli_fail(bench->session, "%s and %s would both be \"%s\" in the results: rename one",
                                options->operands[k], options->operands[i], name);
        }
    return true;
}

static bool prepare(struct bench *bench)
{
    const struct cli_options *options = bench->session->options;
    bench->directory = options->output;
    bench->effort = options->quick ? QUICK : FULL;
    if (!bench->directory)
        return cli_fail(bench->session, "no directory named: add -o DIR for results and report");
    if (!choose_suite(bench) || !choose_metric(bench) || !choose_methods(bench) || !check_names(bench))
        return false;
    if (options->size_px[0]) {
        bench->effort.width = options->size_px[0];
        bench->effort.height = options->size_px[1];
    }
    return true;
}

/* --- running ----------------------------------------------------------------------------------- */

static bool row_missing(const struct bench *bench, const char *scene, const char *camera_name)
{
    char camera[64];
    bench_label(camera, camera_name);
    for (size_t i = 0; bench->methods[i]; i++)
        if (!bench_results_find(bench, scene, camera, bench->methods[i]))
            return true;
    return false;
}

static enum wd_result measure_row(struct bench_stage *stage, const struct wd_camera *camera,
                                  const char *camera_label, const char *method)
{
    struct bench *bench = stage->bench;
    struct bench_row row = {0};
    struct wd_forest_info info;
    wd_forest_get_info(stage->forest, &info);
    snprintf(row.scene, sizeof row.scene, "%s", stage->scene);
    snprintf(row.camera, sizeof row.camera, "%s", camera_label);
    snprintf(row.method, sizeof row.method, "%s", method);
    snprintf(row.forest, sizeof row.forest, "%016llx", (unsigned long long)stage->forest_key);
    for (uint32_t i = 0; i < BENCH_COLUMNS; i++)
        row.values[i] = NAN;
    row.values[BENCH_TREES] = (double)info.tree_count;
    row.values[BENCH_START_S] = stage->start_s;
    enum wd_result result = bench_measure_time(stage, camera, &row);
    if (result == WD_OK && bench->suite->measures & BENCH_ERROR)
        result = bench_measure_error(stage, camera, &row);
    if (result == WD_OK && bench->suite->measures & BENCH_POPPING)
        result = bench_measure_popping(stage, camera, &row);
    if (result == WD_OK && !bench_results_add(bench, &row))
        result = WD_ERROR_OUTPUT;
    return result;
}

static const struct bench_view *find_view(const struct bench_suite *suite, const char *camera)
{
    for (const struct bench_view *view = suite->views; view->camera; view++)
        if (strcmp(view->camera, camera) == 0)
            return view;
    return NULL;
}

void bench_frame_size(const struct bench *bench, const char *camera, uint32_t size_px[2])
{
    const struct cli_options *options = bench->session->options;
    const struct bench_view *view = find_view(bench->suite, camera);
    bool own_size = view && !options->quick && !options->size_px[0];
    size_px[0] = own_size ? view->width : bench->effort.width;
    size_px[1] = own_size ? view->height : bench->effort.height;
}

static bool is_measured(const struct bench_suite *suite, uint32_t index, const char *camera)
{
    return index == 0 || suite->cameras == BENCH_EVERY_CAMERA || find_view(suite, camera);
}

static enum wd_result measure_cameras(struct bench_stage *stage)
{
    struct bench *bench = stage->bench;
    enum wd_result result = WD_OK;
    const char *name;
    for (uint32_t i = 0; result == WD_OK && (name = wd_forest_camera_name(stage->forest, i)); i++) {
        struct wd_camera camera;
        char label[64];
        if (!is_measured(bench->suite, i, name))
            continue;
        bench_label(label, name);
        result = wd_forest_get_camera(stage->forest, name, &camera);
        for (size_t m = 0; result == WD_OK && bench->methods[m]; m++) {
            if (cli_session_interrupted(bench->session))
                return WD_ERROR_INTERRUPTED;
            if (bench_results_find(bench, stage->scene, label, bench->methods[m]))
                continue;
            cli_say(bench->session, "%s, %s: %s\n", stage->scene, name, bench->methods[m]);
            result = measure_row(stage, &camera, label, bench->methods[m]);
        }
    }
    return result;
}

static bool everything_known(const struct bench *bench, const struct wd_forest *forest,
                             const char *scene)
{
    const char *name;
    for (uint32_t i = 0; (name = wd_forest_camera_name(forest, i)); i++) {
        if (is_measured(bench->suite, i, name) && row_missing(bench, scene, name))
            return false;
    }
    return true;
}

static enum wd_result open_renderer(struct bench_stage *stage)
{
    struct bench *bench = stage->bench;
    double begin_s = cli_seconds();
    enum wd_result result = cli_renderer_open(bench->session, &stage->renderer);
    if (result == WD_OK)
        result = wd_renderer_set_forest(stage->renderer, stage->forest);
    stage->start_s += cli_seconds() - begin_s;
    if (result == WD_OK)
        snprintf(bench->device, sizeof bench->device, "%s",
                 wd_renderer_device_name(stage->renderer));
    return result == WD_OK && !bench_machine_fits(bench) ? WD_ERROR_INPUT : result;
}

/* All methods but continuum keep every tree. */
static bool keeps_trees(const struct bench *bench)
{
    for (size_t i = 0; bench->methods[i]; i++)
        if (strcmp(bench->methods[i], "continuum") != 0)
            return true;
    return false;
}

/* The effort's, then the suite's, then the user's, which win. */
static void gather_settings(const struct bench *bench, const char *of_suite, const char **settings)
{
    const struct cli_words *words = &bench->session->options->settings;
    size_t count = 0;
    for (size_t i = 0; bench->effort.settings[i]; i++)
        settings[count++] = bench->effort.settings[i];
    if (!bench->session->options->operand_count && keeps_trees(bench))
        settings[count++] = "planting=stored";
    if (of_suite)
        settings[count++] = of_suite;
    for (uint32_t i = 0; i < words->count; i++)
        settings[count++] = words->words[i];
}

static enum wd_result run_scene(struct bench *bench, const char *path, const char *label,
                                const char *setting)
{
    const char *settings[CLI_MAX_WORDS + 10] = {0};
    struct bench_stage stage = {.bench = bench, .scene = label};
    const struct wd_forest_params params = {
        .scene_path = path,
        .data_dir = bench->session->options->data,
        .settings = settings,
        .threads = bench->session->options->threads,
        .progress = bench->session->progress,
        .log = bench->session->log,
    };
    gather_settings(bench, setting, settings);
    double begin_s = cli_seconds();
    enum wd_result result = wd_forest_create(&stage.forest, &params);
    stage.start_s = cli_seconds() - begin_s;
    if (result == WD_OK) {
        stage.forest_key = wd_forest_key(stage.forest);
        stage.reference_key = wd_reference_key(stage.forest);
        if (!bench_results_fit(&stage))
            result = WD_ERROR_INPUT;
    }
    if (result == WD_OK && !everything_known(bench, stage.forest, label)) {
        result = open_renderer(&stage);
        if (result == WD_OK)
            result = measure_cameras(&stage);
    }
    wd_reference_destroy(&stage.reference);
    cli_renderer_close(bench->session, &stage.renderer);
    wd_forest_destroy(&stage.forest);
    return result;
}

/* Beside the working directory, or where scenes are installed. */
static char *scene_path(const char *name)
{
    char *path = NULL;
    struct stat status;
    if (asprintf(&path, "scenes/%s.json", name) < 0)
        abort();
    if (stat(path, &status) == 0)
        return path;
    free(path);
    if (asprintf(&path, "%s/scenes/%s.json", WEALD_DATA_DIR, name) < 0)
        abort();
    return path;
}

/* The scenes of the suite, or those named on the command line. */
static enum wd_result run_suite(struct bench *bench)
{
    const struct cli_options *options = bench->session->options;
    const struct bench_suite *suite = bench->suite;
    enum wd_result result = WD_OK;
    for (int i = 0; result == WD_OK; i++) {
        if (options->operand_count ? i >= options->operand_count : !suite->scenes[i])
            break;
        char *path = options->operand_count ? strdup(options->operands[i])
                                            : scene_path(suite->scenes[i]);
        char name[NAME_SIZE], label[64];
        name_of(path, name);
        for (int s = 0; result == WD_OK && (s == 0 || (i == 0 && suite->settings[s])); s++) {
            const char *setting = options->operand_count || i > 0 ? NULL : suite->settings[s];
            const char *value = setting ? strchr(setting, '=') + 1 : NULL;
            char whole[256];
            snprintf(whole, sizeof whole, "%s%s%s", name, value ? " " : "", value ? value : "");
            bench_label(label, whole);
            result = run_scene(bench, path, label, setting);
            if (options->operand_count)
                break;
        }
        free(path);
    }
    return result;
}

enum cli_status cli_bench(struct cli_session *session)
{
    struct bench bench = {.session = session}, earlier = {0};
    if (!prepare(&bench))
        return CLI_USAGE;
    if (session->options->against && !bench_results_load_earlier(&earlier, &bench))
        return CLI_FAILED;
    if (!make_directories(&bench) || !lock_directory(&bench) || !bench_results_load(&bench))
        return CLI_FAILED;
    if (bench.resumed)
        cli_say(session, "%s: %zu results are there already\n", bench.directory, bench.resumed);
    enum wd_result result = run_suite(&bench);
    if (result == WD_ERROR_INTERRUPTED)
        cli_say(session, "%s: stopped; the same command goes on from here\n", bench.directory);
    if (result == WD_OK) {
        cli_meter_clear(&session->meter);
        bench_print_table(&bench);
        if (session->options->against)
            bench_print_against(&bench, &earlier);
        if (!bench_write_json(&bench) || !bench_write_html(&bench))
            result = WD_ERROR_OUTPUT;
    }
    if (result == WD_OK)
        cli_say(session, "%s: results.csv, results.json, report.html, %.1f s\n", bench.directory,
                cli_seconds() - session->meter.begin_s);
    free(bench.rows);
    free(earlier.rows);
    return cli_session_status(session, result);
}
