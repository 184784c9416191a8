/* What date, clock and place mean for a scene: sun and season. */
#include "scene/scene_parts.h"

#include <math.h>

#include "scene/calendar.h"

static const double DEFAULT_AZIMUTH_DEG = 150, DEFAULT_ELEVATION_DEG = 35;

bool wd_scene_check_time(void *object, const struct wd_keys_place *place)
{
    const struct wd_scene_time *time = object;
    struct wd_moment moment;
    double hours;
    if (time->date && !wd_date_parse(&moment, time->date))
        return wd_keys_error(place, "date", "found \"%.60s\"; allowed is a day of the calendar as "
                             "\"YYYY-MM-DD\"", time->date);
    if (time->clock && !wd_clock_parse(&hours, time->clock))
        return wd_keys_error(place, "clock", "found \"%.60s\"; allowed is \"HH:MM\" or "
                             "\"HH:MM:SS\" from 00:00 to 24:00", time->clock);
    if (time->clock && (!time->date || isnan(time->latitude_deg) || isnan(time->longitude_deg)))
        return wd_keys_error(place, "clock", "the sun's position needs \"date\", \"latitude_deg\" "
                             "and \"longitude_deg\" beside it");
    return true;
}

bool wd_scene_sun_at(const struct wd_scene *scene, double hour, double *azimuth_deg, double *elevation_deg)
{
    const struct wd_scene_time *time = &scene->time;
    struct wd_moment moment;
    double offset = isnan(time->utc_offset_h) ? floor(time->longitude_deg / 15 + 0.5)
                                              : time->utc_offset_h;
    if (!time->date || !wd_date_parse(&moment, time->date) || isnan(time->latitude_deg + time->longitude_deg))
        return false;
    moment.hours = hour - offset;
    wd_sun_position(&moment, time->latitude_deg, time->longitude_deg, azimuth_deg, elevation_deg);
    return true;
}

/* Species show the season, but for artists' models, which tell of one alone; south of the equator it is half
 * a year later. */
static bool set_season(struct wd_scene *scene, const struct wd_moment *moment,
                       const struct wd_log *log)
{
    double month = wd_month_of(moment);
    if (scene->time.latitude_deg < 0)
        month = month < 7 ? month + 6 : month - 6;
    bool ok = true;
    for (size_t i = 0; i < scene->species_file_count; i++) {
        struct wd_species species = scene->species[i];
        if (species.model.file)
            continue;
        ok = wd_species_in_month(&scene->species[i], &species, month, log) && ok;
    }
    return ok;
}

bool wd_scene_apply_time(struct wd_scene *scene, const struct wd_keys_place *place)
{
    struct wd_moment moment;
    bool placed = !isnan(scene->sun.azimuth_deg) || !isnan(scene->sun.elevation_deg);
    if (scene->time.clock && placed)
        return wd_keys_error(place, "sun", "found azimuth_deg or elevation_deg beside a \"clock\" "
                             "in \"time\"; allowed is one of the two");
    if (isnan(scene->sun.azimuth_deg))
        scene->sun.azimuth_deg = DEFAULT_AZIMUTH_DEG;
    if (isnan(scene->sun.elevation_deg))
        scene->sun.elevation_deg = DEFAULT_ELEVATION_DEG;
    if (!scene->time.date || !wd_date_parse(&moment, scene->time.date))
        return true; /* a wrong one has been reported */
    double hour;
    if (scene->time.clock && wd_clock_parse(&hour, scene->time.clock))
        wd_scene_sun_at(scene, hour, &scene->sun.azimuth_deg, &scene->sun.elevation_deg);
    return set_season(scene, &moment, wd_keys_log(place));
}
