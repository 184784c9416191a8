#include "suite.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "weald/reference.h"

static void remember(void *user, enum wd_log_level level, const char *message)
{
    struct suite *suite = user;
    size_t used = strlen(suite->messages), room = sizeof suite->messages - used;
    if (level <= WD_LOG_WARNING)
        snprintf(suite->messages + used, room, "%s\n", message);
}

static bool go_on(void *user, const char *stage, uint64_t done, uint64_t total)
{
    const struct suite *suite = user;
    (void)total;
    return !suite->stop_stage || strcmp(stage, suite->stop_stage) != 0 || done < suite->stop_at;
}

void suite_clear(struct suite *suite)
{
    suite->messages[0] = 0;
}

bool suite_logged(const struct suite *suite, const char *part)
{
    if (strstr(suite->messages, part))
        return true;
    fprintf(stderr, "\"%s\" was not logged, but:\n%s", part, suite->messages);
    return false;
}

/* --- files ------------------------------------------------------------------------------- */

const char *suite_path(struct suite *suite, const char *name)
{
    static char paths[4][512];
    static unsigned next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", suite->scratch, name);
    return path;
}

bool suite_write(struct suite *suite, const char *name, const char *text)
{
    FILE *file = fopen(suite_path(suite, name), "w");
    if (!file)
        return false;
    bool ok = fputs(text, file) >= 0;
    return fclose(file) == 0 && ok;
}

/* `text` with each `from` replaced by `to`; free() it. */
static char *replaced(const char *text, const char *from, const char *to)
{
    size_t size = 0, length = strlen(from);
    char *result = NULL;
    FILE *stream = open_memstream(&result, &size);
    for (const char *found; (found = strstr(text, from)); text = found + length) {
        fwrite(text, 1, (size_t)(found - text), stream);
        fputs(to, stream);
    }
    fputs(text, stream);
    fclose(stream);
    return result;
}

bool suite_write_variant(struct suite *suite, const char *name, const char *from, const char *to)
{
    char text[8192] = "", species[1100];
    FILE *file = fopen(suite->small_path, "r");
    if (!file)
        return false;
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    if (!strstr(text, from))
        return false;
    snprintf(species, sizeof species, "%s/species/", suite->root);
    char *absolute = replaced(text, "../../species/", species);
    char *other = replaced(absolute, from, to);
    bool ok = suite_write(suite, name, other);
    free(absolute);
    free(other);
    return ok;
}

static void remove_scratch(struct suite *suite)
{
    DIR *folder = opendir(suite->scratch);
    if (!folder)
        return;
    for (struct dirent *entry; (entry = readdir(folder));)
        if (entry->d_name[0] != '.')
            unlink(suite_path(suite, entry->d_name));
    closedir(folder);
    rmdir(suite->scratch);
}

/* --- setting up -------------------------------------------------------------------------- */

struct wd_forest *suite_forest(struct suite *suite, const char *path)
{
    const struct wd_forest_params params = {.scene_path = path, .log = suite->log};
    struct wd_forest *forest;
    if (wd_forest_create(&forest, &params) != WD_OK)
        fprintf(stderr, "%s: no forest:\n%s", path, suite->messages);
    return forest;
}

bool suite_init(struct suite *suite, const char *root)
{
    *suite = (struct suite){.log = {remember, suite}};
    char *absolute = realpath(root, NULL);
    snprintf(suite->root, sizeof suite->root, "%s", absolute ? absolute : root);
    free(absolute);
    snprintf(suite->small_path, sizeof suite->small_path, "%s/tests/api/small.json", suite->root);
    snprintf(suite->scratch, sizeof suite->scratch, "/tmp/weald-api-XXXXXX");
    const struct wd_renderer_params params = {
        .gpu = "software",
        .validation = WD_VALIDATION_ON,
        .progress = {go_on, suite},
        .log = suite->log,
    };
    if (!mkdtemp(suite->scratch))
        return false;
    suite->forest = suite_forest(suite, suite->small_path);
    bool ok = suite->forest && wd_renderer_create(&suite->renderer, &params) == WD_OK;
    if (!ok)
        fprintf(stderr, "no renderer:\n%s", suite->messages);
    return ok;
}

void suite_finish(struct suite *suite)
{
    wd_renderer_destroy(&suite->renderer);
    wd_forest_destroy(&suite->forest);
    remove_scratch(suite);
}

struct wd_render_params suite_params(const struct wd_forest *forest, const char *camera)
{
    struct wd_render_params params = {.width = PICTURE_WIDTH, .height = PICTURE_HEIGHT};
    assert_int_equal(wd_forest_get_camera(forest, camera, &params.camera), WD_OK);
    return params;
}

struct wd_picture suite_render(struct suite *suite, const struct wd_render_params *params)
{
    struct wd_picture picture;
    enum wd_result result = wd_renderer_render(suite->renderer, params, &picture);
    if (result != WD_OK)
        fail_msg("%s: %s", wd_result_name(result), suite->messages);
    return picture;
}

bool suite_shrink_memory(struct rlimit *before, uint64_t spare_bytes)
{
#ifdef SUITE_SANITIZED
    (void)before, (void)spare_bytes;
    return false;
#else
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_true(file && fscanf(file, "%lu", &pages) == 1);
    fclose(file);
    assert_int_equal(getrlimit(RLIMIT_AS, before), 0);
    struct rlimit less = *before;
    less.rlim_cur = pages * (rlim_t)sysconf(_SC_PAGESIZE) + spare_bytes;
    return setrlimit(RLIMIT_AS, &less) == 0;
#endif
}

void suite_trace(const struct suite *suite, const struct wd_forest *forest,
                 const struct wd_render_params *render, uint32_t paths, struct wd_picture *picture)
{
    const struct wd_reference_params params = {.log = suite->log};
    const struct wd_reference_picture_params trace = {.camera = render->camera,
                                                      .sun = render->sun,
                                                      .width = render->width,
                                                      .height = render->height,
                                                      .samples = paths,
                                                      .layers = render->layers};
    struct wd_reference *reference = NULL;
    assert_int_equal(wd_reference_create(&reference, forest, &params), WD_OK);
    assert_int_equal(wd_reference_render(reference, &trace, picture), WD_OK);
    wd_reference_destroy(&reference);
}
