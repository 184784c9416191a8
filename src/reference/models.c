#include "reference/models.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "base/jobs.h"
#include "base/memory.h"

/* Alpha below which a texel is a hole. */
enum { WD_LOOK_HOLE = 128 };

/* --- textures ---------------------------------------------------------------------------- */

/* Half to float; no infinities or NaNs come (wd_pack_uv). */
static float half_decode(uint32_t half)
{
    uint32_t exponent = half >> 10 & 31u, fraction = half & 1023u;
    float value = exponent ? ldexpf((float)(1024u + fraction), (int)exponent - 25)
                           : ldexpf((float)fraction, -24);
    return half & 0x8000u ? -value : value;
}

static void corner_uv(const struct wd_tree_mesh *mesh, uint32_t triangle, int corner, float uv[2])
{
    uint32_t packed = mesh->vertices[mesh->indices[3 * (size_t)triangle + (size_t)corner]].uv;
    uv[0] = half_decode(packed & 0xffffu);
    uv[1] = half_decode(packed >> 16);
}

static uint32_t texel_of(float at)
{
    return (uint32_t)(int32_t)floorf(at * WD_TRACE_LOOK_SIZE) % WD_TRACE_LOOK_SIZE;
}

struct wd_trace_texel wd_trace_texel_at(const struct wd_trace_model *model, uint32_t triangle,
                                        float u, float v)
{
    const struct wd_tree_mesh *mesh = &model->grown.full;
    const float share[3] = {1 - u - v, u, v};
    struct wd_trace_texel texel = {
        .layer = wd_vertex_layer(mesh->vertices[mesh->indices[3 * (size_t)triangle]].kind)};
    for (int corner = 0; corner < 3; corner++) {
        float uv[2];
        corner_uv(mesh, triangle, corner, uv);
        texel.uv[0] += share[corner] * uv[0];
        texel.uv[1] += share[corner] * uv[1];
    }
    texel.offset = 4 * ((size_t)texel_of(texel.uv[1]) * WD_TRACE_LOOK_SIZE + texel_of(texel.uv[0]));
    return texel;
}

float wd_trace_uv_turn(const struct wd_trace_model *model, uint32_t triangle)
{
    float a[2], b[2], c[2];
    corner_uv(&model->grown.full, triangle, 0, a);
    corner_uv(&model->grown.full, triangle, 1, b);
    corner_uv(&model->grown.full, triangle, 2, c);
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0 ? -1.0f : 1.0f;
}

/* Texels of less than half alpha are holes. Rays come one at a time. */
static void pass_holes(const struct RTCFilterFunctionNArguments *args)
{
    const struct wd_trace_model *model = args->geometryUserPtr;
    const struct RTCHit *hit = (const struct RTCHit *)args->hit;
    if (args->N != 1 || args->valid[0] != -1)
        return;
    struct wd_trace_texel texel = wd_trace_texel_at(model, hit->primID, hit->u, hit->v);
    size_t at = texel.layer * WD_TRACE_MAP_BYTES + texel.offset;
    if (model->look->albedo[at + 3] < WD_LOOK_HOLE)
        args->valid[0] = 0;
}

/* --- building ---------------------------------------------------------------------------- */

RTCScene wd_trace_new_scene(RTCDevice device)
{
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    return scene;
}

bool wd_trace_has_twigs(const struct wd_trace_model *model)
{
    return model->grown.spray.index_count > 0 && model->model.fall_mps <= 0;
}

void wd_trace_model_build(struct wd_trace_model *model, RTCDevice device)
{
    const struct wd_tree_mesh *mesh = &model->grown.full;
    model->scene = wd_trace_new_scene(device);
    if (mesh->index_count) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   mesh->vertices, 0, sizeof *mesh->vertices, mesh->vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh->indices, 0, 3 * sizeof *mesh->indices,
                                   mesh->index_count / 3);
        rtcSetGeometryMask(geometry, UINT32_MAX);
        if (model->look->has_holes) {
            rtcSetGeometryUserData(geometry, model);
            rtcSetGeometryIntersectFilterFunction(geometry, pass_holes);
            rtcSetGeometryOccludedFilterFunction(geometry, pass_holes);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(model->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(model->scene);
}

struct preparation {
    struct wd_trace_models *models;
    const struct wd_scene *scene;
    const struct wd_trace_looks *looks;
    const struct wd_log *log;
    atomic_bool failed;
};

/* Leaves of grown species are cut out as polygons; their textures have no holes. */
static void make_look(void *user, size_t index)
{
    struct preparation *work = user;
    const struct wd_species *species = &work->scene->species[index];
    struct wd_trace_look *look = &work->models->looks[index];
    look->albedo = wd_alloc(2 * WD_LOOK_LAYERS * WD_TRACE_MAP_BYTES);
    look->detail = look->albedo + WD_LOOK_LAYERS * WD_TRACE_MAP_BYTES;
    work->looks->get(work->looks->user, species, look->albedo);
    for (size_t i = 3; species->imported && i < WD_LOOK_LAYERS * WD_TRACE_MAP_BYTES; i += 4)
        look->has_holes |= look->albedo[i] < WD_LOOK_HOLE;
}

static void grow(void *user, size_t index)
{
    struct preparation *work = user;
    struct wd_trace_models *models = work->models;
    struct wd_trace_model *model = &models->models[index];
    if (!wd_variant_grow(&model->grown, work->scene, (uint32_t)index, work->log)) {
        atomic_store(&work->failed, true);
        return;
    }
    wd_variant_describe(&model->model, work->scene, (uint32_t)index, &model->grown);
    if (!model->grown.borrowed) {
        wd_tree_mesh_finish(&model->grown.reduced);
        wd_tree_mesh_finish(&model->grown.far_stem);
    }
    model->look = &models->looks[index / models->variants];
    wd_trace_model_build(model, models->device);
}

bool wd_trace_models_init(struct wd_trace_models *models, RTCDevice device, const struct wd_scene *scene,
                          const struct wd_trace_looks *looks, unsigned threads, const struct wd_log *log)
{
    uint32_t species = (uint32_t)scene->species_file_count;
    *models = (struct wd_trace_models){
        .device = device,
        .variants = (uint32_t)scene->variants,
        .count = species * (uint32_t)scene->variants,
        .species_count = species,
        .looks = wd_alloc_array(species, sizeof *models->looks),
    };
    models->models = wd_alloc_array(models->count, sizeof *models->models);
    struct preparation work = {models, scene, looks, log, false};
    wd_jobs_run(threads, species, make_look, &work);
    wd_jobs_run(threads, models->count, grow, &work);
    if (!atomic_load(&work.failed))
        return true;
    wd_trace_models_finish(models);
    return false;
}

void wd_trace_models_finish(struct wd_trace_models *models)
{
    for (uint32_t i = 0; i < models->count; i++) {
        if (models->models[i].scene)
            rtcReleaseScene(models->models[i].scene);
        wd_tree_model_finish(&models->models[i].grown);
    }
    for (uint32_t i = 0; i < models->species_count; i++)
        free(models->looks[i].albedo);
    free(models->models);
    free(models->looks);
    *models = (struct wd_trace_models){0};
}

const struct wd_trace_model *wd_trace_model_of(const struct wd_trace_models *models,
                                               const struct wd_tree *tree)
{
    return &models->models[WD_TREE_SPECIES(*tree) * models->variants +
                           WD_TREE_VARIANT(*tree) % models->variants];
}
