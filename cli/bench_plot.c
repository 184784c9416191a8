/* Plots of the report, as SVG: time against error, one dot a method, the best at the left, low or,
 * of SSIM, high; and time or memory against trees, one line a method. Colours are the style sheet's. */
#include "bench.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 620, HEIGHT = 350, LEFT = 58, RIGHT = WIDTH - 16, TOP = 22, BOTTOM = HEIGHT - 44 };
enum { LABELS_MAX = 32, LABEL_HEIGHT = 14, LETTER_WIDTH = 7 };

/* The same for a method in every report, whatever others it is measured with. */
uint32_t bench_method_color(const char *method)
{
    const char *const *names = wd_method_names();
    uint32_t i = 0;
    while (names[i] && strcmp(names[i], method) != 0)
        i++;
    return i % 10;
}

bool bench_same_place(const struct bench_row *a, const struct bench_row *b)
{
    return !strcmp(a->scene, b->scene) && !strcmp(a->camera, b->camera);
}

static bool is_bias(uint32_t column)
{
    return column >= BENCH_BIAS && column < BENCH_NOISE_FLIP;
}

const char *bench_better(uint32_t column)
{
    return column == BENCH_SSIM ? "higher" : is_bias(column) ? "nearer to 0" : "lower";
}

/* The value as one of which less is better. */
static double badness(const struct bench_row *row, uint32_t column)
{
    double value = row->values[column];
    return column == BENCH_SSIM ? -value : is_bias(column) ? fabs(value) : value;
}

bool bench_is_best(const struct bench *bench, const struct bench_row *row, uint32_t column)
{
    const double ms = row->values[BENCH_FRAME_MS], error = badness(row, column);
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *other = &bench->rows[i];
        const double other_ms = other->values[BENCH_FRAME_MS], other_error = badness(other, column);
        if (bench_same_place(other, row) && other_ms <= ms && other_error <= error &&
            (other_ms < ms || other_error < error))
            return false;
    }
    return isfinite(ms) && isfinite(error);
}

/* --- scales -------------------------------------------------------------------------------- */

struct scale {
    double low, high, from, to; /* values, and where they stand; a logarithmic scale holds log10s */
    bool logarithmic;
};

static double place_on(const struct scale *scale, double value)
{
    if (scale->logarithmic)
        value = log10(fmax(value, 1e-3));
    return scale->from +
           (value - scale->low) / (scale->high - scale->low) * (scale->to - scale->from);
}

/* Of the rows at `place`, or of all rows of that scene's name where the plot is about growth. */
struct plot {
    const struct bench *bench;
    const struct bench_row *place; /* NULL: growth */
    uint32_t x_column, y_column;
    struct scale x, y;
};

/* Growth is of the suite's first scene, whose label has the setting behind a blank. */
static bool is_of_plot(const struct plot *plot, const struct bench_row *row)
{
    if (!isfinite(row->values[plot->x_column]) || !isfinite(row->values[plot->y_column]))
        return false;
    if (plot->place)
        return bench_same_place(row, plot->place);
    const char *scene = plot->bench->suite->scenes[0];
    size_t length = strlen(scene);
    return strncmp(row->scene, scene, length) == 0 && row->scene[length] == ' ';
}

static struct scale scale_of(const struct plot *plot, uint32_t column, bool logarithmic)
{
    struct scale scale = {.low = INFINITY, .high = -INFINITY, .logarithmic = logarithmic};
    for (size_t i = 0; i < plot->bench->row_count; i++) {
        double value = plot->bench->rows[i].values[column];
        if (!is_of_plot(plot, &plot->bench->rows[i]))
            continue;
        value = logarithmic ? log10(fmax(value, 1e-3)) : value;
        scale.low = fmin(scale.low, value);
        scale.high = fmax(scale.high, value);
    }
    double room =
        logarithmic ? 0.15 : 0.12 * (scale.high - scale.low) + 0.01 * fabs(scale.high) + 1e-9;
    bool positive = scale.low >= 0;
    scale.low -= room;
    scale.high += room;
    if (!logarithmic && positive)
        scale.low = fmax(scale.low, 0);
    return scale;
}

/* Steps of 1, 2 or 5 times a power of ten, some five of them. */
static double step_of(double range)
{
    double rough = range / 5, power = pow(10, floor(log10(rough)));
    return rough / power < 1.5   ? power
           : rough / power < 3.5 ? 2 * power
           : rough / power < 7.5 ? 5 * power
                                 : 10 * power;
}

static void print_line(FILE *to, const struct plot *plot, const struct scale *scale, double value)
{
    double at = place_on(scale, value), size = fabs(value);
    const char *unit = size >= 1e9 ? " G" : size >= 1e6 ? " M" : size >= 1e4 ? " k" : "";
    double number = value / (size >= 1e9 ? 1e9 : size >= 1e6 ? 1e6 : size >= 1e4 ? 1e3 : 1);
    if (scale == &plot->x)
        fprintf(to,
                "<path class=\"grid\" d=\"M%.1f %d V%d\"/><text x=\"%.1f\" y=\"%d\" "
                "text-anchor=\"middle\">%.4g%s</text>\n",
                at, TOP, BOTTOM, at, BOTTOM + 17, number, unit);
    else
        fprintf(to,
                "<path class=\"grid\" d=\"M%d %.1f H%d\"/><text x=\"%d\" y=\"%.1f\" "
                "text-anchor=\"end\">%.4g%s</text>\n",
                LEFT, at, RIGHT, LEFT - 7, at + 4, number, unit);
}

