/* keys_settings.c: values from outside a file, put into its JSON before it is read. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/keys_reader.h"

enum { MAX_PATH = 256 };

static bool refuse(const struct wd_keys_reader *reader, const char *setting, const char *why)
{
    return wd_error(reader->log, "%s: setting %s: %s", reader->path, setting, why);
}

/* What the root says at `key`, or its default. */
static const char *text_of_root(const struct wd_keys *table, const json_t *root, const char *key,
                                char *buffer, size_t size)
{
    const char *found = json_string_value(json_object_get(root, key));
    if (found)
        return found;
    for (const struct wd_key *at = table->keys; at->name; at++) {
        if (strcmp(at->name, key) != 0 || !at->fallback || at->fallback[0] != '"')
            continue;
        size_t length = strlen(at->fallback) - 2;
        if (length >= size)
            return NULL;
        memcpy(buffer, at->fallback + 1, length);
        buffer[length] = '\0';
        return buffer;
    }
    return NULL;
}

/* "cameras[0].fov_deg", as errors spell it, becomes "cameras.0.fov_deg". */
static void flatten_indices(char *path)
{
    char *to = path;
    for (const char *at = path; *at;) {
        size_t digits = *at == '[' ? strspn(at + 1, "0123456789") : 0;
        const char *close = at + 1 + digits;
        if (digits == 0 || at == path || *close != ']' || !strchr(".[", close[1])) {
            *to++ = *at++;
            continue;
        }
        *to++ = '.';
        memmove(to, at + 1, digits);
        to += digits;
        at = close + 1;
    }
    *to = '\0';
}

/* The path before "=", with every "@key" replaced. */
static bool expand_path(char path[MAX_PATH], const struct wd_keys_reader *reader,
                        const struct wd_keys *table, const json_t *root, const char *setting)
{
    const char *end = strchr(setting, '=');
    size_t used = 0;
    if (!end || end == setting)
        return refuse(reader, setting, "it must read KEY=VALUE");
    for (const char *at = setting; at < end;) {
        size_t length = strcspn(at, ".=");
        char key[MAX_PATH], buffer[MAX_PATH];
        if (length == 0 || length >= sizeof key - used - 1)
            return refuse(reader, setting, "a part of its path is empty or too long");
        memcpy(key, at, length);
        key[length] = '\0';
        const char *step = key[0] == '@' ? text_of_root(table, root, key + 1, buffer, sizeof buffer)
                                         : key;
        if (!step || used + strlen(step) + 2 > MAX_PATH)
            return refuse(reader, setting, "there is nothing that @ could stand for");
        used += strlen(strcpy(path + used, step));
        at += length;
        if (*at == '.')
            path[used++] = *at++;
    }
    path[used] = '\0';
    flatten_indices(path);
    return true;
}

/* Which item of a list a step means. */
static bool index_of(const struct wd_keys_reader *reader, const char *setting, const json_t *list,
                     const char *step, size_t *index)
{
    char why[256];
    size_t count = json_array_size(list), digits = strspn(step, "0123456789");
    *index = strtoul(step, NULL, 10);
    if (digits > 0 && step[digits] == '\0' && *index < count)
        return true;
    snprintf(why, sizeof why, "there is no item \"%.60s\" in the list; it has %zu, numbered from 0", step,
             count);
    for (size_t i = 0; i < count; i++) {
        const char *name = json_string_value(json_object_get(json_array_get(list, i), "name"));
        if (name && strcmp(name, step) == 0)
            snprintf(why, sizeof why, "items of a list go by number, and \"%.60s\" is %zu", step, i);
    }
    return refuse(reader, setting, why);
}

/* The object or list below `parent` at `step`; an object that is not there yet is made. NULL: refused. */
static json_t *step_into(const struct wd_keys_reader *reader, const char *setting, json_t *parent,
                         const char *step)
{
    size_t index;
    if (json_is_array(parent) && !index_of(reader, setting, parent, step, &index))
        return NULL;
    json_t *child = json_is_array(parent) ? json_array_get(parent, index)
                                          : json_object_get(parent, step);
    if (!child && json_is_object(parent)) {
        child = json_object();
        json_object_set_new(parent, step, child);
    }
    if (!json_is_object(child) && !json_is_array(child)) {
        refuse(reader, setting, "its path leads through something that has no keys");
        return NULL;
    }
    return child;
}

static bool put(const struct wd_keys_reader *reader, const char *setting, json_t *parent,
                const char *step)
{
    const char *text = strchr(setting, '=') + 1;
    size_t index;
    if (json_is_array(parent) && !index_of(reader, setting, parent, step, &index))
        return false;
    json_t *value = json_loads(text, JSON_DECODE_ANY | JSON_REJECT_DUPLICATES, NULL);
    if (!value)
        value = json_string(text);
    if (!value)
        return refuse(reader, setting, "the value is no text");
    return json_is_array(parent) ? json_array_set_new(parent, index, value) == 0
                                 : json_object_set_new(parent, step, value) == 0;
}

static bool apply(const struct wd_keys_reader *reader, json_t *root, const char *path,
                  const char *setting)
{
    char steps[MAX_PATH];
    strcpy(steps, path);
    json_t *parent = root;
    char *step = steps;
    for (char *dot; parent && (dot = strchr(step, '.')) != NULL; step = dot + 1) {
        *dot = '\0';
        parent = step_into(reader, setting, parent, step);
    }
    return parent && put(reader, setting, parent, step);
}

bool wd_keys_apply_settings(struct wd_keys_reader *reader, const struct wd_keys *table,
                            json_t *root)
{
    size_t count = 0;
    while (reader->settings && reader->settings[count])
        count++;
    if (!count)
        return true;
    reader->setting_paths = wd_alloc_array(count, sizeof *reader->setting_paths);
    for (size_t i = 0; i < count; i++) {
        char path[MAX_PATH];
        if (!expand_path(path, reader, table, root, reader->settings[i]) ||
            !apply(reader, root, path, reader->settings[i]))
            return false;
        reader->setting_paths[i] = wd_strdup(path);
    }
    return true;
}

void wd_keys_settings_finish(struct wd_keys_reader *reader)
{
    for (size_t i = 0; reader->setting_paths && reader->settings[i]; i++)
        free(reader->setting_paths[i]);
    free(reader->setting_paths);
    reader->setting_paths = NULL;
}

/* What a path goes on with after the setting's, "" where they are the same; NULL: it is not below. "a[0].b"
 * and "a.0.b" are the same. */
static const char *below(const char *path, const char *setting)
{
    for (; *path && *setting; path++) {
        if (*path == ']')
            continue;
        char step = *path == '[' ? '.' : *path;
        if (*setting++ != step)
            return NULL;
    }
    path += *path == ']';
    if (*setting || !strchr(".[", *path))
        return NULL;
    return path + (*path == '.');
}

const char *wd_keys_setting_of(const struct wd_keys_reader *reader, const char *path,
                               const char **rest)
{
    const char *newest = NULL;
    for (size_t i = 0; reader->setting_paths && reader->settings[i]; i++) {
        const char *after = reader->setting_paths[i] ? below(path, reader->setting_paths[i]) : NULL;
        if (!after)
            continue;
        newest = reader->settings[i];
        *rest = after;
    }
    return newest;
}
