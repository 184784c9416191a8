#include "tree/leaves_open.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "shared/hash.h"

/* Leaves that have places all over, and how many each. */
enum { SOME = 512, OVER = 8 };

/* How far a leaf is as open as its own ways say, which are few; the rest: as the crown about it. By path-traced
 * crowns of 1,024 px (0: FLIP 0.331, 0.25: 0.310, 0.5: 0.324). */
static const float OWN_OPENNESS = 0.25f;

static size_t count_of(const struct wd_tree_model *model)
{
    return (size_t)model->leaf_count + model->flower_count;
}

/* --- places ------------------------------------------------------------------------------------------------------- */

/* A leaf's triangles in the full mesh. */
struct part {
    uint32_t first, count; /* indices */
};

static struct part part_of(const struct wd_tree_model *model, size_t leaf)
{
    uint32_t own = model->sets[0][WD_SET_LEAVES].index_count, petals = model->sets[0][WD_SET_FLOWERS].index_count;
    size_t leaves = leaf < model->leaf_count ? leaf : model->leaf_count, flowers = leaf - leaves;
    return (struct part){model->full.wood_index_count + (uint32_t)(leaves * own + flowers * petals),
                         leaf < model->leaf_count ? own : petals};
}

static struct wd_vec3 corner(const struct wd_tree_mesh *mesh, uint32_t index)
{
    return wd_v3_of(mesh->vertices[mesh->indices[index]].position_m);
}

/* Middle of the triangle that is nearest to the leaf's. */
static struct wd_vec3 middle_of(const struct wd_tree_model *model, size_t at)
{
    const struct wd_tree_leaf *leaf = &model->leaves[at];
    const struct part part = part_of(model, at);
    struct wd_vec3 middle = wd_v3_mad(wd_leaf_foot(*leaf, model->leaf_box), wd_leaf_axes_of(leaf->turn).along,
                                      0.5f * wd_leaf_size_m(*leaf, model->leaf_box));
    struct wd_vec3 nearest = middle;
    float least = INFINITY;
    for (uint32_t i = part.first; i < part.first + part.count; i += 3) {
        struct wd_vec3 sum = corner(&model->full, i);
        sum = wd_v3_add(sum, wd_v3_add(corner(&model->full, i + 1), corner(&model->full, i + 2)));
        struct wd_vec3 own = wd_v3_scale(sum, 1.0f / 3), off = wd_v3_sub(own, middle);
        if (wd_v3_dot(off, off) < least)
            least = wd_v3_dot(off, off), nearest = own;
    }
    return nearest;
}

static struct wd_tree_point point_at(struct wd_vec3 p, struct wd_vec3 face)
{
    return (struct wd_tree_point){.position_m = {p.x, p.y, p.z},
                                  .face = wd_pack_normal((const float[3]){face.x, face.y, face.z}),
                                  .kind = WD_POINT_LEAF};
}

static float area_of(const struct wd_tree_mesh *mesh, uint32_t index, struct wd_vec3 *across)
{
    struct wd_vec3 a = corner(mesh, index);
    *across = wd_v3_cross(wd_v3_sub(corner(mesh, index + 1), a), wd_v3_sub(corner(mesh, index + 2), a));
    return wd_v3_length(*across);
}

/* A place at random, anywhere alike on the leaf. */
static struct wd_tree_point place_on(const struct wd_tree_mesh *mesh, struct part part, uint32_t random)
{
    struct wd_vec3 across = WD_V3(0, 0, 1);
    float all = 0, share = wd_hash_unit(random);
    for (uint32_t i = part.first; i < part.first + part.count; i += 3)
        all += area_of(mesh, i, &across);
    uint32_t at = part.first;
    for (float left = share * all; at + 3 < part.first + part.count; at += 3) {
        left -= area_of(mesh, at, &across);
        if (left < 0)
            break;
    }
    area_of(mesh, at, &across);
    float u = sqrtf(wd_hash_unit(wd_hash1(random))), v = u * wd_hash_unit(wd_hash2(random, 1));
    struct wd_vec3 p = wd_v3_scale(corner(mesh, at), 1 - u);
    p = wd_v3_mad(wd_v3_mad(p, corner(mesh, at + 1), u - v), corner(mesh, at + 2), v);
    return point_at(p, across);
}

