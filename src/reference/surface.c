#include "reference/surface.h"

#include "base/color.h"
#include "reference/fall.h"
#include "shared/ground_cover.h"
#include "shared/snow.h"
#include "tree/vec.h"
#include "world/cover.h"
#include "world/far_sward.h"
#include "world/river.h"

static const float COARSE_FOOTPRINT_M = 0.4f;
/* A pixel has more paths than tell in its footprint. */
enum { PATHS = 64 };

/* --- trees ----------------------------------------------------------------------------------- */

/* The triangle's corners by how much of each the hit holds. */
struct corners {
    const struct wd_tree_vertex *vertex[3];
    float share[3];
};

static struct corners corners_of(const struct wd_trace_model *model, const struct wd_trace_hit *hit)
{
    struct corners corners = {.share = {1 - hit->u - hit->v, hit->u, hit->v}};
    const uint32_t *index = model->grown.full.indices + 3 * (size_t)hit->triangle;
    for (int k = 0; k < 3; k++)
        corners.vertex[k] = &model->grown.full.vertices[index[k]];
    return corners;
}

static struct wd_vec3 vertex_normal(const struct corners *corners)
{
    struct wd_vec3 sum = {0};
    for (int k = 0; k < 3; k++) {
        float normal[3];
        wd_unpack_normal(corners->vertex[k]->normal, normal);
        sum = wd_v3_mad(sum, wd_v3_of(normal), corners->share[k]);
    }
    return sum;
}

static struct wd_vec3 flat_normal(const struct corners *corners)
{
    struct wd_vec3 p[3];
    for (int k = 0; k < 3; k++)
        p[k] = wd_v3_of(corners->vertex[k]->position_m);
    return wd_v3_cross(wd_v3_sub(p[1], p[0]), wd_v3_sub(p[2], p[0]));
}

/* From a model's frame into the world's: the inverse transpose of the pose. */
static struct wd_vec3 pose_normal(const struct wd_tree_pose *pose, struct wd_vec3 n)
{
    n.x *= pose->mirror;
    struct wd_vec3 turned = {(pose->turn_cos * n.x - pose->turn_sin * n.y) * pose->up,
                             (pose->turn_sin * n.x + pose->turn_cos * n.y) * pose->up,
                             n.z * pose->across};
    return wd_v3_unit(turned);
}

static struct wd_vec3 vertex_tint(const struct corners *corners)
{
    struct wd_vec3 sum = {0};
    for (int k = 0; k < 3; k++) {
        uint32_t tint = corners->vertex[k]->tint;
        struct wd_vec3 rgb = WD_V3(tint & 255u, tint >> 8 & 255u, tint >> 16 & 255u);
        sum = wd_v3_mad(sum, rgb, corners->share[k] / 255);
    }
    return sum;
}

/* Openness to the sky, which vertices carry beside their tint. */
static float vertex_openness(const struct corners *corners)
{
    float sum = 0;
    for (int k = 0; k < 3; k++)
        sum += (float)(corners->vertex[k]->tint >> 24) * corners->share[k];
    return sum / 255;
}

/* A sheet's upper side has its texture as it was drawn; the lower side has a texture of its own. */
static void leaf_surface(struct wd_surface *surface, const struct wd_trace_model *model,
                         const struct wd_trace_hit *hit, struct wd_vec3 eye,
                         struct wd_trace_texel *texel)
{
    float turn = wd_trace_uv_turn(model, hit->triangle);
    bool upper = wd_v3_dot(surface->flat, eye) * turn > 0;
    surface->sheet = true;
    surface->glossy = upper && texel->layer == WD_LOOK_LEAF;
    if (!upper && texel->layer == WD_LOOK_LEAF)
        texel->layer = WD_LOOK_LEAF_BACK;
}

static struct wd_vec3 texel_color(const struct wd_trace_model *model,
                                  const struct wd_trace_texel *texel)
{
    const uint8_t *rgb = model->look->albedo + texel->layer * WD_TRACE_MAP_BYTES + texel->offset;
    return WD_V3(wd_srgb_decode(rgb[0]), wd_srgb_decode(rgb[1]), wd_srgb_decode(rgb[2]));
}

/* What comes through a leaf: its share of the albedo is the species', thicker veins let through
 * less. Both together are never more than all. */
