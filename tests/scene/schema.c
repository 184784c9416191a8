#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>
#include <jansson.h>

#include "base/file.h"
#include "log.h"
#include "schemas.h"

static const char *docs_dir;

static void published_schemas_follow_the_tables(void **state)
{
    (void)state;
    for (size_t i = 0; i < SCHEMA_COUNT; i++) {
        char *path = wd_format("%s/%s", docs_dir, schemas[i].file), *published;
        size_t size;
        assert_true(wd_file_read(path, 1 << 24, NULL, &published, &size));
        char *made = wd_keys_schema(schemas[i].table, schemas[i].name);
        if (size != strlen(made) + 1 || strncmp(made, published, size - 1) != 0)
            fail_msg("%s differs from the tables; make it anew: scene-print-schema %s > %s", path,
                     schemas[i].name, path);
        free(made);
        free(published);
        free(path);
    }
}

/* A table's key without a sentence, a default that its own bounds refuse, a name given twice. */
static void check_table(const struct wd_keys *table)
{
    for (const struct wd_key *key = table->keys; key->name; key++) {
        if (!key->doc || strlen(key->doc) < 3)
            fail_msg("%s.%s has no description", table->title, key->name);
        for (const struct wd_key *other = table->keys; other < key; other++)
            assert_string_not_equal(other->name, key->name);
        if (key->flags & WD_KEY_REQUIRED)
            assert_null(key->fallback);
        if (key->table)
            check_table(key->table);
    }
}

static void tables_are_sound(void **state)
{
    (void)state;
    for (size_t i = 0; i < SCHEMA_COUNT; i++)
        check_table(schemas[i].table);
}

static void every_reference_has_its_definition(void **state)
{
    (void)state;
    for (size_t i = 0; i < SCHEMA_COUNT; i++) {
        char *text = wd_keys_schema(schemas[i].table, schemas[i].name);
        json_t *schema = json_loads(text, 0, NULL);
        json_t *definitions = json_object_get(schema, "$defs");
        static const char reference[] = "\"$ref\": \"#/$defs/";
        size_t found = 0;
        for (const char *at = text; (at = strstr(at, reference)); found++) {
            at += sizeof reference - 1;
            char name[64] = "";
            snprintf(name, sizeof name, "%.*s", (int)strcspn(at, "\""), at);
            assert_non_null(json_object_get(definitions, name));
        }
        assert_true(found >= json_object_size(definitions));
        json_decref(schema);
        free(text);
    }
}

static void empty_scene_gets_every_default(void **state)
{
    (void)state;
    struct collected all = {0};
    struct wd_log log = {collect, &all};
    struct wd_arena arena = {0};
    struct wd_scene scene;
    assert_true(wd_keys_read(&wd_scene_keys, "e.json", "{}", 2, &arena, &log, &scene));
    assert_true(scene.quality.width == 1280 && scene.quality.height == 720);
    assert_true(scene.quality.samples == 4 && scene.sun.elevation_deg == 35);
    assert_string_equal(scene.method, "continuum");
    assert_int_equal(scene.camera_count, 1);
    assert_true(scene.cameras[0].automatic);
    assert_true(logged(&all, "bare ground"));
    wd_arena_finish(&arena);
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    docs_dir = argv[1];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_schemas_follow_the_tables),
        cmocka_unit_test(tables_are_sound),
        cmocka_unit_test(every_reference_has_its_definition),
        cmocka_unit_test(empty_scene_gets_every_default),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
