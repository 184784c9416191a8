#include "output_name.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

static bool ends_with(const char *path, const char *ending)
{
    size_t length = strlen(path), ending_length = strlen(ending);
    return length > ending_length && !strcasecmp(path + length - ending_length, ending);
}

enum cli_output_kind cli_output_kind(const char *path)
{
    bool numbered = strchr(path, '%') != NULL;
    if (ends_with(path, ".png"))
        return numbered ? CLI_OUTPUT_NUMBERED_PNG : CLI_OUTPUT_PNG;
    if (ends_with(path, ".exr"))
        return numbered ? CLI_OUTPUT_NUMBERED_EXR : CLI_OUTPUT_EXR;
    return wd_film_has_ending(path) ? CLI_OUTPUT_FILM : CLI_OUTPUT_UNKNOWN;
}

bool cli_output_probe(struct cli_session *session, const char *path)
{
    struct stat status;
    if (!stat(path, &status) && S_ISDIR(status.st_mode))
        return cli_fail(session, "%s is a directory; name a file in it", path);
    if (!stat(path, &status) && !S_ISREG(status.st_mode))
        return cli_fail(session, "%s is a device, pipe or socket; only plain files are written",
                        path);

    const char *slash = strrchr(path, '/');
    int directory_length = slash ? (int)(slash - path + 1) : 0;
    char *probe = NULL;
    if (asprintf(&probe, "%.*s.weald-XXXXXX", directory_length, path) < 0)
        return cli_fail(session, "out of memory");
    int file = mkstemp(probe);
    if (file < 0) {
        cli_fail(session, "%s cannot be written: %s", path,
                 errno == ENOENT ? "its directory does not exist" : strerror(errno));
        free(probe);
        return false;
    }
    close(file);
    unlink(probe);
    free(probe);
    return true;
}
