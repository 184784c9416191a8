#include "scene/species.h"

#include <math.h>

#include "base/dmath.h"

#define FIELD(member) offsetof(struct wd_species, member)
#define IN(group, member) (offsetof(struct wd_species, group.member) - FIELD(group))
#define SIZE(group) sizeof(((struct wd_species *)0)->group)

static const char *const forms[] = {"broadleaf", "conifer", "palm", "shrub", "fern", "grass",
                                    "bramble", "snag", "falling", NULL};
static const char *const phyllotaxes[] = {"alternate", "opposite", "whorled", NULL};
static const char *const leaf_shapes[] = {"ovate", "lobed", "triangular", "palmate", "lanceolate",
                                          "heart", "elliptic", "blade", "needles", "serrate",
                                          NULL};
static const char *const compounds[] = {"simple", "pinnate", "palmate", "bipinnate", NULL};
static const char *const needle_sets[] = {"around", "fascicles", "tufts", NULL};
static const char *const bark_patterns[] = {"fissured", "scaly", "smooth", "birch", "ringed",
                                            "bare", NULL};

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

static const struct wd_key stems_keys[] = {
    {"count", WD_KEY_INTEGER, IN(stems, count), 1, 200, "1",
     "1 for a tree; more for the stems of a shrub or the canes of a bramble."},
    {"lean_deg", WD_KEY_RANGE, IN(stems, lean_deg), 0, 85, "[0, 0]",
     "Lean at the foot, in degrees from the vertical: of the innermost and outermost stem."},
    {"upturn", WD_KEY_FLOATS, IN(stems, upturn), -4, 4, "[0, 0]",
     "Bending up (positive) or over (negative) along a stem's lower and upper half, in radians.",
     .length = 2},
    {"spread_m", WD_KEY_FLOAT, IN(stems, spread_m), 0, 5, "0",
     "Radius of the stool that the stems stand on, in metres."},
    {0},
};
static const struct wd_keys stems_table = {"stems", stems_keys, SIZE(stems), NULL};

static const struct wd_key buttress_keys[] = {
    {"count", WD_KEY_INTEGER, IN(buttress, count), 0, 12, "0", "Number of buttress roots."},
    {"height", WD_KEY_FLOAT, IN(buttress, height), 0, 0.5, "0.1",
     "Share of the tree's height that they climb."},
    {"reach", WD_KEY_FLOAT, IN(buttress, reach), 0.5, 8, "2",
     "How far they run from the stem's middle, in stem diameters."},
    {0},
};
static const struct wd_keys buttress_table = {"buttress", buttress_keys, SIZE(buttress), NULL};

static const struct wd_key decay_keys[] = {
    {"broken_at", WD_KEY_FLOAT, IN(decay, broken_at), 0.1, 1, "1",
     "Share of the stem that still stands; 1 is whole."},
    {"limbs", WD_KEY_FLOAT, IN(decay, limbs), 0, 1, "1", "Share of the limbs still there."},
    {"bark", WD_KEY_FLOAT, IN(decay, bark), 0, 1, "1",
     "Share of the wood that bark still covers."},
    {0},
};
static const struct wd_keys decay_table = {"decay", decay_keys, SIZE(decay), NULL};

