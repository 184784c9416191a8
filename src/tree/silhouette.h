/* silhouette.h: which pixels of a small picture a mesh covers, seen from one side. */
#ifndef WD_TREE_SILHOUETTE_H
#define WD_TREE_SILHOUETTE_H

#include "tree/four.h"
#include "tree/mesh.h"

enum {
    WD_SILHOUETTE = 160,                       /* pixels a side */
    WD_SILHOUETTE_ROW = WD_SILHOUETTE / 8 + 4, /* bytes, the last four for what is not seen */
    WD_SILHOUETTE_FRONT = WD_SILHOUETTE * (WD_SILHOUETTE + 1) + 3, /* the last row likewise */
};

/* Orthographic; the middle of pixel (x, y) is at x + 0.5, y + 0.5. */
struct wd_silhouette {
    struct wd_vec3 right, up, toward;
    float low[2], scale; /* metres at pixel 0; pixels a metre */
    uint8_t covered[WD_SILHOUETTE + 1][WD_SILHOUETTE_ROW]; /* a bit a pixel */
};

/* An empty picture that frames `frame` (its bounds are set), at the same scale from all sides. */
void wd_silhouette_init(struct wd_silhouette *silhouette, const struct wd_tree_mesh *frame,
                        struct wd_vec3 toward);

/* Covers, in each of the views, what the triangles of indices [first, end) cover: pixels whose middle
 * lies in one. */
void wd_silhouette_cover(struct wd_silhouette *views, int view_count,
                         const struct wd_tree_mesh *mesh, uint32_t first, uint32_t end);

/* fronts[view][y * WD_SILHOUETTE + x], WD_SILHOUETTE_FRONT a view: the distance toward the picture's
 * side of what is nearest to it, or minus infinity. */
void wd_silhouette_front(const struct wd_silhouette *views, int view_count,
                         const struct wd_tree_mesh *mesh, float *fronts);

/* triangles[index_count / 3]: those of the mesh that reach over the middle of a pixel, and few others, in
 * their order. Returns how many. */
uint32_t wd_silhouette_reach(uint32_t *triangles, const struct wd_silhouette *view,
                             const struct wd_tree_mesh *mesh);

size_t wd_silhouette_count(const struct wd_silhouette *silhouette);

/* Pixels and distance of a point p, in metres toward the picture's side, are dot(p, axis) - low of these. */
struct wd_silhouette_axes {
    struct wd_vec3 axis[3];
    float low[3];
};
struct wd_silhouette_axes wd_silhouette_axes_of(const struct wd_silhouette *silhouette);
static inline void wd_silhouette_place(const struct wd_silhouette_axes *axes, const float p[3],
                                       float at[3])
{
    for (int i = 0; i < 3; i++)
        at[i] = wd_v3_dot(wd_v3_of(p), axes->axis[i]) - axes->low[i];
}
static inline void wd_silhouette_project(const struct wd_silhouette *silhouette, const float p[3],
                                         float at[2])
{
    at[0] = (wd_v3_dot(wd_v3_of(p), silhouette->right) - silhouette->low[0]) * silhouette->scale;
    at[1] = (wd_v3_dot(wd_v3_of(p), silhouette->up) - silhouette->low[1]) * silhouette->scale;
}

/* First pixel whose middle is at x or beyond, within the picture; 0 for NaN. */
static inline int wd_silhouette_pixel(float x)
{
    if (!(x > 0.5f))
        return 0;
    if (!(x < WD_SILHOUETTE))
        return WD_SILHOUETTE;
    float from = x - 0.5f;
    int pixel = (int)from; /* rounded up, without a call of the library */
    return pixel + ((float)pixel < from);
}

/* Of four; branchless. */
static inline wd_four_ints wd_silhouette_pixels(wd_four x)
{
    const wd_four none = {0};
    wd_four from = wd_four_min(wd_four_max(x, none), wd_four_of(WD_SILHOUETTE)) - 0.5f;
    wd_four_ints pixel = wd_four_truncate(from);
    return pixel - (wd_four_convert(pixel) < from);
}

#endif
