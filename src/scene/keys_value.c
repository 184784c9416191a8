#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/color.h"
#include "scene/keys_reader.h"
#include "scene/nearest.h"

static bool bounded(const struct wd_key *key)
{
    return key->min != 0 || key->max != 0;
}

static void write_bounds(const struct wd_key *key, const char *what, char *buffer, size_t size)
{
    const char *low = key->flags & WD_KEY_EXCLUSIVE_MIN ? "above" : "from";
    if (!bounded(key))
        snprintf(buffer, size, "%s", what);
    else if (isinf(key->min))
        snprintf(buffer, size, "%s of at most %.10g", what, key->max);
    else if (isinf(key->max))
        snprintf(buffer, size, "%s %s %.10g%s", what, low, key->min,
                 key->flags & WD_KEY_EXCLUSIVE_MIN ? "" : " up");
    else
        snprintf(buffer, size, "%s %s %.10g%s to %.10g", what, low, key->min,
                 key->flags & WD_KEY_EXCLUSIVE_MIN ? " up" : "", key->max);
}

static void write_choices(const char *const *choices, char *buffer, size_t size)
{
    size_t used = (size_t)snprintf(buffer, size, "one of");
    for (; *choices && used < size; choices++)
        used += (size_t)snprintf(buffer + used, size - used, " \"%s\"%s", *choices,
                                 choices[1] ? "," : "");
}

const char *wd_keys_allowed(const struct wd_key *key, char *buffer, size_t size)
{
    char number[96];
    write_bounds(key, "a number", number, sizeof number);
    switch (key->kind) {
    case WD_KEY_DOUBLE:
    case WD_KEY_FLOAT: snprintf(buffer, size, "%s", number); break;
    case WD_KEY_INTEGER: write_bounds(key, "a whole number", buffer, size); break;
    case WD_KEY_BOOL: snprintf(buffer, size, "true or false"); break;
    case WD_KEY_STRING:
        if (!key->choices) {
            snprintf(buffer, size, "a text that is not empty");
            break;
        }
        /* fall through */
    case WD_KEY_ENUM: write_choices(key->choices, buffer, size); break;
    case WD_KEY_RANGE:
        snprintf(buffer, size, "%s, or [least, greatest] of two such", number);
        break;
    case WD_KEY_VECTOR:
    case WD_KEY_FLOATS:
        snprintf(buffer, size, "a list of %zu numbers, each %s%s", key->length, number,
                 key->flags & WD_KEY_SORTED ? ", none less than the one before" : "");
        break;
    case WD_KEY_COLOR:
        snprintf(buffer, size, "[red, green, blue] in linear light from 0 to 1, or \"#rrggbb\"");
        break;
    case WD_KEY_OBJECT: snprintf(buffer, size, "an object: { ... }"); break;
    case WD_KEY_LIST: snprintf(buffer, size, "a list of objects: [ { ... }, ... ]"); break;
    case WD_KEY_MAP: snprintf(buffer, size, "an object of objects: { \"name\": { ... } }"); break;
    case WD_KEY_STRINGS: snprintf(buffer, size, "a text or a list of texts"); break;
    case WD_KEY_INTEGERS:
        write_bounds(key, "a whole number", number, sizeof number);
        snprintf(buffer, size, "%s, or a list of such", number);
        break;
    case WD_KEY_NUMBERS:
        if (key->length)
            snprintf(buffer, size, "a list of %zu numbers, each %s", key->length, number);
        else
            snprintf(buffer, size, "a list of numbers, each %s", number);
        break;
    case WD_KEY_STRING_MAP:
        snprintf(buffer, size, "an object of texts: { \"name\": \"text\" }");
        break;
    case WD_KEY_NUMBER_MAP:
        snprintf(buffer, size, "a name, or an object { \"name\": number }, each %s", number);
        break;
    }
    return buffer;
}

static const char *describe(const json_t *json, char *buffer, size_t size)
{
    switch (json_typeof(json)) {
    case JSON_OBJECT: return "an object";
    case JSON_ARRAY:
        snprintf(buffer, size, "a list of %zu", json_array_size(json));
        return buffer;
    case JSON_STRING:
        snprintf(buffer, size, "\"%.60s\"", json_string_value(json));
        return buffer;
    case JSON_INTEGER:
    case JSON_REAL: snprintf(buffer, size, "%.12g", json_number_value(json)); return buffer;
    case JSON_TRUE: return "true";
    case JSON_FALSE: return "false";
    case JSON_NULL: break;
    }
    return "null";
}

