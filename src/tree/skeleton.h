/* skeleton.h: the wood of a tree as chains of nodes, before it has a surface. */
#ifndef WD_TREE_SKELETON_H
#define WD_TREE_SKELETON_H

#include <stddef.h>

#include "tree/density.h"
#include "tree/form.h"

enum { WD_TRUNK = -1, WD_MAX_BRANCHES = 60000 };

struct wd_skeleton_node {
    struct wd_vec3 position_m;
    struct wd_vec3 direction; /* unit, toward the tip */
    float radius_m;
    float load;               /* length of twigs carried from here on, metres */
    float along_m;            /* way along the wood from the foot */
    float flexibility;        /* 0 foot .. 200 the end of a twig */
};

struct wd_branch {
    int order;                /* WD_TRUNK, then 0 .. order_count - 1 */
    int parent;               /* index of the branch it grows from, -1 for a trunk */
    int stem;                 /* index of the trunk that carries it; its own for a trunk */
    size_t parent_node;       /* node of the parent at or below the joint */
    size_t first_node, node_count;
    float length_m;
    uint32_t key;
};

/* A branch comes after its parent, so that loops in either direction meet parts in order. */
struct wd_skeleton {
    struct wd_skeleton_node *nodes;
    size_t node_count, node_capacity;
    struct wd_branch *branches;
    size_t branch_count, branch_capacity;
    size_t stem_count;             /* trunks: 1, or the stems of a shrub; the first branches */
    struct wd_tree_density crowd; /* where branches are already: later ones grow into gaps */
};

/* Grows trunk and branches of all orders, without their radii. False (logged) when the species asks for
 * more than WD_MAX_BRANCHES. */
bool wd_skeleton_grow(struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                      const struct wd_log *log);
void wd_skeleton_finish(struct wd_skeleton *skeleton);

/* Brings places and lengths to another size. */
void wd_skeleton_scale(struct wd_skeleton *skeleton, float factor);

/* Flexibility of every node; called by wd_skeleton_grow. */
void wd_skeleton_set_flexibility(struct wd_skeleton *skeleton, const struct wd_tree_form *form);

/* Thickness of every node from what it carries, once: with the root flare, the stem is as thick as
 * form->dbh_m where the species' diameters are taken. */
void wd_skeleton_set_radii(struct wd_skeleton *skeleton, const struct wd_tree_form *form);

/* Extra radius of the root flare at height z, as a share. It falls off within two diameters. */
float wd_root_flare(const struct wd_tree_form *form, float dbh_m, float z_m);

/* Place and direction at `share` (0 base .. 1 tip) of a branch; *node is the node below. */
struct wd_vec3 wd_branch_point(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                               float share, struct wd_vec3 *direction, size_t *node);

#endif
