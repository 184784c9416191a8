#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "log.h"
#include "scene/keys.h"
#include "scene/nearest.h"

struct leaf {
    const char *name;
    double size;
};
struct sample {
    double number, above_zero, missing;
    float single, range[2], parts[2], color[3];
    int64_t whole;
    bool flag;
    const char *text, *unit;
    int kind;
    double vector[3], *numbers;
    size_t number_count;
    int64_t *integers;
    size_t integer_count;
    const char **texts;
    size_t text_count;
    struct leaf leaf, *list, *map;
    size_t list_count, map_count;
    struct wd_string_pair *pairs;
    size_t pair_count;
    struct wd_number_pair *shares;
    size_t share_count;
};

static const char *const kinds[] = {"first", "second", NULL};
static const struct wd_key leaf_keys[] = {
    {"size_m", WD_KEY_DOUBLE, offsetof(struct leaf, size), 0, 10, "2"}, {0}};
static const struct wd_keys leaf_table = {"leaf", leaf_keys, sizeof(struct leaf), NULL};

#define AT(member) offsetof(struct sample, member)
static const struct wd_key sample_keys[] = {
    {"number", WD_KEY_DOUBLE, AT(number), -1, 1, "0.5"},
    {"above_zero", WD_KEY_DOUBLE, AT(above_zero), 0, INFINITY, "1", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"missing", WD_KEY_DOUBLE, AT(missing), .flags = WD_KEY_NAN_IF_ABSENT},
    {"single", WD_KEY_FLOAT, AT(single)},
    {"range", WD_KEY_RANGE, AT(range), 0, 100, "[1, 2]"},
    {"parts", WD_KEY_FLOATS, AT(parts), .length = 2},
    {"color", WD_KEY_COLOR, AT(color), .fallback = "\"#ffffff\""},
    {"whole", WD_KEY_INTEGER, AT(whole), 1, 1e9, "7"},
    {"flag", WD_KEY_BOOL, AT(flag), .fallback = "true"},
    {"text", WD_KEY_STRING, AT(text)},
    {"unit", WD_KEY_STRING, AT(unit), .choices = kinds, .fallback = "\"second\""},
    {"kind", WD_KEY_ENUM, AT(kind), .choices = kinds, .fallback = "\"second\""},
    {"vector", WD_KEY_VECTOR, AT(vector), .length = 3, .flags = WD_KEY_SORTED},
    {"numbers", WD_KEY_NUMBERS, AT(numbers), .count_offset = AT(number_count), .length = 2},
    {"integers", WD_KEY_INTEGERS, AT(integers), .count_offset = AT(integer_count)},
    {"texts", WD_KEY_STRINGS, AT(texts), .count_offset = AT(text_count)},
    {"leaf", WD_KEY_OBJECT, AT(leaf), .table = &leaf_table},
    {"list", WD_KEY_LIST, AT(list), .table = &leaf_table, .count_offset = AT(list_count)},
    {"map", WD_KEY_MAP, AT(map), .table = &leaf_table, .count_offset = AT(map_count)},
    {"pairs", WD_KEY_STRING_MAP, AT(pairs), .count_offset = AT(pair_count)},
    {"shares", WD_KEY_NUMBER_MAP, AT(shares), 0, 9, .count_offset = AT(share_count)},
    {0},
};
static const struct wd_keys sample_table = {"sample", sample_keys, sizeof(struct sample), NULL};

struct fixture {
    struct wd_arena arena;
    struct collected log;
    struct sample sample;
};

static bool read_bytes(struct fixture *f, const char *text, size_t size)
{
    wd_arena_finish(&f->arena);
    f->log = (struct collected){0};
    struct wd_log log = {collect, &f->log};
    return wd_keys_read(&sample_table, "f.json", text, size, &f->arena, &log, &f->sample);
}

static bool read_text(struct fixture *f, const char *text)
{
    return read_bytes(f, text, strlen(text));
}

