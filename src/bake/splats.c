#include "bake/splats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/dmath.h"
#include "base/memory.h"
#include "shared/hash.h"
#include "tree/progressive.h"
#include "tree/radix.h"

/* Most of a tree's bark lies behind leaves. Few discs spent on all of it alike leave a stem to one or
 * two that are far too large. Of wood that is hidden from all sides so much is kept: crowns have gaps. */
static const float LEAST_SEEN = 0.02f;

/* Points to choose from: some kind may be rare. */
enum { POINTS = 3 * (int)WD_SPLATS / 2 };

static uint32_t unorm16(float value, float min, float extent)
{
    float share = (value - min) / extent;
    return (uint32_t)(fminf(fmaxf(share, 0.0f), 1.0f) * 65535.0f + 0.5f);
}

static struct wd_splat splat_at(const struct wd_splat_model *model, const float position_m[3],
                                uint32_t normal)
{
    uint32_t axes[3];
    for (int k = 0; k < 3; k++)
        axes[k] = unorm16(position_m[k], model->min_m[k], model->extent_m[k]);
    return (struct wd_splat){axes[0] | axes[1] << 16, axes[2] | wd_normal8(normal) << 16};
}

/* A leaf's splat, or a twig's: four bits each of two coordinates of the way along it in the box, which has no
 * sign: half an octahedron, folded out to a square, in bits that are less than a place needs. */
static struct wd_splat leaf_at(const struct wd_splat_model *model, const struct wd_tree_point *point)
{
    struct wd_splat splat = splat_at(model, point->position_m, point->face);
    struct wd_vec3 along = wd_point_along(point);
    float x = along.x / model->extent_m[0], y = along.y / model->extent_m[1];
    float z = along.z / model->extent_m[2], over = 1 / (fabsf(x) + fabsf(y) + fabsf(z));
    over = z < 0 ? -over : over;
    uint32_t a = (uint32_t)fminf(((x + y) * over + 1) * 8, 15);
    uint32_t b = (uint32_t)fminf(((x - y) * over + 1) * 8, 15);
    splat.z_normal = (splat.z_normal & ~15u) | a;
    splat.xy = (splat.xy & ~0x00030003u) | (b & 3u) | (b & 12u) << 14;
    return splat;
}

/* The whole number at or below `value` >= 0, or the next, at random. */
static uint32_t dithered(float value, float next, uint32_t random)
{
    return (uint32_t)value + (wd_hash_unit(random) < next);
}

/* Of a colour's part: levels are a factor apart, and a colour half way between two logarithms is less
 * than half way between two colours. */
static uint32_t albedo_level(float albedo, uint32_t random)
{
    const float half_step = 0.34657359f * WD_SPLAT_ALBEDO_STEP; /* half of its natural logarithm */
    float doublings = (float)(wd_dlog(fmaxf(albedo, 1e-6f)) / 0.69314718055994531);
    float level = (doublings - WD_SPLAT_ALBEDO_LEAST) / WD_SPLAT_ALBEDO_STEP;
    level = fminf(fmaxf(level, 0), WD_SPLAT_ALBEDO_MOST);
    float above = level - floorf(level);
    return dithered(level, above * (1 - half_step * (1 - above)), random);
}

/* `gain`: on the albedo. */
static uint32_t point_look(const struct wd_tree_point *point, float gain)
{
    uint32_t look = point->kind & WD_POINT_LEAF ? 0 : 1u << WD_SPLAT_WOOD_BIT;
    uint32_t random = wd_hash3(point->albedo, point->normal, point->face);
    for (uint32_t k = 0; k < 3; k++) {
        random = wd_hash1(random);
        look |= albedo_level(gain * wd_srgb_decode((uint8_t)(point->albedo >> (8 * k))), random) << (5 * k);
    }
    float openness = (float)(point->albedo >> 24) * (WD_SPLAT_OPENNESS_MOST / 255.0f);
    look |= dithered(openness, openness - floorf(openness), wd_hash1(random)) << WD_SPLAT_OPENNESS_BIT;
    for (uint32_t k = 0; k < 2; k++) {
        float part = (float)(int16_t)(point->normal >> (16 * k)) * (WD_SPLAT_NORMAL_MOST / 32767.0f);
        look |= ((uint32_t)(int32_t)lrintf(part) & 63u) << (WD_SPLAT_NORMAL_BIT + 6 * k);
    }
    return look;
}

