/* species.h: what a species file says: form, allometry, branching, leaves, colours, habitat. */
#ifndef WD_SCENE_SPECIES_H
#define WD_SCENE_SPECIES_H

#include "scene/keys.h"

enum wd_species_form {
    WD_FORM_BROADLEAF, WD_FORM_CONIFER,
    WD_FORM_PALM,    /* one unbranched stem, fronds at its top: no orders */
    WD_FORM_SHRUB,   /* several stems from one stool */
    WD_FORM_FERN,    /* a rosette of fronds from the ground: no orders */
    WD_FORM_GRASS,   /* a tuft of blades: no orders */
    WD_FORM_BRAMBLE, /* arching canes from one stool */
    WD_FORM_SNAG,    /* dead: no leaves, stem and limbs broken */
    WD_FORM_FALLING, /* air with leaves on their way down: no orders */
};
enum wd_phyllotaxis { WD_PHYLLOTAXIS_ALTERNATE, WD_PHYLLOTAXIS_OPPOSITE, WD_PHYLLOTAXIS_WHORLED };
enum wd_leaf_shape {
    WD_LEAF_OVATE, WD_LEAF_LOBED, WD_LEAF_TRIANGULAR, WD_LEAF_PALMATE, WD_LEAF_LANCEOLATE,
    WD_LEAF_HEART, WD_LEAF_ELLIPTIC,
    WD_LEAF_BLADE, WD_LEAF_NEEDLES,
    WD_LEAF_SERRATE, /* ovate with teeth */
};
enum wd_leaf_compound {
    WD_COMPOUND_SIMPLE,
    WD_COMPOUND_PINNATE,   /* leaflets in two rows along a midrib */
    WD_COMPOUND_PALMATE,   /* leaflets from one point: 3 bramble, 7 kapok */
    WD_COMPOUND_BIPINNATE, /* a fern's frond: the pinnae are pinnate themselves */
};
enum wd_needle_set {
    WD_NEEDLES_AROUND,    /* singly all round the shoot: spruce */
    WD_NEEDLES_FASCICLES, /* in bundles round the end of a shoot: pine */
    WD_NEEDLES_TUFTS,     /* in rosettes on short shoots along a bare twig: larch */
};
enum wd_bark_pattern {
    WD_BARK_FISSURED, WD_BARK_SCALY, WD_BARK_SMOOTH, WD_BARK_BIRCH,
    WD_BARK_RINGED, /* scars of fallen fronds around a palm's stem */
    WD_BARK_BARE,   /* weathered wood with drying cracks along the stem */
};

enum wd_model_axis { WD_AXIS_AUTO, WD_AXIS_X, WD_AXIS_Y, WD_AXIS_Z };
enum wd_model_unit { WD_UNIT_AUTO, WD_UNIT_M, WD_UNIT_CM, WD_UNIT_MM, WD_UNIT_FT, WD_UNIT_IN };
struct wd_tree_import; /* tree/import.h */

/* Height from stem diameter: h = diameter_at + a (1 - exp(-b d))^c, d in cm, h in m
 * (Chapman-Richards); crown diameter w = crown_a + crown_b d^crown_c, d in cm, w in m. `source`
 * cites the figures. */
struct wd_allometry {
    double height_a, height_b, height_c;
    double crown_a, crown_b, crown_c;
    const char *source;
    double diameter_at_m; /* height where d is taken: 1.3, or 0 for plants below breast height */
};

