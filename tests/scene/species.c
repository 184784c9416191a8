#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "log.h"
#include "scene/species.h"

#define NAMES "\"name\": \"own\", \"latin\": \"Arbor mea\", "

struct fixture {
    struct wd_arena arena;
    struct collected log;
    struct wd_species species;
};

static bool read_species(struct fixture *f, const char *text)
{
    wd_arena_finish(&f->arena);
    f->log = (struct collected){0};
    struct wd_log log = {collect, &f->log};
    return wd_keys_read(&wd_species_keys, "own.json", text, strlen(text), &f->arena, &log, &f->species);
}

static void missing_orders_are_named(void **state)
{
    (void)state;
    struct fixture f = {0};
    assert_false(read_species(&f, "{" NAMES "\"form\": \"broadleaf\", \"typical_height_m\": 20,\n"
                                  "\"allometry\": {\"height_a\": 25, \"height_b\": 0.04}}"));
    assert_true(logged(&f.log, "own.json:1:1: \"orders\" is missing; a broadleaf has 1 to 3"));
    assert_false(read_species(&f, "{" NAMES "\"form\": \"broadleaf\", \"typical_height_m\": 20,\n"
                                  "\"orders\": [], \"allometry\": {\"height_a\": 25, \"height_b\": 0.04}}"));
    assert_true(logged(&f.log, "own.json:2:11: orders: found 0 orders"));
    wd_arena_finish(&f.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missing_orders_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
