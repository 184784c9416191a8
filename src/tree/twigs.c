#include "tree/twigs.h"

#include "tree/look.h"

#define TWIG_M 0.42f    /* with the year's shoot */
#define CUT_TWIG_M 0.1f /* of a hedge */
#define YOUNG_WIDTH 0.4f

/* A shoot from `foot` to its point: a spike of three sides. */
struct shoot {
    struct wd_vec3 foot, axis, side;
    float length_m, width_m;
};

static void add_corner(struct wd_tree_mesh *mesh, struct wd_vec3 p, struct wd_vec3 n, float u,
                       float v, const struct wd_tree_vertex *like)
{
    struct wd_tree_vertex vertex = *like;
    vertex.position_m[0] = p.x;
    vertex.position_m[1] = p.y;
    vertex.position_m[2] = p.z;
    vertex.normal = wd_pack_normal((float[3]){n.x, n.y, n.z});
    vertex.uv = wd_pack_uv(u, v);
    wd_tree_mesh_add_vertex(mesh, &vertex);
}

static void add_shoot(struct wd_tree_mesh *mesh, const struct shoot *shoot,
                      const struct wd_tree_vertex *like)
{
    const float corners[3][2] = {{1, 0}, {-0.5f, 0.8660254f}, {-0.5f, -0.8660254f}};
    struct wd_vec3 over = wd_v3_cross(shoot->axis, shoot->side);
    uint32_t first = mesh->vertex_count;
    for (int i = 0; i < 3; i++) {
        struct wd_vec3 out = wd_v3_scale(shoot->side, corners[i][0]);
        out = wd_v3_mad(out, over, corners[i][1]);
        add_corner(mesh, wd_v3_mad(shoot->foot, out, 0.5f * shoot->width_m), out,
                   0.01f * (float)i, 0, like);
    }
    add_corner(mesh, wd_v3_mad(shoot->foot, shoot->axis, shoot->length_m), shoot->axis, 0.01f,
               shoot->length_m, like);
    for (uint32_t i = 0; i < 3; i++)
        wd_tree_mesh_add_triangle(mesh, first + i, first + (i + 1) % 3, first + 3);
}

static void add_twig(struct wd_tree_mesh *mesh, const struct wd_leaf *place, float length_m,
                     const struct wd_twig_style *style, const struct wd_tree_vertex *like)
{
    float length = length_m * (0.6f + 0.8f * wd_hash_unit(wd_hash2(place->key, 0x791)));
    struct wd_vec3 side = wd_v3_cross(place->axis, place->normal);
    const struct shoot main = {place->position_m, place->axis, side, length, style->width_m};
    add_shoot(mesh, &main, like);
    for (int i = 1; i < style->shoots; i++) {
        float turn = i & 1 ? 0.75f : -0.75f, at = 0.3f * (float)i;
        struct wd_vec3 axis = wd_v3_unit(wd_v3_mad(place->axis, side, turn));
        const struct shoot fork = {wd_v3_mad(main.foot, main.axis, at * length), axis,
                                   place->normal, 0.75f * length * (1 - at) + 0.1f * length,
                                   0.7f * style->width_m};
        add_shoot(mesh, &fork, like);
    }
}

void wd_twigs_mesh(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                   const struct wd_tree_form *form, const struct wd_twig_style *style)
{
    struct wd_bark_tint bark = wd_bark_tint_of(form->species);
    size_t count = (size_t)(style->share * (float)foliage->twig_count);
    float length_m = form->clip ? CUT_TWIG_M : TWIG_M * wd_minf(0.3f + 0.7f * form->scale, 1);
    struct wd_twig_style thin = *style; /* shoots of young trees are as slender as they are short */
    thin.width_m *= wd_mixf(1, YOUNG_WIDTH, form->youth);
    for (size_t i = 0; i < count; i++) {
        const struct wd_leaf *place = &foliage->leaves[i];
        float height = wd_clampf(place->position_m.z / form->height_m, 0, 1);
        const struct wd_tree_vertex like = {
            .tint = wd_bark_tint_at(&bark, height, 0, place->sky),
            .kind = (uint32_t)wd_clampf(place->flexibility, 0, 255),
        };
        add_twig(mesh, place, length_m, &thin, &like);
    }
}

/* Share of the stalk that is scaly, and its width at the foot over the frond's length. */
#define SCALY 0.8f
#define STIPE_WIDTH 0.01f

void wd_stipes_mesh(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                    const struct wd_tree_form *form)
{
    const struct wd_species *species = form->species;
    struct wd_bark_tint bark = wd_bark_tint_of(species);
    float share = SCALY * species->leaf.stalk_cm / species->leaf.length_cm;
    for (size_t i = 0; species->form == WD_FORM_FERN && i < foliage->count; i++) {
        const struct wd_leaf *frond = &foliage->leaves[i];
        const struct wd_tree_vertex like = {
            .tint = wd_bark_tint_at(&bark, 0, 0, frond->sky),
            .kind = (uint32_t)wd_clampf(frond->flexibility, 0, 255),
        };
        /* the chord of the bent stalk */
        struct wd_vec3 down = wd_v3_scale(frond->normal, -1);
        struct wd_vec3 axis = wd_v3_turn(frond->axis, down, 0.5f * species->leaf.arch * share);
        struct wd_vec3 sunk = wd_v3_mad(frond->position_m, axis, -STIPE_WIDTH * frond->size_m);
        const struct shoot stipe = {sunk, axis, wd_v3_cross(axis, frond->normal),
                                    share * frond->size_m, STIPE_WIDTH * frond->size_m};
        add_shoot(mesh, &stipe, &like);
    }
}
