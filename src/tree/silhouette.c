#include "tree/silhouette.h"

#include <string.h>

void wd_silhouette_init(struct wd_silhouette *silhouette, const struct wd_tree_mesh *frame,
                        struct wd_vec3 toward)
{
    struct wd_vec3 middle = WD_V3(0.5f * (frame->min_m[0] + frame->max_m[0]),
                                  0.5f * (frame->min_m[1] + frame->max_m[1]),
                                  0.5f * (frame->min_m[2] + frame->max_m[2]));
    float x = frame->max_m[0] - frame->min_m[0], y = frame->max_m[1] - frame->min_m[1];
    float tall = frame->max_m[2] - frame->min_m[2];
    float half = 0.5f * fmaxf(fmaxf(sqrtf(x * x + y * y), tall), 2e-3f);
    struct wd_vec3 right = wd_v3_side(toward);
    *silhouette = (struct wd_silhouette){.right = right, .up = wd_v3_cross(right, toward),
                                         .toward = toward,
                                         .scale = 0.5f * (WD_SILHOUETTE - 2) / half};
    silhouette->low[0] = wd_v3_dot(middle, right) - half - 1 / silhouette->scale;
    silhouette->low[1] = wd_v3_dot(middle, silhouette->up) - half - 1 / silhouette->scale;
}

struct wd_silhouette_axes wd_silhouette_axes_of(const struct wd_silhouette *silhouette)
{
    return (struct wd_silhouette_axes){
        {wd_v3_scale(silhouette->right, silhouette->scale),
         wd_v3_scale(silhouette->up, silhouette->scale), silhouette->toward},
        {silhouette->low[0] * silhouette->scale, silhouette->low[1] * silhouette->scale, 0},
    };
}

/* --- triangles, a batch at a time ----------------------------------------------------------- */

enum { BATCH = 256 };

/* Triangles in the tree: three numbers a corner and one that is none of its, */
struct corners {
    wd_four rows[BATCH][3];
};

/* and each number of all of them together. */
struct places {
    float m[3][3][BATCH]; /* [corner][axis] */
};

struct batch {
    float at[3][3][BATCH]; /* [corner][axis] in the picture */
    float turn[BATCH];     /* 1, or -1 of triangles that are seen from behind; 0 of none */
    float right[BATCH], down[BATCH], most[BATCH]; /* distance a pixel; the farthest corner's */
    int32_t x0[BATCH], x1[BATCH], y0[BATCH], y1[BATCH]; /* pixels whose middles it reaches over */
    /* of triangles that reach over two by two or fewer: what they cover, their distance there */
    int32_t covered[BATCH]; /* a bit a pixel */
    int32_t large[BATCH];   /* 1 of triangles that reach over more */
    float distance[4][BATCH];
};

/* Triangles from the first of the indices on. */
static void load(struct corners *corners, const struct wd_tree_mesh *mesh, const uint32_t *indices,
                 int count)
{
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            memcpy(&corners->rows[i][k], &mesh->vertices[indices[3 * i + k]], sizeof(wd_four));
}

/* All of them, or `which`, and up to three more. */
static inline void turn(struct places *places, const struct corners *corners, const int *which,
                        int count)
{
    for (int i = 0; i < count; i += 4) {
        const wd_four(*from[4])[3];
        for (int j = 0; j < 4; j++)
            from[j] = &corners->rows[which ? which[i + j] : i + j];
        for (int k = 0; k < 3; k++) {
            wd_four columns[3];
            const wd_four rows[4] = {(*from[0])[k], (*from[1])[k], (*from[2])[k], (*from[3])[k]};
            wd_four_columns(columns, rows);
            for (int axis = 0; axis < 3; axis++)
                memcpy(places->m[k][axis] + i, &columns[axis], sizeof *columns);
        }
    }
}

static inline struct wd_vec3 corner(const struct places *places, int k, int i)
{
    return WD_V3(places->m[k][0][i], places->m[k][1][i], places->m[k][2][i]);
}

