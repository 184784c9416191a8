/* color.h: the sRGB transfer function (IEC 61966-2-1). Pictures only, not for placement. */
#ifndef WD_BASE_COLOR_H
#define WD_BASE_COLOR_H

#include <stdint.h>

float wd_srgb_decode(uint8_t value);  /* to linear, 0..1 */
const float *wd_srgb_table(void);     /* [256]: of every value, for what decodes many; thread-safe */
uint8_t wd_srgb_encode(float linear); /* clamps to 0..1 */
uint8_t wd_unorm_encode(float value); /* 0..1 to 0..255, clamped, rounded */

#endif
