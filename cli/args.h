/* args.h: the table of options and the parser that reads command lines by it. */
#ifndef CLI_ARGS_H
#define CLI_ARGS_H

#include "cli.h"

enum cli_kind {
    CLI_KIND_FLAG,  /* bool */
    CLI_KIND_TEXT,  /* const char * */
    CLI_KIND_SIZE,  /* uint32_t[2] */
    CLI_KIND_WHOLE, /* uint32_t within min..max */
    CLI_KIND_REAL,  /* double within min..max */
    CLI_KIND_VIEW,  /* enum wd_view_mode */
    CLI_KIND_WORDS, /* struct cli_words: KEY=VALUE, may be given again */
};

struct cli_option {
    const char *name;  /* without the dashes */
    char letter;       /* 0: none */
    const char *value; /* as help shows it; NULL for a flag */
    enum cli_kind kind;
    size_t offset; /* in struct cli_options */
    double min, max;
    unsigned commands; /* cli_command_bit */
    const char *help;
};

/* All options, ended by one without a name. */
const struct cli_option *cli_option_table(void);

/* Reads `words` (after the command's name) into `*options`, which starts zeroed. `operands` must
 * have room for word_count pointers. Complains on standard error and returns false if a word
 * cannot be understood. */
bool cli_options_parse(const struct cli_command *command, int word_count, char **words,
                       char **operands, struct cli_options *options);

/* The one of `names` (ended by NULL) that `word` is most likely a misspelling of, or NULL. */
const char *cli_suggest(const char *word, const char *const *names);

/* Names of the view modes in the order of enum wd_view_mode, ended by NULL. */
const char *const *cli_view_names(void);

#endif
