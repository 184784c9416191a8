#include "api/output.h"

#include <stdlib.h>
#include <string.h>

#include "api/arguments.h"
#include "api/shown.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/cryptomatte.h"
#include "output/exr.h"
#include "output/image.h"

uint8_t *wd_picture_rgb(const struct wd_picture *picture, const struct wd_log *log)
{
    size_t pixels = (size_t)picture->width * picture->height;
    uint8_t *rgb = wd_picture_try_scratch(picture->width, picture->height, 3, log);
    for (size_t i = 0; rgb && i < pixels; i++)
        memcpy(rgb + 3 * i, picture->display + 4 * i, 3);
    return rgb;
}

static enum wd_result write_png(const struct wd_picture *picture, const char *path,
                                const struct wd_log *log)
{
    if (!picture->display) {
        wd_error(log, "%s: a PNG file shows the display layer, which the picture lacks", path);
        return WD_ERROR_INPUT;
    }
    uint8_t *rgb = wd_picture_rgb(picture, log);
    if (!rgb)
        return WD_ERROR_MEMORY;
    bool ok = wd_png_write(path, rgb, picture->width, picture->height, log);
    free(rgb);
    return ok ? WD_OK : WD_ERROR_OUTPUT;
}

enum { MAX_CHANNELS = 32 };

static void add_channels(struct wd_exr_channel *channels, size_t *count, const char *const *names,
                         const float *data, uint32_t stride)
{
    for (uint32_t k = 0; data && k < stride; k++)
        channels[(*count)++] = (struct wd_exr_channel){names[k], WD_EXR_FLOAT, data + k, stride};
}

/* Ids as floats and their coverage, two ranks of a pixel in each RGBA layer, and what readers need to
 * know of them, beside what the picture tells of itself. All of it lives until finish_ranks. */
struct ranks {
    struct wd_cryptomatte matte;
    float *values; /* 2 * WD_RANKS a pixel */
    char *manifest;
    struct wd_exr_text texts[5];
};

/* The keys hold the first seven digits of the hash of "weald_tree". */
#define MATTE_KEY "cryptomatte/9f4781b/"

static bool add_ranks(struct ranks *ranks, const struct wd_picture *picture,
                      struct wd_exr_channel *channels, struct wd_exr_params *params,
                      const struct wd_log *log)
{
    static const char *const names[2 * WD_RANKS] = {
        "weald_tree00.R", "weald_tree00.G", "weald_tree00.B", "weald_tree00.A",
        "weald_tree01.R", "weald_tree01.G", "weald_tree01.B", "weald_tree01.A",
        "weald_tree02.R", "weald_tree02.G", "weald_tree02.B", "weald_tree02.A"};
    size_t count = (size_t)picture->width * picture->height * WD_RANKS;
    if (!picture->rank_tree)
        return true;
    ranks->values = wd_picture_try_scratch(picture->width, picture->height,
                                           2 * WD_RANKS * sizeof *ranks->values, log);
    if (!ranks->values)
        return false;
    wd_cryptomatte_init(&ranks->matte, picture->rank_tree, count);
    for (size_t i = 0; i < count; i++) {
        ranks->values[2 * i] = wd_cryptomatte_find(&ranks->matte, picture->rank_tree[i]);
        ranks->values[2 * i + 1] = picture->rank_share[i];
    }
    ranks->manifest = wd_cryptomatte_manifest(&ranks->matte);
    const struct wd_exr_text texts[] = {{MATTE_KEY "name", "weald_tree"},
                                         {MATTE_KEY "hash", "MurmurHash3_32"},
                                         {MATTE_KEY "conversion", "uint32_to_float32"},
                                         {MATTE_KEY "manifest", ranks->manifest}};
    memcpy(ranks->texts + params->text_count, texts, sizeof texts);
    params->text_count += sizeof texts / sizeof *texts;
    add_channels(channels, &params->channel_count, names, ranks->values, 2 * WD_RANKS);
    return true;
}

static void finish_ranks(struct ranks *ranks)
{
    wd_cryptomatte_finish(&ranks->matte);
    free(ranks->values);
    free(ranks->manifest);
}

static enum wd_result write_exr(const struct wd_picture *picture, const char *path,
                                const struct wd_log *log)
{
    static const char *const color[] = {"R", "G", "B"}, *const depth[] = {"Z"};
    static const char *const normal[] = {"N.X", "N.Y", "N.Z"};
    static const char *const albedo[] = {"albedo.R", "albedo.G", "albedo.B"};
    static const char *const velocity[] = {"velocity.X", "velocity.Y"};
    struct wd_exr_channel channels[MAX_CHANNELS];
    struct ranks ranks = {0};
    struct wd_exr_params params = {picture->width, picture->height, channels, 0, ranks.texts, 0, NULL};
    float camera[4][4];
    if (picture->about)
        ranks.texts[params.text_count++] = (struct wd_exr_text){"weald", picture->about};
    if (picture->camera.fov_rad > 0) {
        wd_picture_camera_matrix(camera, &picture->camera);
        params.world_to_camera = &camera[0][0];
    }
    add_channels(channels, &params.channel_count, color, picture->color, 3);
    add_channels(channels, &params.channel_count, depth, picture->depth_m, 1);
    add_channels(channels, &params.channel_count, normal, picture->normal, 3);
    add_channels(channels, &params.channel_count, albedo, picture->albedo, 3);
    add_channels(channels, &params.channel_count, velocity, picture->velocity_px, 2);
    if (picture->species)
        channels[params.channel_count++] =
            (struct wd_exr_channel){"species", WD_EXR_UINT, picture->species, 1};
    if (picture->tree_id)
        channels[params.channel_count++] =
            (struct wd_exr_channel){"tree_id", WD_EXR_UINT, picture->tree_id, 1};
    if (params.channel_count == 0 && !picture->rank_tree) {
        wd_error(log, "%s: the picture has no layer that an EXR file could hold", path);
        return WD_ERROR_INPUT;
    }
    enum wd_result result = WD_ERROR_MEMORY;
    if (add_ranks(&ranks, picture, channels, &params, log))
        result = wd_exr_write(path, &params, log) ? WD_OK : WD_ERROR_OUTPUT;
    finish_ranks(&ranks);
    return result;
}

enum wd_result wd_picture_write(const struct wd_picture *picture, const char *path,
                                const struct wd_log *log)
{
    if (!wd_given(picture, log) || !wd_given(path, log))
        return WD_ERROR_INPUT;
    if (wd_has_ending(path, ".png"))
        return write_png(picture, path, log);
    if (wd_has_ending(path, ".exr"))
        return write_exr(picture, path, log);
    wd_error(log, "%s: pictures end in .png or .exr", path);
    return WD_ERROR_INPUT;
}
