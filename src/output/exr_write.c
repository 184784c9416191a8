#include <errno.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/exr.h"

enum { MAX_SIDE_PX = 32768, COMPRESSION_LEVEL = 4 };

struct writer {
    struct wd_output_file file;
    const struct wd_exr_params *params;
    exr_context_t context;
    exr_encode_pipeline_t encoder;
    bool encoding;     /* the encoder has been set up */
    char message[256]; /* the first that went wrong */
};

static void keep_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user)
        return;
    struct writer *writer = user;
    if (!writer->message[0])
        snprintf(writer->message, sizeof writer->message, "%s", message);
}

static int64_t write_block(exr_const_context_t context, void *user, const void *data,
                           uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t error_cb)
{
    struct writer *writer = user;
    const char *bytes = data;
    (void)context, (void)error_cb;
    for (uint64_t done = 0; done < size;) {
        ssize_t wrote = pwrite(fileno(writer->file.stream), bytes + done, size - done,
                               (off_t)(offset + done));
        if (wrote < 0 && errno == EINTR)
            continue;
        if (wrote <= 0) {
            if (!writer->message[0])
                snprintf(writer->message, sizeof writer->message, "%s", strerror(errno));
            return -1;
        }
        done += (uint64_t)wrote;
    }
    return (int64_t)size;
}

static exr_pixel_type_t pixel_type(enum wd_exr_type type)
{
    return type == WD_EXR_HALF ? EXR_PIXEL_HALF : type == WD_EXR_FLOAT ? EXR_PIXEL_FLOAT
                                                                       : EXR_PIXEL_UINT;
}

/* Colours are linear, with the primaries and the white of sRGB (Rec. 709, D65). */
static exr_result_t note_colours(exr_context_t context, int part)
{
    static const exr_attr_chromaticities_t srgb = {0.64f, 0.33f, 0.30f, 0.60f,
                                                   0.15f, 0.06f, 0.3127f, 0.3290f};
    exr_result_t result = exr_attr_set_chromaticities(context, part, "chromaticities", &srgb);
    return result ? result
                  : exr_attr_set_string(context, part, "colorSpace", "linear sRGB (Rec. 709, D65)");
}

static exr_result_t write_header(struct writer *writer)
{
    const struct wd_exr_params *params = writer->params;
    exr_context_t context = writer->context;
    int part = 0;
    exr_result_t result = exr_add_part(context, "weald", EXR_STORAGE_SCANLINE, &part);
    if (!result)
        result = exr_initialize_required_attr_simple(context, part, (int32_t)params->width,
                                                     (int32_t)params->height,
                                                     EXR_COMPRESSION_ZIP);
    if (!result)
        result = exr_set_zip_compression_level(context, part, COMPRESSION_LEVEL);
    for (size_t i = 0; i < params->channel_count && !result; i++)
        result = exr_add_channel(context, part, params->channels[i].name,
                                 pixel_type(params->channels[i].type), EXR_PERCEPTUALLY_LOGARITHMIC,
                                 1, 1);
    if (!result)
        result = note_colours(context, part);
    for (size_t i = 0; i < params->text_count && !result; i++)
        result = exr_attr_set_string(context, part, params->texts[i].name, params->texts[i].value);
    if (params->world_to_camera && !result) {
        exr_attr_m44f_t matrix;
        memcpy(matrix.m, params->world_to_camera, sizeof matrix.m);
        result = exr_attr_set_m44f(context, part, "worldToCamera", &matrix);
    }
    return result ? result : exr_write_header(context);
}

static const struct wd_exr_channel *find_channel(const struct wd_exr_params *params,
                                                 const char *name)
{
    for (size_t i = 0; i < params->channel_count; i++) {
        if (strcmp(params->channels[i].name, name) == 0)
            return &params->channels[i];
    }
    return NULL;
}

static void aim(struct writer *writer, int32_t row)
{
    for (int i = 0; i < writer->encoder.channel_count; i++) {
        exr_coding_channel_info_t *to = &writer->encoder.channels[i];
        const struct wd_exr_channel *from = find_channel(writer->params, to->channel_name);
        size_t stride = 4 * (size_t)(from->stride ? from->stride : 1);
        to->user_data_type = from->type == WD_EXR_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        to->user_bytes_per_element = 4;
        to->user_pixel_stride = (int32_t)stride;
        to->user_line_stride = (int32_t)(stride * writer->params->width);
        to->encode_from_ptr =
            (const uint8_t *)from->data + (size_t)row * stride * writer->params->width;
    }
}

static exr_result_t write_rows(struct writer *writer)
{
    int32_t rows = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(writer->context, 0, &rows);
    for (int32_t y = 0; y < (int32_t)writer->params->height && !result; y += rows) {
        exr_chunk_info_t chunk;
        result = exr_write_scanline_chunk_info(writer->context, 0, y, &chunk);
        if (result)
            return result;
        result = writer->encoding
                     ? exr_encoding_update(writer->context, 0, &chunk, &writer->encoder)
                     : exr_encoding_initialize(writer->context, 0, &chunk, &writer->encoder);
        if (result)
            return result;
        aim(writer, y);
        if (!writer->encoding)
            result = exr_encoding_choose_default_routines(writer->context, 0, &writer->encoder);
        writer->encoding = true;
        if (!result)
            result = exr_encoding_run(writer->context, 0, &writer->encoder);
    }
    return result;
}

static exr_result_t write_all(struct writer *writer)
{
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_message;
    start.user_data = writer;
    start.write_fn = write_block;
    exr_result_t result =
        exr_start_write(&writer->context, writer->file.path, EXR_WRITE_FILE_DIRECTLY, &start);
    if (!result)
        result = write_header(writer);
    if (!result)
        result = write_rows(writer);
    if (writer->encoding)
        exr_encoding_destroy(writer->context, &writer->encoder);
    if (writer->context) {
        exr_result_t finished = exr_finish(&writer->context);
        result = result ? result : finished;
    }
    return result;
}

static bool check(const char *path, const struct wd_exr_params *params, const struct wd_log *log)
{
    if (params->width < 1 || params->height < 1 || params->width > MAX_SIDE_PX ||
        params->height > MAX_SIDE_PX)
        return wd_error(log, "%s: a picture of %u x %u pixels; allowed are 1 to %d a side", path,
                        params->width, params->height, MAX_SIDE_PX);
    if (params->channel_count == 0)
        return wd_error(log, "%s: has no channels", path);
    for (size_t i = 0; i < params->channel_count; i++) {
        const struct wd_exr_channel *channel = &params->channels[i];
        if (channel->stride > 1024 || find_channel(params, channel->name) != channel)
            return wd_error(log, "%s: channel %s is given twice or has a stride above 1024", path,
                            channel->name);
    }
    return true;
}

bool wd_exr_write(const char *path, const struct wd_exr_params *params, const struct wd_log *log)
{
    struct writer writer = {.params = params, .encoder = EXR_ENCODE_PIPELINE_INITIALIZER};
    if (!check(path, params, log) || !wd_output_open(&writer.file, path, log))
        return false;
    exr_result_t result = write_all(&writer);
    if (!result && !writer.message[0])
        return wd_output_commit(&writer.file, log);
    wd_error(log, "%s: cannot be written: %s", path,
             writer.message[0] ? writer.message : exr_get_default_error_message(result));
    wd_output_discard(&writer.file);
    return false;
}
