#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "state.h"

#define NOTICE_SECONDS 4.0
#define SUN_STEP_H 0.25
#define NOTICE_FRAMES 3 /* at least: a method's first may take longer */
#define SCREENSHOT_SAMPLES 4

void viewer_notice(struct viewer_state *viewer, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(viewer->notice, sizeof viewer->notice, format, args);
    va_end(args);
    viewer->notice_until_s = viewer_seconds() + NOTICE_SECONDS;
    viewer->notice_until_frame = viewer->frame_count + NOTICE_FRAMES;
}

/* Of deep water not the bed: nobody walks there. */
static double ground_m(const void *forest, double x_m, double y_m)
{
    return fmax(wd_forest_ground_m(forest, x_m, y_m), wd_forest_water_m(forest, x_m, y_m) - VIEWER_WADE_M);
}

struct viewer_ground viewer_ground(const struct viewer_state *viewer)
{
    return (struct viewer_ground){ground_m, viewer->forest};
}

void viewer_act_gait(struct viewer_state *viewer)
{
    bool walking = viewer->motion.gait == VIEWER_WALK;
    viewer->motion.gait = walking ? VIEWER_FLY : VIEWER_WALK;
    viewer->motion.fall_mps = 0;
    viewer->motion.grounded = false;
    viewer_notice(viewer, walking ? "flying" : "on foot");
}

static const char *level_legend(const char *method)
{
    if (!strcmp(method, "continuum"))
        return "green: leaves, brown: wood";
    if (!strcmp(method, "zfield"))
        return "red: mesh, yellow: reduced mesh, blue: z-field, purple: far forest on the ground";
    if (!strcmp(method, "impostor"))
        return "red: mesh, yellow: reduced mesh, blue: billboard, purple: impostor";
    return "red: mesh, yellow: reduced mesh, blue: billboard";
}

static void step_method(struct viewer_state *viewer, int step)
{
    const char *const *names = wd_method_names();
    int count = 0, i = 0;
    for (; names[count]; count++)
        if (!strcmp(names[count], viewer->method))
            i = count;
    viewer->method = names[(i + count + step) % count];
    bool levels = viewer->view == WD_VIEW_LOD;
    viewer_notice(viewer, "method %s%s%s", viewer->method, levels ? "\n" : "",
                  levels ? level_legend(viewer->method) : "");
}

void viewer_act_method(struct viewer_state *viewer)
{
    step_method(viewer, 1);
}

void viewer_act_method_before(struct viewer_state *viewer)
{
    step_method(viewer, -1);
}

static void move_sun(struct viewer_state *viewer, double hours)
{
    if (!wd_forest_sun_moves(viewer->forest)) {
        viewer_notice(viewer, "the sun is the sky map's and stays");
        return;
    }
    viewer->sun = wd_forest_sun_later(viewer->forest, &viewer->sun, hours);
    viewer->sun_moved = true;
    double elevation_deg = viewer->sun.elevation_deg;
    viewer_notice(viewer, "sun %.1f degrees %s the horizon, azimuth %.0f", fabs(elevation_deg),
                  elevation_deg < 0 ? "below" : "above", viewer->sun.azimuth_deg);
}

void viewer_act_later(struct viewer_state *viewer)
{
    move_sun(viewer, SUN_STEP_H);
}

void viewer_act_earlier(struct viewer_state *viewer)
{
    move_sun(viewer, -SUN_STEP_H);
}

/* And back to what was shown at the beginning. */
void viewer_act_lod(struct viewer_state *viewer)
{
    enum wd_view_mode begun = viewer->params->view == WD_VIEW_LOD ? WD_VIEW_LIT : viewer->params->view;
    viewer->view = viewer->view == WD_VIEW_LOD ? begun : WD_VIEW_LOD;
    if (viewer->view == WD_VIEW_LOD)
        viewer_notice(viewer, "%s", level_legend(viewer->method));
}

void viewer_act_accumulate(struct viewer_state *viewer)
{
    viewer->accumulates = !viewer->accumulates;
    viewer_notice(viewer, viewer->accumulates ? "samples of many frames" : "one sample a frame");
}

void viewer_act_times(struct viewer_state *viewer)
{
    viewer->times_shown = !viewer->times_shown;
}

void viewer_act_help(struct viewer_state *viewer)
{
    viewer->help_shown = !viewer->help_shown;
}

void viewer_act_grab(struct viewer_state *viewer)
{
    viewer->grabbed = !viewer->grabbed;
    SDL_SetRelativeMouseMode(viewer->grabbed ? SDL_TRUE : SDL_FALSE);
}

void viewer_act_quit(struct viewer_state *viewer)
{
    viewer->quit = true;
}

void viewer_act_play(struct viewer_state *viewer)
{
    if (!viewer->params->path && !wd_forest_path_name(viewer->forest, 0))
        viewer_notice(viewer, "this scene has no path");
    else
        viewer->path_time_s = viewer->path_time_s < 0 ? 0 : -1;
}

void viewer_act_next_camera(struct viewer_state *viewer)
{
    uint32_t scene_count = 0;
    while (wd_forest_camera_name(viewer->forest, scene_count))
        scene_count++;
    uint32_t index = (viewer->camera_index + 1) % (scene_count + (uint32_t)viewer->cameras.count);
    viewer->camera_index = index;
    viewer->path_time_s = -1;
    if (index >= scene_count) {
        const struct viewer_saved_camera *saved = &viewer->cameras.saved[index - scene_count];
        viewer->motion.camera = saved->camera;
        viewer->camera_name = saved->name;
    } else {
        viewer->camera_name = wd_forest_camera_name(viewer->forest, index);
        wd_forest_get_camera(viewer->forest, viewer->camera_name, &viewer->motion.camera);
    }
    viewer->motion.grounded = false;
    viewer_notice(viewer, "camera %s", viewer->camera_name);
}

