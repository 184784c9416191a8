#include "cli.h"

#include <stdio.h>
#include <stdlib.h>

enum cli_status cli_schema(struct cli_session *session)
{
    const char *kind = session->options->operands[0];
    char *text = wd_schema_text(kind);
    if (!text) {
        cli_fail(session, "there is no schema of \"%s\"; there are: scene, species, model", kind);
        return CLI_USAGE;
    }
    puts(text);
    free(text);
    return CLI_OK;
}