/* Height from age: h = a (1 - exp(-b t))^c, t in years, h in m (Chapman-Richards). */
struct wd_site_curve {
    double height_a, height_b, height_c;
    double span_years; /* the oldest that it holds for */
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
    const char *path;         /* the file read; NULL where there is none */
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
    struct {
        int64_t count;        /* 1 a tree; more: a shrub's stems, a bramble's canes */
        float lean_deg[2];    /* from the vertical at the foot: of the innermost and outermost */
        float upturn[2];      /* bending up (+) or over (-) along the stem, radians in all:
                                 at its foot and tip */
        float spread_m;       /* radius of the stool they stand on */
    } stems;
    struct {
        int64_t count;        /* 0: none */
        float height;         /* share of the tree's height that they climb */
        float reach;          /* how far they run from the stem's middle, in stem diameters */
    } buttress;
    struct {
        float broken_at;      /* share of the stem that stands: 1 whole */
        float limbs;          /* share of the limbs still there .. 1 */
        float bark;           /* share of the wood that bark still covers: 1 alive */
    } decay;
    struct wd_branch_order *orders;
    size_t order_count;       /* 1..3; 0 for palms, ferns, grasses */
    struct {
        int shape;            /* enum wd_leaf_shape, of a compound leaf's leaflets */
        int compound;         /* enum wd_leaf_compound */
        int64_t leaflets;     /* of a compound leaf; of a bipinnate frond: its pinnae */
        float leaflet_length_cm, leaflet_width_cm; /* the longest; of a bipinnate frond: pinnae */
        float stalk_cm;       /* bare foot of the leaf, part of its length */
        float arch;           /* bend of a leaf from its foot to its tip, radians, downward */
        int phyllotaxis;
        int needles;          /* enum wd_needle_set */
        int64_t bundle;       /* needles of one bundle or rosette: pine 2, larch 30 */
        float shoot_cm;       /* length of the needle-bearing shoot that is drawn as one leaf */
        float length_cm, width_cm; /* of the whole leaf, or of one needle */
        float droop;          /* 0 flat to the light .. 1 hanging */
        int64_t count;        /* drawn leaves, or needle shoots, of a tree of typical height */
        float area_index;     /* leaf area, one side, over the crown's projection */
        float color[3], back_color[3]; /* linear albedo in summer */
        float spring_color[3], autumn_color[3];
        float transmittance[3];        /* linear */
        float color_spread;   /* of brightness and hue between trees, 0..1 */
        float gloss;          /* of the upper side: 0 dull .. 1 waxed */
        bool evergreen;
        float months[2];      /* when leaves unfold and when the last fall: 4.5 is mid-April */
        /* of wd_species_in_month: what trees late (0) and early (1) in the season have over `color`
         * and `count`; 0: all are alike */
        float season_color[2][3], season_count[2];
        float flexibility;    /* turn of a leaf in a wind of 10 m/s, radians */
    } leaf;
    struct {
        int64_t count;        /* 0: none to be seen; on a tree of typical height */
        float size_cm;        /* diameter of a flower, length of a panicle or plume */
        int64_t petals;       /* 0: a panicle, catkin or plume */
        float hang;           /* of a panicle: 0 stands up .. 1 hangs as a catkin */
        float color[3], center_color[3]; /* linear albedo */
        float months[2];      /* first and last; may run over the new year: [11, 4] */
    } flower;
    struct {
        int pattern;          /* enum wd_bark_pattern */
        float color[3], crack_color[3]; /* linear albedo */
        float upper_color[3]; /* of the stem's upper part: pine is orange there */
        float twig_color[3];
        float upper_from;     /* share of the height where the upper colour begins to show */
        float scale_cm;       /* size of one plate or fissure */
        float moss;           /* share of the foot that moss covers */
    } bark;
    struct wd_allometry allometry;
    struct wd_site_curve growth;
    struct {
        const char *region;   /* where it is at home */
        float altitude_m[2];
        float moisture[2];    /* of the soil it stands: 0 dry .. 1 wet */
        float light;          /* it needs: 0 endures deep shade .. 1 only in full light */
    } habitat;
    struct {
        const char *file;     /* an artist's model, ready to open; NULL: the species is grown, and
                                 what follows means nothing */
        float height_m;       /* 0: as high as the file has it */
        int up, unit;         /* enum wd_model_axis, wd_model_unit: of the file */
        float leaf_reflectance; /* leaves are darkened to this mean luminance at most */
        const char **leaves, **wood; /* names of materials */
        size_t leaf_count, wood_count;
        float crown_share;    /* crown diameter over height where allometry.crown_b is 0 */
    } model;
    float openness;           /* in scenes: 0 grown among neighbours .. 1 in the open */
    uint32_t when_young;      /* in scenes: 1 + index of what its trees become that are lower than half grown; 0: of none, */
    uint32_t in_the_open;     /* and of those that neighbours leave light from the sides */
    float planted_m[2];       /* in scenes: lowest and greatest height of its trees; 0, 0: any */
    float clip_box_m[3];      /* width, depth, height of the box that a hedge is cut to; 0: none */
    const char *clip_file;    /* or the closed mesh that it is cut to: clip_box_m is then its size, */
    struct wd_clip_mesh *clip; /* once it is read: wd_species_import_models */
    struct wd_tree_import *imported; /* the model once read: wd_species_import_models */
    float flexibility;        /* wind: top displacement over height at 10 m/s, share */
};

