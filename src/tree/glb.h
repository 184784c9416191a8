/* glb.h: a glTF 2.0 binary file being put together. */
#ifndef WD_TREE_GLB_H
#define WD_TREE_GLB_H

#include <jansson.h>

#include "base/log.h"

enum { WD_GLB_BYTE = 5121, WD_GLB_UINT = 5125, WD_GLB_FLOAT = 5126 };
enum { WD_GLB_NO_TARGET = 0, WD_GLB_VERTICES = 34962, WD_GLB_INDICES = 34963 };

struct wd_glb {
    json_t *root;
    uint8_t *bytes;
    size_t size, capacity;
};
void wd_glb_init(struct wd_glb *glb);
void wd_glb_finish(struct wd_glb *glb);

/* Appends to one of the root's lists ("nodes", ...); takes `item`. The index in it. */
int wd_glb_add(struct wd_glb *glb, const char *list, json_t *item);
/* Names an extension as used; once is enough. */
void wd_glb_use(struct wd_glb *glb, const char *extension);

/* A view of `size` bytes, from a multiple of four on; `target` WD_GLB_*. */
int wd_glb_view(struct wd_glb *glb, const void *data, size_t size, int target);

/* An accessor over a view of its own: `count` elements of `components` values of `kind`. Bounds are
 * written for floats of three components where `bounded`. Bytes are normalised. */
struct wd_glb_array {
    const void *data;
    size_t count;
    int components, kind, target;
    bool bounded;
};
int wd_glb_accessor(struct wd_glb *glb, const struct wd_glb_array *array);

/* Writes header, JSON and bytes; the file appears whole or not at all. Progress stage "writing the
 * file"; WD_ERROR_OUTPUT, logged, or WD_ERROR_INTERRUPTED. */
enum wd_result wd_glb_write(const struct wd_glb *glb, const char *path,
                            const struct wd_progress *progress, const struct wd_log *log);

#endif
