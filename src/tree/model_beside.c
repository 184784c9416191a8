#include "tree/model_beside.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"

/* Models come from systems where names of any case are one name. Of several the first by strcmp. */
static char *find_in_any_case(const char *path)
{
    if (access(path, F_OK) == 0)
        return wd_strdup(path);
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    char *above = slash ? wd_format("%.*s", (int)(slash - path), path) : NULL, *best = NULL;
    char *folder = above && above[0] ? find_in_any_case(above) : NULL;
    DIR *list = opendir(folder ? folder : slash == path ? "/" : above ? above : ".");
    for (struct dirent *entry; list && (entry = readdir(list));) {
        if (strcasecmp(entry->d_name, name) != 0 || (best && strcmp(entry->d_name, best) > 0))
            continue;
        free(best);
        best = wd_strdup(entry->d_name);
    }
    if (list)
        closedir(list);
    char *found = best ? wd_format("%s%s%s", folder ? folder : "", slash ? "/" : "", best) : NULL;
    free(best);
    free(folder);
    free(above);
    return found;
}

static int hex_digit(char c)
{
    const char *digits = "0123456789abcdef0123456789ABCDEF", *at = c ? strchr(digits, c) : NULL;
    return at ? (int)((at - digits) % 16) : -1;
}

static void undo_escapes(char *text)
{
    char *to = text;
    for (const char *from = text; *from; from++) {
        int high = *from == '%' ? hex_digit(from[1]) : -1, low = high >= 0 ? hex_digit(from[2]) : -1;
        bool escape = low >= 0 && 16 * high + low > 0;
        *to++ = escape ? (char)(16 * high + low) : *from;
        from += escape ? 2 : 0;
    }
    *to = '\0';
}

static char *find_plain(const char *path)
{
    char *found = find_in_any_case(path);
    if (found && wd_file_is_plain(found))
        return found;
    free(found);
    return NULL;
}

char *wd_model_find(const char *path)
{
    char *found = find_plain(path);
    if (found || !strchr(path, '%'))
        return found;
    char *plain = wd_strdup(path);
    undo_escapes(plain);
    found = find_plain(plain);
    free(plain);
    return found;
}

char *wd_model_beside(const char *model_path, const char *name)
{
    char *slashes = wd_strdup(name);
    for (char *c = slashes; *c; c++)
        if (*c == '\\')
            *c = '/';
    char *whole = wd_path_beside(model_path, slashes), *found = wd_model_find(whole);
    const char *slash = strrchr(slashes, '/');
    if (!found && slash) {
        char *last = wd_path_beside(model_path, slash + 1);
        found = wd_model_find(last);
        free(last);
    }
    free(slashes);
    if (!found)
        return whole;
    free(whole);
    return found;
}