static bool refuse(const struct wd_key *key, const json_t *json, const struct wd_keys_place *place)
{
    char allowed[256], found[96];
    return wd_keys_error(place, key->name, "found %s; allowed is %s",
                         describe(json, found, sizeof found),
                         wd_keys_allowed(key, allowed, sizeof allowed));
}

static bool refuse_item(const struct wd_key *key, size_t index, const json_t *json,
                        const struct wd_keys_place *place)
{
    struct wd_keys_place list = {place->reader, place, key->name, 0};
    struct wd_keys_place item = {place->reader, &list, NULL, index};
    char allowed[256], found[96];
    return wd_keys_error(&item, NULL, "found %s; allowed is %s",
                         describe(json, found, sizeof found),
                         wd_keys_allowed(key, allowed, sizeof allowed));
}

static bool number_allowed(const struct wd_key *key, const json_t *json, double *value)
{
    if (!json_is_number(json))
        return false;
    *value = json_number_value(json);
    if (!isfinite(*value))
        return false;
    if (!bounded(key))
        return true;
    bool low = key->flags & WD_KEY_EXCLUSIVE_MIN ? *value > key->min : *value >= key->min;
    return low && *value <= key->max;
}

static bool float_allowed(const struct wd_key *key, const json_t *json, float *value)
{
    double wide;
    if (!number_allowed(key, json, &wide) || fabs(wide) > FLT_MAX)
        return false;
    *value = (float)wide;
    return true;
}

/* 1e6 and 5.0 are whole numbers too, as far as doubles hold them exactly. */
static bool integer_allowed(const struct wd_key *key, const json_t *json, int64_t *value)
{
    double wide;
    if (!number_allowed(key, json, &wide))
        return false;
    if (json_is_integer(json)) {
        *value = json_integer_value(json);
        return true;
    }
    if (fabs(wide) > 9007199254740992.0 || wide != floor(wide))
        return false;
    *value = (int64_t)wide;
    return true;
}

static bool string_allowed(const json_t *json)
{
    return json_is_string(json) && json_string_length(json) > 0;
}

static bool choice_index(const struct wd_key *key, const json_t *json, int *index)
{
    for (int i = 0; json_is_string(json) && key->choices[i]; i++) {
        if (strcmp(key->choices[i], json_string_value(json)) == 0) {
            *index = i;
            return true;
        }
    }
    return false;
}

static bool refuse_choice(const struct wd_key *key, const json_t *json,
                          const struct wd_keys_place *place)
{
    size_t count = 0;
    while (key->choices[count])
        count++;
    const char *near =
        json_is_string(json) ? wd_nearest_name(json_string_value(json), key->choices, count) : NULL;
    if (!near)
        return refuse(key, json, place);
    char allowed[256];
    return wd_keys_error(place, key->name, "found \"%.60s\"; did you mean \"%s\"? Allowed is %s",
                         json_string_value(json), near,
                         wd_keys_allowed(key, allowed, sizeof allowed));
}

static bool read_string(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                        const char **value)
{
    int index;
    if (key->choices && !choice_index(key, json, &index))
        return refuse_choice(key, json, place);
    if (!string_allowed(json))
        return refuse(key, json, place);
    *value = wd_arena_strdup(place->reader->arena, json_string_value(json));
    return true;
}

static bool read_range(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                       float range[2])
{
    if (json_is_number(json)) {
        if (!float_allowed(key, json, &range[0]))
            return refuse(key, json, place);
        range[1] = range[0];
        return true;
    }
    if (json_array_size(json) != 2)
        return refuse(key, json, place);
    for (size_t i = 0; i < 2; i++) {
        if (!float_allowed(key, json_array_get(json, i), &range[i]))
            return refuse_item(key, i, json_array_get(json, i), place);
    }
    if (range[0] > range[1])
        return wd_keys_error(place, key->name, "found [%g, %g]; the least must come first",
                             (double)range[0], (double)range[1]);
    return true;
}

static bool read_vector(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                        double *parts)
{
    if (!json_is_array(json) || (key->length && json_array_size(json) != key->length))
        return refuse(key, json, place);
    for (size_t i = 0; i < json_array_size(json); i++) {
        if (!number_allowed(key, json_array_get(json, i), &parts[i]))
            return refuse_item(key, i, json_array_get(json, i), place);
        if (key->flags & WD_KEY_SORTED && i > 0 && parts[i] < parts[i - 1])
            return wd_keys_error(place, key->name, "found %.9g after %.9g; none may be less than "
                                 "the one before", parts[i], parts[i - 1]);
    }
    return true;
}

