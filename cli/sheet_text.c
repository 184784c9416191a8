/* Letters of sheets: five by eight dots, small letters only. */
#include <ctype.h>
#include <string.h>

#include "sheet.h"

enum { GLYPH_WIDTH = 5, GLYPH_HEIGHT = 8 };

static const struct glyph {
    char letter;
    unsigned char rows[GLYPH_HEIGHT]; /* bit 4 is the leftmost dot */
} glyphs[] = {
    {'a', {0, 0, 14, 1, 15, 17, 15, 0}},     {'b', {16, 16, 30, 17, 17, 17, 30, 0}},
    {'c', {0, 0, 14, 17, 16, 17, 14, 0}},    {'d', {1, 1, 15, 17, 17, 17, 15, 0}},
    {'e', {0, 0, 14, 17, 31, 16, 14, 0}},    {'f', {6, 9, 8, 28, 8, 8, 8, 0}},
    {'g', {0, 0, 15, 17, 17, 15, 1, 14}},    {'h', {16, 16, 30, 17, 17, 17, 17, 0}},
    {'i', {4, 0, 12, 4, 4, 4, 14, 0}},       {'j', {2, 0, 6, 2, 2, 2, 18, 12}},
    {'k', {16, 16, 18, 20, 24, 20, 18, 0}},  {'l', {12, 4, 4, 4, 4, 4, 14, 0}},
    {'m', {0, 0, 26, 21, 21, 21, 21, 0}},    {'n', {0, 0, 30, 17, 17, 17, 17, 0}},
    {'o', {0, 0, 14, 17, 17, 17, 14, 0}},    {'p', {0, 0, 30, 17, 17, 30, 16, 16}},
    {'q', {0, 0, 15, 17, 17, 15, 1, 1}},     {'r', {0, 0, 22, 25, 16, 16, 16, 0}},
    {'s', {0, 0, 15, 16, 14, 1, 30, 0}},     {'t', {8, 8, 28, 8, 8, 9, 6, 0}},
    {'u', {0, 0, 17, 17, 17, 19, 13, 0}},    {'v', {0, 0, 17, 17, 17, 10, 4, 0}},
    {'w', {0, 0, 17, 17, 21, 21, 10, 0}},    {'x', {0, 0, 17, 10, 4, 10, 17, 0}},
    {'y', {0, 0, 17, 17, 17, 15, 1, 14}},    {'z', {0, 0, 31, 2, 4, 8, 31, 0}},
    {'0', {14, 17, 19, 21, 25, 17, 14, 0}},  {'1', {4, 12, 4, 4, 4, 4, 14, 0}},
    {'2', {14, 17, 1, 6, 8, 16, 31, 0}},     {'3', {14, 17, 1, 6, 1, 17, 14, 0}},
    {'4', {2, 6, 10, 18, 31, 2, 2, 0}},      {'5', {31, 16, 30, 1, 1, 17, 14, 0}},
    {'6', {6, 8, 16, 30, 17, 17, 14, 0}},    {'7', {31, 1, 2, 4, 8, 8, 8, 0}},
    {'8', {14, 17, 17, 14, 17, 17, 14, 0}},  {'9', {14, 17, 17, 15, 1, 2, 12, 0}},
    {'.', {0, 0, 0, 0, 0, 12, 12, 0}},       {',', {0, 0, 0, 0, 12, 12, 4, 8}},
    {'%', {24, 25, 2, 4, 8, 19, 3, 0}},      {'+', {0, 4, 4, 31, 4, 4, 0, 0}},
    {'-', {0, 0, 0, 31, 0, 0, 0, 0}},        {'(', {2, 4, 8, 8, 8, 4, 2, 0}},
    {')', {8, 4, 2, 2, 2, 4, 8, 0}},         {'/', {1, 1, 2, 4, 8, 16, 16, 0}},
    {':', {0, 12, 12, 0, 12, 12, 0, 0}},     {'_', {0, 0, 0, 0, 0, 0, 0, 31}},
};

static const struct glyph *glyph_of(char letter)
{
    char wanted = (char)tolower((unsigned char)letter);
    for (size_t i = 0; i < sizeof glyphs / sizeof *glyphs; i++)
        if (glyphs[i].letter == wanted)
            return &glyphs[i];
    return NULL;
}

static void put_dot(struct wd_picture *picture, uint32_t x, uint32_t y, uint32_t scale)
{
    static const uint8_t ink[4] = {35, 35, 35, 255};
    for (uint32_t j = y; j < y + scale && j < picture->height; j++)
        for (uint32_t i = x; i < x + scale && i < picture->width; i++)
            memcpy(picture->display + 4 * ((size_t)j * picture->width + i), ink, sizeof ink);
}

void cli_sheet_text(struct wd_picture *picture, uint32_t x, uint32_t y, uint32_t scale,
                    const char *text)
{
    for (; *text; text++, x += (GLYPH_WIDTH + 1) * scale) {
        const struct glyph *glyph = glyph_of(*text);
        for (uint32_t row = 0; glyph && row < GLYPH_HEIGHT; row++)
            for (uint32_t column = 0; column < GLYPH_WIDTH; column++)
                if (glyph->rows[row] >> (GLYPH_WIDTH - 1 - column) & 1)
                    put_dot(picture, x + column * scale, y + row * scale, scale);
    }
}
