#include "tree/leaf_template.h"

#include <stdlib.h>

#include "tree/leaf_parts.h"

void wd_leaf_template_finish(struct wd_leaf_template *leaf)
{
    free(leaf->corners);
    free(leaf->indices);
    *leaf = (struct wd_leaf_template){0};
}

float wd_leaf_template_area(const struct wd_leaf_template *leaf)
{
    float area = 0;
    for (size_t i = 0; i < leaf->index_count; i += 3) {
        struct wd_vec3 a = leaf->corners[leaf->indices[i]].p;
        struct wd_vec3 b = wd_v3_sub(leaf->corners[leaf->indices[i + 1]].p, a);
        struct wd_vec3 c = wd_v3_sub(leaf->corners[leaf->indices[i + 2]].p, a);
        area += 0.5f * wd_v3_length(wd_v3_cross(b, c));
    }
    return area;
}

static struct wd_blade_place whole_leaf(const struct wd_species *species, float from)
{
    return wd_blade_place(WD_V3(0, from, 0), WD_V3(0, 1, 0), WD_V3(0, 0, 1), 1 - from,
                          species->leaf.width_cm / species->leaf.length_cm);
}

static void add_simple(struct wd_leaf_template *leaf, const struct wd_species *species,
                       const struct wd_leaf_outline *outline)
{
    float from = fminf(species->leaf.stalk_cm / species->leaf.length_cm, 0.8f);
    struct wd_blade_place place = whole_leaf(species, from);
    if (from > 0)
        wd_leaf_add_stalk(leaf, WD_V3(0, 0, 0), place.foot, WD_V3(1, 0, 0), 0.025f);
    wd_leaf_add_blade(leaf, outline, &place);
}

static void add_outlined(struct wd_leaf_template *leaf, const struct wd_species *species,
                         const struct wd_leaf_outline *outline, enum wd_leaf_form form, uint32_t variant)
{
    switch (species->leaf.compound) {
    case WD_COMPOUND_PINNATE:
    case WD_COMPOUND_BIPINNATE:
        wd_leaf_add_pinnate(leaf, species, outline, form, variant);
        break;
    case WD_COMPOUND_PALMATE:
        wd_leaf_add_palmate(leaf, species, outline);
        break;
    default:
        if (species->leaf.shape == WD_LEAF_BLADE)
            wd_leaf_add_arching_blade(leaf, species);
        else
            add_simple(leaf, species, outline);
    }
}

void wd_leaf_template_scale(struct wd_leaf_template *leaf, float area)
{
    float own = wd_leaf_template_area(leaf), factor = own > 0 ? sqrtf(area / own) : 1;
    for (size_t i = 0; i < leaf->corner_count; i++)
        leaf->corners[i].p = wd_v3_scale(leaf->corners[i].p, factor);
}

void wd_leaf_template_init(struct wd_leaf_template *leaf, const struct wd_species *species,
                           enum wd_leaf_form form, uint32_t variant)
{
    *leaf = (struct wd_leaf_template){0};
    if (species->leaf.shape == WD_LEAF_NEEDLES) {
        wd_leaf_add_needles(leaf, species, variant);
        return;
    }
    add_outlined(leaf, species, wd_leaf_outline_of(species), WD_LEAF_AS_BLADE, variant);
    if (form == WD_LEAF_AS_BLADE)
        return;
    float area = wd_leaf_template_area(leaf);
    leaf->corner_count = leaf->index_count = 0;
    if (form == WD_LEAF_AS_NEAR) {
        add_outlined(leaf, species, wd_leaf_outline_near(species), WD_LEAF_AS_NEAR, variant);
        wd_leaf_template_scale(leaf, area);
        return;
    }
    struct wd_blade_place place = whole_leaf(species, 0);
    wd_leaf_add_kite(leaf, wd_leaf_outline_of(species), &place);
    wd_leaf_template_scale(leaf, area);
}

/* Petals in rings, the inner ones smaller and steeper. */
static void add_petals(struct wd_leaf_template *flower, int petals, enum wd_leaf_form form)
{
    static const struct wd_leaf_outline petal = {0, {{0.62f, 0.3f}, {1, 0.68f}, {0.6f, 0.96f}}, 3,
                                                 0.2f, -0.18f, WD_VEINS_PARALLEL, 0, 0};
    int rings = petals > 6 ? 2 : 1, each = (petals + rings - 1) / rings;
    for (int i = 0; i < petals; i++) {
        int ring = i / each;
        float angle = 6.2831853f * ((float)(i % each) + 0.5f * (float)ring) / (float)each;
        struct wd_vec3 out = wd_v3_turn(WD_V3(1, 0, 0), WD_V3(0, 1, 0), angle);
        struct wd_vec3 along = wd_v3_unit(wd_v3_add(out, WD_V3(0, 0, 0.3f + 0.7f * (float)ring)));
        float length = 0.5f * (1 - 0.25f * (float)ring);
        struct wd_blade_place place = wd_blade_place(WD_V3(0, 0, 0.02f * (float)ring), along,
                                                     WD_V3(0, 0, 1), length,
                                                     length * (each > 5 ? 0.85f : 1.0f));
        if (form == WD_LEAF_AS_KITE)
            wd_leaf_add_kite(flower, &petal, &place);
        else
            wd_leaf_add_blade(flower, &petal, &place);
    }
}

