/* jobs.h: a parallel loop over pthreads. No result may depend on the number of threads. */
#ifndef WD_BASE_JOBS_H
#define WD_BASE_JOBS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/log.h"

/* Processors this process may run on, at least 1. */
unsigned wd_jobs_default_threads(void);

/* Calls work(user, i) once for each i in [0, count), on up to `threads` threads (0: the default),
 * in any order; returns when all are done. The calling thread works too. Calls may nest. */
void wd_jobs_run(unsigned threads, size_t count, void (*work)(void *user, size_t index),
                 void *user);

/* The same; the calling thread reports what is done. False once the one told wants to stop: what has not
 * begun then is left undone. `progress` may be NULL. */
bool wd_jobs_run_told(unsigned threads, size_t count, void (*work)(void *user, size_t index),
                      void *user, const struct wd_progress *progress, const char *stage);

#endif
