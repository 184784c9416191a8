#include "painter.h"

#include <stdio.h>
#include <stdlib.h>

static enum wd_result open_renderer(struct cli_painter *painter, const struct wd_forest *forest)
{
    enum wd_result result = cli_renderer_open(painter->session, &painter->renderer);
    return result == WD_OK ? cli_renderer_show(painter->session, painter->renderer, forest) : result;
}

/* A picture that takes long can be stopped and gone on with. */
static enum wd_result open_reference(struct cli_painter *painter, const struct wd_forest *forest,
                                     const struct cli_plan *plan)
{
    struct cli_session *session = painter->session;
    const struct wd_reference_params params = {
        .threads = session->options->threads,
        .progress = session->progress,
        .log = session->log,
    };
    if (!plan->film && asprintf(&painter->checkpoint, "%s.partial", session->options->output) < 0)
        painter->checkpoint = NULL;
    return wd_reference_create(&painter->reference, forest, &params);
}

enum wd_result cli_painter_open(struct cli_painter *painter, struct cli_session *session,
                                const struct wd_forest *forest, const struct cli_plan *plan)
{
    *painter = (struct cli_painter){.session = session};
    return session->options->reference ? open_reference(painter, forest, plan)
                                       : open_renderer(painter, forest);
}

enum wd_result cli_painter_paint(struct cli_painter *painter, const struct wd_render_params *params,
                                 struct wd_picture *picture)
{
    if (painter->renderer)
        return wd_renderer_render(painter->renderer, params, picture);
    const struct wd_reference_picture_params reference = {
        .camera = params->camera,
        .sun = params->sun,
        .time_s = params->time_s,
        .width = params->width,
        .height = params->height,
        .samples = params->samples,
        .bounces = painter->session->options->bounces,
        .layers = params->layers,
        .checkpoint = painter->checkpoint,
    };
    enum wd_result result = wd_reference_render(painter->reference, &reference, picture);
    if (result == WD_ERROR_INTERRUPTED && painter->checkpoint)
        cli_say(painter->session, "%s: stopped; the same command goes on from here\n",
                painter->checkpoint);
    return result;
}

static void print_passes(const struct wd_renderer *renderer)
{
    struct wd_frame_stats stats;
    wd_renderer_get_stats(renderer, &stats);
    printf("%-16s %10s %10s   (one sample)\n", "pass", "GPU ms", "CPU ms");
    for (uint32_t i = 0; i < stats.pass_count; i++)
        printf("%*s%-*s %10.2f %10.2f\n", 2 * (int)stats.passes[i].depth, "",
               16 - 2 * (int)stats.passes[i].depth, stats.passes[i].name, stats.passes[i].gpu_ms,
               stats.passes[i].cpu_ms);
    printf("%-16s %10.2f\n", "whole frame", stats.frame_ms);
    if (stats.discs)
        printf("discs: %llu\n", (unsigned long long)stats.discs);
    printf("trees drawn: %llu as mesh, %llu reduced, %llu as billboard; %llu draw calls, "
           "%llu triangles; device memory %.1f MB, at most %.1f MB\n",
           (unsigned long long)stats.trees_mesh, (unsigned long long)stats.trees_reduced,
           (unsigned long long)stats.trees_billboard, (unsigned long long)stats.draw_calls,
           (unsigned long long)stats.triangles, (double)stats.device_bytes / 1e6,
           (double)stats.device_bytes_peak / 1e6);
}

static void print_rays(const struct wd_reference *reference)
{
    struct wd_reference_stats stats;
    wd_reference_get_stats(reference, &stats);
    printf("scene built in %.2f s, %.1f M rays traced in %.1f s: %.2f M rays a second\n",
           stats.build_s, (double)stats.rays * 1e-6, stats.trace_s,
           stats.trace_s > 0 ? (double)stats.rays * 1e-6 / stats.trace_s : 0.0);
}

void cli_painter_print_times(struct cli_painter *painter)
{
    if (!painter->session->options->times)
        return;
    cli_meter_clear(&painter->session->meter);
    if (painter->renderer)
        print_passes(painter->renderer);
    else
        print_rays(painter->reference);
}

void cli_painter_close(struct cli_painter *painter)
{
    if (painter->renderer)
        cli_renderer_close(painter->session, &painter->renderer);
    wd_reference_destroy(&painter->reference);
    free(painter->checkpoint);
    *painter = (struct cli_painter){0};
}