static struct wd_vec3 leaf_transmittance(const struct wd_surface *surface,
                                         const struct wd_trace_model *model,
                                         const struct wd_trace_texel *texel)
{
    size_t at = texel->layer * WD_TRACE_MAP_BYTES + texel->offset;
    float thin = (float)model->look->detail[at + 3] * (2 / 255.0f);
    struct wd_vec3 a = surface->albedo;
    struct wd_vec3 t = wd_v3_scale(wd_v3_mul(a, wd_v3_of(model->model.transmittance)), thin);
    return WD_V3(fminf(t.x, 1 - a.x), fminf(t.y, 1 - a.y), fminf(t.z, 1 - a.z));
}

/* It hides what it lies on, and its pads are smoother than leaves. */
static void lay_snow(struct wd_surface *surface, const struct wd_frame_uniforms *frame,
                     float openness, float footprint_m)
{
    float share = frame->snow > 0 ? wd_snow_share_on(frame, surface->place, wd_snow_up(surface->outward.z),
                                                     openness, footprint_m)
                                  : 0;
    if (share <= 0)
        return;
    surface->albedo = wd_v3_mix(surface->albedo, WD_SNOW_ALBEDO, share);
    surface->transmittance = wd_v3_scale(surface->transmittance, 1 - share);
    surface->outward = wd_v3_unit(wd_v3_mix(surface->outward, WD_V3(0, 0, 1), 0.5f * share));
    surface->glossy = surface->glossy && share < 0.5f;
}

static void tree_surface(struct wd_surface *surface, const struct wd_trace_scene *scene,
                         const struct wd_trace_hit *hit, struct wd_vec3 eye, float pixel_rad)
{
    const struct wd_tree *tree = &scene->world->trees[hit->tree];
    const struct wd_trace_model *model = wd_trace_hit_model(scene, hit);
    struct corners corners = corners_of(model, hit);
    struct wd_tree_pose pose = wd_tree_pose_of(*tree, model->model);
    bool leaf = (corners.vertex[0]->kind & WD_VERTEX_LEAF) != 0;
    struct wd_trace_texel texel = wd_trace_texel_at(model, hit->triangle, hit->u, hit->v);
    struct wd_vec3 flat = flat_normal(&corners), outward = vertex_normal(&corners);
    float foot_m[3];
    wd_trace_foot(scene->frame, tree, foot_m);
    if (wd_trace_falls(model, foot_m)) {
        struct wd_leaf_fall fall = wd_trace_fall_at(scene, tree, hit->triangle);
        flat = wd_leaf_fall_turn(fall, flat);
        outward = wd_leaf_fall_turn(fall, outward);
    }
    surface->flat = pose_normal(&pose, flat);
    surface->outward = pose_normal(&pose, outward);
    if (leaf)
        leaf_surface(surface, model, hit, eye, &texel);
    struct wd_vec3 look = wd_v3_mul(texel_color(model, &texel), vertex_tint(&corners));
    if (leaf)
        look = wd_v3_mul(look, wd_tree_tint(*tree, model->model));
    surface->albedo = wd_v3_clamp(look, 0, 1);
    if (leaf)
        surface->transmittance = leaf_transmittance(surface, model, &texel);
    if (wd_v3_dot(surface->outward, eye) > 0)
        lay_snow(surface, scene->frame, vertex_openness(&corners), hit->at_m * pixel_rad);
    surface->coat_alpha = model->model.roughness * model->model.roughness;
}

/* --- ground ---------------------------------------------------------------------------------- */

static float height_at(const struct wd_terrain *terrain, uint32_t i, uint32_t j)
{
    return terrain->height_m[(size_t)j * terrain->width + i];
}

/* Central differences; one-sided at the edge. */
static void sample_slope(const struct wd_terrain *terrain, uint32_t i, uint32_t j, float slope[2])
{
    uint32_t west = i ? i - 1 : 0, east = i + 1 < terrain->width ? i + 1 : i;
    uint32_t south = j ? j - 1 : 0, north = j + 1 < terrain->height ? j + 1 : j;
    float cell_m = (float)terrain->cell_m;
    slope[0] = (height_at(terrain, east, j) - height_at(terrain, west, j)) /
               ((float)(east - west) * cell_m);
    slope[1] = (height_at(terrain, i, north) - height_at(terrain, i, south)) /
               ((float)(north - south) * cell_m);
}

