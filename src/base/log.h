/* log.h: messages to the caller's sink. Errors are logged once, where they happen. */
#ifndef WD_BASE_LOG_H
#define WD_BASE_LOG_H

#include <pthread.h>

#include "weald/types.h"

/* Each takes printf arguments. `log` may be NULL (standard error). wd_error returns false, so
 * that `return wd_error(log, ...)` reads as what it is. */
bool wd_error(const struct wd_log *log, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void wd_warn(const struct wd_log *log, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void wd_info(const struct wd_log *log, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void wd_debug(const struct wd_log *log, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Where nobody is told: of what may fail. */
extern const struct wd_log wd_log_quiet;

/* Several threads' way to one log, whose sink takes one message at a time. Not to be moved. `to` must
 * outlive it; to that itself a sink may log. */
struct wd_shared_log {
    struct wd_log log; /* the threads' */
    const struct wd_log *to;
    pthread_mutex_t turn;
};
void wd_shared_log_init(struct wd_shared_log *shared, const struct wd_log *to);
void wd_shared_log_finish(struct wd_shared_log *shared); /* accepts {0} */

/* Reports progress; returns false when the caller wants to stop. `progress` may be NULL. */
bool wd_progress_report(const struct wd_progress *progress, const char *stage, uint64_t done,
                        uint64_t total);

#endif