/* --- discs ------------------------------------------------------------------------------- */

static struct wd_tree_points room_for(size_t count)
{
    return (struct wd_tree_points){.points = wd_alloc_array(count, sizeof(struct wd_tree_point)),
                                   .lit = wd_alloc_array(count, sizeof(uint32_t)),
                                   .count = count};
}

/* Points of one kind, those that are kept of them (NULL: all). */
struct chosen {
    const struct wd_tree_points *points;
    uint32_t leaf;
    const bool *keep;
};

static bool is_chosen(const struct chosen *chosen, size_t i)
{
    return (chosen->points->points[i].kind & WD_POINT_LEAF) == chosen->leaf && (!chosen->keep || chosen->keep[i]);
}

/* Heights that part them into `strata` of equal count; tops[0] is the highest. */
static void find_tops(const struct chosen *chosen, uint32_t strata, float *tops)
{
    const struct wd_tree_points *points = chosen->points;
    uint32_t *which = wd_alloc_array(points->count, sizeof *which);
    uint32_t *keys = wd_alloc_array(points->count, sizeof *keys);
    uint32_t *order = wd_alloc_array(points->count, sizeof *order);
    size_t count = 0;
    for (uint32_t i = 0; i < points->count; i++)
        if (is_chosen(chosen, i)) {
            keys[count] = ~wd_radix_key(points->points[i].position_m[2]);
            which[count++] = i;
        }
    wd_radix_order(order, keys, count);
    for (uint32_t s = 0; s < strata; s++)
        tops[s] = count ? points->points[which[order[s * count / strata]]].position_m[2] : 0.0f;
    free(which);
    free(keys);
    free(order);
}

/* Fills one stratum with the chosen points between the heights, in their order and round
 * again, and `drawn` with the points themselves, `step` apart. What is lit of them is for light_discs: their
 * number among `points` stands for it. False where there are none. */
static bool fill_stratum(struct wd_splats *splats, const struct chosen *chosen, uint32_t stratum, float top,
                         float bottom, struct wd_tree_points *drawn, uint32_t step)
{
    const struct wd_tree_points *points = chosen->points;
    struct wd_splat *to = splats->splats + stratum * WD_STRATUM_SPLATS;
    uint32_t *looks = splats->looks + stratum * WD_STRATUM_SPLATS;
    uint32_t *lit = splats->lit + stratum * WD_STRATUM_SPLATS, used = 0;
    for (size_t i = 0; i < points->count && used < WD_STRATUM_SPLATS; i++) {
        const struct wd_tree_point *point = &points->points[i];
        if (!is_chosen(chosen, i) || point->position_m[2] > top || point->position_m[2] <= bottom)
            continue;
        drawn->points[used * step + stratum] = *point;
        drawn->lit[used * step + stratum] = lit[used] = (uint32_t)i;
        to[used] = leaf_at(&splats->model, point);
        looks[used++] = point_look(point, 1);
    }
    for (uint32_t i = used; used && i < WD_STRATUM_SPLATS; i++) {
        drawn->points[i * step + stratum] = drawn->points[(i - used) * step + stratum];
        drawn->lit[i * step + stratum] = lit[i] = lit[i - used];
        to[i] = to[i - used];
        looks[i] = looks[i - used];
    }
    return used > 0;
}

/* `leaves` get the points of the splats: strata in turn, as a tree's window takes them. Of a tree without leaves these
 * are its twigs: what is `thin` of the wood. */
