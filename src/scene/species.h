/* species.h: what a species file says: form, allometry, branching, leaves, colours, habitat. */
#ifndef WD_SCENE_SPECIES_H
#define WD_SCENE_SPECIES_H

#include "scene/keys.h"

enum wd_species_form { WD_FORM_BROADLEAF, WD_FORM_CONIFER };
enum wd_phyllotaxis { WD_PHYLLOTAXIS_ALTERNATE, WD_PHYLLOTAXIS_OPPOSITE, WD_PHYLLOTAXIS_WHORLED };
enum wd_leaf_shape { WD_LEAF_OVATE, WD_LEAF_LOBED, WD_LEAF_TRIANGULAR, WD_LEAF_NEEDLES };
enum wd_bark_pattern { WD_BARK_FISSURED, WD_BARK_SCALY, WD_BARK_SMOOTH, WD_BARK_BIRCH };

/* Height from stem diameter: h = 1.3 + a (1 - exp(-b d))^c, d in cm, h in m (Chapman-Richards);
 * crown diameter w = crown_a + crown_b d^crown_c, d in cm, w in m. `source` cites the figures. */
struct wd_allometry {
    double height_a, height_b, height_c;
    double crown_a, crown_b, crown_c;
    const char *source;
};

/* One order of branches: 0 the trunk's own branches, 1 theirs, 2 the twigs. */
struct wd_branch_order {
    float angle_deg[2];       /* to the parent's axis, at the crown's base and top */
    float length_ratio;       /* to the parent's length (order 0: to the crown's width) */
    float radius_ratio;       /* to the parent's radius at the joint */
    float spacing_m;          /* along the parent, at the species' typical height */
    float wander;             /* random bending per metre, radians */
    float upturn;             /* bending toward the light (+) or by weight (-), radians per metre */
    float tip_upturn;         /* the same at the tip; spruce branches sag, and their tips rise */
    float start;              /* bare share of the parent below its first branch (not order 0) */
    float flatness;           /* 0 all around the parent .. 1 in one flat spray */
};

struct wd_species {
    const char *name;         /* short: "spruce" */
    const char *latin;        /* "Picea abies" */
    const char *citation;     /* where form and colours are from */
    int form;                 /* enum wd_species_form */
    float typical_height_m;
    float height_range_m[2];  /* grown heights allowed */
    float crown_base_forest, crown_base_open; /* share of height that is clear stem */
    float crown_shape[4];     /* crown radius, as a share of the widest, at 0, 1/3, 2/3 and 1 of
                                 the crown's length from its base */
    float crown_lobes;        /* depth of the crown's bulges, share of its radius */
    float crown_open;         /* crown diameter in the open over that in a forest, same stem */
    float stem_open;          /* stem diameter in the open over that in a forest, same height */
    float trunk_wander;       /* radians per metre */
    float apical_dominance;   /* 1: one leader to the top; 0: the trunk dissolves into limbs */
    float root_flare;         /* stem radius at the ground over that at 1.3 m */
    int64_t whorl;            /* branches at one height: 1 single, 4..6 conifers */
    struct wd_branch_order *orders;
    size_t order_count;       /* 1..3 */
    struct {
        int shape;            /* enum wd_leaf_shape */
        int phyllotaxis;
        float length_cm, width_cm;
        float droop;          /* 0 flat to the light .. 1 hanging */
        int64_t count;        /* drawn leaves, or needle shoots, of a tree of typical height */
        float area_index;     /* leaf area, one side, over the crown's projection */
        float color[3], back_color[3]; /* linear albedo */
        float transmittance[3];        /* linear */
        float color_spread;   /* of brightness and hue between trees, 0..1 */
    } leaf;
    struct {
        int pattern;          /* enum wd_bark_pattern */
        float color[3], crack_color[3]; /* linear albedo */
        float upper_color[3]; /* of the stem's upper part: pine is orange there */
        float twig_color[3];
        float upper_from;     /* share of the height where the upper colour begins to show */
        float scale_cm;       /* size of one plate or fissure */
    } bark;
    struct wd_allometry allometry;
    float flexibility;        /* wind: top displacement over height at 10 m/s, share */
};

extern const struct wd_keys wd_species_keys;

/* Reads one species file. Strings and lists live in `arena`. */
bool wd_species_load(struct wd_species *species, const char *path, struct wd_arena *arena,
                     const struct wd_log *log);

double wd_species_height_m(const struct wd_species *species, double dbh_cm);
double wd_species_crown_m(const struct wd_species *species, double dbh_cm); /* diameter */
/* The inverse of wd_species_height_m by bisection; clamped to 0.5..400 cm. */
double wd_species_dbh_cm(const struct wd_species *species, double height_m);

#endif
