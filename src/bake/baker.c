#include "bake/baker.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/tree.h"
#include "shared/view_set.h"

static const uint32_t bake_raster_comp[] =
#include "bake_raster.comp.inc"
    ;
static const uint32_t bake_resolve_comp[] =
#include "bake_resolve.comp.inc"
    ;

enum {
    GROUP = 64,                  /* threads, in every shader */
    INDEX_ALIGNMENT = 64,        /* indices; any storage buffer alignment that Vulkan allows */
    BATCH_SAMPLE_BYTES = 64 << 20,
    STORAGE = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
};

static bool init_raster(struct wd_pipeline *pipeline, struct wd_gpu *gpu, uint32_t identity)
{
    const struct wd_compute_params params = {
        .shader = {bake_raster_comp, sizeof bake_raster_comp, "bake_raster.comp"},
        .bindings = {4, {STORAGE, STORAGE, STORAGE, STORAGE}},
        .push_size = sizeof(struct wd_bake_push),
        .constants = {1, &identity},
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

bool wd_baker_init(struct wd_baker *baker, struct wd_gpu *gpu, const struct wd_log *log)
{
    *baker = (struct wd_baker){.gpu = gpu, .log = log};
    const struct wd_compute_params resolve = {
        .shader = {bake_resolve_comp, sizeof bake_resolve_comp, "bake_resolve.comp"},
        .bindings = {6,
                     {STORAGE, STORAGE, STORAGE, STORAGE, STORAGE,
                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}},
        .push_size = sizeof(struct wd_bake_push),
    };
    bool ok = wd_frames_init(&baker->frames, gpu) && init_raster(&baker->depth, gpu, 0) &&
              init_raster(&baker->identity, gpu, 1) &&
              wd_pipeline_init_compute(&baker->resolve, gpu, &resolve) &&
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
    wd_pipeline_finish(&baker->depth, baker->gpu);
    wd_pipeline_finish(&baker->identity, baker->gpu);
    wd_pipeline_finish(&baker->resolve, baker->gpu);
    vkDestroySampler(baker->gpu->device, baker->sampler, NULL);
    wd_buffer_finish(&baker->samples, baker->gpu);
    wd_buffer_finish(&baker->texels, baker->gpu);
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
    };
    if (job->parts == WD_BAKE_WOOD)
        push.triangle_count = push.wood_triangles;
    else if (job->parts == WD_BAKE_LEAVES) {
        push.first_triangle = push.wood_triangles;
        push.triangle_count -= push.wood_triangles;
    }
    return push;
}

static void record_pass(struct wd_cmd *cmd, const struct batch *batch,
                        const struct wd_pipeline *pipeline, uint64_t threads)
{
    wd_cmd_bind(cmd, pipeline, batch->bindings);
    wd_cmd_push(cmd, pipeline, &batch->push, sizeof batch->push);
    if (threads)
        wd_cmd_dispatch_1d(cmd, (threads + GROUP - 1) / GROUP);
}

static void record_batch(struct wd_cmd *cmd, const struct batch *batch)
{
    struct wd_baker *baker = batch->baker;
    uint64_t texels =
        (uint64_t)batch->push.width * batch->push.height * batch->push.shot_count;
    wd_cmd_use_buffer(cmd, batch->job->mesh.vertices, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, batch->job->mesh.indices, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(cmd, batch->job->mesh.looks, WD_USE_COMPUTE_READ);
    wd_cmd_fill_buffer(cmd, &baker->samples, 0);
    wd_cmd_use_buffer(cmd, &baker->samples, WD_USE_COMPUTE_WRITE);
    record_pass(cmd, batch, &baker->depth, batch->push.triangle_count);
    wd_cmd_use_buffer(cmd, &baker->samples, WD_USE_COMPUTE_WRITE);
    record_pass(cmd, batch, &baker->identity, batch->push.triangle_count);
    wd_cmd_use_buffer(cmd, &baker->samples, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &baker->texels, WD_USE_COMPUTE_WRITE);
    record_pass(cmd, batch, &baker->resolve, texels);
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
    const size_t shot_bytes = picture * WD_VIEW_PLANES * 4;
    uint32_t most = (uint32_t)(BATCH_SAMPLE_BYTES / sample_bytes);
    most = most < 1 ? 1 : most > job->shot_count ? job->shot_count : most;
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
