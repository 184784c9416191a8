/* logged.h: keeps what is logged, for tests of messages. */
#ifndef WD_TESTS_LOGGED_H
#define WD_TESTS_LOGGED_H

#include <stdio.h>
#include <string.h>

#include "weald/types.h"

struct logged {
    char text[8192];
    int errors, warnings;
};

static void logged_sink(void *user, enum wd_log_level level, const char *message)
{
    struct logged *logged = user;
    size_t length = strlen(logged->text);
    snprintf(logged->text + length, sizeof logged->text - length, "%s\n", message);
    logged->errors += level == WD_LOG_ERROR;
    logged->warnings += level == WD_LOG_WARNING;
}

#endif