/* Lines at 1, 2 and 5 times powers of ten; where they would crowd, at the powers alone. */
static void print_axis(FILE *to, const struct plot *plot, const struct scale *scale)
{
    static const int lines[] = {1, 2, 5};
    double range = scale->high - scale->low, step = step_of(range);
    for (int power = -3; scale->logarithmic && power <= 12; power++)
        for (size_t i = 0; i < (range > 2.5 ? 1 : 3); i++) {
            double value = lines[i] * pow(10, power);
            if (log10(value) > scale->low && log10(value) < scale->high)
                print_line(to, plot, scale, value);
        }
    for (double value = ceil(scale->low / step) * step;
         !scale->logarithmic && value <= scale->high; value += step)
        print_line(to, plot, scale, fabs(value) < step * 1e-6 ? 0 : value);
}

/* --- labels -------------------------------------------------------------------------------- */

struct label {
    double x, y, width; /* left end of its middle line */
};

struct labels {
    struct label items[LABELS_MAX];
    size_t count;
};

static bool is_free(const struct labels *labels, const struct label *label)
{
    for (size_t i = 0; i < labels->count; i++) {
        const struct label *other = &labels->items[i];
        if (fabs(other->y - label->y) < LABEL_HEIGHT && label->x < other->x + other->width &&
            other->x < label->x + label->width)
            return false;
    }
    return label->x >= LEFT && label->x + label->width <= WIDTH && label->y > TOP - 4 &&
           label->y < BOTTOM - 4;
}

/* Beside the dot, or as near above or below it as there is room. */
static struct label find_room(const struct labels *labels, double x, double y, size_t letters)
{
    struct label best = {x + 11, y, (double)letters * LETTER_WIDTH};
    for (int i = 0; i < 32; i++) {
        struct label label = best;
        label.y = y + (i / 2 % 2 ? 1 : -1) * ((i / 2 + 1) / 2) * LABEL_HEIGHT * 0.8;
        label.x = i % 2 ? x - 11 - label.width : x + 11;
        if (is_free(labels, &label))
            return label;
    }
    return best;
}

static void add_label(struct labels *labels, struct label label)
{
    if (labels->count < LABELS_MAX)
        labels->items[labels->count++] = label;
}

static void print_label(FILE *to, const struct bench_row *row, double x,
                        double y, struct labels *labels)
{
    struct label label = find_room(labels, x, y, strlen(row->method));
    double end = label.x > x ? label.x - 1 : label.x + label.width + 1;
    uint32_t color = bench_method_color(row->method);
    fprintf(to,
            "<g class=\"m%u\"><path class=\"lead\" d=\"M%.1f %.1f L%.1f %.1f\"/>"
            "<text x=\"%.1f\" y=\"%.1f\">%s</text></g>\n",
            color, x, y, end, label.y, label.x, label.y + 4, row->method);
    add_label(labels, label);
}

/* --- what is plotted ----------------------------------------------------------------------- */

