#include "cli.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "film.h"
#include "output_name.h"
#include "picture.h"

static bool make_plan(struct cli_session *session, struct cli_plan *plan)
{
    const struct cli_options *options = session->options;
    *plan = (struct cli_plan){.kind = CLI_OUTPUT_UNKNOWN};
    if (!options->output)
        return cli_fail(session, "no output named: add -o FILE.png, .exr or .mp4");
    plan->kind = cli_output_kind(options->output);
    if (plan->kind == CLI_OUTPUT_UNKNOWN)
        return cli_fail(session, "%s: the output must end in .png, .exr or .mp4", options->output);
    plan->film = plan->kind >= CLI_OUTPUT_FILM;
    if (!plan->film && options->frames > 1)
        return cli_fail(session,
                        "%s holds one frame; for %u name a .mp4 or a pattern like "
                        "frame-%%05d.png",
                        options->output, options->frames);
    if (options->camera && options->path)
        return cli_fail(session, "--camera and --path exclude each other");
    return cli_method_check(session);
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
    params->samples = options->samples ? options->samples : defaults.samples;
    params->method = options->method;
    params->view = options->view;
    params->time_s = params->previous_time_s = options->time_s;
    params->timing = options->times ? WD_TIME_PASSES : WD_TIME_OFF;
    bool layers = plan->kind == CLI_OUTPUT_EXR || plan->kind == CLI_OUTPUT_NUMBERED_EXR;
    params->layers = layers ? WD_LAYER_ALL : WD_LAYER_DISPLAY;
}

static enum wd_result open_renderer(struct cli_session *session, const struct wd_forest *forest,
                                    struct wd_renderer **renderer)
{
    const struct cli_options *options = session->options;
    struct wd_renderer_params params = {
        .gpu = options->gpu,
        .validation = options->gpu_validate ? WD_VALIDATION_ON : WD_VALIDATION_OFF,
        .threads = options->threads,
        .progress = session->progress,
        .log = session->log,
    };
    enum wd_result result = wd_renderer_create(renderer, &params);
    return result == WD_OK ? wd_renderer_set_forest(*renderer, forest) : result;
}

static void print_times(struct cli_session *session, const struct wd_renderer *renderer)
{
    struct wd_frame_stats stats;
    wd_renderer_get_stats(renderer, &stats);
    cli_meter_clear(&session->meter);
    printf("%-16s %10s %10s   (one sample)\n", "pass", "GPU ms", "CPU ms");
    for (uint32_t i = 0; i < stats.pass_count; i++)
        printf("%-16s %10.2f %10.2f\n", stats.passes[i].name, stats.passes[i].gpu_ms,
               stats.passes[i].cpu_ms);
    printf("%-16s %10.2f\n", "whole frame", stats.frame_ms);
    printf("trees drawn: %llu as mesh, %llu reduced, %llu as billboard; %llu draw calls, "
           "%llu triangles; device memory %.1f MB, at most %.1f MB\n",
           (unsigned long long)stats.trees_mesh, (unsigned long long)stats.trees_reduced,
           (unsigned long long)stats.trees_billboard, (unsigned long long)stats.draw_calls,
           (unsigned long long)stats.triangles, (double)stats.device_bytes / 1e6,
           (double)stats.device_bytes_peak / 1e6);
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

static enum wd_result choose_camera(struct cli_session *session, const struct wd_forest *forest,
                                    struct wd_camera *camera)
{
    const struct cli_options *options = session->options;
    if (options->path)
        return wd_forest_get_path_camera(forest, options->path, options->time_s, camera, NULL);
    return wd_forest_get_camera(forest, options->camera, camera);
}

static enum wd_result render_picture(struct cli_session *session, const struct wd_forest *forest,
                                     struct cli_plan *plan)
{
    struct wd_renderer *renderer = NULL;
    struct wd_picture picture = {0};
    enum wd_result result = choose_camera(session, forest, &plan->params.camera);
    if (result == WD_OK)
        result = open_renderer(session, forest, &renderer);
    if (result == WD_OK)
        result = wd_renderer_render(renderer, &plan->params, &picture);
    if (result == WD_OK)
        result = wd_picture_write(&picture, session->options->output, &session->log);
    if (result == WD_OK && session->options->times)
        print_times(session, renderer);
    if (result == WD_OK)
        cli_say_written(session, plan, "");
    wd_picture_finish(&picture);
    wd_renderer_destroy(&renderer);
    return result;
}

static enum wd_result render_film(struct cli_session *session, const struct wd_forest *forest,
                                  struct cli_plan *plan)
{
    struct cli_film film;
    struct wd_renderer *renderer = NULL;
    enum wd_result result = cli_film_open(&film, session, forest, plan);
    if (result == WD_OK)
        result = open_renderer(session, forest, &renderer);
    if (result == WD_OK)
        result = cli_film_shoot(&film, renderer);
    result = cli_film_close(&film, result);
    if (result == WD_OK && session->options->times)
        print_times(session, renderer);
    wd_renderer_destroy(&renderer);
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
    if (result == WD_OK && !cli_places_check(session, forest))
        result = WD_ERROR_INPUT;
    if (result == WD_OK) {
        choose_picture(session, forest, &plan);
        result = plan.film ? render_film(session, forest, &plan)
                           : render_picture(session, forest, &plan);
    }
    wd_forest_destroy(&forest);
    return cli_session_status(session, result);
}
