#include "output/film.h"

#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "output/image.h"

enum { MAX_SIDE_PX = 32768, MAX_FILM_SIDE_PX = 16384, MAX_DIGITS = 9 };

static const char *extension(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    return dot && (!slash || dot > slash) ? dot + 1 : "";
}

/* ffmpeg's name of the container, or NULL. */
static const char *container(const char *path)
{
    static const char *const names[][2] = {
        {"mp4", "mp4"}, {"m4v", "mp4"}, {"mov", "mov"}, {"mkv", "matroska"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(extension(path), names[i][0]) == 0)
            return names[i][1];
    }
    return NULL;
}

/* The one conversion a sequence's name may hold: %d, %5d, %05d. Returns its length, 0 for none. */
static size_t conversion(const char *percent, unsigned *digits)
{
    size_t zeros = percent[1] == '0';
    size_t wide = percent[1 + zeros] >= '1' && percent[1 + zeros] <= '0' + MAX_DIGITS;
    *digits = wide ? (unsigned)(percent[1 + zeros] - '0') : 1;
    return percent[1 + zeros + wide] == 'd' ? 2 + zeros + wide : 0;
}

bool wd_film_path(const char *path)
{
    return strchr(path, '%') || container(path);
}

bool wd_film_sequence_check(const char *path, const struct wd_log *log)
{
    const char *percent = strchr(path, '%'), *slash = strrchr(path, '/');
    unsigned digits;
    size_t length = percent ? conversion(percent, &digits) : 0;
    if (length == 0 || strchr(percent + 1, '%') || (slash && slash > percent))
        return wd_error(log,
                        "%s: not a name for a sequence of frames; give one number, like "
                        "frame-%%05d.png",
                        path);
    return true;
}

static bool open_sequence(struct wd_film_writer *film, const char *path, const struct wd_log *log)
{
    if (!wd_film_sequence_check(path, log))
        return false;
    if (strcmp(extension(path), "png") != 0)
        return wd_error(log, "%s: frames of a film are .png files", path);
    film->pattern = wd_strdup(path);
    return true;
}

static bool open_film(struct wd_film_writer *film, const struct wd_film_writer_params *params,
                      const struct wd_log *log)
{
    const char *format = container(params->path);
    if (!format)
        return wd_error(log,
                        "%s: films are .mp4, .mov or .mkv files, or frames like "
                        "frame-%%05d.png",
                        params->path);
    if (params->width % 2 || params->height % 2)
        return wd_error(log,
                        "%s: a film's width and height must be even; found %u x %u, %u x %u "
                        "would do",
                        params->path, params->width, params->height,
                        params->width + params->width % 2, params->height + params->height % 2);
    if (params->width > MAX_FILM_SIDE_PX || params->height > MAX_FILM_SIDE_PX)
        return wd_error(log, "%s: found %u x %u pixels; a film has at most %d a side", params->path,
                        params->width, params->height, MAX_FILM_SIDE_PX);
    struct wd_encoder_params encoder = {
        .ffmpeg = params->ffmpeg ? params->ffmpeg : "ffmpeg",
        .path = params->path,
        .format = format,
        .width = params->width,
        .height = params->height,
        .frame_rate = params->frame_rate != 0 ? params->frame_rate : 30,
        .crf = params->crf ? params->crf : 16,
    };
    return wd_encoder_open(&film->encoder, &encoder, log);
}

bool wd_film_writer_open(struct wd_film_writer *film, const struct wd_film_writer_params *params,
                         const struct wd_log *log)
{
    *film = (struct wd_film_writer){.width = params->width, .height = params->height};
    bool ok;
    if (params->width < 1 || params->height < 1 || params->width > MAX_SIDE_PX ||
        params->height > MAX_SIDE_PX)
        ok = wd_error(log, "%s: found %u x %u pixels; allowed are 1 to %d a side", params->path,
                      params->width, params->height, MAX_SIDE_PX);
    else if (!(params->frame_rate == 0 ||
               (params->frame_rate >= 0.1 && params->frame_rate <= 1000)))
        ok = wd_error(log, "%s: found %g frames a second; allowed are 0.1 to 1000", params->path,
                      params->frame_rate);
    else if (params->crf < 0 || params->crf > 51)
        ok = wd_error(log, "%s: found a crf of %d; allowed are 1 to 51", params->path, params->crf);
    else
        ok = strchr(params->path, '%') ? open_sequence(film, params->path, log)
                                       : open_film(film, params, log);
    if (!ok)
        *film = (struct wd_film_writer){0};
    return ok;
}

/* The pattern is the user's: its number is put in by hand, never by printf of foreign text. */
char *wd_film_frame_name(const char *pattern, uint64_t frame)
{
    const char *percent = strchr(pattern, '%');
    unsigned digits;
    size_t length = conversion(percent, &digits);
    char number[32];
    snprintf(number, sizeof number, percent[1] == '0' ? "%0*llu" : "%*llu", (int)digits,
             (unsigned long long)frame);
    return wd_format("%.*s%s%s", (int)(percent - pattern), pattern, number, percent + length);
}

bool wd_film_writer_add(struct wd_film_writer *film, const uint8_t *rgb, const struct wd_log *log)
{
    bool ok;
    if (film->pattern) {
        char *name = wd_film_frame_name(film->pattern, film->frames);
        ok = wd_png_write(name, rgb, film->width, film->height, log);
        free(name);
    } else {
        ok = wd_encoder_write(&film->encoder, rgb, (size_t)film->width * film->height * 3, log);
    }
    if (ok)
        film->frames++;
    else
        wd_film_writer_discard(film);
    return ok;
}

bool wd_film_writer_commit(struct wd_film_writer *film, const struct wd_log *log)
{
    bool ok = true;
    if (!film->pattern && film->frames == 0)
        ok =
            wd_error(log, "%s: the film has no frames and is not written", film->encoder.file.path);
    else if (!film->pattern)
        ok = wd_encoder_commit(&film->encoder, log);
    wd_film_writer_discard(film);
    return ok;
}

void wd_film_writer_discard(struct wd_film_writer *film)
{
    wd_encoder_discard(&film->encoder);
    free(film->pattern);
    *film = (struct wd_film_writer){0};
}
