#include "bake/baker.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/tree.h"
#include "shared/view_set.h"

static const uint32_t bake_raster_comp[] =
#include "bake_raster.comp.inc"
    ;
static const uint32_t bake_raster_once_comp[] =
#include "bake_raster_once.comp.inc"
    ;
static const uint32_t bake_resolve_comp[] =
#include "bake_resolve.comp.inc"
    ;
#define STORAGE VK_DESCRIPTOR_TYPE_STORAGE_BUFFER

enum {
    GROUP = 64,                  /* threads, in every shader */
    INDEX_ALIGNMENT = 64,        /* indices; any storage buffer alignment that Vulkan allows */
    BATCH_SAMPLE_BYTES = 64 << 20,
    BATCH_SHOTS = 16,            /* keeps a thread's loops short; see bake_raster.comp */
};

static bool init_raster(struct wd_baker *baker, uint32_t depths, uint32_t identity, uint32_t large)
{
    const uint32_t constants[] = {identity, large, depths};
    const struct wd_spirv twice = {bake_raster_comp, sizeof bake_raster_comp, "bake_raster.comp"};
    const struct wd_spirv once = {bake_raster_once_comp, sizeof bake_raster_once_comp,
                                  "bake_raster_once.comp"};
    const struct wd_compute_params params = {
        .shader = baker->passes == 1 ? once : twice,
        .bindings = {6,
                     {STORAGE, STORAGE, STORAGE, STORAGE, STORAGE,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}},
        .push_size = sizeof(struct wd_bake_push),
        .constants = {3, constants},
    };
    return wd_pipeline_init_compute(&baker->raster[depths][identity][large], baker->gpu, &params);
}

static bool init_pipelines(struct wd_baker *baker)
{
    const struct wd_compute_params resolve = {
        .shader = {bake_resolve_comp, sizeof bake_resolve_comp, "bake_resolve.comp"},
        .bindings = {6,
                     {STORAGE, STORAGE, STORAGE, STORAGE, STORAGE,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}},
        .push_size = sizeof(struct wd_bake_push),
    };
    baker->passes = baker->gpu->features & WD_GPU_FEATURE_INT64_ATOMICS ? 1 : 2;
    for (uint32_t depths = 0; depths < 2; depths++)
        for (uint32_t i = 0; i < 2 * baker->passes; i++)
            if (!init_raster(baker, depths, i / 2, i % 2))
                return false;
    return wd_pipeline_init_compute(&baker->resolve, baker->gpu, &resolve);
}

bool wd_baker_init(struct wd_baker *baker, struct wd_gpu *gpu, const struct wd_log *log)
{
    *baker = (struct wd_baker){.gpu = gpu, .log = log};
    const struct wd_buffer_params list = {
        "bake list", (4 + 2 * (VkDeviceSize)WD_BAKE_LIST) * sizeof(uint32_t),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
        WD_MEMORY_DEVICE};
    bool ok = wd_frames_init(&baker->frames, gpu) && init_pipelines(baker) &&
              wd_buffer_init(&baker->list, gpu, &list) &&
              wd_sampler_init(&baker->sampler, gpu, WD_SAMPLER_TRILINEAR_REPEAT);
    if (!ok)
        wd_baker_finish(baker);
    return ok;
}

void wd_baker_finish(struct wd_baker *baker)
{
    if (!baker->gpu)
        return;
    wd_frames_finish(&baker->frames);
    for (int i = 0; i < 8; i++)
        wd_pipeline_finish(&baker->raster[i / 4][i / 2 % 2][i % 2], baker->gpu);
    wd_pipeline_finish(&baker->resolve, baker->gpu);
    vkDestroySampler(baker->gpu->device, baker->sampler, NULL);
    wd_buffer_finish(&baker->samples, baker->gpu);
    wd_buffer_finish(&baker->texels, baker->gpu);
    wd_buffer_finish(&baker->list, baker->gpu);
    *baker = (struct wd_baker){0};
}

/* No frame that uses it is in flight: each is waited for. */
static bool grow(struct wd_baker *baker, struct wd_buffer *buffer, const char *name,
                 VkDeviceSize size)
{
    if (buffer->size >= size)
        return true;
    wd_buffer_finish(buffer, baker->gpu);
    const struct wd_buffer_params params = {name, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            WD_MEMORY_DEVICE};
    return wd_buffer_init(buffer, baker->gpu, &params);
}

/* One batch of a job's pictures. */
struct batch {
    struct wd_baker *baker;
    const struct wd_bake_job *job;
    struct wd_bake_push push;
    struct wd_binding bindings[6];
    uint32_t first;
};

static struct wd_bake_push job_push(const struct wd_bake_job *job)
{
    const struct wd_bake_mesh *mesh = &job->mesh;
    struct wd_bake_push push = {
        .first_index = mesh->first_index % INDEX_ALIGNMENT,
        .triangle_count = mesh->index_count / 3,
        .width = job->width,
        .height = job->height,
        .samples = job->samples,
        .wood_triangles = mesh->wood_index_count / 3,
        .look_layer = mesh->look_layer,
        .cut_out = mesh->cut_out,
    };
    if (job->parts == WD_BAKE_WOOD)
        push.triangle_count = push.wood_triangles;
    else if (job->parts == WD_BAKE_LEAVES) {
        push.first_triangle = push.wood_triangles;
        push.triangle_count -= push.wood_triangles;
    }
    return push;
}

static void bind_pass(struct wd_cmd *cmd, const struct batch *batch,
                      const struct wd_pipeline *pipeline, const struct wd_binding *bindings)
{
    wd_cmd_bind(cmd, pipeline, bindings);
    wd_cmd_push(cmd, pipeline, &batch->push, sizeof batch->push);
}

