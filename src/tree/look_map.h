/* look_map.h: pictures of bark, leaves and flowers, generated at any resolution. */
#ifndef WD_TREE_LOOK_MAP_H
#define WD_TREE_LOOK_MAP_H

#include "scene/species.h"
#include "shared/tree.h"

/* `size` x `size` texels, 4 bytes each; both owned by the caller. */
struct wd_look_map {
    uint32_t size;
    uint8_t *albedo; /* RGB sRGB; A: share of the texel inside the outline (255 on bark) */
    uint8_t *detail; /* linear. RG: tangent-space normal's x, y * 0.5 + 0.5 (x along u, y along v);
                        B: roughness (GGX alpha's root); A: bark: height of the relief, 0 the
                        deepest crack .. 1; leaves: light let through over light reflected, relative
                        to the leaf's mean, * 0.5 */
};

/* Fills both parts of a layer (WD_LOOK_*). Bark tiles both ways. A leaf fills the square from its foot (v = 0) to its tip;
 * colours go on beyond its outline, so that filtering never darkens an edge. Weighted by A, the
 * mean of albedo is that of wd_look_color; and normals are of unit length, z = sqrt(1 - x2 - y2). */
void wd_look_map_fill(const struct wd_look_map *map, const struct wd_species *species,
                      uint32_t layer);

/* The mean albedo that a layer is made to have, before vertex tints. */
void wd_look_color(const struct wd_species *species, uint32_t layer, float color[3]);

#endif
