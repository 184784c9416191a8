/* sun.c: where the sun stands, and will. */
#include <math.h>

#include "api/arguments.h"
#include "api/forest.h"
#include "base/dmath.h"
#include "base/log.h"
#include "world/sun.h"

static const double DEGREE = WD_PI / 180, HOUR = 15 * (WD_PI / 180); /* of which the earth turns in one */
static const double USUAL_LATITUDE_DEG = 45;

struct wd_sun wd_forest_sun(const struct wd_forest *forest)
{
    return wd_sun_of(&forest->scene);
}

bool wd_forest_sun_moves(const struct wd_forest *forest)
{
    return forest->world.sky.width == 0;
}

enum wd_result wd_forest_sun_at(const struct wd_forest *forest, double hour, struct wd_sun *sun)
{
    if (!(hour >= -24 && hour <= 48)) {
        wd_error(&forest->log, "hour is %g: -24 to 48 are possible", hour);
        return WD_ERROR_INPUT;
    }
    if (wd_scene_sun_at(&forest->scene, hour, &sun->azimuth_deg, &sun->elevation_deg))
        return WD_OK;
    wd_error(&forest->log, "the sun's place at an hour needs date, latitude_deg and longitude_deg in \"time\" of the scene");
    return WD_ERROR_INPUT;
}

/* Its distance from the pole stays, and the angle about it grows with time. */
struct wd_sun wd_forest_sun_later(const struct wd_forest *forest, const struct wd_sun *sun, double hours)
{
    double given_deg = forest->scene.time.latitude_deg;
    double latitude = DEGREE * (isnan(given_deg) ? USUAL_LATITUDE_DEG : given_deg);
    double azimuth = DEGREE * sun->azimuth_deg, elevation = DEGREE * sun->elevation_deg;
    double north = cos(elevation) * cos(azimuth), east = cos(elevation) * sin(azimuth), up = sin(elevation);
    double pole = north * cos(latitude) + up * sin(latitude);   /* along the axis, */
    double noon = -north * sin(latitude) + up * cos(latitude); /* and across it */
    double angle = atan2(-east, noon) + HOUR * hours, across = hypot(noon, east);
    noon = across * cos(angle);
    north = pole * cos(latitude) - noon * sin(latitude);
    up = pole * sin(latitude) + noon * cos(latitude);
    azimuth = atan2(-across * sin(angle), north) / DEGREE;
    return (struct wd_sun){azimuth < 0 ? azimuth + 360 : azimuth, asin(fmin(fmax(up, -1), 1)) / DEGREE};
}
