/* keys.h: one table a JSON object says what keys it has; reading, defaults, errors with
 * file:line:column, "did you mean" and the published JSON Schema all follow from it. */
#ifndef WD_SCENE_KEYS_H
#define WD_SCENE_KEYS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/log.h"
#include "base/memory.h"

enum wd_key_kind {
    WD_KEY_DOUBLE,  /* double */
    WD_KEY_FLOAT,   /* float */
    WD_KEY_INTEGER, /* int64_t */
    WD_KEY_BOOL,    /* bool */
    WD_KEY_STRING,  /* const char *, in the arena; NULL when absent without default; one of
                       `choices` where there are any */
    WD_KEY_ENUM,    /* int: index into `choices` */
    WD_KEY_RANGE,   /* float[2]: a number n (becomes n, n) or [min, max], min <= max */
    WD_KEY_VECTOR,  /* double[length] */
    WD_KEY_FLOATS,  /* float[length] */
    WD_KEY_COLOR,   /* float[3], linear sRGB: [r, g, b] in 0..1 linear, or "#rrggbb" (sRGB) */
    WD_KEY_OBJECT,  /* struct of `table` */
    WD_KEY_LIST,    /* pointer to items of `table` (in the arena) and size_t at count_offset */
    WD_KEY_MAP,     /* as LIST, from an object with free names; each item's first member is
                       `const char *name` */
    WD_KEY_STRINGS, /* const char ** and size_t at count_offset; a lone string is a list of one */
    WD_KEY_INTEGERS,/* int64_t * and size_t at count_offset; a lone number is a list of one */
    WD_KEY_NUMBERS, /* double * and size_t at count_offset; `length` of them unless that is 0 */
    WD_KEY_STRING_MAP, /* struct wd_string_pair * and size_t at count_offset: free names -> text */
    WD_KEY_NUMBER_MAP, /* struct wd_number_pair * and size_t at count_offset: free names ->
                          numbers; a lone string is one name with the number 1 */
};

struct wd_string_pair {
    const char *name;
    const char *value;
};

struct wd_number_pair {
    const char *name;
    double value;
};

enum wd_key_flag {
    WD_KEY_REQUIRED = 1 << 0,
    WD_KEY_EXCLUSIVE_MIN = 1 << 1, /* value > min, not >= */
    WD_KEY_NAN_IF_ABSENT = 1 << 2, /* DOUBLE without a default: NaN, not 0 */
    WD_KEY_SORTED = 1 << 3,        /* VECTOR: no part may be less than the one before */
};

struct wd_keys;
struct wd_keys_reader;

/* Where in the file the reader is: a chain from the innermost object or list item to the root. A
 * check makes the places of children itself: {place->reader, place, "layers", 0}, then
 * {place->reader, &that, NULL, 2}. */
struct wd_keys_place {
    struct wd_keys_reader *reader;
    const struct wd_keys_place *parent; /* NULL: the root */
    const char *key;                    /* NULL in a list */
    size_t index;
};

struct wd_key {
    const char *name;
    enum wd_key_kind kind;
    size_t offset;       /* of the member in the struct */
    double min, max;     /* numbers and each part of ranges, vectors, lists and maps of numbers;
                            either may be infinite; both 0: any finite value */
    const char *fallback; /* default as JSON text; NULL: zero bytes (an OBJECT still gets its keys'
                             own defaults) */
    const char *doc;     /* one sentence with the unit; goes into the schema */
    const char *const *choices; /* ENUM: NULL-terminated */
    const struct wd_keys *table; /* OBJECT, LIST, MAP */
    size_t count_offset;
    size_t length;       /* VECTOR, FLOATS: number of parts */
    unsigned flags;
    const char *row;     /* of docs/methods.md: what of a paper it stands for; or NULL */
};
struct wd_keys {
    const char *title;
    const struct wd_key *keys; /* ends with .name == NULL */
    size_t size;               /* sizeof the struct it fills */
    /* Checks across keys, or NULL; reports with wd_keys_error and returns false. */
    bool (*check)(void *object, const struct wd_keys_place *place);
    bool check_always;         /* even after errors in its keys: their members may be zero, and
                                  arrays hold zeroed items */
};

/* Logs "file:line:column: path.key: message". `key` NULL points at the object itself. Returns false. */
bool wd_keys_error(const struct wd_keys_place *place, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The same as a warning. */
void wd_keys_warn(const struct wd_keys_place *place, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Whether the file, or a setting, says something at `key` of the object at `place`: else its default counts. */
bool wd_keys_given(const struct wd_keys_place *place, const char *key);

/* For checks: what the reader was given. */
const char *wd_keys_path(const struct wd_keys_place *place);
struct wd_arena *wd_keys_arena(const struct wd_keys_place *place);
const struct wd_log *wd_keys_log(const struct wd_keys_place *place);
const void *wd_keys_user(const struct wd_keys_place *place);

/* Reads JSON with // and block comments from memory into `object` (table->size bytes). `path`
 * names the file in messages. Everything allocated lives in `arena`. Every error is logged with
 * file:line:column, the key's path, what was found and what is allowed; unknown keys are errors
 * with a "did you mean". */
bool wd_keys_read(const struct wd_keys *table, const char *path, const char *text, size_t size,
                  struct wd_arena *arena, const struct wd_log *log, void *object);

/* A file's text and what goes with it. */
struct wd_keys_input {
    const char *path, *text;
    size_t size;
    const void *user; /* for the checks: wd_keys_user */
    /* "key.key=value" each, in place of what the text says, ended by NULL; or NULL. The value is
     * JSON, or else a text. A number, "list.0" or "list[0]", stands for an item of a list; "@key" for what the root's key
     * says, so that "methods.@method.depth=7" sets an option of the chosen method. Errors of a
     * value that was set, and within it, name the setting instead of a line. */
    const char *const *settings;
};
bool wd_keys_read_input(const struct wd_keys *table, const struct wd_keys_input *input,
                        struct wd_arena *arena, const struct wd_log *log, void *object);

/* The JSON Schema (draft 2020-12) of a table, as text; its $id is urn:weald:NAME. free() it. */
char *wd_keys_schema(const struct wd_keys *table, const char *name);

#endif
