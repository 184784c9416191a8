#include "tree/fronds.h"

#include "base/memory.h"
#include "tree/look.h"

bool wd_species_has_fronds(const struct wd_species *species)
{
    return species->form == WD_FORM_PALM || species->form == WD_FORM_FERN ||
           species->form == WD_FORM_GRASS || species->form == WD_FORM_FALLING;
}

enum { MAX_FRONDS = 600 };

struct frond {
    float azimuth_rad, rise_rad; /* over the horizon */
    float aside_rad;             /* it leans so far off the way from the stem to its foot */
    float size_m, out_m;         /* length; distance of its foot from the stem's axis */
};

static float radians(float degrees)
{
    return degrees * (float)(WD_PI / 180);
}

/* From the youngest, upright in the middle, to the oldest, hanging: one every golden angle. */
static struct frond palm_frond(const struct wd_tree_form *form, float age, int n,
                               struct wd_random *random)
{
    /* a young palm's oldest fronds cannot hang: the ground is too near */
    float full_m = 0.01f * form->species->leaf.length_cm *
                   wd_mixf(0.62f, 1, wd_minf(form->scale, 1));
    float room = wd_clampf(form->crown_base_m / full_m - 0.4f, 0, 1);
    struct frond frond = {.azimuth_rad = 2.3999632f * (float)n + 0.15f * wd_random_signed(random)};
    frond.rise_rad = radians(wd_mixf(80, wd_mixf(36, -42, room), age) +
                             7 * wd_random_signed(random));
    frond.size_m = full_m * wd_mixf(0.72f, 1, wd_smoothf(0, 0.25f, age)) *
                   wd_random_range(random, 0.93f, 1.04f);
    frond.out_m = 0.35f * form->dbh_m;
    return frond;
}

/* A shuttlecock: fronds of one age in one or two rings, the inner more upright. */
static struct frond fern_frond(const struct wd_tree_form *form, float age, int n,
                               struct wd_random *random)
{
    const float *lean = form->species->stems.lean_deg;
    struct frond frond = {.azimuth_rad = 2.3999632f * (float)n + 0.25f * wd_random_signed(random)};
    frond.rise_rad = radians(90 - wd_mixf(lean[0], lean[1], age) + 6 * wd_random_signed(random));
    frond.size_m = 0.01f * form->species->leaf.length_cm * form->scale *
                   wd_random_range(random, 0.75f, 1.05f);
    frond.out_m = 0.4f * form->dbh_m;
    return frond;
}

/* Blades of all lengths from a disc: a tuft's lean outward, the more the farther out they stand; a
 * sward's, wider than a blade is long, any way. */
static struct frond grass_blade(const struct wd_tree_form *form, float age,
                                struct wd_random *random)
{
    const struct wd_species *species = form->species;
    const float *lean = species->stems.lean_deg;
    struct frond frond = {.azimuth_rad = 2 * (float)WD_PI * wd_random_unit(random)};
    float out = sqrtf(wd_random_unit(random));
    frond.rise_rad = radians(90 - wd_mixf(lean[0], lean[1], 0.7f * out + 0.3f * age) +
                             9 * wd_random_signed(random));
    frond.size_m = 0.01f * species->leaf.length_cm * form->scale *
                   wd_random_range(random, 0.45f, 1.05f);
    frond.out_m = out * wd_maxf(0.5f * form->dbh_m, form->scale * species->stems.spread_m);
    if (species->stems.spread_m > 0.01f * species->leaf.length_cm)
        frond.aside_rad = (float)WD_PI * wd_random_signed(random);
    return frond;
}

static struct wd_vec3 level(float azimuth_rad)
{
    return WD_V3(wd_dcos((double)azimuth_rad), wd_dsin((double)azimuth_rad), 0);
}

/* A leaf on its way down, as it hangs in the air before it moves (shaders/shared/fall.h). */
static void place_falling(struct wd_leaf *leaf, const struct wd_tree_form *form, float share,
                          struct wd_random *random)
{
    const struct wd_species *species = form->species;
    float out = species->stems.spread_m * sqrtf(wd_random_unit(random));
    struct wd_vec3 way = level(2 * (float)WD_PI * wd_random_unit(random));
    leaf->size_m = 0.01f * species->leaf.length_cm * wd_random_range(random, 0.7f, 1.1f);
    leaf->position_m = wd_v3_mad(WD_V3(0, 0, share * (form->height_m - leaf->size_m)), way, out);
    struct wd_vec3 side = level(2 * (float)WD_PI * wd_random_unit(random));
    leaf->axis = side;
    leaf->normal = wd_v3_turn(WD_V3(0, 0, 1), wd_v3_cross(side, WD_V3(0, 0, 1)),
                              (float)WD_PI * wd_random_signed(random));
    leaf->shading = WD_V3(0, 0, 1);
    leaf->flexibility = 0;
}

