#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "world/csv.h"

struct capture {
    char text[4096];
};

static void keep(void *user, enum wd_log_level level, const char *message)
{
    struct capture *capture = user;
    if (level == WD_LOG_ERROR) {
        assert_int_equal(capture->text[0], 0); /* one message an error */
        snprintf(capture->text, sizeof capture->text, "%s", message);
    }
}

static struct capture captured;
static const struct wd_log sink = {keep, &captured};
static const char *const path = "csv_test.csv";

static void write_bytes(const char *text, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    captured.text[0] = 0;
}

static void write_text(const char *text)
{
    write_bytes(text, strlen(text));
}

static void assert_said(const char *part)
{
    if (!strstr(captured.text, part))
        fail_msg("\"%s\" is not in \"%s\"", part, captured.text);
}

static void test_quotes_and_line_ends(void **state)
{
    (void)state;
    struct wd_csv csv;
    write_text("\xef\xbb\xbf" "a, \"b \"\"x\"\"\" ,c\r\n1,\"two,\r\nlines\",3\r\n\r\n4,,\r\n");
    assert_true(wd_csv_open(&csv, path, NULL, &sink));
    assert_int_equal(csv.column_count, 3);
    assert_string_equal(csv.header[0], "a");
    assert_string_equal(csv.header[1], "b \"x\"");
    assert_string_equal(csv.header[2], "c");
    assert_int_equal(wd_csv_next(&csv), WD_CSV_ROW);
    assert_int_equal(csv.line, 2);
    assert_string_equal(csv.fields[1], "two,\r\nlines");
    assert_int_equal(wd_csv_next(&csv), WD_CSV_ROW);
    assert_int_equal(csv.line, 5);
    assert_string_equal(csv.fields[0], "4");
    assert_string_equal(csv.fields[2], "");
    assert_int_equal(wd_csv_next(&csv), WD_CSV_END);
    wd_csv_close(&csv);
    assert_string_equal(captured.text, "");
}

static void test_delimiters(void **state)
{
    (void)state;
    static const struct {
        const char *text, *wanted;
        char found;
    } cases[] = {
        {"a,b\n1,2", NULL, ','},   {"a;b;c,d\n1;2;3", NULL, ';'}, {"a\tb\n1\t2\n", NULL, '\t'},
        {"sep=|\r\na|b\r\n1|2\n", NULL, '|'}, {"sep=;\na;b\n1;2\n;\n;\n", NULL, ';'},
        {"a|b\n1|2\n", "|", '|'},  {"a\tb\n1\t2\n", "tab", '\t'}, {"\"a;b\",c\n1,2\n", NULL, ','},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct wd_csv csv;
        write_text(cases[i].text);
        assert_true(wd_csv_open(&csv, path, cases[i].wanted, &sink));
        assert_int_equal(csv.delimiter, cases[i].found);
        assert_int_equal(wd_csv_next(&csv), WD_CSV_ROW);
        assert_int_equal(wd_csv_next(&csv), WD_CSV_END);
        wd_csv_close(&csv);
    }
    struct wd_csv csv;
    write_text("a,b\n");
    assert_false(wd_csv_open(&csv, path, "ab", &sink));
    assert_said("delimiter");
}

static void test_numbers(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        enum wd_csv_value kind;
        double value;
    } cases[] = {
        {"12.5", WD_CSV_NUMBER, 12.5},      {"-0.25", WD_CSV_NUMBER, -0.25},
        {"+3", WD_CSV_NUMBER, 3.0},         {"1e3", WD_CSV_NUMBER, 1000.0},
        {"5821351", WD_CSV_NUMBER, 5821351.0},
        {"0.100000001490116", WD_CSV_NUMBER, 0.100000001490116},
        {"123456789012345678901234567890", WD_CSV_NUMBER, 1.2345678901234567e29},
        {".5", WD_CSV_NUMBER, 0.5},         {"", WD_CSV_MISSING, 0.0},
        {"NA", WD_CSV_MISSING, 0.0},        {"12,5", WD_CSV_NUMBER, 12.5},
        {"NaN", WD_CSV_BAD, 0.0},           {"inf", WD_CSV_BAD, 0.0},
        {"1.2.3", WD_CSV_BAD, 0.0},         {"1.234,5", WD_CSV_BAD, 0.0},
        {"12 m", WD_CSV_BAD, 0.0},          {"1e", WD_CSV_BAD, 0.0},
        {"-", WD_CSV_BAD, 0.0},             {"1e999", WD_CSV_BAD, 0.0},
        {"0x10", WD_CSV_BAD, 0.0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct wd_csv csv;
        char text[100];
        double value;
        snprintf(text, sizeof text, "a;b\nx;%s\n", cases[i].text);
        write_text(text);
        assert_true(wd_csv_open(&csv, path, NULL, &sink));
        assert_int_equal(wd_csv_next(&csv), WD_CSV_ROW);
        assert_int_equal(wd_csv_number(&csv, 1, &value), cases[i].kind);
        if (cases[i].kind == WD_CSV_NUMBER)
            assert_true(value > cases[i].value - 1e-12 - 1e-15 * cases[i].value * 2 &&
                        value < cases[i].value + 1e-12 + 1e-15 * cases[i].value * 2);
        else if (cases[i].kind == WD_CSV_BAD)
            assert_said("csv_test.csv:2: column b");
        wd_csv_close(&csv);
    }
}

