#include <stdlib.h>

#include "base/memory.h"
#include "tree/shown.h"

enum { PIXELS = WD_SILHOUETTE * WD_SILHOUETTE };
enum { NOTHING, LEAF, LEAF_BELOW, WOOD };

/* A picture with depth. */
struct canvas {
    const struct wd_silhouette *frame;
    float *nearest; /* along frame->toward, where there is something */
    uint8_t *kind;
    uint8_t *openness;
};

struct corner {
    float at[2], toward;
};

static float across(const struct corner *a, const struct corner *b, float x, float y)
{
    return (b->at[0] - a->at[0]) * (y - a->at[1]) - (b->at[1] - a->at[1]) * (x - a->at[0]);
}

/* Which side of a leaf is seen: as shaders/lib/look.glsl has it, in a picture that is mirrored. */
static uint8_t side_of(const struct wd_tree_vertex *const vertices[3], float area)
{
    float uv[3][2];
    for (int k = 0; k < 3; k++)
        wd_unpack_uv(vertices[k]->uv, uv[k]);
    float turn = (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) -
                 (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0]);
    return turn * area < 0 ? LEAF : LEAF_BELOW;
}

static uint8_t openness_of(const struct wd_tree_vertex *const vertices[3])
{
    return (uint8_t)(((vertices[0]->tint >> 24) + (vertices[1]->tint >> 24) +
                      (vertices[2]->tint >> 24)) /
                     3);
}

static struct corner corner_of(const struct canvas *canvas, const struct wd_tree_vertex *vertex)
{
    struct corner corner;
    wd_silhouette_project(canvas->frame, vertex->position_m, corner.at);
    corner.toward = wd_v3_dot(wd_v3_of(vertex->position_m), canvas->frame->toward);
    return corner;
}

static void draw_triangle(struct canvas *canvas, const struct wd_tree_vertex *const vertices[3],
                          bool wood)
{
    struct corner a = corner_of(canvas, vertices[0]), b = corner_of(canvas, vertices[1]);
    struct corner c = corner_of(canvas, vertices[2]);
    float area = across(&a, &b, c.at[0], c.at[1]);
    int x0 = wd_silhouette_pixel(wd_min3f(a.at[0], b.at[0], c.at[0]));
    int x1 = wd_silhouette_pixel(wd_max3f(a.at[0], b.at[0], c.at[0]));
    int y0 = wd_silhouette_pixel(wd_min3f(a.at[1], b.at[1], c.at[1]));
    int y1 = wd_silhouette_pixel(wd_max3f(a.at[1], b.at[1], c.at[1]));
    if (x0 >= x1 || y0 >= y1 || !(fabsf(area) > 1e-9f))
        return;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f;
            float of_c = across(&a, &b, px, py) / area, of_a = across(&b, &c, px, py) / area;
            float of_b = 1 - of_a - of_c;
            float toward = of_a * a.toward + of_b * b.toward + of_c * c.toward;
            int i = y * WD_SILHOUETTE + x;
            bool hidden = canvas->kind[i] != NOTHING && toward <= canvas->nearest[i];
            if (of_a < 0 || of_b < 0 || of_c < 0 || hidden)
                continue;
            canvas->nearest[i] = toward;
            canvas->kind[i] = wood ? WOOD : side_of(vertices, area);
            canvas->openness[i] = openness_of(vertices);
        }
}

static struct wd_shown count_shown(const struct canvas *canvas)
{
    uint32_t counts[WOOD + 1] = {0}, openness[2] = {0};
    for (int i = 0; i < PIXELS; i++) {
        counts[canvas->kind[i]]++;
        openness[canvas->kind[i] != WOOD] += canvas->openness[i];
    }
    return (struct wd_shown){counts[LEAF] + counts[LEAF_BELOW] + counts[WOOD], counts[WOOD],
                             counts[LEAF_BELOW], {openness[0], openness[1]}};
}

struct wd_shown wd_shown_mesh(const struct wd_silhouette *frame, const struct wd_tree_mesh *mesh)
{
    struct canvas canvas = {frame, wd_alloc_array(PIXELS, sizeof *canvas.nearest),
                            wd_alloc(PIXELS), wd_alloc(PIXELS)};
    uint32_t *triangles = wd_alloc_array(mesh->index_count / 3 + 1, sizeof *triangles);
    uint32_t count = wd_silhouette_reach(triangles, frame, mesh);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *indices = mesh->indices + 3 * (size_t)triangles[i];
        const struct wd_tree_vertex *const vertices[3] = {
            &mesh->vertices[indices[0]], &mesh->vertices[indices[1]], &mesh->vertices[indices[2]]};
        draw_triangle(&canvas, vertices, 3 * (size_t)triangles[i] < mesh->wood_index_count);
    }
    struct wd_shown shown = count_shown(&canvas);
    free(triangles);
    free(canvas.nearest);
    free(canvas.kind);
    free(canvas.openness);
    return shown;
}
