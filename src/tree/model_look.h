/* model_look.h: the textures of a model's wood, or of its leaves, as one square look. */
#ifndef WD_TREE_MODEL_LOOK_H
#define WD_TREE_MODEL_LOOK_H

#include "tree/model_material.h"

/* One picture's part of the square. Its texture coordinates [low, high] fill the part but for a
 * margin, which repeats what lies beyond: mips of neighbours do not bleed in. */
struct wd_look_cell {
    int picture;        /* -1: white, for colours alone */
    float low[2], high[2];
    uint32_t column, row;
};

struct wd_look_sheet {
    struct wd_look_cell *cells;
    size_t count, capacity;
    uint32_t columns, rows;
    bool tiled;         /* one picture that repeats: coordinates stay as they are */
};
void wd_look_sheet_finish(struct wd_look_sheet *sheet);

/* Takes note that a triangle with this picture has these coordinates; call for all before laying
 * out. Whole turns are dropped: `shift` is to be subtracted from its coordinates. */
void wd_look_sheet_add(struct wd_look_sheet *sheet, int picture, const float uv[3][2],
                       float shift[2]);
void wd_look_sheet_lay_out(struct wd_look_sheet *sheet);

/* Where (u, v) of a picture, shifted, is in the square. */
void wd_look_sheet_map(const struct wd_look_sheet *sheet, int picture, const float uv[2],
                       float mapped[2]);

/* Draws the square: `size` x `size` texels RGBA8, sRGB. */
void wd_look_sheet_draw(const struct wd_look_sheet *sheet, const struct wd_model_picture *pictures,
                        uint32_t size, uint8_t *rgba);

#endif
