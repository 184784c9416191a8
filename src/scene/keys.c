#include "scene/keys_reader.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/nearest.h"

enum { MAX_STEPS = 16 };

const char *wd_keys_path(const struct wd_keys_place *place)
{
    return place->reader->path;
}

struct wd_arena *wd_keys_arena(const struct wd_keys_place *place)
{
    return place->reader->arena;
}

const struct wd_log *wd_keys_log(const struct wd_keys_place *place)
{
    return place->reader->log;
}

const void *wd_keys_user(const struct wd_keys_place *place)
{
    return place->reader->user;
}

/* The chain from the root down; the root itself is no step. */
static size_t steps_of(const struct wd_keys_place *place, const char *key,
                       struct wd_json_step steps[MAX_STEPS])
{
    size_t depth = key != NULL;
    for (const struct wd_keys_place *at = place; at->parent; at = at->parent)
        depth++;
    if (depth > MAX_STEPS) /* no table nests so deep */
        return 0;
    size_t count = depth;
    if (key)
        steps[--depth] = (struct wd_json_step){.key = key};
    for (const struct wd_keys_place *at = place; at->parent; at = at->parent)
        steps[--depth] = (struct wd_json_step){.key = at->key, .index = at->index};
    return count;
}

static void write_path(const struct wd_json_step *steps, size_t count, char *buffer, size_t size)
{
    size_t used = 0;
    buffer[0] = '\0';
    for (size_t i = 0; i < count && used < size; i++) {
        int wrote = steps[i].key ? snprintf(buffer + used, size - used, "%s%.60s", i ? "." : "",
                                            steps[i].key)
                                 : snprintf(buffer + used, size - used, "[%zu]", steps[i].index);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
}

/* The message with where it is: free() it. */
static char *located(const struct wd_keys_place *place, const char *key, bool at_key,
                     const char *format, va_list arguments)
{
    struct wd_keys_reader *reader = place->reader;
    struct wd_json_step steps[MAX_STEPS];
    size_t count = steps_of(place, key, steps);
    char path[256], message[1024];
    write_path(steps, count, path, sizeof path);
    vsnprintf(message, sizeof message, format, arguments);
    const char *rest, *setting = wd_keys_setting_of(reader, path, &rest);
    if (setting)
        return wd_format("%s: setting %s: %s%s%s", reader->path, setting, rest, rest[0] ? ": " : "",
                         message);
    struct wd_json_spot spot = wd_json_spot_at(
        reader->text, wd_json_find(reader->clean, reader->size, steps, count, at_key));
    return wd_format("%s:%u:%u: %s%s%s", reader->path, spot.line, spot.column, path,
                     path[0] ? ": " : "", message);
}

static void report(const struct wd_keys_place *place, const char *key, bool at_key,
                   const char *format, va_list arguments)
{
    if (++place->reader->errors > WD_KEYS_ERROR_LIMIT)
        return;
    char *message = located(place, key, at_key, format, arguments);
    wd_error(place->reader->log, "%s", message);
    free(message);
}

bool wd_keys_error(const struct wd_keys_place *place, const char *key, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    report(place, key, false, format, arguments);
    va_end(arguments);
    return false;
}

bool wd_keys_error_at_key(const struct wd_keys_place *place, const char *key, const char *format,
                          ...)
{
    va_list arguments;
    va_start(arguments, format);
    report(place, key, true, format, arguments);
    va_end(arguments);
    return false;
}

void wd_keys_warn(const struct wd_keys_place *place, const char *key, const char *format, ...)
{
    if (++place->reader->warnings > WD_KEYS_ERROR_LIMIT)
        return;
    va_list arguments;
    va_start(arguments, format);
    char *message = located(place, key, false, format, arguments);
    va_end(arguments);
    wd_warn(place->reader->log, "%s", message);
    free(message);
}

/* NULL: the file does not say it. */
static const json_t *json_at(const struct wd_keys_place *place)
{
    if (!place->parent)
        return place->reader->json;
    const json_t *parent = json_at(place->parent);
    return place->key ? json_object_get(parent, place->key) : json_array_get(parent, place->index);
}

bool wd_keys_given(const struct wd_keys_place *place, const char *key)
{
    return json_object_get(json_at(place), key) != NULL;
}

static bool unknown_key(const struct wd_keys *table, const char *name,
                        const struct wd_keys_place *place)
{
    const char *names[128];
    size_t count = 0;
    char all[512] = "";
    size_t used = 0;
    for (const struct wd_key *key = table->keys; key->name && count < 128; key++) {
        names[count++] = key->name;
        if (used < sizeof all)
            used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", used ? ", " : "",
                                     key->name);
    }
    const char *near = wd_nearest_name(name, names, count);
    if (near)
        return wd_keys_error_at_key(place, name, "unknown key; did you mean \"%s\"?", near);
    return wd_keys_error_at_key(place, name, "unknown key; %s takes: %s", table->title,
                                count ? all : "none");
}

