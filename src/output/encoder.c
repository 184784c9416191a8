#include "output/encoder.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/close_range.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/log.h"
#include "base/point_locale.h"

enum { MAX_ARGUMENTS = 48 };

struct arguments {
    char *items[MAX_ARGUMENTS + 1];
    char size[32], rate[32], crf[16];
};

/* sRGB is taken for BT.709, as players do; the bit-exact flags leave out dates and versions. */
static void build_arguments(struct arguments *arguments, const struct wd_encoder_params *params,
                            const char *output)
{
    snprintf(arguments->size, sizeof arguments->size, "%ux%u", params->width, params->height);
    struct wd_point_locale point;
    wd_point_locale_enter(&point);
    snprintf(arguments->rate, sizeof arguments->rate, "%.6f", params->frame_rate);
    wd_point_locale_leave(&point);
    snprintf(arguments->crf, sizeof arguments->crf, "%d", params->crf);
    const char *const list[] = {
        params->ffmpeg, "-hide_banner", "-nostdin", "-loglevel", "error", "-xerror", "-y",
        "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", arguments->size,
        "-framerate", arguments->rate, "-i", "pipe:0",
        "-vf", "scale=out_color_matrix=bt709:out_range=tv",
        "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", arguments->crf,
        "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709",
        "-fflags", "+bitexact", "-flags:v", "+bitexact", "-movflags", "+faststart",
        "-f", params->format, output, NULL};
    _Static_assert(sizeof list / sizeof *list <= MAX_ARGUMENTS + 1, "arguments fit");
    memcpy(arguments->items, list, sizeof list); /* execvp takes char *const *, reads only */
}

/* In the new process: no memory is asked for and nothing of the parent's is touched. */
static void become_ffmpeg(struct arguments *arguments, int input, int messages, int failure)
{
    sigset_t none;
    sigemptyset(&none);
    struct sigaction ignore = {.sa_handler = SIG_IGN}, usual = {.sa_handler = SIG_DFL};
    setpgid(0, 0);
    sigaction(SIGINT, &ignore, NULL);
    sigaction(SIGPIPE, &usual, NULL);
    sigprocmask(SIG_SETMASK, &none, NULL);
    int null = open("/dev/null", O_WRONLY);
    if (dup2(input, 0) >= 0 && null >= 0 && dup2(null, 1) >= 0 && dup2(messages, 2) >= 0) {
        close_range(3, ~0u, CLOSE_RANGE_CLOEXEC);
        execvp(arguments->items[0], arguments->items);
    }
    int error = errno;
    ssize_t wrote = write(failure, &error, sizeof error);
    _exit(wrote == sizeof error ? 127 : 126);
}

/* 0, or the errno of the exec: the pipe closes by itself when it succeeds. */
static int exec_error(int failure)
{
    int error = 0;
    ssize_t got;
    do
        got = read(failure, &error, sizeof error);
    while (got < 0 && errno == EINTR);
    return got == sizeof error ? error : 0;
}

static int wait_for(pid_t process)
{
    int status = 0;
    while (waitpid(process, &status, 0) < 0) {
        if (errno != EINTR)
            return -1;
    }
    return status;
}

static int start(struct wd_encoder *encoder, struct arguments *arguments)
{
    int input[2], failure[2];
    if (pipe2(input, O_CLOEXEC) != 0)
        return errno;
    if (pipe2(failure, O_CLOEXEC) != 0) {
        int error = errno;
        close(input[0]);
        close(input[1]);
        return error;
    }
    pid_t process = fork();
    if (process == 0)
        become_ffmpeg(arguments, input[0], fileno(encoder->messages), failure[1]);
    int error = process < 0 ? errno : 0;
    close(input[0]);
    close(failure[1]);
    if (process > 0) {
        error = exec_error(failure[0]);
        encoder->process = process;
        encoder->pipe = input[1];
    } else {
        close(input[1]);
    }
    close(failure[0]);
    return error;
}