static void fill_leaves(struct wd_splats *splats, const struct wd_tree_points *points, const bool *thin,
                        struct wd_tree_points *leaves)
{
    struct wd_splat_model *model = &splats->model;
    const uint32_t strata = WD_LEAF_STRATA;
    bool bare = points->leaf_area_m2 <= 0.0f;
    const struct chosen chosen = {points, bare ? 0 : WD_POINT_LEAF, bare ? thin : NULL};
    find_tops(&chosen, strata, model->strata_top_m);
    for (uint32_t s = 0; s < strata; s++) {
        float top = s ? model->strata_top_m[s] : INFINITY;
        float bottom = s + 1 < strata ? model->strata_top_m[s + 1] : -INFINITY;
        if (!fill_stratum(splats, &chosen, s, top, bottom, leaves, strata))
            fill_stratum(splats, &chosen, s, INFINITY, -INFINITY, leaves, strata);
    }
    /* of the wood, the part under the crown's thick is what is seen */
    float tops[4];
    const struct chosen wood = {points, points->wood_area_m2 > 0.0f ? 0 : WD_POINT_LEAF, NULL};
    find_tops(&wood, 4, tops);
    model->strata_top_m[strata] = tops[1];
}

/* --- wood -------------------------------------------------------------------------------- */

struct sized {
    float area; /* that is seen */
    uint32_t triangle;
};

static int larger_first(const void *a, const void *b)
{
    const struct sized *one = a, *other = b;
    if (one->area != other->area)
        return one->area < other->area ? 1 : -1;
    return one->triangle < other->triangle ? -1 : 1;
}

/* The middle, one side's normal and its area in m^2. */
static float triangle_middle(struct wd_tree_point *point, const struct wd_tree_mesh *mesh,
                             const uint32_t *corners)
{
    float side[2][3];
    for (int k = 0; k < 3; k++) {
        float origin = mesh->vertices[corners[0]].position_m[k];
        side[0][k] = mesh->vertices[corners[1]].position_m[k] - origin;
        side[1][k] = mesh->vertices[corners[2]].position_m[k] - origin;
    }
    float x = side[0][1] * side[1][2] - side[0][2] * side[1][1];
    float y = side[0][2] * side[1][0] - side[0][0] * side[1][2];
    float z = side[0][0] * side[1][1] - side[0][1] * side[1][0];
    float twice = sqrtf(x * x + y * y + z * z), scale = 1 / fmaxf(twice, 1e-12f);
    *point = (struct wd_tree_point){
        .normal = wd_pack_normal((float[3]){x * scale, y * scale, z * scale})};
    for (int k = 0; k < 3; k++)
        point->position_m[k] = mesh->vertices[corners[0]].position_m[k] +
                               (side[0][k] + side[1][k]) / 3.0f;
    return 0.5f * twice;
}

/* The triangles of wood, `order` of them, as struct wd_splat_model counts them. */
struct wood {
    struct wd_tree_mesh mesh;
    struct sized *order;
    uint32_t count, stem, far_stem;
};

static void append_mesh(struct wd_tree_mesh *to, const struct wd_tree_mesh *from, uint32_t first, uint32_t end,
                        uint32_t first_vertex)
{
    for (uint32_t i = first; i < end; i++)
        to->indices[to->index_count++] = first_vertex + from->indices[i];
}

/* Of the reduced mesh, and of the far stem. */
static void gather_wood(struct wood *wood, const struct wd_tree_model *model)
{
    const struct wd_tree_mesh *reduced = &model->reduced, *far_stem = &model->far_stem;
    struct wd_tree_mesh *mesh = &wood->mesh;
    uint32_t stem = far_stem->index_count ? reduced->stem_index_count : 0;
    *wood = (struct wood){.stem = stem / 3, .far_stem = far_stem->index_count / 3};
    wd_tree_mesh_reserve(mesh, reduced->vertex_count + far_stem->vertex_count + 1,
                         reduced->wood_index_count + far_stem->index_count + 3);
    for (uint32_t i = 0; i < reduced->vertex_count; i++)
        wd_tree_mesh_add_vertex(mesh, &reduced->vertices[i]);
    for (uint32_t i = 0; i < far_stem->vertex_count; i++)
        wd_tree_mesh_add_vertex(mesh, &far_stem->vertices[i]);
    append_mesh(mesh, reduced, 0, stem, 0);
    append_mesh(mesh, far_stem, 0, far_stem->index_count, reduced->vertex_count);
    append_mesh(mesh, reduced, stem, reduced->wood_index_count, 0);
    wood->count = mesh->index_count / 3;
}

