/* results.csv is both what a run leaves and what an interrupted one goes on from. Its first line
 * names the suite, the effort and the sizes, each row the forest; results of others are not mixed in. */
#include "bench.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *bench_column_name(uint32_t column)
{
    static const char *const names[] = {
        "trees", "start_s", "frame_ms", "frame_p95_ms", "frame_p99_ms", "frames", "gpu_ms",
        "cpu_ms", "draw_calls", "triangles", "device_mb", "host_peak_mb"};
    static const char *const noise[] = {"noise_flip", "noise_block_rmse_pct"};
    static const char *const popping[] = {
        "popping_mean_pct", "popping_p999_pct", "popping_step_pct", "step_full_reduced_pct",
        "step_reduced_billboard_pct", "step_full_billboard_pct", "step_billboard_canopy_pct"};
    if (column < BENCH_COMPARISON)
        return names[column];
    if (column < BENCH_NOISE_FLIP)
        return wd_comparison_names()[column - BENCH_COMPARISON];
    if (column < BENCH_POPPING_MEAN)
        return noise[column - BENCH_NOISE_FLIP];
    return popping[column - BENCH_POPPING_MEAN];
}

static void print_heads(const struct bench *bench, FILE *to)
{
    const struct bench_effort *e = &bench->effort;
    fprintf(to, "# weald bench %s %s %ux%u %u/%u samples %ux%u %u steps", bench->suite->name,
            e->name, e->width, e->height, e->samples, e->truth_samples, e->truth_width,
            e->truth_height, e->steps);
    for (uint32_t i = 0; i < bench->session->options->settings.count; i++)
        fprintf(to, " %s", bench->session->options->settings.words[i]);
    fprintf(to, "\n");
    fprintf(to, "scene,camera,method,forest");
    for (uint32_t i = 0; i < BENCH_COLUMNS; i++)
        fprintf(to, ",%s", bench_column_name(i));
    fprintf(to, ",passes\n");
}

const struct bench_row *bench_results_find(const struct bench *bench, const char *scene,
                                           const char *camera, const char *method)
{
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        if (!strcmp(row->scene, scene) && !strcmp(row->camera, camera) &&
            !strcmp(row->method, method))
            return row;
    }
    return NULL;
}

bool bench_results_fit(const struct bench_stage *stage)
{
    char key[sizeof stage->bench->rows->forest];
    snprintf(key, sizeof key, "%016llx", (unsigned long long)stage->forest_key);
    for (size_t i = 0; i < stage->bench->row_count; i++) {
        const struct bench_row *row = &stage->bench->rows[i];
        if (!strcmp(row->scene, stage->scene) && strcmp(row->forest, key) != 0)
            return cli_fail(stage->bench->session,
                            "%s/results.csv: holds results of %s by other settings, files or code; name "
                            "another directory or remove it",
                            stage->bench->directory, stage->scene);
    }
    return true;
}

static void keep(struct bench *bench, const struct bench_row *row)
{
    if (bench->row_count == bench->row_capacity) {
        bench->row_capacity = bench->row_capacity ? 2 * bench->row_capacity : 64;
        bench->rows = realloc(bench->rows, bench->row_capacity * sizeof *bench->rows);
        if (!bench->rows)
            abort();
    }
    bench->rows[bench->row_count++] = *row;
}

/* The next of a line's fields, which ends at a comma. */
static bool take(char **line, char *field, size_t size)
{
    char *comma = strchr(*line, ',');
    if (!comma || (size_t)(comma - *line) >= size)
        return false;
    memcpy(field, *line, (size_t)(comma - *line));
    field[comma - *line] = 0;
    *line = comma + 1;
    return true;
}

static bool parse_number(const char *text, double *value)
{
    char *end = NULL;
    *value = *text ? strtod(text, &end) : NAN;
    return !*text || (end != text && !*end && isfinite(*value));
}

