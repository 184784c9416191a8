/* output_name.h: what kind of output a file name asks for, and whether it could be written. */
#ifndef CLI_OUTPUT_NAME_H
#define CLI_OUTPUT_NAME_H

#include "cli.h"

enum cli_output_kind {
    CLI_OUTPUT_UNKNOWN,
    CLI_OUTPUT_PNG,
    CLI_OUTPUT_EXR,
    CLI_OUTPUT_FILM,         /* in one file: wd_film_has_ending */
    CLI_OUTPUT_NUMBERED_PNG, /* a name with %d or %05d */
    CLI_OUTPUT_NUMBERED_EXR,
};

enum cli_output_kind cli_output_kind(const char *path);

/* Whether the file, or the first of numbered ones, of those of --only where that is given, is there, and no FILE.partial
 * to go on from. */
bool cli_output_is_done(const char *path, const char *only);

/* Whether a file could be put at `path` now: the directory exists and takes files, nothing but a
 * plain file is in the way. Complains and returns false if not. Leaves nothing behind. */
bool cli_output_probe(struct cli_session *session, const char *path);

#endif
