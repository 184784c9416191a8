/* inventory_file.h: a small scene with an inventory that a test writes, and what is said of it. Included after
 * cmocka.h. */
#ifndef WD_TESTS_INVENTORY_FILE_H
#define WD_TESTS_INVENTORY_FILE_H

#include <stdio.h>
#include <string.h>

#include "small_scene.h"
#include "world/world.h"

struct capture {
    char errors[8192], others[8192];
};

static inline void keep(void *user, enum wd_log_level level, const char *message)
{
    struct capture *capture = user;
    char *text = level == WD_LOG_ERROR ? capture->errors : capture->others;
    size_t used = strlen(text);
    snprintf(text + used, sizeof capture->errors - used, "%s\n", message);
}

static struct capture captured;
static const struct wd_log sink = {keep, &captured};
static inline void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static inline bool make(struct small_scene *small, struct wd_world *world)
{
    captured = (struct capture){"", ""};
    small->scene.path = NULL;
    return wd_world_init(world, &small->scene, &(struct wd_world_params){.log = &sink});
}

static inline void make_or_fail(struct small_scene *small, struct wd_world *world)
{
    if (!make(small, world))
        fail_msg("%s", captured.errors);
}

static inline void assert_said(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("\"%s\" is not in \"%s\"", part, text);
}

/* Said of `text` by the way, as if it held trees of oak. */
static inline const char *said_of(const char *path, const char *text, struct small_scene *small)
{
    struct wd_world world;
    write_file(path, text);
    make_or_fail(small, &world);
    wd_world_finish(&world);
    return captured.others;
}

#endif
