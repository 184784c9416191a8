#include "output/flip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/dmath.h"
#include "base/memory.h"
#include "output/convolve.h"

/* Symbols in comments are the paper's. */
static const float WHITE[3] = {0.950428545f, 1.0f, 1.088900371f}; /* XYZ of D65 */

/* --- colour spaces --------------------------------------------------------------------------- */

static const double XYZ_FROM_RGB[3][3] = {
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0},
};
static const double RGB_FROM_XYZ[3][3] = {
    {3.241003275, -1.537398934, -0.498615861},
    {-0.969224334, 1.875930071, 0.041554224},
    {0.055639423, -0.204011202, 1.057148933},
};

static void multiply(const double m[3][3], const float v[3], float result[3])
{
    for (int i = 0; i < 3; i++)
        result[i] = (float)(m[i][0] * (double)v[0] + m[i][1] * (double)v[1] +
                            m[i][2] * (double)v[2]);
}

/* Linear opponent colours Y, Cx, Cz. */
static void opponent_from_rgb(const float rgb[3], float opponent[3])
{
    float xyz[3];
    multiply(XYZ_FROM_RGB, rgb, xyz);
    float x = xyz[0] / WHITE[0], y = xyz[1] / WHITE[1], z = xyz[2] / WHITE[2];
    opponent[0] = 116 * y - 16;
    opponent[1] = 500 * (x - y);
    opponent[2] = 200 * (y - z);
}

static void rgb_from_opponent(const float opponent[3], float rgb[3])
{
    float y = (opponent[0] + 16) / 116, x = opponent[1] / 500 + y, z = y - opponent[2] / 200;
    const float xyz[3] = {x * WHITE[0], y * WHITE[1], z * WHITE[2]};
    multiply(RGB_FROM_XYZ, xyz, rgb);
    for (int k = 0; k < 3; k++)
        rgb[k] = fminf(fmaxf(rgb[k], 0), 1);
}

static float lab_curve(float t)
{
    const float d = 6.0f / 29;
    return t > d * d * d ? cbrtf(t) : t / (3 * d * d) + 4.0f / 29;
}

/* CIE Lab with chroma weighted by lightness (Hunt 1952). */
static void hunt_lab(const float rgb[3], float lab[3])
{
    float xyz[3];
    multiply(XYZ_FROM_RGB, rgb, xyz);
    float x = lab_curve(xyz[0] / WHITE[0]), y = lab_curve(xyz[1] / WHITE[1]);
    float z = lab_curve(xyz[2] / WHITE[2]);
    lab[0] = 116 * y - 16;
    lab[1] = 0.01f * lab[0] * 500 * (x - y);
    lab[2] = 0.01f * lab[0] * 200 * (y - z);
}

/* HyAB (Abasi et al. 2020). */
static float lab_distance(const float a[3], const float b[3])
{
    float da = a[1] - b[1], db = a[2] - b[2];
    return fabsf(a[0] - b[0]) + sqrtf(da * da + db * db);
}

/* --- colour difference ----------------------------------------------------------------------- */

struct plane_set {
    uint32_t width, height;
    float *plane[3];
};

static struct plane_set planes_of(uint32_t width, uint32_t height)
{
    struct plane_set set = {width, height, {0}};
    for (int k = 0; k < 3; k++)
        set.plane[k] = wd_alloc_array((size_t)width * height, sizeof(float));
    return set;
}

static void free_planes(struct plane_set *set)
{
    for (int k = 0; k < 3; k++)
        free(set->plane[k]);
}

static void fill_opponent(struct plane_set *set, const uint8_t *pixels, uint32_t stride)
{
    const float *linear = wd_srgb_table();
    for (size_t i = 0; i < (size_t)set->width * set->height; i++) {
        const uint8_t *p = pixels + i * stride;
        const float rgb[3] = {linear[p[0]], linear[p[1]], linear[p[2]]};
        float opponent[3];
        opponent_from_rgb(rgb, opponent);
        for (int k = 0; k < 3; k++)
            set->plane[k][i] = opponent[k];
    }
}

