#include "tree/foliage.h"
#include "tree/leaf_template.h"
#include "tree/look.h"

/* Bytes that the leaves, or flowers, of a full mesh may take with their outlines; more leaves are
 * kites, and more flowers than fit are left out. */
enum { OUTLINE_BYTES = 2200000 };

/* Everything a leaf's vertices have in common. */
struct brush {
    struct wd_tree_mesh *mesh;
    struct wd_vec3 position_m, across, along, above, shading;
    float size_m, flexibility;
    float arch; /* factor of what stands above or below the plane: leaves differ */
    float own;  /* share of the sheet's own normal; the rest is the crown's */
    uint32_t tint;
    uint32_t name; /* of the leaf, in place in a vertex' kind */
};

static struct wd_vec3 to_tree(const struct brush *brush, struct wd_vec3 v)
{
    struct wd_vec3 p = wd_v3_scale(brush->across, v.x);
    return wd_v3_mad(wd_v3_mad(p, brush->along, v.y), brush->above, v.z);
}

static void add_corner(const struct brush *brush, const struct wd_leaf_corner *corner)
{
    struct wd_vec3 local = WD_V3(corner->p.x, corner->p.y, brush->arch * corner->p.z);
    struct wd_vec3 p = wd_v3_mad(brush->position_m, to_tree(brush, local), brush->size_m);
    struct wd_vec3 facing = to_tree(brush, corner->n);
    if (wd_v3_dot(facing, brush->shading) < 0)
        facing = wd_v3_scale(facing, -1);
    struct wd_vec3 n = wd_v3_unit_or(wd_v3_mix(brush->shading, facing, brush->own),
                                     brush->shading);
    float normal[3] = {n.x, n.y, n.z}, bend = brush->flexibility + 45 * corner->stiff;
    struct wd_tree_vertex vertex = {
        .position_m = {p.x, p.y, p.z},
        .normal = wd_pack_normal(normal),
        .uv = wd_pack_uv(corner->u, corner->v),
        .tint = brush->tint,
        .kind = corner->kind | brush->name | (uint32_t)wd_clampf(bend, 0, 255),
    };
    wd_tree_mesh_add_vertex(brush->mesh, &vertex);
}

static void add_template(const struct brush *brush, const struct wd_leaf_template *leaf)
{
    uint32_t first = brush->mesh->vertex_count;
    for (size_t i = 0; i < leaf->corner_count; i++)
        add_corner(brush, &leaf->corners[i]);
    for (size_t i = 0; i < leaf->index_count; i += 3)
        wd_tree_mesh_add_triangle(brush->mesh, first + leaf->indices[i],
                                  first + leaf->indices[i + 1], first + leaf->indices[i + 2]);
}

static struct brush brush_of(struct wd_tree_mesh *mesh, const struct wd_leaf *leaf)
{
    return (struct brush){
        .mesh = mesh,
        .position_m = leaf->position_m,
        .across = wd_v3_cross(leaf->axis, leaf->normal),
        .along = leaf->axis,
        .above = leaf->normal,
        .shading = leaf->shading,
        .size_m = leaf->size_m,
        .flexibility = leaf->flexibility,
        .arch = 1,
        .own = 0.4f,
        .tint = wd_pack_tint(leaf->tint, leaf->sky),
    };
}

/* --- flowers ----------------------------------------------------------------------------- */

/* A flower stands before a leaf that light reaches, turned to it; a panicle stands upright. */
static void add_flower(struct wd_tree_mesh *mesh, const struct wd_leaf *leaf,
                       const struct wd_species *species, const struct wd_leaf_template *flower)
{
    static const float white[3] = {1, 1, 1};
    struct wd_random random = wd_random_of(leaf->key, 0xf10);
    float up = species->flower.petals > 0 ? 0.35f : 2.5f;
    struct brush brush = brush_of(mesh, leaf);
    struct wd_vec3 facing = wd_v3_mad(leaf->shading, WD_V3(0, 0, 1), up);
    brush.above = wd_v3_unit(wd_v3_mad(facing, wd_random_vec3(&random), 0.35f));
    brush.along = wd_v3_square(leaf->axis, brush.above);
    brush.across = wd_v3_cross(brush.along, brush.above);
    brush.size_m = 0.01f * species->flower.size_cm * wd_random_range(&random, 0.75f, 1.1f);
    if (species->leaf.shape == WD_LEAF_BLADE) /* a plume grows with its tuft */
        brush.size_m *= fminf(leaf->size_m / (0.01f * species->leaf.length_cm), 1);
    brush.position_m = wd_v3_mad(leaf->position_m, leaf->shading, 0.3f * leaf->size_m);
    brush.own = 0.6f;
    brush.tint = wd_pack_tint(white, leaf->sky);
    add_template(&brush, flower);
}