static void tint_frond(struct wd_leaf *leaf, float age, struct wd_random *random)
{
    float bright = WD_LEAF_TINT_MEAN * (1.06f - 0.14f * age + 0.1f * wd_random_signed(random));
    float warm = 0.12f * (age - 0.5f) + 0.06f * wd_random_signed(random);
    leaf->tint[0] = wd_clampf(bright * (1 + warm), 0, 1);
    leaf->tint[1] = wd_clampf(bright, 0, 1);
    leaf->tint[2] = wd_clampf(bright * (1 - warm), 0, 1);
}

static void place_frond(struct wd_leaf *leaf, const struct wd_skeleton *skeleton,
                        const struct wd_tree_form *form, int n, int of)
{
    const struct wd_branch *stem = &skeleton->branches[0];
    struct wd_random air = wd_random_of(wd_hash3(form->key, 0xf209d, (uint32_t)n), 2);
    if (form->species->form == WD_FORM_FALLING) {
        leaf->key = wd_hash3(form->key, 0xf209d, (uint32_t)n);
        place_falling(leaf, form, (float)n / (float)(of > 1 ? of - 1 : 1), &air);
        tint_frond(leaf, wd_random_unit(&air), &air);
        return;
    }
    bool palm = form->species->form == WD_FORM_PALM, fern = form->species->form == WD_FORM_FERN;
    leaf->key = wd_hash3(form->key, 0xf209d, (uint32_t)n);
    struct wd_random random = wd_random_of(leaf->key, 1);
    float age = ((float)n + wd_random_unit(&random)) / (float)of;
    struct frond frond = palm ? palm_frond(form, age, n, &random)
                         : fern ? fern_frond(form, age, n, &random)
                                : grass_blade(form, age, &random);
    struct wd_vec3 top, out = level(frond.azimuth_rad);
    float share = palm ? 1 - 0.35f * age / (float)stem->node_count : 1;
    size_t node;
    struct wd_vec3 foot = wd_branch_point(skeleton, stem, share, &top, &node);
    if (!palm)
        foot.z = 0;
    leaf->position_m = wd_v3_mad(foot, out, frond.out_m);
    out = level(frond.azimuth_rad + frond.aside_rad);
    leaf->axis = wd_v3_turn(out, WD_V3(0, 0, 1), frond.rise_rad);
    leaf->normal = wd_v3_turn(WD_V3(0, 0, 1), out, -frond.rise_rad);
    /* fronds twist a little about their own axis, blades a lot */
    float twist = palm ? 0.25f : fern ? 0.12f : 0.8f;
    leaf->normal = wd_v3_turn(leaf->normal, wd_v3_cross(leaf->axis, leaf->normal),
                              twist * wd_random_signed(&random));
    leaf->shading = wd_v3_unit(wd_v3_mad(WD_V3(0, 0, 0.8f), out, 0.5f));
    leaf->size_m = frond.size_m;
    leaf->flexibility = skeleton->nodes[node].flexibility;
    tint_frond(leaf, palm ? age : wd_random_unit(&random), &random);
}

/* A frond sags by its arch: the middle of its parts for the grid of leaf area. */
static struct wd_vec3 along_frond(const struct wd_leaf *leaf, float arch_rad, float share)
{
    float angle = 0.5f * arch_rad * share;
    struct wd_vec3 d = wd_v3_turn(leaf->axis, wd_v3_scale(leaf->normal, -1), angle);
    return wd_v3_mad(leaf->position_m, d, leaf->size_m * share);
}

static void light_fronds(struct wd_foliage *foliage, const struct wd_tree_form *form)
{
    float unit = wd_leaf_unit_area(form->species), arch = form->species->leaf.arch;
    for (size_t i = 0; i < foliage->count; i++) {
        struct wd_leaf *leaf = &foliage->leaves[i];
        float area = unit * leaf->size_m * leaf->size_m;
        foliage->area_m2 += area;
        for (int part = 0; part < 4; part++)
            wd_tree_density_add(&foliage->crown,
                                along_frond(leaf, arch, ((float)part + 0.5f) / 4), area / 4);
    }
    wd_tree_density_light(&foliage->crown);
    for (size_t i = 0; i < foliage->count; i++)
        foliage->leaves[i].sky = wd_tree_density_sky(
            &foliage->crown, along_frond(&foliage->leaves[i], arch, 0.6f));
}

void wd_fronds_place(struct wd_foliage *foliage, const struct wd_skeleton *skeleton,
                     const struct wd_tree_form *form)
{
    const struct wd_species *species = form->species;
    double count = (double)species->leaf.count * (double)form->detail;
    if (species->form == WD_FORM_PALM)
        count = (double)species->leaf.count * (double)wd_mixf(0.5f, 1, wd_minf(form->scale, 1));
    count = count > MAX_FRONDS ? MAX_FRONDS : count;
    foliage->count = count < 3 && species->leaf.count > 0 ? 3 : (size_t)count;
    foliage->leaves = wd_alloc_array(foliage->count + 1, sizeof *foliage->leaves);
    for (size_t i = 0; i < foliage->count; i++)
        place_frond(&foliage->leaves[i], skeleton, form, (int)i, (int)foliage->count);
    light_fronds(foliage, form);
}
