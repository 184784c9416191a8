#include "tree/foliage.h"
#include "tree/look.h"

#include "base/color.h"

/* Shape of a drawn leaf in units of its length. */
struct outline {
    float width;  /* of the whole leaf or shoot */
    float widest; /* where, along the axis */
    float fold;   /* edges above the midrib */
    float curl;   /* tip below the plane */
};

enum { COMB_NEEDLES = 7, TUFT_NEEDLES = 15 };

static bool is_tuft(const struct wd_species *species)
{
    return species->leaf.shape == WD_LEAF_NEEDLES &&
           species->leaf.needles == WD_NEEDLES_FASCICLES;
}

static struct outline outline_of(const struct wd_species *species)
{
    float width = species->leaf.width_cm / species->leaf.length_cm;
    switch (species->leaf.shape) {
    case WD_LEAF_LOBED:
        return (struct outline){width * 1.1f, 0.6f, 0.10f, 0.10f};
    case WD_LEAF_TRIANGULAR:
        return (struct outline){width * 1.1f, 0.34f, 0.08f, 0.06f};
    case WD_LEAF_NEEDLES:
        return (struct outline){is_tuft(species) ? 0.75f : 0.5f, 0.5f, 0.10f, 0.05f};
    default:
        return (struct outline){width * 1.1f, 0.46f, 0.12f, 0.10f};
    }
}

/* Everything a leaf's vertices have in common. */
struct brush {
    struct wd_tree_mesh *mesh;
    const struct wd_leaf *leaf;
    struct wd_vec3 side;
    uint32_t tint;
    float own; /* share of the sheet's own normal; the rest is the crown's */
};

/* Vertex at (across, along, above) in units of `size_m`; `facing` is the sheet's own normal. */
static uint32_t add_vertex(const struct brush *brush, struct wd_vec3 p, struct wd_vec3 facing,
                           float u, float v, float stiff)
{
    const struct wd_leaf *leaf = brush->leaf;
    if (wd_v3_dot(facing, leaf->shading) < 0)
        facing = wd_v3_scale(facing, -1);
    struct wd_vec3 n = wd_v3_unit_or(wd_v3_mix(leaf->shading, facing, brush->own), leaf->shading);
    float normal[3] = {n.x, n.y, n.z}, bend = leaf->flexibility + 45 * stiff;
    struct wd_tree_vertex vertex = {
        .position_m = {p.x, p.y, p.z},
        .normal = wd_pack_normal(normal),
        .uv = wd_pack_uv(u, v),
        .tint = brush->tint,
        .kind = WD_VERTEX_LEAF | (uint32_t)wd_clampf(bend, 0, 255),
    };
    return wd_tree_mesh_add_vertex(brush->mesh, &vertex);
}

static struct wd_vec3 leaf_point(const struct brush *brush, float size, float across, float along,
                                 float above)
{
    const struct wd_leaf *leaf = brush->leaf;
    struct wd_vec3 p = wd_v3_mad(leaf->position_m, leaf->axis, size * along);
    p = wd_v3_mad(p, brush->side, size * across);
    return wd_v3_mad(p, leaf->normal, size * above);
}

/* Two triangles folded along the midrib. `back` moves the leaf back along its axis by that share
 * of its length, so that an enlarged one grows from its middle. */
static void add_kite(const struct brush *brush, const struct outline *outline, float size,
                     float back)
{
    float half = 0.5f * outline->width, at = outline->widest;
    struct wd_vec3 up = brush->leaf->normal;
    struct wd_vec3 right_face = wd_v3_unit(wd_v3_mad(up, brush->side, -2 * outline->fold));
    struct wd_vec3 left_face = wd_v3_unit(wd_v3_mad(up, brush->side, 2 * outline->fold));
    uint32_t base = add_vertex(brush, leaf_point(brush, size, 0, -back, 0), up, 0.5f, 0, 0.2f);
    uint32_t tip = add_vertex(brush, leaf_point(brush, size, 0, 1 - back, -outline->curl), up,
                              0.5f, 1, 1);
    uint32_t right = add_vertex(brush, leaf_point(brush, size, half, at - back,
                                                  outline->fold * half), right_face, 1, at, 0.7f);
    uint32_t left = add_vertex(brush, leaf_point(brush, size, -half, at - back,
                                                 outline->fold * half), left_face, 0, at, 0.7f);
    wd_tree_mesh_add_triangle(brush->mesh, base, right, tip);
    wd_tree_mesh_add_triangle(brush->mesh, base, tip, left);
}

/* One needle bundle: a thin triangle from its foot to its tip. */
static void add_needle(const struct brush *brush, struct wd_vec3 foot, struct wd_vec3 direction,
                       struct wd_vec3 across, float length, float width)
{
    struct wd_vec3 face = wd_v3_unit(wd_v3_cross(across, direction));
    uint32_t a = add_vertex(brush, wd_v3_mad(foot, across, -0.5f * width), face, 0, 0, 0.3f);
    uint32_t b = add_vertex(brush, wd_v3_mad(foot, across, 0.5f * width), face, 1, 0, 0.3f);
    uint32_t c = add_vertex(brush, wd_v3_mad(foot, direction, length), face, 0.5f, 1, 1);
    wd_tree_mesh_add_triangle(brush->mesh, a, b, c);
}

