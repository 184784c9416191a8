#include "scene/calendar.h"

#include <math.h>
#include <string.h>

#include "base/dmath.h"

static const double DEGREE = WD_PI / 180;

/* --- reading ----------------------------------------------------------------------------- */

/* `digits` digits at *text, then the character `end`; moves *text beyond. -1 where they are not. */
static int number(const char **text, int digits, char end)
{
    int value = 0;
    for (int i = 0; i < digits; i++) {
        char c = (*text)[i];
        if (c < '0' || c > '9')
            return -1;
        value = 10 * value + (c - '0');
    }
    if ((*text)[digits] != end)
        return -1;
    *text += digits + (end != '\0');
    return value;
}

static int days_in(int year, int month)
{
    static const int days[12] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    return days[month - 1] + (month == 2 && leap);
}

bool wd_date_parse(struct wd_moment *moment, const char *text)
{
    int year = number(&text, 4, '-');
    int month = year < 0 ? -1 : number(&text, 2, '-');
    int day = month < 1 || month > 12 ? -1 : number(&text, 2, '\0');
    if (day < 1 || day > days_in(year, month))
        return false;
    *moment = (struct wd_moment){year, month, day, 0};
    return true;
}

bool wd_clock_parse(double *hours, const char *text)
{
    bool seconds_given = strlen(text) == 8;
    int hour = number(&text, 2, ':');
    int minute = hour < 0 ? -1 : number(&text, 2, seconds_given ? ':' : '\0');
    int second = minute < 0 ? -1 : seconds_given ? number(&text, 2, '\0') : 0;
    if (second < 0 || minute > 59 || second > 59 || 3600 * hour + 60 * minute + second > 86400)
        return false;
    *hours = hour + minute / 60.0 + second / 3600.0;
    return true;
}

/* --- the year ---------------------------------------------------------------------------- */

double wd_month_of(const struct wd_moment *moment)
{
    return moment->month + (moment->day - 1) / (double)days_in(moment->year, moment->month);
}

/* Days since 2000-01-01 12:00 (Fliegel and Van Flandern 1968). */
static double days_since_2000(const struct wd_moment *moment)
{
    long y = moment->year, m = moment->month, d = moment->day;
    long a = (m - 14) / 12;
    long julian = (1461 * (y + 4800 + a)) / 4 + (367 * (m - 2 - 12 * a)) / 12 -
                  (3 * ((y + 4900 + a) / 100)) / 4 + d - 32075;
    return (double)(julian - 2451545) + (moment->hours - 12) / 24;
}

/* What air adds to a true elevation (Saemundsson 1986). */
static double refraction_deg(double elevation_deg)
{
    if (elevation_deg < -1)
        return 0;
    double at = (elevation_deg + 10.3 / (elevation_deg + 5.11)) * DEGREE;
    return 1.02 / 60 * wd_dcos(at) / wd_dsin(at);
}

void wd_sun_position(const struct wd_moment *moment, double latitude_deg, double longitude_deg,
                     double *azimuth_deg, double *elevation_deg)
{
    double n = days_since_2000(moment);
    double mean = (280.460 + 0.9856474 * n) * DEGREE, anomaly = (357.528 + 0.9856003 * n) * DEGREE;
    double ecliptic =
        mean + (1.915 * wd_dsin(anomaly) + 0.020 * wd_dsin(2 * anomaly)) * DEGREE;
    double tilt = (23.439 - 0.0000004 * n) * DEGREE;
    double along = wd_dcos(ecliptic), aside = wd_dcos(tilt) * wd_dsin(ecliptic);
    double sin_rise = wd_dsin(tilt) * wd_dsin(ecliptic);
    double cos_rise = sqrt(1 - sin_rise * sin_rise); /* of the declination */
    double sidereal = fmod(18.697374558 + 24.06570982441908 * n, 24.0) * 15;
    double hour = (sidereal + longitude_deg) * DEGREE - wd_datan2(aside, along);
    double sin_place = wd_dsin(latitude_deg * DEGREE), cos_place = wd_dcos(latitude_deg * DEGREE);
    double up = sin_place * sin_rise + cos_place * cos_rise * wd_dcos(hour);
    double north = cos_place * sin_rise - sin_place * cos_rise * wd_dcos(hour);
    double east = -cos_rise * wd_dsin(hour);
    double elevation = wd_datan2(up, sqrt(north * north + east * east)) / DEGREE;
    double azimuth = wd_datan2(east, north) / DEGREE;
    *azimuth_deg = azimuth < 0 ? azimuth + 360 : azimuth;
    *elevation_deg = elevation + refraction_deg(elevation);
}
