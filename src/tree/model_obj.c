#include "tree/model_obj.h"

#include <assimp/cfileio.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

struct text {
    char *bytes;
    size_t size, place;
};

/* The whole file with a zero byte behind it; NULL where it cannot be read. */
static char *read_whole(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    char *bytes = NULL;
    long length = -1;
    *size = 0;
    if (!file)
        return NULL;
    if (fseek(file, 0, SEEK_END) == 0)
        length = ftell(file);
    if (length >= 0 && fseek(file, 0, SEEK_SET) == 0)
        bytes = malloc((size_t)length + 1);
    if (bytes) {
        *size = fread(bytes, 1, (size_t)length, file);
        bytes[*size] = '\0';
    }
    fclose(file);
    return bytes;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Copies the text, or only counts where `to` is NULL, with a zero in each place that lacks one: in
 * lines of vertices alone, for names may begin with a point. */
static size_t add_zeroes(char *to, const char *from, size_t size)
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

bool wd_model_obj_is_short(const char *path)
{
    size_t size;
    char *bytes = wd_has_ending(path, ".obj") ? read_whole(path, &size) : NULL;
    bool lacks = bytes && add_zeroes(NULL, bytes, size) > size;
    free(bytes);
    return lacks;
}

/* --- what assimp asks for ---------------------------------------------------------------- */

static struct text *text_of(struct aiFile *file)
{
    return (struct text *)(void *)file->UserData;
}

static size_t read_items(struct aiFile *file, char *to, size_t size, size_t count)
{
    struct text *text = text_of(file);
    size_t left = size ? (text->size - text->place) / size : 0;
    count = count < left ? count : left;
    memcpy(to, text->bytes + text->place, size * count);
    text->place += size * count;
    return count;
}

static size_t write_items(struct aiFile *file, const char *from, size_t size, size_t count)
{
    (void)file, (void)from, (void)size, (void)count;
    return 0;
}

static size_t tell(struct aiFile *file)
{
    return text_of(file)->place;
}

static size_t size_of(struct aiFile *file)
{
    return text_of(file)->size;
}

static enum aiReturn seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    struct text *text = text_of(file);
    size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? text->place : text->size;
    if (from + offset > text->size)
        return aiReturn_FAILURE;
    text->place = from + offset;
    return aiReturn_SUCCESS;
}

static void flush(struct aiFile *file)
{
    (void)file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    if (!file)
        return;
    free(text_of(file)->bytes);
    free(text_of(file));
    free(file);
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode)
{
    size_t size;
    (void)io;
    char *bytes = strchr(mode, 'w') ? NULL : read_whole(path, &size);
    struct text *text = bytes ? calloc(1, sizeof *text) : NULL;
    struct aiFile *file = text ? calloc(1, sizeof *file) : NULL;
    if (!file) {
        free(bytes);
        free(text);
        return NULL;
    }
    *text = (struct text){bytes, size, 0};
    size_t longer = wd_has_ending(path, ".obj") ? add_zeroes(NULL, bytes, size) : size;
    char *whole = longer > size ? malloc(longer + 1) : NULL;
    if (whole) {
        add_zeroes(whole, bytes, size);
        whole[longer] = '\0';
        free(bytes);
        *text = (struct text){whole, longer, 0};
    }
    *file = (struct aiFile){.ReadProc = read_items, .WriteProc = write_items, .TellProc = tell,
                            .FileSizeProc = size_of, .SeekProc = seek, .FlushProc = flush,
                            .UserData = (char *)text};
    return file;
}

struct aiFileIO *wd_model_obj_io(void)
{
    struct aiFileIO *io = calloc(1, sizeof *io);
    if (io)
        *io = (struct aiFileIO){.OpenProc = open_file, .CloseProc = close_file};
    return io;
}

char *wd_model_obj_library(const char *path)
{
    FILE *file = wd_has_ending(path, ".obj") ? fopen(path, "rb") : NULL;
    char *line = NULL, *found = NULL;
    size_t room = 0;
    while (file && !found && getline(&line, &room, file) > 0) {
        char *name = line + 6;
        if (strncmp(line, "mtllib", 6) != 0 || !is_blank(*name))
            continue;
        name += strspn(name, " \t");
        name[strcspn(name, "\r\n")] = '\0';
        found = wd_path_beside(path, name);
    }
    free(line);
    if (file)
        fclose(file);
    return found;
}