void viewer_act_save_camera(struct viewer_state *viewer)
{
    if (viewer_cameras_save(&viewer->cameras, &viewer->motion.camera))
        viewer_notice(viewer, "%s saved in %s",
                      viewer->cameras.saved[viewer->cameras.count - 1].name, viewer->cameras.path);
    else
        viewer_notice(viewer, "the camera could not be saved in %s", viewer->cameras.path);
}

/* DIR/weald-YYYYmmdd-HHMMSS.png, with -2, -3 ... where one was taken in the same second. */
static char *screenshot_name(const char *directory)
{
    char stamp[32];
    time_t now = time(NULL);
    struct tm local;
    strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", localtime_r(&now, &local));
    char *name = NULL;
    for (int i = 1; i < 1000; i++) {
        char suffix[8] = "";
        if (i > 1)
            snprintf(suffix, sizeof suffix, "-%d", i);
        if (asprintf(&name, "%s/weald-%s%s.png", directory ? directory : ".", stamp, suffix) < 0)
            return NULL;
        if (access(name, F_OK))
            return name;
        free(name);
    }
    return NULL;
}

/* Of one picture more, of ids alone: its trees stand as those that are shown do. */
static uint32_t tree_at(struct viewer_state *viewer, uint32_t x, uint32_t y)
{
    struct wd_render_params params = {
        .camera = viewer->motion.camera,
        .time_s = viewer->now_s - viewer->begin_s,
        .previous_time_s = viewer->now_s - viewer->begin_s,
        .width = viewer->swapchain.extent.width,
        .height = viewer->swapchain.extent.height,
        .method = viewer->method,
        .layers = WD_LAYER_TREE_ID,
        .max_error_px = viewer_error_px(viewer),
    };
    struct wd_picture picture = {0};
    uint32_t id = 0;
    double begin_s = viewer_seconds();
    if (wd_renderer_wait(viewer->renderer) == WD_OK &&
        wd_renderer_render(viewer->renderer, &params, &picture) == WD_OK)
        id = picture.tree_id[(size_t)y * params.width + x];
    wd_picture_finish(&picture);
    viewer_input_pause(viewer, viewer_seconds() - begin_s);
    return id;
}

static double distance_m(const double a_m[3], const double b_m[3])
{
    return hypot(hypot(a_m[0] - b_m[0], a_m[1] - b_m[1]), a_m[2] - b_m[2]);
}

void viewer_act_pick(struct viewer_state *viewer, int x, int y)
{
    int width, height;
    struct wd_tree_info tree;
    struct wd_species_info species;
    SDL_GetWindowSize(viewer->window, &width, &height);
    const VkExtent2D extent = viewer->swapchain.extent;
    if (x < 0 || y < 0 || x >= width || y >= height || !extent.width || !extent.height)
        return;
    viewer->picked_id = tree_at(viewer, (uint32_t)x * extent.width / (uint32_t)width,
                                (uint32_t)y * extent.height / (uint32_t)height);
    if (!viewer->picked_id)
        viewer_notice(viewer, "no tree there");
    else if (wd_forest_get_tree(viewer->forest, viewer->picked_id, &tree) &&
             wd_forest_get_species(viewer->forest, tree.species, &species))
        viewer_notice(viewer, "tree %u: %s (%s)\n%.1f m high, crown %.1f m wide\nat %.1f, %.1f, %.1f m, %.1f m away",
                      tree.id, species.name, species.latin ? species.latin : "?", tree.height_m,
                      tree.crown_diameter_m, tree.position_m[0], tree.position_m[1], tree.position_m[2],
                      distance_m(tree.position_m, viewer->motion.camera.position_m));
    else
        viewer_notice(viewer, "tree %u, planted on demand", viewer->picked_id);
}

void viewer_act_screenshot(struct viewer_state *viewer)
{
    char *name = screenshot_name(viewer->params->screenshot_dir);
    if (!name) {
        viewer_notice(viewer, "no free name for a screenshot");
        return;
    }
    struct wd_render_params params = {
        .camera = viewer->motion.camera,
        .sun = viewer_sun(viewer),
        .time_s = viewer->now_s - viewer->begin_s,
        .previous_time_s = viewer->now_s - viewer->begin_s,
        .width = viewer->swapchain.extent.width,
        .height = viewer->swapchain.extent.height,
        .samples = SCREENSHOT_SAMPLES,
        .method = viewer->method,
        .view = viewer->view,
        .max_error_px = viewer_error_px(viewer),
    };
    struct wd_picture picture = {0};
    double begin_s = viewer_seconds();
    bool ok = wd_renderer_wait(viewer->renderer) == WD_OK &&
              wd_renderer_render(viewer->renderer, &params, &picture) == WD_OK &&
              wd_picture_write(&picture, name, &viewer->params->log) == WD_OK;
    viewer_input_pause(viewer, viewer_seconds() - begin_s);
    viewer->screenshot_count += ok;
    viewer_notice(viewer, ok ? "%s" : "%s could not be written", name);
    wd_picture_finish(&picture);
    free(name);
}

void viewer_act_report(struct viewer_state *viewer)
{
    viewer_report(viewer, "key");
}
