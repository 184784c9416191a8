#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "grow.h"
#include "output_name.h"

enum { DEFAULT_SIZE_PX = 900, DEFAULT_SAMPLES = 16 };

/* --- what was asked for ------------------------------------------------------------------ */

enum grow_kind { GROW_PICTURE, GROW_MODEL, GROW_UNKNOWN };

static enum grow_kind kind_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    if (dot && (!strcasecmp(dot, ".glb") || !strcasecmp(dot, ".obj")))
        return GROW_MODEL;
    enum cli_output_kind kind = cli_output_kind(path);
    return kind == CLI_OUTPUT_PNG || kind == CLI_OUTPUT_EXR ? GROW_PICTURE : GROW_UNKNOWN;
}

bool cli_season_month(struct cli_session *session, double *month)
{
    static const struct {
        const char *name;
        double month;
    } seasons[] = {{"spring", 5}, {"summer", 7.5}, {"autumn", 10.6}, {"winter", 1.5}};
    const struct cli_options *options = session->options;
    *month = options->month;
    if (!options->season)
        return true;
    if (options->month > 0)
        return cli_fail(session, "--season and --month exclude each other");
    for (size_t i = 0; i < sizeof seasons / sizeof *seasons; i++) {
        if (!strcmp(seasons[i].name, options->season)) {
            *month = seasons[i].month;
            return true;
        }
    }
    return cli_fail(session, "there is no season \"%s\"; there are: spring, summer, autumn, winter",
                    options->season);
}

static bool check_options(struct cli_session *session, enum grow_kind *kind)
{
    const struct cli_options *options = session->options;
    if (!options->output)
        return cli_fail(session, "no output named: add -o FILE.glb, .obj, .png or .exr");
    *kind = kind_of(options->output);
    if (*kind == GROW_UNKNOWN)
        return cli_fail(session, "%s: the output must end in .glb, .obj, .png or .exr",
                        options->output);
    if (options->sheet)
        return cli_output_kind(options->output) == CLI_OUTPUT_PNG ||
               cli_fail(session, "%s: a sheet is a .png", options->output);
    if (options->operand_count < 1)
        return cli_fail(session, "no species named: a species, a species file or a model");
    return options->operand_count == 1 || !options->variants ||
           cli_fail(session, "--variants goes with one species");
}

/* --- specimens --------------------------------------------------------------------------- */

struct grown {
    struct wd_specimen **items;
    uint32_t count;
};

static enum wd_result grow_all(struct cli_session *session, struct grown *grown)
{
    const struct cli_options *options = session->options;
    struct wd_specimen_params params = {
        .height_m = options->height_m,
        .dbh_m = options->dbh_cm * 0.01,
        .age_years = options->age_years,
        .openness = options->openness,
        .clip = options->clip,
        .detail = options->detail,
        .log = session->log,
    };
    uint32_t variants = options->variants ? options->variants : 1;
    uint32_t first = options->grow_seed ? options->grow_seed : 1;
    uint32_t total = variants * (uint32_t)options->operand_count;
    enum wd_result result = WD_OK;
    if (!cli_season_month(session, &params.month))
        return WD_ERROR_INPUT;
    grown->items = calloc(total, sizeof *grown->items);
    for (uint32_t i = 0; i < total && result == WD_OK && grown->items; i++) {
        params.source = options->operands[i / variants];
        params.seed = options->grow_seed || variants > 1 ? first + i % variants : 0;
        if (!session->progress.report(session->progress.user, "trees", i, total))
            return WD_ERROR_INTERRUPTED;
        result = wd_specimen_create(&grown->items[i], &params);
        grown->count += result == WD_OK;
    }
    return grown->items ? result : WD_ERROR_MEMORY;
}

static void drop_all(struct grown *grown)
{
    for (uint32_t i = 0; i < grown->count; i++)
        wd_specimen_destroy(&grown->items[i]);
    free(grown->items);
}

static void say_specimen(struct cli_session *session, const struct wd_specimen *specimen)
{
    struct wd_specimen_info info;
    struct wd_specimen_level level;
    char levels[128] = "";
    wd_specimen_get_info(specimen, &info);
    for (uint32_t i = 0; wd_specimen_get_level(specimen, i, &level); i++)
        snprintf(levels + strlen(levels), sizeof levels - strlen(levels), "%s%u", i ? ", " : "",
                 level.wood_triangles + level.leaf_triangles);
    cli_say(session, "%s (%s): %.1f m high, crown %.1f m, stem %.0f cm", info.name, info.latin,
            info.height_m, info.crown_diameter_m, info.dbh_m * 100);
    if (info.age_years > 0)
        cli_say(session, ", %.0f years", info.age_years);
    cli_say(session, "; triangles: %s\n", levels);
}

/* --- pictures ---------------------------------------------------------------------------- */

