/* arguments.h: what callers hand over, checked in the same words wherever it comes in. */
#ifndef WD_API_ARGUMENTS_H
#define WD_API_ARGUMENTS_H

#include "weald/renderer.h"

struct wd_world;

/* Each logs what was found and what is right, by the name that the public headers give it. */

/* Whether `pointer`, a parameter or what one points to, is there: `wd_given(params->source, log)`. */
#define wd_given(pointer, log) wd_check_given((pointer), __func__, #pointer, (log))
bool wd_check_given(const void *pointer, const char *function, const char *name,
                    const struct wd_log *log);

/* Width and height of a picture, each 1 to WD_MOST_SIZE_PX. */
bool wd_check_size(uint32_t width, uint32_t height, const struct wd_log *log);
bool wd_check_samples(uint32_t samples, uint32_t most, const struct wd_log *log);

/* Position, angles and field of view. `name`: as in "previous_camera". */
bool wd_check_camera(const struct wd_camera *camera, const char *name, const struct wd_log *log);

/* A time of the wind: within 1e9 seconds of 0, where doubles still tell frames apart. */
bool wd_check_time(double time_s, const char *name, const struct wd_log *log);

/* Where a sun in place of the scene's stands; NULL is one. No sky map's light moves. */
bool wd_check_sun(const struct wd_sun *sun, const struct wd_world *world, const struct wd_log *log);

/* One of the values 0 .. count - 1 of an enum. */
bool wd_check_choice(int64_t value, int64_t count, const char *name, const struct wd_log *log);

/* wd_layer_bits that there are. */
bool wd_check_layers(uint32_t layers, const struct wd_log *log);

#endif
