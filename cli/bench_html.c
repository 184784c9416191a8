/* One file that needs no other and no script: plots as SVG, pictures inside. */
#include "bench.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

/* --- the machine
 * ----------------------------------------------------------------------------------- */

static void processor_name(char name[128])
{
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    snprintf(name, 128, "unknown processor");
    while (file && fgets(line, sizeof line, file)) {
        char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && colon) {
            snprintf(name, 128, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
            break;
        }
    }
    if (file)
        fclose(file);
}

/* As the run that measured wrote it down. */
static char *remembered(const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = fopen(path, "r");
    if (file && getdelim(&text, &size, 0, file) <= 0) {
        free(text);
        text = NULL;
    }
    if (file)
        fclose(file);
    return text;
}

static void remember(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return; /* the report itself holds it, too */
    fputs(text, file);
    fclose(file);
}

static char *describe_machine(const struct bench *bench)
{
    char processor[128], *text = NULL;
    struct utsname name;
    processor_name(processor);
    if (uname(&name) != 0)
        name = (struct utsname){0};
    double memory_gb = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGE_SIZE) * 1e-9;
    if (asprintf(&text,
                 "device: %s\nprocessor: %s, %ld threads\nmemory: %.1f GB\nsystem: %s %s %s\n"
                 "weald " WEALD_VERSION,
                 bench->device, processor, sysconf(_SC_NPROCESSORS_ONLN), memory_gb, name.sysname,
                 name.release, name.machine) < 0)
        abort();
    return text;
}

char *bench_machine_text(const struct bench *bench)
{
    char *path = bench_path(bench, "machine.txt"), *text = NULL;
    if (*bench->device) {
        text = describe_machine(bench);
        remember(path, text);
    } else {
        text = remembered(path);
    }
    free(path);
    return text ? text : describe_machine(bench);
}

/* --- parts
 * ----------------------------------------------------------------------------------------- */

static void print_escaped(FILE *to, const char *text)
{
    for (; *text; text++) {
        if (*text == '<')
            fputs("&lt;", to);
        else if (*text == '&')
            fputs("&amp;", to);
        else if (*text == '"')
            fputs("&quot;", to);
        else
            fputc(*text, to);
    }
}

static void print_base64(FILE *to, const unsigned char *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        unsigned value = (unsigned)data[i] << 16;
        value |= i + 1 < size ? (unsigned)data[i + 1] << 8 : 0;
        value |= i + 2 < size ? data[i + 2] : 0;
        fputc(digits[value >> 18], to);
        fputc(digits[value >> 12 & 63], to);
        fputc(i + 1 < size ? digits[value >> 6 & 63] : '=', to);
        fputc(i + 2 < size ? digits[value & 63] : '=', to);
    }
}

static void print_picture(FILE *to, const struct bench *bench, const struct bench_row *row,
                          const char *what)
{
    char *path = bench_path(bench, "pictures/%s-%s-%s.jpg", row->scene, row->camera, what);
    FILE *file = fopen(path, "rb");
    unsigned char *data = NULL;
    long size = file && fseek(file, 0, SEEK_END) == 0 ? ftell(file) : 0;
    if (size > 0 && (data = malloc((size_t)size)) && fseek(file, 0, SEEK_SET) == 0 &&
        fread(data, 1, (size_t)size, file) == (size_t)size) {
        fputs("<img alt=\"", to);
        print_escaped(to, what);
        fputs("\" src=\"data:image/jpeg;base64,", to);
        print_base64(to, data, (size_t)size);
        fputs("\">", to);
    }
    free(data);
    if (file)
        fclose(file);
    free(path);
}

/* --- tables and strips
 * ----------------------------------------------------------------------------- */

static bool column_used(const struct bench *bench, uint32_t column)
{
    for (size_t i = 0; i < bench->row_count; i++)
        if (isfinite(bench->rows[i].values[column]))
            return true;
    return false;
}

static void print_heads(FILE *to, const struct bench *bench)
{
    fprintf(to, "<tr><th>method</th>");
    for (uint32_t c = BENCH_FRAME_MS; c < BENCH_COLUMNS; c++) {
        char name[64];
        snprintf(name, sizeof name, "%s", bench_column_name(c));
        for (char *at = name; *at; at++)
            *at = *at == '_' ? ' ' : *at;
        if (column_used(bench, c))
            fprintf(to, "<th>%s</th>", name);
    }
    fprintf(to, "</tr>\n");
}

static void print_value(FILE *to, double value)
{
    if (!isfinite(value))
        fputs("<td></td>", to);
    else if (fabs(value) >= 1000)
        fprintf(to, "<td>%.0f</td>", value);
    else
        fprintf(to, "<td>%.3g</td>", value);
}

static void print_table(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    fputs("<table>", to);
    print_heads(to, bench);
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        if (!bench_same_place(row, place))
            continue;
        fprintf(to, "<tr class=\"result\"><td style=\"color:%s\">%s</td>",
                bench_method_color(bench, row->method), row->method);
        for (uint32_t c = BENCH_FRAME_MS; c < BENCH_COLUMNS; c++)
            if (column_used(bench, c))
                print_value(to, row->values[c]);
        fputs("</tr>\n", to);
    }
    fputs("</table>\n<details><summary>Times of the passes, milliseconds</summary><table>\n", to);
    for (size_t i = 0; i < bench->row_count; i++) {
        if (!bench_same_place(&bench->rows[i], place))
            continue;
        fprintf(to, "<tr><td>%s</td><td class=\"passes\">", bench->rows[i].method);
        for (const char *at = bench->rows[i].passes; *at; at++)
            fputs(*at == ';' ? ", " : *at == '=' ? " " : (char[]){*at, 0}, to);
        fputs("</td></tr>\n", to);
    }
    fputs("</table><p>GPU + CPU time of each.</p></details>\n", to);
}