/* Of each of the three parts those of which most is seen of the full mesh's tree come first. */
static void order_wood(struct wood *wood, const struct wd_tree_sides *sides)
{
    uint32_t count = wood->count;
    struct wd_tree_points middles = {.points = wd_alloc_array(count + 1, sizeof *middles.points),
                                     .count = count};
    float *shares = wd_alloc_array(count + 1, sizeof *shares);
    struct sized *order = wood->order = wd_alloc_array(count + 1, sizeof *order);
    for (uint32_t i = 0; i < count; i++)
        order[i] = (struct sized){triangle_middle(&middles.points[i], &wood->mesh, wood->mesh.indices + 3 * i), i};
    wd_tree_points_seen(shares, &middles, sides);
    for (uint32_t i = 0; i < count; i++)
        order[i].area *= fmaxf(shares[i], LEAST_SEEN);
    const uint32_t ends[] = {wood->stem, wood->stem + wood->far_stem, count};
    for (uint32_t k = 0, from = 0; k < 3; from = ends[k++])
        qsort(order + from, ends[k] - from, sizeof *order, larger_first);
    wd_tree_points_finish(&middles);
    free(shares);
}

static void wood_finish(struct wood *wood)
{
    wd_tree_mesh_finish(&wood->mesh);
    free(wood->order);
}

/* Square roots of a vertex's factors, in bytes; openness as it is. */
static uint32_t root_tint(uint32_t tint)
{
    uint32_t root = tint & 0xff000000u;
    for (int k = 0; k < 24; k += 8)
        root |= (uint32_t)wd_unorm_encode(sqrtf((float)(tint >> k & 255u) / 255.0f)) << k;
    return root;
}

static struct wd_splat_corner wood_corner(const struct wd_splat_model *model,
                                          const struct wd_tree_vertex *vertex)
{
    return (struct wd_splat_corner){splat_at(model, vertex->position_m, vertex->normal), vertex->uv,
                                    root_tint(vertex->tint)};
}

/* Corners of the triangles in their order, each once. */
static void fill_wood_triangles(struct wd_splats *splats, const struct wood *wood)
{
    struct wd_splat_model *model = &splats->model;
    const struct wd_tree_mesh *mesh = &wood->mesh;
    const struct sized *order = wood->order;
    uint32_t *number = wd_alloc_array(mesh->vertex_count + 1, sizeof *number); /* 0: not yet */
    for (uint32_t i = 0; i < model->wood_count; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = mesh->indices[3 * order[i].triangle + (uint32_t)k];
            if (!number[vertex]) {
                splats->corners[model->wood_corners] = wood_corner(model, &mesh->vertices[vertex]);
                number[vertex] = ++model->wood_corners;
            }
        }
    for (uint32_t i = 0; i < model->wood_count; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = mesh->indices[3 * order[i].triangle + (uint32_t)k];
            uint64_t before = model->wood_corners + 1 - number[vertex];
            splats->wood[i] |= before << (k * (int)WD_WOOD_BITS);
        }
    free(number);
}

/* What so many times the first triangles leave says how fast that falls; of trees without leaves more are drawn. */
enum { TELLS_FALL = 6, TELLS_BARE_FALL = 60 };

