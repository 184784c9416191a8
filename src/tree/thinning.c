#include "tree/thinning.h"

#include <stdlib.h>
#include <string.h>

#include "base/dmath.h"
#include "base/memory.h"
#include "tree/silhouette.h"

enum { MOST_VIEWS = 3, TRIES = 4, LEAST_LEAVES = 8 };
static const float LEAST = 0.3f, MOST = 1.5f;
/* Coverage grows with about this power of a leaf's length, less where more leaves hide one another. */
static const float POWER = 0.62f;

struct thinning {
    const struct wd_tree_model *model;
    const struct wd_leaf_set *set;
    const struct wd_tree_mesh *mesh;
    struct wd_tree_mesh part; /* its first leaves, grown */
    uint32_t first_vertex;    /* of leaves */
    struct wd_silhouette others[MOST_VIEWS]; /* what wood and flowers cover, from one side */
    int views;
    float *wanted; /* what the full mesh covers from each side; 0: not known yet */
};

/* The views of a side. */
static int frame_side(struct wd_silhouette views[MOST_VIEWS], const struct wd_tree_mesh *frame, int side)
{
    static const float sines[WD_GAIN_SIDES] = {0.07f, 0.70710678f, 1};
    int count = side < 2 ? MOST_VIEWS : 1;
    float sine = sines[side], cosine = sqrtf(1 - sine * sine);
    for (int i = 0; i < count; i++) {
        double turn = 0.4 + 2 * WD_PI * i / count;
        wd_silhouette_init(&views[i], frame, WD_V3(cosine * (float)wd_dcos(turn),
                                                   cosine * (float)wd_dsin(turn), sine));
    }
    return count;
}

static float count_covered(const struct wd_silhouette *views, int count)
{
    size_t sum = 0;
    for (int i = 0; i < count; i++)
        sum += wd_silhouette_count(&views[i]);
    return (float)sum;
}

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
    for (uint32_t i = 0; i < count; i++)
        grow_leaf(t, i, factor);
    t->part.vertex_count = t->first_vertex + count * t->set->corner_count;
    struct wd_silhouette views[MOST_VIEWS];
    memcpy(views, t->others, sizeof views);
    wd_silhouette_cover(views, t->views, &t->part, begin, begin + count * t->set->index_count);
    return count_covered(views, t->views);
}

static void thinning_init(struct thinning *t, const struct wd_tree_model *model, int level,
                          float wanted[WD_GAIN_SIDES])
{
    const struct wd_leaf_set *flowers = &model->sets[level][WD_SET_FLOWERS];
    *t = (struct thinning){
        .model = model,
        .set = &model->sets[level][WD_SET_LEAVES],
        .mesh = level == 0 ? &model->full : &model->reduced,
        .wanted = wanted,
    };
    t->first_vertex = t->mesh->vertex_count - t->set->leaf_count * t->set->corner_count -
                      flowers->leaf_count * flowers->corner_count;
    t->part = *t->mesh;
    t->part.vertices = wd_alloc_array(t->mesh->vertex_count, sizeof *t->part.vertices);
    memcpy(t->part.vertices, t->mesh->vertices,
           t->mesh->vertex_count * sizeof *t->part.vertices);
}

/* What the full mesh covers; what is to cover as much with t's leaves is made ready. */
static float look_from(struct thinning *t, int side)
{
    const struct wd_tree_mesh *full = &t->model->full;
    uint32_t leaves_end =
        t->mesh->wood_index_count + t->set->leaf_count * t->set->index_count;
    t->views = frame_side(t->others, full, side);
    if (t->wanted[side] == 0) {
        struct wd_silhouette whole[MOST_VIEWS];
        memcpy(whole, t->others, sizeof whole);
        wd_silhouette_cover(whole, t->views, full, 0, full->index_count);
        t->wanted[side] = count_covered(whole, t->views);
    }
    wd_silhouette_cover(t->others, t->views, t->mesh, 0, t->mesh->wood_index_count);
    wd_silhouette_cover(t->others, t->views, t->mesh, leaves_end, t->mesh->index_count);
    return t->wanted[side];
}

/* How coverage grows, by the last two tries. */
static float power_of(float grown, float more, float power)
{
    bool known = fabsf(grown) > 0.01f && fabsf(more) > 0.002f;
    return known ? wd_clampf(more / grown, 0.15f, 1.5f) : power;
}

static float fit_step(struct thinning *t, uint32_t count, float area, float growth, float wanted)
{
    float power = POWER, step = 0, last = 0;
    for (int i = 0; i < TRIES; i++) {
        float found = covered(t, count, area * growth);
        if (fabsf(found - wanted) < 0.005f * wanted || !(found > 0))
            break;
        power = i > 0 ? power_of(step, found / last - 1, power) : power;
        step = (wanted / found - 1) / power;
        float next = wd_clampf(growth * (1 + step), LEAST, MOST);
        step = next / growth - 1;
        growth = next;
        last = found;
    }
    return growth;
}

/* All leaves of the full mesh are what they are. */
static void fit_side(struct thinning *t, int side, float growth[WD_LEAF_GROWTHS])
{
    float wanted = look_from(t, side), last = 1;
    for (uint32_t k = t->mesh == &t->model->full; k < WD_LEAF_GROWTHS; k++) {
        uint32_t count = t->set->leaf_count >> k;
        float area = sqrtf((float)t->set->leaf_count / (float)(count ? count : 1));
        if (count >= LEAST_LEAVES)
            last = fit_step(t, count, area, last, wanted);
        growth[k] = last;
    }
}

static void fit_level(struct wd_tree_model *model, int level, float wanted[WD_GAIN_SIDES])
{
    struct thinning t;
    thinning_init(&t, model, level, wanted);
    for (int side = 0; side < WD_GAIN_SIDES; side++)
        fit_side(&t, side, model->leaf_growth[level].of[side]);
    free(t.part.vertices);
}

void wd_tree_thinning_fit(struct wd_tree_model *model)
{
    float wanted[WD_GAIN_SIDES] = {0};
    for (int level = 0; level < 2; level++) {
        for (int k = 0; k < WD_GAIN_SIDES * WD_LEAF_GROWTHS; k++)
            model->leaf_growth[level].of[k / WD_LEAF_GROWTHS][k % WD_LEAF_GROWTHS] = 1;
        if (model->leaves && model->sets[level][WD_SET_LEAVES].leaf_count > 0)
            fit_level(model, level, wanted);
    }
}