/* --- leaves ------------------------------------------------------------------------------ */

float wd_leaf_unit_area(const struct wd_species *species)
{
    float area = 0;
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++) {
        struct wd_leaf_template leaf;
        wd_leaf_template_init(&leaf, species, WD_LEAF_AS_BLADE, i);
        area += wd_leaf_template_area(&leaf) / WD_LEAF_VARIANTS;
        wd_leaf_template_finish(&leaf);
    }
    return area;
}

size_t wd_leaf_least_triangles(const struct wd_species *species)
{
    struct wd_leaf_template leaf;
    wd_leaf_template_init(&leaf, species, WD_LEAF_AS_KITE, 0);
    size_t triangles = leaf.index_count / 3;
    wd_leaf_template_finish(&leaf);
    return triangles ? triangles : 1;
}

static uint32_t pack_vec3(struct wd_vec3 v)
{
    const float normal[3] = {v.x, v.y, v.z};
    return wd_pack_normal(normal);
}

void wd_foliage_records(struct wd_tree_leaf *records, const struct wd_foliage *foliage)
{
    for (size_t i = 0; i < foliage->count; i++) {
        const struct wd_leaf *leaf = &foliage->leaves[i];
        records[i] = (struct wd_tree_leaf){
            .position_m = {leaf->position_m.x, leaf->position_m.y, leaf->position_m.z},
            .axis = pack_vec3(leaf->axis),
            .normal = pack_vec3(leaf->normal),
            .shading = pack_vec3(leaf->shading),
            .tint = wd_pack_tint(leaf->tint, leaf->sky),
            .size_m = leaf->size_m,
            .random = (leaf->key & ~0xffu) | (uint32_t)wd_clampf(leaf->flexibility, 0, 255),
        };
    }
}

static size_t template_bytes(const struct wd_leaf_template *leaf)
{
    return leaf->corner_count * sizeof(struct wd_tree_vertex) +
           leaf->index_count * sizeof(uint32_t);
}

/* With their outlines, or else with few triangles, as many as `bytes` allow. */
static void add_flowers(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                        const struct wd_species *species, enum wd_leaf_form form, size_t bytes)
{
    struct wd_leaf_template flower;
    if (foliage->flower_count == 0)
        return;
    wd_flower_template_init(&flower, species, form);
    if (form == WD_LEAF_AS_BLADE && foliage->flower_count * template_bytes(&flower) > bytes) {
        wd_leaf_template_finish(&flower);
        wd_flower_template_init(&flower, species, WD_LEAF_AS_KITE);
    }
    size_t most = bytes / (template_bytes(&flower) + 1);
    for (size_t i = 0; i < foliage->flower_count && i < most; i++)
        add_flower(mesh, &foliage->flowers[i], species, &flower);
    wd_leaf_template_finish(&flower);
}

static void add_leaves(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                       const struct wd_species *species, enum wd_leaf_form form)
{
    struct wd_leaf_template leaves[WD_LEAF_VARIANTS];
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++)
        wd_leaf_template_init(&leaves[i], species, form, i);
    bool sheet = species->leaf.shape != WD_LEAF_NEEDLES;
    for (size_t i = 0; i < foliage->count; i++) {
        const struct wd_leaf *leaf = &foliage->leaves[i];
        struct brush brush = brush_of(mesh, leaf);
        if (sheet && species->leaf.arch <= 0)
            brush.arch = 0.5f + 1.2f * wd_hash_unit(wd_hash2(leaf->key, 0xb3));
        brush.name = (uint32_t)(i + 1) << WD_VERTEX_LEAF_SHIFT;
        add_template(&brush, &leaves[leaf->key % WD_LEAF_VARIANTS]);
    }
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++)
        wd_leaf_template_finish(&leaves[i]);
}

/* Feathers keep their shape with a quarter of the leaflets, each four times as wide; a fern's pinnae
 * become single leaflets. */
