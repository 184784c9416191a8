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
    bool numbered = wd_film_is_numbered(path);
    if (ends_with(path, ".png"))
        return numbered ? CLI_OUTPUT_NUMBERED_PNG : CLI_OUTPUT_PNG;
    if (ends_with(path, ".exr"))
        return numbered ? CLI_OUTPUT_NUMBERED_EXR : CLI_OUTPUT_EXR;
    return wd_film_has_ending(path) ? CLI_OUTPUT_FILM : CLI_OUTPUT_UNKNOWN;
}

/* A file's own name, or, of a name with %d or %05d, that of the first frame. */
static char *first_name(const char *path, int first)
{
    const char *slash = strrchr(path, '/'), *percent = slash ? slash + 1 : path;
    size_t digits = 0;
    char *name = NULL;
    while ((percent = strchr(percent, '%')) && percent[1 + (digits = strspn(percent + 1, "0123456789"))] != 'd')
        percent++;
    if (!percent || digits > 3)
        return strdup(path);
    if (asprintf(&name, percent[1] == '0' ? "%.*s%0*d%s" : "%.*s%*d%s", (int)(percent - path), path, atoi(percent + 1), first,
                 percent + digits + 2) < 0)
        name = NULL;
    return name;
}

bool cli_output_is_done(const char *path, const char *only)
{
    int number = only ? atoi(only) : 0;
    char *partial = NULL, *first = first_name(path, number);
    if ((number ? asprintf(&partial, "%s.%d.partial", path, number) : asprintf(&partial, "%s.partial", path)) < 0)
        partial = NULL;
    bool done = first && partial && access(first, F_OK) == 0 && access(partial, F_OK) != 0;
    free(first);
    free(partial);
    return done;
}

/* A file's name beside the output, or beside where links lead from there. */
static char *probe_name(const char *path)
{
    char *target = realpath(path, NULL), *probe = NULL;
    const char *at = target ? target : path, *slash = strrchr(at, '/');
    if (asprintf(&probe, "%.*s.weald-XXXXXX", slash ? (int)(slash - at + 1) : 0, at) < 0)
        probe = NULL;
    free(target);
    return probe;
}

bool cli_output_probe(struct cli_session *session, const char *path)
{
    struct stat status;
    bool there = !stat(path, &status);
    if (there && S_ISDIR(status.st_mode))
        return cli_fail(session, "%s is a directory; name a file in it", path);
    if (there && !S_ISREG(status.st_mode))
        return cli_fail(session, "%s is a device, pipe or socket; only plain files are written",
                        path);
    if (there && access(path, W_OK))
        return cli_fail(session, "%s cannot be written: %s", path, strerror(errno));

    char *probe = probe_name(path);
    if (!probe)
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
