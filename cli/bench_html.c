/* The report: one file that needs no other and no script: plots as SVG, pictures inside. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_style.h"

/* --- parts --------------------------------------------------------------------------------- */

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

/* "frame_p95_ms" as "frame p95, ms". */
void bench_column_title(uint32_t column, char title[64])
{
    static const struct {
        const char *end, *unit;
    } units[] = {{"_ms", ", ms"}, {"_pct", ", %"}, {"_mb", ", MB"}, {"_s", ", s"}};
    static const char *const capitals[] = {"flip", "ssim", "rmse", "gpu", "cpu"};
    const char *name = bench_column_name(column);
    size_t length = strlen(name);
    const char *unit = "";
    for (size_t i = 0; !*unit && i < sizeof units / sizeof *units; i++) {
        size_t end = strlen(units[i].end);
        if (length > end && strcmp(name + length - end, units[i].end) == 0) {
            unit = units[i].unit;
            length -= end;
        }
    }
    snprintf(title, 64, "%.*s%s", (int)length, name, unit);
    for (char *at = title; (at = strchr(at, '_'));)
        *at = ' ';
    for (size_t i = 0; i < sizeof capitals / sizeof *capitals; i++) {
        char *at = strstr(title, capitals[i]);
        for (size_t k = 0; at && k < strlen(capitals[i]); k++)
            at[k] = (char)(at[k] - 'a' + 'A');
    }
}

static void print_value(FILE *to, double value, bool best)
{
    const char *begin = best ? "<td class=\"best\">" : "<td>";
    if (!isfinite(value))
        fputs("<td></td>", to);
    else if (fabs(value) >= 1e7)
        fprintf(to, "%s%.1f M</td>", begin, value * 1e-6);
    else if (fabs(value) >= 1000)
        fprintf(to, "%s%.0f</td>", begin, value);
    else
        fprintf(to, "%s%.3g</td>", begin, value);
}

/* --- one place: tables and strips ---------------------------------------------------------- */

static bool column_used(const struct bench *bench, uint32_t column)
{
    if (column == BENCH_NOISE_FLIP || column == BENCH_NOISE_BLOCKS) /* told in words */
        return false;
    for (size_t i = 0; i < bench->row_count; i++)
        if (isfinite(bench->rows[i].values[column]))
            return true;
    return false;
}

static void print_heads(FILE *to, const struct bench *bench)
{
    fprintf(to, "<tr><th>method</th>");
    for (uint32_t c = BENCH_FRAME_MS; c < BENCH_COLUMNS; c++) {
        char title[64];
        bench_column_title(c, title);
        if (column_used(bench, c))
            fprintf(to, "<th class=\"text\">%s</th>", title);
    }
    fprintf(to, "</tr>\n");
}

static void print_table(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    fputs("<div class=\"wide\"><table>", to);
    print_heads(to, bench);
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        if (!bench_same_place(row, place))
            continue;
        fprintf(to, "<tr class=\"result\"><td class=\"m%u\">%s</td>",
                bench_method_color(row->method), row->method);
        for (uint32_t c = BENCH_FRAME_MS; c < BENCH_COLUMNS; c++)
            if (column_used(bench, c))
                print_value(to, row->values[c], false);
        fputs("</tr>\n", to);
    }
    fputs("</table></div>\n", to);
}

static void print_strip(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    if (!(bench->suite->measures & BENCH_ERROR))
        return;
    fputs("<h3>Pictures over their errors</h3>\n<p class=\"legend\">FLIP of each pixel: 0"
          "<i class=\"ramp\"></i>1</p>\n<div class=\"strip\">\n<figure>",
          to);
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
        fprintf(to,
                "<figcaption><b class=\"m%u\">%s</b> FLIP %.3f, blocks %.2g %%, %.4g "
                "ms</figcaption></figure>\n",
                bench_method_color(row->method), row->method, row->values[BENCH_FLIP],
                row->values[BENCH_BLOCKS], row->values[BENCH_FRAME_MS]);
    }
    fputs("</div>\n", to);
}

static bool has_two_methods(const struct bench *bench, const struct bench_row *place)
{
    size_t count = 0;
    for (size_t i = 0; i < bench->row_count; i++)
        count += bench_same_place(&bench->rows[i], place);
    return count > 1;
}

/* The column that stands beside the chosen one. */
static uint32_t second_column(const struct bench *bench)
{
    if (bench->suite->measures & BENCH_POPPING)
        return BENCH_POPPING_P999;
    if (!(bench->suite->measures & BENCH_ERROR))
        return BENCH_DEVICE_MB;
    return bench->metric == BENCH_FLIP ? BENCH_BLOCKS : BENCH_FLIP;
}

static void print_plots(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    uint32_t second = second_column(bench);
    if (!has_two_methods(bench, place))
        return;
    fputs("<div class=\"plots\">\n", to);
    if (isfinite(place->values[bench->metric]))
        bench_print_plot(to, bench, place, bench->metric);
    if (isfinite(place->values[second]))
        bench_print_plot(to, bench, place, second);
    fputs("</div>\n", to);
}

static void print_place(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    fputs("<section><h2>", to);
    print_escaped(to, place->scene);
    fputs(", ", to);
    print_escaped(to, place->camera);
    fprintf(to, "</h2>\n<p class=\"faint\">%.0f trees; ready in %.1f s.",
            place->values[BENCH_TREES], place->values[BENCH_START_S]);
    if (isfinite(place->values[BENCH_NOISE_FLIP]))
        fprintf(to, " The reference's own noise: FLIP %.3f, %.2g %% of 16 x 16 blocks.",
                place->values[BENCH_NOISE_FLIP], place->values[BENCH_NOISE_BLOCKS]);
    fputs("</p>\n", to);
    print_plots(to, bench, place);
    print_table(to, bench, place);
    bench_print_passes(to, bench, place);
    print_strip(to, bench, place);
    fputs("</section>\n", to);
}

