/* accumulate.h: jittered samples of frames that follow each other, kept along the motion of what they
 * show. */
#ifndef WD_SHARED_ACCUMULATE_H
#define WD_SHARED_ACCUMULATE_H

#include "shared/types.h"

/* What has been gathered of one pixel. */
struct wd_history_pixel {
    WD_VEC3(radiance);  /* mean */
    float samples;      /* that it stands for */
    uint32_t surface;   /* as the G-buffer's, of the newest sample */
    float depth;        /* likewise */
};

/* Samples that a pixel's mean stands for at most: while nothing moves, and while something does. */
#define WD_STILL_SAMPLES 256.0
#define WD_MOVING_SAMPLES 24.0

struct wd_accumulate_push {
    uint32_t has_history; /* 0: everything begins anew */
    uint32_t still;       /* 1: neither the camera nor time has moved since the frame before */
};

#endif
