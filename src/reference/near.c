#include "reference/near.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/hash.h"
#include "tree/leaf_spray.h"
#include "tree/vec.h"

/* Of twigs in all. With 1.5 million, as in pictures, those are nearer than the drawn ones: see docs/performance.md. */
enum { MOST_TRIANGLES = 4000000 };

/* --- which leaves ---------------------------------------------------------------------------- */

void wd_trace_near_add(struct wd_trace_near *near, const struct wd_trace_model *model,
                       const struct wd_tree *tree, uint32_t index, const float transform[12])
{
    float reach_m = WD_TREE_CROWN_M(*tree) + WD_SPRAY_NONE_M * model->grown.spray_reach;
    const float *foot_m = transform + 9;
    if (!wd_trace_has_twigs(model) ||
        foot_m[0] * foot_m[0] + foot_m[1] * foot_m[1] > reach_m * reach_m)
        return;
    struct wd_trace_near_tree *added = wd_push(near->trees, near->count, near->capacity);
    added->tree = index;
    memcpy(added->transform, transform, sizeof added->transform);
}

static struct wd_vec3 placed(const float m[12], struct wd_vec3 p)
{
    return WD_V3(m[0] * p.x + m[3] * p.y + m[6] * p.z + m[9],
                 m[1] * p.x + m[4] * p.y + m[7] * p.z + m[10],
                 m[2] * p.x + m[5] * p.y + m[8] * p.z + m[11]);
}

/* A leaf that is a twig where the share of twigs at its distance is over `chance`. */
struct wd_trace_near_leaf {
    uint32_t index;
    float distance_m, chance;
    bool plain; /* a tenth of the triangles */
};
static const float PLAIN_PX = 0.5f;

static const struct wd_tree_mesh *twig_of(const struct wd_tree_model *grown, const struct wd_trace_near_leaf *leaf)
{
    return leaf->plain ? &grown->spray_shade : &grown->spray;
}

/* Whether the leaf's twig is in the picture, or its shadow where it falls on what is no farther off than leaves that
 * are twigs, on the other side of the eye, too. */
static bool matters(const struct wd_trace_near_scene *scene, struct wd_vec3 foot, float twig_m, float reach_m)
{
    const struct wd_frame_uniforms *frame = scene->frame;
    const float *sun = frame->sun_direction, *light = frame->sun_irradiance;
    float shadow_m = wd_max3f(light[0], light[1], light[2]) > 0 ? 2 * reach_m : 0;
    struct wd_vec3 shadow = wd_v3_mad(foot, WD_V3(sun[0], sun[1], sun[2]), -shadow_m);
    return wd_trace_view_sees(scene->view, foot, shadow, twig_m);
}

static void gather(struct wd_trace_near_tree *at, const struct wd_trace_near_scene *scene)
{
    const struct wd_tree *tree = &scene->trees[at->tree];
    const struct wd_tree_model *grown = &wd_trace_model_of(scene->models, tree)->grown;
    const float *m = at->transform;
    float widest = wd_maxf(wd_v3_length(WD_V3(m[0], m[1], m[2])), wd_v3_length(WD_V3(m[6], m[7], m[8])));
    float reach_m = WD_SPRAY_NONE_M * grown->spray_reach;
    float grain = wd_leaf_spray_grain(&grown->spray_shade), plain_rad = PLAIN_PX * wd_trace_pixel_rad(scene->view);
    for (uint32_t i = 0; i < grown->sets[0][WD_SET_LEAVES].leaf_count; i++) {
        const struct wd_tree_leaf *leaf = &grown->leaves[i];
        struct wd_vec3 foot = placed(m, wd_leaf_foot(*leaf, grown->leaf_box));
        float square = wd_v3_dot(foot, foot);
        if (square > reach_m * reach_m)
            continue;
        float distance_m = sqrtf(square), chance = wd_spray_chance(i, wd_tree_random(*tree));
        float size_m = widest * wd_leaf_size_m(*leaf, grown->leaf_box);
        if (chance < wd_spray_share(distance_m, grown->spray_reach) && matters(scene, foot, 2 * size_m, reach_m))
            *wd_push(at->leaves, at->count, at->capacity) =
                (struct wd_trace_near_leaf){i, distance_m, chance, grain * size_m < plain_rad * distance_m};
    }
}