static bool parse_row(char *line, struct bench_row *row)
{
    char number[64];
    if (!take(&line, row->scene, sizeof row->scene) ||
        !take(&line, row->camera, sizeof row->camera) ||
        !take(&line, row->method, sizeof row->method) ||
        !take(&line, row->forest, sizeof row->forest))
        return false;
    for (uint32_t i = 0; i < BENCH_COLUMNS; i++) {
        if (!take(&line, number, sizeof number) || !parse_number(number, &row->values[i]))
            return false;
    }
    line[strcspn(line, "\r\n")] = 0;
    snprintf(row->passes, sizeof row->passes, "%s", line);
    return true;
}

static void print_row(const struct bench_row *row, FILE *to)
{
    fprintf(to, "%s,%s,%s,%s", row->scene, row->camera, row->method, row->forest);
    for (uint32_t i = 0; i < BENCH_COLUMNS; i++) {
        if (isnan(row->values[i]))
            fprintf(to, ",");
        else
            fprintf(to, ",%.6g", row->values[i]);
    }
    fprintf(to, ",%s\n", row->passes);
}

static void print_all(FILE *to, const struct bench *bench)
{
    print_heads(bench, to);
    for (size_t i = 0; i < bench->row_count; i++)
        print_row(&bench->rows[i], to);
}

bool bench_write(const struct bench *bench, const char *name,
                 void (*print)(FILE *to, const struct bench *bench))
{
    char *path = bench_path(bench, "%s", name), *temporary = bench_path(bench, ".%s.tmp", name);
    FILE *file = fopen(temporary, "w");
    bool ok = file != NULL;
    if (ok) {
        print(file, bench);
        ok = !ferror(file);
        ok = fclose(file) == 0 && ok && rename(temporary, path) == 0;
    }
    if (!ok) {
        cli_fail(bench->session, "%s cannot be written: %s", path, strerror(errno));
        unlink(temporary);
    }
    free(path);
    free(temporary);
    return ok;
}

/* The first two lines of a file: what was measured, and the names of the columns. */
struct heads {
    bool same_measure, same_columns; /* as a run now would write */
    char measure[512];
};

static struct heads read_heads(const struct bench *bench, FILE *file)
{
    struct heads found = {0};
    char columns[4096], *heads = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&heads, &size);
    if (!memory)
        abort();
    print_heads(bench, memory);
    fclose(memory);
    size_t first = strcspn(heads, "\n");
    if (fgets(found.measure, sizeof found.measure, file) && fgets(columns, sizeof columns, file)) {
        found.measure[strcspn(found.measure, "\n")] = 0;
        found.same_measure = strlen(found.measure) == first && strncmp(found.measure, heads, first) == 0;
        found.same_columns = strcmp(columns, heads + first + 1) == 0;
    }
    free(heads);
    return found;
}

/* A last line without an end was cut off while it was written. */
static bool read_rows(struct bench *bench, FILE *file, const char *path)
{
    char line[4096];
    for (uint32_t number = 3; fgets(line, sizeof line, file); number++) {
        struct bench_row row = {0};
        bool whole = strchr(line, '\n') != NULL;
        if (!whole && feof(file))
            return true;
        if (!whole || !parse_row(line, &row))
            return cli_fail(bench->session, "%s:%u: is no row of results: wanted are four names, then %d numbers, each may "
                            "be empty, then passes; remove the line", path, number, (int)BENCH_COLUMNS);
        keep(bench, &row);
    }
    return true;
}

static bool take_rows(struct bench *bench, FILE *file, const char *path)
{
    const struct heads heads = read_heads(bench, file);
    if (!heads.same_measure || !heads.same_columns)
        return cli_fail(bench->session,
                        "%s: holds results of another suite, effort, size, --set or version of weald; name "
                        "another directory or remove it",
                        path);
    return read_rows(bench, file, path);
}

