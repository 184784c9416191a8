#include "tree/leaf_spray.h"

#include <math.h>

#include "tree/leaf_sprig.h"
#include "tree/look.h"

enum { SIDE_TWIGS = 10 };

struct spray {
    struct wd_leaf_template twig; /* all of it */
    struct wd_random random;
    float size_m;
    float needle_width_m;
    bool shade; /* it only throws its shadow */
};

/* Adds a leaf scaled and turned: its foot at place->foot, its length times place->length. */
static void add_copy(struct wd_leaf_template *twig, const struct wd_leaf_template *leaf,
                     const struct wd_blade_place *place)
{
    uint32_t first = (uint32_t)twig->corner_count;
    for (size_t i = 0; i < leaf->corner_count; i++) {
        const struct wd_leaf_corner *from = &leaf->corners[i];
        struct wd_vec3 p = wd_v3_scale(place->across, from->p.x);
        struct wd_vec3 n = wd_v3_scale(place->across, from->n.x);
        p = wd_v3_mad(wd_v3_mad(p, place->along, from->p.y), place->above, from->p.z);
        n = wd_v3_mad(wd_v3_mad(n, place->along, from->n.y), place->above, from->n.z);
        wd_leaf_add_corner(twig, wd_v3_mad(place->foot, p, place->length), n, from->u, from->v,
                           from->stiff);
    }
    for (size_t i = 0; i < leaf->index_count; i += 3)
        wd_leaf_add_triangle(twig, first + leaf->indices[i], first + leaf->indices[i + 1],
                             first + leaf->indices[i + 2]);
}

/* Wood: two thin triangles that cross along their length. */
static void add_wood(struct spray *spray, struct wd_vec3 from, struct wd_vec3 to, float width_m)
{
    size_t first = spray->twig.corner_count;
    struct wd_vec3 along = wd_v3_unit(wd_v3_sub(to, from)), side = wd_v3_side(along);
    wd_leaf_add_stalk(&spray->twig, from, to, side, width_m / spray->size_m);
    wd_leaf_add_stalk(&spray->twig, from, to, wd_v3_cross(along, side), width_m / spray->size_m);
    for (size_t i = first; i < spray->twig.corner_count; i++)
        spray->twig.corners[i].kind = 0;
}

/* --- leaves ------------------------------------------------------------------------------ */

static void add_leaves(struct spray *spray, const struct wd_species *species,
                       const struct wd_leaf_template *leaf, int count)
{
    float reach = wd_sprig_reach(count);
    if (count < 2) {
        const struct wd_blade_place place = {.across = {1, 0, 0}, .along = {0, 1, 0},
                                             .above = {0, 0, 1}, .length = 1};
        add_copy(&spray->twig, leaf, &place);
        return;
    }
    for (int i = 0; i < count; i++) {
        struct wd_blade_place place = wd_sprig_place(species, &spray->random, i, count);
        add_copy(&spray->twig, leaf, &place);
    }
    add_wood(spray, wd_sprig_axis(0), wd_sprig_axis(reach), 0.003f);
    add_wood(spray, wd_sprig_axis(0), wd_sprig_axis(0.5f * reach), 0.0035f);
}

/* --- needles ----------------------------------------------------------------------------- */

/* Lines that bear needles, in units of the shoot. */
struct bearer {
    struct wd_vec3 from, to;
};

/* Shoots with needles all around bear twelve on a centimetre: a twig of few needles has few side twigs. */
static int side_twigs(const struct wd_species *species, float needles, float size_m)
{
    static const float NEEDLES_A_METRE = 1200, SIDE_LENGTH = 0.35f;
    if (species->leaf.needles != WD_NEEDLES_AROUND)
        return species->leaf.needles == WD_NEEDLES_FASCICLES ? 3 : 2;
    float sides = (needles / (NEEDLES_A_METRE * size_m) - 1) / SIDE_LENGTH;
    return (int)wd_clampf(sides, 2, SIDE_TWIGS);
}

static int gather_bearers(int sides, struct wd_random *random, struct bearer bearers[SIDE_TWIGS + 1])
{
    bearers[0] = (struct bearer){{0, 0, 0}, {0, 1, -0.04f}};
    for (int i = 0; i < sides; i++) {
        float at = 0.12f + 0.68f * ((float)i + 0.5f) / (float)sides, side = i & 1 ? -1.0f : 1.0f;
        float length = 0.62f * (1.02f - at) * wd_random_range(random, 0.8f, 1.15f);
        struct wd_vec3 d = wd_v3_unit(WD_V3(0.9f * side, 0.75f,
                                            -0.12f + 0.3f * wd_random_signed(random)));
        struct wd_vec3 from = WD_V3(0, at, -0.04f * at);
        bearers[i + 1] = (struct bearer){from, wd_v3_mad(from, d, length)};
    }
    return sides + 1;
}

