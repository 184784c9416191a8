/* weald/reference.h: pictures of a forest by path tracing on the processor: the truth that the
 * renderer's methods are measured by, and an offline quality mode. */
#ifndef WEALD_REFERENCE_H
#define WEALD_REFERENCE_H

#include "weald/renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

struct wd_reference;

struct wd_reference_params {
    unsigned threads; /* 0: one a processor; changes no picture */
    const char *cache_dir; /* of textures, as the renderer's; NULL: $XDG_CACHE_HOME/weald; "": no cache */
    struct wd_progress progress;
    struct wd_log log;
};

/* Grows the trees of `forest` in full and readies them for rays. `forest` must outlive the result.
 * Needs about 0.2 GB for 75,000 trees and 0.6 GB for a million while a picture is made, and some 0.1 GB for each
 * million triangles of twigs that are close to the camera (4 at most).
 *   reference  receives the new object, NULL on failure; destroy with wd_reference_destroy
 *   params     read during the call only, but for `log` and `progress`
 * Errors: WD_ERROR_INPUT (a species cannot be grown), WD_ERROR_MEMORY. */
enum wd_result wd_reference_create(struct wd_reference **reference, const struct wd_forest *forest,
                                   const struct wd_reference_params *params);
void wd_reference_destroy(struct wd_reference **reference); /* accepts NULL and a pointer to NULL */

/* Where paths leave a pixel: from all over it, as the renderer's samples do, or from its middle alone,
 * where what its layers name lies. */
enum wd_reference_places { WD_REFERENCE_WHOLE_PIXELS, WD_REFERENCE_MIDDLES };

struct wd_reference_picture_params {
    struct wd_camera camera;
    const struct wd_sun *sun; /* in place of where the scene has it; NULL: there. Refused under a sky map */
    double time_s;          /* of the wind; within 1e9 of 0 */
    uint32_t width, height; /* 1..16384 each */
    uint32_t samples;       /* paths a pixel; 0: 64 */
    uint32_t bounces;       /* times that light is scattered; 0: 8 */
    uint32_t layers;        /* wd_layer_bits wanted; 0: display; WD_LAYER_ALL: all that there are, which leaves out
                               velocity. Velocity and cryptomatte by name are refused. Paths are for color and
                               display */
    uint32_t stream;        /* pictures of other streams, else alike, have noise of their own */
    enum wd_reference_places places;
    const char *checkpoint; /* a file that holds an unfinished picture: taken up if it is there,
                               written when stopped and now and then, removed at the end; NULL: none */
};

/* Traces one picture of what wd_renderer_render draws with the same camera: the same sun, sky, haze,
 * water, ground, trees and depth of field, every tree with its full mesh; trees lean in the wind, their leaves do
 * not flutter. Each sample is a path from a random place of its pixel (a box filter, as that of the
 * renderer's samples). The picture is a function of the forest and these parameters, the same for
 * any number of threads and interruptions.
 *   picture  overwritten; free with wd_picture_finish
 * Errors: WD_ERROR_INPUT (parameters; a checkpoint of another picture or with more samples; trees on demand),
 * WD_ERROR_OUTPUT (a checkpoint that cannot be written), WD_ERROR_MEMORY, WD_ERROR_INTERRUPTED. */
enum wd_result wd_reference_render(struct wd_reference *reference,
                                   const struct wd_reference_picture_params *params,
                                   struct wd_picture *picture);

/* wd_forest_key without settings of methods (methods.* of struct wd_forest_params), which change no
 * path-traced picture. Thread-safe. */
uint64_t wd_reference_key(const struct wd_forest *forest);

/* Of the newest picture. */
struct wd_reference_stats {
    uint64_t rays;
    double build_s, trace_s;  /* wall clock: of placing trees, of paths */
    uint64_t resumed_samples; /* taken over from the checkpoint, of all tiles */
    uint64_t self_hits;       /* rays that met the triangle they had just left: 0 in a right picture */
};
void wd_reference_get_stats(const struct wd_reference *reference,
                            struct wd_reference_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