/* Contrast sensitivity of each opponent channel: sums of two Gaussians with a_i, b_i of Table 1. */
static const double CSF[3][4] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5},
                                 {34.1, 0.04, 13.5, 0.025}};

static double fill_gaussian(float *kernel, int radius, double b, float pixels_per_degree)
{
    double sum = 0;
    for (int k = -radius; k <= radius; k++) {
        double x = k / (double)pixels_per_degree;
        double value = exp(-WD_PI * WD_PI * x * x / b);
        kernel[k + radius] = (float)value;
        sum += value;
    }
    return sum;
}

/* A sum of products is filtered product by product; the whole kernel sums to 1. */
static void filter_channel(float *plane, const struct plane_set *set, int channel,
                           float pixels_per_degree)
{
    const double *csf = CSF[channel];
    int radius = (int)ceil(3 * sqrt(0.04 / (2 * WD_PI * WD_PI)) * (double)pixels_per_degree);
    size_t pixels = (size_t)set->width * set->height;
    float *kernel = wd_alloc_array(2 * (size_t)radius + 1, sizeof *kernel);
    float *scratch = wd_alloc_array(pixels, sizeof *scratch);
    float *part = wd_alloc_array(pixels, sizeof *part), *sum = wd_alloc_array(pixels, sizeof *sum);
    double weight = 0;
    for (int i = 0; i < 2; i++) {
        double a = csf[2 * i], b = csf[2 * i + 1];
        if (a == 0)
            continue;
        double total = fill_gaussian(kernel, radius, b, pixels_per_degree);
        double height = a * sqrt(WD_PI / b);
        weight += height * total * total;
        wd_convolve(part, scratch, plane, set->width, set->height, kernel, kernel, radius);
        for (size_t k = 0; k < pixels; k++)
            sum[k] += (float)height * part[k];
    }
    for (size_t k = 0; k < pixels; k++)
        plane[k] = sum[k] / (float)weight;
    free(kernel);
    free(scratch);
    free(part);
    free(sum);
}

static void pixel_lab(const struct plane_set *set, size_t pixel, float lab[3])
{
    float rgb[3];
    const float opponent[3] = {set->plane[0][pixel], set->plane[1][pixel], set->plane[2][pixel]};
    rgb_from_opponent(opponent, rgb);
    hunt_lab(rgb, lab);
}

/* Distances to the power 0.7; the lower 40% of the range is drawn over 95% of the errors. */
static float redistribute(float distance, float greatest)
{
    float power = powf(distance, 0.7f), knee = 0.4f * greatest;
    return power < knee ? 0.95f / knee * power
                        : 0.95f + (power - knee) / (greatest - knee) * 0.05f;
}

static void color_difference(float *error, const struct plane_set *a, const struct plane_set *b)
{
    static const float green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    float lab_green[3], lab_blue[3];
    hunt_lab(green, lab_green);
    hunt_lab(blue, lab_blue);
    float greatest = powf(lab_distance(lab_green, lab_blue), 0.7f);
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) {
        float lab_a[3], lab_b[3];
        pixel_lab(a, i, lab_a);
        pixel_lab(b, i, lab_b);
        error[i] = redistribute(lab_distance(lab_a, lab_b), greatest);
    }
}

/* --- edges and points ------------------------------------------------------------------------ */

/* First (edge) or second (point) derivative of a Gaussian; its positive and its negative weights
 * sum to 1 each. */
static void fill_detector(float *kernel, int radius, float deviation, int order)
{
    double positive = 0, negative = 0;
    for (int k = -radius; k <= radius; k++) {
        double x = k, s2 = (double)deviation * (double)deviation;
        double value = exp(-x * x / (2 * s2)) * (order == 1 ? -x : x * x / s2 - 1);
        kernel[k + radius] = (float)value;
        *(value > 0 ? &positive : &negative) += fabs(value);
    }
    for (int k = 0; k <= 2 * radius; k++)
        kernel[k] /= (float)(kernel[k] > 0 ? positive : negative);
}

