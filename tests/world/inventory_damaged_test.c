/* Thousands of damaged inventories: each is planted or refused with one message; long ones soon. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "../base/damage.h"
#include "base/memory.h"
#include "inventory_file.h"

static const char *const path = "inventory_damaged_test.csv";

static const char *const pieces[] = {
    "\"", ";", ",", "\n", "\r\n", "\r", "1e308", "NaN", "-1e9", "\xff", "\xef\xbb\xbf", "\t", "sep=;", "0.0.0", "1e 5"};
enum { PIECES = sizeof pieces / sizeof *pieces };

static bool plant(const char *text, size_t size)
{
    struct small_scene small;
    struct wd_world world;
    small_scene_init(&small);
    small_scene_inventory(&small, path);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    bool ok = make(&small, &world);
    if (ok)
        wd_world_finish(&world);
    return ok;
}

static void damaged_inventories_never_crash(void **state)
{
    (void)state;
    enum { ROUNDS = 2000 };
    static const char whole[] = "id,x,y,species,dbh,height,crown_diameter,status\r\n1,10.5,20.25,oak,40,21.5,9.5,A\r\n"
                                "2,30,40,\"Picea \"\"abies\"\"\",40,,,A\r\n3,50,60,SPRUCE,,25,,dead\r\n4,7e1,80,,,,,\r\n";
    uint32_t seed = 11;
    unsigned refused = 0;
    assert_true(plant(whole, sizeof whole - 1));
    for (unsigned i = 0; i < ROUNDS; i++) {
        char text[sizeof whole];
        size_t size = sizeof whole - 1;
        memcpy(text, whole, sizeof whole);
        damage(text, &size, &seed, pieces, PIECES);
        damage_end(&size, &seed, 6);
        bool ok = plant(text, size);
        const char *end = strchr(captured.errors, '\n');
        assert_true(ok ? !end : end && !end[1]); /* one line */
        refused += !ok;
    }
    assert_true(refused > ROUNDS / 4);
    unlink(path);
}

static void exponents_have_no_blanks(void **state)
{
    (void)state;
    static const char text[] = "x,y\n1e 1,20\n";
    assert_false(plant(text, sizeof text - 1));
    assert_said(captured.errors, "csv:2: column x: \"1e 1\" is not a number");
    unlink(path);
}

/* As where the column of the trees' numbers is taken for that of their species. */
static void as_many_species_as_rows_take_no_time(void **state)
{
    (void)state;
    enum { ROWS = 150000 };
    char *text = wd_alloc((size_t)ROWS * 40 + 40), *end = text + sprintf(text, "x,y,species\n");
    for (int i = 0; i < ROWS; i++)
        end += sprintf(end, "%d,%d,%d\n", 1 + i % 390, 1 + i / 390 % 290, i);
    alarm(30);
    assert_true(plant(text, (size_t)(end - text)));
    alarm(0);
    assert_said(captured.others, "\"*\" stands for 150000 species");
    free(text);
    unlink(path);
}

static void long_headers_are_not_listed_whole(void **state)
{
    (void)state;
    enum { COLUMNS = 300, NAME = 500, LONG = 30000 };
    char *text = wd_alloc((size_t)COLUMNS * (NAME + 1) + LONG), *end = text;
    for (int i = 0; i < COLUMNS; i++) {
        memset(end, 'a', NAME);
        end[NAME] = i + 1 < COLUMNS ? ',' : '\n';
        end += NAME + 1;
    }
    assert_false(plant(text, (size_t)(end - text)));
    assert_said(captured.errors, "no column for x was recognised");
    assert_said(captured.errors, "... (300 columns)");
    memset(text + 1, 'a', LONG);
    assert_false(plant(text, (size_t)LONG));
    assert_said(captured.errors, "csv:1: the name of column 1 has 30000 bytes");
    free(text);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged_inventories_never_crash),
        cmocka_unit_test(exponents_have_no_blanks),
        cmocka_unit_test(as_many_species_as_rows_take_no_time),
        cmocka_unit_test(long_headers_are_not_listed_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
