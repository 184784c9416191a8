/* image.h: 8- and 16-bit pictures and PNG files. */
#ifndef WD_OUTPUT_IMAGE_H
#define WD_OUTPUT_IMAGE_H

#include "weald/types.h"

/* Red, green, blue in sRGB, rows from the top, no padding. `{0}` is empty. */
struct wd_image8 {
    uint32_t width, height;
    uint8_t *pixels; /* width * height * 3 */
};
void wd_image8_finish(struct wd_image8 *image);

/* Writes sRGB pixels (rows from the top, 3 values a pixel); the file appears whole or not at all. */
bool wd_png_write(const char *path, const uint8_t *rgb, uint32_t width, uint32_t height,
                  const struct wd_log *log);

/* Any PNG up to 32768 pixels a side as 8-bit RGB; transparency is dropped. */
bool wd_png_read(struct wd_image8 *image, const char *path, const struct wd_log *log);

#endif
