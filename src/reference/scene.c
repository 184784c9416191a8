#include "reference/scene.h"

#include <math.h>

#include "base/log.h"
#include "reference/fall.h"
#include "shared/frame.h"
#include "shared/hash.h"

/* Rays begin a little off the surface that they leave; what they meet nearer than this is that
 * surface itself. */
static const float NEAR_M = 1e-3f;

/* Where the crown's mass is: the model's bend, which grows with the square of height, is replaced
 * by a lean that agrees there. */
static const float LEAN_HEIGHT = 0.7f;

/* --- placing trees ----------------------------------------------------------------------- */

/* Columns x, y, z, translation. */
static void tree_transform(const struct wd_trace_scene *scene, const struct wd_tree *tree,
                           const struct wd_model *model, float m[12])
{
    const struct wd_frame_uniforms *frame = scene->frame;
    struct wd_tree_pose pose = wd_tree_pose_of(*tree, *model);
    float lean[3] = {0, 0, 0}, height_m = LEAN_HEIGHT * WD_TREE_HEIGHT_M(*tree);
    if (frame->wind_speed_mps > 0 && height_m > 0) {
        const struct wd_wind wind = {frame->wind_speed_mps, frame->wind_gust,
                                     frame->wind_toward[0], frame->wind_toward[1]};
        struct wd_wind_shift shift = wd_wind_offset(
            wind, wd_wind_tree_of(*tree, model->flexibility), height_m, frame->time_s);
        lean[0] = shift.x_m / height_m;
        lean[1] = shift.y_m / height_m;
        lean[2] = shift.z_m / height_m;
    }
    float across = pose.across, x = across * pose.mirror;
    const float columns[12] = {pose.turn_cos * x,       pose.turn_sin * x,      0,
                               -pose.turn_sin * across, pose.turn_cos * across, 0,
                               lean[0] * pose.up,       lean[1] * pose.up,      (1 + lean[2]) * pose.up,
                               0,                       0,                      0};
    for (int k = 0; k < 12; k++)
        m[k] = columns[k];
    wd_trace_foot(frame, tree, m + 9);
}

/* Layers come and go with distance, tree by tree. */
static bool is_shown(const struct wd_trace_scene *scene, size_t index, const float at[3])
{
    uint32_t layer = scene->world->layer_of_tree[index];
    if (layer >= scene->scene->layer_count)
        return true;
    const struct wd_scene_layer *from = &scene->scene->layers[layer];
    const struct wd_layer_fade fade = {
        (float)from->fade_near_m[0], (float)from->fade_near_m[1], (float)from->fade_far_m[0],
        (float)from->fade_far_m[1]};
    float distance_m = sqrtf(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
    uint32_t random = wd_tree_random(scene->world->trees[index]);
    return wd_hash_unit(random) < wd_layer_show(fade, distance_m);
}

static void add_instance(struct wd_trace_scene *scene, size_t index, RTCScene model,
                         const float m[12])
{
    RTCGeometry instance = rtcNewGeometry(scene->models->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, model);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
    rtcSetGeometryMask(instance, UINT32_MAX);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene->top, instance, (unsigned)index);
    rtcReleaseGeometry(instance);
}

static void place_tree(struct wd_trace_scene *scene, size_t index)
{
    const struct wd_tree *tree = &scene->world->trees[index];
    const struct wd_trace_model *model = wd_trace_model_of(scene->models, tree);
    float m[12];
    tree_transform(scene, tree, &model->model, m);
    if (!is_shown(scene, index, m + 9))
        return;
    wd_trace_near_add(&scene->near, model, tree, (uint32_t)index, m);
    RTCScene own = wd_trace_falls(model, m + 9) ? wd_trace_fall_scene(scene, tree) : NULL;
    add_instance(scene, index, own ? own : model->scene, m);
    if (own)
        rtcReleaseScene(own); /* the instance keeps it */
}

static void place_twigs(struct wd_trace_scene *scene, const struct wd_trace_view *view)
{
    const struct wd_trace_near_scene about = {scene->models, scene->world->trees, view, scene->frame};
    wd_trace_near_build(&scene->near, &about);
    for (size_t i = 0; i < scene->near.count; i++) {
        const struct wd_trace_near_tree *at = &scene->near.trees[i];
        if (at->twigs)
            add_instance(scene, scene->world->tree_count + 1 + i, at->twigs->scene, at->transform);
    }
}

