/* weald/compare.h: how far a picture is from the truth. */
#ifndef WEALD_COMPARE_H
#define WEALD_COMPARE_H

#include "weald/renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All are 0 for equal pictures, but ssim, which is 1. */
struct wd_comparison {
    double flip;               /* mean FLIP (Andersson et al. 2020) of both as a display shows them,
                                  at the reference's exposure; 0..1 */
    double ssim;               /* mean structural similarity (Wang et al. 2004) of the same */
    double rmse_pct;           /* root mean square difference of radiance over the reference's mean */
    double block_rmse_pct;     /* the same of means over 16 x 16 pixels: noise averages out */
    double radiance_bias_pct;  /* mean radiance over the reference's, less 100 */
    double tree_bias_pct;      /* the same over pixels that show a tree in both */
    double coverage_bias_pct;  /* pixels that show a tree over the reference's, less 100 */
};

/* Names of the members in their order, ended by NULL, and the value of one by its index (0 beyond). Thread-safe. */
const char *const *wd_comparison_names(void);
double wd_comparison_value(const struct wd_comparison *comparison, uint32_t index);

/* Compares two pictures that both have colour and tree ids.
 *   error_map  NULL, or room for width * height: FLIP of each pixel
 * Errors: WD_ERROR_INPUT (sizes differ or are 0, a layer is missing, a colour is no finite number). Thread-safe. */
enum wd_result wd_picture_compare(struct wd_comparison *comparison,
                                  const struct wd_picture *reference,
                                  const struct wd_picture *picture, float *error_map,
                                  const struct wd_log *log);

/* Fills both pictures' display layers from their colour, at the exposure that metering asks for
 * `reference`: as they must be to be looked at side by side. Errors: as wd_picture_compare. Thread-safe for different
 * pictures. */
enum wd_result wd_picture_expose_alike(struct wd_picture *reference, struct wd_picture *picture,
                                       const struct wd_log *log);

/* Reads colour, depth, species and tree ids, as far as there are, from an .exr that
 * wd_picture_write made.
 *   picture  overwritten; free with wd_picture_finish
 * Errors: WD_ERROR_INPUT, WD_ERROR_MEMORY. Thread-safe. */
enum wd_result wd_picture_read_exr(struct wd_picture *picture, const char *path,
                                   const struct wd_log *log);

#ifdef __cplusplus
}
#endif
#endif
