#include "args.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AT(field) offsetof(struct cli_options, field)
#define SCENE_COMMANDS (CLI_RENDER | CLI_VIEW | CLI_INFO | CLI_EXPORT)
#define PICTURE_COMMANDS (CLI_RENDER | CLI_VIEW)

static const struct cli_option option_table[] = {
    {"output", 'o', "FILE", CLI_KIND_TEXT, AT(output), 0, 0,
     CLI_RENDER,
     "where to write: .png, .exr (all layers), .mp4 (or .m4v, .mov, .mkv), or numbered files "
     "(frame-%05d.png)"},
    {"output", 'o', "DIR", CLI_KIND_TEXT, AT(output), 0, 0, CLI_BENCH,
     "directory for results, reference pictures and the report"},
    {"output", 'o', "FILE", CLI_KIND_TEXT, AT(output), 0, 0, CLI_GROW | CLI_EXPORT,
     "where to write: .glb; of single trees also .obj, .png, .exr; of a forest's trees .csv"},
    {"height", 0, "METRES", CLI_KIND_REAL, AT(height_m), 0.01, 130, CLI_GROW,
     "height of the tree (default: the species' typical one; a model's own)"},
    {"age", 0, "YEARS", CLI_KIND_REAL, AT(age_years), 0.01, 10000, CLI_GROW,
     "age in place of a height"},
    {"dbh", 0, "CM", CLI_KIND_REAL, AT(dbh_cm), 0.01, 2000, CLI_GROW,
     "stem diameter at 1.3 m (default: from the height)"},
    {"open", 0, "SHARE", CLI_KIND_REAL, AT(openness), 0, 1, CLI_GROW,
     "0 grown in a forest to 1 in the open (default: 0)"},
    {"clip", 0, "BOX|FILE", CLI_KIND_TEXT, AT(clip), 0, 0, CLI_GROW,
     "cut as a hedge to WIDTHxDEPTHxHEIGHT metres or to a model's closed mesh, in place of a size"},
    {"detail", 0, "FACTOR", CLI_KIND_REAL, AT(detail), 0.01, 8, CLI_GROW,
     "leaves and twigs relative to the species' own number (default: 1)"},
    {"month", 0, "MONTH", CLI_KIND_REAL, AT(month), 1, 13, CLI_GROW,
     "1 the first of January to 13 the last of December (default: summer)"},
    {"season", 0, "NAME", CLI_KIND_TEXT, AT(season), 0, 0, CLI_GROW,
     "spring, summer, autumn or winter in place of a month"},
    {"seed", 0, "N", CLI_KIND_WHOLE, AT(grow_seed), 1, UINT32_MAX, CLI_GROW,
     "another seed, another individual (default: 1)"},
    {"variants", 0, "N", CLI_KIND_WHOLE, AT(variants), 1, 64, CLI_GROW,
     "this many individuals side by side, of seeds from --seed on"},
    {"form", 0, "NAME", CLI_KIND_TEXT, AT(form), 0, 0, CLI_GROW,
     "what a picture shows: full, reduced, cards, or seen (as in scenes) (default: full)"},
    {"camera-distance", 0, "METRES", CLI_KIND_REAL, AT(distance_m), 0.1, 1900, CLI_GROW,
     "picture from a person's eye this far off (default: all of the tree in the frame)"},
    {"sheet", 0, NULL, CLI_KIND_FLAG, AT(sheet), 0, 0, CLI_GROW,
     "draw a contact sheet of the species (default: of all) by age and season, with levels of "
     "detail"},
    {"max-trees", 0, "N", CLI_KIND_WHOLE, AT(max_trees), 1, UINT32_MAX, CLI_EXPORT,
     "refuse forests of more trees than this (default: 1000000; of a .csv any number)"},
    {"camera", 0, "NAME", CLI_KIND_TEXT, AT(camera), 0, 0, PICTURE_COMMANDS,
     "a camera of the scene, or one that the viewer saved (default: the scene's first)"},
    {"path", 0, "NAME", CLI_KIND_TEXT, AT(path), 0, 0, PICTURE_COMMANDS,
     "a camera path of the scene"},
    {"size", 0, "WxH", CLI_KIND_SIZE, AT(size_px), 1, CLI_MAX_SIZE_PX,
     PICTURE_COMMANDS | CLI_GROW,
     "pixels, 1 to 16384 each way (default: the scene's; of single trees 900x900; of a sheet's cells 230x230)"},
    {"size", 0, "WxH", CLI_KIND_SIZE, AT(size_px), 1, CLI_MAX_SIZE_PX, CLI_BENCH,
     "pixels of the frames that times are of, not of errors and popping (default: 800x600, --quick 320x240; of scale "
     "from the road and from 9 km 1920x1080)"},
    {"samples", 0, "N", CLI_KIND_WHOLE, AT(samples), 1, 65536,
     CLI_RENDER | CLI_GROW,
     "pictures averaged into one (default: the scene's; of single trees 16)"},
    {"frames", 0, "N", CLI_KIND_WHOLE, AT(frames), 1, 10000000, CLI_RENDER,
     "frames of a film, spread evenly over the path (default: the path at its own speed)"},
    {"clock", 0, "HH:MM", CLI_KIND_TEXT, AT(clock), 0, 0, CLI_RENDER,
     "hour that the sun stands by, in place of the scene's; HH:MM-HH:MM: of a film's first and last frame"},
    {"only", 0, "A-B", CLI_KIND_TEXT, AT(only), 0, 0, CLI_RENDER,
     "of a film's numbered files those from number A to B, as for one of many machines (default: all, from 0)"},
    {"fps", 0, "N", CLI_KIND_REAL, AT(frames_per_second),
     WD_LEAST_FRAMES_PER_SECOND, WD_MOST_FRAMES_PER_SECOND, CLI_RENDER,
     "frames a second of a film, and of a still's motion (default: 24)"},
    {"method", 0, "NAME", CLI_KIND_TEXT, AT(method), 0, 0, SCENE_COMMANDS | CLI_GROW,
     "how trees are drawn (default: the scene's)"},
    {"suite", 0, "NAME", CLI_KIND_TEXT, AT(suite), 0, 0, CLI_BENCH,
     "what to measure: seeds, scale, density, quality or popping"},
    {"quick", 0, NULL, CLI_KIND_FLAG, AT(quick), 0, 0, CLI_BENCH,
     "minutes instead of hours: small pictures, few samples"},
    {"methods", 0, "A,B,...", CLI_KIND_TEXT, AT(methods), 0, 0, CLI_BENCH,
     "the methods to measure (default: the suite's)"},
    {"metric", 0, "NAME", CLI_KIND_TEXT, AT(metric), 0, 0, CLI_BENCH,
     "the error that plots and the table show: flip, ssim, rmse_pct, block_rmse_pct, radiance_bias_pct, tree_bias_pct or "
     "coverage_bias_pct (default: flip); of seeds and quality"},
    {"against", 0, "DIR", CLI_KIND_TEXT, AT(against), 0, 0, CLI_BENCH,
     "the directory of an earlier run, also of other code, whose times and errors are printed beside these"},
    {"reference", 0, NULL, CLI_KIND_FLAG, AT(reference), 0, 0, CLI_RENDER,
     "trace paths on the processor: the truth, slow (default: 64 samples)"},
    {"bounces", 0, "N", CLI_KIND_WHOLE, AT(bounces), 1, 1000, CLI_RENDER,
     "how often light is scattered with --reference (default: 8)"},
    {"layers", 0, "A,B,...", CLI_KIND_TEXT, AT(layers), 0, 0, CLI_RENDER,
     "layers of an .exr: color, depth, normal, albedo, species, tree_id, velocity; cryptomatte (trees by "
     "coverage); all: all but the last (default); --reference lacks velocity and cryptomatte"},
    {"max-error", 0, "PX", CLI_KIND_REAL, AT(max_error_px), WD_LEAST_ERROR_PX, WD_MOST_ERROR_PX,
     PICTURE_COMMANDS,
     "error bound of continuum: mean distance of a crown's discs on screen, in pixels (default: 1.41, of "
     "several samples 1 to 0.71)"},
    {"budget-ms", 0, "MS", CLI_KIND_REAL, AT(budget_ms), 0.1, 60000, PICTURE_COMMANDS,
     "hold the time of a frame by that error bound instead; films and views of continuum only"},
    {"option", 0, "NAME=VALUE", CLI_KIND_WORDS, AT(method_options), 0, 0, SCENE_COMMANDS,
     "an option of the method, see `weald methods`; may be given again"},
    {"faithful", 0, NULL, CLI_KIND_FLAG, AT(faithful), 0, 0, SCENE_COMMANDS,
     "short for --option faithful=true: the method with its paper's faults"},
    {"set", 0, "KEY=VALUE", CLI_KIND_WORDS, AT(settings), 0, 0, SCENE_COMMANDS | CLI_BENCH,
     "a value in place of the scene file's, as in wind.speed_mps=0 or cameras[0].fov_deg=40; may be given again"},
    {"view", 0, "WHAT", CLI_KIND_VIEW, AT(view), 0, 0, PICTURE_COMMANDS | CLI_GROW,
     "what pixels show: lit, lod, albedo, normal, tree-id or shadow (default: lit)"},
    {"time", 0, "SECONDS", CLI_KIND_REAL, AT(time_s), 0, 1e6, CLI_RENDER,
     "time of the wind; with --path and a single picture also the place on the path"},
    {"seed", 0, "N", CLI_KIND_TEXT, AT(seed), 0, 0, SCENE_COMMANDS,
     "replaces the scene's seed: another forest of the same kind"},
    {"data", 0, "DIR", CLI_KIND_TEXT, AT(data), 0, 0, SCENE_COMMANDS | CLI_CHECK | CLI_BENCH,
     "what ${data} stands for in the scene's file names"},
    {"gpu", 0, "NAME", CLI_KIND_TEXT, AT(gpu), 0, 0, PICTURE_COMMANDS | CLI_GROW | CLI_BENCH,
     "\"software\" or a part of a device's name, see `weald devices` (default: the best)"},
    {"gpu-validate", 0, NULL, CLI_KIND_FLAG, AT(gpu_validate), 0, 0,
     PICTURE_COMMANDS | CLI_GROW | CLI_BENCH,
     "check every use of Vulkan, end at the first error"},
    {"threads", 0, "N", CLI_KIND_WHOLE, AT(threads), 1, 1024, SCENE_COMMANDS | CLI_GROW | CLI_BENCH,
     "processor threads (default: one a processor); changes no picture"},
    {"max-fps", 0, "N", CLI_KIND_REAL, AT(max_fps), 0.1, 1000, CLI_VIEW,
     "draw at most so many frames a second, to leave the processor to others (default: the display's)"},
    {"single", 0, NULL, CLI_KIND_FLAG, AT(single), 0, 0, CLI_VIEW,
     "show each frame by itself: samples of frames before are not laid under it"},
    {"walk", 0, NULL, CLI_KIND_FLAG, AT(walk), 0, 0, CLI_VIEW,
     "begin on foot instead of in the air"},
    {"screenshots", 0, "DIR", CLI_KIND_TEXT, AT(screenshots), 0, 0, CLI_VIEW,
     "where F12 puts pictures (default: the working directory)"},
    {"report", 0, "FILE", CLI_KIND_TEXT, AT(report), 0, 0, CLI_VIEW,
     "append a line of JSON about the state at F9 and at the end"},
    {"times", 0, NULL, CLI_KIND_FLAG, AT(times), 0, 0, CLI_RENDER, "print how long each pass took"},
    {"skip-existing", 0, NULL, CLI_KIND_FLAG, AT(skip_existing), 0, 0, CLI_BATCH,
     "leave out lines whose output FILE is there and finished: to go on after a stop"},
    {"json", 0, NULL, CLI_KIND_FLAG, AT(json), 0, 0, CLI_INFO, "print JSON"},
    {"quiet", 'q', NULL, CLI_KIND_FLAG, AT(quiet), 0, 0,
     SCENE_COMMANDS | CLI_CHECK | CLI_GROW | CLI_BENCH | CLI_BATCH,
     "print nothing but warnings, errors and what was asked for"},
    {"help", 'h', NULL, CLI_KIND_FLAG, AT(help), 0, 0, CLI_EVERY, "print this and exit"},
    {0},
};

