#include "scene/json_text.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

struct cursor {
    const char *at, *end;
};

/* Some editors put a byte order mark before UTF-8. */
static size_t mark_length(const char *text, size_t size)
{
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

struct wd_json_spot wd_json_spot_at(const char *text, size_t offset)
{
    struct wd_json_spot spot = {1, 1};
    for (size_t i = mark_length(text, offset); i < offset; i++) {
        if (text[i] == '\n') {
            spot.line++;
            spot.column = 1;
        } else if (((unsigned char)text[i] & 0xc0) != 0x80) {
            spot.column++;
        }
    }
    return spot;
}

static const char *encoding_problem(const char *text, size_t size)
{
    const unsigned char *bytes = (const unsigned char *)text;
    if (size >= 2 && ((bytes[0] == 0xff && bytes[1] == 0xfe) ||
                      (bytes[0] == 0xfe && bytes[1] == 0xff)))
        return "is UTF-16 text; save it as UTF-8";
    if (size >= 2 && (!bytes[0] != !bytes[1]))
        return "looks like UTF-16 text; save it as UTF-8";
    return NULL;
}

static void blank(char *text, size_t from, size_t to)
{
    for (size_t i = from; i < to; i++) {
        if (text[i] != '\n')
            text[i] = ' ';
    }
}

static size_t string_end(const char *text, size_t size, size_t at)
{
    for (at++; at < size && text[at] != '"' && text[at] != '\n'; at++) {
        if (text[at] == '\\' && at + 1 < size)
            at++;
    }
    return at < size ? at + 1 : size;
}

static bool blank_all(char *text, size_t size, size_t *unclosed)
{
    for (size_t i = 0; i < size;) {
        if (text[i] == '"') {
            i = string_end(text, size, i);
        } else if (text[i] == '/' && i + 1 < size && text[i + 1] == '/') {
            const char *newline = memchr(text + i, '\n', size - i);
            size_t end = newline ? (size_t)(newline - text) : size;
            blank(text, i, end);
            i = end;
        } else if (text[i] == '/' && i + 1 < size && text[i + 1] == '*') {
            const char *close = i + 2 < size ? memmem(text + i + 2, size - i - 2, "*/", 2) : NULL;
            if (!close) {
                *unclosed = i;
                return false;
            }
            size_t end = (size_t)(close - text) + 2;
            blank(text, i, end);
            i = end;
        } else {
            i++;
        }
    }
    return true;
}

char *wd_json_blank_comments(const char *path, const char *text, size_t size,
                             const struct wd_log *log)
{
    const char *problem = encoding_problem(text, size);
    if (problem) {
        wd_error(log, "%s:1:1: the file %s", path, problem);
        return NULL;
    }
    const char *nul = memchr(text, 0, size);
    if (nul) {
        struct wd_json_spot spot = wd_json_spot_at(text, (size_t)(nul - text));
        wd_error(log, "%s:%u:%u: a NUL byte: this is binary data, not JSON text", path, spot.line,
                 spot.column);
        return NULL;
    }
    size_t mark = mark_length(text, size), blanks = mark;
    while (blanks < size && memchr(" \t\r\n", text[blanks], 4))
        blanks++;
    if (blanks == size) {
        wd_error(log, "%s:1:1: the file is empty; it should hold a JSON object: { ... }", path);
        return NULL;
    }
    char *copy = wd_alloc(size + 1);
    memcpy(copy, text, size);
    blank(copy, 0, mark);
    size_t unclosed = 0;
    if (!blank_all(copy, size, &unclosed)) {
        struct wd_json_spot spot = wd_json_spot_at(text, unclosed);
        wd_error(log, "%s:%u:%u: a /* comment without its */", path, spot.line, spot.column);
        free(copy);
        return NULL;
    }
    return copy;
}

static void skip_space(struct cursor *c)
{
    while (c->at < c->end && memchr(" \t\r\n", *c->at, 4))
        c->at++;
}

static void skip_string(struct cursor *c)
{
    for (c->at++; c->at < c->end && *c->at != '"'; c->at++) {
        if (*c->at == '\\')
            c->at++;
    }
    c->at = c->at < c->end ? c->at + 1 : c->end;
}

/* Iterative, so that no nesting is too deep. */
static void skip_value(struct cursor *c)
{
    size_t depth = 0;
    do {
        skip_space(c);
        if (c->at >= c->end)
            return;
        char here = *c->at;
        if (here == '"') {
            skip_string(c);
        } else if (here == '{' || here == '[') {
            depth++;
            c->at++;
        } else if (here == '}' || here == ']') {
            depth -= depth > 0;
            c->at++;
        } else if (here == ',' || here == ':') {
            c->at++;
        } else {
            while (c->at < c->end && !memchr(" \t\r\n,:]}", *c->at, 8))
                c->at++;
        }
    } while (depth > 0);
}

/* The text between the quotes equals `key` once its escapes are undone. */
static bool key_equals(const char *quoted, size_t size, const char *key)
{
    if (!memchr(quoted, '\\', size))
        return size == strlen(key) + 2 && memcmp(quoted + 1, key, size - 2) == 0;
    json_t *string = json_loadb(quoted, size, JSON_DECODE_ANY, NULL);
    bool equal = json_is_string(string) && strcmp(json_string_value(string), key) == 0;
    json_decref(string);
    return equal;
}

/* From an object's brace to the value of `key`; *key_at is where the key stands. */
static bool enter_key(struct cursor *c, const char *key, const char **key_at)
{
    if (c->at >= c->end || *c->at != '{')
        return false;
    c->at++;
    for (skip_space(c); c->at < c->end && *c->at == '"'; skip_space(c)) {
        *key_at = c->at;
        skip_string(c);
        bool found = key_equals(*key_at, (size_t)(c->at - *key_at), key);
        skip_space(c);
        c->at += c->at < c->end; /* the colon */
        skip_space(c);
        if (found)
            return true;
        skip_value(c);
        skip_space(c);
        if (c->at < c->end && *c->at == ',')
            c->at++;
    }
    return false;
}

static bool enter_index(struct cursor *c, size_t index)
{
    if (c->at >= c->end || *c->at != '[')
        return false;
    c->at++;
    for (size_t i = 0;; i++) {
        skip_space(c);
        if (c->at >= c->end || *c->at == ']')
            return false;
        if (i == index)
            return true;
        skip_value(c);
        skip_space(c);
        if (c->at < c->end && *c->at == ',')
            c->at++;
    }
}

size_t wd_json_find(const char *text, size_t size, const struct wd_json_step *steps,
                    size_t step_count, bool at_key)
{
    struct cursor c = {text, text + size};
    skip_space(&c);
    const char *best = c.at;
    for (size_t i = 0; i < step_count; i++) {
        const char *key_at = c.at;
        bool found = steps[i].key ? enter_key(&c, steps[i].key, &key_at)
                                  : enter_index(&c, steps[i].index);
        if (!found)
            break;
        best = at_key && steps[i].key && i + 1 == step_count ? key_at : c.at;
    }
    return (size_t)(best - text);
}
