#include "forest/pages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/log.h"
#include "base/memory.h"
#include "forest/page_slots.h"
#include "world/packed_trees.h"

static_assert(WD_PAGE_TREES == WD_BLOCK_TREES, "a page is a block");

static const uint32_t populate_comp[] =
#include "populate.comp.inc"
    ;

/* --- tables ------------------------------------------------------------------------------- */

static bool make_buffer(struct wd_buffer *buffer, struct wd_gpu *gpu, const char *name,
                        const void *data, size_t size)
{
    const struct wd_buffer_params params = {name, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            WD_MEMORY_DEVICE};
    return wd_buffer_init(buffer, gpu, &params) && wd_buffer_upload(gpu, buffer, 0, data, size);
}

static size_t map_size(const struct wd_demand_layer *layer)
{
    const struct wd_place_layer *numbers = &layer->placement.input.layer;
    return layer->placement.map ? (size_t)numbers->map_width * numbers->map_height : 0;
}

/* Index into the forest's fades: as wd_forest_fade_of. */
static uint32_t fade_of(uint32_t layer)
{
    return layer < 127 ? layer + 1 : 0;
}

/* All layers' numbers, maps and tables, one after the other. */
static bool upload_layers(struct wd_pages *pages)
{
    const struct wd_demand *demand = &pages->world->demand;
    size_t map_count = 1, table_count = 1; /* never empty */
    for (uint32_t i = 0; i < demand->count; i++) {
        map_count += map_size(&demand->layers[i]);
        table_count += demand->layers[i].placement.table_count;
    }
    struct wd_page_layer *layers = wd_alloc_array(demand->count, sizeof *layers);
    float *maps = wd_alloc_array(map_count, sizeof *maps);
    uint32_t *tables = wd_alloc_array(table_count, sizeof *tables);
    map_count = table_count = 0;
    for (uint32_t i = 0; i < demand->count; i++) {
        const struct wd_demand_layer *layer = &demand->layers[i];
        const struct wd_placement *placement = &layer->placement;
        layers[i] = (struct wd_page_layer){
            placement->input.layer, layer->first_id,       (uint32_t)table_count,
            (uint32_t)map_count,    fade_of(layer->index), (uint32_t)(layer->grain_m * 100.0f)};
        if (placement->map)
            memcpy(maps + map_count, placement->map, map_size(layer) * sizeof *maps);
        memcpy(tables + table_count, placement->table, placement->table_count * sizeof *tables);
        map_count += map_size(layer);
        table_count += placement->table_count;
    }
    bool ok = make_buffer(&pages->layers, pages->gpu, "page layers", layers,
                          demand->count * sizeof *layers) &&
              make_buffer(&pages->maps, pages->gpu, "page maps", maps,
                          (map_count + 1) * sizeof *maps) &&
              make_buffer(&pages->tables, pages->gpu, "page tables", tables,
                          (table_count + 1) * sizeof *tables);
    free(layers);
    free(maps);
    free(tables);
    return ok;
}

uint32_t wd_pages_capacity(const struct wd_gpu *gpu, const struct wd_world *world)
{
    uint64_t bytes = gpu->properties.limits.maxStorageBufferRange;
    uint64_t block = (WD_BLOCK_TREES + 1) * sizeof(struct wd_packed_tree);
    uint64_t stored = wd_pages_first(world) / WD_BLOCK_TREES * block;
    uint64_t room = bytes > stored ? (bytes - stored) / block : 0;
    return world->demand.count == 0 ? 0 : room < WD_PAGES_MOST ? (uint32_t)room : WD_PAGES_MOST;
}

uint32_t wd_pages_first(const struct wd_world *world)
{
    return (uint32_t)((world->tree_count + WD_BLOCK_TREES - 1) / WD_BLOCK_TREES * WD_BLOCK_TREES);
}