bool wd_trace_scene_init(struct wd_trace_scene *scene, const struct wd_trace_models *models,
                         const struct wd_scene *description, const struct wd_world *world,
                         const struct wd_frame_uniforms *frame, const struct wd_trace_view *view,
                         const struct wd_log *log)
{
    RTCDevice device = models->device;
    double origin_m[3];
    *scene = (struct wd_trace_scene){0};
    if (!wd_demand_is_none(&world->demand, "the path tracer", log))
        return false;
    *scene = (struct wd_trace_scene){
        .world = world, .scene = description, .models = models, .frame = frame};
    for (int k = 0; k < 3; k++)
        origin_m[k] = frame->camera_mm[k] * 0.001 + (double)frame->camera_frac_m[k];
    wd_trace_ground_init(&scene->ground, device, &world->terrain, origin_m);
    scene->top = wd_trace_new_scene(device);
    rtcAttachGeometryByID(scene->top, scene->ground.geometry, (unsigned)world->tree_count);
    for (size_t i = 0; i < world->tree_count; i++)
        place_tree(scene, i);
    place_twigs(scene, view);
    rtcCommitScene(scene->top);
    enum RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE)
        return true;
    wd_trace_scene_finish(scene);
    return wd_error(log, "no memory, or a fault in Embree (error %d), for %zu trees", (int)error,
                    world->tree_count);
}

void wd_trace_scene_finish(struct wd_trace_scene *scene)
{
    if (scene->top)
        rtcReleaseScene(scene->top);
    wd_trace_ground_finish(&scene->ground);
    wd_trace_near_finish(&scene->near);
    *scene = (struct wd_trace_scene){0};
}

/* --- rays ---------------------------------------------------------------------------------- */

static struct RTCRay embree_ray(const struct wd_trace_ray *ray)
{
    return (struct RTCRay){
        .org_x = ray->from.x,
        .org_y = ray->from.y,
        .org_z = ray->from.z,
        .tnear = NEAR_M,
        .dir_x = ray->direction.x,
        .dir_y = ray->direction.y,
        .dir_z = ray->direction.z,
        .tfar = ray->far_m,
        .mask = UINT32_MAX,
    };
}

/* What Embree's filters are told of a ray. */
struct context {
    struct RTCIntersectContext of_embree; /* first */
    const struct wd_trace_scene *scene;
};

/* Rays come one at a time; twigs' ids are no tree's. */
static void pass_hidden(const struct RTCFilterFunctionNArguments *args)
{
    const struct wd_trace_scene *scene = ((const struct context *)args->context)->scene;
    const struct RTCHit *hit = (const struct RTCHit *)args->hit;
    uint32_t tree = hit->instID[0];
    if (args->N == 1 && args->valid[0] == -1 && tree < scene->world->tree_count &&
        wd_trace_near_hides(&scene->near, wd_trace_model_of(scene->models, &scene->world->trees[tree]), tree,
                            hit->primID))
        args->valid[0] = 0;
}

static void context_init(struct context *context, const struct wd_trace_scene *scene)
{
    rtcInitIntersectContext(&context->of_embree);
    context->of_embree.filter = scene->near.count ? pass_hidden : NULL;
    context->scene = scene;
}

const struct wd_trace_model *wd_trace_hit_model(const struct wd_trace_scene *scene, const struct wd_trace_hit *hit)
{
    return hit->twig ? wd_trace_near_twigs(&scene->near, hit->tree)
                     : wd_trace_model_of(scene->models, &scene->world->trees[hit->tree]);
}

struct wd_trace_hit wd_trace_nearest(const struct wd_trace_scene *scene,
                                     const struct wd_trace_ray *ray)
{
    struct RTCRayHit rayhit = {.ray = embree_ray(ray),
                               .hit = {.geomID = RTC_INVALID_GEOMETRY_ID,
                                       .instID = {RTC_INVALID_GEOMETRY_ID}}};
    struct context context;
    context_init(&context, scene);
    rtcIntersect1(scene->top, &context.of_embree, &rayhit);
    const struct RTCHit *found = &rayhit.hit;
    struct wd_trace_hit hit = {.at_m = INFINITY};
    if (found->geomID == RTC_INVALID_GEOMETRY_ID)
        return hit;
    uint32_t count = (uint32_t)scene->world->tree_count;
    bool ground = found->instID[0] == RTC_INVALID_GEOMETRY_ID;
    hit.at_m = rayhit.ray.tfar;
    hit.tree = ground ? count : found->instID[0];
    hit.twig = hit.tree > count;
    if (hit.twig)
        hit.tree = scene->near.trees[hit.tree - count - 1].tree;
    hit.triangle = found->primID;
    hit.u = found->u;
    hit.v = found->v;
    if (ground)
        hit.normal = wd_v3_normalize(WD_V3(found->Ng_x, found->Ng_y, found->Ng_z));
    return hit;
}

static bool blocked(RTCScene by, struct RTCIntersectContext *context, const struct wd_trace_ray *ray)
{
    struct RTCRay shadow = embree_ray(ray);
    rtcOccluded1(by, context, &shadow);
    return shadow.tfar < 0;
}

bool wd_trace_blocked(const struct wd_trace_scene *scene, const struct wd_trace_ray *ray)
{
    struct context context;
    context_init(&context, scene);
    return blocked(scene->top, &context.of_embree, ray);
}

bool wd_trace_blocked_by_ground(const struct wd_trace_scene *scene, const struct wd_trace_ray *ray)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    return blocked(scene->ground.scene, &context, ray);
}
