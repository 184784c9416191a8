#include "tree/grow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/clip_mesh.h"
#include "tree/coverage.h"
#include "tree/foliage.h"
#include "tree/fronds.h"
#include "tree/leaf_spray.h"
#include "tree/import.h"
#include "tree/openness.h"
#include "tree/progressive.h"
#include "tree/twigs.h"
#include "tree/wood.h"

enum {
    FULL_WOOD_TRIANGLES = 25000, /* at detail 1, with the least */
    LEAST_WOOD_TRIANGLES = 1000,
    REDUCED_WOOD_TRIANGLES = 1600,
    BARE_WOOD_TRIANGLES = 8000, /* reduced, where no leaves hide branches */
    REDUCED_LEAVES = 4000, /* two triangles each */
    REDUCED_SHOOTS = 2600,
};

/* Both cover as much: fewer shoots are as much wider. */
static const struct wd_twig_style full_twigs = {1, 3, 0.006f};
static const struct wd_twig_style reduced_twigs = {0.36f, 1, 0.026f};

static void build_full_wood(struct wd_tree_mesh *mesh, const struct wd_skeleton *skeleton,
                       const struct wd_foliage *foliage, const struct wd_tree_form *form)
{
    if (form->species->form == WD_FORM_FALLING)
        return; /* leaves in the air: what they have come from stands elsewhere */
    float least = form->species->leaf.shape == WD_LEAF_NEEDLES ? 0.0055f : 0;
    struct wd_wood_style style = {least * fminf(form->scale, 1), 1, 12, 32};
    wd_wood_style_fit(&style, skeleton, form,
                      (size_t)(FULL_WOOD_TRIANGLES * form->detail) + LEAST_WOOD_TRIANGLES);
    wd_wood_mesh(mesh, skeleton, form, &foliage->crown, &style);
    wd_twigs_mesh(mesh, foliage, form, &full_twigs);
    wd_stipes_mesh(mesh, foliage, form);
    mesh->wood_index_count = mesh->index_count;
}

/* The thickest branches that the budget allows, with few sides and a ring at every fourth node. */
static void build_reduced_wood(struct wd_tree_model *model, const struct wd_skeleton *skeleton,
                          const struct wd_foliage *foliage, const struct wd_tree_form *form)
{
    struct wd_tree_mesh *mesh = &model->reduced;
    if (form->species->form == WD_FORM_FALLING)
        return;
    bool bare = foliage->twig_count > 0;
    struct wd_wood_style style = {0.002f, bare ? 2 : 4, 5, 16};
    wd_wood_style_fit(&style, skeleton, form, bare ? BARE_WOOD_TRIANGLES : REDUCED_WOOD_TRIANGLES);
    wd_wood_mesh(mesh, skeleton, form, &foliage->crown, &style);
    const struct wd_wood_style few = {INFINITY, style.node_step, style.most_sides, 0};
    if (mesh->stem_index_count)
        wd_wood_mesh(&model->far_stem, skeleton, form, &foliage->crown, &few);
    model->far_stem.wood_index_count = model->far_stem.index_count;
    wd_twigs_mesh(mesh, foliage, form, &reduced_twigs);
    wd_stipes_mesh(mesh, foliage, form);
    mesh->wood_index_count = mesh->index_count;
}

/* --- leaves ------------------------------------------------------------------------------ */

static struct wd_tree_mesh *mesh_of(struct wd_tree_model *model, int level)
{
    return level ? &model->reduced : &model->full;
}

static void pack_leaves(struct wd_tree_model *model, const struct wd_foliage *foliage,
                        const struct wd_species *species)
{
    model->leaf_count = (uint32_t)foliage->count;
    model->flower_count = (uint32_t)foliage->flower_count;
    model->leaves = wd_alloc_array(foliage->count + foliage->flower_count + 1,
                                   sizeof *model->leaves);
    wd_foliage_pack(model->leaves, &model->leaf_box, foliage, species);
}

/* Where a set's places begin. */
static const struct wd_tree_leaf *set_leaves(const struct wd_tree_model *model, int kind)
{
    return model->leaves + (kind == WD_SET_FLOWERS ? model->leaf_count : 0);
}

static void add_sets(struct wd_tree_model *model, int level)
{
    struct wd_tree_mesh *mesh = mesh_of(model, level);
    for (int kind = 0; kind < WD_LEAF_SETS; kind++) {
        const struct wd_leaf_set *set = &model->sets[level][kind];
        if (set->leaf_count)
            wd_leaf_set_mesh(set, set_leaves(model, kind), &model->leaf_box, mesh);
    }
    wd_tree_mesh_update_bounds(mesh);
}

