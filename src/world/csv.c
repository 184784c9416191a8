#include "world/csv.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/utf8.h"

static const size_t most_bytes = (size_t)1 << 30;
enum { MOST_COLUMNS = 4096, MOST_NAME_BYTES = 1000 };

/* Species and columns are compared with names of the scene, which is UTF-8. */
static bool check_utf8(const char *path, const char *text, size_t size, const struct wd_log *log)
{
    uint64_t line = 1;
    size_t length;
    for (size_t at = 0; at < size; at += length) {
        line += text[at] == '\n';
        length = wd_utf8_length(text + at, size - at);
        if (length == 0)
            return wd_error(log, "%s:%" PRIu64 ": byte 0x%02x is not UTF-8, it may be Latin-1 or Windows-1252; "
                            "save the file as UTF-8", path, line, (unsigned char)text[at]);
    }
    return true;
}

static bool check_encoding(const char *path, const char *text, size_t size,
                           const struct wd_log *log)
{
    const unsigned char *bytes = (const unsigned char *)text;
    bool mark = size >= 2 && ((bytes[0] == 0xff && bytes[1] == 0xfe) ||
                              (bytes[0] == 0xfe && bytes[1] == 0xff));
    bool wide = size >= 4 && ((bytes[0] == 0) != (bytes[1] == 0)) &&
                ((bytes[2] == 0) != (bytes[3] == 0));
    if (mark || wide)
        return wd_error(log, "%s: is UTF-16; save it as UTF-8", path);
    const char *zero = memchr(text, 0, size);
    if (zero)
        return wd_error(log, "%s: byte %zu is zero; this is a binary file, not CSV", path,
                        (size_t)(zero - text));
    if (memchr(text, '\r', size) && !memchr(text, '\n', size))
        return wd_error(log, "%s: lines end in CR alone; save it with LF or CRLF", path);
    return check_utf8(path, text, size, log);
}

/* The candidate that stands most often in the first line outside quotes. */
static char guess_delimiter(const char *text)
{
    static const char candidates[] = {',', ';', '\t'};
    size_t counts[3] = {0};
    bool quoted = false;
    for (const char *at = text; *at && (quoted || (*at != '\n' && *at != '\r')); at++) {
        if (*at == '"')
            quoted = !quoted;
        for (int i = 0; i < 3 && !quoted; i++)
            counts[i] += *at == candidates[i];
    }
    int best = 0;
    for (int i = 1; i < 3; i++)
        if (counts[i] > counts[best])
            best = i;
    return candidates[best];
}

static bool choose_delimiter(struct wd_csv *csv, const char *wanted)
{
    if (wanted == NULL || *wanted == 0)
        csv->delimiter = guess_delimiter(csv->at);
    else if (strcasecmp(wanted, "tab") == 0 || strcmp(wanted, "\\t") == 0)
        csv->delimiter = '\t';
    else if (strlen(wanted) == 1 && !strchr("\"\r\n", *wanted))
        csv->delimiter = *wanted;
    else
        return wd_error(csv->log, "%s: delimiter \"%s\": one character or \"tab\" is wanted",
                        csv->path, wanted);
    csv->decimal_comma = csv->delimiter != ',';
    return true;
}

static void skip_blank_lines(struct wd_csv *csv)
{
    while (csv->at < csv->end) {
        char *at = csv->at;
        while (*at == ' ' || *at == '\r')
            at++;
        if (*at != '\n' && at < csv->end)
            return;
        csv->next_line += *at == '\n';
        csv->at = at < csv->end ? at + 1 : at;
    }
}

/* Programs of tables tell one another the delimiter by a line before the header: "sep=;". 0: there is none. */
static char skip_separator_line(struct wd_csv *csv)
{
    if (csv->end - csv->at < 6 || strncasecmp(csv->at, "sep=", 4) != 0 || !strchr("\r\n", csv->at[5]))
        return 0;
    char separator = csv->at[4];
    csv->at += csv->at[5] == '\r' ? 7 : 6;
    csv->at = csv->at < csv->end ? csv->at : csv->end;
    csv->next_line++;
    return separator;
}

/* Unquotes a field in place; `*at` is left behind its closing quote. */
static bool read_quoted(struct wd_csv *csv, char **at, char **last)
{
    char *from = *at + 1, *to = from;
    uint64_t opened = csv->next_line;
    for (; from < csv->end; from++) {
        if (*from == '"') {
            if (from[1] != '"')
                break;
            from++;
        }
        csv->next_line += *from == '\n';
        *to++ = *from;
    }
    if (from == csv->end)
        return wd_error(csv->log, "%s:%" PRIu64 ": a quote opened here is never closed", csv->path,
                        opened);
    *at = from + 1;
    *last = to;
    return true;
}