static uint64_t groups(uint64_t threads)
{
    return (threads + GROUP - 1) / GROUP;
}

/* Small triangles, then those that the first pass has put on the list. */
static void record_raster(struct wd_cmd *cmd, const struct batch *batch, uint32_t identity)
{
    struct wd_baker *baker = batch->baker;
    const struct wd_pipeline *raster =
        baker->raster[batch->job->depths == WD_BAKE_DEPTHS][identity];
    struct wd_binding bindings[6];
    memcpy(bindings, batch->bindings, sizeof bindings);
    bindings[4] = WD_BIND_BUFFER(&baker->list);
    wd_cmd_use_buffer(cmd, &baker->samples, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &baker->list, WD_USE_COMPUTE_WRITE);
    bind_pass(cmd, batch, &raster[0], bindings);
    if (batch->push.triangle_count)
        wd_cmd_dispatch_1d(cmd, groups(batch->push.triangle_count));
    wd_cmd_use_buffer(cmd, &baker->samples, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &baker->list, WD_USE_INDIRECT);
    bind_pass(cmd, batch, &raster[1], bindings);
    wd_cmd_dispatch_indirect(cmd, &baker->list, 0);
}

static void record_batch(struct wd_cmd *cmd, const struct batch *batch)
{
    struct wd_baker *baker = batch->baker;
    wd_cmd_use_buffer(cmd, batch->job->mesh.vertices, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, batch->job->mesh.indices, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, batch->job->mesh.looks, WD_USE_COMPUTE_READ);
    wd_cmd_fill_buffer(cmd, &baker->samples, 0);
    wd_cmd_fill_buffer(cmd, &baker->list, 1);
    for (uint32_t identity = 0; identity < baker->passes; identity++)
        record_raster(cmd, batch, identity);
    wd_cmd_use_buffer(cmd, &baker->samples, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &baker->texels, WD_USE_COMPUTE_WRITE);
    bind_pass(cmd, batch, &baker->resolve, batch->bindings);
    wd_cmd_dispatch_1d(
        cmd, groups((uint64_t)batch->push.width * batch->push.height * batch->push.shot_count));
}

static bool run_batch(struct batch *batch)
{
    struct wd_baker *baker = batch->baker;
    const struct wd_bake_mesh *mesh = &batch->job->mesh;
    struct wd_cmd cmd;
    if (!wd_frame_begin(&baker->frames, &cmd))
        return false;
    uint32_t aligned = mesh->first_index / INDEX_ALIGNMENT * INDEX_ALIGNMENT;
    batch->bindings[0] = (struct wd_binding){
        .buffer = mesh->vertices,
        .offset = (VkDeviceSize)mesh->first_vertex * sizeof(struct wd_tree_vertex),
        .size = (VkDeviceSize)mesh->vertex_count * sizeof(struct wd_tree_vertex),
    };
    batch->bindings[1] = (struct wd_binding){
        .buffer = mesh->indices,
        .offset = (VkDeviceSize)aligned * sizeof(uint32_t),
        .size = (VkDeviceSize)(mesh->first_index - aligned + mesh->index_count) * sizeof(uint32_t),
    };
    size_t shot_bytes = batch->push.shot_count * sizeof(struct wd_bake_shot);
    void *shots = wd_cmd_upload(&cmd, shot_bytes, &batch->bindings[2]);
    if (shots)
        memcpy(shots, batch->job->shots + batch->first, shot_bytes);
    batch->bindings[3] = WD_BIND_BUFFER(&baker->samples);
    batch->bindings[4] = WD_BIND_BUFFER(&baker->texels);
    batch->bindings[5] = WD_BIND_IMAGE(mesh->looks, baker->sampler);
    record_batch(&cmd, batch);
    return wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE) && wd_frames_wait(&baker->frames);
}

bool wd_baker_run(struct wd_baker *baker, const struct wd_bake_job *job,
                  void (*take)(void *user, uint32_t shot, const uint8_t *planes), void *user)
{
    const size_t picture = (size_t)job->width * job->height;
    const size_t sample_bytes =
        picture * job->samples * job->samples * sizeof(struct wd_bake_sample);
    const size_t shot_bytes = picture * WD_PLANES * 4;
    uint32_t most = (uint32_t)(BATCH_SAMPLE_BYTES / sample_bytes);
    most = most < 1 ? 1 : most > BATCH_SHOTS ? BATCH_SHOTS : most;
    most = most > job->shot_count ? job->shot_count : most;
    assert(job->samples * (job->width > job->height ? job->width : job->height) <=
           WD_BAKE_SIDE_MAX);
    if (!grow(baker, &baker->samples, "bake samples", most * sample_bytes) ||
        !grow(baker, &baker->texels, "bake texels", most * shot_bytes))
        return false;
    uint8_t *planes = wd_alloc(most * shot_bytes);
    struct batch batch = {.baker = baker, .job = job, .push = job_push(job)};
    bool ok = true;
    for (batch.first = 0; batch.first < job->shot_count && ok; batch.first += most) {
        uint32_t left = job->shot_count - batch.first;
        batch.push.shot_count = left < most ? left : most;
        ok = run_batch(&batch) &&
             wd_buffer_read(baker->gpu, &baker->texels, 0, planes,
                            batch.push.shot_count * shot_bytes);
        for (uint32_t i = 0; i < batch.push.shot_count && ok; i++)
            take(user, batch.first + i, planes + i * shot_bytes);
    }
    free(planes);
    return ok;
}
