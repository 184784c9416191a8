#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "args.h"
#include "output_name.h"

/* What a line may ask for: commands that end by themselves. */
enum { OF_LINES = CLI_RENDER | CLI_GROW | CLI_EXPORT | CLI_INFO | CLI_CHECK };
/* Those that write what scenes are made of, and draw forests of their own. */
enum { MAKERS_OF_SOURCES = CLI_GROW | CLI_EXPORT };

struct line {
    uint32_t number;
    char *text;   /* words end in it */
    char **words; /* of the command, then operands */
    const struct cli_command *command; /* NULL: an empty line */
    struct cli_options options;
    bool left_out; /* its output was there before the first line ran */
};

struct batch {
    struct cli_session *session;
    const char *path;
    struct line *lines;
    uint32_t count;
};

static bool complain(const struct batch *batch, uint32_t number, const char *what, const char *more)
{
    return cli_fail(batch->session, "%s:%u: %s%s", batch->path, number, what, more);
}

/* Ends the next word of a shell's line in place: blanks part words but within quotes, # begins a comment. NULL: none
 * is left. `*sound` becomes false where a quote is not closed. */
static char *next_word(char **at, bool *sound)
{
    char *from = *at + strspn(*at, " \t\r\n"), *to = from, *word = from;
    char quote = 0;
    if (!*from || *from == '#')
        return NULL;
    for (; *from && (quote || !strchr(" \t\r\n", *from)); from++) {
        if (*from == quote)
            quote = 0;
        else if (!quote && (*from == '"' || *from == '\''))
            quote = *from;
        else
            *to++ = *from;
    }
    *sound = !quote;
    *at = *from ? from + 1 : from;
    *to = 0;
    return word;
}

static bool read_line(struct batch *batch, struct line *line)
{
    size_t room = strlen(line->text) / 2 + 2, count = 0;
    char *at = line->text;
    bool sound = true;
    line->words = calloc(2 * room, sizeof *line->words);
    if (!line->words)
        return complain(batch, line->number, "out of memory", "");
    for (char *word; (word = next_word(&at, &sound)); count++)
        line->words[count] = word;
    if (!sound)
        return complain(batch, line->number, "a quote is not closed", "");
    if (!count)
        return true;
    line->command = cli_command_find(line->words[0]);
    if (!line->command || !(line->command->bit & OF_LINES))
        return complain(batch, line->number,
                        "a line begins with render, grow, export, info or check, not with ", line->words[0]);
    if (!cli_options_parse(line->command, (int)count - 1, line->words + 1, line->words + room, &line->options))
        return complain(batch, line->number, "this line cannot be run; nothing was begun", "");
    return !line->options.help || complain(batch, line->number, "--help has no place in a line", "");
}

static bool add_line(struct batch *batch, const char *text, uint32_t number)
{
    struct line *lines = realloc(batch->lines, (batch->count + 1) * sizeof *lines);
    if (!lines)
        return complain(batch, number, "out of memory", "");
    batch->lines = lines;
    struct line *line = &lines[batch->count++];
    *line = (struct line){.number = number, .text = strdup(text)};
    return line->text ? read_line(batch, line) : complain(batch, number, "out of memory", "");
}

/* Some editors put a byte order mark before UTF-8. */
static size_t mark_length(const char *text)
{
    static const char mark[] = "\xef\xbb\xbf";
    size_t length = sizeof mark - 1;
    return strncmp(text, mark, length) == 0 ? length : 0;
}

static bool read_lines(struct batch *batch)
{
    FILE *file = strcmp(batch->path, "-") ? fopen(batch->path, "r") : stdin;
    char *text = NULL;
    size_t size = 0;
    bool ok = true;
    if (!file)
        return cli_fail(batch->session, "%s: no such file can be read", batch->path);
    ssize_t length;
    for (uint32_t number = 1; ok && (length = getline(&text, &size, file)) >= 0; number++)
        ok = !memchr(text, 0, (size_t)length) ? add_line(batch, text + (number == 1 ? mark_length(text) : 0), number)
                                              : complain(batch, number, "has a zero byte; lines are text in UTF-8", "");
    if (ok && ferror(file))
        ok = cli_fail(batch->session, "%s: reading it failed", batch->path);
    free(text);
    if (file != stdin)
        fclose(file);
    return ok;
}

