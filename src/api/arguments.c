#include "api/arguments.h"

#include <inttypes.h>
#include <math.h>

#include "base/dmath.h"
#include "base/log.h"
#include "world/world.h"

static const double MOST_S = 1.0e9;
static const double DEGREE = WD_PI / 180.0;

bool wd_check_given(const void *pointer, const char *function, const char *name,
                    const struct wd_log *log)
{
    return pointer || wd_error(log, "%s: %s is NULL; it is required", function, name);
}

bool wd_check_size(uint32_t width, uint32_t height, const struct wd_log *log)
{
    if (width < 1 || width > WD_MOST_SIZE_PX || height < 1 || height > WD_MOST_SIZE_PX)
        return wd_error(log, "picture of %u x %u pixels: 1 to %d each way are possible", width,
                        height, WD_MOST_SIZE_PX);
    return true;
}

bool wd_check_samples(uint32_t samples, uint32_t most, const struct wd_log *log)
{
    return samples <= most || wd_error(log, "%u samples: at most %u are possible", samples, most);
}

bool wd_check_camera(const struct wd_camera *camera, const char *name, const struct wd_log *log)
{
    const double *at = camera->position_m, fov_deg = camera->fov_rad / DEGREE;
    const double rounding_deg = 1e-9; /* of bounds that come as radians */
    for (int k = 0; k < 3; k++) {
        if (!(fabs(at[k]) < WD_MOST_PLACE_M))
            return wd_error(log,
                            "%s.position_m is %g, %g, %g: within 2,000 km of the origin is possible",
                            name, at[0], at[1], at[2]);
    }
    if (!isfinite(camera->yaw_rad) || !isfinite(camera->pitch_rad))
        return wd_error(log, "%s.yaw_rad is %g and %s.pitch_rad %g: both must be finite", name,
                        camera->yaw_rad, name, camera->pitch_rad);
    if (!(fov_deg >= WD_LEAST_FOV_DEG - rounding_deg && fov_deg <= WD_MOST_FOV_DEG + rounding_deg))
        return wd_error(log,
                        "%s.fov_rad is %g: a field of view of %.5f to %.5f radians (%g to %g "
                        "degrees) is possible",
                        name, camera->fov_rad, WD_LEAST_FOV_DEG * DEGREE, WD_MOST_FOV_DEG * DEGREE,
                        WD_LEAST_FOV_DEG, WD_MOST_FOV_DEG);
    return true;
}

bool wd_check_time(double time_s, const char *name, const struct wd_log *log)
{
    return fabs(time_s) <= MOST_S ||
           wd_error(log, "%s is %g: within %g s of 0 is possible", name, time_s, MOST_S);
}

bool wd_check_sun(const struct wd_sun *sun, const struct wd_world *world, const struct wd_log *log)
{
    if (!sun)
        return true;
    if (world->sky.width)
        return wd_error(log, "sun is given: only the scene's own is possible under a sky map, whose light does not move");
    if (!isfinite(sun->azimuth_deg))
        return wd_error(log, "sun.azimuth_deg is %g: it must be finite", sun->azimuth_deg);
    return fabs(sun->elevation_deg) <= 90 ||
           wd_error(log, "sun.elevation_deg is %g: -90 to 90 are possible", sun->elevation_deg);
}

bool wd_check_choice(int64_t value, int64_t count, const char *name, const struct wd_log *log)
{
    return (value >= 0 && value < count) ||
           wd_error(log, "%s is %" PRId64 ": 0 to %" PRId64 " are possible", name, value, count - 1);
}

bool wd_check_layers(uint32_t layers, const struct wd_log *log)
{
    const uint32_t known = WD_LAYER_ALL | WD_LAYER_CRYPTOMATTE;
    return !(layers & ~known) ||
           wd_error(log, "layers has the unknown bits 0x%x: those of 0x%x are possible",
                    layers & ~known, known);
}
