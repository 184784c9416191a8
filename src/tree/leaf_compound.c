#include "tree/leaf_parts.h"

/* More leaflets than this are drawn as kites, fewer with their outline. */
enum { OUTLINED_LEAFLETS = 16, AXIS_PIECES = 6, BLADE_PIECES = 4, PINNULES = 9, NEAR_PINNULES = 12 };

/* The leaf's axis: an arc in the plane of y and z that bends down by `arch` radians in all, and
 * aside by `sway` of its length toward the tip. */
struct axis {
    float arch, sway;
};

static struct wd_vec3 axis_direction(const struct axis *axis, float t)
{
    double turn = -(double)axis->arch * (double)t;
    return wd_v3_unit(WD_V3(2 * axis->sway * t, wd_dcos(turn), wd_dsin(turn)));
}

static struct wd_vec3 axis_point(const struct axis *axis, float t)
{
    struct wd_vec3 p = WD_V3(0, 0, 0);
    const int steps = 12;
    for (int i = 0; i < steps; i++)
        p = wd_v3_mad(p, axis_direction(axis, t * ((float)i + 0.5f) / (float)steps),
                      t / (float)steps);
    return p;
}

/* Square to it, upward. */
static struct wd_vec3 axis_above(struct wd_vec3 direction)
{
    return wd_v3_square(WD_V3(0, -direction.z, direction.y), direction);
}

/* A strip along the axis; half as wide at its end. */
static void add_axis(struct wd_leaf_template *leaf, const struct axis *axis, float width)
{
    uint32_t before[2] = {0};
    for (int i = 0; i <= AXIS_PIECES; i++) {
        float t = (float)i / AXIS_PIECES, half = 0.5f * width * (1 - 0.75f * t);
        struct wd_vec3 p = axis_point(axis, t), n = axis_above(axis_direction(axis, t));
        uint32_t right = wd_leaf_add_corner(leaf, wd_v3_add(p, WD_V3(half, 0, 0)), n, 0.501f, 0,
                                            0.6f * t);
        uint32_t left = wd_leaf_add_corner(leaf, wd_v3_add(p, WD_V3(-half, 0, 0)), n, 0.499f, 0,
                                           0.6f * t);
        if (i > 0) {
            wd_leaf_add_triangle(leaf, before[0], right, left);
            wd_leaf_add_triangle(leaf, before[0], left, before[1]);
        }
        before[0] = right;
        before[1] = left;
    }
}

/* Length of a leaflet at share t of the leafy part: palms and ashes are fullest in the middle,
 * ferns in their lower third. */
static float leaflet_share(const struct wd_species *species, float t)
{
    if (species->leaf.compound == WD_COMPOUND_BIPINNATE)
        return fminf(0.55f + 1.8f * t, 1) * (1 - 0.93f * t * t);
    return 0.55f + 0.45f * (float)wd_dsin(WD_PI * (0.12 + 0.76 * (double)t));
}

/* Where a pinnule is: `half` of its foot along the midrib. */
struct pinnule {
    struct wd_vec3 foot, out, across, above;
    float reach, half;
};

/* A point at share y of its reach; pinnules rise from the midrib and are vaulted, a little more for light than they are. */
static uint32_t add_pinnule_corner(struct wd_leaf_template *leaf, const struct pinnule *at, float x, float y)
{
    struct wd_vec3 p = wd_v3_mad(at->foot, at->out, y * at->reach);
    p = wd_v3_mad(p, at->across, x * at->half);
    p = wd_v3_mad(p, at->above, (0.7f * y - 0.35f * y * y) * at->reach - 0.3f * x * x * at->half);
    struct wd_vec3 n = wd_v3_mad(at->above, at->out, 0.7f * y - 0.9f);
    n = wd_v3_mad(n, at->across, 0.7f * x);
    return wd_leaf_add_corner(leaf, p, wd_v3_unit(n), 0.5f + 0.5f * x, y, wd_mixf(0.3f, 1, y));
}

