#include "base/jobs.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

struct loop {
    atomic_size_t next, done;
    size_t count;
    void (*work)(void *user, size_t index);
    void *user;
    const struct wd_progress *progress;
    const char *stage;
    pthread_t caller;
    atomic_bool stop;
};

unsigned wd_jobs_default_threads(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0)
        return 1;
    int count = CPU_COUNT(&set);
    return count > 0 ? (unsigned)count : 1;
}

static void *loop_run(void *argument)
{
    struct loop *loop = argument;
    for (;;) {
        size_t index = atomic_fetch_add_explicit(&loop->next, 1, memory_order_relaxed);
        if (index >= loop->count || atomic_load_explicit(&loop->stop, memory_order_relaxed))
            return NULL;
        loop->work(loop->user, index);
        size_t done = atomic_fetch_add_explicit(&loop->done, 1, memory_order_relaxed) + 1;
        if (loop->progress && pthread_equal(pthread_self(), loop->caller) &&
            !wd_progress_report(loop->progress, loop->stage, done, loop->count))
            atomic_store(&loop->stop, true);
    }
}

bool wd_jobs_run_told(unsigned threads, size_t count, void (*work)(void *user, size_t index),
                      void *user, const struct wd_progress *progress, const char *stage)
{
    enum { MAX_THREADS = 64 };
    pthread_t helpers[MAX_THREADS];
    struct loop loop = {.count = count,
                        .work = work,
                        .user = user,
                        .progress = progress,
                        .stage = stage,
                        .caller = pthread_self()};
    if (threads == 0)
        threads = wd_jobs_default_threads();
    if (threads > MAX_THREADS)
        threads = MAX_THREADS;
    if (threads > count)
        threads = count ? (unsigned)count : 1;
    unsigned started = 0;
    /* A helper that cannot be started is no error: the others do its work. */
    while (started + 1 < threads && pthread_create(&helpers[started], NULL, loop_run, &loop) == 0)
        started++;
    loop_run(&loop);
    for (unsigned i = 0; i < started; i++)
        pthread_join(helpers[i], NULL);
    return !atomic_load(&loop.stop);
}

void wd_jobs_run(unsigned threads, size_t count, void (*work)(void *user, size_t index), void *user)
{
    wd_jobs_run_told(threads, count, work, user, NULL, NULL);
}
