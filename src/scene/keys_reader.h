/* keys_reader.h: what keys.c and keys_value.c share while a file is read. */
#ifndef WD_SCENE_KEYS_READER_H
#define WD_SCENE_KEYS_READER_H

#include <jansson.h>

#include "scene/json_text.h"
#include "scene/keys.h"

struct wd_keys_reader {
    const char *path;
    const char *text;  /* as written */
    const char *clean; /* comments blanked, same offsets */
    size_t size;
    struct wd_arena *arena;
    const struct wd_log *log;
    const void *user;
    const char *const *settings;   /* as given; NULL: none */
    char **setting_paths;          /* of each its path, without "@"; NULL: it could not be set */
    const json_t *json;            /* the text's, with the settings in it; NULL: not read yet */
    unsigned errors, warnings;
};

/* Errors, and warnings, of one file that are logged; the rest is counted. */
enum { WD_KEYS_ERROR_LIMIT = 20 };

/* Fills an object's struct from its JSON. */
bool wd_keys_read_object(const struct wd_keys *table, json_t *json,
                         const struct wd_keys_place *place, void *object);

/* Fills one member; `place` is the object that holds it. */
bool wd_keys_read_value(const struct wd_key *key, json_t *json, const struct wd_keys_place *place,
                        void *object);

/* As wd_keys_error, but points at the key, not at its value. */
bool wd_keys_error_at_key(const struct wd_keys_place *place, const char *key, const char *format,
                          ...) __attribute__((format(printf, 3, 4)));

/* Puts the reader's settings into the text's JSON and notes their paths. */
bool wd_keys_apply_settings(struct wd_keys_reader *reader, const struct wd_keys *table,
                            json_t *root);
void wd_keys_settings_finish(struct wd_keys_reader *reader);
/* The newest setting that a value at that path ("layers[0].name") came with, or NULL. `rest`: where the
 * value is in what was set, "" if it is that. */
const char *wd_keys_setting_of(const struct wd_keys_reader *reader, const char *path,
                               const char **rest);

/* What a key takes, for messages: "a number from 0 to 1". */
const char *wd_keys_allowed(const struct wd_key *key, char *buffer, size_t size);

#endif
