#include "cli.h"

#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "args.h"
#include "viewer/viewer.h"

#define QUIET_SECONDS 2.0
#define REDRAW_SECONDS 0.1

uint64_t cli_key_text(uint64_t key, const char *text)
{
    for (; *text; text++)
        key = (key ^ (uint8_t)*text) * 0x100000001b3u;
    return key;
}

double cli_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

void cli_meter_clear(struct cli_meter *meter)
{
    if (meter->bar_shown)
        fprintf(stderr, "\r\033[K");
    meter->bar_shown = false;
}

static void draw_bar(struct cli_meter *meter, const char *stage, double fraction)
{
    enum { WIDTH = 40 };
    char bar[WIDTH + 1];
    int full = (int)(fraction * WIDTH);
    memset(bar, '-', WIDTH);
    memset(bar, '#', (size_t)full);
    bar[WIDTH] = 0;
    fprintf(stderr, "\r%-12s [%s] %3.0f%%  %.0f s\033[K", stage, bar, fraction * 100,
            cli_seconds() - meter->begin_s);
    fflush(stderr);
    meter->bar_shown = true;
}

static void print_quarter(struct cli_meter *meter, const char *stage, double fraction)
{
    unsigned quarter = (unsigned)(fraction * 4);
    if (meter->stage && !strcmp(meter->stage, stage) && quarter <= meter->quarter)
        return;
    meter->stage = stage;
    meter->quarter = quarter;
    fprintf(stderr, "weald: %s %u%%\n", stage, quarter * 25);
}

static void show_progress(struct cli_meter *meter, const char *stage, uint64_t done, uint64_t total)
{
    double now_s = cli_seconds();
    if (meter->quiet || now_s - meter->begin_s < QUIET_SECONDS)
        return;
    double fraction = total ? (double)done / (double)total : 0;
    if (meter->frame_count) {
        fraction = ((double)meter->frame + fraction) / (double)meter->frame_count;
        stage = "frames";
    }
    fraction = fraction > 1 ? 1 : fraction;
    if (!meter->terminal) {
        print_quarter(meter, stage, fraction);
    } else if (now_s - meter->drawn_s >= REDRAW_SECONDS) {
        meter->drawn_s = now_s;
        draw_bar(meter, stage, fraction);
    }
}

void cli_session_film_progress(struct cli_session *session, uint64_t frame, uint64_t frame_count)
{
    session->meter.frame = frame;
    session->meter.frame_count = frame_count;
    if (frame_count)
        show_progress(&session->meter, "frames", 0, 1);
}

static bool report_progress(void *user, const char *stage, uint64_t done, uint64_t total)
{
    struct cli_session *session = user;
    show_progress(&session->meter, stage, done, total);
    return !cli_session_interrupted(session);
}

static void print_message(void *user, enum wd_log_level level, const char *message)
{
    struct cli_session *session = user;
    if (level == WD_LOG_DEBUG || (level == WD_LOG_INFO && session->options->quiet))
        return;
    cli_meter_clear(&session->meter);
    const char *kind = level == WD_LOG_ERROR     ? "error: "
                       : level == WD_LOG_WARNING ? "warning: "
                                                 : "";
    fprintf(stderr, "weald: %s%s\n", kind, message);
}

/* A step may take minutes: a frame of many samples cannot be stopped within. Said only where that cannot block, or the
 * next signal would not be waited for. */
static void say_ending(void)
{
    static const char clear[] = "\r\033[K";
    static const char line[] = "\r\033[Kweald: ends after the running step; another Ctrl-C ends it at once\n";
    const char *text = isatty(STDERR_FILENO) ? line : line + strlen(clear);
    struct pollfd errors = {.fd = STDERR_FILENO, .events = POLLOUT};
    if (poll(&errors, 1, 0) == 1 && (errors.revents & POLLOUT) && write(STDERR_FILENO, text, strlen(text)) < 0)
        return; /* it is but a hint */
}

static void *wait_for_signals(void *user)
{
    struct cli_interrupt *interrupt = user;
    for (;;) {
        int number;
        if (sigwait(&interrupt->signals, &number))
            return NULL;
        if (atomic_exchange(&interrupt->signal, number))
            _exit(128 + number);
        say_ending();
    }
}

/* The signals are blocked in every thread but the waiting one and in children: a film's encoder
 * must live on to finish the frames there are when Ctrl-C reaches the whole foreground group. */
static bool start_interrupt(struct cli_interrupt *interrupt)
{
    sigemptyset(&interrupt->signals);
    sigaddset(&interrupt->signals, SIGINT);
    sigaddset(&interrupt->signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &interrupt->signals, NULL);
    signal(SIGINT, SIG_DFL);  /* a shell's background job comes with it ignored */
    signal(SIGPIPE, SIG_IGN); /* a dead encoder and a full quota are errors of the write, with a */
    signal(SIGXFSZ, SIG_IGN); /* message, not the end of the process */
    return !pthread_create(&interrupt->thread, NULL, wait_for_signals, interrupt);
}

bool cli_session_start(struct cli_session *session, const struct cli_options *options)
{
    *session = (struct cli_session){.options = options};
    session->meter.begin_s = cli_seconds();
    session->meter.terminal = isatty(STDERR_FILENO);
    session->meter.quiet = options->quiet;
    session->log = (struct wd_log){print_message, session};
    session->progress = (struct wd_progress){report_progress, session};
    return start_interrupt(&session->interrupt) ||
           cli_fail(session, "no thread could be started to wait for Ctrl-C");
}

