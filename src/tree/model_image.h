/* model_image.h: pictures of models: PNG and JPEG files in memory. */
#ifndef WD_TREE_MODEL_IMAGE_H
#define WD_TREE_MODEL_IMAGE_H

#include "base/log.h"

/* sRGB colour and alpha, rows from the top. `{0}` is empty. */
struct wd_model_image {
    uint32_t width, height;
    uint8_t *rgba;
};
void wd_model_image_finish(struct wd_model_image *image); /* accepts {0} */

/* Decodes a PNG or JPEG of at most 16384 pixels a side. False, with `*why` a few words about what is
 * wrong with it: nothing is logged. */
bool wd_model_image_decode(struct wd_model_image *image, const uint8_t *bytes, size_t size,
                           const char **why);

/* Encodes as PNG, with alpha unless it is 255 everywhere. free() the result; NULL: no memory. */
uint8_t *wd_model_image_encode(const struct wd_model_image *image, size_t *size);

#endif
