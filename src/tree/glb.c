#include "tree/glb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"

void wd_glb_init(struct wd_glb *glb)
{
    *glb = (struct wd_glb){0};
    glb->root = json_pack("{s:{s:s,s:s}}", "asset", "version", "2.0", "generator", "weald");
}

void wd_glb_finish(struct wd_glb *glb)
{
    json_decref(glb->root);
    free(glb->bytes);
    *glb = (struct wd_glb){0};
}

static json_t *list_of(struct wd_glb *glb, const char *name)
{
    json_t *list = json_object_get(glb->root, name);
    if (!list) {
        list = json_array();
        json_object_set_new(glb->root, name, list);
    }
    return list;
}

int wd_glb_add(struct wd_glb *glb, const char *name, json_t *item)
{
    json_t *list = list_of(glb, name);
    json_array_append_new(list, item);
    return (int)json_array_size(list) - 1;
}

void wd_glb_use(struct wd_glb *glb, const char *extension)
{
    json_t *list = list_of(glb, "extensionsUsed"), *used;
    size_t i;
    json_array_foreach(list, i, used)
        if (strcmp(json_string_value(used), extension) == 0)
            return;
    json_array_append_new(list, json_string(extension));
}

static void append(struct wd_glb *glb, const void *data, size_t size)
{
    size_t begin = (glb->size + 3) / 4 * 4;
    if (begin + size > glb->capacity) {
        glb->capacity = 2 * glb->capacity > begin + size ? 2 * glb->capacity : begin + size;
        glb->bytes = wd_realloc(glb->bytes, glb->capacity);
    }
    memset(glb->bytes + glb->size, 0, begin - glb->size);
    memcpy(glb->bytes + begin, data, size);
    glb->size = begin + size;
}

int wd_glb_view(struct wd_glb *glb, const void *data, size_t size, int target)
{
    append(glb, data, size);
    json_t *view = json_pack("{s:i,s:I,s:I}", "buffer", 0, "byteOffset",
                             (json_int_t)(glb->size - size), "byteLength", (json_int_t)size);
    if (target != WD_GLB_NO_TARGET)
        json_object_set_new(view, "target", json_integer(target));
    return wd_glb_add(glb, "bufferViews", view);
}

static void put_bounds(json_t *accessor, const struct wd_glb_array *array)
{
    const float *values = array->data;
    json_t *low = json_array(), *high = json_array();
    for (int k = 0; k < array->components; k++) {
        float least = INFINITY, most = -INFINITY;
        for (size_t i = 0; i < array->count; i++) {
            float value = values[i * (size_t)array->components + (size_t)k];
            least = fminf(least, value);
            most = fmaxf(most, value);
        }
        json_array_append_new(low, json_real((double)least));
        json_array_append_new(high, json_real((double)most));
    }
    json_object_set_new(accessor, "min", low);
    json_object_set_new(accessor, "max", high);
}

int wd_glb_accessor(struct wd_glb *glb, const struct wd_glb_array *array)
{
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    size_t element = (size_t)array->components * (array->kind == WD_GLB_BYTE ? 1 : 4);
    int view = wd_glb_view(glb, array->data, array->count * element, array->target);
    json_t *accessor =
        json_pack("{s:i,s:i,s:I,s:s}", "bufferView", view, "componentType", array->kind, "count",
                  (json_int_t)array->count, "type", types[array->components]);
    if (array->kind == WD_GLB_BYTE)
        json_object_set_new(accessor, "normalized", json_true());
    if (array->bounded)
        put_bounds(accessor, array);
    return wd_glb_add(glb, "accessors", accessor);
}

/* False where it is to stop. */
static bool put_bytes(FILE *stream, const uint8_t *bytes, size_t size,
                      const struct wd_progress *progress)
{
    enum { REPORT_BYTES = 16 << 20 };
    for (size_t at = 0; at < size; at += REPORT_BYTES) {
        size_t rest = size - at;
        if (!wd_progress_report(progress, "writing the file", at, size))
            return false;
        fwrite(bytes + at, 1, rest < REPORT_BYTES ? rest : REPORT_BYTES, stream);
    }
    return true;
}

static bool put_chunk(FILE *stream, uint32_t kind, const void *data, size_t size, char pad,
                      const struct wd_progress *progress)
{
    uint32_t whole = (uint32_t)((size + 3) / 4 * 4);
    const uint32_t head[2] = {whole, kind};
    fwrite(head, 1, sizeof head, stream);
    if (!put_bytes(stream, data, size, progress))
        return false;
    for (size_t i = size; i < whole; i++)
        fputc(pad, stream);
    return true;
}

enum wd_result wd_glb_write(const struct wd_glb *glb, const char *path,
                            const struct wd_progress *progress, const struct wd_log *log)
{
    enum { JSON_CHUNK = 0x4e4f534a, BIN_CHUNK = 0x004e4942 };
    json_object_set_new(glb->root, "buffers",
                        json_pack("[{s:I}]", "byteLength", (json_int_t)glb->size));
    char *text = json_dumps(glb->root, JSON_COMPACT | JSON_REAL_PRECISION(9));
    struct wd_output_file file;
    if (!text || !wd_output_open(&file, path, log)) {
        free(text);
        return WD_ERROR_OUTPUT;
    }
    size_t length = strlen(text);
    uint64_t total = 12 + 8 + (length + 3) / 4 * 4 + 8 + (glb->size + 3) / 4 * 4;
    const uint32_t head[3] = {0x46546c67, 2, (uint32_t)total};
    fwrite(head, 1, sizeof head, file.stream);
    bool going = put_chunk(file.stream, JSON_CHUNK, text, length, ' ', NULL) &&
                 put_chunk(file.stream, BIN_CHUNK, glb->bytes, glb->size, '\0', progress);
    free(text);
    enum wd_result result = !going                         ? WD_ERROR_INTERRUPTED
                            : wd_output_commit(&file, log) ? WD_OK
                                                           : WD_ERROR_OUTPUT;
    wd_output_discard(&file);
    return result;
}