/* Of a species that a scene does not place more openly: the upper trees of a stand. */
#define WD_STAND_OPENNESS 0.2f
/* Height of the lowest variants over the typical one. */
#define WD_HALF_GROWN 0.45f
/* Of one that stands for another's trees in the open. */
#define WD_OPEN_OPENNESS 0.8f

/* Files of grown species and of species that are an artist's model. */
extern const struct wd_keys wd_species_keys, wd_species_model_keys;

/* Whether the name ends like a model: .obj, .gltf, .glb, .fbx or .dae. */
bool wd_species_is_model_file(const char *path);

/* The file of a species by name, or else by its Latin name, in the folders of wd_species_folders_init for the
 * working directory; NULL (logged, with the names there are, or the folders) if there is none. free() it. */
char *wd_species_find_file(const char *name, const struct wd_log *log);

/* Names of the species in the first of those folders that has any, sorted, in the arena. */
size_t wd_species_list(const char ***names, struct wd_arena *arena);

/* Reads one species file of either kind, or takes a model file as a species with the defaults of
 * its kind. Strings and lists live in `arena`. */
bool wd_species_load(struct wd_species *species, const char *path, struct wd_arena *arena,
                     const struct wd_log *log);

double wd_species_height_m(const struct wd_species *species, double dbh_cm);
double wd_species_crown_m(const struct wd_species *species, double dbh_cm); /* diameter */
/* The inverse of wd_species_height_m by bisection; clamped to 0.01..400 cm. */
double wd_species_dbh_cm(const struct wd_species *species, double height_m);
/* The same for any height: where the curve gives no diameter (just over the height where diameters
 * are taken, and near the greatest height) stems thicken with height. */
double wd_species_stem_of_height_cm(const struct wd_species *species, double height_m);
/* How far a broadleaf has grown free of neighbours: 0 up to two fifths open, where they still touch its crown, 1 in the
 * open; less the more its leader leads. Such trees are broad domes of level limbs on short, stout stems. */
double wd_species_free(const struct wd_species *species, double openness);
/* Stem diameter over that of a forest tree of the same height. Trees in the open keep their height
 * per diameter from youth on (30 to 60: Hasenauer, For. Ecol. Manage. 96 (1997) 197-206), while young
 * trees of a forest are rods: below the typical height the ratio grows. */
double wd_species_open_stem(const struct wd_species *species, double height_m, double openness);
/* Crown diameter over that of a forest tree of the same stem. */
double wd_species_open_crown(const struct wd_species *species, double openness);
/* Crown diameter of a tree that stands as openly as the species does. Just over the height where
 * diameters are taken and near the greatest height (where any diameter fits) crowns scale with
 * height. */
double wd_species_crown_of_height_m(const struct wd_species *species, double height_m);

/* How much of its youth a tree of this height still has: 1 a seedling .. 0 from just below half of the typical
 * height on, and always for plants that are no trees. Until neighbours close over them young trees keep a single
 * leader and branches down to the ground, live crowns of 0.6 to 0.9 of the height; then these recede (Oliver and
 * Larson, Forest Stand Dynamics, 1996). */
float wd_species_youth(const struct wd_species *species, double height_m);
/* Crown diameter of a tree of this height whose allometry says `crown_m`: power curves of stems of 15 to 52 cm
 * tell nothing of rods, whose crowns are 0.3 to 0.5 times as wide as they are tall, in the open more. */
double wd_species_young_crown_m(const struct wd_species *species, double height_m, double openness,
                                double crown_m);

/* Radius of the circle as large as a rectangle: how far a hedge reaches. */
float wd_hedge_reach_m(float width_m, float depth_m);

/* Heights that a species' variants stand for, in equal parts: from half grown to tall. Where a scene has but
 * saplings of it, from less than a quarter of the typical height on and none half grown, those planted: they would
 * be scaled down old trees. The range is empty where the species' own is. */
void wd_species_variant_range_m(const struct wd_species *species, float range_m[2]);

double wd_species_height_at_age_m(const struct wd_species *species, double age_years);
/* The inverse, by bisection; clamped to 0.01 .. span_years. */
double wd_species_age_years(const struct wd_species *species, double height_m);

/* `*seasonal` is the species as it looks in that month (1 the first of January .. 13 the last of
 * December, north of the tropics): the colours of its leaves, how many are there, flowers. Growth
 * and looks take it like any species; it shares the strings and lists of `species`. False (logged)
 * for a month outside 1..13. */
bool wd_species_in_month(struct wd_species *seasonal, const struct wd_species *species,
                         double month, const struct wd_log *log);

#endif
