/* clock.h: wall-clock time for measurements and progress, never for placement or growth. */
#ifndef WD_BASE_CLOCK_H
#define WD_BASE_CLOCK_H

double wd_clock_s(void); /* monotonic seconds since an arbitrary start */

#endif
