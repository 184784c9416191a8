/* One file that needs no other and no script: plots as SVG, pictures inside. */
#include "bench.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

static const char *const COLORS[] = {"#1b6ca8", "#c8553d", "#4b8f29", "#8e44ad", "#b8860b",
                                     "#0f8b8d", "#d81b60", "#5d6d7e", "#7f5539", "#2a9d8f"};
enum { COLOR_COUNT = sizeof COLORS / sizeof *COLORS, PLOT_WIDTH = 560, PLOT_HEIGHT = 300 };

/* --- the machine ----------------------------------------------------------------------------------- */

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
    if (asprintf(&text, "device: %s\nprocessor: %s, %ld threads\nmemory: %.1f GB\nsystem: %s %s %s\n"
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

/* --- parts ----------------------------------------------------------------------------------------- */

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

static const char *color_of(const struct bench *bench, const char *method)
{
    for (size_t i = 0; bench->methods[i]; i++)
        if (strcmp(bench->methods[i], method) == 0)
            return COLORS[i % COLOR_COUNT];
    return "#999999";
}

static bool same_place(const struct bench_row *a, const struct bench_row *b)
{
    return !strcmp(a->scene, b->scene) && !strcmp(a->camera, b->camera);
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
                          const char *what, const char *caption)
{
    char *path = bench_path(bench, "pictures/%s-%s-%s.png", row->scene, row->camera, what);
    FILE *file = fopen(path, "rb");
    unsigned char *data = NULL;
    long size = file && fseek(file, 0, SEEK_END) == 0 ? ftell(file) : 0;
    if (size > 0 && (data = malloc((size_t)size)) && fseek(file, 0, SEEK_SET) == 0 &&
        fread(data, 1, (size_t)size, file) == (size_t)size) {
        fputs("<figure><img alt=\"", to);
        print_escaped(to, caption);
        fputs("\" src=\"data:image/png;base64,", to);
        print_base64(to, data, (size_t)size);
        fputs("\"><figcaption>", to);
        print_escaped(to, caption);
        fputs("</figcaption></figure>\n", to);
    }
    free(data);
    if (file)
        fclose(file);
    free(path);
}

/* --- plots ----------------------------------------------------------------------------------------- */

struct range {
    double low, high;
};

static struct range range_of(const struct bench *bench, const struct bench_row *place,
                             uint32_t column)
{
    struct range range = {INFINITY, -INFINITY};
    for (size_t i = 0; i < bench->row_count; i++) {
        double value = bench->rows[i].values[column];
        if (!same_place(&bench->rows[i], place) || !isfinite(value))
            continue;
        range.low = fmin(range.low, value);
        range.high = fmax(range.high, value);
    }
    double room = 0.12 * (range.high - range.low) + 0.02 * fabs(range.high) + 1e-9;
    double low = range.low - room; /* nothing but biases is below zero */
    return (struct range){range.low >= 0 && low < 0 ? 0 : low, range.high + room};
}

static double place_on(struct range range, double value, double low, double high)
{
    return low + (value - range.low) / (range.high - range.low) * (high - low);
}

static void print_axes(FILE *to, struct range x, struct range y, const char *y_name)
{
    fprintf(to, "<path d=\"M50 10V%d H%d\" fill=\"none\" stroke=\"#555\"/>\n", PLOT_HEIGHT - 40,
            PLOT_WIDTH - 10);
    for (int i = 0; i <= 4; i++) {
        double vx = x.low + (x.high - x.low) * i / 4, vy = y.low + (y.high - y.low) * i / 4;
        fprintf(to, "<text x=\"%.0f\" y=\"%d\" text-anchor=\"middle\">%.4g</text>",
                place_on(x, vx, 50, PLOT_WIDTH - 10), PLOT_HEIGHT - 24, vx);
        fprintf(to, "<text x=\"46\" y=\"%.0f\" text-anchor=\"end\">%.3g</text>\n",
                place_on(y, vy, PLOT_HEIGHT - 40, 10) + 4, vy);
    }
    fprintf(to, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">frame, ms</text>", PLOT_WIDTH / 2,
            PLOT_HEIGHT - 6);
    fprintf(to, "<text x=\"56\" y=\"20\">%s</text>\n", y_name);
}

/* Time across, error up: the best method is at the lower left. */
static void print_plot(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    struct range x = range_of(bench, place, BENCH_FRAME_MS);
    uint32_t column = isfinite(place->values[bench->metric]) ? bench->metric : BENCH_DEVICE_MB;
    struct range y = range_of(bench, place, column);
    if (!(x.high > x.low) || !(y.high > y.low))
        return;
    fprintf(to, "<svg class=\"plot\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\">\n",
            PLOT_WIDTH, PLOT_HEIGHT, PLOT_WIDTH, PLOT_HEIGHT);
    print_axes(to, x, y, bench_column_name(column));
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        if (!same_place(row, place) || !isfinite(row->values[column]))
            continue;
        double cx = place_on(x, row->values[BENCH_FRAME_MS], 50, PLOT_WIDTH - 10);
        double cy = place_on(y, row->values[column], PLOT_HEIGHT - 40, 10);
        fprintf(to, "<circle class=\"method\" cx=\"%.1f\" cy=\"%.1f\" r=\"6\" fill=\"%s\"/>", cx,
                cy, color_of(bench, row->method));
        fprintf(to, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n",
                cx > PLOT_WIDTH - 90 ? cx - 9 : cx + 9, cy + 4,
                cx > PLOT_WIDTH - 90 ? "end" : "start", row->method);
    }
    fprintf(to, "</svg>\n");
}

/* --- tables and strips ----------------------------------------------------------------------------- */

static bool column_used(const struct bench *bench, uint32_t column)
{
    for (size_t i = 0; i < bench->row_count; i++)
        if (isfinite(bench->rows[i].values[column]))
            return true;
    return false;
}

static void print_table(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    fprintf(to, "<table><tr><th>method</th>");
    for (uint32_t c = BENCH_FRAME_MS; c < BENCH_COLUMNS; c++)
        if (column_used(bench, c))
            fprintf(to, "<th>%s</th>", bench_column_name(c));
    fprintf(to, "<th>passes: GPU + CPU ms</th></tr>\n");
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        if (!same_place(row, place))
            continue;
        fprintf(to, "<tr class=\"result\"><td style=\"color:%s\">%s</td>",
                color_of(bench, row->method), row->method);
        for (uint32_t c = BENCH_FRAME_MS; c < BENCH_COLUMNS; c++) {
            if (column_used(bench, c) && isfinite(row->values[c]))
                fprintf(to, "<td>%.4g</td>", row->values[c]);
            else if (column_used(bench, c))
                fprintf(to, "<td></td>");
        }
        fputs("<td class=\"passes\">", to);
        print_escaped(to, row->passes);
        fputs("</td></tr>\n", to);
    }
    fputs("</table>\n", to);
}