static void make_wood(struct wd_splats *splats, const struct wood *wood)
{
    const uint32_t most = (1u << WD_WOOD_BITS) / 3 - 1; /* that can be named; what shows least goes */
    const struct sized *order = wood->order + wood->stem;
    uint32_t count = wood->count - wood->stem, first = wd_first_wood(count);
    uint32_t times = splats->model.leaf_area_m2 > 0 ? TELLS_FALL : TELLS_BARE_FALL;
    splats->model.wood_count = wood->count < most ? wood->count : most;
    splats->model.wood_stem = wood->stem;
    splats->model.wood_far_stem = wood->far_stem;
    splats->wood = wd_alloc_array(splats->model.wood_count, sizeof *splats->wood);
    splats->corners = wd_alloc_array(3 * (size_t)splats->model.wood_count, sizeof *splats->corners);
    fill_wood_triangles(splats, wood);
    float all = 0, large = 0, more = 0;
    for (uint32_t i = 0; i < count; i++) {
        all += order[i].area;
        large += i < first ? order[i].area : 0;
        more += i < times * first ? order[i].area : 0;
    }
    float thin = all > 0 ? 1 - large / all : 1, thinner = all > 0 ? 1 - more / all : 1;
    bool falls = thin > 0 && thin < 1 && thinner > 0 && thinner < thin;
    splats->model.wood_falls = falls ? fminf(logf(logf(thinner) / logf(thin)) / logf((float)times), 1.5f) : 1;
    splats->model.thin_share = thin;
}

/* Mean colour of a look's texels that show. */
static void mean_albedo(const struct wd_point_look *look, uint32_t layer, float color[3])
{
    size_t count = (size_t)look->size * look->size;
    double sum[3] = {0}, shown = 1e-9;
    const uint8_t *texels = look->rgba + 4 * count * layer;
    const float *linear = wd_srgb_table();
    for (size_t i = 0; i < count; i++) {
        shown += texels[4 * i + 3];
        for (size_t k = 0; k < 3; k++)
            sum[k] += (double)linear[texels[4 * i + k]] * texels[4 * i + 3];
    }
    for (int k = 0; k < 3; k++)
        color[k] = (float)(sum[k] / shown);
}

static void compare_sides(struct wd_splat_model *model, const struct wd_point_look *look)
{
    float upper[3], lower[3];
    mean_albedo(look, WD_LOOK_LEAF, upper);
    mean_albedo(look, WD_LOOK_LEAF_BACK, lower);
    for (int k = 0; k < 3; k++)
        model->lower_over_upper[k] = upper[k] > 0 ? fminf(lower[k] / upper[k], 4.0f) : 1.0f;
}

/* --- discs of wood ----------------------------------------------------------------------- */

/* Wood by lot, as much as is seen; all points of a tree without. */
static void keep_seen(bool *keep, const struct wd_tree_points *points,
                      const struct wd_tree_sides *sides)
{
    float *shares = wd_alloc_array(points->count, sizeof *shares);
    wd_tree_points_seen(shares, points, sides);
    for (size_t i = 0; i < points->count; i++)
        keep[i] = points->wood_area_m2 <= 0.0f ||
                  (!(points->points[i].kind & WD_POINT_LEAF) &&
                   wd_hash_unit(wd_hash2((uint32_t)i, 0x5ee9)) < fmaxf(shares[i], LEAST_SEEN));
    free(shares);
}

