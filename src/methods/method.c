#include "methods/method.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "forest/model_bakes.h"
#include "weald/renderer.h"

static const struct wd_method *const methods[] = {
    &wd_method_octree,
    &wd_method_separate,
    &wd_method_grid,
    &wd_method_lod,
    &wd_method_patch,
    &wd_method_dissolve,
    &wd_method_impostor,
    &wd_method_views,
    &wd_method_zfield,
    &wd_method_continuum,
};

const char *const *wd_method_names(void)
{
    return wd_scene_method_names;
}

const struct wd_method *wd_method_find(const char *name)
{
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        if (strcmp(methods[i]->name, name) == 0)
            return methods[i];
    }
    return NULL;
}

void *wd_method_borrow(const struct wd_method *method, struct wd_gpu *gpu)
{
    void *state = wd_alloc(method->state_size);
    if (method->init && !method->init(state, gpu))
        wd_method_give_back(method, &state, gpu);
    return state;
}

void wd_method_give_back(const struct wd_method *method, void **state, struct wd_gpu *gpu)
{
    if (*state && method->finish)
        method->finish(*state, gpu);
    free(*state);
    *state = NULL;
}

/* --- states ------------------------------------------------------------------------------ */

static void drop_forest(struct wd_method_slot *slot, struct wd_gpu *gpu)
{
    if (slot->forest && slot->method->drop_forest)
        slot->method->drop_forest(slot->state, gpu);
    slot->forest = NULL;
}

static void close_slot(struct wd_method_slot *slot, struct wd_gpu *gpu)
{
    drop_forest(slot, gpu);
    if (slot->method->finish)
        slot->method->finish(slot->state, gpu);
    free(slot->state);
    *slot = (struct wd_method_slot){0};
}

static struct wd_method_slot *open_slot(struct wd_methods *open, struct wd_gpu *gpu,
                                        const struct wd_method *method)
{
    for (uint32_t i = 0; i < open->count; i++) {
        if (open->slots[i].method == method)
            return &open->slots[i];
    }
    struct wd_method_slot *slot = &open->slots[open->count];
    *slot = (struct wd_method_slot){method, wd_alloc(method->state_size), NULL};
    if (method->init && !method->init(slot->state, gpu)) {
        close_slot(slot, gpu);
        return NULL;
    }
    open->count++;
    return slot;
}

bool wd_method_can_draw(const struct wd_method *method, const struct wd_world *world,
                        const struct wd_log *log)
{
    char who[64];
    snprintf(who, sizeof who, "method %s", method->name);
    return method->on_demand || wd_demand_is_none(&world->demand, who, log);
}

void *wd_methods_open(struct wd_methods *open, struct wd_gpu *gpu, const struct wd_method *method,
                      struct wd_forest_device *forest)
{
    _Static_assert(sizeof methods / sizeof *methods <= WD_METHODS_MAX, "a slot for each method");
    if (!wd_method_can_draw(method, forest->world, gpu->log))
        return NULL;
    struct wd_method_slot *slot = open_slot(open, gpu, method);
    if (!slot)
        return NULL;
    if (slot->forest == forest)
        return slot->state;
    drop_forest(slot, gpu);
    slot->forest = forest;
    bool ok = !method->cards || wd_forest_make_cards(forest, gpu);
    if (!ok || (method->use_forest && !method->use_forest(slot->state, gpu, forest))) {
        drop_forest(slot, gpu);
        return NULL;
    }
    return slot->state;
}

void wd_methods_drop_forest(struct wd_methods *open, struct wd_gpu *gpu)
{
    for (uint32_t i = 0; i < open->count; i++)
        drop_forest(&open->slots[i], gpu);
}

void wd_methods_forget(struct wd_methods *open)
{
    for (uint32_t i = 0; i < open->count; i++) {
        if (open->slots[i].method->forget)
            open->slots[i].method->forget(open->slots[i].state);
    }
}

void wd_methods_finish(struct wd_methods *open, struct wd_gpu *gpu)
{
    for (uint32_t i = 0; i < open->count; i++)
        close_slot(&open->slots[i], gpu);
    *open = (struct wd_methods){0};
}
