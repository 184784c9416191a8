#include "film.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"

#define DEFAULT_FRAMES_PER_SECOND 24.0
#define STANDING_SECONDS 4.0

double cli_frames_per_second(const struct cli_options *options)
{
    return options->frames_per_second > 0 ? options->frames_per_second : DEFAULT_FRAMES_PER_SECOND;
}

/* The numbers of "A-B"; false where the text is another. */
static bool parse_only(const char *text, uint64_t *first, uint64_t *last)
{
    char same[48];
    unsigned a, b;
    if (sscanf(text, "%u-%u", &a, &b) != 2)
        return false;
    *first = a;
    *last = b;
    snprintf(same, sizeof same, "%u-%u", a, b);
    return a <= b && strcmp(text, same) == 0;
}

bool cli_only_check(struct cli_session *session, bool numbered)
{
    const struct cli_options *options = session->options;
    uint64_t first, last;
    if (!options->only)
        return true;
    if (!numbered)
        return cli_fail(session, "--only is for numbered files, like frame-%%05d.png");
    if (options->budget_ms > 0)
        return cli_fail(session, "--only and --budget-ms exclude each other: a frame's error follows from those before");
    return parse_only(options->only, &first, &last) ||
           cli_fail(session, "--only %s: found no two numbers like 100-199, the lower one first", options->only);
}

static bool settle_only(struct cli_film *film)
{
    const char *only = film->session->options->only;
    uint64_t last = film->frame_count - 1;
    if (only && (!parse_only(only, &film->first_frame, &last) || last >= film->frame_count))
        return cli_fail(film->session, "--only %s: the film has frames 0 to %llu", only,
                        (unsigned long long)film->frame_count - 1);
    film->frames_wanted = last - film->first_frame + 1;
    return true;
}

static bool settle_frames(struct cli_film *film)
{
    const struct cli_options *options = film->session->options;
    film->frames_per_second = cli_frames_per_second(options);
    film->path = options->path;
    if (!film->path && !options->camera)
        film->path = wd_forest_path_name(film->forest, 0);
    enum wd_result result =
        film->path
            ? wd_forest_get_path_camera(film->forest, film->path, 0, &film->camera, &film->duration_s)
            : cli_camera(film->session, film->forest, &film->camera);
    double seconds = film->path ? film->duration_s : STANDING_SECONDS;
    film->frame_count = options->frames;
    if (!film->frame_count)
        film->frame_count = (uint64_t)fmax(1, round(seconds * film->frames_per_second));
    return result == WD_OK;
}

static enum wd_result check_output(const struct cli_film *film)
{
    uint64_t pictures = film->plan->kind > CLI_OUTPUT_FILM ? film->frame_count : 0;
    return wd_forest_check_output(film->forest, film->session->options->output, pictures,
                                  &film->session->log);
}

/* With --clock. */
static enum wd_result frame_sun(const struct cli_film *film, uint64_t frame, struct wd_sun *sun)
{
    uint64_t last = film->frame_count - 1;
    double share = last ? (double)frame / (double)last : 0;
    return film->session->options->clock ? cli_clock_sun(film->session, film->forest, share, sun) : WD_OK;
}

enum wd_result cli_film_open(struct cli_film *film, struct cli_session *session,
                             const struct wd_forest *forest, const struct cli_plan *plan)
{
    *film = (struct cli_film){.session = session, .forest = forest, .plan = plan};
    film->budget = wd_budget_of(session->options->budget_ms);
    if (!settle_frames(film) || !settle_only(film))
        return WD_ERROR_INPUT;
    struct wd_sun sun;
    enum wd_result result = frame_sun(film, 0, &sun);
    if (result == WD_OK)
        result = check_output(film);
    if (result != WD_OK)
        return result;
    struct wd_film_params params = {
        .path = session->options->output,
        .width = plan->params.width,
        .height = plan->params.height,
        .frames_per_second = film->frames_per_second,
        .first_frame = film->first_frame,
    };
    return wd_film_open(&film->output, &params, &session->log);
}

/* Frames asked for by number are spread over the whole path; without a number, it is flown at its
 * own speed. */
static enum wd_result frame_camera(const struct cli_film *film, uint64_t frame,
                                   struct wd_camera *camera)
{
    *camera = film->camera;
    if (!film->path)
        return WD_OK;
    double time_s = (double)frame / film->frames_per_second;
    if (film->session->options->frames)
        time_s = film->frame_count > 1
                     ? film->duration_s * (double)frame / (double)(film->frame_count - 1)
                     : 0;
    return wd_forest_get_path_camera(film->forest, film->path, time_s, camera, NULL);
}

void cli_camera_before(struct wd_camera *before, const struct wd_camera *here, const struct wd_camera *next)
{
    *before = *here;
    for (int k = 0; k < 3; k++)
        before->position_m[k] -= next->position_m[k] - here->position_m[k];
    before->yaw_rad -= next->yaw_rad - here->yaw_rad;
    before->pitch_rad -= next->pitch_rad - here->pitch_rad;
}

