#include <stdio.h>
#include <string.h>

#include "state.h"

static const char help_text[] = "W A S D      move\n"
                                "Q E          down, up\n"
                                "Shift        five times as fast; the wheel sets the speed\n"
                                "right button look around\n"
                                "left button  tell of a tree\n"
                                "G            grab the mouse for looking\n"
                                "F            fly or walk\n"
                                "M, Shift+M   next method, the one before\n"
                                "L            colour by level of detail\n"
                                "B            one sample a frame, or those of many\n"
                                "T            times and tree counts\n"
                                "O, Shift+O   sun a quarter of an hour later, earlier\n"
                                "C, Shift+C   next camera, save this one\n"
                                "P            play the path\n"
                                "F9, F12      report line, screenshot\n"
                                "H            this help\n"
                                "Esc          quit";

/* What decides how finely trees are drawn: a budget, a bound, or neither. */
static void print_quality(const struct viewer_state *viewer, char *text, size_t size)
{
    text[0] = 0;
    if (viewer_has_budget(viewer))
        snprintf(text, size, "   budget %g ms: error %.2f px", viewer->budget.target_ms,
                 viewer->budget.error_px);
    else if (viewer_error_px(viewer) > 0 && !strcmp(viewer->method, "continuum"))
        snprintf(text, size, "   error at most %g px", viewer_error_px(viewer));
}

/* With two digits that count, and none of them an exponent. */
static int decimals(double value)
{
    return value < 1 ? 2 : value < 10 ? 1 : 0;
}

static void print_status(const struct viewer_state *viewer, char *text, size_t size)
{
    const double *p = viewer->motion.camera.position_m;
    double speed_mps = viewer_motion_speed_mps(&viewer->motion);
    char quality[64];
    print_quality(viewer, quality, sizeof quality);
    snprintf(text, size,
             "%s   %s, %.*f m/s   %.1f, %.1f, %.1f m, %.1f above ground   %.*f ms a frame%s   H: help",
             viewer->method, viewer->motion.gait == VIEWER_WALK ? "on foot" : "flying", decimals(speed_mps), speed_mps,
             p[0], p[1], p[2], p[2] - wd_forest_ground_m(viewer->forest, p[0], p[1]), decimals(viewer->frame_ms),
             viewer->frame_ms, quality);
}

static void print_times(const struct viewer_state *viewer, char *text, size_t size)
{
    struct wd_frame_stats stats;
    wd_renderer_get_stats(viewer->renderer, &stats);
    size_t used = (size_t)snprintf(text, size, "%s\n%-22s   GPU ms  CPU ms\n",
                                   wd_renderer_device_name(viewer->renderer), "pass");
    for (uint32_t i = 0; i < stats.pass_count && used < size; i++)
        used +=
            (size_t)snprintf(text + used, size - used, "  %-20s %8.2f %7.2f\n",
                             stats.passes[i].name, stats.passes[i].gpu_ms, stats.passes[i].cpu_ms);
    if (used < size)
        used += (size_t)snprintf(text + used, size - used, "submitted in %.1f ms", stats.frame_ms);
    if (used < size && stats.gpu_ms > 0) /* some devices have no true clock */
        used += (size_t)snprintf(text + used, size - used, ", drawn in %.1f ms", stats.gpu_ms);
    if (used < size)
        snprintf(text + used, size - used,
                 "\n"
                 "trees: %llu mesh, %llu reduced, %llu billboard\n"
                 "%llu draw calls, %llu triangles\n"
                 "device memory %.1f MB, at most %.1f MB",
                 (unsigned long long)stats.trees_mesh,
                 (unsigned long long)stats.trees_reduced, (unsigned long long)stats.trees_billboard,
                 (unsigned long long)stats.draw_calls, (unsigned long long)stats.triangles,
                 (double)stats.device_bytes / 1e6, (double)stats.device_bytes_peak / 1e6);
}

struct viewer_panels_content viewer_status(const struct viewer_state *viewer,
                                           struct viewer_texts *texts)
{
    print_status(viewer, texts->status, sizeof texts->status);
    if (viewer->times_shown)
        print_times(viewer, texts->times, sizeof texts->times);
    return (struct viewer_panels_content){
        .status = texts->status,
        .notice = viewer->now_s < viewer->notice_until_s || viewer->frame_count < viewer->notice_until_frame
                      ? viewer->notice
                      : NULL,
        .times = viewer->times_shown ? texts->times : NULL,
        .help = viewer->help_shown ? help_text : NULL,
    };
}
