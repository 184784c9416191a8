#include "tree/thinning.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/silhouette.h"

enum { VIEWS = 4, TRIES = 4, LEAST_LEAVES = 8 };
static const float LEAST = 0.3f, MOST = 1.5f;
/* Coverage grows with about this power of a leaf's length: leaves hide behind one another. */
static const float POWER = 0.62f;

struct thinning {
    const struct wd_tree_model *model;
    const struct wd_leaf_set *set;
    const struct wd_tree_mesh *mesh;
    struct wd_tree_mesh part; /* its first leaves, grown */
    uint32_t first_vertex;    /* of leaves */
    struct wd_silhouette others[VIEWS]; /* what wood and flowers cover */
};

static void grow_leaf(struct thinning *t, uint32_t index, float factor)
{
    const struct wd_tree_leaf *leaf = &t->model->leaves[index];
    const struct wd_leaf_box *box = &t->model->leaf_box;
    struct wd_vec3 along = wd_leaf_axes_of(leaf->turn).along;
    struct wd_vec3 middle =
        wd_v3_mad(wd_leaf_foot(*leaf, *box), along, 0.5f * wd_leaf_size_m(*leaf, *box));
    uint32_t first = t->first_vertex + index * t->set->corner_count;
    for (uint32_t i = first; i < first + t->set->corner_count; i++) {
        const float *p = t->mesh->vertices[i].position_m;
        struct wd_vec3 grown = wd_v3_mix(middle, WD_V3(p[0], p[1], p[2]), factor);
        t->part.vertices[i].position_m[0] = grown.x;
        t->part.vertices[i].position_m[1] = grown.y;
        t->part.vertices[i].position_m[2] = grown.z;
    }
}

/* Pixels covered with the first `count` leaves. */
static float covered(struct thinning *t, uint32_t count, float factor)
{
    const uint32_t begin = t->mesh->wood_index_count;
    size_t sum = 0;
    for (uint32_t i = 0; i < count; i++)
        grow_leaf(t, i, factor);
    t->part.vertex_count = t->first_vertex + count * t->set->corner_count;
    struct wd_silhouette views[VIEWS];
    memcpy(views, t->others, sizeof views);
    wd_silhouette_cover(views, VIEWS, &t->part, begin, begin + count * t->set->index_count);
    for (int i = 0; i < VIEWS; i++)
        sum += wd_silhouette_count(&views[i]);
    return (float)sum;
}

static void thinning_init(struct thinning *t, const struct wd_tree_model *model, int level)
{
    static const struct wd_vec3 towards[VIEWS] = {{0.918f, 0.39f, 0.07f}, {-0.5f, 0.585f, 0.64f},
                                                   {-0.39f, 0.918f, 0.07f}, {0.585f, -0.5f, 0.64f}};
    const struct wd_leaf_set *flowers = &model->sets[level][WD_SET_FLOWERS];
    *t = (struct thinning){
        .model = model,
        .set = &model->sets[level][WD_SET_LEAVES],
        .mesh = level == 0 ? &model->full : &model->reduced,
    };
    t->first_vertex = t->mesh->vertex_count - t->set->leaf_count * t->set->corner_count -
                      flowers->leaf_count * flowers->corner_count;
    t->part = *t->mesh;
    t->part.vertices = wd_alloc_array(t->mesh->vertex_count, sizeof *t->part.vertices);
    memcpy(t->part.vertices, t->mesh->vertices,
           t->mesh->vertex_count * sizeof *t->part.vertices);
    uint32_t leaves_end =
        t->mesh->wood_index_count + t->set->leaf_count * t->set->index_count;
    for (int i = 0; i < VIEWS; i++)
        wd_silhouette_init(&t->others[i], t->mesh, towards[i]);
    wd_silhouette_cover(t->others, VIEWS, t->mesh, 0, t->mesh->wood_index_count);
    wd_silhouette_cover(t->others, VIEWS, t->mesh, leaves_end, t->mesh->index_count);
}

static float fit_step(struct thinning *t, uint32_t count, float area, float growth, float wanted)
{
    for (int i = 0; i < TRIES; i++) {
        float found = covered(t, count, area * growth);
        if (fabsf(found - wanted) < 0.005f * wanted || !(found > 0))
            break;
        growth = wd_clampf(growth * (1 + (wanted / found - 1) / POWER), LEAST, MOST);
    }
    return growth;
}

static void fit_level(struct wd_tree_model *model, int level, float growth[WD_LEAF_GROWTHS])
{
    struct thinning t;
    thinning_init(&t, model, level);
    float wanted = covered(&t, t.set->leaf_count, 1), last = 1;
    for (uint32_t k = 0; k < WD_LEAF_GROWTHS; k++) {
        uint32_t count = t.set->leaf_count >> (k + 1);
        float area = sqrtf((float)t.set->leaf_count / (float)(count ? count : 1));
        if (count >= LEAST_LEAVES)
            last = fit_step(&t, count, area, last, wanted);
        growth[k] = last;
    }
    free(t.part.vertices);
}

void wd_tree_thinning_fit(struct wd_tree_model *model)
{
    for (int level = 0; level < 2; level++) {
        for (int k = 0; k < WD_LEAF_GROWTHS; k++)
            model->leaf_growth[level][k] = 1;
        if (model->leaves && model->sets[level][WD_SET_LEAVES].leaf_count > 0)
            fit_level(model, level, model->leaf_growth[level]);
    }
}