static bool read_floats(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                        float *parts)
{
    if (json_array_size(json) != key->length)
        return refuse(key, json, place);
    for (size_t i = 0; i < key->length; i++) {
        if (!float_allowed(key, json_array_get(json, i), &parts[i]))
            return refuse_item(key, i, json_array_get(json, i), place);
    }
    return true;
}

static int hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

static bool read_color(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                       float color[3])
{
    if (json_is_string(json)) {
        const char *text = json_string_value(json);
        if (strlen(text) != 7 || text[0] != '#')
            return refuse(key, json, place);
        for (int i = 0; i < 3; i++) {
            int high = hex_digit(text[1 + 2 * i]), low = hex_digit(text[2 + 2 * i]);
            if (high < 0 || low < 0)
                return refuse(key, json, place);
            color[i] = wd_srgb_decode((uint8_t)(high * 16 + low));
        }
        return true;
    }
    struct wd_key part = {.name = key->name, .min = 0, .max = 1};
    if (json_array_size(json) != 3)
        return refuse(key, json, place);
    for (size_t i = 0; i < 3; i++) {
        if (!float_allowed(&part, json_array_get(json, i), &color[i]))
            return refuse_item(key, i, json_array_get(json, i), place);
    }
    return true;
}

/* Arrays live in the arena; *count is set with the pointer, never without. */
static void *new_array(const struct wd_key *key, const struct wd_keys_place *place, void *object,
                       size_t count, size_t element_size)
{
    void *items = wd_arena_alloc(place->reader->arena, count * element_size + 1);
    memcpy((char *)object + key->offset, &items, sizeof items);
    memcpy((char *)object + key->count_offset, &count, sizeof count);
    return items;
}

static bool read_list(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                      void *object)
{
    if (!json_is_array(json))
        return refuse(key, json, place);
    size_t count = json_array_size(json);
    char *items = new_array(key, place, object, count, key->table->size);
    struct wd_keys_place list = {place->reader, place, key->name, 0};
    bool ok = true;
    for (size_t i = 0; i < count; i++) {
        struct wd_keys_place item = {place->reader, &list, NULL, i};
        json_t *value = json_array_get(json, i);
        char found[96];
        if (!json_is_object(value))
            ok = wd_keys_error(&item, NULL, "found %s; a %s is an object: { ... }",
                               describe(value, found, sizeof found), key->table->title);
        else
            ok = wd_keys_read_object(key->table, value, &item, items + i * key->table->size) && ok;
    }
    return ok;
}

static bool read_map(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                     void *object)
{
    if (!json_is_object(json))
        return refuse(key, json, place);
    char *item = new_array(key, place, object, json_object_size(json), key->table->size);
    struct wd_keys_place map = {place->reader, place, key->name, 0};
    bool ok = true;
    const char *name;
    json_t *value;
    json_object_foreach(json, name, value)
    {
        struct wd_keys_place at = {place->reader, &map, name, 0};
        const char *copy = wd_arena_strdup(place->reader->arena, name);
        char found[96];
        memcpy(item, &copy, sizeof copy);
        if (!json_is_object(value))
            ok = wd_keys_error(&at, NULL, "found %s; a %s is an object: { ... }",
                               describe(value, found, sizeof found), key->table->title);
        else
            ok = wd_keys_read_object(key->table, value, &at, item) && ok;
        item += key->table->size;
    }
    return ok;
}

static bool read_strings(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                         void *object)
{
    bool lone = string_allowed(json);
    if (!lone && !json_is_array(json))
        return refuse(key, json, place);
    size_t count = lone ? 1 : json_array_size(json);
    const char **items = new_array(key, place, object, count, sizeof *items);
    for (size_t i = 0; i < count; i++) {
        json_t *item = lone ? json : json_array_get(json, i);
        if (!string_allowed(item))
            return refuse_item(key, i, item, place);
        items[i] = wd_arena_strdup(place->reader->arena, json_string_value(item));
    }
    return true;
}

