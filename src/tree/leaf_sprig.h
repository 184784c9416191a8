/* leaf_sprig.h: a short twig's leaves as few triangles, which a drawn leaf of a large tree is. */
#ifndef WD_TREE_LEAF_SPRIG_H
#define WD_TREE_LEAF_SPRIG_H

#include "tree/leaf_parts.h"

enum { WD_SPRIG_LEAVES = 14 }; /* at most */

struct wd_sprig {
    uint32_t leaves;
    uint32_t triangles; /* of each leaf: 1, or 2 for a kite */
};

/* Its leaves, leaflets of compound ones, together with the area of one whole leaf of unit length.
 * Sprigs of one kind have the same triangles in each of the WD_LEAF_VARIANTS. */
void wd_leaf_sprig_init(struct wd_leaf_template *leaf, const struct wd_species *species,
                        struct wd_sprig sprig, uint32_t variant);

/* Where leaf `i` of `count` stands on a twig of unit length with the area of one leaf so long. */
struct wd_blade_place wd_sprig_place(const struct wd_species *species, struct wd_random *random,
                                     int i, int count);
/* How far the twig itself reaches, and its place at share t of that. */
float wd_sprig_reach(int count);
struct wd_vec3 wd_sprig_axis(float at);

#endif
