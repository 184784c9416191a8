#include "cli.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "clock.h"
#include "film.h"
#include "output_name.h"

/* Paths a pixel of --reference, unless asked for otherwise. */
enum { REFERENCE_SAMPLES = 64 };

/* Those that --reference lacks: of "all" it has the rest. */
static const uint32_t RENDERED_LAYERS = WD_LAYER_VELOCITY | WD_LAYER_CRYPTOMATTE;

/* The layers that a list such as "color,cryptomatte" names; 0 after a complaint. */
static uint32_t parse_layers(struct cli_session *session, const char *text)
{
    static const struct {
        const char *name;
        uint32_t bits;
    } layers[] = {{"color", WD_LAYER_COLOR},       {"depth", WD_LAYER_DEPTH},
                  {"normal", WD_LAYER_NORMAL},     {"albedo", WD_LAYER_ALBEDO},
                  {"species", WD_LAYER_SPECIES},   {"tree_id", WD_LAYER_TREE_ID},
                  {"velocity", WD_LAYER_VELOCITY}, {"cryptomatte", WD_LAYER_CRYPTOMATTE},
                  {"all", WD_LAYER_ALL}};
    uint32_t found = 0;
    for (const char *at = text; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        size_t i = 0, length = strcspn(at, ",");
        while (i < sizeof layers / sizeof *layers &&
               (strlen(layers[i].name) != length || strncmp(layers[i].name, at, length)))
            i++;
        if (i == sizeof layers / sizeof *layers) {
            cli_fail(session,
                     "--layers: there is no layer \"%.*s\"; there are: color, depth, normal, "
                     "albedo, species, tree_id, velocity, cryptomatte, all",
                     (int)length, at);
            return 0;
        }
        if (session->options->reference && !(layers[i].bits & ~RENDERED_LAYERS)) {
            cli_fail(session, "--layers: --reference has no layer %s", layers[i].name);
            return 0;
        }
        found |= layers[i].bits;
    }
    return found;
}

static bool settle_layers(struct cli_session *session, struct cli_plan *plan)
{
    const struct cli_options *options = session->options;
    bool layers = plan->kind == CLI_OUTPUT_EXR || plan->kind == CLI_OUTPUT_NUMBERED_EXR;
    plan->params.layers = layers ? WD_LAYER_ALL : WD_LAYER_DISPLAY;
    if (!options->layers)
        return true;
    if (!layers)
        return cli_fail(session, "--layers is for .exr files");
    plan->params.layers = parse_layers(session, options->layers);
    return plan->params.layers != 0;
}

static bool make_plan(struct cli_session *session, struct cli_plan *plan)
{
    const struct cli_options *options = session->options;
    *plan = (struct cli_plan){.kind = CLI_OUTPUT_UNKNOWN};
    if (!options->output)
        return cli_fail(session, "no output named: add -o FILE.png, .exr or .mp4");
    plan->kind = cli_output_kind(options->output);
    if (plan->kind == CLI_OUTPUT_UNKNOWN)
        return cli_fail(session, "%s: the output must end in .png, .exr, .mp4, .m4v, .mov or .mkv",
                        options->output);
    plan->film = plan->kind >= CLI_OUTPUT_FILM;
    if (!plan->film && options->frames > 1)
        return cli_fail(session,
                        "%s holds one frame; for %u name a .mp4 or a pattern like "
                        "frame-%%05d.png",
                        options->output, options->frames);
    if (!cli_only_check(session, plan->kind > CLI_OUTPUT_FILM) || !cli_clock_check(session, plan->film))
        return false;
    if (options->camera && options->path)
        return cli_fail(session, "--camera and --path exclude each other");
    if (options->reference && options->method)
        return cli_fail(session, "--method and --reference exclude each other");
    if (options->reference && options->view != WD_VIEW_LIT)
        return cli_fail(session, "--reference draws lit pictures only; an .exr holds the layers");
    if (options->bounces && !options->reference)
        return cli_fail(session, "--bounces is for --reference");
    if (options->reference && (options->max_error_px > 0 || options->budget_ms > 0))
        return cli_fail(session, "--reference has no error bound: --max-error and --budget-ms are for "
                                 "continuum");
    if (options->budget_ms > 0 && !plan->film)
        return cli_fail(session, "--budget-ms is for films and the viewer: a still must not depend on a "
                                 "clock; --max-error bounds its error");
    if (!cli_error_check(session) || !settle_layers(session, plan))
        return false;
    return cli_method_check(session);
}

/* Motion is that of a film's frame. */
static double step_s(const struct cli_options *options)
{
    return 1 / cli_frames_per_second(options);
}