const struct cli_option *cli_option_table(void)
{
    return option_table;
}

const char *const *cli_view_names(void)
{
    static const char *const names[] = {"lit",     "lod",    "albedo", "normal",
                                        "tree-id", "shadow", NULL};
    return names;
}

/* Edits (insert, delete, replace) that turn `a` into `b`; both shorter than 64 characters. */
static unsigned edit_distance(const char *a, const char *b)
{
    unsigned row[64];
    size_t b_length = strlen(b);
    if (b_length >= 64 || strlen(a) >= 64)
        return UINT32_MAX;
    for (unsigned j = 0; j <= b_length; j++)
        row[j] = j;
    for (unsigned i = 1; a[i - 1]; i++) {
        unsigned diagonal = row[0];
        row[0] = i;
        for (unsigned j = 1; j <= b_length; j++) {
            unsigned best = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            if (row[j] + 1 < best)
                best = row[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            row[j] = best;
        }
    }
    return row[b_length];
}

const char *cli_suggest(const char *word, const char *const *names)
{
    const char *best = NULL;
    unsigned best_distance = 1 + (unsigned)(strlen(word) / 3);
    for (; *names; names++) {
        unsigned distance = edit_distance(word, *names);
        if (distance <= best_distance && (!best || distance < best_distance)) {
            best = *names;
            best_distance = distance;
        }
    }
    return best;
}

static bool complain(const struct cli_command *command, const char *what, const char *word,
                     const char *more)
{
    fprintf(stderr, "weald %s: %s%s%s\n", command->name, what, word, more);
    fprintf(stderr, "Try 'weald %s --help'.\n", command->name);
    return false;
}

static bool complain_unknown(const struct cli_command *command, const char *word)
{
    const char *names[sizeof option_table / sizeof *option_table];
    size_t count = 0;
    for (const struct cli_option *option = option_table; option->name; option++)
        if (option->commands & command->bit)
            names[count++] = option->name;
    names[count] = NULL;

    char bare[64], more[128] = "";
    snprintf(bare, sizeof bare, "%s", word + strspn(word, "-"));
    bare[strcspn(bare, "=")] = 0;
    const char *suggestion = cli_suggest(bare, names);
    if (suggestion)
        snprintf(more, sizeof more, ", did you mean --%s?", suggestion);
    return complain(command, "there is no option ", word, more);
}

static const struct cli_option *find_option(const struct cli_command *command, const char *word)
{
    for (const struct cli_option *option = option_table; option->name; option++) {
        if (!(option->commands & command->bit))
            continue;
        if (word[1] != '-' && option->letter && word[1] == option->letter && !word[2])
            return option;
        size_t length = strlen(option->name);
        if (word[1] == '-' && !strncmp(word + 2, option->name, length) &&
            (!word[2 + length] || word[2 + length] == '='))
            return option;
    }
    return NULL;
}

static bool parse_size(const char *text, uint32_t size_px[2])
{
    char *end;
    unsigned long long width = strtoull(text, &end, 10);
    if (end == text || (*end != 'x' && *end != 'X') || *text == '-')
        return false;
    const char *second = end + 1;
    unsigned long long height = strtoull(second, &end, 10);
    if (end == second || *end || *second == '-')
        return false;
    if (width < 1 || height < 1 || width > CLI_MAX_SIZE_PX || height > CLI_MAX_SIZE_PX)
        return false;
    size_px[0] = (uint32_t)width;
    size_px[1] = (uint32_t)height;
    return true;
}

static bool parse_whole(const char *text, const struct cli_option *option, uint32_t *value)
{
    char *end;
    errno = 0;
    unsigned long long number = strtoull(text, &end, 10);
    if (end == text || *end || errno || *text == '-' || (double)number < option->min ||
        (double)number > option->max)
        return false;
    *value = (uint32_t)number;
    return true;
}

static bool parse_real(const char *text, const struct cli_option *option, double *value)
{
    char *end;
    double number = strtod(text, &end);
    if (end == text || *end || !isfinite(number) || number < option->min || number > option->max)
        return false;
    *value = number;
    return true;
}

static bool parse_view(const char *text, enum wd_view_mode *view)
{
    const char *const *names = cli_view_names();
    for (int i = 0; names[i]; i++)
        if (!strcmp(names[i], text)) {
            *view = (enum wd_view_mode)i;
            return true;
        }
    return false;
}

static bool add_word(const char *text, struct cli_words *words)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || words->count == CLI_MAX_WORDS)
        return false;
    words->words[words->count++] = text;
    return true;
}

