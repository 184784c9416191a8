/* Forests and renderers, and how lines of a batch leave them to each other. */
#include "cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- what is kept ------------------------------------------------------------------------ */

void cli_kept_drop_forest(struct cli_kept *kept)
{
    if (kept->shown && wd_renderer_set_forest(kept->renderer, NULL) != WD_OK)
        wd_renderer_destroy(&kept->renderer); /* its device was lost */
    kept->shown = NULL;
    wd_forest_destroy(&kept->forest);
    free(kept->forest_text);
    kept->forest_text = NULL;
}

void cli_kept_finish(struct cli_kept *kept)
{
    cli_kept_drop_forest(kept);
    wd_renderer_destroy(&kept->renderer);
}

/* --- forests ----------------------------------------------------------------------------- */

/* The options that say what the scene file should have said, as settings of the scene. */
struct settings {
    const char *list[2 * CLI_MAX_WORDS + 3]; /* ended by NULL */
    uint32_t count;
    char *made[CLI_MAX_WORDS + 2];
    uint32_t made_count;
};

static void make_setting(struct settings *settings, const char *before, const char *text)
{
    char *made = NULL;
    if (asprintf(&made, "%s%s", before, text) < 0)
        abort();
    settings->made[settings->made_count++] = made;
    settings->list[settings->count++] = made;
}

/* A method without options is told to the renderer alone: forests of many methods are one. */
static void settings_init(struct settings *settings, const struct cli_options *options)
{
    *settings = (struct settings){0};
    for (uint32_t i = 0; i < options->settings.count; i++)
        settings->list[settings->count++] = options->settings.words[i];
    if (options->method && (options->method_options.count || options->faithful))
        make_setting(settings, "method=", options->method);
    for (uint32_t i = 0; i < options->method_options.count; i++)
        make_setting(settings, "methods.@method.", options->method_options.words[i]);
    if (options->faithful)
        make_setting(settings, "methods.@method.", "faithful=true");
}

static void settings_finish(struct settings *settings)
{
    for (uint32_t i = 0; i < settings->made_count; i++)
        free(settings->made[i]);
}

/* All that a forest is made of, but for what its files hold: a line a word, as no word has two. */
static char *join(const struct wd_forest_params *params)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        abort();
    fprintf(stream, "%s\n%s\n%s\n%u\n", params->scene_path, params->data_dir ? params->data_dir : "",
            params->seed ? params->seed : "", params->threads);
    for (const char *const *setting = params->settings; *setting; setting++)
        fprintf(stream, "%s\n", *setting);
    if (fclose(stream) != 0)
        abort();
    return text;
}

/* The forest before makes room first. */
static enum wd_result open_kept(struct cli_kept *kept, const struct wd_forest_params *params)
{
    char *text = join(params);
    if (kept->forest && strcmp(kept->forest_text, text) == 0) {
        free(text);
        return WD_OK;
    }
    cli_kept_drop_forest(kept);
    enum wd_result result = wd_forest_create(&kept->forest, params);
    kept->forest_text = text;
    return result;
}

enum wd_result cli_forest_open(struct cli_session *session, struct wd_forest **forest)
{
    const struct cli_options *options = session->options;
    struct settings settings;
    settings_init(&settings, options);
    const struct wd_forest_params params = {
        .scene_path = options->operands[0],
        .data_dir = options->data,
        .settings = settings.list,
        .seed = options->seed,
        .threads = options->threads,
        .progress = session->progress,
        .log = session->log,
    };
    enum wd_result result = session->kept ? open_kept(session->kept, &params) : wd_forest_create(forest, &params);
    if (session->kept)
        *forest = session->kept->forest;
    settings_finish(&settings);
    return result;
}

void cli_forest_close(struct cli_session *session, struct wd_forest **forest)
{
    if (!session->kept)
        wd_forest_destroy(forest);
    *forest = NULL;
}

/* --- renderers --------------------------------------------------------------------------- */

static bool is_kept(const struct cli_kept *kept, const struct cli_options *options)
{
    bool same_gpu = kept->gpu && options->gpu ? !strcmp(kept->gpu, options->gpu) : kept->gpu == options->gpu;
    return kept->renderer && same_gpu && kept->gpu_validate == options->gpu_validate &&
           kept->threads == options->threads;
}

static enum wd_result renew(struct cli_kept *kept, const struct wd_renderer_params *params,
                            const struct cli_options *options)
{
    wd_renderer_destroy(&kept->renderer);
    kept->shown = NULL;
    kept->gpu = options->gpu;
    kept->gpu_validate = options->gpu_validate;
    kept->threads = options->threads;
    return wd_renderer_create(&kept->renderer, params);
}

enum wd_result cli_renderer_open(struct cli_session *session, struct wd_renderer **renderer)
{
    const struct cli_options *options = session->options;
    struct cli_kept *kept = session->kept;
    const struct wd_renderer_params params = {
        .gpu = options->gpu,
        .validation = options->gpu_validate ? WD_VALIDATION_ON : WD_VALIDATION_OFF,
        .threads = options->threads,
        .progress = session->progress,
        .log = session->log,
    };
    if (!kept)
        return wd_renderer_create(renderer, &params);
    enum wd_result result = is_kept(kept, options) ? WD_OK : renew(kept, &params, options);
    *renderer = kept->renderer;
    return result;
}

enum wd_result cli_renderer_show(struct cli_session *session, struct wd_renderer *renderer,
                                 const struct wd_forest *forest)
{
    struct cli_kept *kept = session->kept;
    if (!kept)
        return wd_renderer_set_forest(renderer, forest);
    if (kept->shown == forest)
        return WD_OK;
    enum wd_result result = wd_renderer_set_forest(renderer, forest);
    kept->shown = result == WD_OK ? forest : NULL;
    return result;
}

void cli_renderer_close(struct cli_session *session, struct wd_renderer **renderer)
{
    if (!session->kept)
        wd_renderer_destroy(renderer);
    *renderer = NULL;
}
