/* film.h: frames to a film file through ffmpeg, or to a sequence of PNG files. */
#ifndef WD_OUTPUT_FILM_H
#define WD_OUTPUT_FILM_H

#include "output/encoder.h"

struct wd_film_writer_params {
    const char *path;    /* .mp4, .m4v, .mov or .mkv; or frame-%05d.png, one file a frame from 0 */
    uint32_t width, height; /* both even for a film file */
    double frame_rate;   /* frames a second, WD_LEAST_FRAMES_PER_SECOND..WD_MOST_FRAMES_PER_SECOND; 0: 30 */
    int crf;             /* quality of x264, 1 best .. 51; 0: 16 */
    const char *ffmpeg;  /* program; NULL: "ffmpeg" on the PATH */
};

/* `{0}` is closed. A film is open from wd_film_writer_open until commit, discard, or a failed frame. */
struct wd_film_writer {
    struct wd_encoder encoder; /* film file */
    char *pattern;             /* sequence: the name with its %d; NULL: a film file */
    uint32_t width, height;
    uint64_t frames;
};

/* Numbered pictures: whether the name holds exactly one number like %d or %05d, and the name of
 * one of them; free() it. */
bool wd_film_sequence_check(const char *path, const struct wd_log *log);
char *wd_film_frame_name(const char *pattern, uint64_t frame);

/* Whether such a film or sequence can be at all: size, rate and quality; and its name, too. */
bool wd_film_shape_check(const struct wd_film_writer_params *params, const struct wd_log *log);
bool wd_film_writer_check(const struct wd_film_writer_params *params, const struct wd_log *log);

/* Fails for what wd_film_writer_check refuses, and where the file cannot be written. */
bool wd_film_writer_open(struct wd_film_writer *film, const struct wd_film_writer_params *params,
                  const struct wd_log *log);
/* `rgb`: width * height sRGB pixels, rows from the top. On failure the film is discarded. */
bool wd_film_writer_add(struct wd_film_writer *film, const uint8_t *rgb, const struct wd_log *log);
/* The film appears under its name with the frames it has (at least one). After an interruption
 * this keeps what is finished. */
bool wd_film_writer_commit(struct wd_film_writer *film, const struct wd_log *log);
/* Drops a film file; frames of a sequence stay, each is whole. Accepts `{0}`. */
void wd_film_writer_discard(struct wd_film_writer *film);

#endif
