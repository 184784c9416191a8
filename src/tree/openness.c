/* Leaves stand in clumps: on twigs, in tufts, in sprays with gaps between them. More light comes
 * through than through as many leaves spread evenly (the clumping index of Nilson, Agric. Meteorol.
 * 8 (1971) 25-38; for a pine's shoots as low as 0.5). How much more is measured in the mesh itself:
 * it is drawn with depth from a few sides of the sky, of equal parts of the light that a level
 * surface gets, and places on leaves are asked whether anything stands before them. Places of like
 * openness by the grid are taken together; their share that is lit is their true openness. */
#include "tree/openness.h"

#include <stdlib.h>

#include "base/memory.h"
#include "tree/silhouette.h"

enum { WAYS = 4, PLACES = 1536, BANDS = 6, STEPS = 256 };

struct tally {
    uint32_t lit[STEPS], asked[STEPS]; /* by the grid's openness */
};

/* Steps of openness that are taken together: sums, then means. */
struct band {
    float kept, traced, weight;
};

/* Asks corners of leaves; what is nearer than `near_m` is the leaf itself. */
static void ask(struct tally *tally, const struct wd_silhouette *view, const float *front,
                const struct wd_tree_mesh *mesh, float near_m)
{
    const struct wd_silhouette_axes axes = wd_silhouette_axes_of(view);
    uint64_t leaves = mesh->index_count - mesh->wood_index_count;
    for (uint64_t i = 0; i < PLACES; i++) {
        uint32_t vertex = mesh->indices[mesh->wood_index_count + leaves * i / PLACES];
        float at[3];
        wd_silhouette_place(&axes, mesh->vertices[vertex].position_m, at);
        int x = (int)wd_clampf(at[0], 0, WD_SILHOUETTE - 1);
        int y = (int)wd_clampf(at[1], 0, WD_SILHOUETTE - 1);
        uint32_t step = mesh->vertices[vertex].tint >> 24;
        tally->asked[step]++;
        tally->lit[step] += front[y * WD_SILHOUETTE + x] <= at[2] + near_m;
    }
}

/* Length of a leaf or, where leaves are not known apart, of a quad. */
static float leaf_length_m(const struct wd_tree_model *model)
{
    uint32_t triangles = (model->full.index_count - model->full.wood_index_count) / 3;
    if (model->leaf_count)
        return model->sets[0][WD_SET_LEAVES].grain *
               sqrtf(model->leaf_area_m2 / (float)model->leaf_count);
    return sqrtf(2 * model->leaf_area_m2 / (float)triangles);
}

/* Ways whose shares of the light of a level surface are equal: sin^2 of the angle from above. */
static struct wd_vec3 way_toward(int way)
{
    double share = (way + 0.5) / WAYS, turn = 2.39996323 * way;
    float level = (float)sqrt(share), up = (float)sqrt(1 - share);
    return WD_V3(level * (float)wd_dcos(turn), level * (float)wd_dsin(turn), up);
}

static void ask_sky(struct tally *tally, const struct wd_tree_model *model)
{
    const struct wd_tree_mesh *mesh = &model->full;
    struct wd_silhouette views[WAYS];
    float *fronts = wd_alloc_array((size_t)WAYS * WD_SILHOUETTE_FRONT, sizeof *fronts);
    for (int way = 0; way < WAYS; way++)
        wd_silhouette_init(&views[way], mesh, way_toward(way));
    wd_silhouette_front(views, WAYS, mesh, fronts);
    for (int way = 0; way < WAYS; way++)
        ask(tally, &views[way], fronts + way * WD_SILHOUETTE_FRONT, mesh, leaf_length_m(model));
    free(fronts);
}

static bool rises(const struct band *low, const struct band *high)
{
    return low->traced * high->weight < high->traced * low->weight;
}

static struct band together(const struct band *a, const struct band *b)
{
    return (struct band){a->kept + b->kept, a->traced + b->traced, a->weight + b->weight};
}

/* Bands of about as many places each, in which openness only rises (pool adjacent violators). */
static int find_bands(struct band bands[BANDS], const struct tally *tally)
{
    const float enough = (float)PLACES * WAYS / BANDS;
    struct band sum = {0};
    int count = 0;
    for (int step = 0; step < STEPS; step++) {
        sum.kept += (float)(tally->asked[step] * (uint32_t)step);
        sum.traced += (float)(tally->lit[step] * (STEPS - 1));
        sum.weight += (float)tally->asked[step];
        if (sum.weight < (step == STEPS - 1 ? 1 : enough))
            continue;
        for (; count > 0 && !rises(&bands[count - 1], &sum); count--)
            sum = together(&sum, &bands[count - 1]);
        bands[count++] = sum;
        sum = (struct band){0};
    }
    for (int i = 0; i < count; i++) {
        bands[i].kept /= bands[i].weight;
        bands[i].traced /= bands[i].weight;
    }
    return count;
}

/* Straight from band to band, to nothing below and the whole sky above. */
static void fill_curve(uint8_t curve[STEPS], const struct band *bands, int count)
{
    struct band low = {0};
    int next = 0;
    for (int step = 0; step < STEPS; step++) {
        while (next < count && bands[next].kept <= (float)step)
            low = bands[next++];
        struct band high = next < count ? bands[next] : (struct band){STEPS - 1, STEPS - 1, 0};
        float range = high.kept - low.kept;
        float share = range > 0 ? ((float)step - low.kept) / range : 0;
        curve[step] = (uint8_t)(wd_mixf(low.traced, high.traced, share) + 0.5f);
    }
}

static void turn_tint(uint32_t *tint, const uint8_t curve[STEPS])
{
    *tint = (*tint & 0xffffffu) | (uint32_t)curve[*tint >> 24] << 24;
}

static void turn_mesh(struct wd_tree_mesh *mesh, const uint8_t curve[STEPS])
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        turn_tint(&mesh->vertices[i].tint, curve);
}

void wd_tree_model_fit_openness(struct wd_tree_model *model)
{
    struct tally tally = {0};
    struct band bands[BANDS];
    uint8_t curve[STEPS];
    if (model->full.index_count <= model->full.wood_index_count)
        return;
    ask_sky(&tally, model);
    fill_curve(curve, bands, find_bands(bands, &tally));
    turn_mesh(&model->full, curve);
    turn_mesh(&model->reduced, curve);
    turn_mesh(&model->far_stem, curve);
    for (uint32_t i = 0; model->leaves && i < model->leaf_count + model->flower_count; i++)
        turn_tint(&model->leaves[i].tint, curve);
}