/* Spruces' shoots of a year are as slender as their length asks; a young tree's are short. */
static float twig_width_m(const struct spray *spray, const struct wd_species *species, bool main)
{
    float width_m = main ? 0.005f : 0.0035f;
    if (species->leaf.needles == WD_NEEDLES_AROUND)
        width_m = fminf(width_m, (main ? 0.02f : 0.014f) * spray->size_m);
    return width_m;
}

/* One needle or bundle at share `t` of a bearer; needles of a bundle part at a narrow angle. */
static void add_needle(struct spray *spray, const struct wd_species *species,
                       const struct bearer *bearer, float t, int n, int of_bundle)
{
    struct wd_random *random = &spray->random;
    struct wd_vec3 twig = wd_v3_sub(bearer->to, bearer->from), axis = wd_v3_unit(twig);
    struct wd_vec3 foot = wd_v3_mad(bearer->from, twig, t), side = wd_v3_side(axis);
    float angle = 2.3999632f * (float)n + 0.3f * wd_random_signed(random), lean = 0.75f;
    struct wd_vec3 out = wd_v3_turn(side, wd_v3_cross(axis, side), angle);
    if (species->leaf.needles == WD_NEEDLES_TUFTS) {
        /* a rosette opens from a spur: its needles go all ways but back */
        struct wd_vec3 across = wd_v3_cross(axis, out);
        float turn = 6.2831853f * wd_random_unit(random), wide = wd_random_range(random, 0.3f, 1.1f);
        struct wd_vec3 open = wd_v3_turn(axis, across, turn);
        out = wd_v3_mad(out, open, wide);
        lean = 0.1f;
    } else if (species->leaf.needles == WD_NEEDLES_AROUND) {
        out = wd_v3_add(out, WD_V3(0, 0, 0.35f)); /* parted below, combed up */
    }
    struct wd_vec3 d = wd_v3_unit(wd_v3_mad(out, axis, lean));
    float length = 0.01f * species->leaf.length_cm / spray->size_m;
    float width = spray->needle_width_m / spray->size_m;
    struct wd_vec3 across = wd_v3_unit(wd_v3_cross(d, wd_v3_mad(axis, wd_random_vec3(random), 0.8f)));
    for (int i = 0; i < of_bundle; i++) {
        float part = of_bundle > 1 ? 0.16f * (2 * (float)i / (float)(of_bundle - 1) - 1) : 0;
        struct wd_vec3 own = wd_v3_unit(wd_v3_mad(wd_v3_mad(d, across, part),
                                                  wd_random_vec3(random), 0.08f));
        wd_leaf_add_needle(&spray->twig, foot, own, across,
                           length * wd_random_range(random, 0.8f, 1.1f), width);
    }
}

static void add_needles(struct spray *spray, const struct wd_species *species, float area)
{
    struct bearer bearers[SIDE_TWIGS + 1];
    float real_m = 0.01f * species->leaf.width_cm, length_m = 0.01f * species->leaf.length_cm;
    float whole_m2 = area * spray->size_m * spray->size_m;
    float real = 2 * whole_m2 / (length_m * real_m), wanted = fminf(real, WD_SPRAY_TRIANGLES - 50), seen = wanted;
    int count = gather_bearers(side_twigs(species, real, spray->size_m), &spray->random, bearers), n = 0;
    /* where there are not triangles enough, needles grow wider */
    spray->needle_width_m = fminf(2 * whole_m2 / (length_m * wanted), 2.5f * real_m);
    if (spray->shade) {
        wanted = fminf(wanted, WD_SPRAY_SHADE_TRIANGLES - 50);
        spray->needle_width_m *= seen / wanted;
    }
    bool tufts = species->leaf.needles == WD_NEEDLES_TUFTS;
    int bundle = species->leaf.needles == WD_NEEDLES_FASCICLES ? (int)species->leaf.bundle : 1;
    float whole = 0;
    for (int i = 0; i < count; i++)
        whole += wd_v3_length(wd_v3_sub(bearers[i].to, bearers[i].from));
    for (int i = 0; i < count; i++) {
        float share = wd_v3_length(wd_v3_sub(bearers[i].to, bearers[i].from)) / whole;
        int places = (int)(wanted * share / (float)bundle), spur = 1;
        float from = species->leaf.needles == WD_NEEDLES_FASCICLES && i == 0 ? 0.3f : 0.04f;
        if (tufts && species->leaf.bundle > 1)
            spur = (int)species->leaf.bundle;
        for (int k = 0; k < places; k++, n++) {
            int place = k / spur, of = (places + spur - 1) / spur;
            float t = wd_mixf(from, 1, ((float)place + 0.5f) / (float)of);
            add_needle(spray, species, &bearers[i], t, tufts ? n / spur : n, bundle);
        }
        add_wood(spray, bearers[i].from, bearers[i].to, twig_width_m(spray, species, i == 0));
    }
}

/* --- the whole --------------------------------------------------------------------------- */

_Static_assert(WD_LEAF_VARIANTS <= WD_LEAF_FORMS, "a leaf tells its form");

uint32_t wd_leaf_spray_forms(const struct wd_species *species)
{
    return species->leaf.compound == WD_COMPOUND_BIPINNATE ? WD_LEAF_VARIANTS : 1;
}