bool bench_results_load_earlier(struct bench *earlier, const struct bench *bench)
{
    *earlier = (struct bench){.session = bench->session, .directory = bench->session->options->against};
    char *path = bench_path(earlier, "results.csv");
    FILE *file = fopen(path, "r");
    bool ok = file != NULL;
    if (!ok)
        cli_fail(bench->session, "%s: cannot be read: %s; --against names the directory of an earlier run", path,
                 strerror(errno));
    const struct heads heads = ok ? read_heads(bench, file) : (struct heads){0};
    if (ok && !heads.same_columns)
        ok = cli_fail(bench->session, "%s: is not of this version of weald: its columns are others", path);
    ok = ok && read_rows(earlier, file, path);
    if (ok && !heads.same_measure)
        cli_say(bench->session, "%s: was measured otherwise: %s\n", path, heads.measure + strspn(heads.measure, "# "));
    if (file)
        fclose(file);
    free(path);
    return ok;
}

bool bench_results_load(struct bench *bench)
{
    char *path = bench_path(bench, "results.csv");
    FILE *file = fopen(path, "r");
    bool ok = !file || take_rows(bench, file, path);
    if (file)
        fclose(file);
    bench->resumed = bench->row_count;
    ok = ok && bench_write(bench, "results.csv", print_all); /* without a line that was cut off */
    free(path);
    return ok;
}

bool bench_results_add(struct bench *bench, const struct bench_row *row)
{
    char *path = bench_path(bench, "results.csv");
    FILE *file = fopen(path, "a");
    keep(bench, row);
    bool ok = file != NULL;
    if (ok) {
        print_row(row, file);
        ok = fclose(file) == 0;
    }
    if (!ok)
        cli_fail(bench->session, "%s cannot be written: %s", path, strerror(errno));
    free(path);
    return ok;
}

/* --- JSON and the table -------------------------------------------------------------------------- */

static void print_json_text(FILE *to, const char *text)
{
    fputc('"', to);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            fputc('\\', to);
        if ((unsigned char)*text < 32)
            fprintf(to, "\\u%04x", *text);
        else
            fputc(*text, to);
    }
    fputc('"', to);
}

static void print_json_row(FILE *to, const struct bench *bench, const struct bench_row *row)
{
    uint32_t size_px[2];
    bench_frame_size(bench, row->camera, size_px);
    fprintf(to, "    {\"scene\": ");
    print_json_text(to, row->scene);
    fprintf(to, ", \"camera\": ");
    print_json_text(to, row->camera);
    fprintf(to, ", \"method\": ");
    print_json_text(to, row->method);
    fprintf(to, ", \"frame_px\": [%u, %u]", size_px[0], size_px[1]);
    for (uint32_t i = 0; i < BENCH_COLUMNS; i++)
        if (isfinite(row->values[i]))
            fprintf(to, ", \"%s\": %.6g", bench_column_name(i), row->values[i]);
    fprintf(to, ", \"passes\": ");
    print_json_text(to, row->passes);
    fputc('}', to);
}

static void print_json(FILE *to, const struct bench *bench)
{
    char *machine = bench_machine_text(bench);
    const struct bench_effort *e = &bench->effort;
    const struct cli_words *settings = &bench->session->options->settings;
    fprintf(to, "{\n  \"suite\": \"%s\", \"effort\": \"%s\", \"settings\": [", bench->suite->name, e->name);
    for (uint32_t i = 0; i < settings->count; i++) {
        fputs(i ? ", " : "", to);
        print_json_text(to, settings->words[i]);
    }
    fprintf(to, "],\n");
    if (bench->suite->measures & BENCH_ERROR)
        fprintf(to, "  \"error_px\": [%u, %u], \"error_samples\": %u, \"reference_samples\": %u,\n", e->truth_width,
                e->truth_height, e->samples, e->truth_samples);
    fprintf(to, "  \"machine\": ");
    print_json_text(to, machine);
    fprintf(to, ",\n  \"rows\": [\n");
    for (size_t i = 0; i < bench->row_count; i++) {
        print_json_row(to, bench, &bench->rows[i]);
        fprintf(to, "%s\n", i + 1 < bench->row_count ? "," : "");
    }
    fprintf(to, "  ]\n}\n");
    free(machine);
}

