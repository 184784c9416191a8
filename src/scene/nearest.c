#include "scene/nearest.h"

#include <ctype.h>
#include <string.h>

enum { MAX_LENGTH = 48 };

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Optimal string alignment: insert, drop, change, or swap neighbours; letter case is free. */
static size_t edit_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    size_t rows[3][MAX_LENGTH + 1];
    for (size_t j = 0; j <= b_length; j++)
        rows[0][j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        size_t *row = rows[i % 3], *above = rows[(i + 2) % 3], *above2 = rows[(i + 1) % 3];
        row[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            int x = tolower((unsigned char)a[i - 1]), y = tolower((unsigned char)b[j - 1]);
            row[j] = smaller(smaller(above[j], row[j - 1]) + 1, above[j - 1] + (x != y));
            if (i > 1 && j > 1 && x == tolower((unsigned char)b[j - 2]) &&
                y == tolower((unsigned char)a[i - 2]))
                row[j] = smaller(row[j], above2[j - 2] + 1);
        }
    }
    return rows[a_length % 3][b_length];
}

/* "spacing" for "spacing_m": a whole word of the name, unit or group left out. */
static int is_word_of(const char *word, size_t length, const char *name)
{
    const char *found = length >= 3 ? strstr(name, word) : NULL;
    return found && (found == name || found[-1] == '_') &&
           (found[length] == '\0' || found[length] == '_');
}

const char *wd_nearest_name(const char *wanted, const char *const *names, size_t count)
{
    size_t length = strlen(wanted);
    if (length == 0 || length > MAX_LENGTH)
        return NULL;
    const char *best = NULL;
    size_t best_distance = length / 3 + 2;
    for (size_t i = 0; i < count; i++) {
        size_t name_length = strlen(names[i]);
        if (name_length > MAX_LENGTH)
            continue;
        size_t distance = is_word_of(wanted, length, names[i])
                              ? 1
                              : edit_distance(wanted, length, names[i], name_length);
        if (distance < best_distance && distance < smaller(length, name_length)) {
            best_distance = distance;
            best = names[i];
        }
    }
    return best;
}
