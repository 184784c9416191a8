#include "scene/species.h"

#define FIELD(member) offsetof(struct wd_species, member)
#define IN(group, member) (offsetof(struct wd_species, group.member) - FIELD(group))
#define SIZE(group) sizeof(((struct wd_species *)0)->group)

static const char *const forms[] = {"broadleaf", "conifer", NULL};
static const char *const phyllotaxes[] = {"alternate", "opposite", "whorled", NULL};
static const char *const leaf_shapes[] = {"ovate", "lobed", "triangular", "needles", NULL};
static const char *const bark_patterns[] = {"fissured", "scaly", "smooth", "birch", NULL};

#define ORDER(member) offsetof(struct wd_branch_order, member)
static const struct wd_key order_keys[] = {
    {"angle_deg", WD_KEY_FLOATS, ORDER(angle_deg), 0, 170, "[70, 40]",
     "Angles to the parent's axis at the crown's base and at its top, in degrees.", .length = 2},
    {"length_ratio", WD_KEY_FLOAT, ORDER(length_ratio), 0, 4, "0.5",
     "Length over the parent's length; for the first order over half the crown's width.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"radius_ratio", WD_KEY_FLOAT, ORDER(radius_ratio), 0, 1, "0.5",
     "Radius over the parent's radius where they join.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"spacing_m", WD_KEY_FLOAT, ORDER(spacing_m), 0, 20, "0.4",
     "Distance between branches along the parent at the typical height, in metres.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"wander", WD_KEY_FLOAT, ORDER(wander), 0, 6, "0.3", "Random bending, radians per metre."},
    {"upturn", WD_KEY_FLOAT, ORDER(upturn), -3, 3, "0",
     "Bending toward the light (positive) or by weight (negative), radians per metre."},
    {"tip_upturn", WD_KEY_FLOAT, ORDER(tip_upturn), -3, 3, "0",
     "The same at the tip of the branch, radians per metre."},
    {"start", WD_KEY_FLOAT, ORDER(start), 0, 0.95, "0.2",
     "Bare share of the parent branch below its first branch; the crown's base for limbs."},
    {"flatness", WD_KEY_FLOAT, ORDER(flatness), 0, 1, "0.4",
     "0: branches all around the parent; 1: in one flat spray."},
    {0},
};
static const struct wd_keys order_table = {"branch order", order_keys,
                                           sizeof(struct wd_branch_order), NULL};

static const struct wd_key leaf_keys[] = {
    {"shape", WD_KEY_ENUM, IN(leaf, shape), .fallback = "\"ovate\"",
     .doc = "Outline of a leaf; needles come as shoots.", .choices = leaf_shapes},
    {"phyllotaxis", WD_KEY_ENUM, IN(leaf, phyllotaxis), .fallback = "\"alternate\"",
     .doc = "How leaves sit on a twig.", .choices = phyllotaxes},
    {"length_cm", WD_KEY_FLOAT, IN(leaf, length_cm), 0, 300, "8",
     "Length of a leaf or needle in centimetres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"width_cm", WD_KEY_FLOAT, IN(leaf, width_cm), 0, 300, "5",
     "Width of a leaf or needle in centimetres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"droop", WD_KEY_FLOAT, IN(leaf, droop), 0, 1, "0.3", "0 flat to the light, 1 hanging."},
    {"count", WD_KEY_INTEGER, IN(leaf, count), 1, 2000000, "20000",
     "Leaves (or needle shoots) drawn on a tree of typical height."},
    {"area_index", WD_KEY_FLOAT, IN(leaf, area_index), 0, 15, "4",
     "Leaf area, one side, over the area of the crown's projection.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"color", WD_KEY_COLOR, IN(leaf, color), .fallback = "[0.05, 0.1, 0.04]",
     .doc = "Colour of the upper side (linear albedo)."},
    {"back_color", WD_KEY_COLOR, IN(leaf, back_color), .fallback = "[0.08, 0.13, 0.07]",
     .doc = "Colour of the lower side (linear albedo)."},
    {"transmittance", WD_KEY_COLOR, IN(leaf, transmittance), .fallback = "[0.03, 0.11, 0.01]",
     .doc = "Light let through (linear)."},
    {"color_spread", WD_KEY_FLOAT, IN(leaf, color_spread), 0, 1, "0.2",
     "Spread of brightness and hue between trees."},
    {0},
};
static const struct wd_keys leaf_table = {"leaf", leaf_keys, SIZE(leaf), NULL};

static const struct wd_key bark_keys[] = {
    {"pattern", WD_KEY_ENUM, IN(bark, pattern), .fallback = "\"fissured\"",
     .doc = "Pattern of the bark.", .choices = bark_patterns},
    {"color", WD_KEY_COLOR, IN(bark, color), .fallback = "[0.15, 0.12, 0.09]",
     .doc = "Colour of the plates (linear albedo)."},
    {"crack_color", WD_KEY_COLOR, IN(bark, crack_color), .fallback = "[0.05, 0.04, 0.03]",
     .doc = "Colour of the cracks (linear albedo)."},
    {"upper_color", WD_KEY_COLOR, IN(bark, upper_color), .fallback = "[0.15, 0.12, 0.09]",
     .doc = "Colour of the stem's upper part (linear albedo)."},
    {"twig_color", WD_KEY_COLOR, IN(bark, twig_color), .fallback = "[0.12, 0.09, 0.07]",
     .doc = "Colour of twigs (linear albedo)."},
    {"upper_from", WD_KEY_FLOAT, IN(bark, upper_from), 0, 1, "0.5",
     "Share of the height where the upper colour begins to show."},
    {"scale_cm", WD_KEY_FLOAT, IN(bark, scale_cm), 0, 100, "5",
     "Size of one plate or fissure in centimetres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {0},
};
static const struct wd_keys bark_table = {"bark", bark_keys, SIZE(bark), NULL};

#define ALLOMETRY(member) offsetof(struct wd_allometry, member)
static const struct wd_key allometry_keys[] = {
    {"height_a", WD_KEY_DOUBLE, ALLOMETRY(height_a), 0, 150,
     .doc = "Height above 1.3 m that the largest trees tend to, in metres.",
     .flags = WD_KEY_REQUIRED | WD_KEY_EXCLUSIVE_MIN},
    {"height_b", WD_KEY_DOUBLE, ALLOMETRY(height_b), 0, 2,
     .doc = "Rate of h = 1.3 + a (1 - exp(-b d))^c, per centimetre of stem diameter.",
     .flags = WD_KEY_REQUIRED | WD_KEY_EXCLUSIVE_MIN},
    {"height_c", WD_KEY_DOUBLE, ALLOMETRY(height_c), 0, 10, "1",
     "Exponent of h = 1.3 + a (1 - exp(-b d))^c.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"crown_a", WD_KEY_DOUBLE, ALLOMETRY(crown_a), 0, 30, "0.5",
     "Crown diameter of the thinnest stems, in metres: w = a + b d^c."},
    {"crown_b", WD_KEY_DOUBLE, ALLOMETRY(crown_b), 0, 10, "0.15",
     "Growth of the crown's diameter with the stem's, metres per centimetre^c.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"crown_c", WD_KEY_DOUBLE, ALLOMETRY(crown_c), 0, 2, "1", "Exponent of w = a + b d^c.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"source", WD_KEY_STRING, ALLOMETRY(source), .doc = "Where the figures are from."},
    {0},
};
static const struct wd_keys allometry_table = {"allometry", allometry_keys,
                                               sizeof(struct wd_allometry), NULL};

static const struct wd_key species_keys[] = {
    {"name", WD_KEY_STRING, FIELD(name), .doc = "Short name, as scenes use it: \"spruce\".",
     .flags = WD_KEY_REQUIRED},
    {"latin", WD_KEY_STRING, FIELD(latin), .doc = "Botanical name: \"Picea abies\".",
     .flags = WD_KEY_REQUIRED},
    {"citation", WD_KEY_STRING, FIELD(citation), .doc = "Where form and colours are from."},
    {"form", WD_KEY_ENUM, FIELD(form), .doc = "Broadleaf or conifer.", .choices = forms,
     .flags = WD_KEY_REQUIRED},
    {"typical_height_m", WD_KEY_FLOAT, FIELD(typical_height_m), 0.3, 120,
     .doc = "Height of a grown tree in a forest, in metres.", .flags = WD_KEY_REQUIRED},
    {"height_range_m", WD_KEY_RANGE, FIELD(height_range_m), 0.1, 130, "[0.5, 40]",
     "Heights that trees of this species may have, in metres."},
    {"crown_base_forest", WD_KEY_FLOAT, FIELD(crown_base_forest), 0, 0.95, "0.5",
     "Share of the height that is clear stem in a forest."},
    {"crown_base_open", WD_KEY_FLOAT, FIELD(crown_base_open), 0, 0.95, "0.15",
     "Share of the height that is clear stem in the open."},
    {"crown_shape", WD_KEY_FLOATS, FIELD(crown_shape), 0, 1, "[0.6, 1, 0.8, 0.05]",
     "Crown radius as a share of the widest, at 0, 1/3, 2/3 and 1 of the crown from its base.",
     .length = 4},
    {"crown_lobes", WD_KEY_FLOAT, FIELD(crown_lobes), 0, 0.6, "0.15",
     "Depth of the crown's bulges as a share of its radius."},
    {"crown_open", WD_KEY_FLOAT, FIELD(crown_open), 1, 4, "1.4",
     "Crown diameter in the open over that in a forest, for the same stem."},
    {"stem_open", WD_KEY_FLOAT, FIELD(stem_open), 1, 4, "1.4",
     "Stem diameter in the open over that in a forest, for the same height."},
    {"trunk_wander", WD_KEY_FLOAT, FIELD(trunk_wander), 0, 2, "0.03",
     "Random bending of the trunk, radians per metre."},
    {"apical_dominance", WD_KEY_FLOAT, FIELD(apical_dominance), 0, 1, "0.6",
     "1: one leader to the top; 0: the trunk dissolves into limbs."},
    {"root_flare", WD_KEY_FLOAT, FIELD(root_flare), 1, 5, "1.5",
     "Stem radius at the ground over that at 1.3 m."},
    {"whorl", WD_KEY_INTEGER, FIELD(whorl), 1, 12, "1",
     "Branches at one height: 1 single, 4 to 6 for conifers."},
    {"orders", WD_KEY_LIST, FIELD(orders), .table = &order_table,
     .doc = "One entry for each order of branches: limbs, branches, twigs.",
     .count_offset = FIELD(order_count), .flags = WD_KEY_REQUIRED},
    {"leaf", WD_KEY_OBJECT, FIELD(leaf), .table = &leaf_table, .doc = "Leaves or needle shoots."},
    {"bark", WD_KEY_OBJECT, FIELD(bark), .table = &bark_table, .doc = "Bark."},
    {"allometry", WD_KEY_OBJECT, FIELD(allometry), .table = &allometry_table,
     .doc = "Height and crown from stem diameter.", .flags = WD_KEY_REQUIRED},
    {"flexibility", WD_KEY_FLOAT, FIELD(flexibility), 0, 0.3, "0.02",
     "Displacement of the top over the height in a wind of 10 m/s."},
    {0},
};

static bool check_species(void *object, const struct wd_keys_place *place)
{
    struct wd_species *species = object;
    if (species->order_count < 1 || species->order_count > 3)
        return wd_keys_error(place, "orders", "found %zu orders of branches; allowed are 1 to 3",
                             species->order_count);
    if (species->typical_height_m < species->height_range_m[0] ||
        species->typical_height_m > species->height_range_m[1])
        return wd_keys_error(place, "typical_height_m", "found %g; height_range_m allows %g to %g",
                             (double)species->typical_height_m, (double)species->height_range_m[0],
                             (double)species->height_range_m[1]);
    return true;
}

const struct wd_keys wd_species_keys = {"species", species_keys, sizeof(struct wd_species),
                                        check_species};
