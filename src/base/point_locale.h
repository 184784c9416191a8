/* point_locale.h: numbers with a decimal point, as files have them, whatever locale the program that
 * weald is part of has set. */
#ifndef WD_BASE_POINT_LOCALE_H
#define WD_BASE_POINT_LOCALE_H

#include <locale.h>

/* Of the calling thread alone, from enter to leave. */
struct wd_point_locale {
    locale_t own, before;
};
void wd_point_locale_enter(struct wd_point_locale *point);
void wd_point_locale_leave(struct wd_point_locale *point);

#endif
