/* Which ways over the sky a tree itself leaves open at points of its surface: an irregular z-buffer (Johnson et al.,
 * ACM Transactions on Graphics 24 (2005) 1462-1482). For each way the points lie in a picture where they are, and each
 * triangle hides those inside it that it stands before. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/sun_ways.h"
#include "tree/four.h"
#include "tree/points.h"
#include "tree/progressive.h"

/* Points are asked eight at a time. */
enum { EIGHT = 8 };
typedef float eight __attribute__((vector_size(4 * EIGHT)));
typedef int32_t eight_ints __attribute__((vector_size(4 * EIGHT)));

enum { SIDE = 384 }; /* cells of the picture */

/* A point's own triangle is no nearer than so. */
static const float CLEAR_M = 5e-4f;

/* Points and triangles along a curve through space: what is asked one after another lies together in memory. */
struct whole {
    struct wd_vec3 *points, *faces; /* (0, 0, 0) of those with two sides */
    uint32_t *point_order;
    size_t point_count;
    wd_four (*triangles)[3]; /* three numbers a corner and one that is none of its */
    size_t triangle_count;
    struct wd_vec3 middle;
    float half_m; /* from there to the farthest corner of its box */
};

/* Points in the picture, row by row and cell by cell: cell i's are [first[i], first[i + 1]). Some follow the last that
 * nothing hides. */
struct picture {
    struct wd_vec3 axis[3]; /* right and up in cells, toward the sky in metres */
    float low[3], clear_m;
    float *x, *y, *toward; /* x and y in cells */
    uint32_t *point, *first, *cells;
};

static void fill_triangles(struct whole *whole, const struct wd_tree_mesh *mesh)
{
    const size_t count = mesh->index_count / 3;
    struct wd_vec3 *places = wd_alloc_array(count + 1, sizeof *places);
    uint32_t *order = wd_alloc_array(count + 1, sizeof *order);
    for (size_t i = 0; i < count; i++)
        places[i] = wd_v3_of(mesh->vertices[mesh->indices[3 * i]].position_m);
    wd_curve_order(order, places, count);
    whole->triangles = wd_alloc_array(count + 4, sizeof *whole->triangles); /* the last are none */
    whole->triangle_count = count;
    for (size_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const float *p = mesh->vertices[mesh->indices[3 * order[i] + k]].position_m;
            whole->triangles[i][k] = (wd_four){p[0], p[1], p[2], 0};
        }
    free(places);
    free(order);
}

static void fill_points(struct whole *whole, const struct wd_tree_points *points)
{
    const size_t count = points->count;
    struct wd_vec3 *places = wd_alloc_array(count + 1, sizeof *places);
    whole->point_order = wd_alloc_array(count + 1, sizeof *whole->point_order);
    whole->points = wd_alloc_array(count + 1, sizeof *whole->points);
    whole->faces = wd_alloc_array(count + 1, sizeof *whole->faces);
    whole->point_count = count;
    for (size_t i = 0; i < count; i++)
        places[i] = wd_v3_of(points->points[i].position_m);
    wd_curve_order(whole->point_order, places, count);
    for (size_t i = 0; i < count; i++) {
        const struct wd_tree_point *point = &points->points[whole->point_order[i]];
        float face[3] = {0};
        if (point->kind & WD_POINT_ONE_SIDED)
            wd_unpack_normal(point->face, face);
        whole->points[i] = wd_v3_of(point->position_m);
        whole->faces[i] = wd_v3_of(face);
    }
    free(places);
}

static void whole_init(struct whole *whole, const struct wd_tree_points *points, const struct wd_tree_mesh *mesh)
{
    struct wd_vec3 low = wd_v3_of(mesh->min_m), high = wd_v3_of(mesh->max_m), wide = wd_v3_sub(high, low);
    fill_triangles(whole, mesh);
    fill_points(whole, points);
    whole->middle = wd_v3_scale(wd_v3_add(low, high), 0.5f);
    whole->half_m = fmaxf(0.5f * sqrtf(wd_v3_dot(wide, wide)), 1e-3f);
}

static void whole_finish(struct whole *whole)
{
    free(whole->points);
    free(whole->faces);
    free(whole->point_order);
    free(whole->triangles);
}

static void picture_init(struct picture *picture, size_t points, float clear_m)
{
    const size_t room = points + EIGHT;
    *picture = (struct picture){.clear_m = fmaxf(clear_m, CLEAR_M),
                                .x = wd_alloc_array(room, sizeof *picture->x),
                                .y = wd_alloc_array(room, sizeof *picture->y),
                                .toward = wd_alloc_array(room, sizeof *picture->toward),
                                .point = wd_alloc_array(room, sizeof *picture->point),
                                .first = wd_alloc_array(SIDE * SIDE + 1, sizeof *picture->first),
                                .cells = wd_alloc_array(room, sizeof *picture->cells)};
}

