#include "output/film.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/image.h"
#include "weald/renderer.h"

enum { MAX_SIDE_PX = 32768, MAX_FILM_SIDE_PX = 16384, MAX_DIGITS = 9 };

/* ffmpeg's name of the container, or NULL. */
static const char *container(const char *path)
{
    static const char *const names[][2] = {
        {".mp4", "mp4"}, {".m4v", "mp4"}, {".mov", "mov"}, {".mkv", "matroska"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (wd_has_ending(path, names[i][0]))
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

/* Where the number stands in the last part of a path: '%', digits and a letter; NULL without one. Any other '%' stands
 * for itself. */
static const char *number_in(const char *path)
{
    const char *slash = strrchr(path, '/'), *at = slash ? slash + 1 : path;
    while ((at = strchr(at, '%'))) {
        size_t digits = strspn(at + 1, "0123456789");
        if (isalpha((unsigned char)at[1 + digits]))
            return at;
        at++;
    }
    return NULL;
}

bool wd_film_has_ending(const char *path)
{
    return path && container(path);
}

bool wd_film_is_numbered(const char *path)
{
    return path && number_in(path);
}

bool wd_film_sequence_check(const char *path, const struct wd_log *log)
{
    const char *percent = number_in(path);
    unsigned digits;
    size_t length = percent ? conversion(percent, &digits) : 0;
    if (length == 0 || number_in(percent + 1))
        return wd_error(log,
                        "%s: not a name for a sequence of frames; give one number, like "
                        "frame-%%05d.png",
                        path);
    return true;
}

bool wd_film_shape_check(const struct wd_film_writer_params *params, const struct wd_log *log)
{
    double rate = params->frame_rate;
    if (params->width < 1 || params->height < 1 || params->width > MAX_SIDE_PX ||
        params->height > MAX_SIDE_PX)
        return wd_error(log, "%s: found %u x %u pixels; allowed are 1 to %d a side", params->path,
                        params->width, params->height, MAX_SIDE_PX);
    if (rate != 0 && !(rate >= WD_LEAST_FRAMES_PER_SECOND && rate <= WD_MOST_FRAMES_PER_SECOND))
        return wd_error(log, "%s: found %g frames a second; allowed are %g to %g", params->path, rate,
                        WD_LEAST_FRAMES_PER_SECOND, WD_MOST_FRAMES_PER_SECOND);
    if (params->crf < 0 || params->crf > 51)
        return wd_error(log, "%s: found a crf of %d; allowed are 1 to 51", params->path,
                        params->crf);
    return true;
}

static bool check_sequence(const char *path, const struct wd_log *log)
{
    if (!wd_film_sequence_check(path, log))
        return false;
    if (!wd_has_ending(path, ".png"))
        return wd_error(log, "%s: numbered frames are .png or .exr files", path);
    return true;
}

static bool check_film(const struct wd_film_writer_params *params, const struct wd_log *log)
{
    if (!container(params->path))
        return wd_error(log,
                        "%s: films are .mp4, .m4v, .mov or .mkv files, or frames like "
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
    return true;
}

bool wd_film_writer_check(const struct wd_film_writer_params *params, const struct wd_log *log)
{
    return wd_film_shape_check(params, log) &&
           (number_in(params->path) ? check_sequence(params->path, log) : check_film(params, log));
}

static bool open_encoder(struct wd_film_writer *film, const struct wd_film_writer_params *params,
                         const struct wd_log *log)
{
    struct wd_encoder_params encoder = {
        .ffmpeg = params->ffmpeg ? params->ffmpeg : "ffmpeg",
        .path = params->path,
        .format = container(params->path),
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
    *film = (struct wd_film_writer){0};
    if (!wd_film_writer_check(params, log))
        return false;
    if (number_in(params->path))
        film->pattern = wd_strdup(params->path);
    else if (!open_encoder(film, params, log))
        return false;
    film->width = params->width;
    film->height = params->height;
    return true;
}

/* The pattern is the user's: its number is put in by hand, never by printf of foreign text. */
char *wd_film_frame_name(const char *pattern, uint64_t frame)
{
    const char *percent = number_in(pattern);
    unsigned digits;
    size_t length = conversion(percent, &digits);
    char number[32];
    snprintf(number, sizeof number, percent[1] == '0' ? "%0*llu" : "%*llu", (int)digits,
             (unsigned long long)frame);
    return wd_format("%.*s%s%s", (int)(percent - pattern), pattern, number, percent + length);
}

bool wd_film_frame_number(const char *pattern, const char *name, uint64_t *frame)
{
    const char *percent = number_in(pattern), *slash = strrchr(pattern, '/');
    const char *begin = slash ? slash + 1 : pattern;
    size_t before = (size_t)(percent - begin);
    char *end;
    if (strncmp(name, begin, before) != 0)
        return false;
    *frame = strtoull(name + before, &end, 10);
    char *same = wd_film_frame_name(begin, *frame); /* digits of no other writing */
    bool is_frame = end > name + before && strcmp(name, same) == 0;
    free(same);
    return is_frame;
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
