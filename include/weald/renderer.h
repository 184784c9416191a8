/* weald/renderer.h: pictures of a forest, on a Vulkan device that the renderer opens itself. */
#ifndef WEALD_RENDERER_H
#define WEALD_RENDERER_H

#include "weald/forest.h"

#ifdef __cplusplus
extern "C" {
#endif

struct wd_renderer;

enum wd_validation {
    WD_VALIDATION_OFF,
    WD_VALIDATION_ON, /* Vulkan validation and synchronization validation; abort at the first error */
};

struct wd_renderer_params {
    const char *gpu; /* NULL: the best device; "software"; or a part of a device's name */
    enum wd_validation validation;
    const char *cache_dir; /* of baked trees; NULL: $XDG_CACHE_HOME/weald; "": no cache */
    unsigned threads; /* 0: one a processor; changes no picture */
    struct wd_progress progress; /* of wd_renderer_set_forest, and of pictures: stage "samples" */
    struct wd_log log;
};

/* Opens a device and builds the pipelines.
 *   renderer  receives the new object, NULL on failure; destroy with wd_renderer_destroy
 *   params    read during the call only, but for `log` and `progress`
 * Errors: WD_ERROR_DEVICE (no Vulkan, no such device, a feature is missing), WD_ERROR_MEMORY, WD_ERROR_INPUT.
 * A renderer may be used by one thread at a time. */
enum wd_result wd_renderer_create(struct wd_renderer **renderer,
                                  const struct wd_renderer_params *params);
/* Waits for what the device still draws and frees all. Accepts NULL and a pointer to NULL. */
void wd_renderer_destroy(struct wd_renderer **renderer);

/* Grows (or takes from the cache) the trees of `forest` and puts it all on the device, in place of
 * the forest before. `forest` must outlive its use here. NULL: none.
 * Errors: WD_ERROR_DEVICE, WD_ERROR_MEMORY (the device's), WD_ERROR_INTERRUPTED. */
enum wd_result wd_renderer_set_forest(struct wd_renderer *renderer, const struct wd_forest *forest);

/* Names of the methods, ended by NULL; the pointer stays valid for ever. Thread-safe, as the next two. */
const char *const *wd_method_names(void);

struct wd_method_info {
    const char *name, *summary;
    const char *rows; /* of docs/methods.md: what of the papers it is */
};
/* The methods in the order of their names; false beyond the last. Strings stay valid for ever. */
bool wd_method_get_info(uint32_t index, struct wd_method_info *info);

struct wd_method_option {
    const char *name, *summary;
    const char *row;      /* of docs/methods.md */
    const char *fallback; /* its default, as JSON */
    char allowed[128];    /* such as "a whole number from 1 to 16" */
};
/* An option of a method, as scenes ("methods": {"octree": {"max_cull_depth": 7}}) and
 * wd_forest_params.settings give it; false beyond the method's last. */
bool wd_method_get_option(uint32_t method_index, uint32_t option_index,
                          struct wd_method_option *option);

/* What pixels show. */
enum wd_view_mode {
    WD_VIEW_LIT,
    WD_VIEW_LOD,     /* trees coloured by level of detail: red mesh, yellow reduced, blue billboard, purple impostor
                        or far forest; of continuum, which has no levels, leaves green and wood brown */
    WD_VIEW_ALBEDO,
    WD_VIEW_NORMAL,
    WD_VIEW_TREE_ID,
    WD_VIEW_SHADOW,
};

/* Layers of a picture; OR them. All but display, colour and cryptomatte are those of the last sample: where none of
 * these three is wanted, that one alone is drawn, and without the first two no shadows and no light, but with
 * WD_ACCUMULATE. */
enum wd_layer_bits {
    WD_LAYER_DISPLAY = 1 << 0,  /* exposed, tone-mapped, sRGB */
    WD_LAYER_COLOR = 1 << 1,    /* linear radiance, scene units */
    WD_LAYER_DEPTH = 1 << 2,
    WD_LAYER_NORMAL = 1 << 3,
    WD_LAYER_ALBEDO = 1 << 4,
    WD_LAYER_SPECIES = 1 << 5,
    WD_LAYER_TREE_ID = 1 << 6,
    WD_LAYER_VELOCITY = 1 << 7,
    WD_LAYER_CRYPTOMATTE = 1 << 8, /* trees by coverage; each sample is read back for it */
    WD_LAYER_ALL = 0xff,           /* but that one */
};

/* Trees of a pixel that WD_LAYER_CRYPTOMATTE keeps, by falling coverage. */
enum { WD_RANKS = 6 };

enum wd_accumulation { WD_ACCUMULATE_NOT, WD_ACCUMULATE };
enum wd_time_mode { WD_TIME_OFF, WD_TIME_PASSES };

#define WD_LEAST_ERROR_PX 0.25
#define WD_MOST_ERROR_PX 32.0

struct wd_render_params {
    struct wd_camera camera;
    const struct wd_camera *previous_camera; /* for velocity; NULL: the camera stood still */
    const struct wd_sun *sun; /* in place of where the scene has it; NULL: there. Refused under a sky map */
    double time_s;          /* of the wind; within 1e9 of 0, as the next */
    double previous_time_s; /* for velocity */
    uint32_t width, height; /* 1..16384 each */
    uint32_t samples;       /* pictures averaged with sub-pixel offsets, 65536 at most; 0: 1 */
    const char *method;     /* NULL: the scene's */
    enum wd_view_mode view;
    uint32_t layers;        /* wd_layer_bits wanted; 0: display */
    double max_error_px;    /* of continuum, WD_LEAST_ERROR_PX..WD_MOST_ERROR_PX; 0: by its option
                               "density", or 2 to 4 times that where `samples` are more than 1. Mean distance, on
                               screen, between the discs that stand for a crown's surface: what is finer
                               may be missing from a single sample. Trees less than about twice as wide are
                               drawn as one for several, and triangles of wood and pages of trees on demand
                               are chosen alike. */
    /* WD_ACCUMULATE: one jittered sample, laid over what the pictures before this one of the same renderer,
     * method, view and size have shown of the same surfaces: moved along with camera and wind, and begun
     * anew where something else has come into view, and whole where the sun stands elsewhere. For live views;
     * `samples`, previous_camera and previous_time_s are not used. A still camera in a still world comes to the
     * picture of many samples. */
    enum wd_accumulation accumulation;
    enum wd_time_mode timing; /* per-pass times, at some cost */
};

/* A finished picture in host memory. Arrays are height * width, rows top to bottom; those not
 * asked for are NULL. Layers other than colour and display are not blended: they
 * hold the sample through each pixel's middle. */
struct wd_picture {
    uint32_t width, height;
    uint8_t *display;  /* 4 a pixel: R, G, B, 255 */
    float *color;      /* 3 a pixel */
    float *depth_m;    /* distance along the view axis, metres; +infinity for sky. wd_camera_place makes places of it.
                          Of trees that a method draws as pictures, that of the picture's plane: metres off, and seen
                          from above tens of metres. continuum draws none */
    float *normal;     /* 3 a pixel, local frame, unit length, of the side that is seen; 0 for sky */
    float *albedo;     /* 3 a pixel, linear */
    uint32_t *species; /* index + 1; 0: no tree */
    uint32_t *tree_id; /* 0: no tree */
    float *velocity_px; /* 2 a pixel: where this surface moved since the previous time, in pixels,
                           x right, y down */
    uint32_t *rank_tree; /* WD_RANKS a pixel: ids of trees by falling coverage; 0: no more */
    float *rank_share;   /* and the share of the pixel's samples that show each */
    struct wd_camera camera; /* that took it, */
    struct wd_sun sun;       /* under this sun, */
    double time_s;           /* at this time of the wind */
    char *about;         /* these, and what ids and places refer to, as JSON: scene, seed, time_s, camera (as in struct
                            wd_camera), origin_m and crs (as in struct wd_forest_info; null: none), species (names; the
                            species layer holds index + 1), conditions (date, clock, sun, clouds, visibility, wind and
                            snow, by the keys of scenes). Files (.exr) have it as the attribute "weald", and
                            worldToCamera: from the local frame to x right, y up, -z ahead, rows times matrix */
};

/* Draws one picture. Deterministic for the same device.
 *   picture  overwritten; free with wd_picture_finish
 * Errors: WD_ERROR_INPUT (no forest; a value out of its range, an unknown enum or layer; a method that is not
 * there or cannot draw trees on demand), WD_ERROR_DEVICE, WD_ERROR_MEMORY, WD_ERROR_INTERRUPTED (through the
 * renderer's progress, stage "samples"). */
enum wd_result wd_renderer_render(struct wd_renderer *renderer,
                                  const struct wd_render_params *params,
                                  struct wd_picture *picture);
void wd_picture_finish(struct wd_picture *picture); /* accepts NULL and {0} */

/* Times of a pass of the newest picture, per sample. */
struct wd_pass_time {
    const char *name; /* "shadow", "trees", "terrain", "light", ... */
    double gpu_ms;    /* 0 without WD_TIME_PASSES */
    double cpu_ms;
    double processor_ms; /* that all threads of the process ran, recording included; 0 on devices that
                            run passes beside each other */
    uint32_t depth;   /* 0: a pass; more: a part of the pass before it, whose time holds its own */
};
struct wd_frame_stats {
    double frame_ms; /* wall clock of one sample. After wd_renderer_render: from begin to finished, the mean of the
                        picture's samples. After wd_renderer_draw: until it is submitted, not until it is
                        drawn: that takes gpu_ms, and the caller's clock from frame to frame tells both */
    uint32_t samples; /* drawn for the newest picture */
    double gpu_ms;   /* device time of the newest frame of wd_renderer_draw that is finished; 0 where the device
                        has no true clock */
    uint32_t pass_count;
    const struct wd_pass_time *passes; /* valid until the next call on the renderer */
    uint64_t draw_calls, triangles;    /* submitted */
    uint64_t discs;                    /* of the camera's view, by wd_renderer_render; 0 without
                                          WD_TIME_PASSES and for methods other than continuum */
    uint64_t trees_mesh, trees_reduced, trees_billboard; /* drawn into the picture by level */
    uint64_t device_bytes, device_bytes_peak; /* the peak is the forest's, its coming included */
};
/* Of the newest picture, but for the memory held. */
void wd_renderer_get_stats(const struct wd_renderer *renderer, struct wd_frame_stats *stats);

/* Holds frame time by the error bound: before each frame but the first the caller tells how long the
 * newest one took and draws with the error that comes back. Nothing but arithmetic: the same times give
 * the same errors. */
struct wd_budget {
    double target_ms; /* > 0 */
    double error_px;  /* in force */
    double share;     /* of a frame's time that follows the number of discs, as told by the past */
    uint32_t settling; /* frames until a time told is weighed again */
    double weighed_ms, weighed_error_px; /* the newest time that was, and the error it belongs to */
};
struct wd_budget wd_budget_of(double target_ms);
/* Error for the frame to come, within WD_LEAST_ERROR_PX..WD_MOST_ERROR_PX. `frame_ms` that is not
 * positive and finite changes nothing. Times may be those of the frame before the newest or of the one
 * before it: after a change two frames are not weighed. Within eight frames of a jump in cost the time is
 * below the target again, as far as the bounds allow. */
double wd_budget_next(struct wd_budget *budget, double frame_ms);

/* Name of the device in use; lives as long as the renderer. */
const char *wd_renderer_device_name(const struct wd_renderer *renderer);
/* A number that changes with the device, its driver, weald's own code and the forest that is set
 * (wd_forest_key): equal numbers and wd_render_params give equal pictures. */
uint64_t wd_renderer_key(const struct wd_renderer *renderer);
/* Names of all Vulkan devices present, one a line, "" where there are none; free() it. */
char *wd_device_list(void);

/* --- writing pictures ------------------------------------------------------------------- */

/* Writes `picture` whole or not at all; endings are in upper or lower case. ".png" takes the display layer, ".exr"
 * every layer there is (R G B, Z in metres, N.X N.Y N.Z, albedo.R .G .B, species, tree_id, velocity.X .Y; ranks as
 * Cryptomatte 1.2: weald_tree00.R .G .B .A to weald_tree02, trees named "tree_ID" in the manifest).
 * Errors: WD_ERROR_INPUT for another ending or a missing layer, WD_ERROR_OUTPUT, WD_ERROR_MEMORY. Thread-safe. */
enum wd_result wd_picture_write(const struct wd_picture *picture, const char *path,
                                const struct wd_log *log);

/* A film in one file (".mp4", ".m4v", ".mov" or ".mkv", through ffmpeg) or numbered pictures (a name with %d or
 * %05d, ".png" or ".exr"); endings in upper or lower case. */
struct wd_film;
/* Whether a name ends as that of a film in one file. NULL does not. */
bool wd_film_has_ending(const char *path);
/* Whether a name is meant as that of numbered pictures: in its last part a letter follows a "%" and its digits, as in
 * %d and %05d; any other letter is refused when the film is opened. NULL is not. */
bool wd_film_is_numbered(const char *path);
#define WD_LEAST_FRAMES_PER_SECOND 0.01
#define WD_MOST_FRAMES_PER_SECOND 1000.0
struct wd_film_params {
    const char *path;         /* required */
    uint32_t width, height;   /* of every frame; even for a film in one file */
    double frames_per_second; /* WD_LEAST_FRAMES_PER_SECOND..WD_MOST_FRAMES_PER_SECOND; 0: 30. Numbered
                                 pictures do not tell of it */
    uint64_t first_frame;     /* number of the first of numbered pictures */
};
/* Begins a film.
 *   film  receives the new object, NULL on failure; end it with wd_film_commit or wd_film_discard
 * Errors: WD_ERROR_INPUT (name, size or rate), WD_ERROR_OUTPUT (of a film in one file a folder that is not there, no
 * ffmpeg). */
enum wd_result wd_film_open(struct wd_film **film, const struct wd_film_params *params,
                            const struct wd_log *log);
/* Adds the next frame.
 * Errors: WD_ERROR_INPUT (another size, no display layer, of .exr no layer at all) and WD_ERROR_MEMORY, after
 * which the film goes on; WD_ERROR_OUTPUT, after which it cannot: frames to come are refused with the same, and so is
 * wd_film_commit. What wd_film_keep has kept by then stays. */
enum wd_result wd_film_add(struct wd_film *film, const struct wd_picture *picture);
/* Keeps finished frames, or for numbered pictures their checksums, in PATH.partial (PATH.FIRST.partial where `first_frame`
 * is above 0) until the film has `frame_count` of them: a film that was stopped or killed can be gone on with.
 * `key` is a hash of all that the frames follow from (wd_renderer_key, wd_forest_key, and what the caller chose).
 * To be called once, before the first frame. A film of 3840 x 2160 takes about 15 MB a frame.
 * Errors: WD_ERROR_INPUT (a second time, or after a frame); WD_ERROR_OUTPUT, also where PATH.partial is of
 * another key, or in use. */
enum wd_result wd_film_keep(struct wd_film *film, uint64_t key, uint64_t frame_count);
/* Adds the next of the frames that were kept by an earlier film, if it is there and whole; else it is
 * to be drawn, like all after it. `*frames`: how many the film now has. */
enum wd_result wd_film_add_kept(struct wd_film *film, uint64_t *frames);
/* Finishes the film under its name, with the frames that it has, and frees it whatever comes back. With no
 * frame added nothing is written. Errors: WD_ERROR_INPUT (no film); WD_ERROR_OUTPUT, also where a frame could not be
 * written. */
enum wd_result wd_film_commit(struct wd_film **film);
/* Drops the film (numbered pictures already written stay). Accepts NULL and a pointer to NULL. */
void wd_film_discard(struct wd_film **film);

#ifdef __cplusplus
}
#endif
#endif