static void picture_finish(struct picture *picture)
{
    free(picture->x);
    free(picture->y);
    free(picture->toward);
    free(picture->point);
    free(picture->first);
    free(picture->cells);
}

static void aim(struct picture *picture, const struct whole *whole, struct wd_vec3 toward)
{
    struct wd_vec3 right = wd_v3_side(toward);
    float scale = 0.5f * SIDE / whole->half_m;
    picture->axis[0] = wd_v3_scale(right, scale);
    picture->axis[1] = wd_v3_scale(wd_v3_cross(right, toward), scale);
    picture->axis[2] = toward;
    for (int k = 0; k < 2; k++)
        picture->low[k] = wd_v3_dot(whole->middle, picture->axis[k]) - 0.5f * SIDE;
}

/* Nothing of a mesh lies outside but what rounding or no number puts there. */
static inline uint32_t cell_of(float x)
{
    return x > 0 ? x < SIDE ? (uint32_t)x : SIDE - 1 : 0;
}

/* Sets the way's bit of all points but those that face away. */
static void place_points(struct picture *picture, const struct whole *whole, uint32_t *open, uint32_t way)
{
    const uint32_t none = SIDE * SIDE;
    uint32_t *first = picture->first, count = 0;
    memset(first, 0, (none + 1) * sizeof *first);
    for (size_t i = 0; i < whole->point_count; i++) {
        struct wd_vec3 p = whole->points[i], face = whole->faces[i];
        bool is_asked = wd_v3_dot(face, picture->axis[2]) > 0 || wd_v3_dot(face, face) <= 0;
        float x = wd_v3_dot(p, picture->axis[0]) - picture->low[0];
        float y = wd_v3_dot(p, picture->axis[1]) - picture->low[1];
        picture->cells[i] = is_asked ? cell_of(y) * SIDE + cell_of(x) : none;
        first[picture->cells[i]]++;
        open[i] |= (uint32_t)is_asked << way;
        count += is_asked;
    }
    for (uint32_t i = 1; i <= none; i++)
        first[i] += first[i - 1]; /* ends, */
    for (size_t i = whole->point_count; i-- > 0;) {
        struct wd_vec3 p = whole->points[i];
        uint32_t to = --first[picture->cells[i]]; /* then beginnings */
        picture->x[to] = wd_v3_dot(p, picture->axis[0]) - picture->low[0];
        picture->y[to] = wd_v3_dot(p, picture->axis[1]) - picture->low[1];
        picture->toward[to] = wd_v3_dot(p, picture->axis[2]) + picture->clear_m;
        picture->point[to] = (uint32_t)i;
    }
    for (uint32_t i = count; i < count + EIGHT - 1; i++)
        picture->toward[i] = INFINITY;
}

/* --- triangles, four at a time -------------------------------------------------------------------------------- */

/* What is linear in the picture: right x + up y + from. */
struct four_plane {
    wd_four right, up, from;
};

/* Four triangles in the picture. Points where all sides are 0 or more lie inside. */
struct four_seen {
    struct four_plane sides[3], toward; /* `toward` is no more than `most` */
    wd_four most;
    wd_four_ints first[2], last[2]; /* cells, right and up */
};

static inline struct four_plane side_of(const wd_four from[3], const wd_four to[3], wd_four turn)
{
    struct four_plane plane = {(from[1] - to[1]) * turn, (to[0] - from[0]) * turn, {0}};
    plane.from = -(plane.right * from[0] + plane.up * from[1]);
    return plane;
}

static inline struct four_plane toward_of(wd_four at[3][3], wd_four area)
{
    wd_four bx = at[1][0] - at[0][0], by = at[1][1] - at[0][1], bz = at[1][2] - at[0][2];
    wd_four cx = at[2][0] - at[0][0], cy = at[2][1] - at[0][1], cz = at[2][2] - at[0][2];
    struct four_plane plane = {(bz * cy - cz * by) / area, (cz * bx - bz * cx) / area, {0}};
    plane.from = at[0][2] - plane.right * at[0][0] - plane.up * at[0][1];
    return plane;
}

static inline wd_four_ints cells_of(wd_four x)
{
    const wd_four none = {0};
    return wd_four_truncate(wd_four_min(wd_four_max(x, none), wd_four_of(SIDE - 1)));
}

