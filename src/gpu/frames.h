/* frames.h: parts of the frame ring that timers share. */
#ifndef WD_GPU_FRAMES_H
#define WD_GPU_FRAMES_H

#include "gpu/barriers.h"
#include "gpu/command.h"

/* Submits what has been recorded, waits for it and goes on recording; returns the seconds from
 * submission to completion. A failure marks the frame failed. */
double wd_frame_run_now(struct wd_cmd *cmd);

/* Records the barrier and remembers it for an abandoned frame. */
void wd_frame_barrier(struct wd_cmd *cmd, const struct wd_barrier *barrier);

/* bind.c: makes all sets of the slot's descriptor pools free again; destroys the pools. */
bool wd_descriptors_reset(struct wd_frame_slot *slot, struct wd_gpu *gpu);
void wd_descriptors_finish(struct wd_frame_slot *slot, struct wd_gpu *gpu);

#endif