void cli_session_take(struct cli_session *session, const struct cli_options *options)
{
    cli_meter_clear(&session->meter);
    session->options = options;
    session->meter = (struct cli_meter){
        .begin_s = cli_seconds(), .terminal = session->meter.terminal, .quiet = options->quiet};
}

void cli_session_finish(struct cli_session *session)
{
    cli_meter_clear(&session->meter);
    pthread_cancel(session->interrupt.thread);
    pthread_join(session->interrupt.thread, NULL);
}

bool cli_session_interrupted(const struct cli_session *session)
{
    return atomic_load(&session->interrupt.signal) != 0;
}

enum cli_status cli_session_status(const struct cli_session *session, enum wd_result result)
{
    if (result == WD_OK)
        return CLI_OK;
    if (result == WD_ERROR_INTERRUPTED)
        return (enum cli_status)(128 + atomic_load(&session->interrupt.signal));
    return CLI_FAILED;
}

void cli_say(struct cli_session *session, const char *format, ...)
{
    if (session->options->quiet)
        return;
    cli_meter_clear(&session->meter);
    va_list args;
    va_start(args, format);
    vprintf(format, args);
    va_end(args);
    fflush(stdout);
}

bool cli_fail(struct cli_session *session, const char *format, ...)
{
    char message[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    print_message(session, WD_LOG_ERROR, message);
    return false;
}

/* One of `names`, or a complaint that lists the first of them. `what` is what they name. */
static bool check_name(struct cli_session *session, const char *what, const char *name,
                       const char *const *names)
{
    enum { FEW = 10 };
    char known[1024] = "";
    size_t used = 0, count = 0;
    for (const char *const *candidate = names; *candidate; candidate++) {
        if (!strcmp(*candidate, name))
            return true;
        if (count++ < FEW)
            used += (size_t)snprintf(known + used, sizeof known - used, "%s%.60s", used ? ", " : "", *candidate);
    }
    if (count > FEW)
        snprintf(known + used, sizeof known - used, " and %zu more", count - FEW);
    const char *suggestion = cli_suggest(name, names);
    if (suggestion)
        return cli_fail(session, "there is no %s \"%s\", did you mean \"%s\"?", what, name,
                        suggestion);
    return cli_fail(session, "there is no %s \"%s\"; there %s: %s", what, name,
                    *known ? "are" : "is", *known ? known : "none");
}

bool cli_method_known(struct cli_session *session, const char *name)
{
    return check_name(session, "method", name, wd_method_names());
}

bool cli_method_check(struct cli_session *session)
{
    const char *method = session->options->method;
    return !method || cli_method_known(session, method);
}

bool cli_error_check(struct cli_session *session)
{
    const struct cli_options *options = session->options;
    return options->max_error_px <= 0 || options->budget_ms <= 0 ||
           cli_fail(session, "--max-error and --budget-ms exclude each other");
}

bool cli_bound_check(struct cli_session *session, const struct wd_forest *forest)
{
    const struct cli_options *options = session->options;
    struct wd_render_defaults defaults;
    wd_forest_get_render_defaults(forest, &defaults);
    const char *method = options->method ? options->method : defaults.method;
    return (options->max_error_px <= 0 && options->budget_ms <= 0) || !strcmp(method, "continuum") ||
           cli_fail(session, "%s is for the method continuum, not for %s",
                    options->budget_ms > 0 ? "--budget-ms" : "--max-error", method);
}

static bool check_place(struct cli_session *session, const struct wd_forest *forest,
                        const char *what, const char *name,
                        const char *(*get)(const struct wd_forest *, uint32_t))
{
    uint32_t count = 0;
    if (!name)
        return true;
    while (get(forest, count))
        count++;
    const char **names = calloc((size_t)count + 1, sizeof *names);
    if (!names)
        return cli_fail(session, "out of memory");
    for (uint32_t i = 0; i < count; i++)
        names[i] = get(forest, i);
    bool found = check_name(session, what, name, names);
    free(names);
    return found;
}

/* --camera names one that the viewer saved, not one of the scene's. */
static bool is_saved(const struct cli_session *session, const struct wd_forest *forest, struct wd_camera *camera)
{
    const struct cli_options *options = session->options;
    const char *own;
    if (!options->camera)
        return false;
    for (uint32_t i = 0; (own = wd_forest_camera_name(forest, i)); i++)
        if (!strcmp(own, options->camera))
            return false;
    return wd_viewer_saved_camera(camera, options->operands[0], options->camera, &session->log);
}

bool cli_places_check(struct cli_session *session, const struct wd_forest *forest)
{
    const struct cli_options *options = session->options;
    struct wd_camera camera;
    return (is_saved(session, forest, &camera) ||
            check_place(session, forest, "camera", options->camera, wd_forest_camera_name)) &&
           check_place(session, forest, "path", options->path, wd_forest_path_name);
}

enum wd_result cli_camera(const struct cli_session *session, const struct wd_forest *forest, struct wd_camera *camera)
{
    return is_saved(session, forest, camera) ? WD_OK : wd_forest_get_camera(forest, session->options->camera, camera);
}
