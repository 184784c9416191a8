#include "base/point_locale.h"

void wd_point_locale_enter(struct wd_point_locale *point)
{
    point->own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    point->before = uselocale(point->own); /* without memory for an own one all stays as it is */
}

void wd_point_locale_leave(struct wd_point_locale *point)
{
    uselocale(point->before);
    if (point->own)
        freelocale(point->own);
    *point = (struct wd_point_locale){0};
}
