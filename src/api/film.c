#include "output/film.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "api/arguments.h"
#include "api/output.h"
#include "base/file.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/film_store.h"

struct wd_film {
    struct wd_film_writer writer; /* of all but .exr */
    char *path;
    char *pattern;                /* of numbered pictures: their name with %d; NULL: a film file */
    bool layers;                  /* they are .exr */
    bool failed;                  /* a frame could not be written: the film has a gap there */
    uint32_t width, height;
    size_t frame_bytes;
    uint64_t first_frame, frames, frame_count;
    struct wd_film_store store;   /* once wd_film_keep was called */
    struct wd_log log;
};

static bool check_params(const struct wd_film_writer_params *params, const struct wd_log *log)
{
    if (wd_has_ending(params->path, ".exr"))
        return wd_film_shape_check(params, log) && wd_film_sequence_check(params->path, log);
    return wd_film_writer_check(params, log);
}

enum wd_result wd_film_open(struct wd_film **result, const struct wd_film_params *params,
                            const struct wd_log *log)
{
    *result = NULL;
    if (!wd_given(params, log) || !wd_given(params->path, log))
        return WD_ERROR_INPUT;
    if (!wd_film_has_ending(params->path) && !wd_film_is_numbered(params->path)) {
        wd_error(log,
                 "%s: films end in .mp4, .m4v, .mov or .mkv, numbered pictures have %%d or %%05d in "
                 "their name",
                 params->path);
        return WD_ERROR_INPUT;
    }
    const struct wd_film_writer_params writer = {.path = params->path,
                                                 .width = params->width,
                                                 .height = params->height,
                                                 .frame_rate = params->frames_per_second};
    if (!check_params(&writer, log))
        return WD_ERROR_INPUT;
    struct wd_film *film = wd_alloc(sizeof *film);
    film->log = log ? *log : (struct wd_log){0};
    film->layers = wd_has_ending(params->path, ".exr");
    if (!film->layers && !wd_film_writer_open(&film->writer, &writer, &film->log)) {
        free(film);
        return WD_ERROR_OUTPUT;
    }
    film->path = wd_strdup(params->path);
    if (film->layers || film->writer.pattern)
        film->pattern = film->path;
    film->width = params->width;
    film->height = params->height;
    film->first_frame = film->writer.frames = film->pattern ? params->first_frame : 0;
    film->frame_bytes = (size_t)params->width * params->height * 3;
    *result = film;
    return WD_OK;
}

/* Takes note of a frame that could not be written: nothing may follow a gap. */
static enum wd_result noted(struct wd_film *film, enum wd_result result)
{
    film->failed |= result == WD_ERROR_OUTPUT;
    return result;
}

static bool check_whole(const struct wd_film *film)
{
    return !film->failed ||
           wd_error(&film->log, "%s: frame %llu could not be written: the film cannot go on",
                    film->path, (unsigned long long)film->frames);
}

/* --- frames kept for another time ------------------------------------------------------------ */

/* What tells that a numbered picture is still the one that was written. */
struct file_mark {
    uint64_t size, hash;
};
static const size_t MAX_PICTURE_BYTES = (size_t)1 << 36;

/* Of the picture that comes next. */
static char *next_name(const struct wd_film *film)
{
    return wd_film_frame_name(film->pattern, film->first_frame + film->frames);
}

static bool mark_of_next(struct file_mark *mark, const struct wd_film *film)
{
    char *path = next_name(film), *data;
    size_t size;
    bool ok = wd_file_exists(path) && wd_file_read(path, MAX_PICTURE_BYTES, &wd_log_quiet, &data, &size);
    if (ok) {
        *mark = (struct file_mark){size, XXH64(data, size, 0)};
        free(data);
    }
    free(path);
    return ok;
}

enum wd_result wd_film_keep(struct wd_film *film, uint64_t key, uint64_t frame_count)
{
    if (!wd_given(film, NULL))
        return WD_ERROR_INPUT;
    if (film->store.stream || film->frames > 0 || film->failed) {
        wd_error(&film->log, "%s: wd_film_keep is to be called once, before the first frame", film->path);
        return WD_ERROR_INPUT;
    }
    char *path = film->first_frame ? wd_format("%s.%llu.partial", film->path, (unsigned long long)film->first_frame)
                                   : wd_format("%s.partial", film->path);
    bool ok = wd_film_store_open(&film->store, path, key, &film->log);
    film->frame_count = frame_count;
    free(path);
    if (ok && !film->pattern) /* as long as the store is open nobody else writes the film */
        wd_output_sweep(film->path);
    return ok ? WD_OK : WD_ERROR_OUTPUT;
}