static void defaults_fill_what_is_absent(void **state)
{
    (void)state;
    struct fixture f = {0};
    assert_true(read_text(&f, "{}"));
    assert_true(f.sample.number == 0.5 && f.sample.above_zero == 1 && isnan(f.sample.missing));
    assert_true(f.sample.range[0] == 1 && f.sample.range[1] == 2 && f.sample.whole == 7);
    assert_true(f.sample.color[0] == 1 && f.sample.flag && f.sample.kind == 1);
    assert_null(f.sample.text);
    assert_string_equal(f.sample.unit, "second");
    assert_true(f.sample.leaf.size == 2);
    assert_int_equal(f.sample.list_count, 0);
    wd_arena_finish(&f.arena);
}

static void every_kind_is_read(void **state)
{
    (void)state;
    struct fixture f = {0};
    assert_true(read_text(
        &f, "{ // a comment\n\"$schema\": \"x\", \"number\": -1, \"single\": 2.5, \"range\": 3,"
            "\"parts\": [2, 1], \"color\": \"#80ff00\", \"whole\": 1e6, \"flag\": false,"
            "\"text\": \"a // b /* c */ \\\"\", \"unit\": \"first\", \"kind\": \"first\","
            "\"vector\": [1, 2, 2], /* two\nlines */ \"numbers\": [4, 5], \"integers\": 42,"
            "\"texts\": \"one\", \"leaf\": {\"size_m\": 4}, \"list\": [{}, {\"size_m\": 9}],"
            "\"map\": {\"q\": {}, \"p\": {\"size_m\": 1}}, \"pairs\": {\"a b\": \"c\"},"
            "\"shares\": {\"oak\": 0.25, \"ash\": 3}}"));
    const struct sample *s = &f.sample;
    assert_true(s->number == -1 && s->single == 2.5f && s->range[0] == 3 && s->range[1] == 3);
    assert_true(s->parts[0] == 2 && s->parts[1] == 1 && s->whole == 1000000 && !s->flag);
    assert_true(fabsf(s->color[0] - 0.2158605f) < 1e-6f && s->color[1] == 1 && s->color[2] == 0);
    assert_string_equal(s->text, "a // b /* c */ \"");
    assert_int_equal(s->kind, 0);
    assert_true(s->vector[2] == 2 && s->number_count == 2 && s->numbers[1] == 5);
    assert_true(s->integer_count == 1 && s->integers[0] == 42 && s->text_count == 1);
    assert_true(s->leaf.size == 4 && s->list_count == 2 && s->list[0].size == 2 &&
                s->list[1].size == 9);
    assert_int_equal(s->map_count, 2);
    assert_string_equal(s->map[0].name, "q");
    assert_string_equal(s->map[1].name, "p");
    assert_string_equal(s->pairs[0].name, "a b");
    assert_true(s->share_count == 2 && s->shares[1].value == 3);
    assert_true(read_text(&f, "{\"shares\": \"oak\", \"color\": [0, 0.5, 1]}"));
    assert_true(f.sample.share_count == 1 && f.sample.shares[0].value == 1);
    wd_arena_finish(&f.arena);
}

struct wrong {
    const char *text, *message;
};

