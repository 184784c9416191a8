/* display.h: from radiance to what a display shows, as the renderer's last pass does it. */
#ifndef WD_REFERENCE_DISPLAY_H
#define WD_REFERENCE_DISPLAY_H

#include <stdint.h>

/* The exposure that metering asks for. `color`: 3 a pixel. */
float wd_display_exposure(const float *color, uint32_t width, uint32_t height);

/* `display`: 4 bytes a pixel. */
void wd_display_map_at(const float *color, uint32_t width, uint32_t height, float exposure,
                       uint8_t *display);

/* At the metered exposure; `exposure_ev` is added to it. */
void wd_display_map(const float *color, uint32_t width, uint32_t height, float exposure_ev,
                    uint8_t *display);

#endif