static void expect_row_error(const char *text, const char *part)
{
    struct wd_csv csv;
    write_text(text);
    assert_true(wd_csv_open(&csv, path, NULL, &sink));
    enum wd_csv_row row;
    while ((row = wd_csv_next(&csv)) == WD_CSV_ROW)
        ;
    assert_int_equal(row, WD_CSV_ERROR);
    assert_said(part);
    wd_csv_close(&csv);
}

static void test_bad_rows(void **state)
{
    (void)state;
    expect_row_error("a,b\n1,2\n1,2,3\n", "csv_test.csv:3: 3 fields, but the header has 2");
    expect_row_error("a,b\n1\n", "csv_test.csv:2: 1 fields, but the header has 2");
    expect_row_error("x,y\n1,5,2,5\n", "decimal commas");
    expect_row_error("a,b\n1,\"never\nclosed\n", "csv_test.csv:2: a quote");
    expect_row_error("a,b\n1,\"q\"x\n", "csv_test.csv:2: text follows a closing quote");
}

static void expect_refused(const char *text, size_t size, const char *part)
{
    struct wd_csv csv;
    write_bytes(text, size);
    assert_false(wd_csv_open(&csv, path, NULL, &sink));
    assert_null(csv.text);
    assert_said(part);
}

static void test_bad_files(void **state)
{
    (void)state;
    expect_refused("", 0, "empty");
    expect_refused("\n\r\n", 3, "empty");
    expect_refused("\xff\xfe" "a\0,\0b\0\n\0", 10, "UTF-16");
    expect_refused("\xfe\xff\0a\0,\0b", 8, "UTF-16");
    expect_refused("a\0,\0b\0\n\0", 8, "UTF-16");
    expect_refused("GIF89a\0\1\2", 9, "binary");
    expect_refused("a,b\r1,2\r", 8, "CR alone");
    expect_refused("a,b\n1,2\n3,H\xf6he\n", 15, "csv_test.csv:3: byte 0xf6 is not UTF-8");
    expect_refused("a,b\n1,\xc3", 7, ":2: byte 0xc3 is not UTF-8");
    struct wd_csv csv;
    captured.text[0] = 0;
    assert_false(wd_csv_open(&csv, "no_such_file.csv", NULL, &sink));
    assert_said("no_such_file.csv");
}

static void test_find(void **state)
{
    (void)state;
    struct wd_csv csv;
    write_text("DBH,dbh,Height\n1,2,3\n");
    assert_true(wd_csv_open(&csv, path, NULL, &sink));
    assert_int_equal(wd_csv_find(&csv, "dbh"), 1);
    assert_int_equal(wd_csv_find(&csv, "height"), 2);
    assert_int_equal(wd_csv_find(&csv, "width"), -1);
    char *names = wd_csv_names(&csv);
    assert_string_equal(names, "DBH, dbh, Height");
    free(names);
    wd_csv_close(&csv);
}

/* Every prefix and every single-byte change of a file is read or refused, never worse. */
static void test_damage(void **state)
{
    (void)state;
    static const char text[] = "\"x\",y;z\r\n1,\"a\"\"b\",2\r\n\"3\",4\n";
    static const char bytes[] = {'"', ',', '\r'};
    char damaged[sizeof text];
    for (size_t size = 0; size < sizeof text; size++)
        for (size_t i = 0; i < sizeof bytes * size + 1; i++) {
            memcpy(damaged, text, size);
            if (i < sizeof bytes * size)
                damaged[i / sizeof bytes] = bytes[i % sizeof bytes];
            write_bytes(damaged, size);
            struct wd_csv csv;
            double value;
            if (!wd_csv_open(&csv, path, NULL, &sink))
                continue;
            enum wd_csv_row row;
            while ((row = wd_csv_next(&csv)) == WD_CSV_ROW) {
                captured.text[0] = 0;
                wd_csv_number(&csv, 0, &value);
                captured.text[0] = 0;
            }
            wd_csv_close(&csv);
        }
}

static int remove_file(void **state)
{
    (void)state;
    unlink(path);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_quotes_and_line_ends),
        cmocka_unit_test(test_delimiters),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_bad_rows),
        cmocka_unit_test(test_bad_files),
        cmocka_unit_test(test_find),
        cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests_name("csv", tests, NULL, remove_file);
}