/* Wood's vertices come first. */
static uint32_t wood_vertices(const struct wd_tree_model *model, int level)
{
    uint32_t count = level ? model->reduced.vertex_count : model->full.vertex_count;
    for (int kind = 0; kind < WD_LEAF_SETS; kind++)
        count -= model->sets[level][kind].leaf_count * model->sets[level][kind].corner_count;
    return count;
}

/* Leaves that are there already, after their forms' corners have moved. */
static void move_sets(struct wd_tree_model *model, int level)
{
    struct wd_tree_mesh *mesh = mesh_of(model, level);
    struct wd_tree_vertex *vertices = mesh->vertices + wood_vertices(model, level);
    for (int kind = 0; kind < WD_LEAF_SETS; kind++) {
        const struct wd_leaf_set *set = &model->sets[level][kind];
        if (set->leaf_count)
            wd_leaf_set_move(set, set_leaves(model, kind), &model->leaf_box, vertices);
        vertices += set->leaf_count * set->corner_count;
    }
    wd_tree_mesh_update_bounds(mesh);
}

static void drop_sets(struct wd_tree_model *model, int level)
{
    struct wd_tree_mesh *mesh = mesh_of(model, level);
    mesh->vertex_count = wood_vertices(model, level);
    mesh->index_count = mesh->wood_index_count;
    mesh->vertex_capacity = mesh->vertex_count + 1;
    mesh->index_capacity = mesh->index_count + 1;
    mesh->vertices = wd_realloc(mesh->vertices, mesh->vertex_capacity * sizeof *mesh->vertices);
    mesh->indices = wd_realloc(mesh->indices, mesh->index_capacity * sizeof *mesh->indices);
}

static bool has_leaf_triangles(const struct wd_tree_model *model)
{
    return model->full.index_count > model->full.wood_index_count ||
           model->reduced.index_count > model->reduced.wood_index_count;
}

void wd_tree_model_add_leaves(struct wd_tree_model *model)
{
    if (!model->leaves || has_leaf_triangles(model))
        return;
    add_sets(model, 0);
    add_sets(model, 1);
}

static void order_by_place(struct wd_tree_leaf *leaves, size_t count, const struct wd_leaf_box *box)
{
    struct wd_vec3 *feet = wd_alloc_array(count + 1, sizeof *feet);
    uint32_t *order = wd_alloc_array(count + 1, sizeof *order);
    struct wd_tree_leaf *before = wd_alloc_array(count + 1, sizeof *before);
    memcpy(before, leaves, count * sizeof *leaves);
    for (size_t i = 0; i < count; i++)
        feet[i] = wd_leaf_foot(leaves[i], *box);
    wd_curve_order(order, feet, count);
    for (size_t i = 0; i < count; i++)
        leaves[i] = before[order[i]];
    free(feet);
    free(order);
    free(before);
}

void wd_tree_model_add_leaves_by_place(struct wd_tree_model *model)
{
    if (!model->leaves || has_leaf_triangles(model))
        return;
    order_by_place(model->leaves, model->leaf_count, &model->leaf_box);
    order_by_place(model->leaves + model->leaf_count, model->flower_count, &model->leaf_box);
    add_sets(model, 0);
}

void wd_tree_model_drop_leaves(struct wd_tree_model *model)
{
    for (int level = 0; level < 2 && model->leaves; level++)
        if (mesh_of(model, level)->index_count > mesh_of(model, level)->wood_index_count)
            drop_sets(model, level);
}

static float sets_top_m(const struct wd_tree_model *model)
{
    float top = 0;
    for (int kind = 0; kind < WD_LEAF_SETS; kind++)
        top = wd_maxf(top, wd_leaf_set_top_m(&model->sets[0][kind], set_leaves(model, kind),
                                             &model->leaf_box));
    return top;
}

/* --- sizes ------------------------------------------------------------------------------- */

/* Fronds arch and plumes stand over them: their forms are asked. */
static float foliage_top_m(const struct wd_foliage *foliage, const struct wd_species *species)
{
    float top = 0, reach = wd_foliage_reach(foliage, species);
    if (wd_species_has_fronds(species)) {
        struct wd_tree_model model = {0};
        pack_leaves(&model, foliage, species);
        wd_foliage_sets(model.sets[0], foliage, species);
        top = sets_top_m(&model);
        wd_tree_model_finish(&model);
        return top;
    }
    for (size_t i = 0; i < foliage->count; i++) {
        const struct wd_leaf *leaf = &foliage->leaves[i];
        top = wd_maxf(top, leaf->position_m.z + wd_maxf(leaf->axis.z, 0) * reach * leaf->size_m);
    }
    return top;
}

