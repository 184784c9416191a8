#include "message.h"

#include <stdarg.h>
#include <stdio.h>

static void send(const struct wd_log *log, enum wd_log_level level, const char *format,
                 va_list args)
{
    char message[1024];
    vsnprintf(message, sizeof message, format, args);
    if (log->sink)
        log->sink(log->user, level, message);
    else if (level <= WD_LOG_WARNING)
        fprintf(stderr, "weald: %s\n", message);
}

bool viewer_error(const struct wd_log *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    send(log, WD_LOG_ERROR, format, args);
    va_end(args);
    return false;
}

void viewer_info(const struct wd_log *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    send(log, WD_LOG_INFO, format, args);
    va_end(args);
}