/* Oblong, its end rounded and bent toward the pinna's tip. */
static void add_pinnule(struct wd_leaf_template *leaf, const struct pinnule *at, float forward)
{
    uint32_t foot[2] = {add_pinnule_corner(leaf, at, -0.9f, 0), add_pinnule_corner(leaf, at, 0.9f, 0)};
    uint32_t end[2] = {add_pinnule_corner(leaf, at, -0.8f, 0.72f), add_pinnule_corner(leaf, at, 0.8f, 0.72f)};
    uint32_t tip = add_pinnule_corner(leaf, at, 0.3f * forward, 1);
    wd_leaf_add_triangle(leaf, foot[0], foot[1], end[1]);
    wd_leaf_add_triangle(leaf, foot[0], end[1], end[0]);
    wd_leaf_add_triangle(leaf, end[0], end[1], tip);
}

/* A pinna: small leaves left and right of its midrib. */
static void add_pinna(struct wd_leaf_template *leaf, const struct wd_blade_place *place)
{
    for (int i = 0; i < 2 * PINNULES; i++) {
        float t = ((float)(i / 2) + 0.3f) / PINNULES, side = i & 1 ? -1.0f : 1.0f;
        float reach = place->width * (0.58f - 0.32f * t);
        float foot = place->length / PINNULES * 1.5f; /* grown together */
        struct wd_vec3 p = wd_v3_mad(place->foot, place->along, t * place->length);
        p = wd_v3_mad(p, place->above, -0.08f * t * t * place->length);
        struct wd_vec3 out = wd_v3_mad(wd_v3_scale(place->across, side), place->along, 0.35f);
        wd_leaf_add_needle(leaf, p, wd_v3_unit(out), wd_v3_scale(place->along, -side), reach, foot);
    }
}

/* The same from near, on its midrib. */
static void add_near_pinna(struct wd_leaf_template *leaf, const struct wd_blade_place *place)
{
    struct wd_vec3 end = wd_v3_mad(place->foot, place->along, place->length);
    wd_leaf_add_stalk(leaf, place->foot, wd_v3_mad(end, place->above, -0.08f * place->length), place->across,
                      0.07f * place->width);
    for (int i = 0; i < 2 * NEAR_PINNULES; i++) {
        float t = ((float)(i / 2) + 0.3f) / NEAR_PINNULES, side = i & 1 ? -1.0f : 1.0f;
        struct wd_vec3 p = wd_v3_mad(place->foot, place->along, t * place->length);
        struct wd_vec3 out = wd_v3_unit(wd_v3_mad(wd_v3_scale(place->across, side), place->along, 0.35f));
        const struct pinnule at = {
            .foot = wd_v3_mad(p, place->above, -0.08f * t * t * place->length),
            .out = out,
            .across = wd_v3_scale(place->along, -side),
            .above = wd_v3_unit(wd_v3_cross(wd_v3_scale(place->along, -side), out)),
            .reach = 0.474f * place->width * (1 - 0.85f * t * t * t),
            .half = 0.5f * place->length / NEAR_PINNULES,
        };
        add_pinnule(leaf, &at, -side);
    }
}

/* A palm's leaflet: a strap, folded along its midrib and so narrower than it is wide, that hangs
 * the more the farther out. Its blade stands across the frond, more or less: light falls between. */
static void add_strap(struct wd_leaf_template *leaf, const struct wd_blade_place *place,
                      struct wd_random *random)
{
    static const float at[] = {0, 0.3f, 0.68f}, wide[] = {0.3f, 0.8f, 0.62f};
    float droop = wd_random_range(random, 0.12f, 0.5f);
    float roll = wd_random_range(random, 0.15f, 0.85f);
    struct wd_vec3 across = wd_v3_turn(place->across, place->above,
                                       place->along.x > 0 ? roll : -roll);
    uint32_t before[2] = {0};
    for (int i = 0; i <= 3; i++) {
        float y = i < 3 ? at[i] : 1, half = i < 3 ? 0.5f * place->width * wide[i] : 0;
        float reach = y * (1 - 0.2f * droop * y), sag = droop * y * y;
        struct wd_vec3 p = wd_v3_mad(place->foot, place->along, place->length * reach);
        p = wd_v3_mad(p, place->above, -place->length * sag);
        struct wd_vec3 d = wd_v3_mad(place->along, place->above, -2 * droop * y);
        struct wd_vec3 n = wd_v3_unit(wd_v3_cross(across, d));
        float stiff = wd_mixf(place->stiff, 1, y);
        uint32_t right = wd_leaf_add_corner(leaf, wd_v3_mad(p, across, half), n,
                                            i < 3 ? 1 : 0.5f, y, stiff);
        uint32_t left = right;
        if (i < 3)
            left = wd_leaf_add_corner(leaf, wd_v3_mad(p, across, -half), n, 0, y, stiff);
        if (i > 0)
            wd_leaf_add_triangle(leaf, before[0], right, before[1]);
        if (i > 0 && i < 3)
            wd_leaf_add_triangle(leaf, right, left, before[1]);
        before[0] = right;
        before[1] = left;
    }
}