/* Whether a single leaf has lobes or teeth that trees' meshes leave out. */
static bool has_finer_outline(const struct wd_species *species,
                              const struct wd_leaf_template *near)
{
    struct wd_leaf_template blade;
    wd_leaf_template_init(&blade, species, WD_LEAF_AS_BLADE, 0);
    bool finer = near->index_count > blade.index_count;
    wd_leaf_template_finish(&blade);
    return finer;
}

static void pack(struct wd_tree_mesh *mesh, const struct wd_leaf_template *twig,
                 const struct wd_species *species)
{
    static const float white[3] = {1, 1, 1};
    struct wd_bark_tint bark = wd_bark_tint_of(species);
    for (size_t i = 0; i < twig->corner_count; i++) {
        const struct wd_leaf_corner *corner = &twig->corners[i];
        float normal[3] = {corner->n.x, corner->n.y, corner->n.z};
        struct wd_tree_vertex vertex = {
            .position_m = {corner->p.x, corner->p.y, corner->p.z},
            .normal = wd_pack_normal(normal),
            .uv = wd_pack_uv(corner->u, corner->v),
            .tint = wd_pack_tint(corner->kind ? white : bark.twig, 1),
            .kind = corner->kind | (uint32_t)(45 * corner->stiff),
        };
        wd_tree_mesh_add_vertex(mesh, &vertex);
    }
    for (size_t i = 0; i < twig->index_count; i += 3)
        wd_tree_mesh_add_triangle(mesh, twig->indices[i], twig->indices[i + 1],
                                  twig->indices[i + 2]);
}

/* A leaf as shadows show it: two triangles, or a frond's pinnae. */
static enum wd_leaf_form shade_form(const struct wd_species *species)
{
    return wd_leaf_spray_forms(species) > 1 ? WD_LEAF_AS_BLADE : WD_LEAF_AS_KITE;
}

static void make_form(struct spray *spray, const struct wd_species *species, uint32_t variant)
{
    struct wd_leaf_template near, shade;
    wd_leaf_template_init(&near, species, WD_LEAF_AS_NEAR, variant);
    wd_leaf_template_init(&shade, species, shade_form(species), variant);
    float real_m = 0.01f * species->leaf.length_cm;
    int count = (int)(spray->size_m * spray->size_m / (real_m * real_m) + 0.5f);
    int most = WD_SPRAY_TRIANGLES / (int)(near.index_count / 3 + 1);
    most = most < WD_SPRIG_LEAVES ? most : WD_SPRIG_LEAVES;
    if (species->leaf.shape == WD_LEAF_NEEDLES)
        add_needles(spray, species, wd_leaf_template_area(&near));
    else if ((count > 1 && most > 1) || has_finer_outline(species, &near))
        add_leaves(spray, species, spray->shade ? &shade : &near, count < most ? count : most);
    wd_leaf_template_finish(&near);
    wd_leaf_template_finish(&shade);
}

static void make(struct wd_tree_mesh *mesh, const struct wd_species *species, struct spray *spray)
{
    for (uint32_t i = 0; i < wd_leaf_spray_forms(species); i++)
        make_form(spray, species, i);
    pack(mesh, &spray->twig, species);
    wd_tree_mesh_update_bounds(mesh);
    wd_leaf_template_finish(&spray->twig);
}

static struct spray spray_of(float size_m, bool shade)
{
    return (struct spray){.random = wd_random_of(0x5b4a, 1), .size_m = size_m, .shade = shade};
}

void wd_leaf_spray_mesh(struct wd_tree_mesh *mesh, const struct wd_species *species, float size_m)
{
    struct spray spray = spray_of(size_m, false);
    make(mesh, species, &spray);
}

void wd_leaf_spray_shade_mesh(struct wd_tree_mesh *mesh, const struct wd_species *species, float size_m)
{
    struct spray spray = spray_of(size_m, true);
    make(mesh, species, &spray);
}

/* Kites have two triangles, needles one. */
float wd_leaf_spray_grain(const struct wd_tree_mesh *shade)
{
    float twice_m2 = 0;
    uint32_t leaf_triangles = 0;
    for (uint32_t i = 0; i < shade->index_count; i += 3) {
        const struct wd_tree_vertex *corners[3];
        for (int k = 0; k < 3; k++)
            corners[k] = &shade->vertices[shade->indices[i + k]];
        if (!(corners[0]->kind & WD_VERTEX_LEAF))
            continue;
        const float *a = corners[0]->position_m, *b = corners[1]->position_m, *c = corners[2]->position_m;
        twice_m2 += wd_v3_length(wd_v3_cross(WD_V3(b[0] - a[0], b[1] - a[1], b[2] - a[2]),
                                             WD_V3(c[0] - a[0], c[1] - a[1], c[2] - a[2])));
        leaf_triangles++;
    }
    return leaf_triangles ? sqrtf(twice_m2 / (float)leaf_triangles) : 0;
}
