/* suite.h: a renderer on software Vulkan with validation, and a log that remembers. */
#ifndef WD_TESTS_API_SUITE_H
#define WD_TESTS_API_SUITE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <sys/resource.h>

#include "weald/renderer.h"

enum { PICTURE_WIDTH = 160, PICTURE_HEIGHT = 120 };

struct suite {
    char root[1024];       /* of the sources */
    char scratch[64];      /* a directory of this run's own */
    char small_path[1280]; /* tests/api/small.json */
    struct wd_log log;
    char messages[16384];     /* errors and warnings since suite_clear, a line each */
    struct wd_forest *forest; /* of small.json; on the renderer between tests */
    struct wd_renderer *renderer;
    const char *stop_stage; /* the progress says no at this stage from... */
    uint64_t stop_at;       /* ...this count on */
};

/* False, with a message, unless everything is up. `root`: the folder of the sources. */
bool suite_init(struct suite *suite, const char *root);
void suite_finish(struct suite *suite); /* removes the scratch directory's files */

void suite_clear(struct suite *suite);
bool suite_logged(const struct suite *suite, const char *part);

/* SCRATCH/NAME, in a buffer that the next-but-three call overwrites. */
const char *suite_path(struct suite *suite, const char *name);
bool suite_write(struct suite *suite, const char *name, const char *text);

/* A forest from a file; NULL on failure. */
struct wd_forest *suite_forest(struct suite *suite, const char *path);

/* The text of small.json with `from` replaced by `to`, species' files absolute, as scratch/NAME. */
bool suite_write_variant(struct suite *suite, const char *name, const char *from, const char *to);

/* What a test asks for: the camera of the name, 160 x 120, one sample, everything else 0. */
struct wd_render_params suite_params(const struct wd_forest *forest, const char *camera);

/* Draws it, or fails with the messages; free the picture with wd_picture_finish. */
struct wd_picture suite_render(struct suite *suite, const struct wd_render_params *params);

/* As if the machine had no more memory than this beyond what the process maps, until setrlimit(RLIMIT_AS, before).
 * False, and nothing is changed, where a sanitizer's allocator would end the process. */
bool suite_shrink_memory(struct rlimit *before, uint64_t spare_bytes);

/* Path-traces what `render` says of camera, size and layers; free the picture with wd_picture_finish. */
void suite_trace(const struct suite *suite, const struct wd_forest *forest,
                 const struct wd_render_params *render, uint32_t paths, struct wd_picture *picture);

#endif
