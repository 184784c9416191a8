#include "clock.h"

#include <stdlib.h>
#include <string.h>

/* "HH:MM" at the beginning of a text; false where it is not. */
static bool parse_hour(const char *text, double *hour)
{
    static const char digits[] = "0123456789";
    if (strspn(text, digits) != 2 || text[2] != ':' || strspn(text + 3, digits) != 2)
        return false;
    int hours = atoi(text), minutes = atoi(text + 3);
    *hour = hours + minutes / 60.0;
    return minutes < 60 && *hour <= 24;
}

/* From and to; a range that goes back ends on the next day. */
static bool parse(const char *text, double hours[2])
{
    if (!parse_hour(text, &hours[0]))
        return false;
    hours[1] = hours[0];
    if (!text[5])
        return true;
    if (text[5] != '-' || !parse_hour(text + 6, &hours[1]) || text[11])
        return false;
    hours[1] += hours[1] <= hours[0] ? 24 : 0;
    return true;
}

bool cli_clock_check(struct cli_session *session, bool film)
{
    const char *clock = session->options->clock;
    double hours[2];
    if (!clock)
        return true;
    if (!parse(clock, hours))
        return cli_fail(session, "--clock %s: found no hour like 17:30, or of a film two like 05:00-21:00", clock);
    return film || hours[0] == hours[1] ||
           cli_fail(session, "--clock %s: a still has one hour; for a film name a .mp4 or a pattern like frame-%%05d.png",
                    clock);
}

enum wd_result cli_clock_sun(const struct cli_session *session, const struct wd_forest *forest, double share,
                             struct wd_sun *sun)
{
    double hours[2] = {0, 0};
    parse(session->options->clock, hours);
    return wd_forest_sun_at(forest, hours[0] + share * (hours[1] - hours[0]), sun);
}
