#include <assert.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/pipeline_parts.h"

struct kept_pipeline {
    struct kept_pipeline *next;
    struct wd_pipeline pipeline;
    size_t key_size;
    unsigned char key[];
};

struct wd_pipeline_store {
    pthread_mutex_t lock;
    struct kept_pipeline *first;
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

static struct kept_pipeline *find(struct wd_pipeline_store *store, const struct wd_pipeline_key *key)
{
    struct kept_pipeline *kept = store->first;
    while (kept && !(kept->key_size == key->size && memcmp(kept->key, key->bytes, key->size) == 0))
        kept = kept->next;
    return kept;
}

bool wd_pipeline_find(struct wd_pipeline *pipeline, struct wd_gpu *gpu, const struct wd_pipeline_key *key)
{
    struct wd_pipeline_store *store = gpu->pipelines;
    pthread_mutex_lock(&store->lock);
    const struct kept_pipeline *kept = find(store, key);
    if (kept)
        *pipeline = kept->pipeline;
    pthread_mutex_unlock(&store->lock);
    return kept;
}

void wd_pipeline_keep(struct wd_pipeline *pipeline, struct wd_gpu *gpu, const struct wd_pipeline_key *key)
{
    struct wd_pipeline_store *store = gpu->pipelines;
    struct kept_pipeline *made = wd_alloc(sizeof *made + key->size);
    made->pipeline = *pipeline;
    made->key_size = key->size;
    memcpy(made->key, key->bytes, key->size);
    pthread_mutex_lock(&store->lock);
    const struct kept_pipeline *other = find(store, key); /* of a thread that was faster */
    if (other) {
        *pipeline = other->pipeline;
    } else {
        made->next = store->first;
        store->first = made;
    }
    pthread_mutex_unlock(&store->lock);
    if (other) {
        wd_pipeline_destroy(&made->pipeline, gpu);
        free(made);
    }
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
        struct kept_pipeline *kept = store->first;
        store->first = kept->next;
        wd_pipeline_destroy(&kept->pipeline, gpu);
        free(kept);
    }
    pthread_mutex_destroy(&store->lock);
    free(store);
    gpu->pipelines = NULL;
}
