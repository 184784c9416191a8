#include "tree/model_gltf.h"

#include <jansson.h>
#include <stdbool.h>

static bool is_whole(const json_t *root, const json_t *attribute)
{
    enum { FLOATS = 5126 };
    json_int_t index = json_integer_value(attribute);
    const json_t *accessor = index < 0 ? NULL : json_array_get(json_object_get(root, "accessors"), (size_t)index);
    const json_t *type = json_object_get(accessor, "componentType");
    return json_is_integer(attribute) && json_is_integer(type) && json_integer_value(type) != FLOATS;
}

static const char *find_whole(const json_t *root)
{
    static const char *const names[] = {"POSITION", "NORMAL", "TEXCOORD_0"};
    size_t i, k;
    json_t *mesh, *primitive;
    json_array_foreach(json_object_get(root, "meshes"), i, mesh)
        json_array_foreach(json_object_get(mesh, "primitives"), k, primitive)
            for (size_t n = 0; n < sizeof names / sizeof *names; n++)
                if (is_whole(root, json_object_get(json_object_get(primitive, "attributes"), names[n])))
                    return names[n];
    return NULL;
}

const char *wd_gltf_whole_numbers(const char *json, size_t size)
{
    json_t *root = json_loadb(json, size, JSON_DISABLE_EOF_CHECK, NULL);
    const char *found = find_whole(root);
    json_decref(root);
    return found;
}