/* Whether the middle of one of the picture's pixels lies between a and b, or nearly so. */
static inline int passes(float a, float b, float low)
{
    const float nearly = 1 / 1024.0f;
    return (int)(a + (0.5f - nearly - low)) != (int)(b + (0.5f + nearly - low));
}

/* Most triangles lie between the middles of pixels. Finds the others, and few of those: without a
 * branch to be guessed, and not by a rounding less than wd_silhouette_pixels does. They are followed by
 * three that are any. */
static int find_reaching(int reaching[BATCH + 3], const struct places *places,
                         const struct wd_silhouette_axes *axes, int count)
{
    int32_t reaches[BATCH];
    const struct wd_vec3 right = axes->axis[0], up = axes->axis[1];
    for (int i = 0; i < BATCH; i++) {
        struct wd_vec3 p = corner(places, 0, i), q = corner(places, 1, i), r = corner(places, 2, i);
        /* right.z is 0 */
        float a = p.x * right.x + p.y * right.y;
        float b = q.x * right.x + q.y * right.y;
        float c = r.x * right.x + r.y * right.y;
        float d = wd_v3_dot(p, up), e = wd_v3_dot(q, up), f = wd_v3_dot(r, up);
        reaches[i] = passes(wd_min3f(a, b, c), wd_max3f(a, b, c), axes->low[0]) &
                     passes(wd_min3f(d, e, f), wd_max3f(d, e, f), axes->low[1]);
    }
    int found = 0;
    for (int i = 0; i < count; i++) {
        reaching[found] = i;
        found += reaches[i];
    }
    reaching[found] = reaching[found + 1] = reaching[found + 2] = 0;
    return found;
}

static void place_corners(struct batch *batch, const struct places *places,
                          const struct wd_silhouette_axes *axes, int count)
{
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++)
            for (int i = 0; i < count; i++)
                batch->at[k][axis][i] =
                    wd_v3_dot(corner(places, k, i), axes->axis[axis]) - axes->low[axis];
}

static void find_range(int32_t *first, int32_t *end, float (*at)[3][BATCH], int axis, int count)
{
    for (int i = 0; i < count; i += 4) {
        wd_four a = wd_four_load(at[0][axis] + i), b = wd_four_load(at[1][axis] + i);
        wd_four c = wd_four_load(at[2][axis] + i);
        wd_four_ints low = wd_silhouette_pixels(wd_four_min(wd_four_min(a, b), c));
        wd_four_ints high = wd_silhouette_pixels(wd_four_max(wd_four_max(a, b), c));
        memcpy(first + i, &low, sizeof low);
        memcpy(end + i, &high, sizeof high);
    }
}

static float area_of(struct batch *batch, int i)
{
    float(*a)[BATCH] = batch->at[0], (*b)[BATCH] = batch->at[1], (*c)[BATCH] = batch->at[2];
    float bx = b[0][i] - a[0][i], by = b[1][i] - a[1][i];
    return bx * (c[1][i] - a[1][i]) - (c[0][i] - a[0][i]) * by;
}

static void find_turns(struct batch *batch, int count)
{
    for (int i = 0; i < count; i++) {
        float area = area_of(batch, i);
        batch->turn[i] = area > 1e-9f ? 1.0f : area < -1e-9f ? -1.0f : 0.0f;
    }
}

static void find_slopes(struct batch *batch, int count)
{
    float(*a)[BATCH] = batch->at[0], (*b)[BATCH] = batch->at[1], (*c)[BATCH] = batch->at[2];
    for (int i = 0; i < count; i++) {
        float bx = b[0][i] - a[0][i], by = b[1][i] - a[1][i], bz = b[2][i] - a[2][i];
        float cx = c[0][i] - a[0][i], cy = c[1][i] - a[1][i], cz = c[2][i] - a[2][i];
        float over = 1 / area_of(batch, i);
        batch->right[i] = (bz * cy - cz * by) * over;
        batch->down[i] = (cz * bx - bz * cx) * over;
        batch->most[i] = wd_max3f(a[2][i], b[2][i], c[2][i]);
    }
}

