/* Pictures that a run keeps: whole as PNG, small as JPEG for the report. */
#include "bench.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <turbojpeg.h>

enum { SMALL_WIDTH = 240, JPEG_QUALITY = 82 };

/* From black over violet and orange to pale yellow. */
void bench_map_error(struct wd_picture *picture, const float *error)
{
    static const float ramp[5][3] = {
        {0, 0, 4}, {81, 18, 124}, {183, 55, 121}, {252, 137, 97}, {252, 253, 191}};
    size_t pixels = (size_t)picture->width * picture->height;
    for (size_t i = 0; i < pixels; i++) {
        float at = fminf(fmaxf(error[i], 0), 1) * 4;
        int low = at < 3 ? (int)at : 3;
        for (size_t k = 0; k < 3; k++)
            picture->display[4 * i + k] =
                (uint8_t)(ramp[low][k] + (at - (float)low) * (ramp[low + 1][k] - ramp[low][k]));
    }
}

/* Means of squares of display pixels; free() them. */
static uint8_t *shrink(const struct wd_picture *picture, uint32_t square, uint32_t width,
                       uint32_t height)
{
    uint8_t *small = malloc((size_t)width * height * 3);
    for (uint32_t i = 0; small && i < width * height; i++)
        for (uint32_t c = 0; c < 3; c++) {
            uint32_t sum = 0;
            for (uint32_t k = 0; k < square * square; k++) {
                size_t x = i % width * square + k % square, y = i / width * square + k / square;
                sum += picture->display[4 * (y * picture->width + x) + c];
            }
            small[3 * (size_t)i + c] = (uint8_t)((sum + square * square / 2) / (square * square));
        }
    return small;
}

static bool write_bytes(const char *path, const void *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    bool ok = file && fwrite(data, 1, size, file) == size;
    return (file && fclose(file) == 0) && ok;
}

static enum wd_result keep_small(struct bench *bench, const struct wd_picture *picture,
                                 const char *path)
{
    uint32_t square = (picture->width + SMALL_WIDTH - 1) / SMALL_WIDTH;
    uint32_t width = picture->width / square, height = picture->height / square;
    uint8_t *small = shrink(picture, square, width ? width : 1, height ? height : 1);
    unsigned char *jpeg = NULL;
    unsigned long size = 0;
    tjhandle encoder = tjInitCompress();
    bool ok = small && encoder && width && height &&
              tjCompress2(encoder, small, (int)width, 0, (int)height, TJPF_RGB, &jpeg, &size,
                          TJSAMP_420, JPEG_QUALITY, 0) == 0 &&
              write_bytes(path, jpeg, size);
    if (!ok)
        cli_fail(bench->session, "%s cannot be written: %s", path, strerror(errno));
    if (encoder)
        tjDestroy(encoder);
    tjFree(jpeg);
    free(small);
    return ok ? WD_OK : WD_ERROR_OUTPUT;
}

enum wd_result bench_keep_picture(struct bench_stage *stage, const struct wd_picture *picture,
                                  const struct bench_row *row, const char *what)
{
    char *path = bench_path(stage->bench, "pictures/%s-%s-%s.png", row->scene, row->camera, what);
    char *small = bench_path(stage->bench, "pictures/%s-%s-%s.jpg", row->scene, row->camera, what);
    enum wd_result result = wd_picture_write(picture, path, &stage->bench->session->log);
    if (result == WD_OK)
        result = keep_small(stage->bench, picture, small);
    free(path);
    free(small);
    return result;
}
