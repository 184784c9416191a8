#include "bake/baker.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
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
static const uint32_t bake_flat_comp[] =
#include "bake_flat.comp.inc"
    ;
#define STORAGE VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
#define TEXELS VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
#define IMAGE VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER

enum {
    GROUP = 64, /* threads, in every shader */
    BATCH_SAMPLE_BYTES = 32 << 20,
    BATCH_SHOTS = 16, /* they share the list of large triangles */
    LEAF_BYTES = 16,  /* sums of what a picture's leaves show */
};

static bool init_raster(struct wd_baker *baker, uint32_t form)
{
    const uint32_t constants[] = {form & 1, form >> 1 & 1, form >> 2 & 1, form >> 3};
    const struct wd_spirv twice = WD_SPIRV(bake_raster_comp);
    const struct wd_spirv once = WD_SPIRV(bake_raster_once_comp);
    const struct wd_compute_params params = {
        .shader = baker->passes == 1 ? once : twice,
        .bindings = {7, {TEXELS, TEXELS, STORAGE, STORAGE, STORAGE, IMAGE, STORAGE}},
        .push_size = sizeof(struct wd_bake_push),
        .constants = {4, constants},
    };
    return wd_pipeline_init_compute(&baker->raster[form], baker->gpu, &params);
}

static bool init_flat(struct wd_baker *baker)
{
    const struct wd_compute_params params = {
        .shader = WD_SPIRV(bake_flat_comp),
        .bindings = {4, {TEXELS, TEXELS, STORAGE, IMAGE}},
        .push_size = sizeof(struct wd_bake_push),
    };
    return wd_pipeline_init_compute(&baker->flat, baker->gpu, &params);
}

static bool init_resolve(struct wd_baker *baker, uint32_t depths)
{
    const struct wd_compute_params params = {
        .shader = WD_SPIRV(bake_resolve_comp),
        .bindings = {7, {TEXELS, TEXELS, TEXELS, TEXELS, TEXELS, IMAGE, STORAGE}},
        .push_size = sizeof(struct wd_bake_push),
        .constants = {1, &depths},
    };
    return wd_pipeline_init_compute(&baker->resolve[depths], baker->gpu, &params);
}

/* The raster's forms that a job needs, but for pass and size. */
static uint32_t job_form(const struct wd_bake_job *job)
{
    return (job->depths == WD_BAKE_DEPTHS ? WD_BAKE_RASTER_DEPTHS : 0) |
           (job->mesh.cut_out ? WD_BAKE_RASTER_CUT_OUT : 0);
}

static bool init_pipelines(struct wd_baker *baker, const struct wd_bake_job *job)
{
    uint32_t depths = job->depths == WD_BAKE_DEPTHS;
    bool ok = (baker->flat.kept || init_flat(baker)) &&
              (baker->resolve[depths].kept || init_resolve(baker, depths));
    for (uint32_t i = 0; i < 2 * baker->passes && ok; i++) {
        uint32_t form = job_form(job) | (i & 1 ? WD_BAKE_RASTER_LARGE : 0) |
                        (i & 2 ? WD_BAKE_RASTER_IDENTITY : 0);
        ok = baker->raster[form].kept || init_raster(baker, form);
    }
    return ok;
}

bool wd_baker_init(struct wd_baker *baker, struct wd_gpu *gpu, const struct wd_log *log)
{
    *baker = (struct wd_baker){.gpu = gpu, .log = log};
    const struct wd_buffer_params list = {
        "bake list", (4 + 2 * (VkDeviceSize)WD_BAKE_LIST) * sizeof(uint32_t),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
        WD_MEMORY_DEVICE};
    baker->passes = gpu->features & WD_GPU_FEATURE_INT64_ATOMICS ? 1 : 2;
    bool ok = wd_frames_init(&baker->frames, gpu) && wd_buffer_init(&baker->list, gpu, &list) &&
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
    vkDestroySampler(baker->gpu->device, baker->sampler, NULL);
    wd_buffer_finish(&baker->samples, baker->gpu);
    wd_buffer_finish(&baker->rays, baker->gpu);
    wd_buffer_finish(&baker->texels, baker->gpu);
    wd_buffer_finish(&baker->flats, baker->gpu);
    wd_buffer_finish(&baker->list, baker->gpu);
    *baker = (struct wd_baker){0};
}

/* No frame that uses it is in flight: each is waited for. `texels` is 0 or how it is fetched from. */
static bool grow(struct wd_baker *baker, struct wd_buffer *buffer, const char *name,
                 VkDeviceSize size, VkFormat texels)
{
    if (buffer->size >= size)
        return true;
    wd_buffer_finish(buffer, baker->gpu);
    const struct wd_buffer_params params = {name, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            WD_MEMORY_DEVICE, texels};
    return wd_buffer_init(buffer, baker->gpu, &params);
}

/* One batch of a job's pictures. */
struct batch {
    struct wd_baker *baker;
    const struct wd_bake_job *job;
    struct wd_bake_push push;
    uint32_t first, count; /* shots */
};

