#include "methods/leaf_view.h"

#include <math.h>

struct wd_stand wd_stand_of(const struct wd_tree_draw *draw, uint32_t tree)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_tree *record = &forest->world->trees[tree];
    const int32_t place_mm[3] = {record->x_mm, record->y_mm, record->z_mm};
    struct wd_stand stand = {
        .pose = wd_tree_pose_of(*record, forest->host_models[wd_forest_model_of(forest, record)])};
    for (int k = 0; k < 3; k++)
        stand.foot[k] = (float)(place_mm[k] * 0.001 - draw->view->eye_m[k]);
    return stand;
}

void wd_stand_place(const struct wd_stand *stand, struct wd_vec3 in_tree, float at[3])
{
    const struct wd_tree_pose *pose = &stand->pose;
    float x = in_tree.x * pose->mirror, y = in_tree.y;
    at[0] = stand->foot[0] + (pose->turn_cos * x - pose->turn_sin * y) * pose->across;
    at[1] = stand->foot[1] + (pose->turn_sin * x + pose->turn_cos * y) * pose->across;
    at[2] = stand->foot[2] + in_tree.z * pose->up;
}

/* What a leaf may reach. */
struct reach {
    float size;      /* over the leaf's own, where all leaves stand */
    float px_m;      /* size in pixels of the mesh's leaves, times their distance */
    float most;      /* of wd_leaf_stand */
    float bend_m;    /* way of the top in the wind */
    float flutter_m;
};

/* Drawn leaves lie within 3 of their sizes of their feet; they grow where fewer stand. */
static struct reach reach_of(const struct wd_tree_draw *draw, uint32_t tree,
                             const struct wd_stand *stand)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_tree *record = &forest->world->trees[tree];
    uint32_t index = wd_forest_model_of(forest, record);
    const struct wd_model *model = &forest->host_models[index];
    const struct wd_mesh_range *range = &forest->meshes.ranges[index][WD_LEVEL_MESH];
    float speed_mps = (float)forest->scene->wind.speed_mps, gust = (float)forest->scene->wind.gust;
    float growth = 1.0f;
    for (int i = 0; i < WD_GAIN_SIDES * WD_LEAF_GROWTHS; i++)
        growth = fmaxf(growth, model->full_growth.of[i / WD_LEAF_GROWTHS][i % WD_LEAF_GROWTHS]);
    return (struct reach){
        .size = 3.0f * growth * fmaxf(stand->pose.across, stand->pose.up),
        .px_m = range->leaf_count ? range->leaf_m * stand->pose.across *
                                        wd_leaf_pixels(forest, draw->view, draw->pass)
                                  : INFINITY,
        .most = wd_leaf_most(forest, draw->view, draw->pass, index, WD_LEVEL_MESH),
        .bend_m = wd_wind_bend(model->flexibility, speed_mps) * WD_TREE_HEIGHT_M(*record) * (1.0f + 1.5f * gust),
        .flutter_m = 0.006f * fminf(speed_mps, 12.0f),
    };
}

static bool leaf_in_view(const struct wd_view *view, const float at[3], float reach_m)
{
    float min[3], max[3];
    for (int k = 0; k < 3; k++) {
        min[k] = at[k] - reach_m;
        max[k] = at[k] + reach_m;
    }
    return wd_frustum_box(&view->frustum, min, max) != WD_OUTSIDE;
}

uint32_t wd_leaves_in_view(const struct wd_tree_draw *draw, uint32_t tree,
                           const struct wd_leaf_draw *set, uint32_t count, uint32_t *list)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_tree *record = &forest->world->trees[tree];
    uint32_t model = wd_forest_model_of(forest, record);
    const struct wd_twig_range *twigs = &forest->meshes.twigs[model];
    const struct wd_mesh_range *range = &forest->meshes.ranges[model][WD_LEVEL_MESH];
    const uint32_t thinning = set == &range->sets[WD_SET_LEAVES] ? range->leaf_count : 0;
    const float rounding = 1.01f;
    const struct wd_tree_leaf *leaves =
        forest->meshes.host_leaves + twigs->first_leaf + set->first_leaf;
    const struct wd_stand stand = wd_stand_of(draw, tree);
    const struct reach reach = reach_of(draw, tree, &stand);
    float height_m = fmaxf(WD_TREE_HEIGHT_M(*record), 0.01f);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < count; i++) {
        float at[3];
        wd_stand_place(&stand, wd_leaf_foot(leaves[i], twigs->box), at);
        float far_m = sqrtf(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
        float share = wd_leaf_stand(reach.px_m / fmaxf(far_m, 1e-3f), reach.most, stand.pose.across);
        if (thinning && (float)i > rounding * share * (float)thinning)
            continue; /* as shaders/methods/tree_leaf.vert has it */
        float high = (at[2] - stand.foot[2]) / height_m;
        float size_m = reach.size * wd_leaf_size_m(leaves[i], twigs->box) / sqrtf(share);
        float reach_m = size_m + reach.flutter_m + reach.bend_m * high * high;
        list[seen] = i;
        seen += leaf_in_view(draw->view, at, reach_m);
    }
    return seen;
}
