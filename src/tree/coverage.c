#include "tree/coverage.h"

#include <stdlib.h>
#include <string.h>

#include "base/dmath.h"
#include "base/memory.h"
#include "tree/silhouette.h"

enum { VIEWS = 2, STEPS = 3, MOST_TURNS = 4 };
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
    struct wd_silhouette wood[VIEWS]; /* what it covers, whatever the size of leaves */
};

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

/* Wood is made of vertices of its own, which are left as they are. */
static void scale_leaves(struct fit *fit, float factor)
{
    struct wd_tree_mesh *mesh = fit->mesh;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        if (!(mesh->vertices[i].kind & WD_VERTEX_LEAF))
            continue;
        struct wd_vec3 p = wd_v3_mix(fit->middles[fit->parts[i]].place, fit->unscaled[i], factor);
        mesh->vertices[i].position_m[0] = p.x;
        mesh->vertices[i].position_m[1] = p.y;
        mesh->vertices[i].position_m[2] = p.z;
    }
}

static float covered(const struct fit *fit)
{
    size_t sum = 0;
    struct wd_silhouette views[VIEWS];
    memcpy(views, fit->wood, sizeof views);
    wd_silhouette_cover(views, VIEWS, fit->mesh, fit->mesh->wood_index_count,
                        fit->mesh->index_count);
    for (int i = 0; i < VIEWS; i++)
        sum += wd_silhouette_count(&views[i]);
    return (float)sum;
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
        scale_leaves(fit, factor);
        found = covered(fit);
    }
    return factor;
}

float wd_tree_mesh_fit_coverage(struct wd_tree_mesh *reduced, const struct wd_tree_mesh *full)
{
    static const struct wd_vec3 towards[VIEWS] = {{0.998f, 0, 0.07f}, {0, 0.77f, 0.64f}};
    if (reduced->wood_index_count == reduced->index_count)
        return 1;
    struct fit fit = {
        .mesh = reduced,
        .parts = wd_alloc_array(reduced->vertex_count, sizeof *fit.parts),
        .unscaled = wd_alloc_array(reduced->vertex_count, sizeof *fit.unscaled),
    };
    size_t wanted = 0;
    struct wd_silhouette whole[VIEWS];
    for (int i = 0; i < VIEWS; i++)
        wd_silhouette_init(&whole[i], full, towards[i]);
    memcpy(fit.wood, whole, sizeof whole);
    wd_silhouette_cover(fit.wood, VIEWS, reduced, 0, reduced->wood_index_count);
    wd_silhouette_cover(whole, VIEWS, full, 0, full->index_count);
    for (int i = 0; i < VIEWS; i++)
        wanted += wd_silhouette_count(&whole[i]);
    find_middles(&fit);
    float factor = find_factor(&fit, (float)wanted);
    free(fit.parts);
    free(fit.middles);
    free(fit.unscaled);
    wd_tree_mesh_update_bounds(reduced);
    return factor;
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
