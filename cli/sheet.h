/* sheet.h: writing on pictures. */
#ifndef CLI_SHEET_H
#define CLI_SHEET_H

#include "weald/renderer.h"

/* Writes dark letters of 5 x 8 dots, `scale` pixels a dot, from (x, y) on; what has no letter here
 * is a blank. */
void cli_sheet_text(struct wd_picture *picture, uint32_t x, uint32_t y, uint32_t scale,
                    const char *text);

#endif
