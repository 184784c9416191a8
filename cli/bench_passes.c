/* Bars of the report: what of a frame each pass takes, a bar a method. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PASSES_MAX = 10, NAME_MAX_LENGTH = 31 };

struct pass {
    char name[NAME_MAX_LENGTH + 1];
    double gpu_ms, cpu_ms;
};

struct names {
    char names[PASSES_MAX][NAME_MAX_LENGTH + 1];
    uint32_t count;
};

/* Reads "name=gpu+cpu;" and returns what follows, or NULL at the end. */
static const char *take_pass(const char *text, struct pass *pass)
{
    size_t length = strcspn(text, "=");
    char *end;
    if (!text[length] || length > NAME_MAX_LENGTH)
        return NULL;
    memcpy(pass->name, text, length);
    pass->name[length] = 0;
    pass->gpu_ms = strtod(text + length + 1, &end);
    pass->cpu_ms = *end == '+' ? strtod(end + 1, &end) : 0;
    return *end == ';' ? end + 1 : end;
}

/* Where a pass's name stands among those of the place; the last of them stands for what is too many. */
static uint32_t name_index(struct names *names, const char *name)
{
    uint32_t i = 0;
    while (i < names->count && strcmp(names->names[i], name) != 0)
        i++;
    if (i < names->count || names->count == PASSES_MAX)
        return i < PASSES_MAX ? i : PASSES_MAX - 1;
    snprintf(names->names[names->count++], sizeof names->names[0], "%s", name);
    return i;
}

static double longest_bar(const struct bench *bench, const struct bench_row *place,
                          struct names *names)
{
    double longest_ms = 0;
    for (size_t i = 0; i < bench->row_count; i++) {
        struct pass pass;
        double sum_ms = 0;
        if (!bench_same_place(&bench->rows[i], place))
            continue;
        for (const char *at = bench->rows[i].passes; at && (at = take_pass(at, &pass));) {
            name_index(names, pass.name);
            sum_ms += pass.gpu_ms + pass.cpu_ms;
        }
        longest_ms = fmax(longest_ms, sum_ms);
    }
    return longest_ms;
}

static void print_bar(FILE *to, const struct bench_row *row,
                      struct names *names, double longest_ms)
{
    struct pass pass;
    double sum_ms = 0;
    fprintf(to, "<div class=\"name m%u\">%s</div><div class=\"bar\">",
            bench_method_color(row->method), row->method);
    for (const char *at = row->passes; at && (at = take_pass(at, &pass));) {
        double ms = pass.gpu_ms + pass.cpu_ms;
        sum_ms += ms;
        fprintf(to, "<i class=\"p%u\" style=\"width:%.2f%%\" title=\"%s: GPU %.2f, CPU %.2f ms\"></i>",
                name_index(names, pass.name), 88 * ms / longest_ms, pass.name, pass.gpu_ms,
                pass.cpu_ms);
    }
    fprintf(to, "<b>%.*f ms</b></div>\n", sum_ms < 100 ? 1 : 0, sum_ms);
}

void bench_print_passes(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    struct names names = {.count = 0};
    double longest_ms = longest_bar(bench, place, &names);
    if (!(longest_ms > 0))
        return;
    fputs("<h3>Where the time goes</h3>\n<p class=\"legend\">", to);
    for (uint32_t i = 0; i < names.count; i++)
        fprintf(to, "<span><i class=\"p%u\"></i>%s</span>", i, names.names[i]);
    fputs("</p>\n<div class=\"bars\">\n", to);
    for (size_t i = 0; i < bench->row_count; i++)
        if (bench_same_place(&bench->rows[i], place))
            print_bar(to, &bench->rows[i], &names, longest_ms);
    fputs("</div>\n", to);
}