static void add_leaflet(struct wd_leaf_template *leaf, const struct wd_species *species,
                        const struct wd_leaf_outline *outline, enum wd_leaf_form form,
                        const struct wd_blade_place *place, struct wd_random *random)
{
    if (species->leaf.compound == WD_COMPOUND_BIPINNATE && form == WD_LEAF_AS_NEAR)
        add_near_pinna(leaf, place);
    else if (species->leaf.compound == WD_COMPOUND_BIPINNATE)
        add_pinna(leaf, place);
    else if (species->leaf.shape == WD_LEAF_BLADE)
        add_strap(leaf, place, random);
    else if (species->leaf.leaflets > OUTLINED_LEAFLETS)
        wd_leaf_add_kite(leaf, outline, place);
    else
        wd_leaf_add_blade(leaf, outline, place);
}

/* No two fronds bend alike. */
static struct axis frond_axis(const struct wd_species *species, struct wd_random *random)
{
    if (species->leaf.leaflets <= OUTLINED_LEAFLETS)
        return (struct axis){species->leaf.arch, 0};
    float arch = species->leaf.arch * wd_random_range(random, 0.6f, 1.3f);
    return (struct axis){arch, 0.14f * wd_random_signed(random)};
}

void wd_leaf_add_pinnate(struct wd_leaf_template *leaf, const struct wd_species *species,
                         const struct wd_leaf_outline *outline, enum wd_leaf_form form, uint32_t variant)
{
    struct wd_random random = wd_random_of(variant, 0xf40d);
    const struct axis axis = frond_axis(species, &random);
    float whole = species->leaf.length_cm;
    float from = species->leaf.stalk_cm / whole;
    float length = species->leaf.leaflet_length_cm / whole;
    float width = species->leaf.leaflet_width_cm / whole;
    int count = (int)species->leaf.leaflets;
    bool frond = count > OUTLINED_LEAFLETS;
    bool fern = species->leaf.compound == WD_COMPOUND_BIPINNATE;
    add_axis(leaf, &axis, fern ? 0.007f : frond ? 0.012f : 0.02f);
    for (int i = 0; i < count; i++) {
        bool last = i == count - 1 && count % 2;
        float t = ((float)(i / 2) + 0.5f + 0.25f * (float)(i & 1)) / (0.5f * (float)count + 0.25f);
        float at = wd_mixf(from, 0.985f, last ? 1 : t), side = i & 1 ? -1.0f : 1.0f;
        float size = leaflet_share(species, last ? 0.8f : t);
        struct wd_vec3 d = axis_direction(&axis, at), up = axis_above(d);
        struct wd_vec3 out = wd_v3_mad(wd_v3_scale(d, 0.55f + 0.7f * t), WD_V3(side, 0, 0), 1);
        out = wd_v3_mad(out, WD_V3(0, 0, -1), frond ? 0.35f : 0.15f);
        if (frond) {
            out = wd_v3_mad(out, wd_random_vec3(&random), 0.14f);
            size *= wd_random_range(&random, 0.85f, 1.06f);
        }
        struct wd_blade_place place = wd_blade_place(axis_point(&axis, at),
                                                     last ? d : wd_v3_unit(out), up,
                                                     size * length, width * (0.5f + 0.5f * size));
        place.stiff = 0.6f * at;
        add_leaflet(leaf, species, outline, form, &place, &random);
    }
}

