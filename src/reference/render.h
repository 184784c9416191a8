/* render.h: a picture by path tracing, tile by tile and sample by sample, that can be left and taken
 * up again. */
#ifndef WD_REFERENCE_RENDER_H
#define WD_REFERENCE_RENDER_H

#include "reference/path.h"
#include "reference/view.h"
#include "weald/renderer.h"

enum { WD_TRACE_TILE = 16 };

/* Sums so far. `{0}` is empty. */
struct wd_trace_sums {
    uint32_t width, height;
    uint32_t tile_columns, tile_rows;
    float *radiance;        /* 3 a pixel, rows from the top */
    uint32_t *tile_samples; /* samples that each tile's sums hold */
};
/* False where there is no memory for so many pixels: then it is {0}. */
bool wd_trace_sums_init(struct wd_trace_sums *sums, uint32_t width, uint32_t height);
void wd_trace_sums_finish(struct wd_trace_sums *sums);

struct wd_trace_job {
    const struct wd_tracer *tracer;
    struct wd_trace_view view;
    unsigned threads;
    uint32_t stream; /* of random numbers */
    bool middles;    /* paths leave pixels from their middles alone */
    const struct wd_progress *progress; /* stage "samples" */
    struct wd_trace_counts counts;      /* added to */
    bool stopped;                       /* the progress asked to stop */
};

/* Brings every tile to `samples` samples, unless stopped: then tiles may differ, and a later call
 * goes on where they are. The result is the same for any number of threads. */
void wd_trace_run(struct wd_trace_job *job, struct wd_trace_sums *sums, uint32_t samples);

/* Fills depth, normal, albedo, species and tree id of `*picture` with what the rays through the
 * pixels' middles meet; arrays that are NULL are left out. */
void wd_trace_layers(struct wd_trace_job *job, struct wd_picture *picture);

#endif
