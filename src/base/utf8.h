/* utf8.h: text that comes from elsewhere. */
#ifndef WD_BASE_UTF8_H
#define WD_BASE_UTF8_H

#include <stddef.h>

/* Bytes of the character at the beginning of `size` bytes; 0: none that is whole and valid (RFC 3629). */
size_t wd_utf8_length(const char *text, size_t size);

/* Copies a text with whatever would break its line or is no UTF-8 as \n, \t, \x1b and the like. Ends it
 * with a zero; cuts it between characters where there is no room. */
void wd_utf8_line(char *to, size_t room, const char *text);

/* Copies `size` bytes of a text as people compare names: Latin letters small and without their accents, whole or
 * combined, a blank for every white space, also the no-break one. Ends it with a zero; cuts it where there is no room. */
void wd_utf8_plain(char *to, size_t room, const char *text, size_t size);

#endif
