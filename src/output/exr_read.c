#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/exr.h"

static const uint64_t max_bytes = (uint64_t)4 << 30;
enum { MAX_SIDE_PX = 32768, MAX_CHANNELS = 1024 };

struct reader {
    const char *path;
    const struct wd_log *log;
    struct wd_exr_image *image;
    exr_context_t context;
    exr_decode_pipeline_t decoder;
    bool decoding;
    exr_attr_box2i_t window;
    char message[256];
};

static void keep_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user)
        return;
    struct reader *reader = user;
    if (!reader->message[0])
        snprintf(reader->message, sizeof reader->message, "%s", message);
}

static bool refuse(struct reader *reader, exr_result_t result)
{
    return wd_error(reader->log, "%s: is not an EXR that can be read: %s", reader->path,
                    reader->message[0] ? reader->message : exr_get_default_error_message(result));
}

static bool check_kind(struct reader *reader)
{
    exr_storage_t storage;
    exr_compression_t compression;
    exr_result_t result = exr_get_storage(reader->context, 0, &storage);
    if (!result)
        result = exr_get_compression(reader->context, 0, &compression);
    if (!result)
        result = exr_get_data_window(reader->context, 0, &reader->window);
    if (result)
        return refuse(reader, result);
    if (storage != EXR_STORAGE_SCANLINE)
        return wd_error(reader->log, "%s: is tiled or deep; save it as plain scan lines",
                        reader->path);
    if (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB)
        return wd_error(reader->log, "%s: is compressed with %s, which cannot be read here; save "
                        "it with ZIP or without compression", reader->path,
                        compression == EXR_COMPRESSION_DWAA ? "DWAA" : "DWAB");
    return true;
}

static bool make_planes(struct reader *reader)
{
    const exr_attr_chlist_t *channels;
    exr_result_t result = exr_get_channels(reader->context, 0, &channels);
    if (result)
        return refuse(reader, result);
    int64_t width = (int64_t)reader->window.max.x - reader->window.min.x + 1;
    int64_t height = (int64_t)reader->window.max.y - reader->window.min.y + 1;
    if (width < 1 || height < 1 || width > MAX_SIDE_PX || height > MAX_SIDE_PX ||
        channels->num_channels < 1 || channels->num_channels > MAX_CHANNELS ||
        (uint64_t)(width * height * channels->num_channels) * 4 > max_bytes)
        return wd_error(reader->log, "%s: %lld x %lld pixels of %d channels are more than can be "
                        "read", reader->path, (long long)width, (long long)height,
                        channels->num_channels);
    struct wd_exr_image *image = reader->image;
    *image = (struct wd_exr_image){(uint32_t)width, (uint32_t)height,
                                   wd_alloc_array((size_t)channels->num_channels,
                                                  sizeof *image->planes),
                                   (size_t)channels->num_channels};
    for (size_t i = 0; i < image->plane_count; i++) {
        const exr_attr_chlist_entry_t *from = &channels->entries[i];
        struct wd_exr_plane *plane = &image->planes[i];
        if (from->x_sampling != 1 || from->y_sampling != 1)
            return wd_error(reader->log, "%s: channel %s is subsampled", reader->path,
                            from->name.str);
        snprintf(plane->name, sizeof plane->name, "%s", from->name.str);
        plane->type = from->pixel_type == EXR_PIXEL_HALF    ? WD_EXR_HALF
                      : from->pixel_type == EXR_PIXEL_FLOAT ? WD_EXR_FLOAT
                                                            : WD_EXR_UINT;
        plane->data = wd_try_array((size_t)(width * height), 4);
        image->no_memory |= !plane->data;
    }
    if (image->no_memory)
        return wd_error(reader->log, "%s: out of memory: %lld x %lld pixels of %d channels want %.1f "
                        "MiB, which cannot be had", reader->path, (long long)width,
                        (long long)height, channels->num_channels,
                        (double)(width * height * channels->num_channels) * 4 / (1 << 20));
    return true;
}

static void aim(struct reader *reader, int32_t row)
{
    const struct wd_exr_image *image = reader->image;
    for (int i = 0; i < reader->decoder.channel_count; i++) {
        exr_coding_channel_info_t *channel = &reader->decoder.channels[i];
        const struct wd_exr_plane *plane = wd_exr_find(image, channel->channel_name);
        channel->user_data_type = plane->type == WD_EXR_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = 4;
        channel->user_pixel_stride = 4;
        channel->user_line_stride = (int32_t)(4 * image->width);
        channel->decode_to_ptr = (uint8_t *)plane->data + (size_t)row * 4 * image->width;
    }
}

static exr_result_t read_rows(struct reader *reader)
{
    int32_t rows = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(reader->context, 0, &rows);
    for (int32_t row = 0; row < (int32_t)reader->image->height && !result; row += rows) {
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(reader->context, 0, reader->window.min.y + row,
                                              &chunk);
        if (result)
            return result;
        result = reader->decoding
                     ? exr_decoding_update(reader->context, 0, &chunk, &reader->decoder)
                     : exr_decoding_initialize(reader->context, 0, &chunk, &reader->decoder);
        if (result)
            return result;
        aim(reader, row);
        if (!reader->decoding)
            result = exr_decoding_choose_default_routines(reader->context, 0, &reader->decoder);
        reader->decoding = true;
        if (!result)
            result = exr_decoding_run(reader->context, 0, &reader->decoder);
    }
    return result;
}

static bool read_image(struct reader *reader)
{
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_message;
    start.user_data = reader;
    start.max_image_width = MAX_SIDE_PX;
    start.max_image_height = MAX_SIDE_PX;
    exr_result_t result = exr_start_read(&reader->context, reader->path, &start);
    if (result)
        return refuse(reader, result);
    if (!check_kind(reader) || !make_planes(reader))
        return false;
    result = read_rows(reader);
    return result ? refuse(reader, result) : true;
}

bool wd_exr_read(struct wd_exr_image *image, const char *path, const struct wd_log *log)
{
    *image = (struct wd_exr_image){0};
    struct reader reader = {.path = path, .log = log, .image = image,
                            .decoder = EXR_DECODE_PIPELINE_INITIALIZER};
    bool ok = read_image(&reader);
    if (reader.decoding)
        exr_decoding_destroy(reader.context, &reader.decoder);
    if (reader.context)
        exr_finish(&reader.context);
    if (!ok) {
        bool no_memory = image->no_memory;
        wd_exr_image_finish(image);
        image->no_memory = no_memory;
    }
    return ok;
}

void wd_exr_image_finish(struct wd_exr_image *image)
{
    for (size_t i = 0; i < image->plane_count; i++)
        free(image->planes[i].data);
    free(image->planes);
    *image = (struct wd_exr_image){0};
}

const struct wd_exr_plane *wd_exr_find(const struct wd_exr_image *image, const char *name)
{
    for (size_t i = 0; i < image->plane_count; i++) {
        if (strcmp(image->planes[i].name, name) == 0)
            return &image->planes[i];
    }
    return NULL;
}
