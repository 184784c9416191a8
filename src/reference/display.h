/* display.h: from radiance to what a display shows, as the renderer's last pass does it. */
#ifndef WD_REFERENCE_DISPLAY_H
#define WD_REFERENCE_DISPLAY_H

#include <stdint.h>

/* `color`: 3 a pixel; `display`: 4 bytes a pixel. `exposure_ev` is added to what metering asks. */
void wd_display_map(const float *color, uint32_t width, uint32_t height, float exposure_ev,
                    uint8_t *display);

#endif
