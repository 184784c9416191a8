#include "scene/species.h"

#include <math.h>

/* Months that unfolding, turning and falling take. */
#define UNFOLD_MONTHS 0.8
#define YOUNG_MONTHS 1.6
#define TURN_MONTHS 1.5
#define FALL_MONTHS 0.7

/* Of a tuft's blades, so many are left in winter. */
#define WINTER_STRAW 0.6

struct season {
    double leaves, young, turned, flowers; /* shares, 0..1 */
};

static double ramp(double from, double to, double at)
{
    double t = (at - from) / (to - from);
    return t < 0 ? 0 : t > 1 ? 1 : t * t * (3 - 2 * t);
}

static double mix(double a, double b, double t)
{
    return a + (b - a) * t;
}

static bool in_flower(const struct wd_species *species, double month)
{
    double first = (double)species->flower.months[0], last = (double)species->flower.months[1];
    double end = last == floor(last) ? last + 1 : last; /* 5: with May; 5.4: within it */
    if (first <= last)
        return month >= first && month < end;
    return month >= first || month < end;
}

static struct season season_of(const struct wd_species *species, double month)
{
    struct season season = {1, 0, 0, in_flower(species, month) ? 1 : 0};
    double out = (double)species->leaf.months[0], fall = (double)species->leaf.months[1];
    season.young = 1 - ramp(out + 0.5 * UNFOLD_MONTHS, out + YOUNG_MONTHS, month);
    if (species->leaf.evergreen) {
        season.young = month < out ? 0 : 0.4 * season.young; /* only this year's shoots */
        return season;
    }
    season.leaves = ramp(out, out + UNFOLD_MONTHS, month) *
                    (1 - ramp(fall - FALL_MONTHS, fall, month));
    season.turned = ramp(fall - TURN_MONTHS - FALL_MONTHS, fall - FALL_MONTHS, month);
    if (species->form == WD_FORM_GRASS) { /* straw stands until new blades have come up */
        season.leaves = fmax(season.leaves, WINTER_STRAW);
        season.turned = fmax(season.turned, 1 - ramp(out, out + UNFOLD_MONTHS, month));
    }
    return season;
}

/* The back and the light let through follow the upper side, as far as leaves can. */
static void turn_colors(struct wd_species *leafy, const struct season *season)
{
    for (int i = 0; i < 3; i++) {
        double summer = (double)leafy->leaf.color[i];
        double color = mix(summer, (double)leafy->leaf.spring_color[i], season->young);
        color = mix(color, (double)leafy->leaf.autumn_color[i], season->turned);
        double change = summer > 0 ? color / summer : 1;
        leafy->leaf.color[i] = (float)color;
        leafy->leaf.back_color[i] = (float)fmin((double)leafy->leaf.back_color[i] * change, 0.6);
        leafy->leaf.transmittance[i] =
            (float)fmin((double)leafy->leaf.transmittance[i] * change, 0.35);
    }
}

/* Trees of a stand turn over some four weeks. */
static void spread_season(struct wd_species *leafy, const struct wd_species *species, double month)
{
    static const double apart[2] = {-0.5, 0.5};
    double own = fmax(season_of(species, month).leaves, 1e-3);
    for (int i = 0; i < 2; i++) {
        struct season season = season_of(species, fmin(fmax(month + apart[i], 1), 13));
        struct wd_species other = *species;
        turn_colors(&other, &season);
        for (int k = 0; k < 3; k++) {
            double change = (double)other.leaf.color[k] / fmax((double)leafy->leaf.color[k], 1e-3);
            leafy->leaf.season_color[i][k] = (float)fmin(fmax(change, 0.3), 1.8);
        }
        leafy->leaf.season_count[i] = (float)fmin(season.leaves / own, 1 / own);
    }
}

bool wd_species_in_month(struct wd_species *seasonal, const struct wd_species *species,
                         double month, const struct wd_log *log)
{
    if (!(month >= 1 && month <= 13))
        return wd_error(log, "cannot show %s in month %g; allowed are 1 to 13", species->name,
                        month);
    struct season season = season_of(species, month);
    *seasonal = *species;
    turn_colors(seasonal, &season);
    spread_season(seasonal, species, month);
    seasonal->leaf.count = (int64_t)(season.leaves * (double)species->leaf.count);
    seasonal->leaf.area_index *= (float)season.leaves;
    seasonal->flower.count = (int64_t)(season.flowers * (double)species->flower.count);
    return true;
}