/* Interpolated between samples, as pictures are drawn with it. */
static void smooth_slope(const struct wd_terrain *terrain, double x_m, double y_m, float slope[2])
{
    float u, v, corner[4][2];
    uint32_t i = wd_grid_place(x_m / terrain->cell_m, terrain->width, &u);
    uint32_t j = wd_grid_place(y_m / terrain->cell_m, terrain->height, &v);
    for (uint32_t k = 0; k < 4; k++)
        sample_slope(terrain, i + (k & 1), j + (k >> 1), corner[k]);
    for (int k = 0; k < 2; k++)
        slope[k] = wd_mixf(wd_mixf(corner[0][k], corner[1][k], u),
                           wd_mixf(corner[2][k], corner[3][k], u), v);
}

static void ground_surface(struct wd_surface *surface, const struct wd_trace_scene *scene,
                           const struct wd_trace_hit *hit, struct wd_vec3 direction,
                           float pixel_rad)
{
    const struct wd_trace_ground *ground = &scene->ground;
    if (hit->triangle >= WD_TRACE_WALL) {
        surface->albedo = wd_v3_scale(wd_v3_of(scene->frame->soil),
                                      0.75f + 0.25f * cosf(surface->place.z * 1.3f));
        surface->outward = surface->flat = hit->normal;
        return;
    }
    double x_m = (double)surface->place.x + ground->origin_m[0];
    double y_m = (double)surface->place.y + ground->origin_m[1];
    float slope[2], footprint_m = COARSE_FOOTPRINT_M;
    smooth_slope(&scene->world->terrain, x_m, y_m, slope);
    if (pixel_rad > 0) {
        /* a mean of the sample's length away from the eye and its width */
        struct wd_vec3 level = wd_v3_normalize(WD_V3(-slope[0], -slope[1], 1));
        float facing = fabsf(wd_v3_dot(level, direction));
        footprint_m = hit->at_m * pixel_rad * wd_sample_footprint(PATHS) / sqrtf(fmaxf(facing, 0.02f));
    }
    struct wd_ground_look look =
        wd_ground_cover(scene->frame, surface->place, slope[0], slope[1],
                        wd_cover_at(scene->world, x_m, y_m), wd_woods_at(scene->world, x_m, y_m),
                        wd_sward_layers_at(scene->world, x_m, y_m),
                        wd_river_level(&scene->world->terrain, x_m, y_m), footprint_m);
    surface->albedo = look.albedo;
    surface->outward = look.normal;
    surface->flat = hit->normal;
}

/* --- both ------------------------------------------------------------------------------------ */

void wd_surface_at(struct wd_surface *surface, const struct wd_trace_scene *scene,
                   const struct wd_trace_ray *ray, const struct wd_trace_hit *hit, float pixel_rad)
{
    struct wd_vec3 eye = wd_v3_scale(ray->direction, -1);
    *surface = (struct wd_surface){.place = wd_v3_mad(ray->from, ray->direction, hit->at_m)};
    if (hit->tree < scene->world->tree_count)
        tree_surface(surface, scene, hit, eye, pixel_rad);
    else
        ground_surface(surface, scene, hit, ray->direction, pixel_rad);
    if (wd_v3_dot(surface->flat, eye) < 0)
        surface->flat = wd_v3_scale(surface->flat, -1);
    surface->normal = surface->outward;
    if (wd_v3_dot(surface->normal, surface->flat) < 0)
        surface->normal = wd_v3_scale(surface->normal, -1);
    if (wd_v3_dot(surface->normal, eye) <= 0)
        surface->normal = surface->flat;
    /* two millimetres, and more where floats are coarser than that */
    struct wd_vec3 p = surface->place;
    float farthest_m = fmaxf(fabsf(p.x), fmaxf(fabsf(p.y), fabsf(p.z)));
    surface->offset_m = fmaxf(2e-3f, farthest_m * 1e-6f);
}

struct wd_trace_ray wd_surface_leave(const struct wd_surface *surface, struct wd_vec3 direction)
{
    float side = wd_v3_dot(direction, surface->flat) < 0 ? -surface->offset_m : surface->offset_m;
    return (struct wd_trace_ray){wd_v3_mad(surface->place, surface->flat, side), direction,
                                 INFINITY};
}