/* Overlapping scales around an axis that hangs by its foot (z goes down): a slender spindle. */
static void add_catkin(struct wd_leaf_template *flower, int scales)
{
    float longer = 26 / (float)scales;
    for (int i = 0; i < scales; i++) {
        float t = ((float)i + 0.5f) / (float)scales, angle = (float)i * 2.3999632f;
        float radius = 0.075f * (1 - 0.5f * t * t);
        struct wd_vec3 out = wd_v3_turn(WD_V3(1, 0, 0), WD_V3(0, 1, 0), angle);
        struct wd_vec3 p = wd_v3_add(wd_v3_scale(out, 0.3f * radius), WD_V3(0, 0, 0.9f * t));
        struct wd_vec3 d = wd_v3_unit(wd_v3_add(wd_v3_scale(out, 0.45f), WD_V3(0, 0, 1)));
        wd_leaf_add_needle(flower, p, d, wd_v3_unit(wd_v3_cross(d, out)), 0.16f * longer,
                           2.2f * radius);
    }
}

/* A straw: a strip of two triangles. */
static void add_straw(struct wd_leaf_template *flower, float length, float width)
{
    struct wd_vec3 n = WD_V3(0, 1, 0);
    uint32_t corners[4];
    for (int i = 0; i < 4; i++) {
        float x = (i & 1 ? -0.5f : 0.5f) * width * (i < 2 ? 1 : 0.6f);
        corners[i] = wd_leaf_add_corner(flower, WD_V3(x, 0, i < 2 ? 0 : length), n, 0.5f, 0.06f,
                                        i < 2 ? 0 : 0.5f);
    }
    wd_leaf_add_triangle(flower, corners[0], corners[2], corners[1]);
    wd_leaf_add_triangle(flower, corners[1], corners[2], corners[3]);
}

/* The ear of a grass: florets in dense clusters left and right of a straw, the lowest on short
 * branches of their own, the upper ones grown together. */
static void add_ear(struct wd_leaf_template *flower, float stalk, int florets)
{
    enum { CLUSTERS = 6 };
    float larger = sqrtf(26 / (float)florets);
    add_straw(flower, stalk + 0.6f, 0.024f);
    for (int i = 0; i < florets; i++) {
        int cluster = i % CLUSTERS;
        float t = (float)cluster / CLUSTERS, angle = (float)i * 2.3999632f;
        struct wd_vec3 aside = wd_v3_turn(WD_V3(1, 0, 0), WD_V3(0, 1, 0),
                                          (float)WD_PI * ((float)cluster + 0.2f * (float)(i % 5)));
        struct wd_vec3 out = wd_v3_turn(WD_V3(1, 0, 0), WD_V3(0, 1, 0), angle);
        float along = (float)(i / CLUSTERS) * (float)CLUSTERS / (float)florets;
        struct wd_vec3 p = wd_v3_mad(WD_V3(0, 0, stalk + 0.9f * t + 0.14f * along), aside,
                                     0.17f * (1 - t) * (1 - t));
        p = wd_v3_mad(p, out, 0.025f);
        struct wd_vec3 d = wd_v3_unit(wd_v3_mad(WD_V3(0, 0, 1), out, 0.4f));
        wd_leaf_add_needle(flower, p, d, wd_v3_unit(wd_v3_cross(d, out)),
                           larger * (0.2f - 0.06f * t), larger * (0.08f - 0.02f * t));
    }
}

/* Florets in a spiral around an upright axis, a cone in all. */
static void add_panicle(struct wd_leaf_template *flower, int florets)
{
    float larger = sqrtf(26 / (float)florets);
    for (int i = 0; i < florets; i++) {
        float t = (float)i / (float)florets, angle = (float)i * 2.3999632f, radius = 0.3f * (1 - 0.8f * t);
        struct wd_vec3 out = wd_v3_turn(WD_V3(1, 0, 0), WD_V3(0, 1, 0), angle);
        struct wd_vec3 p = wd_v3_add(wd_v3_scale(out, 0.4f * radius), WD_V3(0, 0, 0.1f + 0.85f * t));
        struct wd_vec3 d = wd_v3_unit(wd_v3_add(out, WD_V3(0, 0, 0.5f)));
        wd_leaf_add_needle(flower, p, d, wd_v3_cross(d, out), larger * (0.7f * radius + 0.06f),
                           larger * (0.35f * radius + 0.05f));
    }
}

void wd_flower_template_init(struct wd_leaf_template *flower, const struct wd_species *species,
                             enum wd_leaf_form form)
{
    bool grass = species->leaf.shape == WD_LEAF_BLADE &&
                 species->leaf.compound == WD_COMPOUND_SIMPLE;
    *flower = (struct wd_leaf_template){0};
    if (species->flower.petals > 0)
        add_petals(flower, (int)species->flower.petals, form);
    else if (species->flower.hang > 0.5f)
        add_catkin(flower, form == WD_LEAF_AS_KITE ? 6 : 26);
    else if (grass)
        add_ear(flower, 0.5f * species->leaf.length_cm / species->flower.size_cm,
                form == WD_LEAF_AS_KITE ? 6 : 26);
    else
        add_panicle(flower, form == WD_LEAF_AS_KITE ? 6 : 26);
    for (size_t i = 0; i < flower->corner_count; i++)
        flower->corners[i].kind |= WD_VERTEX_FLOWER;
}
