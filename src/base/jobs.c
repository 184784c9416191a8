#include "base/jobs.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/memory.h"

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

/* 0 where the system's set of processors does not fit into one of `places`. */
static unsigned count_processors(size_t places)
{
    cpu_set_t *set = CPU_ALLOC(places);
    size_t size = CPU_ALLOC_SIZE(places);
    int count = set && sched_getaffinity(0, size, set) == 0 ? CPU_COUNT_S(size, set) : 0;
    CPU_FREE(set);
    return (unsigned)count;
}

unsigned wd_jobs_default_threads(void)
{
    unsigned count = 0;
    for (size_t places = 64; count == 0 && places <= 1 << 20; places *= 2)
        count = count_processors(places);
    return count ? count : 1;
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
    struct loop loop = {.count = count,
                        .work = work,
                        .user = user,
                        .progress = progress,
                        .stage = stage,
                        .caller = pthread_self()};
    if (threads == 0)
        threads = wd_jobs_default_threads();
    if (threads > count)
        threads = count ? (unsigned)count : 1;
    pthread_t *helpers = wd_try_array(threads - 1, sizeof *helpers);
    unsigned started = 0;
    /* A helper that cannot be started is no error: the others do its work. */
    while (helpers && started + 1 < threads &&
           pthread_create(&helpers[started], NULL, loop_run, &loop) == 0)
        started++;
    loop_run(&loop);
    for (unsigned i = 0; i < started; i++)
        pthread_join(helpers[i], NULL);
    free(helpers);
    return !atomic_load(&loop.stop);
}

void wd_jobs_run(unsigned threads, size_t count, void (*work)(void *user, size_t index), void *user)
{
    wd_jobs_run_told(threads, count, work, user, NULL, NULL);
}
