#include "tree/model_image.h"

#include <spng.h>
#include <stdlib.h>
#include <string.h>
#include <turbojpeg.h>

#include "base/memory.h"

enum {
    MAX_SIDE_PX = 16384,
    MAX_BESIDE_BYTES = 64 << 20, /* of text and profiles that a PNG has beside its pixels */
    DEFLATED_MOST = 1040,       /* bytes that one of DEFLATE stands for */
    JPEG_MOST_PX = 64 * 8,      /* pixels that a byte stands for: a bit for the mean of 8 x 8, which every one has */
};
static const char cut_short[] = "it is cut short: it has too few bytes for its size in pixels";

void wd_model_image_finish(struct wd_model_image *image)
{
    free(image->rgba);
    *image = (struct wd_model_image){0};
}

static bool decode_png(struct wd_model_image *image, const uint8_t *bytes, size_t size,
                       const char **why)
{
    spng_ctx *context = spng_ctx_new(0);
    struct spng_ihdr header;
    size_t decoded = 0;
    int result = context ? spng_set_png_buffer(context, bytes, size) : SPNG_EMEM;
    if (!result)
        result = spng_set_image_limits(context, MAX_SIDE_PX, MAX_SIDE_PX);
    if (!result)
        result = spng_set_chunk_limits(context, MAX_BESIDE_BYTES, MAX_BESIDE_BYTES);
    if (!result)
        result = spng_get_ihdr(context, &header);
    if (!result)
        result = spng_decoded_image_size(context, SPNG_FMT_RGBA8, &decoded);
    if (!result && (uint64_t)header.width * header.height * header.bit_depth / 8 / DEFLATED_MOST > size) {
        spng_ctx_free(context);
        *why = cut_short;
        return false;
    }
    if (!result) {
        *image = (struct wd_model_image){header.width, header.height, wd_alloc(decoded)};
        result = spng_decode_image(context, image->rgba, decoded, SPNG_FMT_RGBA8,
                                   SPNG_DECODE_TRNS);
    }
    spng_ctx_free(context);
    *why = spng_strerror(result);
    return result == 0;
}

/* Harmless warnings, of bytes too many, are let pass, not that pixels are missing. */
static bool is_whole(tjhandle decoder)
{
    return tjGetErrorCode(decoder) == TJERR_WARNING && !strstr(tjGetErrorStr2(decoder), "remature end");
}

/* A copy with the marker of the end behind it, which files without it are let pass without. free() it. */
static uint8_t *with_end(const uint8_t *bytes, size_t size)
{
    static const uint8_t end[] = {0xff, 0xd9};
    uint8_t *copy = wd_alloc(size + sizeof end);
    memcpy(copy, bytes, size);
    memcpy(copy + size, end, sizeof end);
    return copy;
}

static bool decode_jpeg(struct wd_model_image *image, const uint8_t *bytes, size_t size,
                        const char **why)
{
    tjhandle decoder = tjInitDecompress();
    int width = 0, height = 0, subsampling, space;
    *why = "the JPEG is malformed";
    bool ok = decoder && size < (size_t)1 << 31 &&
              tjDecompressHeader3(decoder, bytes, (unsigned long)size, &width, &height,
                                  &subsampling, &space) == 0;
    if (ok && (width < 1 || height < 1 || width > MAX_SIDE_PX || height > MAX_SIDE_PX)) {
        *why = "it is larger than 16384 pixels a side";
        ok = false;
    }
    if (ok && (space == TJCS_CMYK || space == TJCS_YCCK)) {
        *why = "it is a CMYK JPEG; RGB and grey are read";
        ok = false;
    }
    if (ok && (size_t)width * (size_t)height / JPEG_MOST_PX > size) {
        *why = cut_short;
        ok = false;
    }
    if (ok) {
        *image = (struct wd_model_image){(uint32_t)width, (uint32_t)height,
                                         wd_alloc((size_t)width * (size_t)height * 4)};
        uint8_t *ended = with_end(bytes, size);
        ok = tjDecompress2(decoder, ended, (unsigned long)size + 2, image->rgba, width, 0, height,
                           TJPF_RGBA, TJFLAG_LIMITSCANS) == 0 || is_whole(decoder);
        free(ended);
        *why = ok ? *why : "the JPEG is malformed or cut short";
    }
    if (decoder)
        tjDestroy(decoder);
    return ok;
}

bool wd_model_image_decode(struct wd_model_image *image, const uint8_t *bytes, size_t size,
                           const char **why)
{
    static const uint8_t png[] = {0x89, 'P', 'N', 'G'}, jpeg[] = {0xff, 0xd8};
    *image = (struct wd_model_image){0};
    bool ok = false;
    *why = size > 12 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0
               ? "it is WebP; PNG and JPEG are read"
               : "it is neither PNG nor JPEG";
    if (size > sizeof png && memcmp(bytes, png, sizeof png) == 0)
        ok = decode_png(image, bytes, size, why);
    else if (size > sizeof jpeg && memcmp(bytes, jpeg, sizeof jpeg) == 0)
        ok = decode_jpeg(image, bytes, size, why);
    if (!ok)
        wd_model_image_finish(image);
    return ok;
}

static bool opaque(const struct wd_model_image *image)
{
    size_t pixels = (size_t)image->width * image->height;
    for (size_t i = 0; i < pixels; i++)
        if (image->rgba[4 * i + 3] != 255)
            return false;
    return true;
}

uint8_t *wd_model_image_encode(const struct wd_model_image *image, size_t *size)
{
    size_t pixels = (size_t)image->width * image->height;
    bool alpha = !opaque(image);
    size_t channels = alpha ? 4 : 3;
    uint8_t *packed = wd_alloc_array(pixels, channels);
    for (size_t i = 0; i < pixels; i++)
        memcpy(packed + i * channels, image->rgba + 4 * i, channels);
    struct spng_ihdr header = {
        .width = image->width,
        .height = image->height,
        .bit_depth = 8,
        .color_type = alpha ? SPNG_COLOR_TYPE_TRUECOLOR_ALPHA : SPNG_COLOR_TYPE_TRUECOLOR,
    };
    spng_ctx *context = spng_ctx_new(SPNG_CTX_ENCODER);
    int result = context ? spng_set_option(context, SPNG_ENCODE_TO_BUFFER, 1) : SPNG_EMEM;
    uint8_t *png = NULL;
    if (!result)
        result = spng_set_ihdr(context, &header);
    if (!result)
        result = spng_encode_image(context, packed, pixels * channels, SPNG_FMT_PNG,
                                   SPNG_ENCODE_FINALIZE);
    if (!result)
        png = spng_get_png_buffer(context, size, &result);
    spng_ctx_free(context);
    free(packed);
    return png;
}
