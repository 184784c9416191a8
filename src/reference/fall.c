#include "reference/fall.h"

#include "shared/frame.h"
#include "shared/hash.h"

/* A leaf of 8 cm is a pixel wide at some 100 m. */
static const float FALL_REACH_M = 250.0f;

void wd_trace_foot(const struct wd_frame_uniforms *frame, const struct wd_tree *tree,
                   float foot_m[3])
{
    const int32_t foot_mm[3] = {tree->x_mm, tree->y_mm, tree->z_mm};
    for (int k = 0; k < 3; k++)
        foot_m[k] =
            (float)(foot_mm[k] - frame->camera_mm[k]) * 0.001f - frame->camera_frac_m[k];
}

bool wd_trace_falls(const struct wd_trace_model *model, const float foot_m[3])
{
    return model->model.fall_mps > 0 &&
           foot_m[0] * foot_m[0] + foot_m[1] * foot_m[1] < FALL_REACH_M * FALL_REACH_M;
}

/* Leaves stand last in the mesh, one after another. */
static uint32_t first_vertex(const struct wd_tree_model *grown)
{
    const struct wd_leaf_set *set = &grown->sets[0][WD_SET_LEAVES];
    return grown->full.vertex_count - set->leaf_count * set->corner_count;
}

static struct wd_leaf_fall fall_of(const struct wd_trace_scene *scene, const struct wd_tree *tree,
                                   uint32_t leaf)
{
    const struct wd_frame_uniforms *frame = scene->frame;
    const struct wd_trace_model *model = wd_trace_model_of(scene->models, tree);
    const struct wd_wind wind = {frame->wind_speed_mps, frame->wind_gust, frame->wind_toward[0],
                                 frame->wind_toward[1]};
    return wd_leaf_fall_of(wd_leaf_foot(model->grown.leaves[leaf], model->grown.leaf_box),
                           model->model, wd_tree_pose_of(*tree, model->model), wind,
                           wd_hash2(leaf, wd_tree_random(*tree)), frame->time_s);
}

/* Wood, of which there is none to speak of, comes before. */
static bool leaf_of(const struct wd_tree_model *grown, uint32_t vertex, uint32_t *leaf)
{
    const struct wd_leaf_set *set = &grown->sets[0][WD_SET_LEAVES];
    uint32_t first = first_vertex(grown);
    *leaf = vertex >= first && set->corner_count ? (vertex - first) / set->corner_count : 0;
    return vertex >= first && set->corner_count;
}

struct wd_leaf_fall wd_trace_fall_at(const struct wd_trace_scene *scene, const struct wd_tree *tree,
                                     uint32_t triangle)
{
    const struct wd_tree_model *grown = &wd_trace_model_of(scene->models, tree)->grown;
    uint32_t leaf;
    if (leaf_of(grown, grown->full.indices[3 * (size_t)triangle], &leaf))
        return fall_of(scene, tree, leaf);
    return (struct wd_leaf_fall){.about = {0, 0, 1}, .turn_cos = 1};
}

static void fill_places(float (*places)[3], const struct wd_trace_scene *scene,
                        const struct wd_tree *tree)
{
    const struct wd_tree_model *grown = &wd_trace_model_of(scene->models, tree)->grown;
    struct wd_leaf_fall fall = {0};
    struct wd_vec3 foot = {0};
    uint32_t last = UINT32_MAX, leaf;
    for (uint32_t i = 0; i < grown->full.vertex_count; i++) {
        struct wd_vec3 place = wd_v3_of(grown->full.vertices[i].position_m);
        if (leaf_of(grown, i, &leaf)) {
            if (leaf != last) {
                fall = fall_of(scene, tree, leaf);
                foot = wd_leaf_foot(grown->leaves[leaf], grown->leaf_box);
                last = leaf;
            }
            place = wd_v3_add(fall.foot_m, wd_leaf_fall_turn(fall, wd_v3_sub(place, foot)));
        }
        places[i][0] = place.x;
        places[i][1] = place.y;
        places[i][2] = place.z;
    }
}

RTCScene wd_trace_fall_scene(const struct wd_trace_scene *scene, const struct wd_tree *tree)
{
    RTCDevice device = scene->models->device;
    const struct wd_tree_mesh *mesh = &wd_trace_model_of(scene->models, tree)->grown.full;
    RTCScene leaves = wd_trace_new_scene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float(*places)[3] = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                RTC_FORMAT_FLOAT3, sizeof *places,
                                                mesh->vertex_count);
    if (places) /* else Embree's error is found with the others */
        fill_places(places, scene, tree);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->indices,
                               0, 3 * sizeof *mesh->indices, mesh->index_count / 3);
    rtcSetGeometryMask(geometry, UINT32_MAX);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(leaves, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(leaves);
    return leaves;
}
