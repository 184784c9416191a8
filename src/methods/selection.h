/* selection.h: which trees a view shows, at which level: what every method decides before drawing. */
#ifndef WD_METHODS_SELECTION_H
#define WD_METHODS_SELECTION_H

#include "forest/forest.h"
#include "frame/view.h"

enum wd_tree_pass { WD_PASS_CAMERA, WD_PASS_SHADOW };

/* How much of each level shows: G7's noise blend. The farther level is blended in whole before the
 * nearer one is blended out, so that nothing shines through. */
struct wd_levels {
    float show[3]; /* by WD_LEVEL_*: 0 nothing .. 1 whole */
};

/* Distances of the levels for one view. */
struct wd_level_rule {
    float mesh_m, reduced_m; /* for a tree of 20 m; both grow with height, unless `plain` */
    float blend;             /* share of the distance over which levels blend */
    uint32_t finest;         /* WD_LEVEL_*: shadows of far cascades start lower */
    enum wd_tree_pass pass;
    float farthest_m;        /* greatest mesh distance that a layer asks for itself */
    bool plain;              /* distances hold for every tree, whatever its height or layer */
    bool parallel;           /* levels blend at the same time: the ghosts that G7 avoids */
};
struct wd_level_rule wd_level_rule_of(const struct wd_forest_device *forest,
                                      const struct wd_view *view, enum wd_tree_pass pass);
/* Pixels of a radian, as far as leaves thin out by them: shadows hold fewer and larger ones, and the
 * scene may want them longer or shorter than WD_LEAF_WHOLE_PX. */
float wd_leaf_pixels(const struct wd_forest_device *forest, const struct wd_view *view,
                     enum wd_tree_pass pass);
/* Of wd_leaf_stand: a shadow map needs but some triangles of leaves for each texel that the tree covers. */
float wd_leaf_most(const struct wd_forest_device *forest, const struct wd_view *view,
                   enum wd_tree_pass pass, uint32_t model, uint32_t level);
struct wd_levels wd_levels_at(const struct wd_level_rule *rule, float height_m, float distance_m);
/* Distance beyond which every tree up to `height_m` is a card and nothing else. */
float wd_level_card_distance(const struct wd_level_rule *rule, float height_m);

struct wd_range {
    uint32_t begin, end;    /* trees, octree order */
    uint32_t card_vertices; /* a tree: WD_CARD_VERTICES or WD_UPRIGHT_VERTICES */
};

/* Trees of one model and level. */
struct wd_mesh_batch {
    uint32_t model, level, leaf_step; /* at most leaf_count >> leaf_step leaves show */
    uint32_t first, count; /* instances */
};

struct wd_selection {
    struct wd_range *ranges; /* drawn as cards, whole */
    size_t range_count, range_capacity;
    struct wd_instance *cards; /* drawn as cards one by one */
    size_t card_count, card_capacity;
    struct wd_instance *meshes; /* in the order they were found, until sorted into batches */
    uint32_t *mesh_keys;        /* (model * 2 + level) * WD_LEAF_STEPS + step, parallel to meshes */
    size_t mesh_count, mesh_capacity, key_capacity;
    struct wd_mesh_batch *batches;
    size_t batch_count, batch_capacity;
};

void wd_selection_clear(struct wd_selection *selection); /* keeps the memory */
void wd_selection_finish(struct wd_selection *selection);

/* Adds a range; one that begins where the last ended, with as many vertices, makes it longer. */
void wd_selection_add_range(struct wd_selection *selection, const struct wd_range *range);

/* Adds one tree by itself at the levels that its distance asks for, if the view can see it. */
void wd_selection_add_tree(struct wd_selection *selection, const struct wd_forest_device *forest,
                           const struct wd_view *view, const struct wd_level_rule *rule,
                           uint32_t tree);

/* Adds one tree at a mesh level, wholly or in part, with its leaves as far as the step says. */
struct wd_mesh_choice {
    uint32_t model, level, leaf_step;
};
void wd_selection_add_mesh(struct wd_selection *selection, const struct wd_mesh_choice *choice,
                           uint32_t tree, float show);
bool wd_tree_in_view(const struct wd_view *view, const struct wd_tree *tree);

/* Orders the meshes by model and level and fills `batches`. */
void wd_selection_sort(struct wd_selection *selection, uint32_t model_count);

#endif