static bool at_field_end(const struct wd_csv *csv, const char *at)
{
    return at >= csv->end || *at == csv->delimiter || *at == '\n' ||
           (*at == '\r' && (at[1] == '\n' || at + 1 == csv->end));
}

/* Reads one field; returns its text, cut at both ends, or NULL on error. `*terminator` is what
 * stood behind it. */
static const char *read_field(struct wd_csv *csv, char *terminator)
{
    char *first = csv->at, *last = first;
    while ((*first == ' ' || *first == '\t') && *first != csv->delimiter)
        first++;
    char *at = first;
    if (*first == '"') {
        first++;
        if (!read_quoted(csv, &at, &last))
            return NULL;
        while ((*at == ' ' || *at == '\t') && *at != csv->delimiter)
            at++;
        if (!at_field_end(csv, at)) {
            wd_error(csv->log, "%s:%" PRIu64 ": text follows a closing quote; a quote within a "
                     "quoted field is written \"\"", csv->path, csv->next_line);
            return NULL;
        }
    } else {
        while (!at_field_end(csv, at))
            at++;
        last = at;
        while (last > first && (last[-1] == ' ' || last[-1] == '\t'))
            last--;
    }
    if (*at == '\r')
        at++;
    *terminator = at < csv->end ? *at : '\n';
    csv->next_line += at < csv->end && *at == '\n';
    csv->at = at < csv->end ? at + 1 : at;
    *last = 0;
    return first;
}

/* Reads a row into `fields`; returns how many there are, at most `most` of them kept; 0: error. */
static size_t read_row(struct wd_csv *csv, const char **fields, size_t most)
{
    size_t count = 0;
    char terminator;
    csv->line = csv->next_line;
    do {
        const char *field = read_field(csv, &terminator);
        if (!field)
            return 0;
        if (count < most)
            fields[count] = field;
        count++;
    } while (terminator == csv->delimiter);
    return count;
}

static bool read_header(struct wd_csv *csv)
{
    skip_blank_lines(csv);
    if (csv->at >= csv->end)
        return wd_error(csv->log, "%s: is empty; a header row is wanted", csv->path);
    csv->header = wd_alloc_array(MOST_COLUMNS, sizeof *csv->header);
    csv->column_count = read_row(csv, csv->header, MOST_COLUMNS);
    if (csv->column_count > MOST_COLUMNS)
        return wd_error(csv->log, "%s:%" PRIu64 ": %zu columns, at most %d are read", csv->path,
                        csv->line, csv->column_count, MOST_COLUMNS);
    for (size_t i = 0; i < csv->column_count; i++)
        if (strlen(csv->header[i]) > MOST_NAME_BYTES)
            return wd_error(csv->log, "%s:%" PRIu64 ": the name of column %zu has %zu bytes, at most %d are read; is the "
                            "first row the header?", csv->path, csv->line, i + 1, strlen(csv->header[i]), MOST_NAME_BYTES);
    csv->fields = wd_alloc_array(csv->column_count, sizeof *csv->fields);
    return csv->column_count > 0;
}

bool wd_csv_open(struct wd_csv *csv, const char *path, const char *delimiter,
                 const struct wd_log *log)
{
    size_t size;
    *csv = (struct wd_csv){.path = path, .log = log, .next_line = 1};
    if (!wd_file_read(path, most_bytes, log, &csv->text, &size)) {
        *csv = (struct wd_csv){0};
        return false;
    }
    csv->at = csv->text;
    csv->end = csv->text + size;
    if (size >= 3 && memcmp(csv->text, "\xef\xbb\xbf", 3) == 0)
        csv->at += 3;
    if (check_encoding(path, csv->text, size, log)) {
        const char told[] = {skip_separator_line(csv), 0};
        bool given = delimiter && *delimiter;
        if (choose_delimiter(csv, given ? delimiter : told) && read_header(csv))
            return true;
    }
    wd_csv_close(csv);
    return false;
}

void wd_csv_close(struct wd_csv *csv)
{
    free(csv->text);
    free(csv->header);
    free(csv->fields);
    *csv = (struct wd_csv){0};
}

