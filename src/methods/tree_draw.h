/* tree_draw.h: pipelines that draw trees as meshes and cards, shared by methods. */
#ifndef WD_METHODS_TREE_DRAW_H
#define WD_METHODS_TREE_DRAW_H

#include "frame/targets.h"
#include "methods/selection.h"

/* Bias of shadow maps' depth by the slope. Depth is reversed: away from the sun is down. */
#define WD_SHADOW_SLOPE (-1.0f)

struct wd_draw_stats {
    uint64_t draw_calls, triangles;
    uint64_t trees[3]; /* by WD_LEVEL_*; a tree that blends counts at both levels */
    bool unfinished;   /* a view shows less than it will when trees on demand have been planted */
};

struct wd_tree_pipelines {
    /* [WD_PASS_CAMERA, WD_PASS_SHADOW] */
    struct wd_pipeline mesh[2];
    struct wd_pipeline mesh_detail; /* full meshes for the camera */
    struct wd_pipeline leaf[2][2], leaf_listed[2][2]; /* by whether they hang or fall; of full meshes
                                                         those that the view may show */
    struct wd_pipeline spray[2];    /* leaves close by as twigs */
    struct wd_pipeline card_range[2], card_listed[2];
};
bool wd_tree_pipelines_init(struct wd_tree_pipelines *pipelines, struct wd_gpu *gpu);
/* Adds those that such a forest needs, and methods that draw cards. No frame is being recorded. */
bool wd_tree_pipelines_prepare(struct wd_tree_pipelines *pipelines, struct wd_gpu *gpu,
                               const struct wd_forest_device *forest, bool cards);

/* One view to be drawn. */
struct wd_tree_draw {
    struct wd_cmd *cmd;
    const struct wd_tree_pipelines *pipelines;
    const struct wd_forest_device *forest;
    const struct wd_view *view;
    enum wd_tree_pass pass;
    struct wd_targets *targets;     /* of the frame: the terrain's depth is there already */
    struct wd_binding uniforms;     /* struct wd_frame_uniforms */
    struct wd_draw_stats *stats;    /* added to */
    uint32_t view_mode;             /* WD_MODE_* */
    uint32_t page_budget;           /* as in struct wd_frame_params */
    float max_error_px;             /* likewise */
};

/* Whether trees that stand alone share draws. */
enum wd_draw_grouping {
    WD_DRAW_GROUPED, /* one instanced draw a model and level, one draw for all listed cards */
    WD_DRAW_SINGLE,  /* one draw a tree */
    WD_DRAW_WOOD,    /* grouped, meshes without their leaves */
};

/* Draws ranges of trees as cards: of octree order, or of a list of struct wd_instance. */
void wd_tree_draw_card_ranges(const struct wd_tree_draw *draw, const struct wd_range *ranges,
                              size_t count, const struct wd_buffer *list);

/* Quads of four vertices each, by the bound pipeline, as many in one draw as there are indices for: vertex 4 * i + k is
 * corner k of quad i. */
void wd_tree_draw_quads(const struct wd_tree_draw *draw, uint32_t quads);

/* The meshes of a selection without their leaves. Sorts it. */
void wd_tree_draw_wood(const struct wd_tree_draw *draw, struct wd_selection *selection);

/* Records all of a selection, inside an open rendering. Buffers of the forest are in use for
 * reading by graphics. Sorts the selection. */
void wd_tree_draw_selection(const struct wd_tree_draw *draw, struct wd_selection *selection,
                            enum wd_draw_grouping grouping);

#endif
