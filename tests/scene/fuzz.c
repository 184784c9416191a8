/* Thousands of damaged scenes and species: each is read or refused with a message, never more. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../base/damage.h"
#include "base/file.h"
#include "log.h"
#include "scene/scene.h"

static char *species_dir;

static const char scene_text[] =
    "{ // a scene\n\"$schema\": \"x\", \"name\": \"all\", \"seed\": 12, \"terrain\": {\"kind\": "
    "\"diamond-square\", \"size_m\": [500, 600.5], \"relief_m\": 1e2},\n"
    "\"layers\": [{\"name\": \"a\", \"species\": {\"oak\": 0.5, \"b\\u0069rch\": 2}, \"map\": {"
    "\"file\": \"m.tif\", \"classes\": [41, 42], \"class_density\": [1, 0.5]}, \"height_m\": "
    "[5, 20], /* wide */ \"slope_deg\": 30}],\n\"inventories\": [{\"file\": \"t.csv\", "
    "\"columns\": {\"x\": \"X\", \"status\": \"S\"}, \"dead\": [\"D\", \"X\"], \"species\": {\"*\": "
    "\"oak\"}, \"outside\": \"keep\"}],\n\"water\": {\"enabled\": true, \"color\": \"#102030\"},"
    "\"cameras\": [{\"name\": \"c\", \"position_m\": [1, -2, 3e0], \"look_at_m\": [0, 0, 0]}],"
    "\"paths\": [{\"name\": \"p\", \"keys\": [{\"position_m\": [0, 0, 1]}, {\"position_m\": [1, 0,"
    " 1], \"absolute\": true}]}], \"method\": \"octree\", \"in_the_open\": {\"oak\": "
    "\"far\"}, \"quality\": {\"width\": 64}}\n";

static const char *const pieces[] = {
    "{", "}", "[", "]", ",", ":", "\"", "\\", "-", "1e400", "NaN", "null", "/*", "*/", "//", "\n", "\xff", "9999999",
    "${data}", "\xc3"};
enum { PIECES = sizeof pieces / sizeof *pieces };

static void batter(const struct wd_keys *table, const char *path, const char *source, size_t size,
                   unsigned rounds)
{
    uint32_t seed = 7;
    void *object = malloc(table->size);
    unsigned refused = 0;
    for (unsigned i = 0; i < rounds; i++) {
        size_t length = size;
        char *text = malloc(size + 1);
        memcpy(text, source, size);
        if (i < size) {
            length = i; /* every truncation once */
        } else {
            damage(text, &length, &seed, pieces, PIECES);
            damage_end(&length, &seed, 3);
        }
        char *exact = malloc(length ? length : 1); /* so that a read beyond the end is seen */
        memcpy(exact, text, length);
        struct collected all = {0};
        struct wd_log log = {collect, &all};
        struct wd_arena arena = {0};
        bool ok = wd_keys_read(table, path, exact, length, &arena, &log, object);
        assert_true(ok == (all.errors == 0));
        refused += !ok;
        wd_arena_finish(&arena);
        free(exact);
        free(text);
    }
    assert_true(refused > rounds / 2);
    free(object);
}

static void damaged_scenes_never_crash(void **state)
{
    (void)state;
    char *path = wd_path_beside(species_dir, "scenes/x.json");
    batter(&wd_scene_keys, path, scene_text, sizeof scene_text - 1, 8000);
    free(path);
}

static void damaged_species_never_crash(void **state)
{
    (void)state;
    char *path = wd_format("%s/oak.json", species_dir), *text;
    size_t size;
    assert_true(wd_file_read(path, 1 << 20, NULL, &text, &size));
    batter(&wd_species_keys, path, text, size, 8000);
    free(text);
    free(path);
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    species_dir = argv[1];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged_scenes_never_crash),
        cmocka_unit_test(damaged_species_never_crash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