static void leave_out_done(struct batch *batch)
{
    uint32_t left_out = 0;
    for (uint32_t i = 0; i < batch->count; i++) {
        const struct line *line = &batch->lines[i];
        bool done = line->command && line->options.output && cli_output_is_done(line->options.output, line->options.only);
        left_out += batch->lines[i].left_out = done;
    }
    if (left_out && !batch->session->options->quiet)
        fprintf(stderr, "weald: %s: %u lines left out, their output is there\n", batch->path, left_out);
}

/* What a line that failed leaves may be of a lost device. */
static enum cli_status run_line(struct batch *batch, struct line *line)
{
    struct cli_session *session = batch->session;
    const struct cli_options *own = session->options;
    line->options.quiet |= own->quiet;
    cli_session_take(session, &line->options);
    if (line->command->bit & MAKERS_OF_SOURCES)
        cli_kept_drop_forest(session->kept);
    enum cli_status status = line->command->run(session);
    if (status != CLI_OK)
        cli_kept_drop_forest(session->kept);
    cli_session_take(session, own);
    if (status != CLI_OK && !cli_session_interrupted(session))
        complain(batch, line->number, "failed: ", line->command->name);
    return status;
}

static bool is_wanted(const struct line *line)
{
    return line->command && !line->left_out;
}

/* `next`: the first line that is not done. */
static enum cli_status stopped(const struct batch *batch, uint32_t next, uint32_t run, uint32_t failed)
{
    uint32_t wanted = 0;
    char of_them[32] = "";
    for (uint32_t i = 0; i < batch->count; i++)
        wanted += is_wanted(&batch->lines[i]);
    if (failed)
        snprintf(of_them, sizeof of_them, " (%u failed)", failed);
    fprintf(stderr, "weald: %s: stopped; %u of %u lines done%s, the next is line %u: with --skip-existing the same command goes "
            "on from there\n", batch->path, run, wanted, of_them, batch->lines[next].number);
    return cli_session_status(batch->session, WD_ERROR_INTERRUPTED);
}

static enum cli_status run_lines(struct batch *batch)
{
    double begin_s = cli_seconds();
    uint32_t run = 0, failed = 0;
    if (batch->session->options->skip_existing)
        leave_out_done(batch);
    for (uint32_t i = 0; i < batch->count; i++) {
        if (!is_wanted(&batch->lines[i]))
            continue;
        enum cli_status status = cli_session_interrupted(batch->session) ? CLI_FAILED : run_line(batch, &batch->lines[i]);
        if (status != CLI_OK && cli_session_interrupted(batch->session))
            return stopped(batch, i, run, failed);
        failed += status != CLI_OK;
        run++;
    }
    if (!batch->session->options->quiet) /* what lines tell has standard output to itself */
        fprintf(stderr, "weald: %s: %u lines, %u failed, %.1f s\n", batch->path, run, failed, cli_seconds() - begin_s);
    return failed ? CLI_FAILED : CLI_OK;
}

enum cli_status cli_batch(struct cli_session *session)
{
    struct batch batch = {.session = session, .path = session->options->operands[0]};
    struct cli_kept kept = {0};
    session->kept = &kept;
    enum cli_status status = read_lines(&batch) ? run_lines(&batch) : CLI_USAGE;
    session->kept = NULL;
    cli_kept_finish(&kept);
    for (uint32_t i = 0; i < batch.count; i++) {
        free(batch.lines[i].text);
        free(batch.lines[i].words);
    }
    free(batch.lines);
    return status;
}
