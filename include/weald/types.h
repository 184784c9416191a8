/* weald/types.h: result codes, logging and small value types shared by every public header. */
#ifndef WEALD_TYPES_H
#define WEALD_TYPES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a call came to. Every failure has been logged once, with its cause, before it is returned. */
enum wd_result {
    WD_OK = 0,
    WD_ERROR_INPUT,       /* a file, option or argument is wrong; the message names it */
    WD_ERROR_OUTPUT,      /* an output could not be written; nothing half-written remains */
    WD_ERROR_DEVICE,      /* no usable Vulkan device, or the device was lost */
    WD_ERROR_MEMORY,      /* the device's memory ran out, or the host's for what a picture or its file holds;
                             see below */
    WD_ERROR_INTERRUPTED, /* the caller's progress callback asked to stop */
};

/* Host memory. Room for the layers of pictures, which a caller or a file can make as large as it likes, is had
 * before they are drawn, traced, read or written, or the call returns WD_ERROR_MEMORY. Other memory is taken to be
 * there: where it cannot be had for a forest's trees (which max_trees bounds), tables, ground or meshes, for
 * comparing pictures or for small things, the process ends by abort() after a message on standard error. Systems
 * that promise more memory than they have may end it at any time. */

/* Pointers that a call takes are to objects that are there, but where a comment says that NULL is accepted or may be
 * given. A `const struct wd_log *` and a `const struct wd_progress *` may be NULL everywhere, which is as {0}. Where a
 * call returns an enum wd_result, most that are NULL are refused with WD_ERROR_INPUT; those to where the call writes
 * must not be. */

/* Threads. Calls said to be thread-safe may run beside each other on the same objects, as any may on objects that have
 * nothing to do with each other; all others on an object come one at a time. */

/* The version of the library that is loaded, as "1.2.3". Structures are those of the headers of that version, which tells
 * programs that mirror them in another language whether theirs fit. Never NULL, valid for ever. Thread-safe. */
const char *wd_version(void);

/* Short English name of a result ("input", "output", ...); never NULL. Thread-safe. */
const char *wd_result_name(enum wd_result result);

enum wd_log_level {
    WD_LOG_ERROR,
    WD_LOG_WARNING,
    WD_LOG_INFO,
    WD_LOG_DEBUG,
};

/* Where messages go. `sink` may be NULL: then errors and warnings go to standard error. What is made with one keeps a copy
 * of it and logs there in all later calls, so that `user` must live as long; the same holds for struct wd_progress.
 * `message` is one line of UTF-8 without a newline and lives only during the call.
 * The sink may be called from any thread that works for the call at hand, one at a time. */
struct wd_log {
    void (*sink)(void *user, enum wd_log_level level, const char *message);
    void *user;
};

/* How far a long call has come. `report` may be NULL. `done`, in the unit that `stage` names ("trees", "frames", ...),
 * never falls within a stage; one may begin after 0 and end before `total`. Return false to stop the call, which then
 * returns WD_ERROR_INTERRUPTED and leaves no partial output. Called on the calling thread. */
struct wd_progress {
    bool (*report)(void *user, const char *stage, uint64_t done, uint64_t total);
    void *user;
};

#ifdef __cplusplus
}
#endif
#endif