bool wd_pages_init(struct wd_pages *pages, struct wd_gpu *gpu, const struct wd_world *world,
                   const struct wd_ground *ground, uint32_t variants)
{
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const struct wd_compute_params populate = {
        .shader = WD_SPIRV(populate_comp),
        .bindings = {9, {buffer, buffer, buffer, buffer, buffer, buffer, buffer, buffer, buffer}},
        .push_size = sizeof(struct wd_page_push),
    };
    uint32_t capacity = wd_pages_capacity(gpu, world);
    *pages = (struct wd_pages){.gpu = gpu,
                               .world = world,
                               .ground = ground,
                               .first_tree = wd_pages_first(world),
                               .variants = variants};
    if (!world->demand.count)
        return true;
    if (capacity < 64)
        return wd_error(gpu->log,
                        "%zu stored trees leave no room for those planted on demand: %s binds %u "
                        "MB at once",
                        world->tree_count, gpu->properties.deviceName,
                        gpu->properties.limits.maxStorageBufferRange >> 20);
    wd_page_slots_init(pages, capacity);
    const struct wd_ground_input *input = &world->demand.layers[0].placement.input.ground;
    return wd_pipeline_init_compute(&pages->populate, gpu, &populate) && upload_layers(pages) &&
           make_buffer(&pages->place_ground, gpu, "page ground", &input->ground,
                       sizeof input->ground);
}

void wd_pages_finish(struct wd_pages *pages, struct wd_gpu *gpu)
{
    struct wd_buffer *buffers[] = {&pages->place_ground, &pages->layers, &pages->maps,
                                   &pages->tables};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        wd_buffer_finish(buffers[i], gpu);
    wd_page_slots_finish(pages);
    *pages = (struct wd_pages){0};
}

bool wd_pages_tree(const struct wd_pages *pages, uint32_t record, struct wd_tree *tree)
{
    uint32_t at = record - pages->first_tree;
    const struct wd_page_slot *slot = &pages->slots[at / WD_PAGE_TREES];
    return slot->filled &&
           wd_demand_tree(&pages->world->demand, &slot->page, at % WD_PAGE_TREES, tree);
}

void wd_page_list_finish(struct wd_page_list *list)
{
    free(list->slots);
    *list = (struct wd_page_list){0};
}

/* --- choice ------------------------------------------------------------------------------- */

struct page_array {
    struct wd_page *items;
    size_t count, capacity;
};

struct choice {
    struct wd_pages *pages;
    const struct wd_pages_query *query;
    double fewer;            /* factor on the trees that are wanted */
    struct page_array wanted;
    struct page_array missing;
    uint32_t *missing_slots;
    size_t missing_slot_count, missing_slot_capacity;
};

/* Where the feet of a page's trees are, in local metres; false: it lies outside of the ground. */
static bool page_feet(const struct wd_pages *pages, const struct wd_page *page, double low[3],
                      double high[3])
{
    const struct wd_place_layer *numbers =
        &pages->world->demand.layers[page->layer].placement.input.layer;
    double side_m = (double)((uint64_t)WD_PAGE_SIDE << page->level) * numbers->cell_mm * 0.001;
    low[0] = page->column * side_m;
    low[1] = page->row * side_m;
    for (int k = 0; k < 2; k++) {
        if (low[k] * 1000.0 >= numbers->extent_mm[k])
            return false;
        high[k] = fmin(low[k] + side_m, numbers->extent_mm[k] * 0.001);
    }
    struct wd_height_range range = wd_ground_range(pages->ground, low, high);
    low[2] = (double)range.min_m;
    high[2] = (double)range.max_m;
    return true;
}

/* Bounds of a page's trees in rel; false: it lies outside of the ground. */
static bool page_box(const struct choice *c, const struct wd_page *page, float min[3], float max[3])
{
    const struct wd_demand_layer *layer = &c->pages->world->demand.layers[page->layer];
    double reach_m = 0.75 * (double)layer->max_crown_m + 0.1 * (double)layer->max_height_m + 0.5;
    double low[3], high[3];
    if (!page_feet(c->pages, page, low, high))
        return false;
    high[2] += 1.1 * (double)layer->max_height_m;
    for (int k = 0; k < 3; k++) {
        min[k] = (float)(low[k] - (k < 2 ? reach_m : 1.0) - c->query->eye_m[k]);
        max[k] = (float)(high[k] + (k < 2 ? reach_m : 0.0) - c->query->eye_m[k]);
    }
    return true;
}

/* Whether the page holds as many trees as its nearest place asks for. */
static bool is_fine(const struct choice *c, const struct wd_page *page, const float min[3],
                    const float max[3])
{
    const struct wd_demand_layer *layer = &c->pages->world->demand.layers[page->layer];
    double distance_m = c->query->orthographic ? 1.0 : fmax((double)wd_box_distance(min, max), 1.0);
    double tall_px = (double)(layer->grain_m * c->query->pixels) / distance_m;
    double share = tall_px / (double)c->query->whole_px;
    return page->level == 0 || c->fewer * share * share <= ldexp(1.0, -2 * (int)page->level);
}

