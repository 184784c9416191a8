#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/keys.h"

enum { MAX_TABLES = 64 };

struct tables {
    const struct wd_keys *items[MAX_TABLES];
    size_t count;
};

static json_t *any_of(json_t *first, json_t *second)
{
    return json_pack("{s:[o,o]}", "anyOf", first, second);
}

static json_t *number_json(double value)
{
    return value == floor(value) && fabs(value) < 1e15 ? json_integer((json_int_t)value)
                                                       : json_real(value);
}

static json_t *number_schema(const struct wd_key *key, const char *type)
{
    json_t *schema = json_pack("{s:s}", "type", type);
    if (key->min == 0 && key->max == 0)
        return schema;
    const char *least = key->flags & WD_KEY_EXCLUSIVE_MIN ? "exclusiveMinimum" : "minimum";
    if (isfinite(key->min))
        json_object_set_new(schema, least, number_json(key->min));
    if (isfinite(key->max))
        json_object_set_new(schema, "maximum", number_json(key->max));
    return schema;
}

static json_t *text_schema(void)
{
    return json_pack("{s:s, s:i}", "type", "string", "minLength", 1);
}

static json_t *choice_schema(const char *const *choices)
{
    json_t *list = json_array();
    for (; *choices; choices++)
        json_array_append_new(list, json_string(*choices));
    return json_pack("{s:o}", "enum", list);
}

/* `length` 0: any number of items. */
static json_t *list_schema(json_t *items, size_t length)
{
    json_t *schema = json_pack("{s:s, s:o}", "type", "array", "items", items);
    if (length) {
        json_object_set_new(schema, "minItems", json_integer((json_int_t)length));
        json_object_set_new(schema, "maxItems", json_integer((json_int_t)length));
    }
    return schema;
}

static json_t *map_schema(json_t *values)
{
    return json_pack("{s:s, s:o}", "type", "object", "additionalProperties", values);
}

static json_t *color_schema(void)
{
    json_t *part = json_pack("{s:s, s:i, s:i}", "type", "number", "minimum", 0, "maximum", 1);
    return any_of(list_schema(part, 3), json_pack("{s:s, s:s}", "type", "string", "pattern",
                                                  "^#[0-9a-fA-F]{6}$"));
}

/* Titles are words for people; references are parts of addresses. */
static char *definition_name(const struct wd_keys *table)
{
    char *name = wd_strdup(table->title);
    for (char *at = name; *at; at++)
        *at = *at == ' ' ? '-' : *at;
    return name;
}

static json_t *reference(const struct wd_keys *table, struct tables *tables)
{
    size_t at = 0;
    while (at < tables->count && tables->items[at] != table)
        at++;
    if (at == tables->count && at < MAX_TABLES)
        tables->items[tables->count++] = table;
    char *name = definition_name(table);
    json_t *schema = json_pack("{s:s+}", "$ref", "#/$defs/", name);
    free(name);
    return schema;
}

static json_t *value_schema(const struct wd_key *key, struct tables *tables)
{
    switch (key->kind) {
    case WD_KEY_DOUBLE:
    case WD_KEY_FLOAT: return number_schema(key, "number");
    case WD_KEY_INTEGER: return number_schema(key, "integer");
    case WD_KEY_BOOL: return json_pack("{s:s}", "type", "boolean");
    case WD_KEY_STRING: return key->choices ? choice_schema(key->choices) : text_schema();
    case WD_KEY_ENUM: return choice_schema(key->choices);
    case WD_KEY_RANGE:
        return any_of(number_schema(key, "number"), list_schema(number_schema(key, "number"), 2));
    case WD_KEY_VECTOR:
    case WD_KEY_FLOATS:
    case WD_KEY_NUMBERS: return list_schema(number_schema(key, "number"), key->length);
    case WD_KEY_COLOR: return color_schema();
    case WD_KEY_OBJECT: return reference(key->table, tables);
    case WD_KEY_LIST: return list_schema(reference(key->table, tables), 0);
    case WD_KEY_MAP: return map_schema(reference(key->table, tables));
    case WD_KEY_STRINGS: return any_of(text_schema(), list_schema(text_schema(), 0));
    case WD_KEY_INTEGERS:
        return any_of(number_schema(key, "integer"), list_schema(number_schema(key, "integer"), 0));
    case WD_KEY_STRING_MAP: return map_schema(text_schema());
    case WD_KEY_NUMBER_MAP: return any_of(text_schema(), map_schema(number_schema(key, "number")));
    }
    return NULL;
}

static json_t *table_schema(const struct wd_keys *table, struct tables *tables)
{
    json_t *properties = json_object(), *required = json_array();
    for (const struct wd_key *key = table->keys; key->name; key++) {
        json_t *value = value_schema(key, tables);
        if (key->doc)
            json_object_set_new(value, "description", json_string(key->doc));
        if (key->fallback)
            json_object_set_new(value, "default", json_loads(key->fallback, JSON_DECODE_ANY, NULL));
        json_object_set_new(properties, key->name, value);
        if (key->flags & WD_KEY_REQUIRED)
            json_array_append_new(required, json_string(key->name));
    }
    json_t *schema = json_pack("{s:s, s:o, s:b}", "type", "object", "properties", properties,
                               "additionalProperties", 0);
    if (json_array_size(required) > 0)
        json_object_set(schema, "required", required);
    json_decref(required);
    return schema;
}

char *wd_keys_schema(const struct wd_keys *table, const char *name)
{
    struct tables tables = {0};
    json_t *schema = json_pack("{s:s, s:s+, s:s}", "$schema",
                               "https://json-schema.org/draft/2020-12/schema", "$id", "urn:weald:",
                               name, "title", table->title);
    json_t *root = table_schema(table, &tables);
    json_object_set_new(json_object_get(root, "properties"), "$schema",
                        json_pack("{s:s, s:s}", "type", "string", "description",
                                  "Where this schema is, for editors."));
    json_object_update(schema, root);
    json_decref(root);
    json_t *definitions = json_object();
    for (size_t i = 0; i < tables.count; i++) {
        char *definition = definition_name(tables.items[i]);
        json_object_set_new(definitions, definition, table_schema(tables.items[i], &tables));
        free(definition);
    }
    json_object_set_new(schema, "$defs", definitions);
    char *text = json_dumps(schema, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    json_decref(schema);
    return text;
}
