/* timers.h: the scopes of a frame. */
#ifndef WD_GPU_TIMERS_H
#define WD_GPU_TIMERS_H

#include "gpu/command.h"

/* After the frame's commands have begun. */
void wd_timers_begin_frame(struct wd_cmd *cmd);
/* After the slot's fence: makes its scopes frames->last_scopes. */
void wd_timers_collect(struct wd_frames *frames, struct wd_frame_slot *slot);

#endif
