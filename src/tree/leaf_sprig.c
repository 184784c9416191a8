#include "tree/leaf_sprig.h"

/* --- places ------------------------------------------------------------------------------ */

float wd_sprig_reach(int count)
{
    return fmaxf(1 - 0.6f / sqrtf((float)count), 0.35f);
}

struct wd_vec3 wd_sprig_axis(float at)
{
    return WD_V3(0, at, -0.1f * at * at);
}

/* The n-th leaf's way off the twig: in two ranks, or in crossed pairs. */
static struct wd_vec3 leaf_side(const struct wd_species *species, int n)
{
    float turn = (float)(n & 1) * (float)WD_PI;
    if (species->leaf.phyllotaxis == WD_PHYLLOTAXIS_OPPOSITE)
        turn += (float)(n >> 1 & 1) * 0.5f * (float)WD_PI;
    return wd_v3_turn(WD_V3(1, 0, 0), WD_V3(0, 0, 1), turn);
}

struct wd_blade_place wd_sprig_place(const struct wd_species *species, struct wd_random *random,
                                     int i, int count)
{
    float length = 1 / sqrtf((float)count), reach = wd_sprig_reach(count);
    bool pairs = species->leaf.phyllotaxis != WD_PHYLLOTAXIS_ALTERNATE, last = i == count - 1;
    float hang = wd_maxf(species->leaf.droop - 0.3f, 0); /* on long stalks, every way */
    float step = pairs ? (float)(i & ~1) + 0.5f : (float)i;
    float at = last ? reach : reach * (0.15f + 0.8f * step / (float)count);
    struct wd_vec3 side = last ? WD_V3(0, 0, 0) : leaf_side(species, i);
    struct wd_vec3 along = wd_v3_mad(WD_V3(0, 0.75f, -0.1f), side, 0.8f);
    along = wd_v3_unit(wd_v3_mad(along, wd_random_vec3(random), 0.22f + 1.2f * hang));
    struct wd_vec3 up = wd_v3_mad(WD_V3(0, 0.15f, 1), wd_random_vec3(random), 0.35f);
    return wd_blade_place(wd_sprig_axis(at), along, up,
                          length * wd_random_range(random, 0.85f, 1.12f), 1);
}

/* --- triangles --------------------------------------------------------------------------- */

/* A leaf as one triangle with the outline's area: its base where the blade is widest, at the foot or
 * near the tip. */
static void add_wedge(struct wd_leaf_template *leaf, const struct wd_leaf_outline *outline,
                      const struct wd_blade_place *place)
{
    float widest = wd_leaf_outline_widest(outline), base = widest < 0.5f ? 0 : 1;
    float half = place->width * wd_leaf_outline_area(outline);
    float stiff[2] = {wd_mixf(place->stiff, 1, base), wd_mixf(place->stiff, 1, 1 - base)};
    struct wd_vec3 p = wd_v3_mad(place->foot, place->along, place->length * base);
    struct wd_vec3 apex = wd_v3_mad(place->foot, place->along, place->length * (1 - base));
    uint32_t right = wd_leaf_add_corner(leaf, wd_v3_mad(p, place->across, half), place->above, 1,
                                        widest, stiff[0]);
    uint32_t left = wd_leaf_add_corner(leaf, wd_v3_mad(p, place->across, -half), place->above, 0,
                                       widest, stiff[0]);
    uint32_t tip = wd_leaf_add_corner(leaf, apex, place->above, 0.5f, 1 - base, stiff[1]);
    wd_leaf_add_triangle(leaf, base > 0 ? right : left, base > 0 ? left : right, tip);
}

/* Width of a blade, or leaflet, over its length. */
static float slimness(const struct wd_species *species)
{
    struct wd_leaf_size size = wd_leaf_blade_size(species);
    return size.width_m / size.length_m;
}

void wd_leaf_sprig_init(struct wd_leaf_template *leaf, const struct wd_species *species,
                        struct wd_sprig sprig, uint32_t variant)
{
    const struct wd_leaf_outline *outline = wd_leaf_outline_of(species);
    bool compound = species->leaf.compound != WD_COMPOUND_SIMPLE;
    float stalk = compound ? 0.1f : fminf(species->leaf.stalk_cm / species->leaf.length_cm, 0.8f);
    struct wd_random random = wd_random_of(variant, 0x5b71);
    *leaf = (struct wd_leaf_template){0};
    for (uint32_t i = 0; i < sprig.leaves; i++) {
        struct wd_blade_place place = wd_sprig_place(species, &random, (int)i, (int)sprig.leaves);
        place.foot = wd_v3_mad(place.foot, place.along, stalk * place.length);
        place.length *= 1 - stalk;
        place.width = place.length * slimness(species);
        place.stiff = 0.4f;
        if (sprig.triangles > 1)
            wd_leaf_add_kite(leaf, outline, &place);
        else
            add_wedge(leaf, outline, &place);
    }
    struct wd_leaf_template whole;
    wd_leaf_template_init(&whole, species, WD_LEAF_AS_BLADE, variant);
    wd_leaf_template_scale(leaf, wd_leaf_template_area(&whole));
    wd_leaf_template_finish(&whole);
}