static void choose_picture(const struct cli_session *session, const struct wd_forest *forest,
                           struct cli_plan *plan)
{
    const struct cli_options *options = session->options;
    struct wd_render_defaults defaults;
    wd_forest_get_render_defaults(forest, &defaults);
    struct wd_render_params *params = &plan->params;
    params->width = options->size_px[0] ? options->size_px[0] : defaults.width;
    params->height = options->size_px[1] ? options->size_px[1] : defaults.height;
    params->samples = options->samples     ? options->samples
                      : options->reference ? REFERENCE_SAMPLES
                                           : defaults.samples;
    params->method = options->method;
    params->view = options->view;
    params->max_error_px = options->max_error_px;
    params->time_s = options->time_s;
    params->previous_time_s = options->time_s - step_s(options);
    params->timing = options->times ? WD_TIME_PASSES : WD_TIME_OFF;
}

void cli_say_written(struct cli_session *session, const struct cli_plan *plan, const char *what)
{
    struct stat status;
    char size[32] = "";
    if (plan->kind <= CLI_OUTPUT_FILM && !stat(session->options->output, &status))
        snprintf(size, sizeof size, ", %.1f MB", (double)status.st_size / 1e6);
    cli_say(session, "%s: %s%ux%u, %u sample%s%s, %.1f s\n", session->options->output, what,
            plan->params.width, plan->params.height, plan->params.samples,
            plan->params.samples == 1 ? "" : "s", size, cli_seconds() - session->meter.begin_s);
}

/* Where it was a frame before, as in a film. */
static enum wd_result choose_camera(struct cli_session *session, const struct wd_forest *forest,
                                    struct wd_camera *camera, struct wd_camera *previous)
{
    const struct cli_options *options = session->options;
    double at_s = options->time_s, before_s = at_s - step_s(options), after_s = at_s + step_s(options);
    enum wd_result result = options->path ? wd_forest_get_path_camera(forest, options->path, at_s, camera, NULL)
                                          : cli_camera(session, forest, camera);
    *previous = *camera;
    if (result != WD_OK || !options->path)
        return result;
    if (before_s >= 0)
        return wd_forest_get_path_camera(forest, options->path, before_s, previous, NULL);
    struct wd_camera next = *camera;
    result = wd_forest_get_path_camera(forest, options->path, after_s, &next, NULL);
    cli_camera_before(previous, camera, &next);
    return result;
}

static enum wd_result render_picture(struct cli_session *session, const struct wd_forest *forest,
                                     struct cli_plan *plan)
{
    struct cli_painter painter = {0};
    struct wd_picture picture = {0};
    struct wd_camera previous = {.fov_rad = 0};
    struct wd_sun sun;
    enum wd_result result = choose_camera(session, forest, &plan->params.camera, &previous);
    if (result == WD_OK && session->options->clock)
        result = cli_clock_sun(session, forest, 0, &sun);
    if (result == WD_OK)
        result = cli_painter_open(&painter, session, forest, plan);
    struct wd_render_params params = plan->params;
    params.previous_camera = &previous;
    params.sun = session->options->clock ? &sun : NULL;
    if (result == WD_OK)
        result = cli_painter_paint(&painter, &params, &picture);
    if (result == WD_OK)
        result = wd_picture_write(&picture, session->options->output, &session->log);
    if (result == WD_OK) {
        cli_painter_print_times(&painter);
        cli_say_written(session, plan, "");
    }
    wd_picture_finish(&picture);
    cli_painter_close(&painter);
    return result;
}

static enum wd_result render_film(struct cli_session *session, const struct wd_forest *forest,
                                  struct cli_plan *plan)
{
    struct cli_film film;
    struct cli_painter painter = {0};
    enum wd_result result = cli_film_open(&film, session, forest, plan);
    if (result == WD_OK)
        result = cli_painter_open(&painter, session, forest, plan);
    if (result == WD_OK)
        result = cli_film_shoot(&film, &painter);
    result = cli_film_close(&film, result);
    if (result == WD_OK)
        cli_painter_print_times(&painter);
    cli_painter_close(&painter);
    return result;
}

enum cli_status cli_render(struct cli_session *session)
{
    struct cli_plan plan;
    struct wd_forest *forest = NULL;
    if (!make_plan(session, &plan))
        return CLI_USAGE;
    if (!plan.film && !cli_output_probe(session, session->options->output))
        return CLI_FAILED;
    enum wd_result result = cli_forest_open(session, &forest);
    if (result == WD_OK && !plan.film)
        result = wd_forest_check_output(forest, session->options->output, 0, &session->log);
    if (result == WD_OK && !(cli_places_check(session, forest) && cli_bound_check(session, forest)))
        result = WD_ERROR_INPUT;
    if (result == WD_OK) {
        choose_picture(session, forest, &plan);
        result = plan.film ? render_film(session, forest, &plan)
                           : render_picture(session, forest, &plan);
    }
    cli_forest_close(session, &forest);
    return cli_session_status(session, result);
}
