/* clock.h: the hours that --clock names. */
#ifndef CLI_CLOCK_H
#define CLI_CLOCK_H

#include "cli.h"

/* Whether --clock, if it is given, can be understood; a range is for films. */
bool cli_clock_check(struct cli_session *session, bool film);
/* The sun by --clock: at the share 0..1 of its range. To be called where it is given alone. */
enum wd_result cli_clock_sun(const struct cli_session *session, const struct wd_forest *forest, double share,
                             struct wd_sun *sun);

#endif
