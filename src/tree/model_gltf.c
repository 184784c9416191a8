#include "tree/model_gltf.h"

#include <jansson.h>
#include <stdint.h>

#include "base/memory.h"

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

/* --- faults ------------------------------------------------------------------------------ */

struct walk {
    const json_t *nodes;
    uint32_t met;
    const char *fault;
};

/* A node that two others hold is met twice, so that a few nodes can stand for more than there is memory. */
static void meet(struct walk *walk, const json_t *indices, uint32_t depth)
{
    enum { MAX_DEPTH = 1000, MAX_MET = 1000000 };
    size_t i;
    json_t *index;
    if (depth > MAX_DEPTH)
        walk->fault = "its nodes nest deeper than 1000, or in a circle";
    json_array_foreach(indices, i, index) {
        const json_t *node = json_array_get(walk->nodes, (size_t)json_integer_value(index));
        if (!walk->fault && ++walk->met > MAX_MET)
            walk->fault = "its nodes are more than 1000000, each counted as often as others hold it";
        if (walk->fault)
            return;
        meet(walk, json_object_get(node, "children"), depth + 1);
    }
}

static const char *find_endless_nodes(const json_t *root)
{
    struct walk walk = {.nodes = json_object_get(root, "nodes")};
    size_t i;
    json_t *scene;
    json_array_foreach(json_object_get(root, "scenes"), i, scene)
        meet(&walk, json_object_get(scene, "nodes"), 0);
    return walk.fault;
}

static char *find_sparse(const json_t *root)
{
    size_t i;
    json_t *accessor;
    json_array_foreach(json_object_get(root, "accessors"), i, accessor) {
        const json_t *sparse = json_object_get(accessor, "sparse");
        json_int_t count = json_integer_value(json_object_get(accessor, "count"));
        json_int_t replaced = json_integer_value(json_object_get(sparse, "count"));
        if (replaced < 0 || replaced > count)
            return wd_format("its accessors[%zu] has %lld values, but %lld sparse ones", i, (long long)count,
                             (long long)replaced);
    }
    return NULL;
}

char *wd_gltf_fault(const char *json, size_t size, bool *broken)
{
    json_error_t error;
    json_t *root = json_loadb(json, size, JSON_DISABLE_EOF_CHECK, &error);
    *broken = !root && json_error_code(&error) != json_error_stack_overflow;
    if (!root)
        return wd_format("its JSON is malformed: line %d, column %d: %s", error.line, error.column, error.text);
    const char *nodes = find_endless_nodes(root);
    char *fault = nodes ? wd_strdup(nodes) : find_sparse(root);
    json_decref(root);
    return fault;
}
