#include "base/jobs.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

struct loop {
    atomic_size_t next;
    size_t count;
    void (*work)(void *user, size_t index);
    void *user;
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
        if (index >= loop->count)
            return NULL;
        loop->work(loop->user, index);
    }
}

void wd_jobs_run(unsigned threads, size_t count, void (*work)(void *user, size_t index), void *user)
{
    enum { MAX_THREADS = 64 };
    pthread_t helpers[MAX_THREADS];
    struct loop loop = {.count = count, .work = work, .user = user};
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
}