bool bench_write_json(const struct bench *bench)
{
    return bench_write(bench, "results.json", print_json);
}

static void print_cell(double value, const char *format, int width)
{
    char text[32] = "-";
    if (isfinite(value))
        snprintf(text, sizeof text, format, value);
    printf(" %*s", width, text);
}

/* Of the column of errors; 0: the suite measures none. */
static int error_width(const struct bench *bench)
{
    int length = (int)strlen(bench_column_name(bench->metric)), width = length > 10 ? length : 10;
    return bench->suite->measures & (BENCH_ERROR | BENCH_POPPING) ? width : 0;
}

void bench_print_table(const struct bench *bench)
{
    const char *metric = bench_column_name(bench->metric);
    const int width = error_width(bench);
    char last[160] = "";
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *row = &bench->rows[i];
        char place[160];
        snprintf(place, sizeof place, "%s, %s", row->scene, row->camera);
        if (strcmp(place, last) != 0) {
            printf("%s%s: %.0f trees, ready in %.1f s\n", i ? "\n" : "", place,
                   row->values[BENCH_TREES], row->values[BENCH_START_S]);
            printf("%-12s %10s %8s %8s %8s %8s %10s %10s", "method", "median ms", "p95 ms", "GPU ms", "CPU ms", "draws",
                   "triangles", "device MB");
            if (width)
                printf(" %*s", width, metric);
            printf("\n");
        }
        snprintf(last, sizeof last, "%s", place);
        printf("%-12s", row->method);
        print_cell(row->values[BENCH_FRAME_MS], "%.1f", 10);
        print_cell(row->values[BENCH_FRAME_P95_MS], "%.1f", 8);
        print_cell(row->values[BENCH_GPU_MS], "%.1f", 8);
        print_cell(row->values[BENCH_CPU_MS], "%.1f", 8);
        print_cell(row->values[BENCH_DRAWS], "%.0f", 8);
        print_cell(row->values[BENCH_TRIANGLES], "%.0f", 10);
        print_cell(row->values[BENCH_DEVICE_MB], "%.0f", 10);
        if (width)
            print_cell(row->values[bench->metric], "%.4f", width);
        printf("\n");
    }
}

void bench_print_against(const struct bench *bench, const struct bench *earlier)
{
    const char *metric = bench_column_name(bench->metric);
    const int width = error_width(bench);
    size_t found = 0;
    printf("\nBeside %s:\n%-24s %-12s %10s %10s %6s", earlier->directory, "scene, camera", "method", "median ms", "before",
           "ratio");
    if (width)
        printf(" %*s %10s %10s", width, metric, "before", "difference");
    printf("\n");
    for (size_t i = 0; i < bench->row_count; i++) {
        const struct bench_row *now = &bench->rows[i];
        const struct bench_row *before = bench_results_find(earlier, now->scene, now->camera, now->method);
        char place[160];
        if (!before)
            continue;
        found++;
        snprintf(place, sizeof place, "%s, %s", now->scene, now->camera);
        printf("%-24s %-12s", place, now->method);
        print_cell(now->values[BENCH_FRAME_MS], "%.1f", 10);
        print_cell(before->values[BENCH_FRAME_MS], "%.1f", 10);
        print_cell(now->values[BENCH_FRAME_MS] / before->values[BENCH_FRAME_MS], "%.2f", 6);
        if (width) {
            print_cell(now->values[bench->metric], "%.4f", width);
            print_cell(before->values[bench->metric], "%.4f", 10);
            print_cell(now->values[bench->metric] - before->values[bench->metric], "%+.4f", 10);
        }
        printf("\n");
    }
    printf("%zu of %zu rows are in both\n", found, bench->row_count);
}
