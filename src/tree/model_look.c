#include "tree/model_look.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/memory.h"

#define MARGIN 0.03f /* of a cell, on each side */

void wd_look_sheet_finish(struct wd_look_sheet *sheet)
{
    free(sheet->cells);
    *sheet = (struct wd_look_sheet){0};
}

static struct wd_look_cell *find(const struct wd_look_sheet *sheet, int picture)
{
    for (size_t i = 0; i < sheet->count; i++)
        if (sheet->cells[i].picture == picture)
            return &sheet->cells[i];
    return NULL;
}

void wd_look_sheet_add(struct wd_look_sheet *sheet, int picture, const float uv[3][2],
                       float shift[2])
{
    struct wd_look_cell *cell = find(sheet, picture);
    if (!cell) {
        cell = wd_push(sheet->cells, sheet->count, sheet->capacity);
        *cell = (struct wd_look_cell){.picture = picture, .low = {1e30f, 1e30f},
                                      .high = {-1e30f, -1e30f}};
    }
    for (int k = 0; k < 2; k++) {
        float middle = (uv[0][k] + uv[1][k] + uv[2][k]) * (1.0f / 3);
        shift[k] = floorf(middle);
        for (int i = 0; i < 3; i++) {
            cell->low[k] = fminf(cell->low[k], uv[i][k] - shift[k]);
            cell->high[k] = fmaxf(cell->high[k], uv[i][k] - shift[k]);
        }
    }
}

void wd_look_sheet_lay_out(struct wd_look_sheet *sheet)
{
    sheet->columns = sheet->rows = 1;
    while ((size_t)sheet->columns * sheet->rows < sheet->count) {
        if (sheet->columns <= sheet->rows)
            sheet->columns++;
        else
            sheet->rows++;
    }
    for (size_t i = 0; i < sheet->count; i++) {
        struct wd_look_cell *cell = &sheet->cells[i];
        cell->column = (uint32_t)i % sheet->columns;
        cell->row = (uint32_t)i / sheet->columns;
        for (int k = 0; k < 2; k++)
            if (!(cell->high[k] - cell->low[k] > 1e-4f))
                cell->high[k] = cell->low[k] + 1e-4f;
    }
    if (sheet->count == 1 && sheet->cells[0].picture >= 0) {
        const struct wd_look_cell *cell = &sheet->cells[0];
        sheet->tiled = cell->low[0] < -0.02f || cell->low[1] < -0.02f || cell->high[0] > 1.02f ||
                       cell->high[1] > 1.02f;
    }
}

void wd_look_sheet_map(const struct wd_look_sheet *sheet, int picture, const float uv[2],
                       float mapped[2])
{
    const struct wd_look_cell *cell = find(sheet, picture);
    const float place[2] = {(float)cell->column, (float)cell->row};
    const float cells[2] = {(float)sheet->columns, (float)sheet->rows};
    for (int k = 0; k < 2; k++) {
        float share = (uv[k] - cell->low[k]) / (cell->high[k] - cell->low[k]);
        if (picture < 0)
            share = 0.5f;
        mapped[k] = sheet->tiled ? uv[k]
                                 : (place[k] + MARGIN + share * (1 - 2 * MARGIN)) / cells[k];
    }
}

/* Linear colour and alpha of a picture, averaged over about one texel of the square. */
static void sample(const struct wd_model_image *image, float u, float v, float du, float dv,
                   float out[4])
{
    enum { MOST = 8 };
    int nu = (int)ceilf(du * (float)image->width), nv = (int)ceilf(dv * (float)image->height);
    nu = nu < 1 ? 1 : nu > MOST ? MOST : nu;
    nv = nv < 1 ? 1 : nv > MOST ? MOST : nv;
    float sum[4] = {0}, weight = 0;
    for (int j = 0; j < nv; j++) {
        for (int i = 0; i < nu; i++) {
            float at_u = u + du * (((float)i + 0.5f) / (float)nu - 0.5f);
            float at_v = v + dv * (((float)j + 0.5f) / (float)nv - 0.5f);
            at_u -= floorf(at_u);
            at_v -= floorf(at_v);
            uint32_t x = (uint32_t)(at_u * (float)image->width) % image->width;
            uint32_t y = (uint32_t)(at_v * (float)image->height) % image->height;
            const uint8_t *texel = image->rgba + 4 * ((size_t)y * image->width + x);
            float alpha = texel[3] * (1.0f / 255), share = alpha + 1e-3f;
            for (int k = 0; k < 3; k++)
                sum[k] += share * wd_srgb_decode(texel[k]);
            sum[3] += alpha;
            weight += share;
        }
    }
    for (int k = 0; k < 3; k++)
        out[k] = sum[k] / weight;
    out[3] = sum[3] / (float)(nu * nv);
}

void wd_look_sheet_draw(const struct wd_look_sheet *sheet, const struct wd_model_picture *pictures,
                        uint32_t size, uint8_t *rgba)
{
    memset(rgba, 255, (size_t)size * size * 4);
    for (uint32_t y = 0; y < size; y++) {
        for (uint32_t x = 0; x < size; x++) {
            float at[2] = {((float)x + 0.5f) / (float)size * (float)sheet->columns,
                           ((float)y + 0.5f) / (float)size * (float)sheet->rows};
            size_t index = (size_t)at[1] * sheet->columns + (size_t)at[0];
            if (index >= sheet->count || sheet->cells[index].picture < 0)
                continue;
            const struct wd_look_cell *cell = &sheet->cells[index];
            float uv[2], step[2], color[4];
            const uint32_t cells[2] = {sheet->columns, sheet->rows};
            for (int k = 0; k < 2; k++) {
                float share = (at[k] - floorf(at[k]) - MARGIN) / (1 - 2 * MARGIN);
                float range = cell->high[k] - cell->low[k];
                uv[k] = sheet->tiled ? at[k] : cell->low[k] + share * range;
                step[k] = (sheet->tiled ? 1 : range / (1 - 2 * MARGIN)) * (float)cells[k] /
                          (float)size;
            }
            sample(&pictures[cell->picture].image, uv[0], uv[1], step[0], step[1], color);
            uint8_t *texel = rgba + 4 * ((size_t)y * size + x);
            for (int k = 0; k < 3; k++)
                texel[k] = wd_srgb_encode(color[k]);
            texel[3] = wd_unorm_encode(color[3]);
        }
    }
}