/* --- small triangles, four at a time --------------------------------------------------------- */

/* Points p with cross(way, p - from) >= 0 lie inside. */
struct four_edge {
    wd_four from[2], way[2];
};

static inline wd_four_ints load_ints(const int32_t *from)
{
    wd_four_ints a;
    memcpy(&a, from, sizeof a);
    return a;
}

static inline wd_four_ints is_inside_four(const struct four_edge edges[3], wd_four x, wd_four y)
{
    const struct four_edge *a = &edges[0], *b = &edges[1], *c = &edges[2];
    return (a->way[0] * (y - a->from[1]) >= a->way[1] * (x - a->from[0])) &
           (b->way[0] * (y - b->from[1]) >= b->way[1] * (x - b->from[0])) &
           (c->way[0] * (y - c->from[1]) >= c->way[1] * (x - c->from[0]));
}

/* Which of the two by two pixels four triangles cover; none of those that reach farther. What
 * slivers have beyond their farthest corner is error. */
static inline void cover_small(struct batch *batch, int i, bool depth)
{
    const wd_four none = {0};
    wd_four turn = wd_four_load(batch->turn + i), right = wd_four_load(batch->right + i);
    wd_four_ints x0 = load_ints(batch->x0 + i), y0 = load_ints(batch->y0 + i);
    wd_four_ints wide = load_ints(batch->x1 + i) - x0, tall = load_ints(batch->y1 + i) - y0;
    wd_four_ints small = (turn != none) & (wide <= 2) & (tall <= 2), covered = {0};
    wd_four_ints large = ((wide > 2) | (tall > 2)) & (wide > 0) & (tall > 0) & (turn != none) & 1;
    struct four_edge edges[3];
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 2; axis++) {
            wd_four to = wd_four_load(batch->at[(k + 1) % 3][axis] + i);
            edges[k].from[axis] = wd_four_load(batch->at[k][axis] + i);
            edges[k].way[axis] = (to - edges[k].from[axis]) * turn;
        }
    for (int pixel = 0; pixel < 4; pixel++) {
        const int dx = pixel & 1, dy = pixel >> 1;
        wd_four x = wd_four_convert(x0 + dx), middle = wd_four_convert(y0 + dy) + 0.5f;
        wd_four_ints inside = small & (wide > dx) & (tall > dy) &
                              is_inside_four(edges, x + 0.5f, middle);
        covered |= inside & 1 << pixel;
        if (!depth)
            continue;
        wd_four own = wd_four_load(batch->at[0][2] + i) +
                      wd_four_load(batch->down + i) * (middle - edges[0].from[1]) +
                      right * (0.5f - edges[0].from[0]) + right * x;
        own = wd_four_choose(inside & (own <= wd_four_load(batch->most + i)), own,
                             wd_four_of(-INFINITY));
        memcpy(batch->distance[pixel] + i, &own, sizeof own);
    }
    memcpy(batch->covered + i, &covered, sizeof covered);
    memcpy(batch->large + i, &large, sizeof large);
}

static inline void or_bits(uint8_t *row, int x, uint32_t bits)
{
    uint32_t covered;
    memcpy(&covered, row + x / 8, sizeof covered);
    covered |= bits << x % 8;
    memcpy(row + x / 8, &covered, sizeof covered);
}

static inline void draw_small(uint8_t (*covered)[WD_SILHOUETTE_ROW], float *front,
                              const struct batch *batch, int i)
{
    int x = batch->x0[i], y = batch->y0[i];
    if (covered) {
        or_bits(covered[y], x, (uint32_t)batch->covered[i] & 3);
        or_bits(covered[y + 1], x, (uint32_t)batch->covered[i] >> 2);
        return;
    }
    for (int pixel = 0; pixel < 4; pixel++) {
        float *at = front + (y + (pixel >> 1)) * WD_SILHOUETTE + x + (pixel & 1);
        *at = wd_maxf(batch->distance[pixel][i], *at);
    }
}