static void errors_say_place_found_and_allowed(void **state)
{
    (void)state;
    static const struct wrong cases[] = {
        {"{\n  \"number\": 2}", "f.json:2:13: number: found 2; allowed is a number from -1 to 1"},
        {"{\"above_zero\": 0}", "f.json:1:16: above_zero: found 0; allowed is a number above 0"},
        {"{\"number\": \"x\"}", "number: found \"x\"; allowed is a number"},
        {"{\"number\": null}", "number: found null"},
        {"{\"whole\": 1.5}", "whole: found 1.5; allowed is a whole number from 1 to 1000000000"},
        {"{\"whole\": 0}", "found 0"},
        {"{\"single\": 1e39}", "single: found 1e+39"},
        {"{\"range\": [5, 1]}", "range: found [5, 1]; the least must come first"},
        {"{\"range\": [1, 101]}", "f.json:1:15: range[1]: found 101"},
        {"{\"range\": [1]}", "range: found a list of 1"},
        {"{\"parts\": [1, \"2\"]}", "f.json:1:15: parts[1]: found \"2\""},
        {"{\"color\": \"#12345\"}", "color: found \"#12345\"; allowed is [red, green, blue]"},
        {"{\"color\": \"#12345g\"}", "color: found"},
        {"{\"color\": [0, 0, 2]}", "color[2]: found 2"},
        {"{\"flag\": 1}", "flag: found 1; allowed is true or false"},
        {"{\"text\": \"\"}", "text: found \"\"; allowed is a text that is not empty"},
        {"{\"kind\": \"frist\"}", "did you mean \"first\"? Allowed is one of \"first\", \"second\""},
        {"{\"unit\": 3}", "unit: found 3; allowed is one of"},
        {"{\"vector\": [1, 2]}", "vector: found a list of 2; allowed is a list of 3 numbers"},
        {"{\"vector\": [1, 2, 0]}", "vector: found 0 after 2"},
        {"{\"numbers\": [1]}", "numbers: found a list of 1; allowed is a list of 2 numbers"},
        {"{\"integers\": [1, 2.5]}", "integers[1]: found 2.5"},
        {"{\"texts\": [\"a\", 1]}", "texts[1]: found 1"},
        {"{\"leaf\": []}", "leaf: found a list of 0; allowed is an object"},
        {"{\"list\": {}}", "list: found an object; allowed is a list of objects"},
        {"{\"list\": [{}, /* x */ 3]}", "f.json:1:23: list[1]: found 3; a leaf is an object"},
        {"{\"list\": [{}, {\n \"size_m\": 11}]}", "f.json:2:12: list[1].size_m: found 11"},
        {"{\"map\": {\"a.b\": {\"size_m\": -1}}}", "f.json:1:28: map.a.b.size_m: found -1"},
        {"{\"pairs\": {\"a\": 1}}", "f.json:1:17: pairs.a: found 1"},
        {"{\"shares\": {\"a\": 10}}", "shares.a: found 10"},
        {"{\"leaf\": {\"size\": 1}}", "f.json:1:11: leaf.size: unknown key; did you mean \"size_m\"?"},
        {"{\"leaf\": {\"qqqqq\": 1}}", "unknown key; leaf takes: size_m"},
        {"{\"leaf\": {\"$schema\": 1}}", "leaf.$schema: unknown key"},
        {"{\"w\\u0068ole\": 0}", "f.json:1:16: whole: found 0"},
    };
    struct fixture f = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_false(read_text(&f, cases[i].text));
        assert_true(logged(&f.log, cases[i].message));
        assert_int_equal(f.log.errors, 1);
        struct sample zero = {0};
        assert_memory_equal(&f.sample, &zero, sizeof zero);
    }
    wd_arena_finish(&f.arena);
}

