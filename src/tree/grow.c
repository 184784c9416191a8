#include "tree/grow.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "tree/coverage.h"
#include "tree/foliage.h"
#include "tree/fronds.h"
#include "tree/leaf_spray.h"
#include "tree/import.h"
#include "tree/wood.h"

enum {
    FULL_WOOD_TRIANGLES = 25000, /* at detail 1, with the least */
    LEAST_WOOD_TRIANGLES = 1000,
    REDUCED_WOOD_TRIANGLES = 1600,
    REDUCED_LEAVES = 2600, /* two triangles each */
    LEAST_SIDES = 3,
    MOST_STEP = 32,
};
#define MOST_RADIUS_M 20.0f /* no branch is thicker */

/* Leaves out the thinnest branches until the rest fits the budget. Stems are never left out: where
 * they alone are too much they get fewer sides and rings. */
static void fit_wood(struct wd_wood_style *style, const struct wd_skeleton *skeleton,
                     const struct wd_species *species, size_t triangles)
{
    struct wd_wood_style stems = *style;
    stems.least_radius_m = INFINITY;
    while (wd_wood_triangles(skeleton, species, &stems) > triangles &&
           (stems.most_sides > LEAST_SIDES || stems.node_step < MOST_STEP)) {
        stems.node_step *= stems.most_sides > LEAST_SIDES ? 1 : 2;
        stems.most_sides -= stems.most_sides > LEAST_SIDES;
    }
    style->most_sides = stems.most_sides;
    style->node_step = stems.node_step;
    while (style->least_radius_m < MOST_RADIUS_M &&
           wd_wood_triangles(skeleton, species, style) > triangles)
        style->least_radius_m = 1.08f * style->least_radius_m + 1e-4f;
}

static void build_full(struct wd_tree_mesh *mesh, const struct wd_skeleton *skeleton,
                       const struct wd_foliage *foliage, const struct wd_tree_form *form)
{
    float least = form->species->leaf.shape == WD_LEAF_NEEDLES ? 0.0055f : 0;
    struct wd_wood_style style = {least * fminf(form->scale, 1), 1, 12};
    fit_wood(&style, skeleton, form->species,
             (size_t)(FULL_WOOD_TRIANGLES * form->detail) + LEAST_WOOD_TRIANGLES);
    wd_wood_mesh(mesh, skeleton, form, &foliage->crown, &style);
    mesh->wood_index_count = mesh->index_count;
    wd_foliage_mesh(mesh, foliage, form->species);
}

/* The thickest branches that the budget allows, with few sides and a ring at every third node. */
static void build_reduced(struct wd_tree_mesh *mesh, const struct wd_skeleton *skeleton,
                          const struct wd_foliage *foliage, const struct wd_tree_form *form)
{
    struct wd_wood_style style = {0.002f, 4, 5};
    fit_wood(&style, skeleton, form->species, REDUCED_WOOD_TRIANGLES);
    wd_wood_mesh(mesh, skeleton, form, &foliage->crown, &style);
    mesh->wood_index_count = mesh->index_count;
    wd_foliage_mesh_reduced(mesh, foliage, form->species, REDUCED_LEAVES);
}

/* Fronds arch and plumes stand over them: their mesh is asked. */
static float foliage_top_m(const struct wd_foliage *foliage, const struct wd_species *species)
{
    float top = 0;
    if (wd_species_has_fronds(species)) {
        struct wd_tree_mesh mesh = {0};
        wd_foliage_mesh(&mesh, foliage, species);
        wd_tree_mesh_update_bounds(&mesh);
        top = mesh.vertex_count ? mesh.max_m[2] : 0;
        wd_tree_mesh_finish(&mesh);
        return top;
    }
    for (size_t i = 0; i < foliage->count; i++) {
        const struct wd_leaf *leaf = &foliage->leaves[i];
        top = wd_maxf(top, leaf->position_m.z + wd_maxf(leaf->axis.z, 0) * leaf->size_m);
    }
    return top;
}

/* Growth itself ends near the asked height: wood and leaves are brought to it before stems get
 * their thickness, so that the stem is as thick as asked too. A hedge's height is its cut's. */
