/* look.h: colours of bark and leaves as vertex tints, matched to the look textures.
 *
 * A tint can only darken, so each texture holds the brightest of the species' colours and the tint
 * brings it to the colour of the place: texture x tint = albedo. */
#ifndef WD_TREE_LOOK_H
#define WD_TREE_LOOK_H

#include "scene/species.h"
#include "shared/types.h"

/* Mean of the tints of leaves: leaf textures are brighter by its inverse. */
#define WD_LEAF_TINT_MEAN 0.8f

struct wd_bark_tint {
    float lower[3], upper[3], twig[3]; /* over the texture's own plate colour */
    float upper_from;
};

/* The brightest of the bark's colours, part by part: the plate colour of the texture. */
void wd_bark_texture_color(const struct wd_species *species, float color[3]);

struct wd_bark_tint wd_bark_tint_of(const struct wd_species *species);

/* Tint at `height` (share of the tree's) on wood of the given radius; `sky` goes into A. */
uint32_t wd_bark_tint_at(const struct wd_bark_tint *bark, float height, float radius_m,
                         float sky);

/* Mean roughness (the root of GGX's alpha) of the upper side: 0.62 dull .. 0.24 waxed. */
float wd_leaf_roughness(const struct wd_species *species);

uint32_t wd_pack_tint(const float rgb[3], float sky);

#endif