/* `reach`: factor on the distance up to which leaves are twigs. */
static bool is_twig(const struct wd_trace_near_leaf *leaf, float reach)
{
    return leaf->chance < wd_spray_share(leaf->distance_m, reach);
}

/* Triangles of a tree's twigs. */
static uint64_t count_of(const struct wd_trace_near_tree *at, const struct wd_tree_model *grown, float reach)
{
    uint64_t indices = 0;
    for (size_t i = 0; i < at->count; i++)
        if (is_twig(&at->leaves[i], reach))
            indices += twig_of(grown, &at->leaves[i])->index_count / grown->spray_forms;
    return indices / 3;
}

static uint64_t count_triangles(const struct wd_trace_near *near, const struct wd_trace_near_scene *scene,
                                float scale)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < near->count; i++) {
        const struct wd_trace_near_tree *at = &near->trees[i];
        const struct wd_tree_model *grown = &wd_trace_model_of(scene->models, &scene->trees[at->tree])->grown;
        sum += count_of(at, grown, scale * grown->spray_reach);
    }
    return sum;
}

/* --- meshes ---------------------------------------------------------------------------------- */

static uint32_t tinted(uint32_t tint, uint32_t leaf)
{
    uint32_t product = leaf & 0xff000000u; /* openness */
    for (int shift = 0; shift < 24; shift += 8)
        product |= ((tint >> shift & 255u) * (leaf >> shift & 255u) + 127u) / 255u << shift;
    return product;
}

static void add_twig(struct wd_tree_mesh *mesh, const struct wd_tree_model *grown, const struct wd_trace_near_leaf *leaf)
{
    const struct wd_tree_leaf *from = &grown->leaves[leaf->index];
    const struct wd_tree_mesh *twig = twig_of(grown, leaf);
    struct wd_vec3 foot = wd_leaf_foot(*from, grown->leaf_box);
    struct wd_vec3 shading = wd_leaf_shading(from->shading);
    struct wd_leaf_axes axes = wd_leaf_axes_of(from->turn);
    float size_m = wd_leaf_size_m(*from, grown->leaf_box);
    uint32_t form = WD_LEAF_FORM(*from) % grown->spray_forms;
    uint32_t vertices = twig->vertex_count / grown->spray_forms, indices = twig->index_count / grown->spray_forms;
    uint32_t first = mesh->vertex_count - form * vertices; /* of the first form's, were it there */
    for (uint32_t i = form * vertices; i < (form + 1) * vertices; i++) {
        struct wd_tree_vertex vertex = twig->vertices[i];
        float n[3];
        wd_unpack_normal(vertex.normal, n);
        struct wd_vec3 own = wd_v3_scale(axes.across, n[0]);
        own = wd_v3_mad(wd_v3_mad(own, axes.along, n[1]), axes.above, n[2]);
        own = wd_v3_mix(shading, wd_v3_dot(own, shading) < 0 ? wd_v3_scale(own, -1) : own, 0.5f);
        struct wd_vec3 place = wd_v3_mad(foot, axes.across, size_m * vertex.position_m[0]);
        place = wd_v3_mad(place, axes.along, size_m * vertex.position_m[1]);
        place = wd_v3_mad(place, axes.above, size_m * vertex.position_m[2]);
        bool blade = (vertex.kind & WD_VERTEX_LEAF) != 0;
        vertex.position_m[0] = place.x;
        vertex.position_m[1] = place.y;
        vertex.position_m[2] = place.z;
        vertex.normal = wd_pack_normal((const float[3]){own.x, own.y, own.z});
        vertex.tint = tinted(vertex.tint, blade ? from->tint : from->tint | 0xffffffu);
        wd_tree_mesh_add_vertex(mesh, &vertex);
    }
    for (uint32_t i = form * indices; i < (form + 1) * indices; i += 3)
        wd_tree_mesh_add_triangle(mesh, first + twig->indices[i], first + twig->indices[i + 1],
                                  first + twig->indices[i + 2]);
}

