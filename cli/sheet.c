#include "sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "grow.h"
#include "sheet_error.h"

enum {
    DEFAULT_CELL_PX = 230,
    LETTER_PX = 9, /* a line, before scaling */
    LINES = 4,     /* below each cell */
    GAP_PX = 6,
    AGES = 6,
    FORMS = 4,
    COLUMNS = AGES + FORMS,
    MAX_SPECIES = 64,
    SAMPLES = 8,
};

/* One column of ages and seasons. */
static const struct column {
    const char *title;
    double size; /* share of the typical height */
    double openness, month;
} columns[AGES] = {
    {"young", 0.3, 0.6, 0},     {"forest-grown", 1, 0, 0}, {"open-grown", 1, 1, 0},
    {"spring (may)", 1, 0.5, 5}, {"autumn", 1, 0.5, 10.6},  {"winter", 1, 0.5, 1.5},
};
static const struct form {
    const char *title;
    enum wd_specimen_form form;
    const char *method; /* NULL: as asked for */
} forms[FORMS] = {{"full", WD_SPECIMEN_FULL, NULL},
                  {"reduced", WD_SPECIMEN_REDUCED, NULL},
                  {"cards", WD_SPECIMEN_CARDS, NULL},
                  {"points (continuum)", WD_SPECIMEN_AS_SEEN, "continuum"}};

struct sheet {
    struct cli_session *session;
    struct wd_renderer *renderer;
    struct wd_picture picture;
    const char *species[MAX_SPECIES];
    uint32_t species_count;
    uint32_t cell_px;    /* a side */
    uint32_t text_scale;
    uint32_t cells_done;
    char *names; /* owns the default list */
};

/* --- cells ------------------------------------------------------------------------------- */

static void paste(struct sheet *sheet, const struct wd_picture *cell, uint32_t x, uint32_t y)
{
    for (uint32_t row = 0; row < cell->height; row++)
        memcpy(sheet->picture.display + 4 * ((size_t)(y + row) * sheet->picture.width + x),
               cell->display + (size_t)4 * row * cell->width, (size_t)4 * cell->width);
}

static uint32_t cell_x(const struct sheet *sheet, uint32_t column)
{
    return GAP_PX + column * (sheet->cell_px + GAP_PX) + (column >= AGES ? 2 * GAP_PX : 0);
}

static uint32_t cell_y(const struct sheet *sheet, uint32_t row)
{
    uint32_t line_px = LETTER_PX * sheet->text_scale;
    return line_px + 2 * GAP_PX + row * (sheet->cell_px + LINES * line_px + 2 * GAP_PX);
}

static enum wd_result draw_cell(struct sheet *sheet, const struct wd_specimen *specimen,
                                const struct form *form, uint32_t row, uint32_t column,
                                struct wd_picture *cell)
{
    const struct cli_specimen_view view = {
        .width = sheet->cell_px,
        .height = sheet->cell_px,
        .samples = SAMPLES,
        .layers = WD_LAYER_DISPLAY | WD_LAYER_COLOR | WD_LAYER_TREE_ID,
        .form = form->form,
        .method = form->method ? form->method : sheet->session->options->method,
    };
    struct cli_session *session = sheet->session;
    uint32_t total = sheet->species_count * COLUMNS;
    if (!session->progress.report(session->progress.user, "cells", sheet->cells_done++, total))
        return WD_ERROR_INTERRUPTED;
    enum wd_result result =
        cli_specimens_picture(session, sheet->renderer, &specimen, 1, &view, cell);
    if (result == WD_OK)
        paste(sheet, cell, cell_x(sheet, column), cell_y(sheet, row));
    return result;
}

static void label(struct sheet *sheet, uint32_t row, uint32_t column, uint32_t line,
                  const char *text)
{
    uint32_t below = sheet->cell_px + GAP_PX + LETTER_PX * sheet->text_scale * line;
    cli_sheet_text(&sheet->picture, cell_x(sheet, column) + 3, cell_y(sheet, row) + below,
                   sheet->text_scale, text);
}

/* --- a row ------------------------------------------------------------------------------- */

/* `*ages`: whether it is grown; a model has but one age. */
static double typical_height(struct sheet *sheet, const char *source, bool *ages,
                             enum wd_result *result)
{
    struct wd_specimen *specimen;
    struct wd_specimen_info info = {0};
    const struct wd_specimen_params params = {.source = source, .log = sheet->session->log};
    *result = wd_specimen_create(&specimen, &params);
    if (*result == WD_OK) {
        wd_specimen_get_info(specimen, &info);
        *result = wd_specimens_check_output((const struct wd_specimen *const *)&specimen, 1,
                                            sheet->session->options->output);
    }
    wd_specimen_destroy(&specimen);
    *ages = info.age_years > 0;
    return info.height_m;
}

