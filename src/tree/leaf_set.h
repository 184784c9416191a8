/* leaf_set.h: leaves of a mesh as places and a few forms, and what becomes of them as triangles. A
 * tree has two sets a level, leaves and flowers; all share the tree's places. */
#ifndef WD_TREE_LEAF_SET_H
#define WD_TREE_LEAF_SET_H

#include "tree/leaf_template.h"
#include "tree/mesh.h"

enum wd_leaf_set_kind { WD_SET_LEAVES, WD_SET_FLOWERS, WD_LEAF_SETS };

/* The first leaf_count places, each in the form that it names, of those that there are. */
struct wd_leaf_set {
    struct wd_leaf_vertex *corners; /* [form][corner_count] */
    uint32_t *indices;              /* three a triangle, the same for each form; from 0 on */
    uint32_t forms, corner_count, index_count;
    uint32_t leaf_count;
    float grain;      /* length of its parts over a leaf's: 1, or less of sprigs */
    float own;        /* share of the sheet's own normal; the rest is the crown's */
    float arch_least; /* what stands above or below a leaf's plane is scaled by arch_least + */
    float arch_range; /* arch_range * WD_LEAF_ARCH */
};

/* Takes the forms of `templates`, which have the same triangles. */
void wd_leaf_set_init(struct wd_leaf_set *set, const struct wd_leaf_template *templates,
                      uint32_t forms);
void wd_leaf_set_finish(struct wd_leaf_set *set); /* accepts {0} */

/* Scales what hangs together by triangles about its middle, in each form; midribs of compound
 * leaves stay as they are. */
void wd_leaf_set_scale_parts(struct wd_leaf_set *set, float factor);

/* Height of the highest corner, or 0. */
float wd_leaf_set_top_m(const struct wd_leaf_set *set, const struct wd_tree_leaf *leaves,
                        const struct wd_leaf_box *box);

/* Appends the leaves as triangles. */
void wd_leaf_set_mesh(const struct wd_leaf_set *set, const struct wd_tree_leaf *leaves,
                      const struct wd_leaf_box *box, struct wd_tree_mesh *mesh);
/* Gives the vertices that wd_leaf_set_mesh appended their places anew: the forms' corners may have
 * moved since, the leaves and all else not. */
void wd_leaf_set_move(const struct wd_leaf_set *set, const struct wd_tree_leaf *leaves,
                      const struct wd_leaf_box *box, struct wd_tree_vertex *vertices);

/* A leaf before it is packed. */
struct wd_leaf_stand {
    struct wd_vec3 position_m; /* of its foot */
    struct wd_vec3 axis;       /* unit, to the tip */
    struct wd_vec3 normal;     /* unit, square to the axis: the upper side */
    struct wd_vec3 shading;    /* unit: how the crown faces the light here */
    float size_m, flexibility;
    float arch;                /* 0..1, see wd_leaf_set.arch_range */
    uint32_t form, tint;
};

/* The box that holds them. */
struct wd_leaf_box wd_leaf_box_of(const struct wd_leaf_stand *places, size_t count);
struct wd_tree_leaf wd_leaf_pack(const struct wd_leaf_stand *place, const struct wd_leaf_box *box);
void wd_leaf_box_scale(struct wd_leaf_box *box, float factor);

#endif
