/* json_text.h: JSON as text: comments, encodings, and where a value stands in the file. */
#ifndef WD_SCENE_JSON_TEXT_H
#define WD_SCENE_JSON_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "base/log.h"

/* A line and column, both from 1; columns count characters, not bytes. */
struct wd_json_spot {
    unsigned line, column;
};

/* One step down from an object (key) or from a list (key NULL: index). */
struct wd_json_step {
    const char *key;
    size_t index;
};

/* A copy of `text` in which comments are spaces, so that lines and columns hold. Refuses what is
 * not UTF-8 JSON text (empty, UTF-16, NUL bytes, unclosed comments) with a message; a byte order
 * mark becomes spaces, too. free() the result; NULL after an error. */
char *wd_json_blank_comments(const char *path, const char *text, size_t size,
                             const struct wd_log *log);

/* The offset at which the value at the end of `steps` begins, or its key when `at_key`. Where a step
 * is missing, the deepest value found. `text` is valid JSON without comments. */
size_t wd_json_find(const char *text, size_t size, const struct wd_json_step *steps,
                    size_t step_count, bool at_key);

/* For an offset into the text as it was written, comments and all. */
struct wd_json_spot wd_json_spot_at(const char *text, size_t offset);

#endif
