/* light.h: what the light pass is told besides the frame's uniforms. */
#ifndef WD_SHARED_LIGHT_H
#define WD_SHARED_LIGHT_H

#include "shared/types.h"

struct wd_light_push {
    WD_VEC2(camera_m);   /* local; for places in the field of shadow heights only */
    float sun_cell_m;    /* of that field */
    float sun_soft_m;    /* half the height over which its shadows fade */
    uint32_t sun_width, sun_height;
    uint32_t variants;   /* models a species */
};

/* Metering: 256 classes of log2 luminance, then the exposure they come to. */
#define WD_METER_BINS 256
#define WD_METER_LOW -16.0f  /* log2 of luminance at class 0 */
#define WD_METER_PER_EV 10.0f

struct wd_meter {
    uint32_t bins[WD_METER_BINS];
    float exposure;
};

struct wd_post_push {
    float exposure_scale; /* 2^exposure_ev */
};

#endif
