#include "cli.h"

#include <stdio.h>
#include <string.h>

#include "args.h"

static void print_method(uint32_t index, const struct wd_method_info *info)
{
    struct wd_method_option option;
    printf("%s  (%s)\n  %s\n", info->name, info->rows, info->summary);
    for (uint32_t i = 0; wd_method_get_option(index, i, &option); i++)
        printf("    %-20s %s (default %s; %s)\n%25s%s\n", option.name, option.allowed,
               option.fallback, option.row, "", option.summary);
}

enum cli_status cli_methods(struct cli_session *session)
{
    const struct cli_options *options = session->options;
    const char *wanted = options->operand_count ? options->operands[0] : NULL;
    if (wanted && !cli_method_known(session, wanted))
        return CLI_USAGE;
    struct wd_method_info info;
    for (uint32_t i = 0; wd_method_get_info(i, &info); i++) {
        if (!wanted || !strcmp(wanted, info.name))
            print_method(i, &info);
    }
    return CLI_OK;
}
