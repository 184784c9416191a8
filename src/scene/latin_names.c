#include "scene/latin_names.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

#include "base/utf8.h"
#include "scene/species.h"

enum { NAME_ROOM = 256 };

/* What artists' models have for one that nobody told. */
#define NO_LATIN_NAME "unknown"

/* Small, one blank between words; a hybrid's sign is an x. False where it is longer than any name. */
static bool plain(char to[NAME_ROOM], const char *name)
{
    wd_utf8_plain(to, NAME_ROOM, name, strlen(name));
    if (strlen(to) > NAME_ROOM - 8)
        return false;
    char *end = to;
    for (const char *at = to; *at; at++) {
        bool sign = strncmp(at, "\303\227", 2) == 0, gap = *at == ' ' || *at == '_';
        if (!gap || (end > to && end[-1] != ' '))
            *end++ = sign ? 'x' : gap ? ' ' : *at;
        at += sign;
    }
    end -= end > to && end[-1] == ' ';
    *end = 0;
    return true;
}

bool wd_names_alike(const char *a, const char *b)
{
    char first[NAME_ROOM], second[NAME_ROOM];
    return plain(first, a) && plain(second, b) && strcmp(first, second) == 0;
}

/* A word and what follows; NULL: there are not so many. */
static const char *find_word(const char *name, size_t word)
{
    bool gap = true;
    for (; *name; name++) {
        bool no_break = strncmp(name, "\302\240", 2) == 0;
        bool blank = *name == ' ' || *name == '\t' || *name == '_' || no_break;
        if (gap && !blank && word-- == 0)
            return name;
        gap = blank;
        name += no_break;
    }
    return NULL;
}

/* Authors begin with a capital, of Latin-1's too, or a bracket. */
static bool is_author(const char *word)
{
    unsigned char first = (unsigned char)word[0], second = first ? (unsigned char)word[1] : 0;
    return first == '(' || (first >= 'A' && first <= 'Z') ||
           (first == 0xc3 && second >= 0x80 && second <= 0x9e && second != 0x97); /* that is a hybrid's sign */
}

bool wd_name_is_latin(const char *name, const char *latin)
{
    char whole[NAME_ROOM], begin[NAME_ROOM];
    if (strcmp(latin, NO_LATIN_NAME) == 0 || !plain(whole, name) || !plain(begin, latin))
        return false;
    size_t length = strlen(begin), words = 1;
    for (const char *at = begin; *at; at++)
        words += *at == ' ';
    if (strncmp(whole, begin, length) != 0 || whole[length] == 0)
        return strcmp(whole, begin) == 0;
    const char *author = find_word(name, words);
    return words > 1 && whole[length] == ' ' && author && is_author(author);
}

bool wd_name_has_words(const char *name)
{
    return find_word(name, 1) != NULL;
}

static bool is_listed(const struct wd_latin_names *latin, const char *name)
{
    for (size_t i = 0; i < latin->count; i++)
        if (strcmp(latin->names[i].name, name) == 0)
            return true;
    return false;
}

static void add_file(struct wd_latin_names *latin, const char *folder, const char *entry)
{
    size_t length = strlen(entry);
    if (length <= 5 || strcmp(entry + length - 5, ".json") != 0)
        return;
    struct wd_species species;
    char *name = wd_format("%.*s", (int)length - 5, entry), *file = wd_format("%s/%s", folder, entry);
    if (!is_listed(latin, name)) {
        bool known = wd_species_load(&species, file, &latin->arena, &wd_log_quiet) && species.latin;
        *wd_push(latin->names, latin->count, latin->capacity) = (struct wd_latin_name){
            wd_arena_strdup(&latin->arena, name), known ? species.latin : NO_LATIN_NAME,
            wd_arena_strdup(&latin->arena, file)};
    }
    free(name);
    free(file);
}

static int by_name(const void *first, const void *second)
{
    const struct wd_latin_name *a = first, *b = second;
    return strcmp(a->name, b->name);
}

void wd_latin_names_init(struct wd_latin_names *latin, const struct wd_species_folders *folders)
{
    *latin = (struct wd_latin_names){0};
    for (size_t i = 0; i < folders->count; i++) {
        DIR *folder = opendir(folders->paths[i]);
        for (struct dirent *entry; folder && (entry = readdir(folder));)
            add_file(latin, folders->paths[i], entry->d_name);
        if (folder)
            closedir(folder);
    }
    if (latin->count)
        qsort(latin->names, latin->count, sizeof *latin->names, by_name);
}

void wd_latin_names_finish(struct wd_latin_names *latin)
{
    free(latin->names);
    wd_arena_finish(&latin->arena);
    *latin = (struct wd_latin_names){0};
}

const struct wd_latin_name *wd_latin_names_find(const struct wd_latin_names *latin, const char *name)
{
    for (size_t i = 0; i < latin->count; i++)
        if (wd_name_is_latin(name, latin->names[i].latin))
            return &latin->names[i];
    return NULL;
}
