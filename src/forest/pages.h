/* pages.h: trees of layers on demand on the device: a fixed number of pages, planted when a view
 * first needs them, forgotten when others have been needed since. */
#ifndef WD_FOREST_PAGES_H
#define WD_FOREST_PAGES_H

#include "forest/ground.h"
#include "gpu/command.h"
#include "shared/page_layer.h"
#include "world/world.h"

/* Slots for pages; fewer where a device can bind less at once. */
enum { WD_PAGES_MOST = 3072 };

struct wd_pages {
    struct wd_gpu *gpu;
    const struct wd_world *world;
    const struct wd_ground *ground;
    struct wd_pipeline populate;
    struct wd_buffer place_ground, layers, maps, tables;
    uint32_t capacity;   /* slots; 0: no layer is planted on demand */
    uint32_t first_tree; /* number of the first slot's among the forest's trees */
    uint32_t variants;   /* of a species */
    struct wd_page_slot {
        struct wd_page page;
        uint32_t newer, older; /* neighbours in the order of use; capacity: none */
        bool filled;
    } *slots;
    uint32_t newest, oldest;
    uint32_t *slot_of_hash; /* open addressing: slot + 1, 0 free */
    uint32_t hash_size;     /* a power of two */
    uint64_t planted;       /* pages since the beginning, for reports */
    uint64_t changes;       /* of what slots hold */
};

/* Pages for the layers of `world` that are planted on demand; none without such layers. */
bool wd_pages_init(struct wd_pages *pages, struct wd_gpu *gpu, const struct wd_world *world,
                   const struct wd_ground *ground, uint32_t variants);
void wd_pages_finish(struct wd_pages *pages, struct wd_gpu *gpu); /* accepts {0} */

/* Slots that a device has room for beside the stored trees, and the number of the first one's first
 * tree: a page is a block of trees (shared/packed_tree.h). */
uint32_t wd_pages_capacity(const struct wd_gpu *gpu, const struct wd_world *world);
uint32_t wd_pages_first(const struct wd_world *world);

/* Forgets every page. */
void wd_pages_forget(struct wd_pages *pages);

/* The tree of a record, from the page that its slot holds. */
bool wd_pages_tree(const struct wd_pages *pages, uint32_t record, struct wd_tree *tree);

/* A view that asks for pages. */
struct wd_pages_query {
    /* Whether a box in rel may be seen. */
    bool (*sees)(const void *view, const float min[3], const float max[3]);
    const void *view;
    uint64_t view_hash;  /* equal for views that see the same */
    double eye_m[3];
    float pixels;        /* of a metre at a metre's distance, or anywhere when `orthographic` */
    bool orthographic;
    float whole_px;      /* trees of so many pixels, and larger ones, are all wanted */
    uint32_t most;       /* pages of this view, at most; coarser ones are taken where they do not do */
    uint32_t budget;     /* pages to plant now, at most; 0: all that are missing */
};

struct wd_page_list {
    uint32_t *slots;
    size_t count, capacity;
    bool coarser; /* than wanted: the budget did not do */
    uint64_t query_hash, changes; /* what it was made for; while slots hold the same it is not made again */
};
void wd_page_list_finish(struct wd_page_list *list);

/* Which pages stand for the layers in this view, each part of the ground in one page of a layer;
 * plants those that are missing into `trees` and their clusters into `clusters` from
 * `first_cluster` on, WD_PAGE_CLUSTERS a slot. With a budget, coarser pages stand for those that have to
 * wait; what is chosen without one does not depend on what was seen before. */
void wd_pages_select(struct wd_pages *pages, struct wd_cmd *cmd,
                     const struct wd_pages_query *query, struct wd_buffer *trees,
                     struct wd_buffer *clusters, uint32_t first_cluster,
                     struct wd_page_list *list);

#endif