/* How far from the hub a leaflet's blade begins that is to stay within `half_rad` to either side of its axis. */
static float petiolule(const struct wd_leaf_outline *outline, float length, float width, float half_rad)
{
    float slope = (float)(wd_dcos((double)half_rad) / wd_dsin((double)half_rad)), from = 0;
    for (int i = 0; i < outline->count; i++) {
        struct wd_vec3 p = wd_leaf_outline_corner(outline, i + 1);
        from = wd_maxf(from, 0.5f * width * p.x * slope - length * p.y);
    }
    return from;
}

/* A hand of leaflets on stalks of their own as long as keeps them apart, the middle one's the longest:
 * a bramble's is a third of its blade. */
void wd_leaf_add_palmate(struct wd_leaf_template *leaf, const struct wd_species *species,
                         const struct wd_leaf_outline *outline)
{
    float whole = species->leaf.length_cm, from = species->leaf.stalk_cm / whole;
    float length = species->leaf.leaflet_length_cm / whole;
    float width = species->leaf.leaflet_width_cm / whole;
    int count = (int)species->leaf.leaflets;
    struct wd_vec3 hub = WD_V3(0, from, 0);
    wd_leaf_add_stalk(leaf, WD_V3(0, 0, 0), hub, WD_V3(1, 0, 0), 0.02f);
    float step = wd_minf(1.2f, 4.7f / (float)count);
    for (int i = 0; i < count; i++) {
        float t = count > 1 ? 2 * (float)i / (float)(count - 1) - 1 : 0;
        float angle = step * ((float)i - 0.5f * (float)(count - 1));
        struct wd_vec3 out = wd_v3_turn(WD_V3(0, 1, 0), WD_V3(1, 0, 0), angle);
        out = wd_v3_unit(wd_v3_mad(out, WD_V3(0, 0, -1), 0.2f));
        float size = 1 - 0.32f * t * t;
        float clear = petiolule(outline, size * length, size * width, 0.48f * step);
        struct wd_vec3 foot = wd_v3_mad(hub, out, wd_maxf(t == 0 ? 1.4f * clear : clear, 0.02f));
        struct wd_blade_place place = wd_blade_place(foot, out, WD_V3(0, 0, 1), size * length,
                                                     size * width);
        wd_leaf_add_stalk(leaf, hub, foot, place.across, 0.012f);
        place.stiff = 0.3f;
        wd_leaf_add_blade(leaf, outline, &place);
    }
}

void wd_leaf_add_arching_blade(struct wd_leaf_template *leaf, const struct wd_species *species)
{
    float arch = species->leaf.arch, width = species->leaf.width_cm / species->leaf.length_cm;
    uint32_t before[2] = {0};
    for (int i = 0; i < BLADE_PIECES; i++) {
        /* most of the bend is in the outer half, and so are the pieces */
        float left_over = 1 - (float)i / BLADE_PIECES, t = 1 - left_over * sqrtf(left_over);
        float half = 0.5f * width * (1 - 0.75f * t * t);
        struct axis axis = {arch * t, 0};
        struct wd_vec3 p = axis_point(&axis, t), n = axis_above(axis_direction(&axis, 1));
        uint32_t right = wd_leaf_add_corner(leaf, wd_v3_add(p, WD_V3(half, 0, 0)), n, 1, t, t);
        uint32_t left = wd_leaf_add_corner(leaf, wd_v3_add(p, WD_V3(-half, 0, 0)), n, 0, t, t);
        if (i > 0) {
            wd_leaf_add_triangle(leaf, before[0], right, left);
            wd_leaf_add_triangle(leaf, before[0], left, before[1]);
        }
        before[0] = right;
        before[1] = left;
    }
    const struct axis end = {arch, 0};
    uint32_t tip = wd_leaf_add_corner(leaf, axis_point(&end, 1),
                                      axis_above(axis_direction(&end, 1)), 0.5f, 1, 1);
    wd_leaf_add_triangle(leaf, before[0], tip, before[1]);
}
