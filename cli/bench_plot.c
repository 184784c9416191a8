/* Plots of the report, as SVG: time across, error up, one dot a method; the best is at the lower
 * left. */
#include "bench.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 640, HEIGHT = 340, LEFT = 60, RIGHT = WIDTH - 20, TOP = 16, BOTTOM = HEIGHT - 44 };
enum { LABELS_MAX = 32, LABEL_HEIGHT = 13, LETTER_WIDTH = 7 };

const char *bench_method_color(const struct bench *bench, const char *method)
{
    static const char *const colors[] = {"#1b6ca8", "#c8553d", "#4b8f29", "#8e44ad", "#b8860b",
                                         "#0f8b8d", "#d81b60", "#5d6d7e", "#7f5539", "#111111"};
    for (size_t i = 0; bench->methods[i]; i++)
        if (strcmp(bench->methods[i], method) == 0)
            return colors[i % (sizeof colors / sizeof *colors)];
    return "#999999";
}

bool bench_same_place(const struct bench_row *a, const struct bench_row *b)
{
    return !strcmp(a->scene, b->scene) && !strcmp(a->camera, b->camera);
}

/* --- scales
 * --------------------------------------------------------------------------------------- */

struct scale {
    double low, high, from, to; /* values, and where they stand; a logarithmic scale holds log10s */
};

static double place_on(const struct scale *scale, double value)
{
    return scale->from +
           (value - scale->low) / (scale->high - scale->low) * (scale->to - scale->from);
}

static struct scale scale_of(const struct bench *bench, const struct bench_row *place,
                             uint32_t column, bool logarithmic)
{
    struct scale scale = {.low = INFINITY, .high = -INFINITY};
    for (size_t i = 0; i < bench->row_count; i++) {
        double value = bench->rows[i].values[column];
        if (!bench_same_place(&bench->rows[i], place) || !isfinite(value))
            continue;
        value = logarithmic ? log10(fmax(value, 1e-3)) : value;
        scale.low = fmin(scale.low, value);
        scale.high = fmax(scale.high, value);
    }
    double room =
        logarithmic ? 0.12 : 0.1 * (scale.high - scale.low) + 0.02 * fabs(scale.high) + 1e-9;
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

static void print_times(FILE *to, const struct scale *x)
{
    static const int lines[] = {1, 2, 5};
    for (int power = -1; power <= 6; power++)
        for (size_t i = 0; i < 3; i++) {
            double value = lines[i] * pow(10, power), at = place_on(x, log10(value));
            if (at < LEFT || at > RIGHT)
                continue;
            fprintf(to, "<path d=\"M%.1f %d V%d\" stroke=\"#e4e4e4\"/>", at, TOP, BOTTOM);
            fprintf(to, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g</text>\n", at,
                    BOTTOM + 16, value);
        }
}

static void print_errors(FILE *to, const struct scale *y)
{
    double step = step_of(y->high - y->low);
    for (double value = ceil(y->low / step) * step; value <= y->high; value += step) {
        double at = place_on(y, value);
        fprintf(to, "<path d=\"M%d %.1f H%d\" stroke=\"#e4e4e4\"/>", LEFT, at, RIGHT);
        fprintf(to, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.4g</text>\n", LEFT - 6, at + 4,
                fabs(value) < step * 1e-6 ? 0 : value);
    }
}

/* --- labels
 * --------------------------------------------------------------------------------------- */

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
           label->y < BOTTOM;
}

/* Beside the dot, or as near above or below it as there is room. */
static struct label find_room(const struct labels *labels, double x, double y, size_t letters)
{
    struct label best = {x + 10, y, (double)letters * LETTER_WIDTH};
    for (int i = 0; i < 24; i++) {
        struct label label = best;
        label.y = y + (i / 2 % 2 ? 1 : -1) * ((i / 2 + 1) / 2) * LABEL_HEIGHT * 0.8;
        label.x = i % 2 ? x - 10 - label.width : x + 10;
        if (is_free(labels, &label))
            return label;
    }
    return best;
}

static void print_dot(FILE *to, const char *name, const char *color, double x, double y,
                      struct labels *labels)
{
    struct label label = find_room(labels, x, y, strlen(name));
    double end = label.x > x ? label.x - 1 : label.x + label.width + 1;
    fprintf(to, "<path d=\"M%.1f %.1f L%.1f %.1f\" stroke=\"%s\" stroke-opacity=\".5\"/>", x, y,
            end, label.y, color);
    fprintf(to, "<circle class=\"method\" cx=\"%.1f\" cy=\"%.1f\" r=\"6\" fill=\"%s\"/>", x, y,
            color);
    fprintf(to, "<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%s</text>\n", label.x, label.y + 4, color,
            name);
    if (labels->count < LABELS_MAX)
        labels->items[labels->count++] = label;
}

/* Other labels keep off the dots. */
static void keep_off(struct labels *labels, double x, double y)
{
    if (labels->count < LABELS_MAX)
        labels->items[labels->count++] = (struct label){x - 6, y, 12};
}

void bench_print_plot(FILE *to, const struct bench *bench, const struct bench_row *place)
{
    uint32_t column = isfinite(place->values[bench->metric]) ? bench->metric : BENCH_DEVICE_MB;
    struct scale x = scale_of(bench, place, BENCH_FRAME_MS, true);
    struct scale y = scale_of(bench, place, column, false);
    struct labels labels = {.count = 0};
    if (!(x.high > x.low) || !(y.high > y.low))
        return;
    x.from = LEFT, x.to = RIGHT;
    y.from = BOTTOM, y.to = TOP;
    fprintf(to, "<svg class=\"plot\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\">\n", WIDTH,
            HEIGHT, WIDTH, HEIGHT);
    print_times(to, &x);
    print_errors(to, &y);
    fprintf(to, "<path d=\"M%d %dV%dH%d\" fill=\"none\" stroke=\"#555\"/>\n", LEFT, TOP, BOTTOM,
            RIGHT);
    fprintf(to, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">median frame, ms</text>", WIDTH / 2,
            HEIGHT - 8);
    fprintf(to, "<text x=\"%d\" y=\"%d\">%s</text>\n", LEFT + 6, TOP + 4,
            bench_column_name(column));
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < bench->row_count; i++) {
            const struct bench_row *row = &bench->rows[i];
            double cx = place_on(&x, log10(fmax(row->values[BENCH_FRAME_MS], 1e-3)));
            double cy = place_on(&y, row->values[column]);
            if (!bench_same_place(row, place) || !isfinite(row->values[column]))
                continue;
            if (pass == 0)
                keep_off(&labels, cx, cy);
            else
                print_dot(to, row->method, bench_method_color(bench, row->method), cx, cy, &labels);
        }
    fprintf(to, "</svg>\n");
}