/* The first frame moves as it does to the second. */
static enum wd_result previous_camera(const struct cli_film *film, uint64_t frame, const struct wd_camera *here,
                                      struct wd_camera *previous)
{
    struct wd_camera next = *here;
    if (frame)
        return frame_camera(film, frame - 1, previous);
    enum wd_result result = film->frame_count > 1 ? frame_camera(film, 1, &next) : WD_OK;
    cli_camera_before(previous, here, &next);
    return result;
}

/* The next frame's error bound follows from this one's time. */
static void note_time(struct cli_film *film, const struct cli_painter *painter)
{
    struct wd_frame_stats stats;
    if (film->session->options->budget_ms <= 0)
        return;
    wd_renderer_get_stats(painter->renderer, &stats);
    double frame_ms = stats.frame_ms * stats.samples;
    film->over_budget += frame_ms > film->budget.target_ms;
    wd_budget_next(&film->budget, frame_ms);
}

static enum wd_result shoot_frame(struct cli_film *film, struct cli_painter *painter)
{
    uint64_t frame = film->first_frame + film->frames_done;
    struct wd_render_params params = film->plan->params;
    struct wd_camera previous;
    struct wd_picture picture = {0};
    struct wd_sun sun;
    enum wd_result result = frame_camera(film, frame, &params.camera);
    if (result == WD_OK)
        result = frame_sun(film, frame, &sun);
    params.sun = film->session->options->clock ? &sun : NULL;
    if (result == WD_OK)
        result = previous_camera(film, frame, &params.camera, &previous);
    if (film->session->options->budget_ms > 0)
        params.max_error_px = film->budget.error_px;
    params.time_s += (double)frame / film->frames_per_second;
    params.previous_time_s = params.time_s - 1 / film->frames_per_second;
    params.previous_camera = &previous;
    if (result == WD_OK)
        result = cli_painter_paint(painter, &params, &picture);
    if (result == WD_OK)
        note_time(film, painter);
    if (result == WD_OK)
        result = wd_film_add(film->output, &picture);
    wd_picture_finish(&picture);
    film->frames_done += result == WD_OK;
    return result;
}

/* --- going on with a film ---------------------------------------------------------------- */

/* All that frames follow from and that the renderer or the forest does not know of. */
static uint64_t film_key(const struct cli_film *film, uint64_t key)
{
    const struct cli_options *options = film->session->options;
    const struct wd_render_params *params = &film->plan->params;
    const struct wd_camera *camera = &film->camera;
    char *text;
    if (asprintf(&text,
                 "%s\n%s\n%.17g %.17g %.17g %.17g %.17g %.17g\n"
                 "%s\n%d %llu %u %.17g %ux%u %u %d %u %d %u %.17g %.17g %.17g %llu",
                 film->path ? film->path : "", options->clock ? options->clock : "", camera->position_m[0],
                 camera->position_m[1], camera->position_m[2], camera->yaw_rad, camera->pitch_rad, camera->fov_rad,
                 params->method ? params->method : "", film->plan->kind,
                 (unsigned long long)film->frame_count, options->frames, film->frames_per_second,
                 params->width, params->height, params->samples, params->view, params->layers,
                 options->reference, options->bounces, params->time_s, params->max_error_px,
                 options->budget_ms, (unsigned long long)film->frames_wanted) < 0)
        abort();
    key = cli_key_text(key, text);
    free(text);
    return key;
}

/* Takes the frames that are there from the last time. */
static enum wd_result take_kept(struct cli_film *film, const struct cli_painter *painter)
{
    uint64_t key = painter->renderer ? wd_renderer_key(painter->renderer)
                                     : wd_reference_key(film->forest), before;
    enum wd_result result = wd_film_keep(film->output, film_key(film, key), film->frames_wanted);
    do {
        before = film->frames_done;
        if (result == WD_OK && cli_session_interrupted(film->session))
            result = WD_ERROR_INTERRUPTED;
        if (result == WD_OK)
            result = wd_film_add_kept(film->output, &film->frames_done);
    } while (result == WD_OK && film->frames_done > before);
    if (film->frames_done)
        cli_say(film->session, "%s: going on after %llu of %llu frames\n",
                film->session->options->output, (unsigned long long)film->frames_done,
                (unsigned long long)film->frames_wanted);
    return result;
}

enum wd_result cli_film_shoot(struct cli_film *film, struct cli_painter *painter)
{
    enum wd_result result = take_kept(film, painter);
    while (result == WD_OK && film->frames_done < film->frames_wanted) {
        cli_session_film_progress(film->session, film->frames_done, film->frames_wanted);
        if (cli_session_interrupted(film->session))
            return WD_ERROR_INTERRUPTED;
        result = shoot_frame(film, painter);
    }
    return result;
}

static void say_kept(struct cli_film *film, enum wd_result result)
{
    char what[128];
    unsigned long long done = film->frames_done, count = film->frames_wanted;
    if (result == WD_OK)
        snprintf(what, sizeof what, "%llu frame%s, ", done, done == 1 ? "" : "s");
    else
        snprintf(what, sizeof what, "stopped; the finished %llu of %llu frames are kept, the same "
                 "command goes on from here; ", done, count);
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