static enum wd_result draw_age(struct sheet *sheet, uint32_t row, uint32_t index, double height_m, bool ages)
{
    const struct column *column = &columns[index];
    const struct wd_specimen_params params = {
        .source = sheet->species[row],
        .height_m = height_m * column->size,
        .openness = ages ? column->openness : 0,
        .month = ages ? column->month : 0,
        .log = sheet->session->log,
    };
    struct wd_specimen *specimen;
    struct wd_specimen_info info;
    struct wd_picture cell = {0};
    char text[64];
    enum wd_result result = wd_specimen_create(&specimen, &params);
    if (result != WD_OK)
        return result;
    wd_specimen_get_info(specimen, &info);
    result = draw_cell(sheet, specimen, &forms[0], row, index, &cell);
    snprintf(text, sizeof text, "%.18s", info.name);
    if (index == 0 || info.age_years == 0)
        label(sheet, row, index, 1, text);
    int used = snprintf(text, sizeof text, "%.*f m", info.height_m < 10 ? 1 : 0, info.height_m);
    if (info.age_years > 0)
        snprintf(text + used, sizeof text - (size_t)used, ", %.0f years", info.age_years);
    label(sheet, row, index, 0, text);
    wd_picture_finish(&cell);
    wd_specimen_destroy(&specimen);
    return result;
}

/* What a form shows of the tree, drawn again with one sample: such a picture's edges hold no ground. */
static enum wd_result take_shown(struct sheet *sheet, const struct wd_specimen *specimen,
                                 const struct form *form, uint32_t zoom, struct cli_shown *shown)
{
    struct cli_session *session = sheet->session;
    const struct cli_specimen_view view = {
        .width = sheet->cell_px * zoom,
        .height = sheet->cell_px * zoom,
        .samples = 1,
        .layers = WD_LAYER_COLOR | WD_LAYER_TREE_ID,
        .form = form->form,
        .method = form->method ? form->method : session->options->method,
        .timing = WD_TIME_PASSES,
    };
    struct wd_picture picture = {0};
    enum wd_result result =
        cli_specimens_picture(session, sheet->renderer, &specimen, 1, &view, &picture);
    if (result == WD_OK && !cli_shown_take(shown, &picture, zoom)) {
        cli_fail(session, "out of memory");
        result = WD_ERROR_MEMORY;
    }
    wd_picture_finish(&picture);
    return result;
}

static void label_size(struct sheet *sheet, uint32_t row, uint32_t index,
                       const struct wd_specimen *specimen)
{
    struct wd_specimen_level level;
    struct wd_frame_stats stats;
    char text[64] = "";
    wd_renderer_get_stats(sheet->renderer, &stats);
    if (forms[index].form == WD_SPECIMEN_CARDS)
        snprintf(text, sizeof text, "8 triangles");
    else if (forms[index].method)
        snprintf(text, sizeof text, "%llu discs", (unsigned long long)stats.discs);
    else if (wd_specimen_get_level(specimen, index, &level))
        snprintf(text, sizeof text, "%u triangles", level.wood_triangles + level.leaf_triangles);
    label(sheet, row, AGES + index, 0, text);
}

static void label_error(struct sheet *sheet, uint32_t row, uint32_t index,
                        const struct cli_form_error *error)
{
    char text[64];
    snprintf(text, sizeof text, "cover %+.1f%%", error->coverage_pct);
    label(sheet, row, AGES + index, 1, text);
    snprintf(text, sizeof text, "light %+.1f%%", error->radiance_pct);
    label(sheet, row, AGES + index, 2, text);
    snprintf(text, sizeof text, "picture %.0f%%", error->picture_pct);
    label(sheet, row, AGES + index, 3, text);
}

/* Errors are against the full mesh, with `zoom` squared samples a pixel. */
static enum wd_result draw_form(struct sheet *sheet, uint32_t row, uint32_t index,
                                const struct wd_specimen *specimen, const struct cli_shown *full,
                                uint32_t zoom)
{
    struct wd_picture cell = {0};
    struct cli_shown shown = {0};
    enum wd_result result = draw_cell(sheet, specimen, &forms[index], row, AGES + index, &cell);
    wd_picture_finish(&cell);
    if (result == WD_OK)
        result = take_shown(sheet, specimen, &forms[index], 1, &shown);
    if (result == WD_OK) {
        struct cli_form_error error = cli_form_error_of(&shown, full);
        char text[64];
        label_size(sheet, row, index, specimen);
        label_error(sheet, row, index, &error);
        snprintf(text, sizeof text, "%.18s %+.1f%% %+.1f%% %.0f%%", forms[index].title,
                 error.coverage_pct, error.radiance_pct, error.picture_pct);
        cli_say(sheet->session, "%s: %s (against the full mesh, %u samples a pixel)\n",
                sheet->species[row], text, zoom * zoom);
    }
    cli_shown_finish(&shown);
    return result;
}

