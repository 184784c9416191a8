/* accumulate.h: jittered samples of frames that follow each other, kept along the motion of what they
 * show. */
#ifndef WD_SHARED_ACCUMULATE_H
#define WD_SHARED_ACCUMULATE_H

#include "shared/types.h"

/* What has been gathered of pixels, in buffers of two words a pixel: devices may let a shader see no more of one buffer
 * than four words of each pixel of 3840 x 2160. */
#define WD_HISTORY_RED_GREEN 0    /* of the mean radiance */
#define WD_HISTORY_BLUE_SAMPLES 1 /* its blue; how many samples the mean stands for */
#define WD_HISTORY_SEEN 2         /* surface and depth as in the G-buffer, of the newest sample */
#define WD_HISTORY_PARTS 3

/* Samples that a pixel's mean stands for at most: while nothing moves, and while something does. */
#define WD_STILL_SAMPLES 256.0
#define WD_MOVING_SAMPLES 24.0

struct wd_accumulate_push {
    uint32_t has_history; /* 0: everything begins anew */
    uint32_t still;       /* 1: neither the camera nor time has moved since the frame before */
};

#endif
