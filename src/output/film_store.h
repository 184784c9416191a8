/* film_store.h: the finished frames of a film that is not finished, on disk, so that it can be gone
 * on with.
 *
 * One file that only grows, frame by frame; each carries a checksum. What a kill has cut short, or
 * anything has damaged, is dropped with all that follows it. */
#ifndef WD_OUTPUT_FILM_STORE_H
#define WD_OUTPUT_FILM_STORE_H

#include <stdio.h>

#include "weald/types.h"

/* `{0}` is closed. Frames that are there are read first, in order, then others are added. */
struct wd_film_store {
    char *path;
    FILE *stream;
    uint64_t key;
    uint64_t frames; /* read or added */
    int64_t before;  /* where the frame that was read last begins */
    bool adding;     /* nothing is left to be read */
};

/* `key`: a hash of all that the frames follow from. False, logged, for a file that is not such a
 * store, or of another key, or at which another process is at work. */
bool wd_film_store_open(struct wd_film_store *store, const char *path, uint64_t key,
                        const struct wd_log *log);
/* The next frame, of `size` bytes, if it is there and whole. */
bool wd_film_store_read(struct wd_film_store *store, void *frame, size_t size);
/* Takes back the frame that was read last: what it speaks of is no more. */
void wd_film_store_unread(struct wd_film_store *store);
/* Frames not read are dropped. On failure those before stay. */
bool wd_film_store_add(struct wd_film_store *store, const void *frame, size_t size,
                       const struct wd_log *log);
/* Leaves the file, if it holds a frame. Accepts `{0}`. */
void wd_film_store_close(struct wd_film_store *store);
/* Removes it. */
void wd_film_store_remove(struct wd_film_store *store);

#endif
