#include "tree/coverage.h"

#include <stdlib.h>
#include <string.h>

#include "base/dmath.h"
#include "base/memory.h"
#include "tree/silhouette.h"

enum {
    VIEWS = 2, /* from the side and from half above */
    MORE_VIEWS = 8, FEW_TRIANGLES = 10000, /* of meshes whose few leaves leave more to chance */
    STEPS = 3, MOST_TURNS = 4
};
/* Beyond these, leaves would no longer look like leaves. */
static const float LEAST = 0.25f, MOST = 4;
/* How much of a leaf's growth is seen in a crown, mostly: the rest hides behind other leaves. */
#define FIRST_SLOPE 0.62f

struct middle {
    struct wd_vec3 place;
    uint32_t members;
};

struct fit {
    struct wd_tree_mesh *mesh;
    uint32_t *parts;         /* [vertex] number of its leaf */
    struct middle *middles;  /* [leaf] */
    struct wd_vec3 *unscaled; /* [vertex] */
    struct wd_silhouette *views, *still; /* [view_count]; still: what is covered, whatever the factor */
    int view_count;
    bool flowers;        /* they are scaled, not leaves */
    uint32_t first, end; /* indices of what is scaled */
};

/* Flowers' triangles come last. */
static uint32_t first_flower_index(const struct wd_tree_mesh *mesh)
{
    uint32_t first = mesh->index_count;
    while (first > mesh->wood_index_count &&
           mesh->vertices[mesh->indices[first - 1]].kind & WD_VERTEX_FLOWER)
        first -= 3;
    return first;
}

static struct wd_vec3 position(const struct wd_tree_mesh *mesh, uint32_t vertex)
{
    const float *p = mesh->vertices[vertex].position_m;
    return WD_V3(p[0], p[1], p[2]);
}

static uint32_t root_of(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
    return i;
}

/* Numbers what hangs together by triangles of leaves; a vertex's parent is never a later one. */
static uint32_t number_parts(uint32_t *parts, const struct wd_tree_mesh *mesh)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        parts[i] = i;
    for (uint32_t i = mesh->wood_index_count; i + 2 < mesh->index_count; i += 3)
        for (uint32_t k = 1; k < 3; k++) {
            uint32_t a = root_of(parts, mesh->indices[i]);
            uint32_t b = root_of(parts, mesh->indices[i + k]);
            parts[a < b ? b : a] = a < b ? a : b;
        }
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        parts[i] = parts[i] == i ? count++ : parts[parts[i]];
    return count;
}

static void find_middles(struct fit *fit)
{
    const struct wd_tree_mesh *mesh = fit->mesh;
    uint32_t count = number_parts(fit->parts, mesh);
    fit->middles = wd_alloc_array(count + 1, sizeof *fit->middles);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        struct middle *middle = &fit->middles[fit->parts[i]];
        fit->unscaled[i] = position(mesh, i);
        middle->place = wd_v3_add(middle->place, fit->unscaled[i]);
        middle->members++;
    }
    for (uint32_t i = 0; i < count; i++)
        fit->middles[i].place =
            wd_v3_scale(fit->middles[i].place, 1 / (float)fit->middles[i].members);
}

static bool is_scaled(const struct fit *fit, const struct wd_tree_vertex *vertex)
{
    return vertex->kind & WD_VERTEX_LEAF && fit->flowers == !!(vertex->kind & WD_VERTEX_FLOWER);
}

/* Wood, leaves and flowers are made of vertices of their own. */
static void scale_parts(struct fit *fit, float factor)
{
    struct wd_tree_mesh *mesh = fit->mesh;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        if (!is_scaled(fit, &mesh->vertices[i]))
            continue;
        struct wd_vec3 p = wd_v3_mix(fit->middles[fit->parts[i]].place, fit->unscaled[i], factor);
        mesh->vertices[i].position_m[0] = p.x;
        mesh->vertices[i].position_m[1] = p.y;
        mesh->vertices[i].position_m[2] = p.z;
    }
}

static float seen(const struct wd_silhouette *views, int count)
{
    size_t sum = 0;
    for (int i = 0; i < count; i++)
        sum += wd_silhouette_count(&views[i]);
    return (float)sum;
}

static float covered(const struct fit *fit)
{
    memcpy(fit->views, fit->still, (size_t)fit->view_count * sizeof *fit->views);
    wd_silhouette_cover(fit->views, fit->view_count, fit->mesh, fit->first, fit->end);
    return seen(fit->views, fit->view_count);
}

