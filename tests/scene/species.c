#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "log.h"
#include "scene/species.h"

#define NAMES "\"name\": \"own\", \"latin\": \"Arbor mea\", "
#define ORDERS ", \"orders\": [{}]"

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

/* Without a site curve old trees are as high as the thickest. */
static void heights_by_age_follow_the_allometry(void **state)
{
    (void)state;
    struct fixture f = {0};
    assert_true(read_species(&f, "{" NAMES "\"form\": \"broadleaf\", \"typical_height_m\": 80, \"height_range_m\": [1, 100],"
                                 "\"allometry\": {\"height_a\": 95, \"height_b\": 0.02}" ORDERS "}"));
    assert_true(wd_species_height_at_age_m(&f.species, 200) > 80);
    assert_true(read_species(&f, "{" NAMES "\"form\": \"shrub\", \"typical_height_m\": 0.4, \"height_range_m\": [0.1, 1],"
                                 "\"allometry\": {\"height_a\": 0.6, \"height_b\": 1, \"diameter_at_m\": 0}" ORDERS "}"));
    assert_true(wd_species_height_at_age_m(&f.species, 200) < 0.61);
    assert_int_equal(f.log.warnings, 0);
    wd_arena_finish(&f.arena);
}

static void curves_too_low_for_the_tree_are_told(void **state)
{
    (void)state;
    struct fixture f = {0};
    assert_true(read_species(&f, "{" NAMES "\"form\": \"broadleaf\", \"typical_height_m\": 25,\n"
                                 "\"allometry\": {\"height_a\": 10, \"height_b\": 0.04},\n"
                                 "\"growth\": {\"height_a\": 3}, \"leaf\": {\"count\": 0}" ORDERS "}"));
    assert_true(logged(&f.log, "own.json:2:27: allometry.height_a: found 10; no stem is thick enough"));
    assert_true(logged(&f.log, "own.json:3:24: growth.height_a: found 3; no tree grows old enough"));
    assert_int_equal(f.log.warnings, 2);
    wd_arena_finish(&f.arena);
}

static bool in_flower(const struct wd_species *species, float first, float last, double month)
{
    struct wd_species own = *species, in;
    own.flower.count = 10;
    own.flower.months[0] = first;
    own.flower.months[1] = last;
    return wd_species_in_month(&in, &own, month, NULL) && in.flower.count > 0;
}

static void flowers_last_as_long_as_their_months(void **state)
{
    (void)state;
    struct fixture f = {0};
    assert_true(read_species(&f, "{" NAMES "\"form\": \"broadleaf\", \"typical_height_m\": 20,"
                                 "\"allometry\": {\"height_a\": 25, \"height_b\": 0.04}" ORDERS "}"));
    assert_true(in_flower(&f.species, 4, 5, 5.9) && !in_flower(&f.species, 4, 5, 6));
    assert_true(in_flower(&f.species, 4.2f, 4.9f, 4.8) && !in_flower(&f.species, 4.2f, 4.9f, 5));
    assert_true(in_flower(&f.species, 11, 1, 1.9) && !in_flower(&f.species, 11, 1.5f, 1.9));
    assert_true(in_flower(&f.species, 12, 12, 12.9));
    wd_arena_finish(&f.arena);
}

static void stems_that_do_not_grow_are_told(void **state)
{
    (void)state;
    struct fixture f = {0};
    static const char *const forms[] = {"broadleaf", "shrub"};
    for (int i = 0; i < 2; i++) {
        char text[512];
        snprintf(text, sizeof text, "{" NAMES "\"form\": \"%s\", \"typical_height_m\": 4, \"stems\": {\"count\": 3},"
                 "\"allometry\": {\"height_a\": 5, \"height_b\": 0.1}" ORDERS "}", forms[i]);
        assert_true(read_species(&f, text));
        assert_int_equal(f.log.warnings, i == 0);
        assert_true(i > 0 || logged(&f.log, "stems.count: found 3; a broadleaf has one stem"));
    }
    wd_arena_finish(&f.arena);
}

/* Who writes down a tree of the south learns that its months are turned. */
static void months_of_the_south_are_refused(void **state)
{
    (void)state;
    struct fixture f = {0};
    assert_false(read_species(&f, "{" NAMES "\"form\": \"broadleaf\", \"typical_height_m\": 20, \"leaf\": {\"months\": [11, 5]},"
                                  "\"allometry\": {\"height_a\": 25, \"height_b\": 0.04}" ORDERS "}"));
    assert_true(logged(&f.log, "leaf.months: leaves unfold in month 11 and fall in month 5; the first must be less, as north"));
    wd_arena_finish(&f.arena);
}

static void leaves_drawn_as_giants_are_told(void **state)
{
    (void)state;
    struct fixture f = {0};
    static const char *const leaves[] = {"\"count\": 60", "\"width_cm\": 0.05", "\"count\": 5000",
                                         "\"count\": 60, \"shape\": \"needles\"", "\"count\": 0"};
    for (size_t i = 0; i < sizeof leaves / sizeof *leaves; i++) {
        char text[512];
        snprintf(text, sizeof text, "{" NAMES "\"form\": \"broadleaf\", \"typical_height_m\": 25,"
                 "\"allometry\": {\"height_a\": 30, \"height_b\": 0.04}" ORDERS ",\n\"leaf\": {%s}}", leaves[i]);
        assert_true(read_species(&f, text));
        assert_int_equal(f.log.warnings, i < 2);
        assert_true(i >= 2 || logged(&f.log, "leaf.count: found "));
    }
    wd_arena_finish(&f.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missing_orders_are_named),
        cmocka_unit_test(heights_by_age_follow_the_allometry),
        cmocka_unit_test(curves_too_low_for_the_tree_are_told),
        cmocka_unit_test(flowers_last_as_long_as_their_months),
        cmocka_unit_test(stems_that_do_not_grow_are_told),
        cmocka_unit_test(months_of_the_south_are_refused),
        cmocka_unit_test(leaves_drawn_as_giants_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
