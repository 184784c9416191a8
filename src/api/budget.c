/* Time of a frame is taken as a + b / error^2, for discs are as many as 1 / error^2. */
#include <math.h>

#include "weald/renderer.h"

static const double FIRST_ERROR_PX = 2.0;
/* Aimed at, and how far above or below it nothing is changed: the noise of clocks must not be
 * followed. */
static const double AIM = 0.92, HELD = 0.07;
/* Frames that a change is given to show in the times told, which may be two frames late: none is ever
 * weighed against the wrong error, and so nothing oscillates. */
enum { SETTLING = 2 };
static const double FIRST_SHARE = 0.7, LEAST_SHARE = 0.3; /* of wd_budget.share */
static const double GAIN = 0.9, MOST_STEP = 2.5;
/* From so great a change of the discs' logarithm on something is learned of their share, half of what it tells. */
static const double CLEAR_CHANGE = 0.2, LEARNED = 0.5;

struct wd_budget wd_budget_of(double target_ms)
{
    return (struct wd_budget){
        .target_ms = target_ms, .error_px = FIRST_ERROR_PX, .share = FIRST_SHARE};
}

static double clamped(double value, double least, double most)
{
    return fmin(fmax(value, least), most);
}

/* How much of the time went with the discs, where the error has changed clearly. */
static void learn_share(struct wd_budget *budget, double frame_ms)
{
    if (budget->weighed_ms <= 0.0)
        return;
    double discs = 2.0 * log(budget->weighed_error_px / budget->error_px);
    if (fabs(discs) < CLEAR_CHANGE)
        return;
    double told = clamped(log(frame_ms / budget->weighed_ms) / discs, LEAST_SHARE, 1.0);
    budget->share += LEARNED * (told - budget->share);
}

double wd_budget_next(struct wd_budget *budget, double frame_ms)
{
    if (!(frame_ms > 0.0) || !isfinite(frame_ms))
        return budget->error_px;
    if (budget->settling > 0) {
        budget->settling--;
        return budget->error_px;
    }
    learn_share(budget, frame_ms);
    budget->weighed_ms = frame_ms;
    budget->weighed_error_px = budget->error_px;
    double over = frame_ms / (AIM * budget->target_ms);
    if (fabs(over - 1.0) <= HELD)
        return budget->error_px;
    double step = clamped(pow(over, 0.5 * GAIN / budget->share), 1.0 / MOST_STEP, MOST_STEP);
    budget->error_px = clamped(budget->error_px * step, WD_LEAST_ERROR_PX, WD_MOST_ERROR_PX);
    budget->settling = SETTLING;
    return budget->error_px;
}