static void print_strip(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    if (!(bench->suite->measures & BENCH_ERROR))
        return;
    fputs("<div class=\"strip\">\n", to);
    print_picture(to, bench, place, "reference", "path-traced reference");
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        char caption[96], what[48];
        if (!same_place(row, place))
            continue;
        snprintf(caption, sizeof caption, "%s, FLIP %.3f", row->method,
                 row->values[BENCH_COMPARISON]);
        print_picture(to, bench, row, row->method, caption);
        snprintf(what, sizeof what, "%s-error", row->method);
        snprintf(caption, sizeof caption, "%s: error", row->method);
        print_picture(to, bench, row, what, caption);
    }
    fputs("</div>\n", to);
}

static bool is_first_of_place(const struct bench *bench, size_t index)
{
    for (size_t i = 0; i < index; i++)
        if (same_place(&bench->rows[i], &bench->rows[index]))
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
            "td:first-child,th:first-child,.passes{text-align:left}\n.passes{font-size:11px}\n"
            "svg text{font:12px sans-serif}\nfigure{display:inline-block;margin:.3em}\n"
            "figure img{width:320px;image-rendering:auto}\nfigcaption{font-size:13px}\n"
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
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        if (!is_first_of_place(bench, i))
            continue;
        fputs("<section><h2>", to);
        print_escaped(to, row->scene);
        fprintf(to, ", %s</h2>\n<p>%.0f trees; ready in %.1f s.</p>\n", row->camera,
                row->values[BENCH_TREES], row->values[BENCH_START_S]);
        print_plot(to, bench, row);
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
