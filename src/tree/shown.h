/* shown.h: what a small picture of a tree shows, as its mesh or as discs. */
#ifndef WD_TREE_SHOWN_H
#define WD_TREE_SHOWN_H

#include "tree/points.h"
#include "tree/silhouette.h"

/* Pixels, those of them that are wood or the lower side of leaves, and the sum of the openness to the
 * sky of wood and of leaves. */
struct wd_shown {
    double covered, wood, lower, openness[2];
};

void wd_shown_add(struct wd_shown *sum, const struct wd_shown *shown, double weight);

struct wd_shown wd_shown_mesh(const struct wd_silhouette *frame, const struct wd_tree_mesh *mesh);

/* Discs of one class, whoever looks; parallel. */
struct wd_faces {
    const struct wd_tree_points *discs;
    float (*normals)[3];
    uint8_t *lots; /* of wd_sun_way_by_lot */
};
void wd_faces_init(struct wd_faces *faces, const struct wd_tree_points *discs);
void wd_faces_finish(struct wd_faces *faces);

/* As a view sees a disc. */
struct wd_facet {
    float at[2], toward, facing;
    uint8_t seen, openness; /* seen: 1 where nothing of the tree lies before it */
};

/* A facet a disc; free() them. */
struct wd_facet *wd_facets_of(const struct wd_faces *faces, const struct wd_silhouette *frame);

/* So many facets of a class from one of them on, the first again after the last. */
struct wd_facet_run {
    const struct wd_facet *facets;
    size_t all, first, count;
};

/* Discs of both classes, wood first, as they lie before one another: the nearest first. */
struct wd_disc_window {
    float *at[2], *facing;
    int32_t *looks; /* openness; 256 more: leaves */
    size_t count;   /* room is for a multiple of four */
};

/* `close`: wd_disc_close; else what is seen is drawn `nearer_m` nearer. */
void wd_disc_window_init(struct wd_disc_window *window, const struct wd_facet_run runs[2],
                         float close, float nearer_m);
void wd_disc_window_finish(struct wd_disc_window *window);

/* Drawn as the squares of equal area that shaders/lib/splat_draw.glsl draws. `squared_m2`: of the radii of
 * both classes, where a disc is seen as the mean face is; `scale`: pixels a metre. What `before` covers hides
 * them and is not counted; NULL: nothing does. */
struct wd_shown wd_shown_discs(const struct wd_disc_window *window, const float squared_m2[2],
                               float scale, const struct wd_silhouette *before);

#endif