/* --- all places at a glance ---------------------------------------------------------------- */

static bool is_first_of_place(const struct bench *bench, size_t index)
{
    for (size_t i = 0; i < index; i++)
        if (bench_same_place(&bench->rows[i], &bench->rows[index]))
            return false;
    return true;
}

/* Also of methods that an earlier run left in the directory. */
static bool has_rows(const struct bench *bench, const char *method)
{
    for (size_t i = 0; i < bench->row_count; i++)
        if (strcmp(bench->rows[i].method, method) == 0)
            return true;
    return false;
}

static void print_glance_row(FILE *to, const struct bench *bench, const char *method, bool error)
{
    fprintf(to, "<tr><td class=\"m%u\">%s</td>", bench_method_color(method), method);
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *place = &bench->rows[i], *row;
        if (!is_first_of_place(bench, i))
            continue;
        row = bench_results_find(bench, place->scene, place->camera, method);
        bool best = error && row && bench_is_best(bench, row, bench->metric);
        print_value(to, row ? row->values[BENCH_FRAME_MS] : NAN, best);
        if (error)
            print_value(to, row ? row->values[bench->metric] : NAN, best);
    }
    fputs("</tr>\n", to);
}

static void print_glance(FILE *to, const struct bench *bench)
{
    bool error = column_used(bench, bench->metric);
    char title[64];
    bench_column_title(bench->metric, title);
    fputs("<h3>At a glance</h3>\n<div class=\"wide\"><table><tr><th></th>", to);
    for (size_t i = 0; i < bench->row_count; i++)
        if (is_first_of_place(bench, i)) {
            fprintf(to, "<th colspan=\"%d\">", error ? 2 : 1);
            print_escaped(to, bench->rows[i].scene);
            fputs("<br>", to);
            print_escaped(to, bench->rows[i].camera);
            fputs("</th>", to);
        }
    fputs("</tr>\n<tr><th>method</th>", to);
    for (size_t i = 0; i < bench->row_count; i++)
        if (is_first_of_place(bench, i)) {
            fputs("<th>ms</th>", to);
            if (error)
                fprintf(to, "<th class=\"text\">%s</th>", title);
        }
    fputs("</tr>\n", to);
    for (const char *const *method = wd_method_names(); *method; method++)
        if (has_rows(bench, *method))
            print_glance_row(to, bench, *method, error);
    fputs("</table></div>\n", to);
    if (error)
        fprintf(to, "<p class=\"faint\">Shaded: no other method is both faster and %s in %s.</p>\n",
                bench_better(bench->metric), title);
}

static void print_effort(FILE *to, const struct bench *bench)
{
    const struct bench_effort *effort = &bench->effort;
    fprintf(to,
            "<p class=\"faint\">Effort \"%s\". Times: medians of up to %u frames of %u x %u "
            "pixels",
            effort->name, effort->frames, effort->width, effort->height);
    for (const struct bench_view *view = bench->suite->views; view->camera; view++) {
        uint32_t size_px[2];
        bench_frame_size(bench, view->camera, size_px);
        if (size_px[0] != effort->width)
            fprintf(to, " (from the camera \"%s\" %u x %u)", view->camera, size_px[0], size_px[1]);
    }
    fputs(", one sample a pixel.", to);
    if (bench->suite->measures & BENCH_ERROR)
        fprintf(to,
                " Errors: %u samples a pixel against %u traced paths a pixel, at %u x %u.",
                effort->samples, effort->truth_samples, effort->truth_width, effort->truth_height);
    if (bench->suite->measures & BENCH_POPPING)
        fprintf(to,
                " Popping: change between %u frames 0.25 m apart beyond the change of the "
                "path-traced ones (%u paths a pixel), in blocks of 4 x 4 pixels, %u x %u in all.",
                effort->steps, effort->step_samples, effort->step_width, effort->step_height);
    const struct cli_words *settings = &bench->session->options->settings;
    for (uint32_t i = 0; i < settings->count; i++) {
        fputs(i ? ", " : " Of every scene is set: ", to);
        print_escaped(to, settings->words[i]);
    }
    fputs(settings->count ? ".</p>\n" : "</p>\n", to);
}

static void print_report(FILE *to, const struct bench *bench)
{
    char *machine = bench_machine_text(bench);
    const char *name = bench->suite->name;
    fprintf(to,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
            "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
            "<title>weald bench: %s</title>\n<style>\n%s</style></head><body>\n<header><h1>weald bench: %s</h1>\n<p>%c%s.</p>\n",
            name, BENCH_STYLE, name, bench->suite->summary[0] - 'a' + 'A', bench->suite->summary + 1);
    print_effort(to, bench);
    fputs("</header>\n<pre id=\"machine\">", to);
    print_escaped(to, machine);
    fputs("</pre>\n", to);
    free(machine);
    print_glance(to, bench);
    if (bench->suite->settings[0]) {
        fputs("<h3>As trees become more</h3>\n<div class=\"plots\">\n", to);
        bench_print_growth(to, bench, BENCH_FRAME_MS);
        bench_print_growth(to, bench, BENCH_DEVICE_MB);
        fputs("</div>\n", to);
    }
    for (size_t i = 0; i < bench->row_count; i++)
        if (is_first_of_place(bench, i))
            print_place(to, bench, &bench->rows[i]);
    fputs("</body></html>\n", to);
}

bool bench_write_html(const struct bench *bench)
{
    return bench_write(bench, "report.html", print_report);
}