static bool check_names(const struct wd_keys *table, json_t *json,
                        const struct wd_keys_place *place)
{
    bool ok = true;
    const char *name;
    json_t *value;
    json_object_foreach(json, name, value)
    {
        bool known = !place->parent && strcmp(name, "$schema") == 0;
        if (known && !json_is_string(value))
            ok = wd_keys_error(place, name, "is no text; it names the schema that editors check the file by");
        for (const struct wd_key *key = table->keys; key->name && !known; key++)
            known = strcmp(key->name, name) == 0;
        if (!known)
            ok = unknown_key(table, name, place);
    }
    return ok;
}

static bool read_default(const struct wd_key *key, const struct wd_keys_place *place, void *object)
{
    const char *text = key->fallback;
    if (!text && key->kind == WD_KEY_OBJECT)
        text = "{}";
    if (!text) {
        if (key->flags & WD_KEY_NAN_IF_ABSENT)
            *(double *)((char *)object + key->offset) = __builtin_nan("");
        return true;
    }
    json_t *json = json_loads(text, JSON_DECODE_ANY, NULL);
    if (!json)
        return wd_keys_error(place, key->name, "the built-in default %s is not JSON", text);
    bool ok = wd_keys_read_value(key, json, place, object);
    json_decref(json);
    return ok;
}

bool wd_keys_read_object(const struct wd_keys *table, json_t *json,
                         const struct wd_keys_place *place, void *object)
{
    bool ok = check_names(table, json, place);
    for (const struct wd_key *key = table->keys; key->name; key++) {
        json_t *value = json_object_get(json, key->name);
        char allowed[256];
        if (value)
            ok = wd_keys_read_value(key, value, place, object) && ok;
        else if (key->flags & WD_KEY_REQUIRED)
            ok = wd_keys_error(place, NULL, "\"%s\" is missing; it takes %s", key->name,
                               wd_keys_allowed(key, allowed, sizeof allowed));
        else
            ok = read_default(key, place, object) && ok;
    }
    if (table->check && (ok || table->check_always))
        ok = table->check(object, place) && ok;
    return ok;
}

static bool syntax_error(const struct wd_keys_reader *reader, const json_error_t *error)
{
    size_t at = error->position > 0 ? (size_t)error->position : 0;
    struct wd_json_spot spot = wd_json_spot_at(reader->text, at < reader->size ? at : reader->size);
    if (json_error_code(error) == json_error_premature_end_of_input)
        return wd_error(reader->log, "%s:%u:%u: the file ends too early: %s", reader->path,
                        spot.line, spot.column, error->text);
    return wd_error(reader->log, "%s:%u:%u: not valid JSON: %s", reader->path, spot.line,
                    spot.column, error->text);
}

static bool read_text(struct wd_keys_reader *reader, const struct wd_keys *table, void *object)
{
    json_error_t error;
    json_t *json = json_loadb(reader->clean, reader->size, JSON_REJECT_DUPLICATES, &error);
    if (!json)
        return syntax_error(reader, &error);
    struct wd_keys_place root = {.reader = reader};
    bool ok = json_is_object(json) || wd_keys_error(&root, NULL, "found a list; a %s is an object: "
                                                                 "{ ... }", table->title);
    reader->json = json;
    ok = ok && wd_keys_apply_settings(reader, table, json) &&
         wd_keys_read_object(table, json, &root, object);
    wd_keys_settings_finish(reader);
    reader->json = NULL;
    json_decref(json);
    if (reader->warnings > WD_KEYS_ERROR_LIMIT)
        wd_warn(reader->log, "%s: %u more warnings", reader->path, reader->warnings - WD_KEYS_ERROR_LIMIT);
    if (reader->errors > WD_KEYS_ERROR_LIMIT)
        wd_error(reader->log, "%s: %u more errors", reader->path,
                 reader->errors - WD_KEYS_ERROR_LIMIT);
    return ok;
}

bool wd_keys_read_input(const struct wd_keys *table, const struct wd_keys_input *input,
                        struct wd_arena *arena, const struct wd_log *log, void *object)
{
    memset(object, 0, table->size);
    char *clean = wd_json_blank_comments(input->path, input->text, input->size, log);
    if (!clean)
        return false;
    struct wd_keys_reader reader = {.path = input->path, .text = input->text, .clean = clean,
                                    .size = input->size, .arena = arena, .log = log,
                                    .user = input->user, .settings = input->settings};
    bool ok = read_text(&reader, table, object);
    free(clean);
    if (!ok)
        memset(object, 0, table->size);
    return ok;
}

bool wd_keys_read(const struct wd_keys *table, const char *path, const char *text, size_t size,
                  struct wd_arena *arena, const struct wd_log *log, void *object)
{
    const struct wd_keys_input input = {.path = path, .text = text, .size = size};
    return wd_keys_read_input(table, &input, arena, log, object);
}
