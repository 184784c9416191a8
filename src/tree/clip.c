#include "tree/clip.h"

#include <string.h>

enum { MAX_TRIANGLES = 1000000 };

struct wd_clip_volume wd_clip_box(const float size_m[3])
{
    return (struct wd_clip_volume){
        .min_m = {-0.5f * size_m[0], -0.5f * size_m[1], wd_minf(0.04f, 0.1f * size_m[2])},
        .max_m = {0.5f * size_m[0], 0.5f * size_m[1], size_m[2]},
    };
}

static const char *name_of(const struct wd_clip_volume *volume)
{
    return volume->name ? volume->name : "clip volume";
}

static bool check_mesh(const struct wd_clip_volume *volume, const struct wd_log *log)
{
    if (volume->triangle_count > MAX_TRIANGLES)
        return wd_error(log, "%s has %u triangles; allowed to cut to are %d",
                        name_of(volume), volume->triangle_count, MAX_TRIANGLES);
    for (uint32_t i = 0; i < 3 * volume->triangle_count; i++)
        if (volume->indices[i] >= volume->vertex_count)
            return wd_error(log, "%s: index %u of triangle %u is %u; it has %u vertices",
                            name_of(volume), i % 3, i / 3, volume->indices[i], volume->vertex_count);
    for (uint32_t i = 0; i < 3 * volume->vertex_count; i++)
        if (!isfinite(volume->positions_m[i]))
            return wd_error(log, "%s: vertex %u is not a finite place", name_of(volume), i / 3);
    return true;
}

static void set_bounds(struct wd_clip_grid *grid, const struct wd_clip_volume *volume)
{
    memcpy(grid->min_m, volume->min_m, sizeof grid->min_m);
    memcpy(grid->max_m, volume->max_m, sizeof grid->max_m);
    for (uint32_t i = 0; volume->triangle_count > 0 && i < volume->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++) {
            float p = volume->positions_m[3 * i + (uint32_t)axis];
            grid->min_m[axis] = i == 0 ? p : wd_minf(grid->min_m[axis], p);
            grid->max_m[axis] = i == 0 ? p : wd_maxf(grid->max_m[axis], p);
        }
}

static bool check_bounds(const struct wd_clip_grid *grid, const char *name,
                         const struct wd_log *log)
{
    for (int axis = 0; axis < 3; axis++) {
        double low = (double)grid->min_m[axis], high = (double)grid->max_m[axis];
        if (!(high - low >= 0.1 && low >= -100 && high <= 100))
            return wd_error(log, "%s reaches from %g to %g m along %c; allowed are 0.1 m or more, "
                                 "within 100 m of the foot", name, low, high, "xyz"[axis]);
    }
    if (!(grid->max_m[2] >= 0.2f && grid->min_m[2] <= 0.5f * grid->max_m[2]))
        return wd_error(log, "%s stands from %g to %g m above the foot; allowed is a top at 0.2 m or "
                             "more and a bottom at half of that or less", name,
                        (double)grid->min_m[2], (double)grid->max_m[2]);
    return true;
}

/* The middle of a column; off the middle by an odd share, so that it meets no edge of the mesh. */
static double column_at(const struct wd_clip_grid *grid, int axis, int i)
{
    double side = (double)grid->max_m[axis] - (double)grid->min_m[axis];
    return (double)grid->min_m[axis] + side * ((double)i + 0.50317) / WD_CLIP_SIDE;
}

static int column_of(const struct wd_clip_grid *grid, int axis, double at)
{
    double side = (double)grid->max_m[axis] - (double)grid->min_m[axis];
    double cell = (at - (double)grid->min_m[axis]) / side * WD_CLIP_SIDE;
    return cell < 0 ? 0 : cell >= WD_CLIP_SIDE ? WD_CLIP_SIDE - 1 : (int)cell;
}

/* Twice the signed area of (a, b, p) seen from above. */
static double turn_of(const float *a, const float *b, double x, double y)
{
    return ((double)b[0] - (double)a[0]) * (y - (double)a[1]) -
           ((double)b[1] - (double)a[1]) * (x - (double)a[0]);
}

