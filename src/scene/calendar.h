/* calendar.h: date, time and place: the sun's position and the season. */
#ifndef WD_SCENE_CALENDAR_H
#define WD_SCENE_CALENDAR_H

#include <stdbool.h>

struct wd_moment {
    int year, month, day; /* Gregorian; 1 is January */
    double hours;         /* since midnight, universal time; below 0 or over 24 is another day */
};

/* Reads "YYYY-MM-DD"; false for anything else and for days that no calendar has. */
bool wd_date_parse(struct wd_moment *moment, const char *text);
/* Reads "HH:MM" or "HH:MM:SS", 00:00 to 24:00, into hours. */
bool wd_clock_parse(double *hours, const char *text);

/* 1: the first of January at 0:00 .. 13: the end of December. */
double wd_month_of(const struct wd_moment *moment);

/* Azimuth (clockwise from north) and elevation of the sun's centre, with refraction by air of 10 C
 * and 1010 hPa, after the Astronomical Almanac's low precision formulas: within 0.02 degrees from
 * 1950 to 2050. Latitude north and longitude east in degrees. */
void wd_sun_position(const struct wd_moment *moment, double latitude_deg, double longitude_deg,
                     double *azimuth_deg, double *elevation_deg);

#endif
