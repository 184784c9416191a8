/* help.h: help texts and the manual page, both made from the tables of commands and options. */
#ifndef CLI_HELP_H
#define CLI_HELP_H

#include <stdio.h>

#include "cli.h"

void cli_help_program(FILE *to);
void cli_help_command(FILE *to, const struct cli_command *command);
/* The manual page in roff. */
void cli_help_manual(FILE *to);

#endif
