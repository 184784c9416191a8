#include "tree/model_io.h"

#include <assimp/cfileio.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "tree/model_beside.h"
#include "tree/model_gltf.h"
#include "tree/model_obj.h"

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

/* --- what is put right ------------------------------------------------------------------- */

static void drop_mark(struct text *text)
{
    static const char mark[3] = {'\xef', '\xbb', '\xbf'};
    if (text->size < sizeof mark || memcmp(text->bytes, mark, sizeof mark) != 0)
        return;
    text->size -= sizeof mark;
    memmove(text->bytes, text->bytes + sizeof mark, text->size + 1);
}

static void add_zeroes(struct text *text)
{
    size_t longer = wd_model_obj_add_zeroes(NULL, text->bytes, text->size);
    char *whole = longer > text->size ? malloc(longer + 1) : NULL;
    if (!whole)
        return;
    wd_model_obj_add_zeroes(whole, text->bytes, text->size);
    whole[longer] = '\0';
    free(text->bytes);
    *text = (struct text){whole, longer, 0};
}

/* The JSON of a glTF file, of a GLB its first chunk. */
static struct text json_of(const struct text *text, const char *path)
{
    enum { HEAD = 20 };
    const uint8_t *head = (const uint8_t *)text->bytes;
    if (wd_has_ending(path, ".gltf"))
        return *text;
    if (!wd_has_ending(path, ".glb") || text->size < HEAD)
        return (struct text){0};
    size_t size = head[12] | (size_t)head[13] << 8 | (size_t)head[14] << 16 | (size_t)head[15] << 24;
    return (struct text){text->bytes + HEAD, size < text->size - HEAD ? size : text->size - HEAD, 0};
}

/* Gives the keys "skin" and "skins" other names. Returns how many there were. */
static size_t hide_skins(struct text *text, const char *path)
{
    static const char key[] = "\"skin";
    struct text json = json_of(text, path);
    size_t count = 0;
    if (!json.bytes)
        return 0;
    char *end = json.bytes + json.size;
    for (char *at = json.bytes; (at = memmem(at, (size_t)(end - at), key, sizeof key - 1)); at++) {
        char *after = at + sizeof key - 1;
        after += after < end && *after == 's';
        if (after == end || *after != '"')
            continue;
        for (after++; after < end && strchr(" \t\r\n", *after);)
            after++;
        if (after == end || *after != ':')
            continue;
        at[2] = '_';
        count++;
    }
    return count;
}

static void mend(struct text *text, const char *path)
{
    bool obj = wd_model_is_obj(path);
    if (obj || wd_has_ending(path, ".mtl"))
        drop_mark(text);
    if (obj)
        add_zeroes(text);
    hide_skins(text, path);
}

static struct wd_model_traits traits_of(const char *path)
{
    struct text text = {0};
    struct wd_model_traits traits = {0};
    if (wd_has_ending(path, ".gltf") || wd_has_ending(path, ".glb"))
        text.bytes = read_whole(path, &text.size);
    if (text.bytes) {
        struct text json = json_of(&text, path);
        traits.whole_numbers = json.bytes ? wd_gltf_whole_numbers(json.bytes, json.size) : NULL;
        traits.fault = json.bytes ? wd_gltf_fault(json.bytes, json.size, &traits.broken) : NULL;
        traits.skins = hide_skins(&text, path) > 0;
    }
    free(text.bytes);
    return traits;
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
    char *there = strchr(mode, 'w') ? NULL : wd_model_find(path);
    char *bytes = there ? read_whole(there, &size) : NULL;
    free(there);
    struct text *text = bytes ? calloc(1, sizeof *text) : NULL;
    struct aiFile *file = text ? calloc(1, sizeof *file) : NULL;
    if (!file) {
        free(bytes);
        free(text);
        return NULL;
    }
    *text = (struct text){bytes, size, 0};
    mend(text, path);
    *file = (struct aiFile){.ReadProc = read_items, .WriteProc = write_items, .TellProc = tell,
                            .FileSizeProc = size_of, .SeekProc = seek, .FlushProc = flush,
                            .UserData = (char *)text};
    return file;
}

struct aiFileIO *wd_model_io(const char *path, struct wd_model_traits *traits)
{
    *traits = traits_of(path);
    bool others = wd_model_is_obj(path) || wd_has_ending(path, ".gltf"); /* names of files beside it */
    struct aiFileIO *io = traits->skins || others ? calloc(1, sizeof *io) : NULL;
    if (io)
        *io = (struct aiFileIO){.OpenProc = open_file, .CloseProc = close_file};
    return io;
}

bool wd_model_has_word(const char *path, const char *word)
{
    enum { ENOUGH = 1 << 20 };
    FILE *stream = fopen(path, "rb");
    char *head = stream ? malloc(ENOUGH) : NULL;
    size_t size = head ? fread(head, 1, ENOUGH, stream) : 0;
    bool found = size > 0 && memmem(head, size, word, strlen(word));
    free(head);
    if (stream)
        fclose(stream);
    return found;
}
