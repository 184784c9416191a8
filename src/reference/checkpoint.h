/* checkpoint.h: an unfinished picture on disk. */
#ifndef WD_REFERENCE_CHECKPOINT_H
#define WD_REFERENCE_CHECKPOINT_H

#include "reference/render.h"

/* `key` is a hash of everything that the picture depends on but the number of samples. The file
 * appears whole or not at all. */
bool wd_checkpoint_write(const char *path, uint64_t key, const struct wd_trace_sums *sums,
                         const struct wd_log *log);

/* Fills `*sums`, which has been made for the picture's size. False, logged, for a file that is
 * broken, or of another picture or size; `*sums` then holds nothing of use. */
bool wd_checkpoint_read(const char *path, uint64_t key, struct wd_trace_sums *sums,
                        const struct wd_log *log);

#endif
