#include "base/log.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/utf8.h"

static void deliver(const struct wd_log *log, enum wd_log_level level, const char *message)
{
    if (log && log->sink) {
        log->sink(log->user, level, message);
        return;
    }
    if (level > WD_LOG_WARNING)
        return;
    fprintf(stderr, "weald: %s%s\n", level == WD_LOG_WARNING ? "warning: " : "", message);
}

static void ignore(void *user, enum wd_log_level level, const char *message)
{
    (void)user;
    (void)level;
    (void)message;
}

const struct wd_log wd_log_quiet = {.sink = ignore};

/* Takes from the end what is left of a character that was cut. */
static void drop_cut(char *message, size_t length)
{
    for (size_t i = 1; i < 4 && i <= length; i++)
        if ((message[length - i] & 0xc0) == 0xc0 && wd_utf8_length(message + length - i, i) == 0)
            message[length - i] = '\0';
}

/* A name or a text in a file may hold anything; a message is one line. */
static void log_message(const struct wd_log *log, enum wd_log_level level, const char *format,
                        va_list args)
{
    char message[2048], line[2048];
    int length = vsnprintf(message, sizeof message, format, args);
    if (length >= (int)sizeof message)
        drop_cut(message, sizeof message - 1);
    wd_utf8_line(line, sizeof line, message);
    deliver(log, level, line);
}

bool wd_error(const struct wd_log *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_message(log, WD_LOG_ERROR, format, args);
    va_end(args);
    return false;
}

void wd_warn(const struct wd_log *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_message(log, WD_LOG_WARNING, format, args);
    va_end(args);
}

void wd_info(const struct wd_log *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_message(log, WD_LOG_INFO, format, args);
    va_end(args);
}

void wd_debug(const struct wd_log *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_message(log, WD_LOG_DEBUG, format, args);
    va_end(args);
}

static void deliver_in_turn(void *user, enum wd_log_level level, const char *message)
{
    struct wd_shared_log *shared = user;
    pthread_mutex_lock(&shared->turn);
    deliver(shared->to, level, message);
    pthread_mutex_unlock(&shared->turn);
}

void wd_shared_log_init(struct wd_shared_log *shared, const struct wd_log *to)
{
    *shared = (struct wd_shared_log){.log = {deliver_in_turn, shared}, .to = to};
    pthread_mutex_init(&shared->turn, NULL);
}

void wd_shared_log_finish(struct wd_shared_log *shared)
{
    if (shared->log.sink)
        pthread_mutex_destroy(&shared->turn);
    *shared = (struct wd_shared_log){0};
}

bool wd_progress_report(const struct wd_progress *progress, const char *stage, uint64_t done,
                        uint64_t total)
{
    return !progress || !progress->report || progress->report(progress->user, stage, done, total);
}

const char *wd_result_name(enum wd_result result)
{
    switch (result) {
    case WD_OK:
        return "ok";
    case WD_ERROR_INPUT:
        return "input";
    case WD_ERROR_OUTPUT:
        return "output";
    case WD_ERROR_DEVICE:
        return "device";
    case WD_ERROR_MEMORY:
        return "memory";
    case WD_ERROR_INTERRUPTED:
        return "interrupted";
    }
    return "unknown";
}