enum wd_result cli_specimens_picture(struct cli_session *session, struct wd_renderer *renderer,
                                     const struct wd_specimen *const *specimens, uint32_t count,
                                     const struct cli_specimen_view *view,
                                     struct wd_picture *picture)
{
    struct wd_forest *forest = NULL;
    struct wd_render_params params = {
        .width = view->width,
        .height = view->height,
        .samples = view->samples,
        .layers = view->layers,
        .view = session->options->view,
        .method = view->method,
        .timing = view->timing,
    };
    enum wd_result result =
        wd_forest_create_specimens(&forest, specimens, count, (double)view->width / view->height,
                                   view->distance_m, &session->log);
    if (result == WD_OK) {
        wd_forest_set_specimen_form(forest, view->form);
        result = wd_forest_get_camera(forest, view->distance_m > 0 ? "eye" : "fit", &params.camera);
    }
    if (result == WD_OK)
        result = wd_renderer_set_forest(renderer, forest);
    if (result == WD_OK)
        result = wd_renderer_render(renderer, &params, picture);
    wd_renderer_set_forest(renderer, NULL);
    wd_forest_destroy(&forest);
    return result;
}

static bool choose_form(struct cli_session *session, enum wd_specimen_form *form)
{
    static const char *const names[] = {"seen", "full", "reduced", "cards"};
    const char *wanted = session->options->form;
    *form = session->options->distance_m > 0 ? WD_SPECIMEN_AS_SEEN : WD_SPECIMEN_FULL;
    for (size_t i = 0; wanted && i < sizeof names / sizeof *names; i++) {
        if (!strcmp(names[i], wanted)) {
            *form = (enum wd_specimen_form)i;
            return true;
        }
    }
    return !wanted || cli_fail(session, "there is no form \"%s\"; there are: seen, full, reduced, "
                               "cards", wanted);
}

static enum wd_result draw(struct cli_session *session, const struct grown *grown)
{
    const struct cli_options *options = session->options;
    struct wd_renderer *renderer = NULL;
    struct wd_picture picture = {0};
    struct cli_specimen_view view = {
        .width = options->size_px[0] ? options->size_px[0] : DEFAULT_SIZE_PX,
        .height = options->size_px[1] ? options->size_px[1] : DEFAULT_SIZE_PX,
        .samples = options->samples ? options->samples : DEFAULT_SAMPLES,
        .layers = cli_output_kind(options->output) == CLI_OUTPUT_EXR ? WD_LAYER_ALL
                                                                     : WD_LAYER_DISPLAY,
        .distance_m = options->distance_m,
        .method = options->method,
    };
    if (!choose_form(session, &view.form))
        return WD_ERROR_INPUT;
    enum wd_result result = cli_renderer_open(session, &renderer);
    if (result == WD_OK)
        result = cli_specimens_picture(session, renderer,
                                       (const struct wd_specimen *const *)grown->items,
                                       grown->count, &view, &picture);
    if (result == WD_OK)
        result = wd_picture_write(&picture, options->output, &session->log);
    wd_picture_finish(&picture);
    cli_renderer_close(session, &renderer);
    return result;
}

/* --- the command ------------------------------------------------------------------------- */

static void say_file(struct cli_session *session)
{
    struct stat status;
    if (!stat(session->options->output, &status))
        cli_say(session, "%s: %.2f MB, %.1f s\n", session->options->output,
                (double)status.st_size / 1e6, cli_seconds() - session->meter.begin_s);
}

static enum wd_result grow(struct cli_session *session, enum grow_kind kind)
{
    struct grown grown = {0};
    enum wd_result result = grow_all(session, &grown);
    if (result == WD_OK)
        result = wd_specimens_check_output((const struct wd_specimen *const *)grown.items,
                                           grown.count, session->options->output);
    if (result == WD_OK && kind == GROW_PICTURE)
        result = draw(session, &grown);
    else if (result == WD_OK)
        result = wd_specimens_write((const struct wd_specimen *const *)grown.items, grown.count,
                                    session->options->output, &session->log);
    for (uint32_t i = 0; i < grown.count && result == WD_OK; i++)
        say_specimen(session, grown.items[i]);
    drop_all(&grown);
    return result;
}

enum cli_status cli_grow(struct cli_session *session)
{
    enum grow_kind kind = GROW_UNKNOWN;
    if (!check_options(session, &kind) || !cli_method_check(session))
        return CLI_USAGE;
    if (!cli_output_probe(session, session->options->output))
        return CLI_FAILED;
    enum wd_result result = session->options->sheet ? cli_sheet(session) : grow(session, kind);
    if (result == WD_OK)
        say_file(session);
    return cli_session_status(session, result);
}

enum cli_status cli_export(struct cli_session *session)
{
    const struct cli_options *options = session->options;
    struct wd_forest *forest = NULL;
    const char *dot = options->output ? strrchr(options->output, '.') : NULL;
    if (!dot || (strcasecmp(dot, ".glb") && strcasecmp(dot, ".csv"))) {
        cli_fail(session, options->output ? "the output must end in .glb or .csv"
                                          : "no output named: add -o FILE.glb or FILE.csv");
        return CLI_USAGE;
    }
    if (!cli_method_check(session))
        return CLI_USAGE;
    if (!cli_output_probe(session, options->output))
        return CLI_FAILED;
    enum wd_result result = cli_forest_open(session, &forest);
    if (result == WD_OK)
        result = wd_forest_write(forest, options->output, options->max_trees, &session->progress,
                                 &session->log);
    if (result == WD_OK)
        say_file(session);
    cli_forest_close(session, &forest);
    return cli_session_status(session, result);
}