static bool is_seen(const struct choice *c, const struct wd_page *page, bool *fine)
{
    float min[3], max[3];
    if (!page_box(c, page, min, max) || !c->query->sees(c->query->view, min, max))
        return false;
    *fine = is_fine(c, page, min, max);
    return true;
}

static struct wd_page child_of(const struct wd_page *page, uint32_t child)
{
    return (struct wd_page){page->layer, page->level - 1, 2 * page->column + (child & 1),
                            2 * page->row + (child >> 1)};
}

static struct wd_page root_of(const struct choice *c, uint32_t layer)
{
    return (struct wd_page){layer, c->pages->world->demand.layers[layer].levels - 1, 0, 0};
}

/* The pages that are wanted below `page`; stops when there are more than may be. */
static void visit(struct choice *c, const struct wd_page *page)
{
    bool fine;
    if (c->wanted.count > c->query->most || !is_seen(c, page, &fine))
        return;
    if (fine) {
        *wd_push(c->wanted.items, c->wanted.count, c->wanted.capacity) = *page;
        return;
    }
    for (uint32_t i = 0; i < 4; i++) {
        struct wd_page child = child_of(page, i);
        visit(c, &child);
    }
}

/* A hard cap: trees thin out until their pages are few enough. */
static void find_wanted(struct choice *c)
{
    for (c->fewer = 1.0; c->fewer > 1e-9; c->fewer *= 0.7) {
        c->wanted.count = 0;
        for (uint32_t layer = 0; layer < c->pages->world->demand.count; layer++) {
            struct wd_page root = root_of(c, layer);
            visit(c, &root);
        }
        if (c->wanted.count <= c->query->most)
            return;
    }
    c->wanted.count = c->query->most;
}

static uint32_t slot_for(struct choice *c, const struct wd_page *page)
{
    int64_t found = wd_page_slots_find(c->pages, page);
    if (found != WD_NO_SLOT)
        return (uint32_t)found;
    uint32_t slot = wd_page_slots_take(c->pages, page);
    *wd_push(c->missing.items, c->missing.count, c->missing.capacity) = *page;
    *wd_push(c->missing_slots, c->missing_slot_count, c->missing_slot_capacity) = slot;
    return slot;
}

static void add_slot(struct wd_page_list *list, uint32_t slot)
{
    *wd_push(list->slots, list->count, list->capacity) = slot;
}

static size_t count_missing(const struct choice *c, const struct page_array *pages)
{
    size_t missing = 0;
    for (size_t i = 0; i < pages->count; i++)
        missing += wd_page_slots_find(c->pages, &pages->items[i]) == WD_NO_SLOT;
    return missing;
}

/* From the coarsest pages down, as far as the budget goes: a page gives way to its children only when
 * all of them that are seen are there. */
static void refine(struct choice *c, struct wd_page_list *list)
{
    struct page_array queue = {0};
    for (uint32_t layer = 0; layer < c->pages->world->demand.count; layer++) {
        struct wd_page root = root_of(c, layer);
        slot_for(c, &root);
        *wd_push(queue.items, queue.count, queue.capacity) = root;
    }
    for (size_t at = 0; at < queue.count; at++) {
        struct wd_page page = queue.items[at], children[4];
        struct page_array seen = {.items = children, .capacity = 4};
        bool fine;
        if (!is_seen(c, &page, &fine))
            continue;
        for (uint32_t i = 0; i < 4 && !fine; i++) {
            bool ignored;
            children[seen.count] = child_of(&page, i);
            seen.count += is_seen(c, &children[seen.count], &ignored);
        }
        if (fine || c->missing.count + count_missing(c, &seen) > c->query->budget) {
            add_slot(list, slot_for(c, &page));
            continue;
        }
        for (size_t i = 0; i < seen.count; i++) {
            slot_for(c, &seen.items[i]);
            *wd_push(queue.items, queue.count, queue.capacity) = seen.items[i];
        }
    }
    free(queue.items);
}

/* --- planting ----------------------------------------------------------------------------- */

/* A millimetre to spare, as metres are not whole ones. */
static struct wd_tree_block block_of(const struct wd_pages *pages, const struct wd_page *page)
{
    double low[3] = {0}, high[3] = {0};
    int64_t least_mm[3], most_mm[3];
    page_feet(pages, page, low, high);
    for (int k = 0; k < 3; k++) {
        least_mm[k] = (int64_t)floor(low[k] * 1000.0) - 1;
        most_mm[k] = (int64_t)ceil(high[k] * 1000.0) + 1;
    }
    return wd_tree_block_in(least_mm, most_mm, pages->variants);
}

