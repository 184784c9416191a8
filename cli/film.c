#include "film.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEFAULT_FRAMES_PER_SECOND 24.0
#define STANDING_SECONDS 4.0

static bool settle_frames(struct cli_film *film)
{
    const struct cli_options *options = film->session->options;
    film->frames_per_second =
        options->frames_per_second > 0 ? options->frames_per_second : DEFAULT_FRAMES_PER_SECOND;
    film->path = options->path;
    if (!film->path && !options->camera)
        film->path = wd_forest_path_name(film->forest, 0);
    struct wd_camera camera;
    enum wd_result result =
        film->path
            ? wd_forest_get_path_camera(film->forest, film->path, 0, &camera, &film->duration_s)
            : wd_forest_get_camera(film->forest, options->camera, &camera);
    double seconds = film->path ? film->duration_s : STANDING_SECONDS;
    film->frame_count = options->frames;
    if (!film->frame_count)
        film->frame_count = (uint64_t)fmax(1, round(seconds * film->frames_per_second));
    return result == WD_OK;
}

enum wd_result cli_film_open(struct cli_film *film, struct cli_session *session,
                             const struct wd_forest *forest, const struct cli_plan *plan)
{
    *film = (struct cli_film){.session = session, .forest = forest, .plan = plan};
    film->budget = wd_budget_of(session->options->budget_ms);
    if (!settle_frames(film))
        return WD_ERROR_INPUT;
    struct wd_film_params params = {
        .path = session->options->output,
        .width = plan->params.width,
        .height = plan->params.height,
        .frames_per_second = film->frames_per_second,
    };
    return wd_film_open(&film->output, &params, &session->log);
}

/* Frames asked for by number are spread over the whole path; without a number, it is flown at its
 * own speed. */
static enum wd_result frame_camera(const struct cli_film *film, uint64_t frame,
                                   struct wd_camera *camera)
{
    if (!film->path)
        return wd_forest_get_camera(film->forest, film->session->options->camera, camera);
    double time_s = (double)frame / film->frames_per_second;
    if (film->session->options->frames)
        time_s = film->frame_count > 1
                     ? film->duration_s * (double)frame / (double)(film->frame_count - 1)
                     : 0;
    return wd_forest_get_path_camera(film->forest, film->path, time_s, camera, NULL);
}

/* The next frame's error bound follows from this one's time. */
static void note_time(struct cli_film *film, const struct cli_painter *painter,
                      const struct wd_render_params *params)
{
    struct wd_frame_stats stats;
    if (film->session->options->budget_ms <= 0)
        return;
    wd_renderer_get_stats(painter->renderer, &stats);
    double frame_ms = stats.frame_ms * (params->samples ? params->samples : 1);
    film->over_budget += frame_ms > film->budget.target_ms;
    wd_budget_next(&film->budget, frame_ms);
}

static enum wd_result shoot_frame(struct cli_film *film, struct cli_painter *painter,
                                  struct wd_camera *previous)
{
    uint64_t frame = film->frames_done;
    struct wd_render_params params = film->plan->params;
    struct wd_picture picture = {0};
    enum wd_result result = frame_camera(film, frame, &params.camera);
    if (film->session->options->budget_ms > 0)
        params.max_error_px = film->budget.error_px;
    params.time_s += (double)frame / film->frames_per_second;
    params.previous_time_s = frame ? params.time_s - 1 / film->frames_per_second : params.time_s;
    params.previous_camera = frame ? previous : NULL;
    if (result == WD_OK)
        result = cli_painter_paint(painter, &params, &picture);
    if (result == WD_OK)
        note_time(film, painter, &params);
    if (result == WD_OK)
        result = wd_film_add(film->output, &picture);
    wd_picture_finish(&picture);
    *previous = params.camera;
    return result;
}

enum wd_result cli_film_shoot(struct cli_film *film, struct cli_painter *painter)
{
    struct wd_camera previous = {0};
    enum wd_result result = WD_OK;
    while (result == WD_OK && film->frames_done < film->frame_count) {
        cli_session_film_progress(film->session, film->frames_done, film->frame_count);
        if (cli_session_interrupted(film->session))
            return WD_ERROR_INTERRUPTED;
        result = shoot_frame(film, painter, &previous);
        film->frames_done += result == WD_OK;
    }
    return result;
}

static void say_kept(struct cli_film *film, enum wd_result result)
{
    char what[96];
    unsigned long long done = film->frames_done, count = film->frame_count;
    if (result == WD_OK)
        snprintf(what, sizeof what, "%llu frame%s, ", done, done == 1 ? "" : "s");
    else
        snprintf(what, sizeof what, "stopped; the finished %llu of %llu frames are kept, ", done,
                 count);
    cli_say_written(film->session, film->plan, what);
}

static void say_budget(struct cli_film *film)
{
    if (film->session->options->budget_ms > 0)
        cli_say(film->session, "budget %g ms: %llu frames took longer; error at the end %.2f px\n",
                film->budget.target_ms, (unsigned long long)film->over_budget,
                film->budget.error_px);
}

enum wd_result cli_film_close(struct cli_film *film, enum wd_result result)
{
    enum wd_result closed = WD_OK;
    if (result == WD_ERROR_OUTPUT || !film->frames_done)
        wd_film_discard(&film->output);
    else
        closed = wd_film_commit(&film->output);
    if (closed == WD_OK && film->frames_done && result != WD_ERROR_OUTPUT) {
        say_kept(film, result);
        say_budget(film);
    }
    return result == WD_OK ? closed : result;
}
