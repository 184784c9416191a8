#include <assert.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/pipeline_parts.h"

struct wd_kept_pipeline {
    struct wd_kept_pipeline *next;
    struct wd_pipeline pipeline;
    struct wd_pipeline_params params;
    uint32_t constants[WD_MAX_SPEC_CONSTANTS];
    pthread_mutex_t lock; /* of `made` */
    VkPipeline made;
    size_t key_size;
    unsigned char key[];
};

struct wd_pipeline_store {
    pthread_mutex_t lock;
    struct wd_kept_pipeline *first;
};

void wd_pipeline_key_add(struct wd_pipeline_key *key, const void *bytes, size_t size)
{
    assert(key->size + size <= sizeof key->bytes);
    if (size)
        memcpy(key->bytes + key->size, bytes, size);
    key->size += size;
}

void wd_pipeline_key_add_constants(struct wd_pipeline_key *key, const struct wd_spec_constants *constants)
{
    wd_pipeline_key_add(key, &constants->count, sizeof constants->count);
    wd_pipeline_key_add(key, constants->values, constants->count * sizeof *constants->values);
}

static struct wd_kept_pipeline *find(struct wd_pipeline_store *store, const struct wd_pipeline_key *key)
{
    struct wd_kept_pipeline *kept = store->first;
    while (kept && !(kept->key_size == key->size && memcmp(kept->key, key->bytes, key->size) == 0))
        kept = kept->next;
    return kept;
}

bool wd_pipeline_find(struct wd_pipeline *pipeline, struct wd_gpu *gpu, const struct wd_pipeline_key *key)
{
    struct wd_pipeline_store *store = gpu->pipelines;
    pthread_mutex_lock(&store->lock);
    const struct wd_kept_pipeline *kept = find(store, key);
    if (kept)
        *pipeline = kept->pipeline;
    pthread_mutex_unlock(&store->lock);
    return kept;
}

static void take_constants(struct wd_kept_pipeline *kept, struct wd_spec_constants *constants)
{
    if (constants->count)
        memcpy(kept->constants, constants->values, constants->count * sizeof *constants->values);
    constants->values = kept->constants;
}

static struct wd_kept_pipeline *kept_of(const struct wd_pipeline *pipeline, const struct wd_pipeline_key *key,
                                        const struct wd_pipeline_params *params)
{
    struct wd_kept_pipeline *kept = wd_alloc(sizeof *kept + key->size);
    kept->pipeline = *pipeline;
    kept->pipeline.kept = kept;
    kept->params = *params;
    take_constants(kept, pipeline->bind_point == VK_PIPELINE_BIND_POINT_COMPUTE ? &kept->params.compute.constants
                                                                                : &kept->params.graphics.constants);
    kept->key_size = key->size;
    memcpy(kept->key, key->bytes, key->size);
    pthread_mutex_init(&kept->lock, NULL);
    return kept;
}

static void destroy(struct wd_kept_pipeline *kept, struct wd_gpu *gpu)
{
    if (kept->made)
        vkDestroyPipeline(gpu->device, kept->made, NULL);
    wd_pipeline_destroy_layout(&kept->pipeline, gpu);
    pthread_mutex_destroy(&kept->lock);
    free(kept);
}

bool wd_pipeline_keep(struct wd_pipeline *pipeline, struct wd_gpu *gpu, const struct wd_pipeline_key *key,
                      const struct wd_pipeline_params *params)
{
    struct wd_pipeline_store *store = gpu->pipelines;
    struct wd_kept_pipeline *own = kept_of(pipeline, key, params);
    pthread_mutex_lock(&store->lock);
    struct wd_kept_pipeline *other = find(store, key); /* of a thread that was faster */
    if (!other) {
        own->next = store->first;
        store->first = own;
    }
    pthread_mutex_unlock(&store->lock);
    *pipeline = (other ? other : own)->pipeline;
    if (other)
        destroy(own, gpu);
    bool ok = !gpu->makes_at_once || wd_pipeline_make(pipeline, gpu);
    if (!ok)
        *pipeline = (struct wd_pipeline){0};
    return ok;
}

bool wd_pipeline_make(const struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    struct wd_kept_pipeline *kept = pipeline->kept;
    pthread_mutex_lock(&kept->lock);
    if (!kept->made && !gpu->lost)
        kept->made = pipeline->bind_point == VK_PIPELINE_BIND_POINT_COMPUTE
                         ? wd_compute_create(gpu, pipeline->layout, &kept->params.compute)
                         : wd_graphics_create(gpu, pipeline->layout, &kept->params.graphics);
    bool ok = kept->made;
    pthread_mutex_unlock(&kept->lock);
    return ok;
}

VkPipeline wd_pipeline_made(const struct wd_pipeline *pipeline)
{
    struct wd_kept_pipeline *kept = pipeline->kept;
    pthread_mutex_lock(&kept->lock);
    VkPipeline made = kept->made;
    pthread_mutex_unlock(&kept->lock);
    return made;
}

void wd_pipeline_store_init(struct wd_gpu *gpu)
{
    gpu->pipelines = wd_alloc(sizeof *gpu->pipelines);
    pthread_mutex_init(&gpu->pipelines->lock, NULL);
}

void wd_pipeline_store_finish(struct wd_gpu *gpu)
{
    struct wd_pipeline_store *store = gpu->pipelines;
    if (!store)
        return;
    while (store->first) {
        struct wd_kept_pipeline *kept = store->first;
        store->first = kept->next;
        destroy(kept, gpu);
    }
    pthread_mutex_destroy(&store->lock);
    free(store);
    gpu->pipelines = NULL;
}
