#include "viewer.h"

#include <SDL_vulkan.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "message.h"
#include "state.h"

#define DEFAULT_WIDTH 1280
#define DEFAULT_HEIGHT 720
#define HIDDEN_WAIT_MS 100

double viewer_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

bool wd_viewer_display_present(const struct wd_log *log)
{
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    if (SDL_Init(SDL_INIT_VIDEO))
        return viewer_error(log, "no window can be opened: %s", SDL_GetError());
    const char *driver = SDL_GetCurrentVideoDriver();
    bool real = driver && strcmp(driver, "dummy") && strcmp(driver, "offscreen");
    SDL_Quit();
    return real || viewer_error(log, "no window can be opened: there is no display");
}

bool wd_viewer_saved_camera(struct wd_camera *camera, const char *scene_path, const char *name, const struct wd_log *log)
{
    struct viewer_cameras cameras;
    const struct viewer_saved_camera *saved =
        viewer_cameras_init(&cameras, scene_path, log) ? viewer_cameras_find(&cameras, name) : NULL;
    if (saved)
        *camera = saved->camera;
    viewer_cameras_finish(&cameras);
    return saved != NULL;
}

static bool open_window(struct viewer_state *viewer)
{
    const struct wd_viewer_params *params = viewer->params;
    struct wd_forest_info info;
    char title[256];
    wd_forest_get_info(viewer->forest, &info);
    snprintf(title, sizeof title, "weald: %s", info.name);
    viewer->window = SDL_CreateWindow(title, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                                      (int)(params->width ? params->width : DEFAULT_WIDTH),
                                      (int)(params->height ? params->height : DEFAULT_HEIGHT),
                                      SDL_WINDOW_VULKAN | SDL_WINDOW_RESIZABLE | SDL_WINDOW_HIDDEN |
                                          SDL_WINDOW_ALLOW_HIGHDPI);
    return viewer->window ||
           viewer_error(&params->log, "no window can be opened: %s", SDL_GetError());
}

static enum wd_result open_renderer(struct viewer_state *viewer)
{
    const struct wd_viewer_params *params = viewer->params;
    const char *extensions[16];
    unsigned count = 16;
    if (!SDL_Vulkan_GetInstanceExtensions(viewer->window, &count, extensions)) {
        viewer_error(&params->log, "the window takes no Vulkan pictures: %s", SDL_GetError());
        return WD_ERROR_DEVICE;
    }
    struct wd_renderer_params renderer = {
        .gpu = params->gpu,
        .validation = params->validation,
        .threads = params->threads,
        .progress = params->progress,
        .log = params->log,
    };
    enum wd_result result =
        wd_renderer_create_presenting(&viewer->renderer, extensions, count, &renderer);
    return result == WD_OK ? wd_renderer_set_forest(viewer->renderer, viewer->forest) : result;
}

static bool open_swapchain(struct viewer_state *viewer)
{
    struct wd_vulkan_handles vulkan;
    wd_renderer_get_vulkan(viewer->renderer, &vulkan);
    return viewer_swapchain_init(&viewer->swapchain, viewer->window, &vulkan,
                                 &viewer->params->log) &&
           viewer_swapchain_rebuild(&viewer->swapchain) == VIEWER_SWAP_READY &&
           viewer_overlay_init(&viewer->overlay, &viewer->swapchain);
}

const struct wd_sun *viewer_sun(const struct viewer_state *viewer)
{
    return viewer->sun_moved ? &viewer->sun : NULL;
}

static enum wd_result choose_camera(struct viewer_state *viewer)
{
    const char *wanted = viewer->params->camera, *name;
    const struct viewer_saved_camera *saved = NULL;
    uint32_t index = 0, found = UINT32_MAX;
    for (; (name = wd_forest_camera_name(viewer->forest, index)); index++)
        if (found == UINT32_MAX && (!wanted || !strcmp(name, wanted)))
            found = index;
    if (found == UINT32_MAX)
        saved = viewer_cameras_find(&viewer->cameras, wanted);
    if (saved) {
        viewer->camera_index = index + (uint32_t)(saved - viewer->cameras.saved);
        viewer->camera_name = saved->name;
        viewer->motion.camera = saved->camera;
        return WD_OK;
    }
    viewer->camera_index = found;
    viewer->camera_name = wd_forest_camera_name(viewer->forest, found);
    return wd_forest_get_camera(viewer->forest, wanted, &viewer->motion.camera);
}

