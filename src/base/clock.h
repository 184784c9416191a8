/* clock.h: time for measurements and progress, never for placement or growth. */
#ifndef WD_BASE_CLOCK_H
#define WD_BASE_CLOCK_H

double wd_clock_s(void); /* monotonic seconds since an arbitrary start */
double wd_processor_s(void); /* that all threads of this process have run */

#endif