static bool store(const struct cli_option *option, const char *text, struct cli_options *options)
{
    void *field = (char *)options + option->offset;
    switch (option->kind) {
    case CLI_KIND_FLAG:
        *(bool *)field = true;
        return true;
    case CLI_KIND_TEXT:
        *(const char **)field = text;
        return *text != 0;
    case CLI_KIND_SIZE:
        return parse_size(text, field);
    case CLI_KIND_WHOLE:
        return parse_whole(text, option, field);
    case CLI_KIND_REAL:
        return parse_real(text, option, field);
    case CLI_KIND_VIEW:
        return parse_view(text, field);
    case CLI_KIND_WORDS:
        return add_word(text, field);
    }
    return false;
}

static bool complain_value(const struct cli_command *command, const struct cli_option *option,
                           const char *text)
{
    char what[64], more[256] = " is not usable";
    snprintf(what, sizeof what, "--%s ", option->name);
    switch (option->kind) {
    case CLI_KIND_SIZE:
        snprintf(more, sizeof more,
                 ": a size is WIDTHxHEIGHT in pixels, each from %g to %g, as in 1280x720",
                 option->min, option->max);
        break;
    case CLI_KIND_WHOLE:
        snprintf(more, sizeof more, ": must be a whole number from %.0f to %.0f", option->min,
                 option->max);
        break;
    case CLI_KIND_REAL:
        snprintf(more, sizeof more, ": must be a number from %g to %g", option->min, option->max);
        break;
    case CLI_KIND_VIEW: {
        const char *suggestion = cli_suggest(text, cli_view_names());
        snprintf(more, sizeof more, ": must be lit, lod, albedo, normal, tree-id or shadow%s%s%s",
                 suggestion ? "; did you mean " : "", suggestion ? suggestion : "",
                 suggestion ? "?" : "");
        break;
    }
    case CLI_KIND_WORDS:
        snprintf(more, sizeof more, ": must be %s, and given %d times at most", option->value,
                 CLI_MAX_WORDS);
        break;
    case CLI_KIND_TEXT:
        snprintf(more, sizeof more, "must not be empty");
        break;
    case CLI_KIND_FLAG:
        break;
    }
    return complain(command, what, text, more);
}