/* Those seen from their edge reach over no cell. */
static inline void see(struct four_seen *seen, wd_four at[3][3])
{
    wd_four area = (at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[2][0] - at[0][0]) * (at[1][1] - at[0][1]);
    wd_four turn = wd_four_choose(area < 0, wd_four_of(-1), wd_four_of(1));
    wd_four_ints edge = ~(wd_four_abs(area) > 1e-9f);
    for (int k = 0; k < 3; k++)
        seen->sides[k] = side_of(at[k], at[(k + 1) % 3], turn);
    seen->toward = toward_of(at, area);
    seen->most = wd_four_max(wd_four_max(at[0][2], at[1][2]), at[2][2]);
    for (int k = 0; k < 2; k++) {
        seen->first[k] = cells_of(wd_four_min(wd_four_min(at[0][k], at[1][k]), at[2][k]));
        seen->last[k] = cells_of(wd_four_max(wd_four_max(at[0][k], at[1][k]), at[2][k]));
    }
    seen->last[1] = seen->last[1] | edge; /* -1 */
}

/* Of eight points from `i` on those that triangle `t` stands before, -1. Returns whether there are any. */
static inline bool find_hidden(eight_ints *hidden, const struct picture *picture, uint32_t i,
                               const struct four_seen *seen, int t)
{
    const struct four_plane *plane = &seen->toward;
    eight x, y, toward;
    uint64_t pairs[EIGHT / 2];
    memcpy(&x, picture->x + i, sizeof x);
    memcpy(&y, picture->y + i, sizeof y);
    memcpy(&toward, picture->toward + i, sizeof toward);
    *hidden = (plane->right[t] * x + plane->up[t] * y + plane->from[t] > toward) & (seen->most[t] > toward);
    for (int k = 0; k < 3; k++) {
        const struct four_plane *side = &seen->sides[k];
        *hidden &= side->right[t] * x + side->up[t] * y + side->from[t] >= 0;
    }
    memcpy(pairs, hidden, sizeof pairs);
    return (pairs[0] | pairs[1]) | (pairs[2] | pairs[3]);
}

/* Points that are hidden need not be asked again. */
static inline void hide(const struct picture *picture, const struct four_seen *seen, int t, uint32_t *open,
                        uint32_t way)
{
    for (int32_t y = seen->first[1][t]; y <= seen->last[1][t]; y++) {
        uint32_t end = picture->first[y * SIDE + seen->last[0][t] + 1];
        for (uint32_t i = picture->first[y * SIDE + seen->first[0][t]]; i < end; i += EIGHT) {
            eight_ints hidden;
            if (!find_hidden(&hidden, picture, i, seen, t))
                continue;
            for (uint32_t k = 0; k < EIGHT; k++)
                if (hidden[k]) {
                    open[picture->point[i + k]] &= ~(1u << way);
                    picture->toward[i + k] = INFINITY;
                }
        }
    }
}

WD_FOUR_TWICE
static void hide_points(const struct picture *picture, const struct whole *whole, uint32_t *open, uint32_t way)
{
    for (size_t i = 0; i < whole->triangle_count; i += 4) {
        struct four_seen seen;
        wd_four at[3][3];
        for (int k = 0; k < 3; k++) {
            const wd_four rows[4] = {whole->triangles[i][k], whole->triangles[i + 1][k], whole->triangles[i + 2][k],
                                     whole->triangles[i + 3][k]};
            wd_four p[3];
            wd_four_columns(p, rows);
            for (int axis = 0; axis < 3; axis++)
                at[k][axis] = wd_four_dot(&(struct wd_four_vec3){p[0], p[1], p[2]}, picture->axis[axis]) -
                              picture->low[axis];
        }
        see(&seen, at);
        for (int t = 0; t < 4; t++)
            hide(picture, &seen, t, open, way);
    }
}

void wd_tree_points_open(uint32_t *open, const struct wd_tree_points *points, const struct wd_tree_mesh *mesh,
                         float clear_m, const struct wd_vec3 *ways, uint32_t count)
{
    struct whole whole;
    struct picture picture;
    uint32_t *bits = wd_alloc_array(points->count + 1, sizeof *bits);
    whole_init(&whole, points, mesh);
    picture_init(&picture, points->count, clear_m);
    for (uint32_t way = 0; way < count; way++) {
        aim(&picture, &whole, ways[way]);
        place_points(&picture, &whole, bits, way);
        hide_points(&picture, &whole, bits, way);
    }
    for (size_t i = 0; i < points->count; i++)
        open[whole.point_order[i]] = bits[i];
    whole_finish(&whole);
    picture_finish(&picture);
    free(bits);
}

void wd_tree_points_light(struct wd_tree_points *points, const struct wd_tree_mesh *mesh)
{
    struct wd_vec3 ways[WD_SUN_WAYS];
    for (uint32_t way = 0; way < WD_SUN_WAYS; way++)
        ways[way] = wd_sun_way(way);
    points->lit = wd_alloc_array(points->count + 1, sizeof *points->lit);
    wd_tree_points_open(points->lit, points, mesh, 0, ways, WD_SUN_WAYS);
}
