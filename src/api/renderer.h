/* renderer.h: what stands behind the public struct wd_renderer. */
#ifndef WD_API_RENDERER_H
#define WD_API_RENDERER_H

#include "api/coverage.h"
#include "api/forest.h"
#include "frame/frame.h"
#include "weald/renderer.h"

enum { WD_MAX_PASSES = 32 };

struct wd_renderer {
    struct wd_gpu gpu;
    struct wd_frame frame;
    struct wd_forest_device device; /* of `forest` */
    const struct wd_forest *forest; /* NULL: none */
    char *cache_dir;
    unsigned threads;
    struct wd_progress progress;
    bool stopped; /* progress asked to stop */
    bool no_memory; /* for a picture, on the host */
    struct wd_log log;
    struct wd_pass_time passes[WD_MAX_PASSES];
    char pass_names[WD_MAX_PASSES][sizeof((struct wd_scope_time){0}.name)]; /* the ring's are its newest frame's */
    uint32_t pass_count;
    double frame_ms;
    uint32_t samples; /* of the newest picture, as drawn */
    double gpu_ms;  /* of the newest frame drawn live; 0: not known */
    struct wd_coverage coverage; /* of the picture being made, where it is asked for */
    uint64_t discs; /* of the newest picture; 0: not counted */
};

/* What a call came to that failed, once its cause was logged. Each that may fail for want of memory clears
 * no_memory, its own and the device's, first. */
enum wd_result wd_renderer_failure(const struct wd_renderer *renderer);
/* Checks the parameters of a picture, makes room for its layers (`picture` NULL: none is read), and hands them
 * to the frame. */
enum wd_result wd_renderer_prepare(struct wd_renderer *renderer,
                                   const struct wd_render_params *params, uint32_t max_samples,
                                   enum wd_frame_light light, struct wd_picture *picture);
/* Fetches the layers of the frame just finished. */
bool wd_picture_read(struct wd_picture *picture, struct wd_renderer *renderer, uint32_t layers);
/* Adds what the sample just finished shows to renderer->coverage. */
bool wd_picture_count_trees(struct wd_renderer *renderer);
/* Takes over the pass times of the newest finished frame. */
void wd_renderer_keep_times(struct wd_renderer *renderer);

#endif