/* The tree's leaves that are twigs: a bit each, and the mesh of the twigs. */
static void make_twigs(struct wd_trace_near_tree *at, const struct wd_tree_model *grown, float reach)
{
    struct wd_tree_mesh *mesh = &at->twigs->grown.full;
    at->hidden = wd_alloc_array(grown->sets[0][WD_SET_LEAVES].leaf_count / 32 + 1, sizeof *at->hidden);
    for (size_t i = 0; i < at->count; i++) {
        const struct wd_trace_near_leaf *leaf = &at->leaves[i];
        if (!is_twig(leaf, reach))
            continue;
        add_twig(mesh, grown, leaf);
        at->hidden[leaf->index / 32] |= 1u << leaf->index % 32;
    }
}

void wd_trace_near_build(struct wd_trace_near *near, const struct wd_trace_near_scene *scene)
{
    float scale = 1;
    for (size_t i = 0; i < near->count; i++)
        gather(&near->trees[i], scene);
    while (count_triangles(near, scene, scale) > MOST_TRIANGLES)
        scale *= 0.9f;
    for (size_t i = 0; i < near->count; i++) {
        struct wd_trace_near_tree *at = &near->trees[i];
        const struct wd_trace_model *model = wd_trace_model_of(scene->models, &scene->trees[at->tree]);
        float reach = scale * model->grown.spray_reach;
        if (count_of(at, &model->grown, reach) > 0) {
            at->twigs = wd_alloc(sizeof *at->twigs);
            *at->twigs = (struct wd_trace_model){.model = model->model, .look = model->look};
            make_twigs(at, &model->grown, reach);
            wd_trace_model_build(at->twigs, scene->models->device);
        }
        free(at->leaves);
        at->leaves = NULL;
    }
}

void wd_trace_near_finish(struct wd_trace_near *near)
{
    for (size_t i = 0; i < near->count; i++) {
        struct wd_trace_model *twigs = near->trees[i].twigs;
        if (twigs) {
            rtcReleaseScene(twigs->scene);
            wd_tree_mesh_finish(&twigs->grown.full);
        }
        free(twigs);
        free(near->trees[i].hidden);
    }
    free(near->trees);
    *near = (struct wd_trace_near){0};
}

static const struct wd_trace_near_tree *find(const struct wd_trace_near *near, uint32_t tree)
{
    size_t low = 0, high = near->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (near->trees[middle].tree < tree)
            low = middle + 1;
        else
            high = middle;
    }
    return low < near->count && near->trees[low].tree == tree ? &near->trees[low] : NULL;
}

const struct wd_trace_model *wd_trace_near_twigs(const struct wd_trace_near *near, uint32_t tree)
{
    return find(near, tree)->twigs;
}

/* Leaves stand after wood in the full mesh, one after another; flowers after them. */
bool wd_trace_near_hides(const struct wd_trace_near *near, const struct wd_trace_model *model, uint32_t tree,
                         uint32_t triangle)
{
    const struct wd_trace_near_tree *at = find(near, tree);
    const struct wd_leaf_set *set = &model->grown.sets[0][WD_SET_LEAVES];
    uint32_t wood = model->grown.full.wood_index_count / 3, leaf = 0;
    if (!at || !at->hidden || triangle < wood)
        return false;
    leaf = (triangle - wood) / (set->index_count / 3);
    return leaf < set->leaf_count && (at->hidden[leaf / 32] >> leaf % 32 & 1);
}
