#include "tree/leaf_parts.h"

enum { COMB_NEEDLES = 9, BRUSH_NEEDLES = 15, ROSETTES = 5, ROSETTE_NEEDLES = 5 };

/* A feather: needles left and right of the shoot, shorter toward its tip, one at the tip. They
 * share their feet: a shoot has half the vertices so. */
static void add_comb(struct wd_leaf_template *leaf, struct wd_random *random)
{
    float step = 0.84f / COMB_NEEDLES;
    uint32_t feet = wd_leaf_add_corner(leaf, WD_V3(0, 0, 0), WD_V3(0, 0, 1), 0, 0, 0.3f);
    for (int i = 1; i <= COMB_NEEDLES; i++)
        wd_leaf_add_corner(leaf, WD_V3(0, step * (float)i, 0), WD_V3(0, 0, 1), (float)(i & 1), 0,
                           0.3f);
    for (int i = 0; i < 2 * COMB_NEEDLES; i++) {
        float side = i & 1 ? 1.0f : -1.0f, at = ((float)(i / 2) + 0.5f) * step;
        float length = (0.41f - 0.18f * at) * wd_random_range(random, 0.6f, 1.4f);
        float up = 0.25f + 0.35f * wd_random_signed(random);
        struct wd_vec3 d = wd_v3_unit(WD_V3(side, wd_random_range(random, 0.65f, 1.35f), up));
        struct wd_vec3 n = wd_v3_unit(WD_V3(-up * side, 0, 1));
        uint32_t tip = wd_leaf_add_corner(leaf, wd_v3_mad(WD_V3(0, at, 0), d, length), n, 0.5f, 1,
                                          1);
        uint32_t low = feet + (uint32_t)(i / 2);
        wd_leaf_add_triangle(leaf, side > 0 ? low : low + 1, tip, side > 0 ? low + 1 : low);
    }
    wd_leaf_add_needle(leaf, WD_V3(0, 0.7f, 0), WD_V3(0, 1, 0), WD_V3(1, 0, 0), 0.3f, 0.1f);
}

/* A brush: needles all around the end of a shoot, pointing forward. */
static void add_brush(struct wd_leaf_template *leaf, struct wd_random *random)
{
    for (int i = 0; i < BRUSH_NEEDLES; i++) {
        float at = 0.5f * (float)i / BRUSH_NEEDLES, angle = (float)i * 2.3999632f;
        struct wd_vec3 out = wd_v3_turn(WD_V3(1, 0, 0), WD_V3(0, 0, 1), angle);
        float lean = wd_random_range(random, 0.3f, 0.9f) + 0.9f * at;
        struct wd_vec3 d = wd_v3_unit(wd_v3_mad(out, WD_V3(0, 1, 0), lean));
        wd_leaf_add_needle(leaf, WD_V3(0, at, 0), d, wd_v3_unit(wd_v3_cross(d, out)),
                           wd_random_range(random, 0.5f, 0.7f), 0.11f);
    }
}

/* Rosettes on short shoots along a bare twig. */
static void add_rosettes(struct wd_leaf_template *leaf, struct wd_random *random)
{
    for (int i = 0; i < ROSETTES * ROSETTE_NEEDLES; i++) {
        int rosette = i / ROSETTE_NEEDLES;
        float at = ((float)rosette + 0.6f) / ROSETTES, angle = (float)rosette * 2.3999632f;
        struct wd_vec3 axis = wd_v3_turn(WD_V3(1, 0, 0), WD_V3(0, 0, 1), angle);
        axis = wd_v3_unit(wd_v3_mad(axis, WD_V3(0, 1, 0), 0.4f));
        struct wd_vec3 side = wd_v3_square(WD_V3(0, 1, 0), axis);
        struct wd_vec3 out = wd_v3_turn(side, wd_v3_cross(axis, side),
                                        6.2831853f * ((float)i + wd_random_unit(random)) /
                                            ROSETTE_NEEDLES);
        struct wd_vec3 d = wd_v3_unit(wd_v3_mad(out, axis, 0.6f));
        wd_leaf_add_needle(leaf, WD_V3(0, at, 0), d, wd_v3_unit(wd_v3_cross(d, axis)),
                           wd_random_range(random, 0.19f, 0.29f), 0.048f);
    }
}

void wd_leaf_add_needles(struct wd_leaf_template *leaf, const struct wd_species *species,
                         uint32_t variant)
{
    struct wd_random random = wd_random_of(variant, 0xc0b);
    if (species->leaf.needles == WD_NEEDLES_FASCICLES)
        add_brush(leaf, &random);
    else if (species->leaf.needles == WD_NEEDLES_TUFTS)
        add_rosettes(leaf, &random);
    else
        add_comb(leaf, &random);
}
