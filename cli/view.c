#include "cli.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "output_name.h"
#include "viewer/viewer.h"

static bool keep_running(void *user)
{
    return !cli_session_interrupted(user);
}

/* Lines may go to a pipe or a terminal, too. */
static bool can_report(struct cli_session *session, const char *path)
{
    struct stat status;
    if (!path)
        return true;
    if (stat(path, &status) || S_ISDIR(status.st_mode))
        return cli_output_probe(session, path);
    return access(path, W_OK) == 0 || cli_fail(session, "%s cannot be written: %s", path, strerror(errno));
}

static bool can_take_pictures(struct cli_session *session, const char *folder)
{
    char *name = NULL;
    if (!folder)
        return true;
    if (asprintf(&name, "%s/weald.png", folder) < 0)
        return cli_fail(session, "out of memory");
    bool can = cli_output_probe(session, name);
    free(name);
    return can;
}

enum cli_status cli_view(struct cli_session *session)
{
    const struct cli_options *options = session->options;
    if (!cli_method_check(session) || !cli_error_check(session))
        return CLI_USAGE;
    struct wd_viewer_params params = {
        .scene_path = options->operands[0],
        .camera = options->camera,
        .path = options->path,
        .method = options->method,
        .view = options->view,
        .width = options->size_px[0],
        .height = options->size_px[1],
        .max_error_px = options->max_error_px,
        .budget_ms = options->budget_ms,
        .max_fps = options->max_fps,
        .single = options->single,
        .walk = options->walk,
        .screenshot_dir = options->screenshots,
        .report_path = options->report,
        .gpu = options->gpu,
        .validation = options->gpu_validate ? WD_VALIDATION_ON : WD_VALIDATION_OFF,
        .threads = options->threads,
        .log = session->log,
        .progress = session->progress,
        .keep_running = keep_running,
        .user = session,
    };
    if (!wd_viewer_display_present(&session->log))
        return CLI_NO_DISPLAY;
    if (!can_report(session, options->report) || !can_take_pictures(session, options->screenshots))
        return CLI_FAILED;
    struct wd_forest *forest = NULL;
    enum wd_result result = cli_forest_open(session, &forest);
    if (result == WD_OK && !(cli_places_check(session, forest) && cli_bound_check(session, forest)))
        result = WD_ERROR_INPUT;
    if (result == WD_OK)
        result = wd_viewer_run(forest, &params);
    cli_forest_close(session, &forest);
    return cli_session_status(session, result);
}