static enum wd_result add_kept_pixels(struct wd_film *film)
{
    uint8_t *rgb = wd_alloc(film->frame_bytes);
    bool found = wd_film_store_read(&film->store, rgb, film->frame_bytes);
    bool ok = !found || wd_film_writer_add(&film->writer, rgb, &film->log);
    free(rgb);
    film->frames += found && ok;
    return ok ? WD_OK : WD_ERROR_OUTPUT;
}

static void count_kept_picture(struct wd_film *film)
{
    struct file_mark kept, there;
    if (!wd_film_store_read(&film->store, &kept, sizeof kept)) {
        char *next = next_name(film);
        wd_output_sweep(next); /* where a kill came */
        free(next);
    } else if (mark_of_next(&there, film) && there.size == kept.size && there.hash == kept.hash)
        film->writer.frames = film->first_frame + ++film->frames;
    else
        wd_film_store_unread(&film->store);
}

enum wd_result wd_film_add_kept(struct wd_film *film, uint64_t *frames)
{
    if (!wd_given(film, NULL) || !wd_given(frames, &film->log))
        return WD_ERROR_INPUT;
    enum wd_result result = check_whole(film) ? WD_OK : WD_ERROR_OUTPUT;
    if (result == WD_OK && film->store.stream && film->frames < film->frame_count) {
        if (film->pattern)
            count_kept_picture(film);
        else
            result = noted(film, add_kept_pixels(film));
    }
    *frames = film->frames;
    return result;
}

/* --- frames ------------------------------------------------------------------------------ */

static enum wd_result add_picture(struct wd_film *film, const struct wd_picture *picture)
{
    if (picture->width != film->width || picture->height != film->height) {
        wd_error(&film->log, "%s: found a picture of %u x %u pixels; the film's have %u x %u",
                 film->path, picture->width, picture->height, film->width, film->height);
        return WD_ERROR_INPUT;
    }
    if (film->layers) {
        char *path = next_name(film);
        enum wd_result result = wd_picture_write(picture, path, &film->log);
        free(path);
        return result;
    }
    if (!picture->display) {
        wd_error(&film->log, "%s: a film shows the display layer, which the picture lacks",
                 film->path);
        return WD_ERROR_INPUT;
    }
    uint8_t *rgb = wd_picture_rgb(picture, &film->log);
    if (!rgb)
        return WD_ERROR_MEMORY;
    bool ok = (film->pattern || !film->store.stream ||
               wd_film_store_add(&film->store, rgb, film->frame_bytes, &film->log)) &&
              wd_film_writer_add(&film->writer, rgb, &film->log);
    free(rgb);
    return ok ? WD_OK : WD_ERROR_OUTPUT;
}

enum wd_result wd_film_add(struct wd_film *film, const struct wd_picture *picture)
{
    struct file_mark mark;
    if (!wd_given(film, NULL) || !wd_given(picture, &film->log))
        return WD_ERROR_INPUT;
    if (!check_whole(film))
        return WD_ERROR_OUTPUT;
    enum wd_result result = add_picture(film, picture);
    if (result == WD_OK && film->pattern && film->store.stream &&
        !(mark_of_next(&mark, film) &&
          wd_film_store_add(&film->store, &mark, sizeof mark, &film->log)))
        result = WD_ERROR_OUTPUT;
    film->frames += result == WD_OK;
    return noted(film, result);
}

static bool commit(struct wd_film *film)
{
    return check_whole(film) && (film->layers || film->frames == 0 ||
                                 wd_film_writer_commit(&film->writer, &film->log));
}

enum wd_result wd_film_commit(struct wd_film **film)
{
    if (!wd_given(film, NULL) || !wd_given(*film, NULL))
        return WD_ERROR_INPUT;
    struct wd_film *f = *film;
    bool ok = commit(f);
    if (ok && f->frames == f->frame_count)
        wd_film_store_remove(&f->store);
    wd_film_discard(film);
    return ok ? WD_OK : WD_ERROR_OUTPUT;
}

void wd_film_discard(struct wd_film **film)
{
    if (!film || !*film)
        return;
    wd_film_writer_discard(&(*film)->writer);
    wd_film_store_close(&(*film)->store);
    free((*film)->path);
    free(*film);
    *film = NULL;
}
