#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "message.h"
#include "state.h"

#define DEGREES (180 / M_PI)

static const char *view_name(enum wd_view_mode view)
{
    static const char *const names[] = {"lit", "lod", "albedo", "normal", "tree-id", "shadow"};
    return names[view];
}

static json_t *state_json(const struct viewer_state *viewer, const char *event)
{
    const struct wd_camera *camera = &viewer->motion.camera;
    const double *p = camera->position_m;
    json_t *root = json_pack(
        "{s:s, s:[f,f,f], s:f, s:f, s:f, s:s, s:s, s:s, s:s}", "event", event, "position_m", p[0],
        p[1], p[2], "yaw_deg", camera->yaw_rad * DEGREES, "pitch_deg", camera->pitch_rad * DEGREES,
        "ground_m", wd_forest_ground_m(viewer->forest, p[0], p[1]), "gait",
        viewer->motion.gait == VIEWER_WALK ? "walk" : "fly", "method", viewer->method, "view",
        view_name(viewer->view), "camera", viewer->camera_name);
    json_t *more = json_pack(
        "{s:I, s:I, s:I, s:i, s:I, s:f, s:f, s:f, s:f, s:f, s:b, s:b, s:b, s:b, s:i, s:s}", "width",
        (json_int_t)viewer->swapchain.extent.width, "height",
        (json_int_t)viewer->swapchain.extent.height, "frames", (json_int_t)viewer->frame_count,
        "screenshots", (int)viewer->screenshot_count, "picked_id", (json_int_t)viewer->picked_id,
        "sun_elevation_deg", viewer->sun.elevation_deg, "speed_factor", viewer->motion.speed_factor,
        "error_px", viewer_error_px(viewer), "budget_ms",
        viewer_has_budget(viewer) ? viewer->budget.target_ms : 0.0, "frame_ms", viewer->frame_ms, "times", viewer->times_shown, "help", viewer->help_shown,
        "accumulates", viewer->accumulates, "path_playing", viewer->path_time_s >= 0, "saved_cameras", (int)viewer->cameras.count,
        "device", wd_renderer_device_name(viewer->renderer));
    if (root && more)
        json_object_update(root, more);
    json_decref(more);
    return root;
}

bool viewer_report(const struct viewer_state *viewer, const char *event)
{
    const char *path = viewer->params->report_path;
    const struct wd_log *log = &viewer->params->log;
    if (!path)
        return true;
    FILE *file = fopen(path, "a");
    if (!file)
        return viewer_error(log, "%s cannot be written: %s", path, strerror(errno));
    json_t *root = state_json(viewer, event);
    bool ok = root && !json_dumpf(root, file, JSON_COMPACT | JSON_REAL_PRECISION(12)) &&
              fputc('\n', file) != EOF;
    json_decref(root);
    ok = !fclose(file) && ok;
    return ok || viewer_error(log, "%s cannot be written", path);
}