/* A rootstock without its leaves stands no higher than with them. */
static bool is_bare_rootstock(const struct wd_foliage *foliage, const struct wd_tree_form *form)
{
    bool low = form->species->form == WD_FORM_FERN || form->species->form == WD_FORM_GRASS;
    return low && foliage->count == 0 && foliage->flower_count == 0;
}

/* Growth itself ends near the asked height: wood and leaves are brought to it before stems get
 * their thickness, so that the stem is as thick as asked too. A hedge's height is its cut's. */
static void fit_height(struct wd_skeleton *skeleton, struct wd_foliage *foliage,
                       struct wd_tree_form *form)
{
    float top = foliage_top_m(foliage, form->species);
    for (size_t i = 0; i < skeleton->node_count; i++)
        top = wd_maxf(top, skeleton->nodes[i].position_m.z);
    if (form->clip || !(top > 0) || is_bare_rootstock(foliage, form))
        return;
    float factor = form->height_m / top;
    wd_skeleton_scale(skeleton, factor);
    wd_foliage_scale(foliage, factor);
    form->crown_base_m = wd_minf(factor * form->crown_base_m, 0.98f * form->height_m);
    form->bole_m *= factor;
}

static void scale_mesh(struct wd_tree_mesh *mesh, float factor)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++)
            mesh->vertices[i].position_m[axis] *= factor;
    wd_tree_mesh_update_bounds(mesh);
}

enum { SECTORS = 16 };

/* One of sixteen parts of the circle round the axis: quadrant, half, quarter. */
static int sector_of(float x, float y)
{
    float ax = fabsf(x), ay = fabsf(y);
    bool steep = ay > ax;
    float least = steep ? ax : ay, most = steep ? ay : ax;
    int quarter = least > 0.41421356f * most; /* tan 22.5 degrees */
    int sector = steep ? 3 - quarter : quarter;
    return sector | (x < 0 ? 4 : 0) | (y < 0 ? 8 : 0);
}

static void add_reach(float reach_m[SECTORS], struct wd_vec3 p)
{
    int sector = sector_of(p.x, p.y);
    reach_m[sector] = wd_maxf(reach_m[sector], sqrtf(p.x * p.x + p.y * p.y));
}

/* Mean, over those of sixteen sectors that they reach into, of how far leaves and, where these have fallen,
 * branches reach out: a fern's dozen fronds leave sectors empty. */
static float crown_radius_m(const struct wd_foliage *foliage, const struct wd_skeleton *skeleton)
{
    float reach_m[SECTORS] = {0}, sum = 0;
    for (size_t i = 0; i < foliage->count; i++) {
        const struct wd_leaf *leaf = &foliage->leaves[i];
        add_reach(reach_m, wd_v3_mad(leaf->position_m, leaf->axis, leaf->size_m));
    }
    for (size_t i = 0; i < skeleton->branch_count; i++) {
        const struct wd_branch *branch = &skeleton->branches[i];
        if (branch->node_count)
            add_reach(reach_m,
                      skeleton->nodes[branch->first_node + branch->node_count - 1].position_m);
    }
    int reached = 0;
    for (int i = 0; i < SECTORS; i++) {
        sum += reach_m[i];
        reached += reach_m[i] > 0;
    }
    return sum / (float)(reached ? reached : 1);
}

/* The twig that a leaf of mean size stands for. */
static void build_spray(struct wd_tree_model *model, const struct wd_foliage *foliage,
                        const struct wd_species *species)
{
    if (foliage->count == 0)
        return;
    wd_leaf_spray_mesh(&model->spray, species, wd_foliage_mean_m(foliage));
    wd_leaf_spray_shade_mesh(&model->spray_shade, species, wd_foliage_mean_m(foliage));
    if (model->spray.index_count == 0)
        return;
    model->spray_reach = species->leaf.shape == WD_LEAF_NEEDLES ? 0.8f : 1;
    model->spray_forms = wd_leaf_spray_forms(species);
}