/* A flat feather: needles left and right of the shoot, shorter toward its tip, one at the tip. */
static void add_comb(const struct brush *brush)
{
    const struct wd_leaf *leaf = brush->leaf;
    struct wd_random random = wd_random_of(leaf->key, 0xc0b);
    float size = leaf->size_m, step = 0.84f / COMB_NEEDLES;
    for (int i = 0; i < 2 * COMB_NEEDLES; i++) {
        float side = i & 1 ? 1.0f : -1.0f, at = ((float)(i / 2) + 0.5f) * step;
        float length = size * (0.36f - 0.16f * at) * wd_random_range(&random, 0.8f, 1.2f);
        struct wd_vec3 out = wd_v3_mad(wd_v3_scale(brush->side, side), leaf->normal,
                                       0.25f + 0.35f * wd_random_signed(&random));
        struct wd_vec3 d = wd_v3_unit(wd_v3_mad(out, leaf->axis, 0.95f));
        struct wd_vec3 foot = wd_v3_mad(leaf->position_m, leaf->axis, size * at);
        add_needle(brush, foot, d, wd_v3_unit(wd_v3_mad(leaf->axis, leaf->normal, 0.2f * side)),
                   length, 1.15f * step * size);
    }
    struct wd_vec3 end = wd_v3_mad(leaf->position_m, leaf->axis, 0.7f * size);
    add_needle(brush, end, leaf->axis, brush->side, 0.3f * size, 0.12f * size);
}

/* A brush: needles all around the end of a shoot, pointing forward. */
static void add_tuft(const struct brush *brush)
{
    const struct wd_leaf *leaf = brush->leaf;
    struct wd_random random = wd_random_of(leaf->key, 0x7f7);
    for (int i = 0; i < TUFT_NEEDLES; i++) {
        float at = 0.5f * (float)i / TUFT_NEEDLES, angle = (float)i * 2.3999632f;
        struct wd_vec3 out = wd_v3_turn(brush->side, leaf->normal, angle);
        float lean = wd_random_range(&random, 0.3f, 0.9f) + 0.9f * at;
        struct wd_vec3 d = wd_v3_unit(wd_v3_mad(out, leaf->axis, lean));
        struct wd_vec3 across = wd_v3_unit(wd_v3_cross(d, out));
        struct wd_vec3 foot = wd_v3_mad(leaf->position_m, leaf->axis, leaf->size_m * at);
        add_needle(brush, foot, d, across,
                   leaf->size_m * wd_random_range(&random, 0.5f, 0.7f), 0.11f * leaf->size_m);
    }
}

static void add_leaf(const struct brush *brush, const struct wd_species *species,
                     const struct outline *outline)
{
    if (is_tuft(species))
        add_tuft(brush);
    else if (species->leaf.shape == WD_LEAF_NEEDLES)
        add_comb(brush);
    else
        add_kite(brush, outline, brush->leaf->size_m, 0);
}

static struct brush brush_of(struct wd_tree_mesh *mesh, const struct wd_leaf *leaf)
{
    return (struct brush){mesh, leaf, wd_v3_cross(leaf->axis, leaf->normal),
                          wd_pack_tint(leaf->tint, leaf->sky), 0.4f};
}

static struct wd_vec3 corner(const struct wd_tree_mesh *mesh, uint32_t i)
{
    const float *p = mesh->vertices[mesh->indices[i]].position_m;
    return WD_V3(p[0], p[1], p[2]);
}

static float mesh_area(const struct wd_tree_mesh *mesh)
{
    float area = 0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        struct wd_vec3 a = corner(mesh, i);
        struct wd_vec3 b = wd_v3_sub(corner(mesh, i + 1), a), c = wd_v3_sub(corner(mesh, i + 2), a);
        area += 0.5f * wd_v3_length(wd_v3_cross(b, c));
    }
    return area;
}

float wd_leaf_unit_area(const struct wd_species *species)
{
    enum { SAMPLES = 8 };
    struct outline outline = outline_of(species);
    struct wd_tree_mesh mesh = {0};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        struct wd_leaf leaf = {.axis = {1, 0, 0}, .normal = {0, 0, 1}, .shading = {0, 0, 1},
                               .size_m = 1, .key = i};
        struct brush brush = brush_of(&mesh, &leaf);
        add_leaf(&brush, species, &outline);
    }
    float area = mesh_area(&mesh) / SAMPLES;
    wd_tree_mesh_finish(&mesh);
    return area;
}

void wd_foliage_mesh(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                     const struct wd_species *species)
{
    struct outline outline = outline_of(species);
    for (size_t i = 0; i < foliage->count; i++) {
        struct brush brush = brush_of(mesh, &foliage->leaves[i]);
        add_leaf(&brush, species, &outline);
    }
}

void wd_foliage_mesh_reduced(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                             const struct wd_species *species, size_t count)
{
    struct outline outline = outline_of(species);
    count = count < foliage->count ? count : foliage->count;
    float kite = 0.5f * outline.width * sqrtf(1 + outline.fold * outline.fold), sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += kite * foliage->leaves[i].size_m * foliage->leaves[i].size_m;
    /* the needles of a tuft hide one another, a kite does not hide itself */
    float seen = is_tuft(species) ? 0.905f : 1;
    float grow = sum > 0 ? sqrtf(seen * foliage->area_m2 / sum) : 1;
    for (size_t i = 0; i < count; i++) {
        struct brush brush = brush_of(mesh, &foliage->leaves[i]);
        if (is_tuft(species)) /* a kite faces one way, the needles it stands for all ways */
            brush.own = 0.1f;
        add_kite(&brush, &outline, grow * brush.leaf->size_m, 0.5f * (1 - 1 / grow));
    }
}