static enum wd_result choose_start(struct viewer_state *viewer)
{
    const struct wd_viewer_params *params = viewer->params;
    struct wd_render_defaults defaults;
    wd_forest_get_render_defaults(viewer->forest, &defaults);
    viewer->method = params->method ? params->method : defaults.method;
    viewer->view = params->view;
    viewer->sun = wd_forest_sun(viewer->forest);
    viewer->motion.speed_factor = 1;
    viewer->motion.gait = params->walk ? VIEWER_WALK : VIEWER_FLY;
    viewer->path_time_s = params->path ? 0 : -1;
    viewer->budget = wd_budget_of(params->budget_ms);
    viewer->accumulates = !params->single;
    struct wd_camera unused;
    enum wd_result result = choose_camera(viewer);
    if (result == WD_OK && params->walk) {
        struct viewer_ground ground = viewer_ground(viewer);
        viewer_motion_land(&viewer->motion, &ground);
    }
    if (result == WD_OK && params->path)
        result = wd_forest_get_path_camera(viewer->forest, params->path, 0, &unused, NULL);
    return result;
}

static enum wd_result open_viewer(struct viewer_state *viewer)
{
    if (!viewer_cameras_init(&viewer->cameras, viewer->params->scene_path, &viewer->params->log))
        return WD_ERROR_INPUT;
    enum wd_result result = choose_start(viewer);
    if (result != WD_OK)
        return result;
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    if (SDL_Init(SDL_INIT_VIDEO)) {
        viewer_error(&viewer->params->log, "no window can be opened: %s", SDL_GetError());
        return WD_ERROR_DEVICE;
    }
    if (!open_window(viewer))
        return WD_ERROR_DEVICE;
    result = open_renderer(viewer);
    if (result == WD_OK && !open_swapchain(viewer))
        result = WD_ERROR_DEVICE;
    return result;
}

static void close_viewer(struct viewer_state *viewer)
{
    if (viewer->swapchain.vulkan.device)
        vkDeviceWaitIdle(viewer->swapchain.vulkan.device);
    viewer_overlay_finish(&viewer->overlay);
    viewer_swapchain_finish(&viewer->swapchain);
    wd_renderer_destroy(&viewer->renderer);
    viewer_cameras_finish(&viewer->cameras);
    if (viewer->window)
        SDL_DestroyWindow(viewer->window);
    SDL_Quit();
}

/* A window that is minimised or has no area costs nothing. */
static void handle_events(struct viewer_state *viewer)
{
    SDL_Event event;
    if ((viewer->minimised || viewer->no_area) && SDL_WaitEventTimeout(&event, HIDDEN_WAIT_MS)) {
        viewer_panels_event(&event);
        viewer_input_event(viewer, &event);
    }
    while (SDL_PollEvent(&event)) {
        viewer_panels_event(&event);
        viewer_input_event(viewer, &event);
    }
}

static void play_path(struct viewer_state *viewer)
{
    double duration_s;
    if (viewer->path_time_s < 0)
        return;
    viewer->path_time_s += viewer->step_s;
    wd_forest_get_path_camera(viewer->forest, viewer->params->path, viewer->path_time_s,
                              &viewer->motion.camera, &duration_s);
    if (viewer->path_time_s >= duration_s)
        viewer->path_time_s = -1;
}

static void advance(struct viewer_state *viewer)
{
    double now_s = viewer_seconds();
    viewer->step_s = now_s - viewer->now_s;
    viewer->now_s = now_s;
    viewer_input_step(viewer);
    play_path(viewer);
}

static bool rebuild(struct viewer_state *viewer)
{
    vkDeviceWaitIdle(viewer->swapchain.vulkan.device);
    enum viewer_swap_state state = viewer_swapchain_rebuild(&viewer->swapchain);
    viewer->no_area = state == VIEWER_SWAP_HIDDEN;
    viewer->stale = viewer->no_area;
    return state == VIEWER_SWAP_HIDDEN ||
           (state == VIEWER_SWAP_READY &&
            viewer_overlay_resize(&viewer->overlay, &viewer->swapchain));
}

/* Only continuum has an error to bound. */
bool viewer_has_budget(const struct viewer_state *viewer)
{
    return viewer->params->budget_ms > 0 && !strcmp(viewer->method, "continuum");
}

double viewer_error_px(const struct viewer_state *viewer)
{
    return viewer_has_budget(viewer) ? viewer->budget.error_px : viewer->params->max_error_px;
}

static enum wd_result draw_forest(struct viewer_state *viewer,
                                  const struct viewer_overlay_frame *frame, uint32_t index)
{
    double time_s = viewer->now_s - viewer->begin_s;
    struct wd_render_params params = {
        .camera = viewer->motion.camera,
        .sun = viewer_sun(viewer),
        .time_s = time_s,
        .previous_time_s = time_s - viewer->step_s,
        .width = viewer->swapchain.extent.width,
        .height = viewer->swapchain.extent.height,
        .samples = 1,
        .method = viewer->method,
        .view = viewer->view,
        .max_error_px = viewer_error_px(viewer),
        .accumulation = viewer->accumulates ? WD_ACCUMULATE : WD_ACCUMULATE_NOT,
        .timing = viewer->times_shown ? WD_TIME_PASSES : WD_TIME_OFF,
    };
    struct wd_vulkan_target target = {
        .image = viewer->swapchain.images[index],
        .format = viewer->swapchain.format.format,
        .width = params.width,
        .height = params.height,
        .layout_after = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        .wait = frame->acquired,
        .signal = frame->drawn,
    };
    return wd_renderer_draw(viewer->renderer, &params, &target);
}