static void print_strip(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    if (!(bench->suite->measures & BENCH_ERROR))
        return;
    fputs("<div class=\"strip\">\n<figure>", to);
    print_picture(to, bench, place, "reference");
    fputs("<figcaption>path-traced reference</figcaption></figure>\n", to);
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        char what[48];
        if (!bench_same_place(row, place))
            continue;
        snprintf(what, sizeof what, "%s-error", row->method);
        fputs("<figure>", to);
        print_picture(to, bench, row, row->method);
        print_picture(to, bench, row, what);
        fprintf(to, "<figcaption><b style=\"color:%s\">%s</b> FLIP %.3f</figcaption></figure>\n",
                bench_method_color(bench, row->method), row->method, row->values[BENCH_COMPARISON]);
    }
    fputs("</div>\n", to);
}

/* --- all places at a glance
 * ------------------------------------------------------------------------ */

static bool is_first_of_place(const struct bench *bench, size_t index);

static void print_glance_row(FILE *to, const struct bench *bench, const char *method)
{
    fprintf(to, "<tr><td style=\"color:%s\">%s</td>", bench_method_color(bench, method), method);
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *place = &bench->rows[i], *row;
        if (!is_first_of_place(bench, i))
            continue;
        row = bench_results_find(bench, place->scene, place->camera, method);
        print_value(to, row ? row->values[BENCH_FRAME_MS] : NAN);
        print_value(to, row ? row->values[bench->metric] : NAN);
    }
    fputs("</tr>\n", to);
}

static void print_glance(FILE *to, const struct bench *bench)
{
    fputs("<table><tr><th></th>", to);
    for (size_t i = 0; i < bench->row_count; i++)
        if (is_first_of_place(bench, i)) {
            fputs("<th colspan=\"2\">", to);
            print_escaped(to, bench->rows[i].scene);
            fprintf(to, "<br>%s</th>", bench->rows[i].camera);
        }
    fputs("</tr>\n<tr><th>method</th>", to);
    for (size_t i = 0; i < bench->row_count; i++)
        if (is_first_of_place(bench, i))
            fprintf(to, "<th>ms</th><th>%s</th>", bench_column_name(bench->metric));
    fputs("</tr>\n", to);
    for (size_t m = 0; bench->methods[m]; m++)
        print_glance_row(to, bench, bench->methods[m]);
    fputs("</table>\n", to);
}

static bool is_first_of_place(const struct bench *bench, size_t index)
{
    for (size_t i = 0; i < index; i++)
        if (bench_same_place(&bench->rows[i], &bench->rows[index]))
            return false;
    return true;
}

static void print_report(FILE *to, const struct bench *bench)
{
    char *machine = bench_machine_text(bench);
    fprintf(to,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
            "<title>weald bench: %s</title>\n<style>\n"
            "body{font:15px/1.45 sans-serif;margin:2em;color:#222;max-width:110em}\n"
            "table{border-collapse:collapse;font-size:13px;margin:1em 0}\n"
            "th,td{padding:.2em .6em;border-bottom:1px solid #ddd;text-align:right}\n"
            "th[colspan]{text-align:center}\n"
            "td:first-child,th:first-child,.passes{text-align:left}\n.passes{font-size:11px}\n"
            "svg text{font:12px sans-serif}\n.strip{display:flex;flex-wrap:wrap;gap:.7em}\n"
            "figure{margin:0;width:240px}\nfigure img{width:240px;display:block}\n"
            "figcaption{font-size:13px}\nsection{margin-top:3em}\nth{font-weight:600}\n"
            "pre{background:#f4f4f2;padding:1em}\n</style></head><body>\n<h1>weald bench: %s</h1>\n"
            "<p>%s. Effort: %s, %u x %u pixels, %u frames; errors against path-traced pictures of "
            "%u samples a pixel.</p>\n<pre id=\"machine\">",
            bench->suite->name, bench->suite->name, bench->suite->summary, bench->effort.name,
            bench->effort.width, bench->effort.height, bench->effort.frames,
            bench->suite->measures & BENCH_POPPING ? bench->effort.step_samples
                                                   : bench->effort.truth_samples);
    print_escaped(to, machine);
    fputs("</pre>\n", to);
    free(machine);
    print_glance(to, bench);
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        if (!is_first_of_place(bench, i))
            continue;
        fputs("<section><h2>", to);
        print_escaped(to, row->scene);
        fprintf(to, ", %s</h2>\n<p>%.0f trees; ready in %.1f s.</p>\n", row->camera,
                row->values[BENCH_TREES], row->values[BENCH_START_S]);
        bench_print_plot(to, bench, row);
        print_table(to, bench, row);
        print_strip(to, bench, row);
        fputs("</section>\n", to);
    }
    fputs("</body></html>\n", to);
}

bool bench_write_html(const struct bench *bench)
{
    char *path = bench_path(bench, "report.html"), *temporary = bench_path(bench, ".report.tmp");
    FILE *file = fopen(temporary, "w");
    bool ok = file != NULL;
    if (ok) {
        print_report(file, bench);
        ok = fclose(file) == 0 && rename(temporary, path) == 0;
    }
    if (!ok)
        cli_fail(bench->session, "%s cannot be written: %s", path, strerror(errno));
    free(path);
    free(temporary);
    return ok;
}