/* Half of the stratum, in an order of which any window is well spread. False where none is kept. */
static bool fill_wood(struct wd_splats *splats, uint32_t half, const struct wd_tree_points *points,
                      const bool *keep, struct wd_tree_points *drawn)
{
    uint32_t first = WD_LEAF_STRATA * WD_STRATUM_SPLATS + half * WD_WOOD_SPLATS;
    uint32_t *which = wd_alloc_array(points->count + 1, sizeof *which);
    uint32_t *order = wd_alloc_array(points->count + 1, sizeof *order);
    struct wd_vec3 *places = wd_alloc_array(points->count + 1, sizeof *places);
    size_t count = 0;
    for (uint32_t i = 0; i < points->count; i++)
        if (keep[i]) {
            places[count] = wd_v3_of(points->points[i].position_m);
            which[count++] = i;
        }
    wd_progressive_order(order, places, count, 0x3a7d);
    for (uint32_t i = 0; i < WD_WOOD_SPLATS && count; i++) {
        uint32_t chosen = which[order[i % count]];
        const struct wd_tree_point *point = &points->points[chosen];
        drawn->points[i] = *point;
        drawn->lit[i] = splats->lit[first + i] = chosen;
        splats->splats[first + i] = points->leaf_area_m2 > 0.0f
                                        ? splat_at(&splats->model, point->position_m, point->face)
                                        : leaf_at(&splats->model, point);
        splats->looks[first + i] = point_look(point, 1);
    }
    free(which);
    free(order);
    free(places);
    return count > 0;
}

/* Whether a place lies on a triangle, as nearly as the reduced mesh follows the full one. */
static bool lies_on(struct wd_vec3 p, const struct wd_vec3 corners[3])
{
    struct wd_vec3 u = wd_v3_sub(corners[1], corners[0]), v = wd_v3_sub(corners[2], corners[0]);
    struct wd_vec3 w = wd_v3_sub(p, corners[0]), n = wd_v3_cross(u, v);
    float squared = wd_v3_dot(n, n), off = wd_v3_dot(w, n);
    if (!(squared > 0) || off * off > 0.02f * squared * sqrtf(squared))
        return false;
    float b = wd_v3_dot(wd_v3_cross(w, v), n) / squared;
    float c = wd_v3_dot(wd_v3_cross(u, w), n) / squared;
    return b > -0.15f && c > -0.15f && b + c < 1.15f;
}

/* Leaves out what the triangles show that are drawn first. */
static void keep_thin(bool *keep, const struct wd_tree_points *points,
                      const struct wd_tree_mesh *mesh, const struct sized *first, uint32_t count)
{
    struct wd_vec3(*corners)[3] = wd_alloc_array(count + 1, sizeof *corners);
    for (uint32_t i = 0; i < 3 * count; i++) {
        uint32_t vertex = mesh->indices[3 * first[i / 3].triangle + i % 3];
        corners[i / 3][i % 3] = wd_v3_of(mesh->vertices[vertex].position_m);
    }
    for (size_t i = 0; i < points->count; i++)
        for (uint32_t t = 0; t < count && keep[i]; t++)
            keep[i] = !lies_on(wd_v3_of(points->points[i].position_m), corners[t]);
    free(corners);
}

/* `all` gets the points of all of it, the stratum's first half, `thin` those of the other, which are kept. */
static void fill_wood_halves(struct wd_splats *splats, const struct wd_tree_points *points,
                             const struct wood *wood, const struct wd_tree_sides *sides, bool *keep,
                             struct wd_tree_points *all, struct wd_tree_points *thin)
{
    uint32_t first = wd_first_wood(wood->count - wood->stem);
    keep_seen(keep, points, sides);
    fill_wood(splats, 0, points, keep, all);
    keep_thin(keep, points, &wood->mesh, wood->order + wood->stem, first);
    if (!fill_wood(splats, 1, points, keep, thin)) {
        keep_seen(keep, points, sides);
        fill_wood(splats, 1, points, keep, thin);
    }
}

static void tell_lit(uint32_t *which, size_t count, const uint32_t *lit)
{
    for (size_t i = 0; i < count; i++)
        which[i] = lit[which[i]];
}