static void fit_height(struct wd_skeleton *skeleton, struct wd_foliage *foliage,
                       struct wd_tree_form *form)
{
    float top = foliage_top_m(foliage, form->species);
    for (size_t i = 0; i < skeleton->node_count; i++)
        top = wd_maxf(top, skeleton->nodes[i].position_m.z);
    if (form->clip || !(top > 0))
        return;
    float factor = form->height_m / top;
    wd_skeleton_scale(skeleton, factor);
    wd_foliage_scale(foliage, factor);
    form->crown_base_m = wd_minf(factor * form->crown_base_m, 0.98f * form->height_m);
}

static void scale_mesh(struct wd_tree_mesh *mesh, float factor)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++)
            mesh->vertices[i].position_m[axis] *= factor;
    wd_tree_mesh_update_bounds(mesh);
}

enum { SECTORS = 16 };

static void add_reach(float reach_m[SECTORS], struct wd_vec3 p)
{
    double turn = wd_datan2((double)p.y, (double)p.x) / (2 * WD_PI) + 0.5;
    int sector = (int)(turn * SECTORS) % SECTORS;
    reach_m[sector] = fmaxf(reach_m[sector], sqrtf(p.x * p.x + p.y * p.y));
}

/* Mean over sixteen sectors of how far leaves and, where these have fallen, branches reach out. */
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
    for (int i = 0; i < SECTORS; i++)
        sum += reach_m[i];
    return sum / SECTORS;
}

/* Records of the leaves and the twig they stand for, by their mean size. */
static void build_spray(struct wd_tree_model *model, const struct wd_foliage *foliage,
                        const struct wd_species *species)
{
    double area = 0;
    for (size_t i = 0; i < foliage->count; i++)
        area += (double)(foliage->leaves[i].size_m * foliage->leaves[i].size_m);
    if (foliage->count == 0 || foliage->count > UINT32_MAX >> (WD_VERTEX_LEAF_SHIFT + 1))
        return;
    wd_leaf_spray_mesh(&model->spray, species, (float)sqrt(area / (double)foliage->count));
    if (model->spray.index_count == 0)
        return;
    model->leaves = wd_alloc_array(foliage->count, sizeof *model->leaves);
    model->leaf_count = (uint32_t)foliage->count;
    model->spray_reach = species->leaf.shape == WD_LEAF_NEEDLES ? 0.5f : 1;
    wd_foliage_records(model->leaves, foliage);
}

/* The mesh is brought to exactly the asked height: leaves end a little beside their axes. */
static void finish_model(struct wd_tree_model *model, const struct wd_skeleton *skeleton,
                         const struct wd_foliage *foliage, const struct wd_tree_form *form)
{
    wd_tree_mesh_update_bounds(&model->full);
    float factor = form->clip ? 1 : form->height_m / model->full.max_m[2];
    scale_mesh(&model->full, factor);
    scale_mesh(&model->reduced, factor);
    wd_tree_mesh_fit_coverage(&model->reduced, &model->full);
    for (uint32_t i = 0; i < model->leaf_count; i++) {
        model->leaves[i].size_m *= factor;
        for (int axis = 0; axis < 3; axis++)
            model->leaves[i].position_m[axis] *= factor;
    }
    model->height_m = form->height_m;
    model->crown_radius_m = factor * crown_radius_m(foliage, skeleton);
    if (form->clip)
        model->crown_radius_m = wd_hedge_reach_m(form->clip->max_m[0] - form->clip->min_m[0],
                                                 form->clip->max_m[1] - form->clip->min_m[1]);
    model->crown_base_m = factor * form->crown_base_m;
    model->dbh_m = factor * form->dbh_m;
    model->leaf_area_m2 = factor * factor * foliage->area_m2;
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
        resolved.clip = &own;
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
    build_full(&model->full, &skeleton, &foliage, &form);
    build_reduced(&model->reduced, &skeleton, &foliage, &form);
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
        wd_tree_mesh_finish(&model->spray);
        free(model->leaves);
    }
    *model = (struct wd_tree_model){0};
}