/* --- others, four pixels at a time ----------------------------------------------------------- */

/* Points p with cross(way, p - from) >= 0 lie inside: way[0] (y - from[1]) >= beyond, which is
 * way[1] (x - from[0]) of four pixels. */
struct edge {
    float from[2], way[2];
    wd_four beyond;
};

static void set_edges(struct edge edges[3], const struct batch *batch, int i)
{
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 2; axis++) {
            float from = batch->at[k][axis][i], to = batch->at[(k + 1) % 3][axis][i];
            edges[k].from[axis] = from;
            edges[k].way[axis] = (to - from) * batch->turn[i];
        }
}

static inline wd_four_ints is_inside(const struct edge *edge, float y)
{
    return wd_four_of(edge->way[0] * (y - edge->from[1])) >= edge->beyond;
}

static inline void cover_four(uint8_t *row, int x, wd_four_ints inside)
{
    const wd_four_ints bits = {1, 2, 4, 8};
    uint64_t pairs[2];
    inside &= bits;
    memcpy(pairs, &inside, sizeof pairs);
    pairs[0] |= pairs[1];
    or_bits(row, x, (uint32_t)(pairs[0] | pairs[0] >> 32));
}

static inline void bring_four(float *row, wd_four_ints inside, wd_four own, float most)
{
    wd_four front = wd_four_load(row);
    front = wd_four_choose(inside & (own > front) & (own <= most), own, front);
    memcpy(row, &front, sizeof front);
}

/* Covers a triangle in `covered`, or brings `front` before it. What lies beyond x1 is left as it
 * is. */
static inline void draw_triangle(uint8_t (*covered)[WD_SILHOUETTE_ROW], float *front,
                                 const struct batch *batch, int i)
{
    float ax = batch->at[0][0][i], ay = batch->at[0][1][i], az = batch->at[0][2][i];
    struct edge edges[3];
    set_edges(edges, batch, i);
    for (int x = batch->x0[i]; x < batch->x1[i]; x += 4) {
        const wd_four_ints at = {x, x + 1, x + 2, x + 3}, seen = at < batch->x1[i];
        wd_four places = wd_four_convert(at);
        wd_four nearer = batch->right[i] * places;
        for (int k = 0; k < 3; k++)
            edges[k].beyond = edges[k].way[1] * (places + 0.5f - edges[k].from[0]);
        for (int y = batch->y0[i]; y < batch->y1[i]; y++) {
            float middle = (float)y + 0.5f;
            wd_four_ints inside = seen & is_inside(&edges[0], middle) & is_inside(&edges[1], middle) &
                               is_inside(&edges[2], middle);
            if (covered) {
                cover_four(covered[y], x, inside);
                continue;
            }
            float first = az + batch->down[i] * (middle - ay) + batch->right[i] * (0.5f - ax);
            bring_four(front + y * WD_SILHOUETTE + x, inside, first + nearer, batch->most[i]);
        }
    }
}

static void prepare(struct batch *batch, const struct places *places,
                    const struct wd_silhouette_axes *axes, int count, bool depth)
{
    int eights = (count + 7) & ~7;
    place_corners(batch, places, axes, eights);
    find_range(batch->x0, batch->x1, batch->at, 0, eights);
    find_range(batch->y0, batch->y1, batch->at, 1, eights);
    find_turns(batch, eights);
    if (depth)
        find_slopes(batch, eights);
    for (int i = 0; i < count; i += 4)
        cover_small(batch, i, depth);
}

/* Small ones that lie between the middles of pixels are sorted out without a branch to be guessed. */
static inline void draw_batch(uint8_t (*covered)[WD_SILHOUETTE_ROW], float *front,
                              const struct batch *batch, int count)
{
    int small[BATCH + 1], large[BATCH + 1], smalls = 0, larges = 0;
    for (int i = 0; i < count; i++) {
        small[smalls] = large[larges] = i;
        smalls += batch->covered[i] != 0;
        larges += batch->large[i];
    }
    for (int i = 0; i < smalls; i++)
        draw_small(covered, front, batch, small[i]);
    for (int i = 0; i < larges; i++)
        draw_triangle(covered, front, batch, large[i]);
}