static bool read_integers(const struct wd_key *key, json_t *json,
                          const struct wd_keys_place *place, void *object)
{
    bool lone = json_is_number(json);
    if (!lone && !json_is_array(json))
        return refuse(key, json, place);
    size_t count = lone ? 1 : json_array_size(json);
    int64_t *items = new_array(key, place, object, count, sizeof *items);
    for (size_t i = 0; i < count; i++) {
        json_t *item = lone ? json : json_array_get(json, i);
        if (!integer_allowed(key, item, &items[i]))
            return lone ? refuse(key, item, place) : refuse_item(key, i, item, place);
    }
    return true;
}

static bool read_numbers(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                         void *object)
{
    if (!json_is_array(json))
        return refuse(key, json, place);
    double *items = new_array(key, place, object, json_array_size(json), sizeof *items);
    return read_vector(key, json, place, items);
}

static bool refuse_pair(const struct wd_key *key, const char *name, const json_t *json,
                        const struct wd_keys_place *place)
{
    struct wd_keys_place map = {place->reader, place, key->name, 0};
    char allowed[256], found[96];
    return wd_keys_error(&map, name, "found %s; allowed is %s", describe(json, found, sizeof found),
                         wd_keys_allowed(key, allowed, sizeof allowed));
}

static bool read_string_map(const struct wd_key *key, json_t *json,
                            const struct wd_keys_place *place, void *object)
{
    if (!json_is_object(json))
        return refuse(key, json, place);
    struct wd_string_pair *pair =
        new_array(key, place, object, json_object_size(json), sizeof *pair);
    bool ok = true;
    const char *name;
    json_t *value;
    json_object_foreach(json, name, value)
    {
        pair->name = wd_arena_strdup(place->reader->arena, name);
        if (!string_allowed(value))
            ok = refuse_pair(key, name, value, place);
        else
            pair->value = wd_arena_strdup(place->reader->arena, json_string_value(value));
        pair++;
    }
    return ok;
}

static bool read_number_map(const struct wd_key *key, json_t *json,
                            const struct wd_keys_place *place, void *object)
{
    if (!string_allowed(json) && !json_is_object(json))
        return refuse(key, json, place);
    size_t count = json_is_object(json) ? json_object_size(json) : 1;
    struct wd_number_pair *pair = new_array(key, place, object, count, sizeof *pair);
    if (!json_is_object(json)) {
        pair->name = wd_arena_strdup(place->reader->arena, json_string_value(json));
        pair->value = 1;
        return true;
    }
    bool ok = true;
    const char *name;
    json_t *value;
    json_object_foreach(json, name, value)
    {
        pair->name = wd_arena_strdup(place->reader->arena, name);
        if (!number_allowed(key, value, &pair->value))
            ok = refuse_pair(key, name, value, place);
        pair++;
    }
    return ok;
}

static bool read_object(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                        void *member)
{
    if (!json_is_object(json))
        return refuse(key, json, place);
    struct wd_keys_place inner = {place->reader, place, key->name, 0};
    return wd_keys_read_object(key->table, json, &inner, member);
}

bool wd_keys_read_value(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                        void *object)
{
    void *member = (char *)object + key->offset;
    switch (key->kind) {
    case WD_KEY_DOUBLE: return number_allowed(key, json, member) || refuse(key, json, place);
    case WD_KEY_FLOAT: return float_allowed(key, json, member) || refuse(key, json, place);
    case WD_KEY_INTEGER: return integer_allowed(key, json, member) || refuse(key, json, place);
    case WD_KEY_BOOL:
        *(bool *)member = json_is_true(json);
        return json_is_boolean(json) || refuse(key, json, place);
    case WD_KEY_STRING: return read_string(key, json, place, member);
    case WD_KEY_ENUM: return choice_index(key, json, member) || refuse_choice(key, json, place);
    case WD_KEY_RANGE: return read_range(key, json, place, member);
    case WD_KEY_VECTOR: return read_vector(key, json, place, member);
    case WD_KEY_FLOATS: return read_floats(key, json, place, member);
    case WD_KEY_COLOR: return read_color(key, json, place, member);
    case WD_KEY_OBJECT: return read_object(key, json, place, member);
    case WD_KEY_LIST: return read_list(key, json, place, object);
    case WD_KEY_MAP: return read_map(key, json, place, object);
    case WD_KEY_STRINGS: return read_strings(key, json, place, object);
    case WD_KEY_INTEGERS: return read_integers(key, json, place, object);
    case WD_KEY_NUMBERS: return read_numbers(key, json, place, object);
    case WD_KEY_STRING_MAP: return read_string_map(key, json, place, object);
    case WD_KEY_NUMBER_MAP: return read_number_map(key, json, place, object);
    }
    return false;
}
