/* form.h: the sizes of one individual, resolved from its species, and the envelope of its crown. */
#ifndef WD_TREE_FORM_H
#define WD_TREE_FORM_H

#include "scene/species.h"
#include "tree/clip.h"
#include "tree/grow.h"
#include "tree/random.h"

struct wd_tree_form {
    const struct wd_species *species;
    uint32_t key;         /* of every random number of this individual */
    float height_m;
    float scale;          /* height over the species' typical height */
    float youth;          /* 1 a seedling .. 0 grown: wd_species_youth */
    float leader;         /* the species' apical dominance; young trees all have one leader */
    float crown_shape[4]; /* as the species' own */
    float openness;       /* 0 forest-grown .. 1 open-grown */
    float free;           /* wd_species_free, but for clipped and young trees */
    float dissolved;      /* how far a free tree's stem gives way to few heavy limbs: 0 to a third free, 1 when free */
    float bole_m;         /* height of the lowest limb */
    float detail;
    float dbh_m;
    float crown_base_m;
    float crown_radius_m; /* of the envelope at its widest */
    float spread;         /* size of the crown over that of a typical forest tree */
    float lobe_m;         /* size of the envelope's bulges */
    const struct wd_clip_grid *clip; /* NULL, or the envelope instead of the crown's shape */
};

/* `params` as wd_grow_params_resolve left them. */
struct wd_tree_form wd_tree_form_of(const struct wd_species *species,
                                    const struct wd_grow_params *params);

/* Makes the clip volume the envelope of the crown; it must outlive the form. */
void wd_tree_form_clip(struct wd_tree_form *form, const struct wd_clip_grid *clip);

/* Whether a clip volume ends below or beside p; never under its bottom. */
bool wd_tree_is_cut(const struct wd_tree_form *form, struct wd_vec3 p);

/* Radius of the crown's envelope at height z in the direction of p from the axis, with bulges;
 * 0 above and below the crown. */
float wd_tree_envelope_m(const struct wd_tree_form *form, struct wd_vec3 p);

/* Distance of p from the axis over the envelope's radius there, beyond the crown; at most 1 inside.
 * Large above the top; under the crown's base it grows softly. */
float wd_tree_envelope_share(const struct wd_tree_form *form, struct wd_vec3 p);

/* How far one can go from p along d inside the envelope, at most `limit_m`. */
float wd_tree_envelope_reach_m(const struct wd_tree_form *form, struct wd_vec3 p,
                               struct wd_vec3 d, float limit_m);

/* The direction away from the crown's middle: how the crown as a whole faces the sky at p. */
struct wd_vec3 wd_tree_crown_direction(const struct wd_tree_form *form, struct wd_vec3 p);

#endif