/* Spreadsheets write the rows below a table that are formatted but empty. */
static bool is_empty_row(const struct wd_csv *csv, size_t count)
{
    for (size_t i = 0; i < count && i < csv->column_count; i++)
        if (*csv->fields[i])
            return false;
    return count > 1 && count <= csv->column_count;
}

enum wd_csv_row wd_csv_next(struct wd_csv *csv)
{
    size_t count;
    do {
        skip_blank_lines(csv);
        if (csv->at >= csv->end)
            return WD_CSV_END;
        count = read_row(csv, csv->fields, csv->column_count);
        if (count == 0)
            return WD_CSV_ERROR;
    } while (is_empty_row(csv, count));
    if (count == csv->column_count)
        return WD_CSV_ROW;
    const char *name = csv->delimiter == '\t' ? "tab" : (const char[]){csv->delimiter, 0};
    wd_error(csv->log, "%s:%" PRIu64 ": %zu fields, but the header has %zu (delimiter: %s)%s",
             csv->path, csv->line, count, csv->column_count, name,
             csv->delimiter == ',' && count > csv->column_count
                 ? "; decimal commas need another delimiter, and text with commas needs quotes"
                 : "");
    return WD_CSV_ERROR;
}

int wd_csv_find(const struct wd_csv *csv, const char *name)
{
    for (size_t i = 0; i < csv->column_count; i++)
        if (strcmp(csv->header[i], name) == 0)
            return (int)i;
    for (size_t i = 0; i < csv->column_count; i++)
        if (strcasecmp(csv->header[i], name) == 0)
            return (int)i;
    return -1;
}

/* As many as a message has room for. */
char *wd_csv_names(const struct wd_csv *csv)
{
    enum { ENOUGH = 100, MOST_LETTERS = 1000 };
    size_t count = 0, letters = 0;
    while (count < csv->column_count && count < ENOUGH && letters < MOST_LETTERS)
        letters += strnlen(csv->header[count++], MOST_LETTERS);
    char *names = wd_join(csv->header, count, ", ");
    if (count == csv->column_count)
        return names;
    char *more = wd_format("%s, ... (%zu columns)", names, csv->column_count);
    free(names);
    return more;
}

static double power_of_ten(int exponent)
{
    double power = 1.0;
    while (exponent-- > 0)
        power *= 10.0;
    return power;
}

/* A decimal number over the whole text, without regard to the locale. Digits beyond the 18th do
 * not count; up to 15 digits and 22 places the result is the nearest double. */
static bool parse_number(const char *text, bool decimal_comma, double *value)
{
    uint64_t digits = 0;
    int places = 0, seen = 0, exponent = 0;
    bool negative = *text == '-', point = false;
    text += *text == '-' || *text == '+';
    for (;; text++) {
        if (isdigit((unsigned char)*text)) {
            seen++;
            if (digits < UINT64_C(100000000000000000)) {
                digits = digits * 10 + (uint64_t)(*text - '0');
                places += point;
            } else {
                places -= !point;
            }
        } else if (!point && (*text == '.' || (decimal_comma && *text == ','))) {
            point = true;
        } else {
            break;
        }
    }
    if (seen == 0)
        return false;
    if (*text == 'e' || *text == 'E') {
        char *end;
        long written = strtol(text + 1, &end, 10);
        if (end == text + 1 || isspace((unsigned char)text[1]) || written < -300 || written > 300)
            return false;
        exponent = (int)written;
        text = end;
    }
    exponent -= places;
    if (*text != 0 || exponent > 300 || exponent < -300)
        return false;
    *value = exponent < 0 ? (double)digits / power_of_ten(-exponent)
                          : (double)digits * power_of_ten(exponent);
    *value = negative ? -*value : *value;
    return *value <= 1e300 && *value >= -1e300;
}

bool wd_csv_is_missing(const char *text)
{
    return *text == 0 || strcmp(text, "NA") == 0 || strcasecmp(text, "null") == 0;
}

enum wd_csv_value wd_csv_number(const struct wd_csv *csv, int column, double *value)
{
    const char *text = csv->fields[column];
    *value = 0.0;
    if (wd_csv_is_missing(text))
        return WD_CSV_MISSING;
    if (parse_number(text, csv->decimal_comma, value))
        return WD_CSV_NUMBER;
    bool comma = !csv->decimal_comma && strchr(text, ',') != NULL;
    wd_error(csv->log, "%s:%" PRIu64 ": column %s: \"%.40s\" is not a number%s", csv->path,
             csv->line, csv->header[column], text,
             comma ? "; decimal commas are read only where the delimiter is not a comma" : "");
    return WD_CSV_BAD;
}