/* Strength of edges (order 1) or points (order 2) in luminance 0..1. */
static void detect(float *strength, const float *luminance, uint32_t width, uint32_t height,
                   float deviation, int order)
{
    int radius = (int)ceilf(3 * deviation);
    size_t pixels = (size_t)width * height;
    float *detector = wd_alloc_array(2 * (size_t)radius + 1, sizeof *detector);
    float *smooth = wd_alloc_array(2 * (size_t)radius + 1, sizeof *smooth);
    float *scratch = wd_alloc_array(pixels, sizeof *scratch);
    float *down = wd_alloc_array(pixels, sizeof *down);
    float sum = 0;
    fill_detector(detector, radius, deviation, order);
    for (int k = -radius; k <= radius; k++)
        sum += smooth[k + radius] = expf(-(float)(k * k) / (2 * deviation * deviation));
    for (int k = 0; k <= 2 * radius; k++)
        smooth[k] /= sum;
    wd_convolve(strength, scratch, luminance, width, height, detector, smooth, radius);
    wd_convolve(down, scratch, luminance, width, height, smooth, detector, radius);
    for (size_t i = 0; i < pixels; i++)
        strength[i] = sqrtf(strength[i] * strength[i] + down[i] * down[i]);
    free(detector);
    free(smooth);
    free(scratch);
    free(down);
}

static float *luminance_of(const struct plane_set *set)
{
    size_t pixels = (size_t)set->width * set->height;
    float *luminance = wd_alloc_array(pixels, sizeof *luminance);
    for (size_t i = 0; i < pixels; i++)
        luminance[i] = (set->plane[0][i] + 16) / 116;
    return luminance;
}

/* The greater of the differences in edges and in points, (d / sqrt 2)^0.5. */
static void feature_difference(float *difference, const struct plane_set *a,
                               const struct plane_set *b, float pixels_per_degree)
{
    size_t pixels = (size_t)a->width * a->height;
    float deviation = 0.5f * 0.082f * pixels_per_degree;
    float *luminance[2] = {luminance_of(a), luminance_of(b)}, *strength[2];
    for (int k = 0; k < 2; k++)
        strength[k] = wd_alloc_array(pixels, sizeof(float));
    for (int order = 1; order <= 2; order++) {
        for (int k = 0; k < 2; k++)
            detect(strength[k], luminance[k], a->width, a->height, deviation, order);
        for (size_t i = 0; i < pixels; i++) {
            float apart = fabsf(strength[0][i] - strength[1][i]);
            difference[i] = order == 1 ? apart : fmaxf(difference[i], apart);
        }
    }
    for (size_t i = 0; i < pixels; i++)
        difference[i] = fminf(sqrtf(difference[i] * 0.70710678f), 1);
    for (int k = 0; k < 2; k++) {
        free(luminance[k]);
        free(strength[k]);
    }
}

/* --- both ------------------------------------------------------------------------------------ */

double wd_flip(float *error, const uint8_t *reference, const uint8_t *test, uint32_t width,
               uint32_t height, uint32_t stride, float pixels_per_degree)
{
    struct plane_set a = planes_of(width, height), b = planes_of(width, height);
    size_t pixels = (size_t)width * height;
    float *feature = wd_alloc_array(pixels, sizeof *feature);
    double sum = 0;
    fill_opponent(&a, reference, stride);
    fill_opponent(&b, test, stride);
    feature_difference(feature, &a, &b, pixels_per_degree);
    for (int k = 0; k < 3; k++) {
        filter_channel(a.plane[k], &a, k, pixels_per_degree);
        filter_channel(b.plane[k], &b, k, pixels_per_degree);
    }
    color_difference(error, &a, &b);
    for (size_t i = 0; i < pixels; i++) {
        error[i] = powf(error[i], 1 - feature[i]);
        sum += (double)error[i];
    }
    free_planes(&a);
    free_planes(&b);
    free(feature);
    return pixels ? sum / (double)pixels : 0;
}