/* Of points that are discs; most of the others are none. */
static void light_discs(struct wd_splats *splats, const struct wd_tree_points *points,
                        const struct wd_tree_mesh *mesh, struct wd_tree_points discs[3])
{
    struct wd_tree_points some = {.points = wd_alloc_array(points->count, sizeof *some.points)};
    uint32_t *lit = wd_alloc_array(points->count, sizeof *lit);
    bool *is_disc = wd_alloc_array(points->count, sizeof *is_disc);
    for (size_t i = 0; i < WD_SPLATS; i++)
        is_disc[splats->lit[i]] = true;
    for (size_t i = 0; i < points->count; i++)
        if (is_disc[i])
            some.points[some.count++] = points->points[i];
    wd_tree_points_light(&some, mesh);
    for (size_t i = 0, at = 0; i < points->count; i++)
        lit[i] = is_disc[i] ? some.lit[at++] : 0;
    tell_lit(splats->lit, WD_SPLATS, lit);
    for (int class = 0; class < 3; class++)
        tell_lit(discs[class].lit, discs[class].count, lit);
    wd_tree_points_finish(&some);
    free(is_disc);
    free(lit);
}

static void make_discs(struct wd_splats *splats, const struct wd_tree_points *points,
                       const struct wd_tree_model *model)
{
    size_t leaf_count = (size_t)WD_LEAF_STRATA * WD_STRATUM_SPLATS;
    struct wd_tree_points discs[3] = {room_for(WD_WOOD_SPLATS), room_for(leaf_count), room_for(WD_WOOD_SPLATS)};
    struct wd_tree_sides sides;
    struct wood wood;
    wd_tree_sides_init(&sides, &model->full);
    gather_wood(&wood, model);
    order_wood(&wood, &sides);
    make_wood(splats, &wood);
    bool *keep = wd_alloc_array(points->count, sizeof *keep);
    fill_wood_halves(splats, points, &wood, &sides, keep, &discs[0], &discs[2]);
    fill_leaves(splats, points, keep, &discs[1]);
    free(keep);
    light_discs(splats, points, &model->full, discs);
    struct wd_disc_fit fits;
    const float stratum = 1.0f / WD_SPLAT_STRATA;
    const struct wd_disc_class woody = {&discs[0], points->wood_area_m2, stratum};
    const struct wd_disc_class leafy = {&discs[1], points->leaf_area_m2, 1 - stratum};
    const struct wd_disc_class thin = {&discs[2], points->wood_area_m2, stratum};
    wd_disc_fit(&fits, &woody, &leafy, &thin, splats->model.thin_share, &model->full, &model->reduced);
    splats->model.wood = fits.wood;
    splats->model.leaf = fits.leaf;
    splats->model.light = fits.light;
    splats->model.wood_light = fits.wood_light;
    /* trees near enough for triangles are seen level or from half above */
    splats->model.leaf_past_bark = 0.5f * (fits.past_bark[0] + fits.past_bark[1]);
    splats->model.thin_wood = 0.5f * (fits.thin[0] + fits.thin[1]);
    splats->model.bare_thin = 0.5f * (fits.bare_thin[0] + fits.bare_thin[1]);
    for (size_t i = 0; i < WD_WOOD_SPLATS && points->wood_area_m2 > 0; i++)
        splats->looks[WD_LEAF_STRATA * WD_STRATUM_SPLATS + i] =
            point_look(&discs[0].points[i], 0.5f * (fits.bark[0] + fits.bark[1]));
    memcpy(splats->model.lower, fits.lower, sizeof fits.lower);
    for (int class = 0; class < 3; class++)
        wd_tree_points_finish(&discs[class]);
    wd_tree_sides_finish(&sides);
    wood_finish(&wood);
}

/* --- the whole --------------------------------------------------------------------------- */