/* Where a column passes through a triangle, everything above changes sides. */
static void cross_triangle(struct wd_clip_grid *grid, const float *corner[3], uint8_t *odd)
{
    double low[2], high[2];
    for (int axis = 0; axis < 2; axis++) {
        low[axis] = (double)wd_min3f(corner[0][axis], corner[1][axis], corner[2][axis]);
        high[axis] = (double)wd_max3f(corner[0][axis], corner[1][axis], corner[2][axis]);
    }
    double height = (double)grid->max_m[2] - (double)grid->min_m[2];
    for (int j = column_of(grid, 1, low[1]); j <= column_of(grid, 1, high[1]); j++)
        for (int i = column_of(grid, 0, low[0]); i <= column_of(grid, 0, high[0]); i++) {
            double x = column_at(grid, 0, i), y = column_at(grid, 1, j);
            double a = turn_of(corner[1], corner[2], x, y);
            double b = turn_of(corner[2], corner[0], x, y);
            double c = turn_of(corner[0], corner[1], x, y);
            if (!((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0)))
                continue;
            double z = (a * (double)corner[0][2] + b * (double)corner[1][2] +
                        c * (double)corner[2][2]) / (a + b + c);
            double cells = (z - (double)grid->min_m[2]) / height * WD_CLIP_SIDE + 0.5;
            int below = cells < 0 ? 0 : cells >= WD_CLIP_SIDE ? WD_CLIP_SIDE : (int)cells;
            if (below < WD_CLIP_SIDE)
                grid->columns[j * WD_CLIP_SIDE + i] ^= UINT64_MAX << below;
            odd[j * WD_CLIP_SIDE + i] ^= 1;
        }
}

static bool fill_columns(struct wd_clip_grid *grid, const struct wd_clip_volume *volume,
                         const struct wd_log *log)
{
    uint8_t odd[WD_CLIP_SIDE * WD_CLIP_SIDE] = {0};
    int open = 0, filled = 0;
    for (uint32_t t = 0; t < volume->triangle_count; t++) {
        const float *corner[3];
        for (uint32_t k = 0; k < 3; k++)
            corner[k] = &volume->positions_m[3 * (size_t)volume->indices[3 * t + k]];
        cross_triangle(grid, corner, odd);
    }
    for (int i = 0; i < WD_CLIP_SIDE * WD_CLIP_SIDE; i++) {
        open += odd[i];
        grid->columns[i] = odd[i] ? 0 : grid->columns[i];
        filled += grid->columns[i] != 0;
    }
    if (open > WD_CLIP_SIDE * WD_CLIP_SIDE / 100)
        return wd_error(log, "%s is not closed: %d of %d lines from below pass through an odd number "
                             "of its triangles", name_of(volume), open, WD_CLIP_SIDE * WD_CLIP_SIDE);
    grid->area_m2 *= (float)filled / (WD_CLIP_SIDE * WD_CLIP_SIDE);
    if (filled == 0)
        return wd_error(log, "%s is empty", name_of(volume));
    return true;
}

bool wd_clip_grid_init(struct wd_clip_grid *grid, const struct wd_clip_volume *volume,
                       const struct wd_log *log)
{
    *grid = (struct wd_clip_grid){.box = volume->triangle_count == 0};
    if (!grid->box && !check_mesh(volume, log))
        return false;
    set_bounds(grid, volume);
    if (!check_bounds(grid, name_of(volume), log))
        return false;
    float width = grid->max_m[0] - grid->min_m[0], depth = grid->max_m[1] - grid->min_m[1];
    grid->area_m2 = width * depth;
    if (!grid->box && !fill_columns(grid, volume, log))
        return false;
    grid->shell_m2 = grid->area_m2 + 2 * (width + depth) * (grid->max_m[2] - grid->min_m[2]) *
                                         sqrtf(grid->area_m2 / (width * depth));
    return true;
}

bool wd_clip_inside(const struct wd_clip_grid *grid, struct wd_vec3 p)
{
    const float at[3] = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; axis++)
        if (!(at[axis] >= grid->min_m[axis] && at[axis] <= grid->max_m[axis]))
            return false;
    if (grid->box)
        return true;
    int i = column_of(grid, 0, (double)p.x), j = column_of(grid, 1, (double)p.y);
    return grid->columns[j * WD_CLIP_SIDE + i] >> column_of(grid, 2, (double)p.z) & 1;
}

bool wd_clip_near_shell(const struct wd_clip_grid *grid, struct wd_vec3 p, float reach_m)
{
    const struct wd_vec3 beside[5] = {{reach_m, 0, 0}, {-reach_m, 0, 0}, {0, reach_m, 0},
                                      {0, -reach_m, 0}, {0, 0, reach_m}};
    for (int i = 0; i < 5; i++)
        if (!wd_clip_inside(grid, wd_v3_add(p, beside[i])))
            return true;
    return false;
}
