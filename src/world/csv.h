/* csv.h: tables of text with a header row (RFC 4180), read tolerantly and complained about exactly. */
#ifndef WD_WORLD_CSV_H
#define WD_WORLD_CSV_H

#include "base/log.h"

/* UTF-8 with or without byte order mark; lines end in LF or CRLF; fields may be quoted. */
struct wd_csv {
    const char *path;
    const struct wd_log *log;
    char *text;      /* the whole file; fields are unquoted in place */
    char *at, *end;
    char delimiter;
    const char **header;
    const char **fields; /* of the row read last, white space around them cut off */
    size_t column_count;
    uint64_t line;     /* of that row's first character, from 1 */
    uint64_t next_line;
    bool decimal_comma; /* a number may be written 12,5: the delimiter is not a comma */
};

/* `path` must outlive the table. `delimiter` is one character or "tab"; NULL: found out from the
 * header. Files over 1 GB, binary files and what is not UTF-8 are refused. */
bool wd_csv_open(struct wd_csv *csv, const char *path, const char *delimiter,
                 const struct wd_log *log);
void wd_csv_close(struct wd_csv *csv);

enum wd_csv_row { WD_CSV_ROW, WD_CSV_END, WD_CSV_ERROR };
/* The next row that is not blank. A row with more or fewer fields than the header is an error. */
enum wd_csv_row wd_csv_next(struct wd_csv *csv);

/* Column of that name (exactly, else without regard to case), or -1. */
int wd_csv_find(const struct wd_csv *csv, const char *name);
/* The header's names for an error message: "a, b, c"; free() it. */
char *wd_csv_names(const struct wd_csv *csv);

/* Whether a field says nothing: empty, NA or NULL. */
bool wd_csv_is_missing(const char *text);

enum wd_csv_value { WD_CSV_NUMBER, WD_CSV_MISSING, WD_CSV_BAD };
/* Reads a field as a number. BAD has been logged with file:line:column name. NaN and infinities are BAD. */
enum wd_csv_value wd_csv_number(const struct wd_csv *csv, int column, double *value);

#endif