static enum wd_result draw_forms(struct sheet *sheet, uint32_t row, bool ages)
{
    const struct wd_specimen_params params = {
        .source = sheet->species[row], .openness = ages ? 0.5 : 0, .log = sheet->session->log};
    struct wd_specimen *specimen;
    struct cli_shown full = {0};
    uint32_t zoom = cli_shown_zoom(sheet->cell_px);
    enum wd_result result = wd_specimen_create(&specimen, &params);
    if (result == WD_OK)
        result = take_shown(sheet, specimen, &forms[0], zoom, &full);
    for (uint32_t i = 0; i < FORMS && result == WD_OK; i++)
        result = draw_form(sheet, row, i, specimen, &full, zoom);
    cli_shown_finish(&full);
    wd_specimen_destroy(&specimen);
    return result;
}

static enum wd_result draw_row(struct sheet *sheet, uint32_t row)
{
    enum wd_result result;
    bool ages;
    double height_m = typical_height(sheet, sheet->species[row], &ages, &result);
    for (uint32_t i = 0; i < AGES && result == WD_OK; i++)
        if (ages || columns[i].openness >= 1)
            result = draw_age(sheet, row, i, height_m, ages);
    return result == WD_OK ? draw_forms(sheet, row, ages) : result;
}

/* --- the sheet --------------------------------------------------------------------------- */

static bool choose_species(struct sheet *sheet)
{
    const struct cli_options *options = sheet->session->options;
    for (int i = 0; i < options->operand_count && i < MAX_SPECIES; i++)
        sheet->species[sheet->species_count++] = options->operands[i];
    if (sheet->species_count)
        return true;
    sheet->names = wd_species_names();
    for (char *name = strtok(sheet->names, "\n"); name && sheet->species_count < MAX_SPECIES;
         name = strtok(NULL, "\n"))
        sheet->species[sheet->species_count++] = name;
    return sheet->species_count > 0 ||
           cli_fail(sheet->session, "no species named, and there are none in species/");
}

static bool make_paper(struct sheet *sheet)
{
    struct wd_picture *picture = &sheet->picture;
    picture->width = cell_x(sheet, COLUMNS);
    picture->height = cell_y(sheet, sheet->species_count);
    size_t bytes = (size_t)4 * picture->width * picture->height;
    picture->display = malloc(bytes);
    if (!picture->display)
        return cli_fail(sheet->session, "out of memory");
    memset(picture->display, 240, bytes);
    for (uint32_t i = 0; i < COLUMNS; i++)
        cli_sheet_text(picture, cell_x(sheet, i) + 3, GAP_PX, sheet->text_scale,
                       i < AGES ? columns[i].title : forms[i - AGES].title);
    return true;
}

enum wd_result cli_sheet(struct cli_session *session)
{
    uint32_t size_px = session->options->size_px[0];
    struct sheet sheet = {.session = session, .cell_px = size_px ? size_px : DEFAULT_CELL_PX};
    enum { LEAST_CELL_PX = 64, MOST_CELL_PX = 1024, LARGE_CELL_PX = 200 };
    if (sheet.cell_px < LEAST_CELL_PX || sheet.cell_px > MOST_CELL_PX) {
        cli_fail(session, "cells of a sheet are %d to %d pixels wide", LEAST_CELL_PX,
                 MOST_CELL_PX);
        return WD_ERROR_INPUT;
    }
    sheet.text_scale = sheet.cell_px >= LARGE_CELL_PX ? 2 : 1;
    enum wd_result result = WD_ERROR_INPUT;
    if (choose_species(&sheet) && make_paper(&sheet))
        result = cli_renderer_open(session, &sheet.renderer);
    for (uint32_t row = 0; row < sheet.species_count && result == WD_OK; row++)
        result = draw_row(&sheet, row);
    if (result == WD_OK)
        result = wd_picture_write(&sheet.picture, session->options->output, &session->log);
    cli_renderer_close(session, &sheet.renderer);
    wd_picture_finish(&sheet.picture);
    free(sheet.names);
    return result;
}