static const struct wd_key leaf_keys[] = {
    {"shape", WD_KEY_ENUM, IN(leaf, shape), .fallback = "\"ovate\"",
     .doc = "Outline of a leaf or of a compound leaf's leaflets; needles come as shoots.",
     .choices = leaf_shapes},
    {"compound", WD_KEY_ENUM, IN(leaf, compound), .fallback = "\"simple\"",
     .doc = "How leaflets stand: in rows, from one point, or as a fern's twice divided frond.",
     .choices = compounds},
    {"leaflets", WD_KEY_INTEGER, IN(leaf, leaflets), 1, 400, "1",
     "Leaflets of a compound leaf; pinnae of a bipinnate frond."},
    {"leaflet_length_cm", WD_KEY_FLOAT, IN(leaf, leaflet_length_cm), 0, 300, "5",
     "Length of the longest leaflet or pinna in centimetres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"leaflet_width_cm", WD_KEY_FLOAT, IN(leaf, leaflet_width_cm), 0, 100, "2",
     "Width of the longest leaflet or pinna in centimetres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"stalk_cm", WD_KEY_FLOAT, IN(leaf, stalk_cm), 0, 300, "0",
     "Bare foot of a leaf, part of its length, in centimetres."},
    {"arch", WD_KEY_FLOAT, IN(leaf, arch), -1, 4, "0",
     "Downward bend of a blade or a leaf in rows of leaflets from its foot to its tip, in radians."},
    {"phyllotaxis", WD_KEY_ENUM, IN(leaf, phyllotaxis), .fallback = "\"alternate\"",
     .doc = "How leaves sit on a twig.", .choices = phyllotaxes},
    {"needles", WD_KEY_ENUM, IN(leaf, needles), .fallback = "\"around\"",
     .doc = "How needles stand: singly around the shoot, in bundles, or in tufts on short shoots.",
     .choices = needle_sets},
    {"bundle", WD_KEY_INTEGER, IN(leaf, bundle), 1, 80, "1",
     "Needles of one bundle or tuft: 2 for Scots pine, 30 for larch."},
    {"shoot_cm", WD_KEY_FLOAT, IN(leaf, shoot_cm), 0, 100, "10",
     "Length of the needle-bearing shoot that is drawn as one leaf, in centimetres.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"length_cm", WD_KEY_FLOAT, IN(leaf, length_cm), 0, 1000, "8",
     "Length of a leaf, with its stalk, or of a needle, in centimetres.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"width_cm", WD_KEY_FLOAT, IN(leaf, width_cm), 0, 300, "5",
     "Width of a leaf or needle in centimetres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"droop", WD_KEY_FLOAT, IN(leaf, droop), 0, 1, "0.3", "0 flat to the light, 1 hanging."},
    {"count", WD_KEY_INTEGER, IN(leaf, count), 0, 2000000, "20000",
     "Leaves (or needle shoots) drawn on a tree of typical height; 0: bare twigs as in winter, of snags none."},
    {"area_index", WD_KEY_FLOAT, IN(leaf, area_index), 0, 15, "4",
     "Leaf area, one side, over the area of the crown's projection.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"color", WD_KEY_COLOR, IN(leaf, color), .fallback = "[0.066, 0.111, 0.034]",
     .doc = "Colour of the upper side (linear albedo)."},
    {"back_color", WD_KEY_COLOR, IN(leaf, back_color), .fallback = "[0.1, 0.15, 0.065]",
     .doc = "Colour of the lower side (linear albedo)."},
    {"transmittance", WD_KEY_COLOR, IN(leaf, transmittance), .fallback = "[0.06, 0.106, 0.012]",
     .doc = "Light let through (linear)."},
    {"spring_color", WD_KEY_COLOR, IN(leaf, spring_color), .fallback = "[0.14, 0.178, 0.034]",
     .doc = "Colour of the upper side just unfolded (linear albedo)."},
    {"autumn_color", WD_KEY_COLOR, IN(leaf, autumn_color), .fallback = "[0.3, 0.17, 0.03]",
     .doc = "Colour of the upper side before the fall (linear albedo)."},
    {"color_spread", WD_KEY_FLOAT, IN(leaf, color_spread), 0, 1, "0.2",
     "Spread of brightness and hue between trees."},
    {"gloss", WD_KEY_FLOAT, IN(leaf, gloss), 0, 1, "0.4",
     "Gloss of the upper side: 0 dull, 1 waxed."},
    {"evergreen", WD_KEY_BOOL, IN(leaf, evergreen), .fallback = "false",
     .doc = "Leaves stay and keep their colour through the year."},
    {"months", WD_KEY_FLOATS, IN(leaf, months), 1, 13, "[4.5, 11]",
     "When leaves unfold and when the last ones fall: 4.5 is mid-April. North of the equator, as all months "
     "here: south of it scenes turn them by half a year.", .length = 2},
    {"flexibility", WD_KEY_FLOAT, IN(leaf, flexibility), 0, 3, "0.4",
     "Turn of a leaf in a wind of 10 m/s, in radians."},
    {0},
};
static const struct wd_keys leaf_table = {"leaf", leaf_keys, SIZE(leaf), NULL};

static const struct wd_key flower_keys[] = {
    {"count", WD_KEY_INTEGER, IN(flower, count), 0, 20000, "0",
     "Flowers (or panicles, plumes) of a plant of typical height; 0 where none are to be seen. The more petals, the "
     "fewer are drawn: some 3,800 of 5 petals, 950 of 20."},
    {"size_cm", WD_KEY_FLOAT, IN(flower, size_cm), 0, 100, "5",
     "Diameter of a flower, length of a panicle or plume, in centimetres.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"petals", WD_KEY_INTEGER, IN(flower, petals), 0, 60, "5",
     "Petals; 0 for a panicle, catkin or plume."},
    {"hang", WD_KEY_FLOAT, IN(flower, hang), 0, 1, "0",
     "Of what has no petals: 0 a panicle that stands up, 1 a slender catkin that hangs."},
    {"color", WD_KEY_COLOR, IN(flower, color), .fallback = "[0.7, 0.68, 0.62]",
     .doc = "Colour of the petals (linear albedo)."},
    {"center_color", WD_KEY_COLOR, IN(flower, center_color), .fallback = "[0.55, 0.38, 0.05]",
     .doc = "Colour of the middle (linear albedo)."},
    {"months", WD_KEY_FLOATS, IN(flower, months), 1, 13, "[5, 6]",
     "First and last month of the flowers: 5 ends with May, 5.4 within it; may run over the new year.", .length = 2},
    {0},
};
static const struct wd_keys flower_table = {"flower", flower_keys, SIZE(flower), NULL};

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
     "Size of one plate, fissure or ring in centimetres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"moss", WD_KEY_FLOAT, IN(bark, moss), 0, 1, "0.25",
     "Share of the stem's foot that moss covers."},
    {0},
};
static const struct wd_keys bark_table = {"bark", bark_keys, SIZE(bark), NULL};