/* Reads the option at words[*index] and moves *index past its last word. */
static bool parse_option(const struct cli_command *command, int word_count, char **words,
                         int *index, struct cli_options *options)
{
    const char *word = words[(*index)++];
    const struct cli_option *option = find_option(command, word);
    if (!option)
        return complain_unknown(command, word);
    const char *text = word[1] == '-' ? strchr(word, '=') : NULL;
    if (text)
        text++;
    if (option->kind == CLI_KIND_FLAG && text)
        return complain(command, word, " takes no value", "");
    if (option->kind != CLI_KIND_FLAG && !text) {
        if (*index >= word_count)
            return complain(command, word, " needs a value: ", option->value);
        text = words[(*index)++];
    }
    return store(option, text, options) || complain_value(command, option, text);
}

static bool check_operands(const struct cli_command *command, const struct cli_options *options)
{
    if (options->operand_count < command->operands_min)
        return complain(command, "missing: ", command->operands, "");
    if (options->operand_count > command->operands_max)
        return complain(command, "one too many: ", options->operands[command->operands_max], "");
    return true;
}

bool cli_options_parse(const struct cli_command *command, int word_count, char **words,
                       char **operands, struct cli_options *options)
{
    options->operands = operands;
    bool options_over = false;
    for (int i = 0; i < word_count;) {
        if (!options_over && !strcmp(words[i], "--")) {
            options_over = true;
            i++;
        } else if (options_over || words[i][0] != '-' || !words[i][1]) {
            operands[options->operand_count++] = words[i++];
        } else if (!parse_option(command, word_count, words, &i, options)) {
            return false;
        }
    }
    return options->help || check_operands(command, options);
}