/* Which leaf the i-th of SOME is. */
static size_t one_of(size_t i, size_t count)
{
    return i * count / SOME;
}

void wd_leaves_open_add(struct wd_tree_points *points, const struct wd_tree_model *model)
{
    size_t count = count_of(model), some = count ? (size_t)SOME * OVER : 0;
    points->points = wd_realloc(points->points, (points->count + count + some + 1) * sizeof *points->points);
    struct wd_tree_point *to = points->points + points->count;
    for (size_t i = 0; i < count; i++)
        *to++ = point_at(middle_of(model, i), wd_leaf_axes_of(model->leaves[i].turn).above);
    for (size_t i = 0; i < some; i++)
        *to++ = place_on(&model->full, part_of(model, one_of(i / OVER, count)), wd_hash2((uint32_t)i, 0x09e4));
    points->count += count + some;
}

/* --- openness ----------------------------------------------------------------------------------------------------- */

/* Share of an even sky's light on both sides of a flat leaf that its tree lets through. */
static float sky_share(const struct wd_sky_way *sky, uint32_t open, struct wd_vec3 face)
{
    float all = 0, comes = 0;
    for (uint32_t way = 0; way < WD_SUN_WAYS; way++) {
        float brings = sky[way].brings * fabsf(wd_v3_dot(face, sky[way].toward));
        all += brings;
        comes += brings * wd_sun_way_lit(open, way);
    }
    return all > 0 ? comes / all : 0;
}

static float own_share(const struct wd_sky_way *sky, const struct wd_tree_leaf *leaf)
{
    return sky_share(sky, leaf->open, wd_leaf_axes_of(leaf->turn).above);
}

static float crown_share(const struct wd_tree_leaf *leaf)
{
    return (float)(leaf->tint >> 24) / 255;
}

/* A leaf's area that is seen from all over the sky. */
static float seen_of(const struct wd_tree_points *over, const struct wd_sky_way *sky)
{
    float seen = 0;
    for (size_t i = 0; i < OVER; i++) {
        float face[3];
        wd_unpack_normal(over->points[i].face, face);
        for (uint32_t way = 0; way < WD_SUN_WAYS; way++)
            seen += fabsf(wd_v3_dot(wd_v3_of(face), sky[way].toward)) * wd_sun_way_lit(over->lit[i], way);
    }
    return seen;
}

/* By which own shares, none of them more than 1 then, are to be multiplied so that what is seen of the leaves is as
 * open as before. */
static float share_factor(const struct wd_tree_model *model, const struct wd_tree_points *over,
                          const struct wd_sky_way *sky)
{
    float seen[SOME], share[SOME], known = 0, low = 0, high = 16;
    for (size_t i = 0; i < SOME; i++) {
        const struct wd_tree_leaf *leaf = &model->leaves[one_of(i, count_of(model))];
        const struct wd_tree_points places = {over->points + i * OVER, over->lit + i * OVER, OVER, 0, 0};
        seen[i] = seen_of(&places, sky);
        share[i] = own_share(sky, leaf);
        known += seen[i] * crown_share(leaf);
    }
    for (int step = 0; step < 14; step++) {
        float factor = 0.5f * (low + high), sum = 0;
        for (size_t i = 0; i < SOME; i++)
            sum += seen[i] * fminf(factor * share[i], 1);
        *(sum < known ? &low : &high) = factor;
    }
    return low;
}

void wd_leaves_open_set(struct wd_tree_model *model, const struct wd_tree_points *points, size_t first,
                        const struct wd_sky_way sky[WD_SUN_WAYS])
{
    const size_t count = count_of(model);
    const struct wd_tree_points over = {points->points + first + count, points->lit + first + count,
                                        (size_t)SOME * OVER, 0, 0};
    if (!count)
        return;
    for (size_t i = 0; i < count; i++)
        model->leaves[i].open = points->lit[first + i];
    float factor = share_factor(model, &over, sky);
    for (size_t i = 0; i < count; i++) {
        struct wd_tree_leaf *leaf = &model->leaves[i];
        float open = wd_mixf(crown_share(leaf), fminf(factor * own_share(sky, leaf), 1), OWN_OPENNESS);
        leaf->tint = (leaf->tint & 0xffffffu) | (uint32_t)(open * 255 + 0.5f) << 24;
    }
}
