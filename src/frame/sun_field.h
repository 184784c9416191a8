/* sun_field.h: shadows of the ground on itself and on what stands on it, at any distance: for each
 * place, the height below which the ground hides the middle of the sun. */
#ifndef WD_FRAME_SUN_FIELD_H
#define WD_FRAME_SUN_FIELD_H

#include "gpu/command.h"
#include "world/terrain.h"

struct wd_sun_field {
    struct wd_buffer heights;         /* float[width * height] */
    uint32_t width, height;           /* samples, at least 2 each; at most 2048 a side */
    float cell_m;
    float soft_m;                     /* of wd_sun_field_soft_m */
    const struct wd_terrain *terrain; /* it was made for these two */
    float direction[3];
};

/* Makes the field for this terrain and sun where it is not there yet, and declares that compute
 * shaders read it. A change costs a few milliseconds a million samples. */
void wd_sun_field_update(struct wd_sun_field *field, struct wd_cmd *cmd,
                         const struct wd_terrain *terrain, const float sun_direction[3]);
/* The device never ran what was recorded: it is made anew. */
void wd_sun_field_forget(struct wd_sun_field *field);
void wd_sun_field_finish(struct wd_sun_field *field, struct wd_gpu *gpu);

/* The field itself: out[width * height] for heights[width * height], `toward_x`, `toward_y` the
 * sun's unit direction across and `rise` its height over run. Rows from the south. */
void wd_sun_field_sweep(float *out, const float *height_m, uint32_t width, uint32_t height,
                        float cell_m, float toward_x, float toward_y, float rise);

/* Half the height over which the field's shadows fade: what is nearer to it than this has part of the sun. */
float wd_sun_field_soft_m(float cell_m, float rise);

#endif
