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

/* The letter that a character of two bytes is without its accent; 0: none. */
static char without_accent(const uint8_t *at)
{
    static const char letters[] = "aaaaaaaceeeeiiiidnooooo*ouuuuytsaaaaaaaceeeeiiiidnooooo*ouuuuyty"; /* U+00C0 on */
    return at[0] == 0xc3 && (at[1] & 0x1f) != 0x17 ? letters[at[1] & 0x3f] : 0;
}

void wd_utf8_plain(char *to, size_t room, const char *text, size_t size)
{
    size_t used = 0, length;
    for (size_t i = 0; i < size; i += length) {
        const uint8_t *at = (const uint8_t *)text + i;
        length = wd_utf8_length(text + i, size - i);
        length = length ? length : 1;
        bool combined = length == 2 && (at[0] == 0xcc || (at[0] == 0xcd && at[1] < 0xb0));
        char plain = length == 2 ? without_accent(at) : 0;
        if (length == 2 && at[0] == 0xc2 && at[1] == 0xa0)
            plain = ' ';
        if (length == 1)
            plain = at[0] >= 'A' && at[0] <= 'Z' ? (char)(at[0] + 32) : at[0] >= 9 && at[0] <= 13 ? ' ' : (char)at[0];
        if (combined)
            continue;
        if (used + (plain ? 1 : length) >= room)
            break;
        memcpy(to + used, plain ? &plain : text + i, plain ? 1 : length);
        used += plain ? 1 : length;
    }
    to[used] = '\0';
}
