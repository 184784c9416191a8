/* message.h: messages of the viewer to its caller's sink. */
#ifndef VIEWER_MESSAGE_H
#define VIEWER_MESSAGE_H

#include "weald/types.h"

/* Logs an error and returns false. */
bool viewer_error(const struct wd_log *log, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void viewer_info(const struct wd_log *log, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
