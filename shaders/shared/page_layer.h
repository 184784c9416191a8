/* page_layer.h: what populate.comp is told of layers on demand and of the pages to plant. */
#ifndef WD_SHARED_PAGE_LAYER_H
#define WD_SHARED_PAGE_LAYER_H

#include "shared/packed_tree.h"
#include "shared/place_layer.h"

struct wd_page_layer {
    WD_STRUCT wd_place_layer layer;
    uint32_t first_id;
    uint32_t table_first, map_first; /* of all layers' tables and maps */
    uint32_t fade;                   /* see WD_TREE_LAYER */
    uint32_t grain_cm;               /* struct wd_demand_layer.grain_m */
};

/* A page to be planted into a slot: records WD_PAGE_TREES * slot on, after the stored trees. */
struct wd_page_job {
    uint32_t layer, level, column, row;
    uint32_t slot;
    WD_STRUCT wd_tree_block block;
};

struct wd_page_push {
    uint32_t job_count;
    uint32_t first_tree;    /* of the first slot */
    uint32_t first_cluster;
};

#endif