static void broken_text_is_refused(void **state)
{
    (void)state;
    static const struct wrong cases[] = {
        {"", "f.json:1:1: the file is empty"},
        {" \n ", "the file is empty"},
        {"{", "f.json:1:2: the file ends too early"},
        {"{\"number\": ", "the file ends too early"},
        {"{\"number\": NaN}", "not valid JSON: invalid token near 'NaN'"},
        {"{\"number\": Infinity}", "not valid JSON"},
        {"{\"number\": 1e999}", "not valid JSON: real number overflow"},
        {"{\"whole\": 99999999999999999999}", "too big integer"},
        {"{\"number\": 1, \"number\": 1}", "duplicate object key"},
        {"{\"number\": 1,}", "not valid JSON"},
        {"[1]", "f.json:1:1: found a list; a sample is an object"},
        {"{} x", "not valid JSON: end of file expected"},
        {"{ /* open", "f.json:1:3: a /* comment without its */"},
        {"\xef\xbb\xbf ", "f.json:1:1: the file is empty"},
        {"\xff\xfe{", "UTF-16"},
        {"{\"text\": \"\xff\xc0\"}", "not valid JSON"},
        {"{\"te\nxt\": 1}", "not valid JSON"},
    };
    struct fixture f = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_false(read_text(&f, cases[i].text));
        assert_true(logged(&f.log, cases[i].message));
        assert_int_equal(f.log.errors, 1);
    }
    assert_false(read_bytes(&f, "{\0}\0", 4));
    assert_true(logged(&f.log, "UTF-16"));
    assert_false(read_bytes(&f, "{}  \0\0", 6));
    assert_true(logged(&f.log, "f.json:1:5: a NUL byte"));
    wd_arena_finish(&f.arena);
}

static void deep_nesting_is_refused(void **state)
{
    (void)state;
    struct fixture f = {0};
    size_t size = 200000;
    char *text = malloc(size + 1);
    memset(text, '[', size);
    text[size] = '\0';
    assert_false(read_text(&f, text));
    assert_true(logged(&f.log, "maximum parsing depth"));
    free(text);
    wd_arena_finish(&f.arena);
}

static void many_errors_come_in_one_pass_but_bounded(void **state)
{
    (void)state;
    struct fixture f = {0};
    assert_false(read_text(&f, "{\"number\": 9, \"whole\": \"x\",\n\"list\": [{\"size_m\": 99}]}"));
    assert_int_equal(f.log.errors, 3);
    char text[4096] = "{\"list\": [{}";
    for (int i = 0; i < 50; i++)
        strcat(text, ", {\"size_m\": -5}");
    strcat(text, "]}");
    assert_false(read_text(&f, text));
    assert_int_equal(f.log.errors, 21);
    assert_true(logged(&f.log, "f.json: 30 more errors"));
    wd_arena_finish(&f.arena);
}

static void columns_count_characters_beyond_comments(void **state)
{
    (void)state;
    struct fixture f = {0};
    assert_false(read_text(&f, "{ /* \xc3\xa9\xc3\xa9 */ \"number\": 7}"));
    assert_true(logged(&f.log, "f.json:1:22: number: found 7"));
    assert_false(read_text(&f, "\xef\xbb\xbf{\"number\": 7}"));
    assert_true(logged(&f.log, "f.json:1:12: number: found 7"));
    assert_true(read_text(&f, "\xef\xbb\xbf{\"number\": 1}") && f.sample.number == 1);
    wd_arena_finish(&f.arena);
}

static bool read_set(struct fixture *f, const char *text, const char *const *settings)
{
    wd_arena_finish(&f->arena);
    f->log = (struct collected){0};
    struct wd_log log = {collect, &f->log};
    const struct wd_keys_input input = {"f.json", text, strlen(text), NULL, settings};
    return wd_keys_read_input(&sample_table, &input, &f->arena, &log, &f->sample);
}

static void settings_take_the_place_of_the_text(void **state)
{
    (void)state;
    struct fixture f = {0};
    const char *const good[] = {"whole=9",           "leaf.size_m=3", "text=plain words",
                                "list.0.size_m=4.5", "flag=false",    "vector=[1, 2, 3]",
                                "list[1].size_m=6",  "vector[0]=0.5", NULL};
    assert_true(read_set(&f, "{\"whole\": 1, \"list\": [{}, {}]}", good));
    assert_true(f.sample.whole == 9 && f.sample.leaf.size == 3 && !f.sample.flag);
    assert_true(f.sample.list[0].size == 4.5 && f.sample.list[1].size == 6);
    assert_true(f.sample.vector[0] == 0.5 && f.sample.vector[2] == 3);
    assert_string_equal(f.sample.text, "plain words");
    const char *const chosen[] = {"text=leaf", "@text.size_m=7", NULL};
    assert_true(read_set(&f, "{}", chosen) && f.sample.leaf.size == 7);
    wd_arena_finish(&f.arena);
}