bool wd_encoder_open(struct wd_encoder *encoder, const struct wd_encoder_params *params,
                     const struct wd_log *log)
{
    *encoder = (struct wd_encoder){0};
    if (!wd_output_open(&encoder->file, params->path, log))
        return false;
    struct arguments arguments = {0};
    build_arguments(&arguments, params, encoder->file.temporary);
    encoder->messages = tmpfile();
    int error = encoder->messages ? start(encoder, &arguments) : errno;
    if (error == 0)
        return true;
    if (error == ENOENT)
        wd_error(log, "%s: films need the program %s, which is not there; install the package "
                 "ffmpeg, or write frames: frame-%%05d.png", params->path, params->ffmpeg);
    else
        wd_error(log, "%s: %s cannot be started: %s", params->path, params->ffmpeg,
                 strerror(error));
    wd_encoder_discard(encoder);
    return false;
}

/* The last line that ffmpeg wrote to its standard error, or "". */
static void last_message(struct wd_encoder *encoder, char *line, size_t size)
{
    char text[2048];
    long length = fseek(encoder->messages, 0, SEEK_END) == 0 ? ftell(encoder->messages) : 0;
    long from = length > (long)sizeof text - 1 ? length - (long)sizeof text + 1 : 0;
    size_t got = fseek(encoder->messages, from, SEEK_SET) == 0
                     ? fread(text, 1, sizeof text - 1, encoder->messages) : 0;
    while (got > 0 && (text[got - 1] == '\n' || text[got - 1] == '\r'))
        got--;
    text[got] = '\0';
    const char *newline = strrchr(text, '\n');
    snprintf(line, size, "%.500s", newline ? newline + 1 : text);
}

static void close_pipe(struct wd_encoder *encoder)
{
    if (encoder->pipe > 0)
        close(encoder->pipe);
    encoder->pipe = 0;
}

/* Ends the process one way or the other and logs what it said. */
static bool fail(struct wd_encoder *encoder, const char *what, const struct wd_log *log)
{
    char line[512];
    close_pipe(encoder);
    if (encoder->process > 0)
        wait_for(encoder->process);
    encoder->process = 0;
    last_message(encoder, line, sizeof line);
    wd_error(log, "%s: the film cannot be written: ffmpeg %s%s%s", encoder->file.path, what,
             line[0] ? ": " : "", line);
    wd_encoder_discard(encoder);
    return false;
}

/* write() with SIGPIPE held back: one that this call caused is taken from the pending ones. It
 * comes with a short count, too, when the reader dies in the middle. */
static ssize_t write_quietly(int pipe, const void *data, size_t size)
{
    sigset_t pipe_signal, before, pending;
    sigemptyset(&pipe_signal);
    sigaddset(&pipe_signal, SIGPIPE);
    sigpending(&pending);
    pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
    ssize_t wrote = write(pipe, data, size);
    int error = errno;
    if (wrote < (ssize_t)size && !sigismember(&pending, SIGPIPE)) {
        struct timespec no_time = {0};
        while (sigtimedwait(&pipe_signal, NULL, &no_time) < 0 && errno == EINTR)
            ;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return wrote;
}

bool wd_encoder_write(struct wd_encoder *encoder, const void *data, size_t size,
                      const struct wd_log *log)
{
    const char *bytes = data;
    while (size > 0) {
        ssize_t wrote = write_quietly(encoder->pipe, bytes, size);
        if (wrote < 0 && errno == EINTR)
            continue;
        if (wrote < 0)
            return fail(encoder, "stopped early", log);
        bytes += wrote;
        size -= (size_t)wrote;
    }
    return true;
}

bool wd_encoder_commit(struct wd_encoder *encoder, const struct wd_log *log)
{
    close_pipe(encoder);
    int status = wait_for(encoder->process);
    encoder->process = 0;
    char what[64];
    if (WIFSIGNALED(status)) {
        snprintf(what, sizeof what, "was ended by signal %d", WTERMSIG(status));
        return fail(encoder, what, log);
    }
    if (status != 0) {
        snprintf(what, sizeof what, "failed with status %d", WEXITSTATUS(status));
        return fail(encoder, what, log);
    }
    bool ok = wd_output_commit(&encoder->file, log);
    wd_encoder_discard(encoder);
    return ok;
}

void wd_encoder_discard(struct wd_encoder *encoder)
{
    close_pipe(encoder);
    if (encoder->process > 0) {
        kill(encoder->process, SIGKILL);
        wait_for(encoder->process);
    }
    if (encoder->messages)
        fclose(encoder->messages);
    wd_output_discard(&encoder->file);
    *encoder = (struct wd_encoder){0};
}
