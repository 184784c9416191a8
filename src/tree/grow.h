/* grow.h: one individual of a species, grown from its file. Pure CPU, deterministic. */
#ifndef WD_TREE_GROW_H
#define WD_TREE_GROW_H

#include "base/log.h"
#include "scene/species.h"
#include "shared/sunlit.h"
#include "tree/crown_shade.h"
#include "tree/leaf_set.h"

/* What a hedge is cut to, in metres from its foot: a box, or the inside of a closed mesh. The foot
 * should lie under it: one plant fills about as far as it is high. */
struct wd_clip_volume {
    const char *name;            /* for messages; NULL: "clip volume" */
    float min_m[3], max_m[3];    /* the box; not read where there are triangles */
    const float *positions_m;    /* three a vertex */
    const uint32_t *indices;     /* three a triangle, either way round */
    uint32_t vertex_count, triangle_count;
};

/* Zeroes are a typical tree. The size is given by height, by stem diameter, by both (an inventory's
 * tree), or by age; the rest follows from the species' allometry and site curve. An age together
 * with a diameter gives the height; together with a height it is refused. */
struct wd_grow_params {
    uint32_t seed;     /* the variant: another seed, another individual */
    float height_m;    /* 0: from dbh_m, from age_years, or the species' typical height */
    float dbh_m;       /* stem diameter at the species' diameter_at_m; 0: from the height */
    float age_years;   /* 0: from the height */
    float openness;    /* 0 forest-grown (narrow, high crown) .. 1 open-grown (wide, low crown) */
    float detail;      /* leaves and twigs of the full mesh relative to the species' own number;
                          0 means 1 */
    const struct wd_clip_volume *clip; /* NULL (the species' own box, if any), or what the plant is cut to: its top gives the
                                          height, so no size may be given */
};

/* Checks the parameters (errors are logged) and fills in the zeroes among height_m, dbh_m,
 * age_years and detail. */
bool wd_grow_params_resolve(struct wd_grow_params *params, const struct wd_species *species,
                            const struct wd_log *log);

/* A grown tree: the full mesh and its reduced mesh (about a tenth of the triangles; leaves are a
 * fair sample of the full set, enlarged so that leaf area is kept). */
struct wd_tree_model {
    struct wd_tree_mesh full;
    struct wd_tree_mesh reduced;
    struct wd_tree_mesh far_stem; /* the reduced mesh's stem again, of five sides and with a round foot, for small trees;
                                     empty where that has no root lobes */
    struct wd_tree_leaf *leaves; /* of both meshes: leaf_count leaves in progressive order, then
                                    flower_count flowers; NULL of imported trees, whose leaves are
                                    triangles only */
    uint32_t leaf_count, flower_count;
    struct wd_leaf_box leaf_box;
    struct wd_leaf_set sets[2][WD_LEAF_SETS]; /* of the full mesh and of the reduced one */
    struct wd_leaf_growths leaf_growth[2]; /* of either level (tree/thinning.h); 0: not known yet */
    float seen_m2[WD_GAIN_SIDES]; /* that the full mesh covers (tree/coverage.h); 0: not known yet */
    float sun_curve[2]; /* of wd_crown_lit (tree/sunlit.h); 0: not known yet */
    float sunlit[WD_SUNLIT_PLACES][WD_SUNLIT_KINDS]; /* tree/sunlit.h; 0: not known yet */
    float skylit[WD_SKYLIT_PLACES][WD_SKYLIT_KINDS]; /* likewise */
    float upper[WD_EYE_RINGS][WD_UPPER_KINDS]; /* shares of upper sides (shared/sunlit.h); likewise */
    float wood_seen[WD_EYE_RINGS]; /* share of wood in what eyes on these rings see above the lowest living branch; not
                                      known: 0 */
    float stem_seen[WD_EYE_RINGS]; /* and of wood below that branch in what they see of all; likewise */
    float cloud_wax[2]; /* what leaves' wax mirrors of the sun to an eye, over WD_WAX of what they would send of it were
                           they white: toward the sun, and what wd_cloud_wax_rise adds; 0: not known yet */
    float near_shade[2]; /* at WD_NEAR_SHADE_M, and the power; 0: not known yet */
    float recollision;   /* chance that what a leaf has scattered meets another of its tree; 0: not known yet */
    float flatness;      /* mean |z| of leaves' faces: 0.5 of leaves turned every way, 1 of level ones; 0: not known yet */
    float low_sky;       /* how much more of a sky that is brighter low down its leaves let through than of an even one, by
                            how much brighter an upright face's is; 0: not known yet */
    struct wd_crown_shade shade; /* not known yet: 0 */
    float spray_reach;           /* of wd_spray_share; 0 without twigs */
    struct wd_tree_mesh spray;   /* the twig that each leaf stands for (tree/leaf_spray.h), or
                                    empty where it is one leaf */
    uint32_t spray_forms;        /* in that mesh and the next, one after another; 0 without twigs */
    struct wd_tree_mesh spray_shade; /* the same for shadow maps */
    float height_m;       /* of the highest point */
    float crown_radius_m; /* mean horizontal reach of the crown */
    float crown_base_m;   /* height of the lowest living branch */
    float dbh_m;          /* stem diameter at 1.3 m; of low plants at the ground */
    float age_years;      /* by the species' site curve */
    float leaf_area_m2;   /* one side, of the full mesh */
    bool borrowed;        /* the meshes are those of species->imported, which keeps them */
};

/* Grows `*model`, or borrows a species' imported one as it is; the same parameters give the same
 * bytes on any machine. For another season than summer pass what wd_species_in_month made. False,
 * with {0}, for parameters outside the species' range (logged). */
bool wd_tree_grow(struct wd_tree_model *model, const struct wd_species *species,
                  const struct wd_grow_params *params, const struct wd_log *log);
void wd_tree_model_finish(struct wd_tree_model *model);

/* The meshes' leaves as triangles, or not: with them gone the meshes are wood alone, their bounds
 * still those of the whole, and leaves are where `sets` say. Imported trees keep theirs. */
void wd_tree_model_add_leaves(struct wd_tree_model *model); /* where they are not there already */
void wd_tree_model_drop_leaves(struct wd_tree_model *model);
/* Adds those of the full mesh alone, in the order in which they lie in space: who draws all of them has
 * its memory near by. `leaves` are in that order afterwards, no longer in the progressive one. */
void wd_tree_model_add_leaves_by_place(struct wd_tree_model *model);

#endif
