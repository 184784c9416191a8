/* image_compare.h: how far two pictures are apart. */
#ifndef WD_TESTS_OUTPUT_IMAGE_COMPARE_H
#define WD_TESTS_OUTPUT_IMAGE_COMPARE_H

#include "output/image.h"

struct wd_image_difference {
    double rmse_linear;       /* root mean square over all pixels and channels, linear light */
    double mean_absolute;     /* of the 8-bit values, 0..255 */
    unsigned max_absolute;    /* of the 8-bit values */
    double different_share;   /* of the pixels with any difference */
    double block_rmse_linear; /* of the means of 16 x 16 blocks: noise averages out, bias stays */
    double block_max_linear;  /* largest difference between two block means of a channel */
    double brightness_ratio;  /* mean linear value of b over that of a; 1 when a is black */
};

/* Both of `width` x `height` 8-bit sRGB pixels. */
struct wd_image_difference wd_image_compare(const uint8_t *a, const uint8_t *b, uint32_t width,
                                            uint32_t height);

/* Linear means of blocks of `block` x `block` pixels (smaller at the right and lower edge), 3 a
 * block, rows from the top. `means` holds ceil(width / block) * ceil(height / block) * 3. */
void wd_image_block_means(const uint8_t *rgb, uint32_t width, uint32_t height, uint32_t block,
                          float *means);

/* |a - b| per channel, times `gain`, clamped: what an updated golden image is judged by. */
void wd_image_difference_picture(const uint8_t *a, const uint8_t *b, uint32_t width,
                                 uint32_t height, unsigned gain, uint8_t *picture);

#endif