static void plant(struct choice *c, struct wd_cmd *cmd, struct wd_buffer *trees,
                  struct wd_buffer *clusters, uint32_t first_cluster)
{
    struct wd_pages *pages = c->pages;
    struct wd_binding list;
    struct wd_page_job *jobs = wd_cmd_upload(cmd, c->missing.count * sizeof *jobs, &list);
    if (!jobs)
        return;
    for (size_t i = 0; i < c->missing.count; i++) {
        const struct wd_page *page = &c->missing.items[i];
        jobs[i] = (struct wd_page_job){.layer = page->layer,
                                       .level = page->level,
                                       .column = page->column,
                                       .row = page->row,
                                       .slot = c->missing_slots[i],
                                       .block = block_of(pages, page)};
    }
    const struct wd_page_push push = {(uint32_t)c->missing.count, pages->first_tree, first_cluster};
    struct wd_buffer *tables[] = {&pages->place_ground, &pages->layers, &pages->maps,
                                  &pages->tables};
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
        wd_cmd_use_buffer(cmd, tables[i], WD_USE_COMPUTE_READ);
    const struct wd_binding bindings[] = {WD_BIND_BUFFER(&pages->place_ground),
                                          WD_BIND_BUFFER(&pages->ground->heights),
                                          WD_BIND_BUFFER(&pages->ground->holes),
                                          WD_BIND_BUFFER(&pages->maps),
                                          WD_BIND_BUFFER(&pages->tables),
                                          WD_BIND_BUFFER(&pages->layers),
                                          list,
                                          WD_BIND_BUFFER(trees),
                                          WD_BIND_BUFFER(clusters)};
    wd_cmd_use_buffer(cmd, trees, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(cmd, clusters, WD_USE_COMPUTE_WRITE);
    wd_cmd_bind(cmd, &pages->populate, bindings);
    wd_cmd_push(cmd, &pages->populate, &push, sizeof push);
    wd_cmd_dispatch_1d(cmd, (uint64_t)c->missing.count * WD_PAGE_CLUSTERS);
    wd_cmd_use_buffer(cmd, trees, WD_USE_SHADER_READ);
    wd_cmd_use_buffer(cmd, clusters, WD_USE_COMPUTE_READ);
    pages->planted += c->missing.count;
}

static uint64_t hash_of(const struct wd_pages_query *query)
{
    const struct {
        uint64_t view;
        double eye_m[3], pixels, whole_px;
        uint64_t most, orthographic;
    } key = {query->view_hash,
             {query->eye_m[0], query->eye_m[1], query->eye_m[2]},
             (double)query->pixels,
             (double)query->whole_px,
             query->most,
             query->orthographic};
    return XXH3_64bits(&key, sizeof key);
}

/* Whether the list is the one that would be made now; then its pages are in use again. */
static bool use_again(struct wd_pages *pages, const struct wd_page_list *list, uint64_t hash)
{
    if (list->coarser || !list->changes || list->query_hash != hash || list->changes != pages->changes)
        return false;
    for (size_t i = 0; i < list->count; i++)
        wd_page_slots_touch(pages, list->slots[i]);
    return true;
}

void wd_pages_select(struct wd_pages *pages, struct wd_cmd *cmd,
                     const struct wd_pages_query *query, struct wd_buffer *trees,
                     struct wd_buffer *clusters, uint32_t first_cluster,
                     struct wd_page_list *list)
{
    struct choice choice = {.pages = pages, .query = query};
    uint64_t hash = hash_of(query);
    if (pages->capacity && !cmd->failed && use_again(pages, list, hash))
        return;
    list->count = 0;
    list->coarser = false;
    list->changes = 0;
    if (!pages->capacity || cmd->failed)
        return;
    find_wanted(&choice);
    list->coarser = query->budget && count_missing(&choice, &choice.wanted) > query->budget;
    if (list->coarser)
        refine(&choice, list);
    else
        for (size_t i = 0; i < choice.wanted.count; i++)
            add_slot(list, slot_for(&choice, &choice.wanted.items[i]));
    if (choice.missing.count)
        plant(&choice, cmd, trees, clusters, first_cluster);
    list->query_hash = hash;
    list->changes = cmd->failed ? 0 : pages->changes;
    free(choice.wanted.items);
    free(choice.missing.items);
    free(choice.missing_slots);
}