static void settings_that_are_wrong_are_named(void **state)
{
    (void)state;
    static const struct {
        const char *setting, *message;
    } wrong[] = {
        {"whole=0.5", "f.json: setting whole=0.5: found 0.5; allowed is a whole number"},
        {"whoel=1", "setting whoel=1: unknown key; did you mean \"whole\"?"},
        {"list.0.size_m=11", "setting list.0.size_m=11: found 11"},
        {"list[0].size_m=11", "setting list[0].size_m=11: found 11"},
        {"list[5].size_m=1", "there is no item \"5\" in the list; it has 2, numbered from 0"},
        {"list[x].size_m=1", "f.json:1:1: list[x]: unknown key"},
        {"list.5=1", "there is no item \"5\" in the list; it has 2, numbered from 0"},
        {"list.nonsense.size_m=1", "there is no item \"nonsense\" in the list"},
        {"list.0x.size_m=1", "there is no item \"0x\" in the list"},
        {"list.-1=1", "there is no item \"-1\" in the list"},
        {"list.99999999999999999999=1", "there is no item \"99999999999999999999\" in the list"},
        {"list.pine.size_m=1", "items of a list go by number, and \"pine\" is 1"},
        {"leaf={\"size_m\":11}", "setting leaf={\"size_m\":11}: size_m: found 11"},
        {"list.0={\"size_m\":11}", "setting list.0={\"size_m\":11}: size_m: found 11"},
        {"list=[{},{\"size_m\":11}]", "setting list=[{},{\"size_m\":11}]: [1].size_m: found 11"},
        {"whole.a.b=1", "leads through something that has no keys"},
        {"whole", "must read KEY=VALUE"},
        {"=1", "must read KEY=VALUE"},
        {"leaf..size_m=1", "empty or too long"},
        {"@flag.x=1", "nothing that @ could stand for"},
        {"@none.x=1", "nothing that @ could stand for"},
    };
    struct fixture f = {0};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const char *const settings[] = {wrong[i].setting, NULL};
        assert_false(read_set(&f, "{\"whole\": 1, \"list\": [{}, {\"name\": \"pine\"}]}", settings));
        assert_true(logged(&f.log, wrong[i].message));
    }
    wd_arena_finish(&f.arena);
}

static void nearest_name_is_found_or_none(void **state)
{
    (void)state;
    static const char *const names[] = {"spacing_m", "species", "spruce", "oak", "patch_size_m"};
    assert_string_equal(wd_nearest_name("spacing", names, 5), "spacing_m");
    assert_string_equal(wd_nearest_name("Spurce", names, 5), "spruce");
    assert_string_equal(wd_nearest_name("specie", names, 5), "species");
    assert_string_equal(wd_nearest_name("oka", names, 5), "oak");
    assert_string_equal(wd_nearest_name("size_m", names, 5), "patch_size_m");
    assert_null(wd_nearest_name("zzz", names, 5));
    assert_null(wd_nearest_name("", names, 5));
    assert_null(wd_nearest_name("oak", names, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_fill_what_is_absent),
        cmocka_unit_test(every_kind_is_read),
        cmocka_unit_test(errors_say_place_found_and_allowed),
        cmocka_unit_test(broken_text_is_refused),
        cmocka_unit_test(deep_nesting_is_refused),
        cmocka_unit_test(many_errors_come_in_one_pass_but_bounded),
        cmocka_unit_test(columns_count_characters_beyond_comments),
        cmocka_unit_test(settings_take_the_place_of_the_text),
        cmocka_unit_test(settings_that_are_wrong_are_named),
        cmocka_unit_test(nearest_name_is_found_or_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