/* Leaves and flowers of the reduced mesh get the size with which it covers as much as the full one. */
static void fit_reduced(struct wd_tree_model *model)
{
    float factors[WD_LEAF_SETS];
    wd_tree_mesh_fit_coverage(&model->reduced, &model->full, factors);
    for (int kind = 0; kind < WD_LEAF_SETS; kind++)
        wd_leaf_set_scale_parts(&model->sets[1][kind], factors[kind]);
    move_sets(model, 1);
}

/* The mesh is brought to exactly the asked height: leaves end a little beside their axes. */
static void finish_model(struct wd_tree_model *model, const struct wd_skeleton *skeleton,
                         const struct wd_foliage *foliage, const struct wd_tree_form *form)
{
    wd_tree_mesh_update_bounds(&model->full);
    float top = wd_maxf(model->full.max_m[2], sets_top_m(model));
    bool bare = is_bare_rootstock(foliage, form);
    float factor = form->clip || bare ? 1 : form->height_m / top;
    scale_mesh(&model->full, factor);
    scale_mesh(&model->reduced, factor);
    scale_mesh(&model->far_stem, factor);
    wd_leaf_box_scale(&model->leaf_box, factor);
    model->leaf_area_m2 = factor * factor * foliage->area_m2;
    wd_tree_model_add_leaves(model);
    wd_tree_model_fit_openness(model);
    if (has_leaf_triangles(model))
        fit_reduced(model);
    model->height_m = form->height_m;
    model->crown_radius_m = bare ? form->crown_radius_m : factor * crown_radius_m(foliage, skeleton);
    if (form->clip)
        model->crown_radius_m = wd_hedge_reach_m(form->clip->max_m[0] - form->clip->min_m[0],
                                                 form->clip->max_m[1] - form->clip->min_m[1]);
    model->crown_base_m = factor * form->crown_base_m;
    model->dbh_m = factor * form->dbh_m;
}

bool wd_tree_grow(struct wd_tree_model *model, const struct wd_species *species,
                  const struct wd_grow_params *params, const struct wd_log *log)
{
    *model = (struct wd_tree_model){0};
    if (species->imported) {
        *model = species->imported->model;
        model->borrowed = true;
        return true;
    }
    struct wd_grow_params resolved = *params;
    const struct wd_clip_volume own = wd_clip_box(species->clip_box_m);
    if (!resolved.clip && species->clip_box_m[2] > 0)
        resolved.clip = species->clip ? &species->clip->volume : &own;
    if (!wd_grow_params_resolve(&resolved, species, log))
        return false;
    struct wd_tree_form form = wd_tree_form_of(species, &resolved);
    struct wd_clip_grid clip;
    if (resolved.clip && !wd_clip_grid_init(&clip, resolved.clip, log))
        return false;
    if (resolved.clip)
        wd_tree_form_clip(&form, &clip);
    struct wd_skeleton skeleton;
    struct wd_foliage foliage;
    if (!wd_skeleton_grow(&skeleton, &form, log))
        return false;
    wd_foliage_grow(&foliage, &skeleton, &form);
    fit_height(&skeleton, &foliage, &form);
    wd_skeleton_set_radii(&skeleton, &form);
    build_full_wood(&model->full, &skeleton, &foliage, &form);
    build_reduced_wood(model, &skeleton, &foliage, &form);
    pack_leaves(model, &foliage, species);
    wd_foliage_sets(model->sets[0], &foliage, species);
    model->flower_count = model->sets[0][WD_SET_FLOWERS].leaf_count; /* more than fit are left out */
    bool needles = species->leaf.shape == WD_LEAF_NEEDLES;
    wd_foliage_sets_reduced(model->sets[1], &foliage, species,
                            needles ? REDUCED_SHOOTS : REDUCED_LEAVES);
    build_spray(model, &foliage, form.species);
    finish_model(model, &skeleton, &foliage, &form);
    model->age_years = resolved.age_years;
    wd_foliage_finish(&foliage);
    wd_skeleton_finish(&skeleton);
    return true;
}

void wd_tree_model_finish(struct wd_tree_model *model)
{
    if (!model->borrowed) {
        wd_tree_mesh_finish(&model->full);
        wd_tree_mesh_finish(&model->reduced);
        wd_tree_mesh_finish(&model->far_stem);
        wd_tree_mesh_finish(&model->spray);
        wd_tree_mesh_finish(&model->spray_shade);
        for (int i = 0; i < 2 * WD_LEAF_SETS; i++)
            wd_leaf_set_finish(&model->sets[i / WD_LEAF_SETS][i % WD_LEAF_SETS]);
        free(model->leaves);
    }
    *model = (struct wd_tree_model){0};
}