/* Coverage grows with the factor, slower and slower: the secant through the last two tries. */
static float find_factor(struct fit *fit, float wanted)
{
    float factor = 1, found = covered(fit), last_factor = 1, last_found = found;
    for (int step = 0; step < STEPS && fabsf(found - wanted) > 0.005f * wanted; step++) {
        float slope = (found - last_found) / (factor - last_factor);
        if (step == 0 || !(slope > 0.1f * found / factor))
            slope = FIRST_SLOPE * found / factor;
        last_factor = factor;
        last_found = found;
        factor = wd_clampf(factor + (wanted - found) / slope, LEAST, MOST);
        if (factor == last_factor)
            break;
        scale_parts(fit, factor);
        found = covered(fit);
    }
    return factor;
}

/* Level and from half above in turn, pairs an eighth of a turn apart. */
static struct wd_vec3 view_toward(int view)
{
    static const struct wd_vec3 towards[VIEWS] = {{0.998f, 0, 0.07f}, {0, 0.77f, 0.64f}};
    static const float eighths[MORE_VIEWS / VIEWS][2] = {{1, 0}, {0.70710678f, 0.70710678f}, {0, 1}, {-0.70710678f, 0.70710678f}};
    struct wd_vec3 v = towards[view % VIEWS];
    const float *turn = eighths[view / VIEWS];
    return WD_V3(turn[0] * v.x - turn[1] * v.y, turn[1] * v.x + turn[0] * v.y, v.z);
}

/* Flowers cover as much as those of `full` do by themselves, leaves as all of it does. */
static float find_wanted(struct fit *fit, const struct wd_tree_mesh *full)
{
    const struct wd_tree_mesh *reduced = fit->mesh;
    for (int i = 0; i < fit->view_count; i++)
        wd_silhouette_init(&fit->views[i], full, view_toward(i));
    memcpy(fit->still, fit->views, (size_t)fit->view_count * sizeof *fit->views);
    if (!fit->flowers) {
        wd_silhouette_cover(fit->still, fit->view_count, reduced, 0, fit->first);
        wd_silhouette_cover(fit->still, fit->view_count, reduced, fit->end, reduced->index_count);
    }
    wd_silhouette_cover(fit->views, fit->view_count, full, fit->flowers ? first_flower_index(full) : 0,
                        full->index_count);
    return seen(fit->views, fit->view_count);
}

static float fit_parts(struct wd_tree_mesh *reduced, const struct wd_tree_mesh *full, bool flowers)
{
    uint32_t first_flower = first_flower_index(reduced);
    int view_count = full->index_count < 3 * FEW_TRIANGLES ? MORE_VIEWS : VIEWS;
    struct fit fit = {
        .mesh = reduced,
        .flowers = flowers,
        .first = flowers ? first_flower : reduced->wood_index_count,
        .end = flowers ? reduced->index_count : first_flower,
        .view_count = view_count,
    };
    if (fit.first == fit.end)
        return 1;
    fit.parts = wd_alloc_array(reduced->vertex_count, sizeof *fit.parts);
    fit.unscaled = wd_alloc_array(reduced->vertex_count, sizeof *fit.unscaled);
    fit.views = wd_alloc_array((size_t)view_count, sizeof *fit.views);
    fit.still = wd_alloc_array((size_t)view_count, sizeof *fit.still);
    float wanted = find_wanted(&fit, full);
    find_middles(&fit);
    float factor = find_factor(&fit, wanted);
    free(fit.parts);
    free(fit.middles);
    free(fit.unscaled);
    free(fit.views);
    free(fit.still);
    return factor;
}

void wd_tree_mesh_fit_coverage(struct wd_tree_mesh *reduced, const struct wd_tree_mesh *full,
                               float factors[WD_LEAF_SETS])
{
    factors[WD_SET_FLOWERS] = fit_parts(reduced, full, true);
    factors[WD_SET_LEAVES] = fit_parts(reduced, full, false);
    wd_tree_mesh_update_bounds(reduced);
}

/* Mean over `turns` sides that are `step` of a turn apart. */
static float seen_around(const struct wd_tree_mesh *mesh, int turns, double step, float sine)
{
    struct wd_silhouette views[MOST_TURNS];
    float sum = 0, cosine = sqrtf(1 - sine * sine);
    for (int i = 0; i < turns; i++) {
        double turn = 2 * WD_PI * step * i;
        wd_silhouette_init(&views[i], mesh,
                           WD_V3(cosine * (float)wd_dsin(turn), -cosine * (float)wd_dcos(turn),
                                 sine));
    }
    wd_silhouette_cover(views, turns, mesh, 0, mesh->index_count);
    for (int i = 0; i < turns; i++)
        sum += (float)wd_silhouette_count(&views[i]) / (views[i].scale * views[i].scale);
    return sum / (float)turns;
}

void wd_tree_mesh_measure_seen(float seen_m2[WD_GAIN_SIDES], const struct wd_tree_mesh *mesh)
{
    seen_m2[0] = seen_around(mesh, 3, 1.0 / 6, 0);
    seen_m2[1] = seen_around(mesh, MOST_TURNS, 1.0 / 4, 0.70710678f);
    seen_m2[2] = seen_around(mesh, 1, 1, 1);
}
