/* comma_locale.h: a locale whose numbers have a decimal comma. */
#ifndef WD_TESTS_COMMA_LOCALE_H
#define WD_TESTS_COMMA_LOCALE_H

#include <locale.h>
#include <stddef.h>

/* freelocale() it; 0 where the machine has none. */
static inline locale_t comma_locale(void)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "es_ES.UTF-8",
                                        "it_IT.UTF-8", "pt_BR.UTF-8", "nl_NL.UTF-8", "ru_RU.UTF-8"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        locale_t found = newlocale(LC_NUMERIC_MASK, names[i], (locale_t)0);
        if (found)
            return found;
    }
    return (locale_t)0;
}

#endif
