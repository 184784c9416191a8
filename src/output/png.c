#include <errno.h>
#include <spng.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/image.h"

enum { MAX_SIDE_PX = 32768, COMPRESSION_LEVEL = 4 };

void wd_image8_finish(struct wd_image8 *image)
{
    free(image->pixels);
    *image = (struct wd_image8){0};
}

/* sRGB, and for readers that do not know it what comes nearest: its primaries, its white and the
 * gamma 1 / 2.2 (PNG specification, third edition, 11.3.2.5). */
static int note_colours(spng_ctx *context)
{
    /* in hundred-thousandths */
    struct spng_chrm_int srgb = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    int result = spng_set_srgb(context, 0); /* perceptual */
    if (!result)
        result = spng_set_gama_int(context, 45455);
    return result ? result : spng_set_chrm_int(context, &srgb);
}

static int encode(spng_ctx *context, FILE *stream, const uint8_t *rgb, uint32_t width,
                  uint32_t height)
{
    struct spng_ihdr header = {.width = width, .height = height, .bit_depth = 8,
                               .color_type = SPNG_COLOR_TYPE_TRUECOLOR};
    size_t size = (size_t)width * height * 3;
    int result = spng_set_png_file(context, stream);
    if (!result)
        result = spng_set_option(context, SPNG_IMG_COMPRESSION_LEVEL, COMPRESSION_LEVEL);
    if (!result)
        result = spng_set_ihdr(context, &header);
    if (!result)
        result = note_colours(context);
    if (!result)
        result = spng_encode_image(context, rgb, size, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    return result;
}

bool wd_png_write(const char *path, const uint8_t *rgb, uint32_t width, uint32_t height,
                  const struct wd_log *log)
{
    if (width < 1 || height < 1 || width > MAX_SIDE_PX || height > MAX_SIDE_PX)
        return wd_error(log, "%s: a picture of %u x %u pixels; allowed are 1 to %d a side", path,
                        width, height, MAX_SIDE_PX);
    struct wd_output_file file;
    if (!wd_output_open(&file, path, log))
        return false;
    spng_ctx *context = spng_ctx_new(SPNG_CTX_ENCODER);
    errno = 0;
    int result = context ? encode(context, file.stream, rgb, width, height)
                         : SPNG_EMEM;
    int error = errno;
    spng_ctx_free(context);
    if (!result)
        return wd_output_commit(&file, log);
    /* the encoder goes on after a failed write and ends with an error of its own */
    wd_error(log, "%s: cannot be written: %s", path,
             ferror(file.stream) && error ? strerror(error) : spng_strerror(result));
    wd_output_discard(&file);
    return false;
}

static int decode(spng_ctx *context, FILE *stream, struct wd_image8 *image)
{
    struct spng_ihdr header;
    size_t size = 0;
    int result = spng_set_png_file(context, stream);
    if (!result)
        result = spng_set_image_limits(context, MAX_SIDE_PX, MAX_SIDE_PX);
    if (!result)
        result = spng_get_ihdr(context, &header);
    if (!result)
        result = spng_decoded_image_size(context, SPNG_FMT_RGB8, &size);
    if (result)
        return result;
    *image = (struct wd_image8){header.width, header.height, wd_alloc(size)};
    result = spng_decode_image(context, image->pixels, size, SPNG_FMT_RGB8, 0);
    return result ? result : spng_decode_chunks(context); /* to the file's end */
}

bool wd_png_read(struct wd_image8 *image, const char *path, const struct wd_log *log)
{
    *image = (struct wd_image8){0};
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return wd_error(log, "%s: cannot be opened: %s", path, strerror(errno));
    spng_ctx *context = spng_ctx_new(0);
    int result = context ? decode(context, stream, image) : SPNG_EMEM;
    spng_ctx_free(context);
    fclose(stream);
    if (!result)
        return true;
    wd_image8_finish(image);
    return wd_error(log, "%s: is not a PNG that can be read: %s", path, spng_strerror(result));
}
