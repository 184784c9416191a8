/* output.h: what writing pictures and films has in common. */
#ifndef WD_API_OUTPUT_H
#define WD_API_OUTPUT_H

#include "weald/renderer.h"

/* The display layer as three bytes a pixel; free() it. NULL, logged, where there is not so much memory. */
uint8_t *wd_picture_rgb(const struct wd_picture *picture, const struct wd_log *log);

#endif
