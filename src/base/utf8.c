#include "base/utf8.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static bool follows(uint8_t byte)
{
    return (byte & 0xc0) == 0x80;
}

size_t wd_utf8_length(const char *text, size_t size)
{
    const uint8_t *at = (const uint8_t *)text;
    if (size == 0)
        return 0;
    size_t length = at[0] < 0x80 ? 1 : at[0] < 0xc2 ? 0 : at[0] < 0xe0 ? 2 : at[0] < 0xf0 ? 3 : at[0] < 0xf5 ? 4 : 0;
    if (length > size)
        return 0;
    for (size_t i = 1; i < length; i++)
        if (!follows(at[i]))
            return 0;
    /* neither longer than it need be, nor half of a pair, nor beyond the last */
    bool wrong = (at[0] == 0xe0 && at[1] < 0xa0) || (at[0] == 0xed && at[1] > 0x9f) ||
                 (at[0] == 0xf0 && at[1] < 0x90) || (at[0] == 0xf4 && at[1] > 0x8f);
    return wrong ? 0 : length;
}

/* As C writes the byte. */
static size_t escape(char piece[8], uint8_t byte)
{
    static const char letters[][2] = {{'\n', 'n'}, {'\t', 't'}, {'\r', 'r'}};
    for (size_t i = 0; i < sizeof letters / sizeof *letters; i++)
        if (byte == (uint8_t)letters[i][0])
            return (size_t)snprintf(piece, 8, "\\%c", letters[i][1]);
    return (size_t)snprintf(piece, 8, "\\x%02x", byte);
}

void wd_utf8_line(char *to, size_t room, const char *text)
{
    size_t left = strlen(text), used = 0;
    while (left > 0) {
        char piece[8];
        uint8_t first = (uint8_t)*text;
        size_t length = wd_utf8_length(text, left), wide = length;
        if (length == 0 || first < 0x20 || first == 0x7f) {
            wide = escape(piece, first);
            length = 1;
        } else {
            memcpy(piece, text, length);
        }
        if (used + wide >= room)
            break;
        memcpy(to + used, piece, wide);
        used += wide;
        text += length;
        left -= length;
    }
    to[used] = '\0';
}