static struct wd_species coarser_fronds(const struct wd_species *species)
{
    struct wd_species coarse = *species;
    if (species->leaf.compound == WD_COMPOUND_BIPINNATE) {
        coarse.leaf.compound = WD_COMPOUND_PINNATE;
        coarse.leaf.shape = WD_LEAF_LANCEOLATE;
        return coarse;
    }
    int64_t leaflets = species->leaf.leaflets / 4 > 6 ? species->leaf.leaflets / 4 : 6;
    coarse.leaf.leaflet_width_cm *= (float)species->leaf.leaflets / (float)leaflets;
    coarse.leaf.leaflets = leaflets;
    return coarse;
}

static bool is_frond(const struct wd_species *species)
{
    return species->leaf.compound == WD_COMPOUND_BIPINNATE ||
           (species->leaf.compound == WD_COMPOUND_PINNATE && species->leaf.leaflets > 16) ||
           (species->leaf.compound == WD_COMPOUND_SIMPLE && species->leaf.shape == WD_LEAF_BLADE);
}

static bool outlines_fit(const struct wd_foliage *foliage, const struct wd_species *species,
                         size_t bytes)
{
    struct wd_leaf_template leaf;
    wd_leaf_template_init(&leaf, species, WD_LEAF_AS_BLADE, 0);
    bool fit = foliage->count * template_bytes(&leaf) <= bytes;
    wd_leaf_template_finish(&leaf);
    return fit;
}

void wd_foliage_mesh(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                     const struct wd_species *species)
{
    struct wd_species drawn = *species;
    if (is_frond(species) && species->leaf.compound != WD_COMPOUND_SIMPLE &&
        !outlines_fit(foliage, species, OUTLINE_BYTES))
        drawn = coarser_fronds(species);
    add_leaves(mesh, foliage, &drawn,
               outlines_fit(foliage, &drawn, OUTLINE_BYTES) ? WD_LEAF_AS_BLADE : WD_LEAF_AS_KITE);
    add_flowers(mesh, foliage, species, WD_LEAF_AS_BLADE, OUTLINE_BYTES);
}

static void add_kites(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                      const struct wd_species *species, size_t count)
{
    /* a kite faces one way, the needles of a brush all ways, and they hide one another */
    bool brushes = species->leaf.shape == WD_LEAF_NEEDLES &&
                   species->leaf.needles != WD_NEEDLES_AROUND;
    struct wd_species plain = *species;
    if (species->leaf.shape == WD_LEAF_NEEDLES) {
        plain.leaf.shape = WD_LEAF_ELLIPTIC;
        plain.leaf.width_cm = (brushes ? 0.75f : 0.5f) * plain.leaf.length_cm;
        plain.leaf.stalk_cm = 0;
    }
    struct wd_leaf_template kite;
    wd_leaf_template_init(&kite, &plain, WD_LEAF_AS_KITE, 0);
    float area = wd_leaf_template_area(&kite), sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += area * foliage->leaves[i].size_m * foliage->leaves[i].size_m;
    float grow = sum > 0 ? sqrtf((brushes ? 0.905f : 1) * foliage->area_m2 / sum) : 1;
    for (size_t i = 0; i < count; i++) {
        const struct wd_leaf *leaf = &foliage->leaves[i];
        struct brush brush = brush_of(mesh, leaf);
        brush.own = brushes ? 0.1f : brush.own;
        brush.size_m *= grow;
        /* an enlarged leaf grows from its middle */
        brush.position_m = wd_v3_mad(leaf->position_m, leaf->axis, 0.5f * leaf->size_m * (1 - grow));
        add_template(&brush, &kite);
    }
    wd_leaf_template_finish(&kite);
}

void wd_foliage_mesh_reduced(struct wd_tree_mesh *mesh, const struct wd_foliage *foliage,
                             const struct wd_species *species, size_t count)
{
    struct wd_species coarse = *species;
    if (is_frond(species) && species->leaf.compound != WD_COMPOUND_SIMPLE)
        coarse = coarser_fronds(species);
    if (is_frond(species) && foliage->count <= count &&
        outlines_fit(foliage, &coarse, OUTLINE_BYTES / 4))
        add_leaves(mesh, foliage, &coarse, WD_LEAF_AS_BLADE);
    else
        add_kites(mesh, foliage, species, count < foliage->count ? count : foliage->count);
    add_flowers(mesh, foliage, species, WD_LEAF_AS_KITE, OUTLINE_BYTES / 4);
}
