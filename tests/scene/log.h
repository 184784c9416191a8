/* log.h: collects what is logged, for tests of messages. */
#ifndef WD_TESTS_SCENE_LOG_H
#define WD_TESTS_SCENE_LOG_H

#include <stdio.h>
#include <string.h>

#include "weald/types.h"

struct collected {
    char text[16384];
    unsigned errors, warnings;
};

static inline void collect(void *user, enum wd_log_level level, const char *message)
{
    struct collected *all = user;
    all->errors += level == WD_LOG_ERROR;
    all->warnings += level == WD_LOG_WARNING;
    size_t used = strlen(all->text);
    snprintf(all->text + used, sizeof all->text - used, "%s\n", message);
}

/* Prints what was logged when a message is missing, so that a failure explains itself. */
static inline bool logged(const struct collected *all, const char *part)
{
    if (strstr(all->text, part))
        return true;
    fprintf(stderr, "wanted: %s\nlogged: %s\n", part, all->text);
    return false;
}

#endif
