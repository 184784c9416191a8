#include "help.h"

#include <string.h>

#include "args.h"

static const char controls[] =
    "  W A S D        move            right button   look around (or G to grab the mouse)\n"
    "  Q E            down, up        Shift          five times as fast; the wheel sets the speed\n"
    "  F              fly or walk     M, Shift+M     next method, the one before\n"
    "  L              colour by level of detail      T  times and tree counts\n"
    "  left button    tell of a tree: id, species, height\n"
    "  B              one sample a frame, or many gathered over frames\n"
    "  O, Shift+O     sun a quarter of an hour later, earlier\n"
    "  C, Shift+C     next camera, save this one     P  play the path\n"
    "  F9, F12        report line, screenshot        H  help        Esc  quit\n";

void cli_help_program(FILE *to)
{
    fprintf(to, "weald: forests from terrain, species and inventories, drawn with Vulkan\n\n"
                "Usage: weald COMMAND [OPTIONS]\n\nCommands:\n");
    for (const struct cli_command *command = cli_commands(); command->name; command++)
        fprintf(to, "  %-9s %s\n", command->name, command->summary);
    fprintf(to, "\n  --version, --help\n\nExamples:\n"
                "  weald render scenes/valley.json -o valley.png\n"
                "  weald view scenes/valley.json\n"
                "  weald info scenes/valley.json\n\n"
                "'weald COMMAND --help' tells all about a command.\n");
}

enum { COLUMNS = 80, TEXT_COLUMN = 28 };

/* From the text's column on, where further lines begin, too. */
static void print_words(FILE *to, const char *text)
{
    for (int column = TEXT_COLUMN; *text;) {
        int length = (int)strcspn(text, " ");
        if (column > TEXT_COLUMN && column + 1 + length > COLUMNS) {
            fprintf(to, "\n%*s", TEXT_COLUMN, "");
            column = TEXT_COLUMN;
        } else if (column > TEXT_COLUMN) {
            fputc(' ', to);
            column++;
        }
        fprintf(to, "%.*s", length, text);
        column += length;
        text += length + strspn(text + length, " ");
    }
    fputc('\n', to);
}

static void print_option(FILE *to, const struct cli_option *option)
{
    char left[64];
    char letter[8] = "    ";
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(left, sizeof left, "%s--%s%s%s", letter, option->name, option->value ? " " : "",
             option->value ? option->value : "");
    if (fprintf(to, "  %-*s ", TEXT_COLUMN - 3, left) > TEXT_COLUMN)
        fprintf(to, "\n%*s", TEXT_COLUMN, "");
    print_words(to, option->help);
}

void cli_help_command(FILE *to, const struct cli_command *command)
{
    fprintf(to, "Usage: weald %s %s%s[OPTIONS]\n\n%s\n\nOptions:\n", command->name,
            command->operands, *command->operands ? " " : "", command->description);
    for (const struct cli_option *option = cli_option_table(); option->name; option++)
        if (option->commands & command->bit)
            print_option(to, option);
    if (command->bit == CLI_RENDER || command->bit == CLI_VIEW) {
        fprintf(to, "\nMethods:");
        for (const char *const *name = wd_method_names(); *name; name++)
            fprintf(to, " %s", *name);
        fprintf(to, "\n");
    }
    if (command->bit == CLI_VIEW)
        fprintf(to, "\nKeys:\n%s", controls);
    fprintf(to, "\nExamples:\n%s", command->examples);
}

/* Text with what roff would take for its own escaped. */
static void print_roff(FILE *to, const char *text)
{
    bool line_start = true;
    for (; *text; text++) {
        if (line_start && (*text == '.' || *text == '\''))
            fputs("\\&", to);
        if (*text == '\\')
            fputs("\\e", to);
        else if (*text == '-')
            fputs("\\-", to);
        else
            fputc(*text, to);
        line_start = *text == '\n';
    }
}

static void print_roff_literal(FILE *to, const char *text)
{
    fputs(".nf\n", to);
    print_roff(to, text);
    fputs(".fi\n", to);
}

static void manual_command(FILE *to, const struct cli_command *command)
{
    fprintf(to, ".SS weald %s %s\n", command->name, command->operands);
    print_roff(to, command->description);
    fputs("\n", to);
    for (const struct cli_option *option = cli_option_table(); option->name; option++) {
        if (!(option->commands & command->bit))
            continue;
        fputs(".TP\n.B ", to);
        if (option->letter)
            fprintf(to, "\\-%c, ", option->letter);
        fputs("\\-\\-", to);
        print_roff(to, option->name);
        if (option->value)
            fprintf(to, " \\fI%s\\fR", option->value);
        fputs("\n", to);
        print_roff(to, option->help);
        fputs("\n", to);
    }
    if (command->bit == CLI_VIEW) {
        fputs(".PP\nKeys:\n", to);
        print_roff_literal(to, controls);
    }
    fputs(".PP\nExamples:\n", to);
    print_roff_literal(to, command->examples);
}

void cli_help_manual(FILE *to)
{
    fprintf(to, ".TH WEALD 1 \"\" \"weald %s\" \"User Commands\"\n", wd_version());
    fputs(
        ".SH NAME\nweald \\- draw forests from terrain, species and inventories\n"
        ".SH SYNOPSIS\n.B weald\n.I COMMAND\n[\\fIOPTIONS\\fR]\n"
        ".SH DESCRIPTION\n"
        "weald reads a scene file (terrain, species, layers of trees or a tree inventory, light,\n"
        "cameras), plants the forest and draws it with Vulkan: as a picture, a film, layers for\n"
        "measurement, or in a window to walk through.\n"
        ".SH COMMANDS\n",
        to);
    for (const struct cli_command *command = cli_commands(); command->name; command++)
        manual_command(to, command);
    fputs(
        ".SH EXIT STATUS\n"
        "0: done. 1: failed, the message says why. 2: the command line is wrong.\n"
        "3: there is no display for a window. 130: stopped by Ctrl\\-C; finished frames of a film\n"
        "are kept.\n"
        ".SH FILES\n"
        ".I $XDG_CACHE_HOME/weald\n(or ~/.cache/weald, without a home /tmp/weald-UID) holds what was made from trees once.\n"
        "It may be deleted at any time.\n",
        to);
}

enum cli_status cli_manual(struct cli_session *session)
{
    (void)session;
    cli_help_manual(stdout);
    return CLI_OK;
}
