/* leaf_spray.h: the twig that one drawn leaf of a large tree stands for. */
#ifndef WD_TREE_LEAF_SPRAY_H
#define WD_TREE_LEAF_SPRAY_H

#include "scene/species.h"
#include "tree/mesh.h"

/* Triangles of a twig at most, as it is seen and as it throws its shadow; ferns' fronds have as many as they take. */
enum { WD_SPRAY_TRIANGLES = 1500, WD_SPRAY_SHADE_TRIANGLES = 150 };

/* Of ferns each of the forms of its fronds has a near form; of others all twigs are alike. Forms have as many corners
 * and triangles each and stand one after another in the meshes below. */
uint32_t wd_leaf_spray_forms(const struct wd_species *species);

/* Makes the twig for drawn leaves `size_m` long: leaves or needles of their real size with the
 * drawn one's area in all, with lobes and teeth, and their wood. Positions are in units of size_m in the leaf's frame (x
 * across, y along, z above), tints of leaves white, of wood the twig's; kind's flexibility is what
 * is added to the leaf's own. Empty where a drawn leaf is a single leaf or frond in full already. */
void wd_leaf_spray_mesh(struct wd_tree_mesh *mesh, const struct wd_species *species, float size_m);
/* The same twig for shadow maps and pixels that are as wide as its leaves, wider than needles and teeth: leaves as kites
 * in the same places (fronds as from afar), fewer and wider needles, of the same area in all. */
void wd_leaf_spray_shade_mesh(struct wd_tree_mesh *mesh, const struct wd_species *species, float size_m);
/* Root of the mean area of the leaves of such a mesh, in units of size_m; 0 where it has none. */
float wd_leaf_spray_grain(const struct wd_tree_mesh *shade);

#endif