static struct wd_bake_push job_push(const struct wd_bake_job *job)
{
    const struct wd_bake_mesh *mesh = &job->mesh;
    struct wd_bake_push push = {
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

static uint64_t groups(uint64_t threads)
{
    return (threads + GROUP - 1) / GROUP;
}

/* `threads` of a bound pass for each shot. */
static void dispatch_shots(struct wd_cmd *cmd, struct batch *batch,
                           const struct wd_pipeline *pipeline, uint64_t threads)
{
    for (uint32_t i = 0; i < batch->count && threads; i++) {
        batch->push.shot = batch->job->shots[batch->first + i];
        batch->push.shot_index = i;
        wd_cmd_push(cmd, pipeline, &batch->push, sizeof batch->push);
        wd_cmd_dispatch_1d(cmd, groups(threads));
    }
}

static void record_flat(struct wd_cmd *cmd, const struct batch *batch)
{
    struct wd_baker *baker = batch->baker;
    const struct wd_bake_mesh *mesh = &batch->job->mesh;
    const struct wd_binding bindings[] = {
        WD_BIND_BUFFER(mesh->vertices), WD_BIND_BUFFER(mesh->indices),
        WD_BIND_BUFFER(&baker->flats), WD_BIND_IMAGE(mesh->looks, baker->sampler)};
    wd_cmd_use_buffer(cmd, &baker->flats, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, &baker->flat, bindings);
    wd_cmd_push(cmd, &baker->flat, &batch->push, sizeof batch->push);
    if (batch->push.triangle_count)
        wd_cmd_dispatch_1d(cmd, groups(batch->push.triangle_count));
}

/* Small triangles, then those that the first pass has put on the list. */
static void record_raster(struct wd_cmd *cmd, struct batch *batch, uint32_t form,
                          const struct wd_binding *bindings)
{
    struct wd_baker *baker = batch->baker;
    const struct wd_pipeline *small = &baker->raster[form];
    const struct wd_pipeline *large = &baker->raster[form | WD_BAKE_RASTER_LARGE];
    wd_cmd_use_buffer(cmd, &baker->samples, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &baker->rays, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &baker->list, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, small, bindings);
    dispatch_shots(cmd, batch, small, batch->push.triangle_count);
    wd_cmd_use_buffer(cmd, &baker->samples, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &baker->rays, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, &baker->list, WD_USE_INDIRECT);
    wd_cmd_bind(cmd, large, bindings);
    wd_cmd_push(cmd, large, &batch->push, sizeof batch->push);
    wd_cmd_dispatch_indirect(cmd, &baker->list, 0);
}

static void record_rasters(struct wd_cmd *cmd, struct batch *batch)
{
    struct wd_baker *baker = batch->baker;
    const struct wd_bake_job *job = batch->job;
    struct wd_binding bindings[7] = {
        WD_BIND_BUFFER(job->mesh.vertices), WD_BIND_BUFFER(job->mesh.indices),
        WD_BIND_BUFFER(&baker->samples), WD_BIND_BUFFER(&baker->rays),
        WD_BIND_BUFFER(&baker->list), WD_BIND_IMAGE(job->mesh.looks, baker->sampler)};
    size_t shot_bytes = batch->count * sizeof *job->shots;
    void *shots = wd_cmd_upload(cmd, shot_bytes, &bindings[6]);
    if (shots)
        memcpy(shots, job->shots + batch->first, shot_bytes);
    wd_cmd_fill_buffer(cmd, &baker->samples, 0);
    if (job->depths == WD_BAKE_DEPTHS)
        wd_cmd_fill_buffer(cmd, &baker->rays, 0);
    wd_cmd_fill_buffer(cmd, &baker->list, 1);
    for (uint32_t i = 0; i < baker->passes; i++)
        record_raster(cmd, batch, job_form(job) | (i ? WD_BAKE_RASTER_IDENTITY : 0), bindings);
}

static void record_resolve(struct wd_cmd *cmd, struct batch *batch)
{
    struct wd_baker *baker = batch->baker;
    const struct wd_bake_mesh *mesh = &batch->job->mesh;
    const struct wd_pipeline *resolve = &baker->resolve[batch->job->depths == WD_BAKE_DEPTHS];
    const struct wd_binding bindings[] = {
        WD_BIND_BUFFER(mesh->vertices), WD_BIND_BUFFER(mesh->indices),
        WD_BIND_BUFFER(&baker->samples), WD_BIND_BUFFER(&baker->rays),
        WD_BIND_BUFFER(&baker->flats), WD_BIND_IMAGE(mesh->looks, baker->sampler),
        WD_BIND_BUFFER(&baker->texels)};
    wd_cmd_use_buffer(cmd, &baker->samples, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &baker->rays, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(cmd, &baker->flats, WD_USE_COMPUTE_READ);
    wd_cmd_fill_buffer(cmd, &baker->texels, 0);
    wd_cmd_use_buffer(cmd, &baker->texels, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, resolve, bindings);
    dispatch_shots(cmd, batch, resolve, (uint64_t)batch->push.width * batch->push.height);
}

static bool run_batch(struct batch *batch)
{
    struct wd_baker *baker = batch->baker;
    const struct wd_bake_mesh *mesh = &batch->job->mesh;
    struct wd_cmd cmd;
    if (!wd_frame_begin(&baker->frames, &cmd))
        return false;
    wd_cmd_use_buffer(&cmd, mesh->vertices, WD_USE_COMPUTE_READ);
    wd_cmd_use_buffer(&cmd, mesh->indices, WD_USE_COMPUTE_READ);
    wd_cmd_use_image(&cmd, mesh->looks, WD_USE_COMPUTE_READ);
    wd_cmd_scope_begin(&cmd, "bake raster");
    record_rasters(&cmd, batch);
    wd_cmd_scope_end(&cmd);
    if (batch->first == 0 && !mesh->cut_out) {
        wd_cmd_scope_begin(&cmd, "bake flat");
        record_flat(&cmd, batch);
        wd_cmd_scope_end(&cmd);
    }
    wd_cmd_scope_begin(&cmd, "bake resolve");
    record_resolve(&cmd, batch);
    wd_cmd_scope_end(&cmd);
    return wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE) && wd_frames_wait(&baker->frames);
}

static size_t picture_bytes(const struct wd_bake_job *job)
{
    return (size_t)job->width * job->height * WD_PLANES * 4;
}

/* Buffers of a batch of `shots` pictures, and of the mesh. */
static bool grow_buffers(struct wd_baker *baker, const struct wd_bake_job *job, uint32_t shots)
{
    VkDeviceSize texels = (VkDeviceSize)job->width * job->height * shots;
    VkDeviceSize samples = texels * job->samples * job->samples;
    VkDeviceSize rays = job->depths == WD_BAKE_DEPTHS ? samples : 1;
    return grow(baker, &baker->samples, "bake samples", samples * sizeof(struct wd_bake_sample),
                VK_FORMAT_R32G32_UINT) &&
           grow(baker, &baker->rays, "bake rays", rays * sizeof(struct wd_bake_ray),
                VK_FORMAT_R32G32_UINT) &&
           grow(baker, &baker->flats, "bake flats",
                (job->mesh.index_count / 3 + 1) * sizeof(struct wd_bake_flat),
                VK_FORMAT_R32G32B32A32_UINT) &&
           grow(baker, &baker->texels, "bake texels", shots * (picture_bytes(job) + LEAF_BYTES), 0);
}

/* Pictures of a batch that have come back, and the sums after them. */
struct taking {
    void (*take)(void *user, uint32_t shot, const struct wd_bake_picture *picture);
    void *user;
    const uint8_t *planes;
    size_t shot_bytes, leaf_sums;
    uint32_t first;
};

static void take_shot(void *user, size_t index)
{
    const struct taking *taking = user;
    struct wd_bake_picture picture = {.planes = taking->planes + index * taking->shot_bytes};
    uint32_t sums[4];
    memcpy(sums, taking->planes + taking->leaf_sums + LEAF_BYTES * index, sizeof sums);
    for (int k = 0; k < 4; k++)
        picture.leaves[k] = (double)sums[k] / WD_BAKE_LEAF_STEPS;
    taking->take(taking->user, taking->first + (uint32_t)index, &picture);
}

bool wd_baker_run(struct wd_baker *baker, const struct wd_bake_job *job,
                  void (*take)(void *user, uint32_t shot, const struct wd_bake_picture *picture),
                  void *user)
{
    const size_t picture = (size_t)job->width * job->height;
    const size_t sample_bytes =
        picture * job->samples * job->samples * sizeof(struct wd_bake_sample);
    const size_t shot_bytes = picture_bytes(job);
    uint32_t most = (uint32_t)(BATCH_SAMPLE_BYTES / sample_bytes);
    most = most < 1 ? 1 : most > BATCH_SHOTS ? BATCH_SHOTS : most;
    most = most > job->shot_count ? job->shot_count : most;
    assert(job->samples >= 1 && job->samples <= WD_BAKE_SAMPLES_MAX);
    assert(job->samples * (job->width > job->height ? job->width : job->height) <=
           WD_BAKE_SIDE_MAX);
    if (!init_pipelines(baker, job) || !grow_buffers(baker, job, most))
        return false;
    const size_t leaf_sums = most * shot_bytes, bytes = leaf_sums + most * LEAF_BYTES;
    uint8_t *planes = wd_alloc(bytes);
    struct batch batch = {.baker = baker, .job = job, .push = job_push(job)};
    batch.push.leaf_sums = (uint32_t)(leaf_sums / 4);
    bool ok = true;
    for (batch.first = 0; batch.first < job->shot_count && ok; batch.first += most) {
        uint32_t left = job->shot_count - batch.first;
        batch.count = left < most ? left : most;
        ok = run_batch(&batch) &&
             wd_buffer_read(baker->gpu, &baker->texels, 0, planes, bytes);
        struct taking taking = {take, user, planes, shot_bytes, leaf_sums, batch.first};
        wd_jobs_run(baker->gpu->threads, ok ? batch.count : 0, take_shot, &taking);
    }
    free(planes);
    return ok;
}