/* A method that is refused, as those are that need all trees in memory where some are planted on demand,
 * leaves the one before. */
static enum wd_result draw_by_method(struct viewer_state *viewer,
                                     const struct viewer_overlay_frame *frame, uint32_t index)
{
    enum wd_result result = draw_forest(viewer, frame, index);
    if (result == WD_ERROR_INPUT && viewer->drawn_method && viewer->method != viewer->drawn_method) {
        viewer_notice(viewer, "method %s cannot draw this forest", viewer->method);
        viewer->method = viewer->drawn_method;
        result = draw_forest(viewer, frame, index);
    }
    if (result == WD_OK)
        viewer->drawn_method = viewer->method;
    return result;
}

/* Without a true clock on the device the time from frame to frame is what there is; the window system
 * may hold it up to its own pace. */
static void note_time(struct viewer_state *viewer, double frame_ms)
{
    struct wd_frame_stats stats;
    if (!viewer_has_budget(viewer))
        return;
    wd_renderer_get_stats(viewer->renderer, &stats);
    wd_budget_next(&viewer->budget, stats.gpu_ms > 0 ? stats.gpu_ms : frame_ms);
}

static enum wd_result draw_frame(struct viewer_state *viewer)
{
    struct viewer_overlay_frame *frame =
        &viewer->overlay.frames[viewer->frame_count % VIEWER_FRAMES_IN_FLIGHT];
    uint32_t index;
    if (!viewer_overlay_begin(&viewer->overlay, frame))
        return WD_ERROR_DEVICE;
    enum viewer_swap_state state =
        viewer_swapchain_acquire(&viewer->swapchain, frame->acquired, &index);
    if (state == VIEWER_SWAP_STALE)
        viewer->stale = true;
    if (state != VIEWER_SWAP_READY)
        return state == VIEWER_SWAP_FAILED ? WD_ERROR_DEVICE : WD_OK;

    struct viewer_texts texts;
    struct viewer_panels_content content = viewer_status(viewer, &texts);
    enum wd_result result = draw_by_method(viewer, frame, index);
    if (result != WD_OK)
        return result;
    if (!viewer_overlay_draw(&viewer->overlay, frame, &viewer->swapchain, index, &content))
        return WD_ERROR_DEVICE;
    state = viewer_swapchain_present(&viewer->swapchain, index);
    viewer->stale = viewer->stale || state == VIEWER_SWAP_STALE;
    viewer->frame_count++;
    double frame_ms = (viewer_seconds() - viewer->now_s) * 1e3;
    note_time(viewer, frame_ms);
    viewer->frame_ms += (frame_ms - viewer->frame_ms) * (viewer->frame_count == 1 ? 1 : 0.2);
    return state == VIEWER_SWAP_FAILED ? WD_ERROR_DEVICE : WD_OK;
}

/* Until the next frame is due, where there is a most of them. */
static void keep_pace(const struct viewer_state *viewer)
{
    if (viewer->params->max_fps <= 0)
        return;
    double left_s = viewer->now_s + 1 / viewer->params->max_fps - viewer_seconds();
    if (left_s > 0)
        SDL_Delay((Uint32)(left_s * 1e3 + 0.5));
}

static enum wd_result run_loop(struct viewer_state *viewer)
{
    const struct wd_viewer_params *params = viewer->params;
    enum wd_result result = WD_OK;
    viewer->begin_s = viewer->now_s = viewer_seconds();
    SDL_ShowWindow(viewer->window);
    while (result == WD_OK && !viewer->quit) {
        if (params->keep_running && !params->keep_running(params->user))
            return WD_ERROR_INTERRUPTED;
        handle_events(viewer);
        advance(viewer);
        if (viewer->minimised)
            continue;
        if (viewer->stale && !rebuild(viewer))
            result = WD_ERROR_DEVICE;
        else if (!viewer->no_area)
            result = draw_frame(viewer);
        keep_pace(viewer);
    }
    return result;
}

enum wd_result wd_viewer_run(const struct wd_forest *forest, const struct wd_viewer_params *params)
{
    struct viewer_state viewer = {.params = params, .forest = forest};
    enum wd_result result = open_viewer(&viewer);
    if (result == WD_OK) {
        result = run_loop(&viewer);
        if (!viewer_report(&viewer, "exit") && result == WD_OK)
            result = WD_ERROR_OUTPUT;
    }
    close_viewer(&viewer);
    return result;
}