#define ALLOMETRY(member) offsetof(struct wd_allometry, member)
static const struct wd_key allometry_keys[] = {
    {"height_a", WD_KEY_DOUBLE, ALLOMETRY(height_a), 0, 150,
     .doc = "Height above diameter_at_m that the largest trees tend to, in metres.",
     .flags = WD_KEY_REQUIRED | WD_KEY_EXCLUSIVE_MIN},
    {"height_b", WD_KEY_DOUBLE, ALLOMETRY(height_b), 0, 20,
     .doc = "Rate of h = diameter_at_m + a (1 - exp(-b d))^c, per centimetre of stem diameter.",
     .flags = WD_KEY_REQUIRED | WD_KEY_EXCLUSIVE_MIN},
    {"height_c", WD_KEY_DOUBLE, ALLOMETRY(height_c), 0, 10, "1",
     "Exponent of h = diameter_at_m + a (1 - exp(-b d))^c.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"diameter_at_m", WD_KEY_DOUBLE, ALLOMETRY(diameter_at_m), 0, 1.3, "1.3",
     "Height where the stem's diameter is taken, in metres; 0 for low plants."},
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

#define GROWTH(member) offsetof(struct wd_site_curve, member)
static const struct wd_key growth_keys[] = {
    {"height_a", WD_KEY_DOUBLE, GROWTH(height_a), 0, 150,
     .doc = "Height that old trees tend to, in metres: h = a (1 - exp(-b t))^c, t in years. Without it "
            "the greatest that the allometry gives.",
     .flags = WD_KEY_EXCLUSIVE_MIN | WD_KEY_NAN_IF_ABSENT},
    {"height_b", WD_KEY_DOUBLE, GROWTH(height_b), 0, 20, "0.03", "Rate, per year.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"height_c", WD_KEY_DOUBLE, GROWTH(height_c), 0, 10, "1.3",
     "Exponent of h = a (1 - exp(-b t))^c.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"span_years", WD_KEY_DOUBLE, GROWTH(span_years), 0, 5000, "200",
     "Greatest age that the curve is for, in years.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"source", WD_KEY_STRING, GROWTH(source), .doc = "Where the figures are from."},
    {0},
};
static const struct wd_keys growth_table = {"growth", growth_keys, sizeof(struct wd_site_curve),
                                            NULL};

static const struct wd_key habitat_keys[] = {
    {"region", WD_KEY_STRING, IN(habitat, region), .doc = "Where the species is at home."},
    {"altitude_m", WD_KEY_RANGE, IN(habitat, altitude_m), -500, 6000, "[0, 1500]",
     "Altitudes where it grows, in metres."},
    {"moisture", WD_KEY_RANGE, IN(habitat, moisture), 0, 1, "[0.3, 0.7]",
     "Moisture of the soil it stands: 0 dry, 1 wet."},
    {"light", WD_KEY_FLOAT, IN(habitat, light), 0, 1, "0.5",
     "Light it needs: 0 endures deep shade, 1 grows only in full light."},
    {0},
};
static const struct wd_keys habitat_table = {"habitat", habitat_keys, SIZE(habitat), NULL};

static const struct wd_key species_keys[] = {
    {"name", WD_KEY_STRING, FIELD(name), .doc = "Short name, as scenes use it: \"spruce\".",
     .flags = WD_KEY_REQUIRED},
    {"latin", WD_KEY_STRING, FIELD(latin), .doc = "Botanical name: \"Picea abies\".",
     .flags = WD_KEY_REQUIRED},
    {"citation", WD_KEY_STRING, FIELD(citation), .doc = "Where form and colours are from."},
    {"form", WD_KEY_ENUM, FIELD(form), .doc = "Growth form.", .choices = forms,
     .flags = WD_KEY_REQUIRED},
    {"typical_height_m", WD_KEY_FLOAT, FIELD(typical_height_m), 0.1, 120,
     .doc = "Height of a grown tree in a forest, in metres.", .flags = WD_KEY_REQUIRED},
    {"height_range_m", WD_KEY_RANGE, FIELD(height_range_m), 0.02, 130, "[0.5, 40]",
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
    {"stems", WD_KEY_OBJECT, FIELD(stems), .table = &stems_table,
     .doc = "How many stems rise from one root, and how they lean."},
    {"buttress", WD_KEY_OBJECT, FIELD(buttress), .table = &buttress_table,
     .doc = "Buttress roots."},
    {"decay", WD_KEY_OBJECT, FIELD(decay), .table = &decay_table,
     .doc = "What a dead tree has lost."},
    {"orders", WD_KEY_LIST, FIELD(orders), .table = &order_table,
     .doc = "One entry for each order of branches: limbs, branches, twigs; palms, ferns, "
            "grasses and falling leaves have none.",
     .count_offset = FIELD(order_count)},
    {"leaf", WD_KEY_OBJECT, FIELD(leaf), .table = &leaf_table, .doc = "Leaves or needle shoots."},
    {"flower", WD_KEY_OBJECT, FIELD(flower), .table = &flower_table, .doc = "Flowers."},
    {"bark", WD_KEY_OBJECT, FIELD(bark), .table = &bark_table, .doc = "Bark."},
    {"allometry", WD_KEY_OBJECT, FIELD(allometry), .table = &allometry_table,
     .doc = "Height and crown from stem diameter.", .flags = WD_KEY_REQUIRED},
    {"growth", WD_KEY_OBJECT, FIELD(growth), .table = &growth_table, .doc = "Height from age."},
    {"habitat", WD_KEY_OBJECT, FIELD(habitat), .table = &habitat_table,
     .doc = "Where it grows."},
    {"flexibility", WD_KEY_FLOAT, FIELD(flexibility), 0, 0.3, "0.02",
     "Displacement of the top over the height in a wind of 10 m/s."},
    {0},
};

static bool check_orders(const struct wd_species *species, const struct wd_keys_place *place)
{
    bool bare = species->form == WD_FORM_PALM || species->form == WD_FORM_FERN ||
                species->form == WD_FORM_GRASS || species->form == WD_FORM_FALLING;
    if (bare && species->order_count > 0)
        return wd_keys_error(place, "orders", "found %zu orders of branches; a %s has none",
                             species->order_count, forms[species->form]);
    if (!bare && !species->orders)
        return wd_keys_error(place, NULL, "\"orders\" is missing; a %s has 1 to 3 orders of branches: "
                             "[ { ... }, ... ]", forms[species->form]);
    if (!bare && (species->order_count < 1 || species->order_count > 3))
        return wd_keys_error(place, "orders", "found %zu orders of branches; a %s has 1 to 3",
                             species->order_count, forms[species->form]);
    return true;
}

static bool check_leaf(const struct wd_species *species, const struct wd_keys_place *place)
{
    const struct wd_keys_place leaf = {place->reader, place, "leaf", 0};
    bool needles = species->leaf.shape == WD_LEAF_NEEDLES;
    bool compound = species->leaf.compound != WD_COMPOUND_SIMPLE;
    if (needles && compound)
        return wd_keys_error(&leaf, "compound", "found \"%s\"; needles are simple",
                             compounds[species->leaf.compound]);
    if (compound && species->leaf.leaflets < 2)
        return wd_keys_error(&leaf, "compound", "a %s leaf needs leaflets, 2 or more",
                             compounds[species->leaf.compound]);
    if (species->leaf.stalk_cm >= species->leaf.length_cm)
        return wd_keys_error(&leaf, "stalk_cm", "found %g; allowed is less than length_cm, %g",
                             (double)species->leaf.stalk_cm, (double)species->leaf.length_cm);
    if (!species->leaf.evergreen && species->leaf.months[0] >= species->leaf.months[1])
        return wd_keys_error(&leaf, "months", "leaves unfold in month %g and fall in month %g; "
                                              "the first must be less, as north of the equator",
                             (double)species->leaf.months[0], (double)species->leaf.months[1]);
    return true;
}

/* A tree that its own curves never reach has a stem and an age that say nothing. */
static void check_curves(struct wd_species *species, const struct wd_keys_place *place)
{
    const struct wd_keys_place allometry = {place->reader, place, "allometry", 0};
    const struct wd_keys_place growth = {place->reader, place, "growth", 0};
    double typical_m = (double)species->typical_height_m;
    double most_m = species->allometry.height_a + species->allometry.diameter_at_m;
    if (isnan(species->growth.height_a))
        species->growth.height_a = fmax(most_m, typical_m);
    if (most_m < typical_m)
        wd_keys_warn(&allometry, "height_a", "found %g; no stem is thick enough for typical_height_m, %g",
                     species->allometry.height_a, typical_m);
    if (species->growth.height_a < typical_m)
        wd_keys_warn(&growth, "height_a", "found %g; no tree grows old enough for typical_height_m, %g",
                     species->growth.height_a, typical_m);
}

/* Drawn leaves have the crown's leaf area among them: far too few are giants. Needles come as shoots. */
static void check_leaf_count(const struct wd_species *species, const struct wd_keys_place *place)
{
    const struct wd_keys_place leaf = {place->reader, place, "leaf", 0};
    enum { MOST_TIMES = 6 };
    double crown_m = wd_species_crown_of_height_m(species, (double)species->typical_height_m);
    double length_m = 0.01 * (double)species->leaf.length_cm, width_m = 0.01 * (double)species->leaf.width_cm;
    double area_m2 = (double)species->leaf.area_index * WD_PI / 4 * crown_m * crown_m;
    double times = sqrt(area_m2 / ((double)species->leaf.count * 0.6 * length_m * width_m));
    if (species->order_count > 0 && species->leaf.shape != WD_LEAF_NEEDLES && species->leaf.count > 0 &&
        times > MOST_TIMES)
        wd_keys_warn(&leaf, "count", "found %lld; to have area_index, %g, so few leaves of %g x %g cm are drawn %.3g "
                     "times as long", (long long)species->leaf.count, (double)species->leaf.area_index,
                     (double)species->leaf.length_cm, (double)species->leaf.width_cm, times);
}

static bool check_species(void *object, const struct wd_keys_place *place)
{
    struct wd_species *species = object;
    if (!check_orders(species, place) || !check_leaf(species, place))
        return false;
    if (species->typical_height_m < species->height_range_m[0] ||
        species->typical_height_m > species->height_range_m[1])
        return wd_keys_error(place, "typical_height_m", "found %g; height_range_m allows %g to %g",
                             (double)species->typical_height_m, (double)species->height_range_m[0],
                             (double)species->height_range_m[1]);
    const struct wd_keys_place stems = {place->reader, place, "stems", 0};
    if (species->stems.count > 1 && species->form != WD_FORM_SHRUB && species->form != WD_FORM_BRAMBLE)
        wd_keys_warn(&stems, "count", "found %lld; a %s has one stem, shrubs and brambles have several",
                     (long long)species->stems.count, forms[species->form]);
    check_curves(species, place);
    check_leaf_count(species, place);
    return true;
}

const struct wd_keys wd_species_keys = {"species", species_keys, sizeof(struct wd_species),
                                        check_species};
