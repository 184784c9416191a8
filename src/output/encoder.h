/* encoder.h: an ffmpeg process that takes raw frames from a pipe and writes a film. */
#ifndef WD_OUTPUT_ENCODER_H
#define WD_OUTPUT_ENCODER_H

#include <stdio.h>
#include <sys/types.h>

#include "base/file.h"

struct wd_encoder_params {
    const char *ffmpeg; /* program */
    const char *path;   /* of the film */
    const char *format; /* ffmpeg's name of the container */
    uint32_t width, height;
    double frame_rate;
    int crf;
};

/* `{0}` is closed. */
struct wd_encoder {
    pid_t process;
    int pipe;                   /* write end; valid while process > 0 */
    FILE *messages;             /* ffmpeg's standard error, an unnamed file */
    struct wd_output_file file; /* ffmpeg writes its temporary name */
};

/* The process ignores SIGINT and stands in a process group of its own, so that Ctrl-C in the
 * terminal is the caller's to answer. */
bool wd_encoder_open(struct wd_encoder *encoder, const struct wd_encoder_params *params,
                     const struct wd_log *log);
/* Never raises SIGPIPE. On failure the encoder is discarded. */
bool wd_encoder_write(struct wd_encoder *encoder, const void *data, size_t size,
                      const struct wd_log *log);
/* Waits for ffmpeg, checks its exit, gives the film its name. */
bool wd_encoder_commit(struct wd_encoder *encoder, const struct wd_log *log);
void wd_encoder_discard(struct wd_encoder *encoder);

#endif
