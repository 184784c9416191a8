/* jobs.h: a parallel loop over pthreads. No result may depend on the number of threads. */
#ifndef WD_BASE_JOBS_H
#define WD_BASE_JOBS_H

#include <stddef.h>

/* Processors this process may run on, at least 1. */
unsigned wd_jobs_default_threads(void);

/* Calls work(user, i) once for each i in [0, count), on up to `threads` threads (0: the default),
 * in any order; returns when all are done. The calling thread works too. Calls may nest. */
void wd_jobs_run(unsigned threads, size_t count, void (*work)(void *user, size_t index),
                 void *user);

#endif