struct drawing {
    struct corners corners;
    struct places all, some; /* some reach over the middle of a pixel of a view, */
    struct batch batch;      /* where they are these */
};

/* Triangles from `indices` on, BATCH at most, in all views: into their bits, or into `fronts`. */
static inline void draw_views(struct drawing *drawing, struct wd_silhouette *covers, float *fronts,
                              const struct wd_silhouette *views, int view_count,
                              const struct wd_tree_mesh *mesh, const uint32_t *indices, int count)
{
    int reaching[BATCH + 3];
    load(&drawing->corners, mesh, indices, count);
    turn(&drawing->all, &drawing->corners, NULL, count);
    for (int view = 0; view < view_count; view++) {
        const struct wd_silhouette_axes axes = wd_silhouette_axes_of(&views[view]);
        int reach = find_reaching(reaching, &drawing->all, &axes, count);
        turn(&drawing->some, &drawing->corners, reaching, reach);
        prepare(&drawing->batch, &drawing->some, &axes, reach, fronts != NULL);
        draw_batch(covers ? covers[view].covered : NULL,
                   fronts ? fronts + view * WD_SILHOUETTE_FRONT : NULL, &drawing->batch, reach);
    }
}

static inline int batch_count(uint32_t first, uint32_t end)
{
    return (end - first) / 3 < BATCH ? (int)((end - first) / 3) : BATCH;
}

WD_FOUR_TWICE
void wd_silhouette_cover(struct wd_silhouette *views, int view_count,
                         const struct wd_tree_mesh *mesh, uint32_t first, uint32_t end)
{
    struct drawing drawing = {0};
    for (uint32_t i = first; i + 2 < end; i += 3 * BATCH)
        draw_views(&drawing, views, NULL, views, view_count, mesh, mesh->indices + i,
                   batch_count(i, end));
}

WD_FOUR_TWICE
void wd_silhouette_front(const struct wd_silhouette *views, int view_count,
                         const struct wd_tree_mesh *mesh, float *fronts)
{
    struct drawing drawing = {0};
    const uint32_t end = mesh->index_count;
    for (int i = 0; i < view_count * WD_SILHOUETTE_FRONT; i++)
        fronts[i] = -INFINITY;
    for (uint32_t i = 0; i + 2 < end; i += 3 * BATCH)
        draw_views(&drawing, NULL, fronts, views, view_count, mesh, mesh->indices + i,
                   batch_count(i, end));
}

WD_FOUR_TWICE
uint32_t wd_silhouette_reach(uint32_t *triangles, const struct wd_silhouette *view,
                             const struct wd_tree_mesh *mesh)
{
    struct corners corners = {0};
    struct places places = {0};
    const struct wd_silhouette_axes axes = wd_silhouette_axes_of(view);
    const uint32_t end = mesh->index_count;
    uint32_t found = 0;
    for (uint32_t i = 0; i + 2 < end; i += 3 * BATCH) {
        int reaching[BATCH + 3], count = batch_count(i, end);
        load(&corners, mesh, mesh->indices + i, count);
        turn(&places, &corners, NULL, count);
        int reach = find_reaching(reaching, &places, &axes, count);
        for (int k = 0; k < reach; k++)
            triangles[found++] = i / 3 + (uint32_t)reaching[k];
    }
    return found;
}

size_t wd_silhouette_count(const struct wd_silhouette *silhouette)
{
    size_t count = 0;
    for (int y = 0; y < WD_SILHOUETTE; y++)
        for (int x = 0; x < WD_SILHOUETTE / 8; x += 4) {
            uint32_t bits;
            memcpy(&bits, &silhouette->covered[y][x], sizeof bits);
            count += (size_t)__builtin_popcount(bits);
        }
    return count;
}
