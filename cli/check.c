#include "cli.h"

#include <stdio.h>

enum cli_status cli_check(struct cli_session *session)
{
    const struct cli_options *options = session->options;
    enum cli_status status = CLI_OK;
    for (int i = 0; i < options->operand_count; i++) {
        if (wd_file_check(options->operands[i], options->data, &session->log) == WD_OK)
            cli_say(session, "%s: ok\n", options->operands[i]);
        else
            status = CLI_FAILED;
    }
    return status;
}