bool wd_splats_init(struct wd_splats *splats, const struct wd_tree_model *model,
                    const struct wd_point_look *look, const struct wd_log *log)
{
    struct wd_tree_points points;
    *splats = (struct wd_splats){0};
    if (!wd_tree_points_build(&points, &model->full, look, POINTS))
        return wd_error(log, "a tree of %.1f m has no surface to draw", (double)model->height_m);
    splats->splats = wd_alloc_array(WD_SPLATS, sizeof *splats->splats);
    splats->looks = wd_alloc_array(WD_SPLATS, sizeof *splats->looks);
    splats->lit = wd_alloc_array(WD_SPLATS, sizeof *splats->lit);
    splats->model.leaf_area_m2 = points.leaf_area_m2;
    splats->model.wood_area_m2 = points.wood_area_m2;
    for (int k = 0; k < 3; k++) {
        splats->model.min_m[k] = model->full.min_m[k];
        splats->model.extent_m[k] = fmaxf(model->full.max_m[k] - model->full.min_m[k], 1e-3f);
    }
    make_discs(splats, &points, model);
    compare_sides(&splats->model, look);
    wd_tree_points_finish(&points);
    return true;
}

void wd_splats_finish(struct wd_splats *splats)
{
    free(splats->splats);
    free(splats->looks);
    free(splats->lit);
    free(splats->corners);
    free(splats->wood);
    *splats = (struct wd_splats){0};
}

/* --- cache ------------------------------------------------------------------------------- */

static size_t kept_bytes(const struct wd_splat_model *model)
{
    return sizeof *model + WD_SPLATS_BYTES + model->wood_corners * sizeof(struct wd_splat_corner) +
           model->wood_count * sizeof(uint64_t);
}

/* Brings all but the model from a block, or to it. */
static void copy_parts(struct wd_splats *splats, uint8_t *block, bool from_block)
{
    const struct {
        void *part;
        size_t bytes;
    } parts[] = {
        {splats->splats, WD_SPLATS * sizeof *splats->splats},
        {splats->looks, WD_SPLATS * sizeof *splats->looks},
        {splats->lit, WD_SPLATS * sizeof *splats->lit},
        {splats->corners, splats->model.wood_corners * sizeof *splats->corners},
        {splats->wood, splats->model.wood_count * sizeof *splats->wood},
    };
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        memcpy(from_block ? parts[i].part : block, from_block ? block : parts[i].part,
               parts[i].bytes);
        block += parts[i].bytes;
    }
}

static void allocate(struct wd_splats *splats)
{
    splats->splats = wd_alloc_array(WD_SPLATS, sizeof *splats->splats);
    splats->looks = wd_alloc_array(WD_SPLATS, sizeof *splats->looks);
    splats->lit = wd_alloc_array(WD_SPLATS, sizeof *splats->lit);
    splats->corners = wd_alloc_array(splats->model.wood_corners, sizeof *splats->corners);
    splats->wood = wd_alloc_array(splats->model.wood_count, sizeof *splats->wood);
}

bool wd_splats_load(struct wd_splats *splats, struct wd_bake_cache *cache, uint64_t model_key)
{
    const struct wd_splat_model largest = {.wood_count = 1u << WD_WOOD_BITS,
                                           .wood_corners = 1u << WD_WOOD_BITS};
    size_t size;
    uint8_t *block = wd_cache_load(cache, "splats", model_key, kept_bytes(&largest), &size);
    *splats = (struct wd_splats){0};
    bool found = block && size >= sizeof splats->model;
    if (found)
        memcpy(&splats->model, block, sizeof splats->model);
    const struct wd_splat_model *kept = &splats->model;
    found = found && size == kept_bytes(kept) && kept->wood_stem <= kept->wood_count &&
            kept->wood_far_stem <= kept->wood_count - kept->wood_stem && !kept->wood_stem == !kept->wood_far_stem;
    if (found) {
        allocate(splats);
        copy_parts(splats, block + sizeof splats->model, true);
    }
    free(block);
    return found;
}

void wd_splats_store(const struct wd_splats *splats, struct wd_bake_cache *cache,
                     uint64_t model_key)
{
    size_t bytes = kept_bytes(&splats->model);
    uint8_t *block = wd_alloc(bytes);
    struct wd_splats parts = *splats;
    memcpy(block, &splats->model, sizeof splats->model);
    copy_parts(&parts, block + sizeof splats->model, false);
    wd_cache_store(cache, "splats", model_key, block, bytes);
    free(block);
}
