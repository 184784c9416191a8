#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "output/cryptomatte.h"

static float value_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Names and floats of the specification's own tests; hashes as published for MurmurHash3_x86_32. */
static void names_have_the_floats_of_the_specification(void **state)
{
    static const struct {
        const char *name;
        float value;
    } known[] = {{"hello", 6.0705627102400005616e-17f},
                 {"cube", -4.08461912519e+15f},
                 {"sphere", 2.79018604383e+15f},
                 {"plane", 3.66557617593e-11f}};
    (void)state;
    assert_int_equal(wd_murmur3("", 0), 0);
    assert_int_equal(wd_murmur3("hello", 5), 0x248bfa47u);
    assert_int_equal(wd_murmur3("hello, world", 12), 0x149bbb7fu);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        float ratio = value_of(wd_cryptomatte_id(known[i].name)) / known[i].value;
        assert_true(ratio > 0.999999f && ratio < 1.000001f);
    }
}

/* No float is denormal, infinite or NaN; ids far apart and next to each other. */
static void floats_are_normal_and_differ(void **state)
{
    enum { COUNT = 300000 };
    (void)state;
    uint32_t *ids = malloc(COUNT * sizeof *ids);
    for (uint32_t i = 0; i < COUNT; i++)
        ids[i] = (i + 1) * 14317u;
    struct wd_cryptomatte matte;
    wd_cryptomatte_init(&matte, ids, COUNT);
    assert_int_equal(matte.count, COUNT);
    uint32_t lengthened = 0;
    uint32_t *bits = malloc(COUNT * sizeof *bits);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t exponent = matte.trees[i].bits >> 23 & 255u;
        assert_true(exponent > 0 && exponent < 255);
        lengthened += matte.trees[i].tries;
        bits[i] = matte.trees[i].bits;
        assert_true(wd_cryptomatte_find(&matte, matte.trees[i].tree) == value_of(bits[i]));
    }
    assert_true(lengthened > 0); /* names whose hashes meet are among them */
    struct wd_cryptomatte again;
    wd_cryptomatte_init(&again, bits, COUNT); /* as ids: equal ones would be counted once */
    assert_int_equal(again.count, COUNT);
    wd_cryptomatte_finish(&again);
    wd_cryptomatte_finish(&matte);
    free(bits);
    free(ids);
}

static void the_manifest_names_each_tree_once(void **state)
{
    static const uint32_t ids[] = {0, 4294967295u, 7, 7, 0, 12};
    struct wd_cryptomatte matte;
    (void)state;
    wd_cryptomatte_init(&matte, ids, 6);
    char *text = wd_cryptomatte_manifest(&matte);
    char wanted[256];
    snprintf(wanted, sizeof wanted,
             "{\"tree_7\":\"%08x\",\"tree_12\":\"%08x\",\"tree_4294967295\":\"%08x\"}",
             wd_cryptomatte_id("tree_7"), wd_cryptomatte_id("tree_12"),
             wd_cryptomatte_id("tree_4294967295"));
    assert_string_equal(text, wanted);
    assert_true(wd_cryptomatte_find(&matte, 0) == 0.0f);
    free(text);
    wd_cryptomatte_finish(&matte);
    wd_cryptomatte_init(&matte, ids, 1);
    text = wd_cryptomatte_manifest(&matte);
    assert_string_equal(text, "{}");
    free(text);
    wd_cryptomatte_finish(&matte);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_have_the_floats_of_the_specification),
        cmocka_unit_test(floats_are_normal_and_differ),
        cmocka_unit_test(the_manifest_names_each_tree_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
