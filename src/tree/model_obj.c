#include "tree/model_obj.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "tree/model_beside.h"

bool wd_model_is_obj(const char *path)
{
    return wd_has_ending(path, ".obj");
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* In lines of vertices alone, for names may begin with a point. */
size_t wd_model_obj_add_zeroes(char *to, const char *from, size_t size)
{
    size_t length = 0;
    bool vertex = false;
    for (size_t i = 0; i < size; i++) {
        if (i == 0 || from[i - 1] == '\n')
            vertex = from[i] == 'v';
        bool lacks = vertex && from[i] == '.' && i > 0 && is_blank(from[i - 1]) &&
                     i + 1 < size && from[i + 1] >= '0' && from[i + 1] <= '9';
        if (lacks && to)
            to[length] = '0';
        length += lacks;
        if (to)
            to[length] = from[i];
        length++;
    }
    return length;
}

/* --- materials --------------------------------------------------------------------------- */

/* What follows the word that a line begins with; NULL: it begins with another. */
static char *after_word(char *line, const char *word)
{
    size_t length = strlen(word);
    if (strncmp(line, word, length) != 0 || !is_blank(line[length]))
        return NULL;
    char *text = line + length + strspn(line + length, " \t");
    text[strcspn(text, "\r\n")] = '\0';
    return text;
}

/* The library that the file names first, and whether it has materials before one or without. */
static char *find_library(const char *path, bool *materials)
{
    FILE *file = wd_model_is_obj(path) ? fopen(path, "rb") : NULL;
    char *line = NULL, *found = NULL;
    size_t room = 0;
    *materials = false;
    while (file && !found && getline(&line, &room, file) > 0) {
        char *start = line + (strncmp(line, "\xef\xbb\xbf", 3) == 0 ? 3 : 0);
        char *name = after_word(start, "mtllib");
        *materials = *materials || after_word(start, "usemtl");
        if (name)
            found = wd_model_beside(path, name);
    }
    free(line);
    if (file)
        fclose(file);
    if (found && !wd_file_is_plain(found)) { /* assimp takes the one of the model's own name then */
        char *own = wd_format("%.*smtl", (int)(strlen(path) - strlen("obj")), path);
        char *there = wd_model_find(own);
        free(own);
        if (there)
            free(found);
        found = there ? there : found;
    }
    return found;
}

char *wd_model_obj_library(const char *path)
{
    bool materials;
    return find_library(path, &materials);
}

char *wd_model_obj_lacks(const char *path)
{
    bool materials;
    char *library = find_library(path, &materials), *lacks = NULL;
    if (library && !wd_file_is_plain(library))
        lacks = wd_format("its material library %s is not there", library);
    else if (!library && materials)
        lacks = wd_strdup("names materials (usemtl) but no library that has them (mtllib)");
    free(library);
    return lacks;
}