static void print_frame(FILE *to, const struct plot *plot, const char *across)
{
    char title[64];
    bench_column_title(plot->y_column, title);
    fprintf(to, "<svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"%s\">\n", WIDTH,
            HEIGHT, title);
    print_axis(to, plot, &plot->x);
    print_axis(to, plot, &plot->y);
    fprintf(to, "<path class=\"axis\" d=\"M%d %dV%dH%d\"/>\n", LEFT, TOP, BOTTOM, RIGHT);
    fprintf(to, "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">%s</text>", RIGHT, HEIGHT - 8, across);
    fprintf(to, "<text class=\"title\" x=\"%d\" y=\"%d\">%s</text>\n", 4, 12, title);
}

static const struct bench_row *next_faster(const struct plot *plot, double above_ms)
{
    const struct bench_row *next = NULL;
    for (size_t i = 0; i < plot->bench->row_count; i++) {
        const struct bench_row *row = &plot->bench->rows[i];
        double ms = row->values[BENCH_FRAME_MS];
        if (is_of_plot(plot, row) && ms > above_ms &&
            bench_is_best(plot->bench, row, plot->y_column) &&
            (!next || ms < next->values[BENCH_FRAME_MS]))
            next = row;
    }
    return next;
}

static void print_best(FILE *to, const struct plot *plot)
{
    const struct bench_row *row = next_faster(plot, -1);
    char command = 'M';
    fprintf(to, "<path class=\"best\" d=\"");
    for (; row; row = next_faster(plot, row->values[BENCH_FRAME_MS])) {
        fprintf(to, "%c%.1f %.1f", command, place_on(&plot->x, row->values[plot->x_column]),
                place_on(&plot->y, row->values[plot->y_column]));
        command = 'L';
    }
    fprintf(to, "\"/>\n");
}

static void print_noise(FILE *to, const struct plot *plot)
{
    uint32_t column = plot->y_column == BENCH_FLIP     ? BENCH_NOISE_FLIP
                      : plot->y_column == BENCH_BLOCKS ? BENCH_NOISE_BLOCKS
                                                     : BENCH_COLUMNS;
    double noise = column < BENCH_COLUMNS ? plot->place->values[column] : NAN;
    if (!(noise > plot->y.low && noise < plot->y.high))
        return;
    double at = place_on(&plot->y, noise);
    fprintf(to,
            "<path class=\"noise\" d=\"M%d %.1fH%d\"/><text class=\"faint\" x=\"%d\" y=\"%.1f\" "
            "text-anchor=\"end\">the reference's own noise</text>\n",
            LEFT, at, RIGHT, RIGHT - 4, at - 5);
}

/* Dots first, as labels keep off them. */
static void print_dots(FILE *to, const struct plot *plot)
{
    struct labels labels = {.count = 0};
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < plot->bench->row_count; i++) {
            const struct bench_row *row = &plot->bench->rows[i];
            if (!is_of_plot(plot, row))
                continue;
            double x = place_on(&plot->x, row->values[plot->x_column]);
            double y = place_on(&plot->y, row->values[plot->y_column]);
            if (pass == 1) {
                print_label(to, row, x, y, &labels);
                continue;
            }
            add_label(&labels, (struct label){x - 6, y, 12});
            fprintf(to,
                    "<circle class=\"method m%u\" cx=\"%.1f\" cy=\"%.1f\" r=\"5.5\"><title>%s: "
                    "%.4g, %.4g</title></circle>\n",
                    bench_method_color(row->method), x, y, row->method,
                    row->values[plot->x_column], row->values[plot->y_column]);
        }
}

void bench_print_plot(FILE *to, const struct bench *bench, const struct bench_row *place,
                      uint32_t column)
{
    struct plot plot = {bench, place, BENCH_FRAME_MS, column, {0}, {0}};
    plot.x = scale_of(&plot, BENCH_FRAME_MS, true);
    plot.y = scale_of(&plot, column, false);
    if (!(plot.x.high > plot.x.low) || !(plot.y.high > plot.y.low))
        return;
    plot.x.from = LEFT, plot.x.to = RIGHT;
    plot.y.from = BOTTOM, plot.y.to = TOP;
    print_frame(to, &plot, "median frame, ms");
    print_noise(to, &plot);
    print_best(to, &plot);
    print_dots(to, &plot);
    fprintf(to, "</svg>\n");
}

/* A method's line through its rows, which stand in the order of growing scenes, and its name at the end. */
static void print_growth_line(FILE *to, const struct plot *plot, const char *method,
                              struct labels *labels)
{
    const struct bench_row *last = NULL;
    uint32_t color = bench_method_color(method);
    fprintf(to, "<path class=\"growth m%u\" d=\"", color);
    for (size_t i = 0; i < plot->bench->row_count; i++) {
        const struct bench_row *row = &plot->bench->rows[i];
        if (strcmp(row->method, method) != 0 || !is_of_plot(plot, row))
            continue;
        fprintf(to, "%c%.1f %.1f", last ? 'L' : 'M', place_on(&plot->x, row->values[plot->x_column]),
                place_on(&plot->y, row->values[plot->y_column]));
        last = row;
    }
    fprintf(to, "\"/>\n");
    for (size_t i = 0; i < plot->bench->row_count; i++) {
        const struct bench_row *row = &plot->bench->rows[i];
        if (!strcmp(row->method, method) && is_of_plot(plot, row))
            fprintf(to, "<circle class=\"method m%u\" cx=\"%.1f\" cy=\"%.1f\" r=\"4\"/>", color,
                    place_on(&plot->x, row->values[plot->x_column]),
                    place_on(&plot->y, row->values[plot->y_column]));
    }
    if (last)
        print_label(to, last, place_on(&plot->x, last->values[plot->x_column]),
                    place_on(&plot->y, last->values[plot->y_column]), labels);
}

void bench_print_growth(FILE *to, const struct bench *bench, uint32_t column)
{
    struct plot plot = {bench, NULL, BENCH_TREES, column, {0}, {0}};
    struct labels labels = {.count = 0};
    plot.x = scale_of(&plot, BENCH_TREES, true);
    plot.y = scale_of(&plot, column, true);
    if (!(plot.x.high > plot.x.low) || !(plot.y.high > plot.y.low))
        return;
    plot.x.high += 0.12 * (plot.x.high - plot.x.low); /* for the names */
    plot.x.from = LEFT, plot.x.to = RIGHT;
    plot.y.from = BOTTOM, plot.y.to = TOP;
    print_frame(to, &plot, "trees");
    for (const char *const *method = wd_method_names(); *method; method++)
        print_growth_line(to, &plot, *method, &labels);
    fprintf(to, "</svg>\n");
}
