/* limits.h: a full disk, as a process sees it that may write no more than so many bytes a file. */
#ifndef WD_TESTS_OUTPUT_LIMITS_H
#define WD_TESTS_OUTPUT_LIMITS_H

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "common.h"

/* Runs `work` in a child whose files end at `bytes` with an error (SIGXFSZ ignored, here and in
 * what it starts). True when `work` said true. */
static inline bool with_small_files(bool (*work)(struct fixture *), struct fixture *f,
                                    unsigned bytes)
{
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        struct rlimit limit = {bytes, bytes};
        signal(SIGXFSZ, SIG_IGN);
        bool ok = setrlimit(RLIMIT_FSIZE, &limit) == 0 && work(f);
        _exit(ok ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return status == 0;
}

#endif
