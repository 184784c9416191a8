#include "raster.h"

#include <math.h>
#include <stdlib.h>

#include "base/color.h"
#include "base/memory.h"
#include "tree/vec.h"

enum { SHADOW_SIZE = 1400 };

void wd_raster_init(struct wd_raster *raster, int width, int height)
{
    size_t count = (size_t)width * (size_t)height;
    *raster = (struct wd_raster){width, height, wd_alloc_array(3 * count, sizeof(float)),
                                 wd_alloc_array(count, sizeof(float)), wd_alloc(count)};
    for (size_t i = 0; i < count; i++)
        raster->depth[i] = -1e30f;
}

void wd_raster_finish(struct wd_raster *raster)
{
    free(raster->rgb);
    free(raster->depth);
    free(raster->covered);
    *raster = (struct wd_raster){0};
}

double wd_raster_coverage(const struct wd_raster *raster)
{
    size_t count = (size_t)raster->width * (size_t)raster->height, covered = 0;
    for (size_t i = 0; i < count; i++)
        covered += raster->covered[i];
    return (double)covered / (double)count;
}

struct camera {
    struct wd_vec3 right, up, toward; /* toward the eye */
    float x, y, scale;
};

static struct camera camera_of(const struct wd_raster_view *view)
{
    float ca = cosf(view->azimuth_rad), sa = sinf(view->azimuth_rad);
    float ce = cosf(view->elevation_rad), se = sinf(view->elevation_rad);
    return (struct camera){WD_V3(-sa, ca, 0), WD_V3(-ca * se, -sa * se, ce),
                           WD_V3(ca * ce, sa * ce, se), view->x, view->y, view->pixels_per_m};
}

static struct wd_vec3 project(const struct camera *camera, const float p[3])
{
    struct wd_vec3 v = WD_V3(p[0], p[1], p[2]);
    return WD_V3(camera->x + camera->scale * wd_v3_dot(v, camera->right),
                 camera->y - camera->scale * wd_v3_dot(v, camera->up),
                 wd_v3_dot(v, camera->toward));
}

struct scan {
    struct wd_vec3 corner[3];
    const struct wd_tree_vertex *vertex[3];
    void (*plot)(void *user, int x, int y, float depth, const float weight[3],
                 const struct wd_tree_vertex *const vertex[3]);
    void *user;
    int width, height;
};

static void scan_triangle(const struct scan *scan)
{
    const struct wd_vec3 *c = scan->corner;
    float area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
    if (fabsf(area) < 1e-12f)
        return;
    int x0 = (int)floorf(fminf(c[0].x, fminf(c[1].x, c[2].x)));
    int x1 = (int)ceilf(fmaxf(c[0].x, fmaxf(c[1].x, c[2].x)));
    int y0 = (int)floorf(fminf(c[0].y, fminf(c[1].y, c[2].y)));
    int y1 = (int)ceilf(fmaxf(c[0].y, fmaxf(c[1].y, c[2].y)));
    for (int y = y0 < 0 ? 0 : y0; y <= y1 && y < scan->height; y++)
        for (int x = x0 < 0 ? 0 : x0; x <= x1 && x < scan->width; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f, w[3];
            w[0] = ((c[1].x - px) * (c[2].y - py) - (c[2].x - px) * (c[1].y - py)) / area;
            w[1] = ((c[2].x - px) * (c[0].y - py) - (c[0].x - px) * (c[2].y - py)) / area;
            w[2] = 1 - w[0] - w[1];
            if (w[0] < 0 || w[1] < 0 || w[2] < 0)
                continue;
            scan->plot(scan->user, x, y, w[0] * c[0].z + w[1] * c[1].z + w[2] * c[2].z, w,
                       scan->vertex);
        }
}

static void scan_mesh(const struct wd_tree_mesh *mesh, const struct camera *camera,
                      struct scan *scan)
{
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        for (int k = 0; k < 3; k++) {
            scan->vertex[k] = &mesh->vertices[mesh->indices[i + (uint32_t)k]];
            scan->corner[k] = project(camera, scan->vertex[k]->position_m);
        }
        scan_triangle(scan);
    }
}

struct painter {
    struct wd_raster *raster;
    const struct wd_raster_looks *looks;
    struct camera sun;
    float *shadow;
    struct wd_vec3 toward_eye;
};

static void plot_shadow(void *user, int x, int y, float depth, const float weight[3],
                        const struct wd_tree_vertex *const vertex[3])
{
    (void)weight, (void)vertex;
    float *shadow = ((struct painter *)user)->shadow;
    float *texel = &shadow[(size_t)y * SHADOW_SIZE + (size_t)x];
    *texel = fmaxf(*texel, depth);
}

static float half_to_float(uint32_t half)
{
    int exponent = (int)(half >> 10 & 31);
    float value = exponent ? ldexpf((float)(1024 + (half & 1023)), exponent - 25) : 0;
    return half & 0x8000 ? -value : value;
}

static void look_up(const struct painter *painter, bool leaf, float u, float v, float rgb[3])
{
    const struct wd_raster_looks *looks = painter->looks;
    uint32_t x = (uint32_t)((u - floorf(u)) * (float)looks->size) % looks->size;
    uint32_t y = (uint32_t)((v - floorf(v)) * (float)looks->size) % looks->size;
    const uint8_t *texel = (leaf ? looks->leaf : looks->bark) + 4 * ((size_t)y * looks->size + x);
    for (int i = 0; i < 3; i++)
        rgb[i] = wd_srgb_decode(texel[i]);
}

static float lit(const struct painter *painter, const float p[3])
{
    struct wd_vec3 s = project(&painter->sun, p);
    float bias = 0.12f, sum = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            int x = (int)s.x + i, y = (int)s.y + j;
            if (x < 0 || y < 0 || x >= SHADOW_SIZE || y >= SHADOW_SIZE)
                sum += 1;
            else
                sum += painter->shadow[(size_t)y * SHADOW_SIZE + (size_t)x] < s.z + bias;
        }
    return sum / 9;
}

static void plot_color(void *user, int x, int y, float depth, const float w[3],
                       const struct wd_tree_vertex *const vertex[3])
{
    static const float sun[3] = {2.6f, 2.45f, 2.2f}, sky[3] = {0.55f, 0.68f, 0.9f};
    struct painter *painter = user;
    size_t at = (size_t)y * (size_t)painter->raster->width + (size_t)x;
    if (depth <= painter->raster->depth[at])
        return;
    painter->raster->depth[at] = depth;
    painter->raster->covered[at] = 1;
    float p[3] = {0}, n[3] = {0}, tint[4] = {0}, u = 0, v = 0, rgb[3], one[3];
    for (int k = 0; k < 3; k++) {
        wd_unpack_normal(vertex[k]->normal, one);
        u += w[k] * half_to_float(vertex[k]->uv & 0xffff);
        v += w[k] * half_to_float(vertex[k]->uv >> 16);
        for (int i = 0; i < 3; i++) {
            p[i] += w[k] * vertex[k]->position_m[i];
            n[i] += w[k] * one[i];
        }
        for (int i = 0; i < 4; i++)
            tint[i] += w[k] * (float)(vertex[k]->tint >> (8 * i) & 255) / 255;
    }
    bool leaf = vertex[0]->kind & WD_VERTEX_LEAF;
    look_up(painter, leaf, u, v, rgb);
    struct wd_vec3 normal = wd_v3_unit(WD_V3(n[0], n[1], n[2]));
    float cosine = wd_v3_dot(normal, painter->sun.toward), direct = lit(painter, p);
    for (int i = 0; i < 3; i++) {
        float albedo = rgb[i] * tint[i], through = 0;
        if (leaf)
            through = painter->looks->species->leaf.transmittance[i] * fmaxf(0.25f - cosine, 0);
        float light = sun[i] * direct * (albedo * fmaxf(cosine, leaf ? 0.12f : 0) + through);
        light += sky[i] * tint[3] * (0.55f + 0.45f * normal.z) * albedo + 0.04f * albedo;
        painter->raster->rgb[3 * at + (size_t)i] = light;
    }
}

static struct camera sun_camera(const struct wd_tree_mesh *mesh, const struct camera *eye)
{
    float tall = mesh->max_m[2], wide = mesh->max_m[0] - mesh->min_m[0];
    float reach = sqrtf(tall * tall + wide * wide);
    struct wd_vec3 toward = wd_v3_unit(WD_V3(0.55f * eye->toward.x - 0.75f * eye->right.x,
                                             0.55f * eye->toward.y - 0.75f * eye->right.y, 1.05f));
    struct wd_vec3 right = wd_v3_side(toward), up = wd_v3_cross(toward, right);
    if (up.z < 0)
        up = wd_v3_scale(up, -1);
    return (struct camera){right, up, toward, 0.5f * SHADOW_SIZE, 0.8f * SHADOW_SIZE,
                           0.8f * SHADOW_SIZE / reach};
}

void wd_raster_tree(struct wd_raster *raster, const struct wd_tree_mesh *mesh,
                    const struct wd_raster_looks *looks, const struct wd_raster_view *view)
{
    struct camera eye = camera_of(view);
    struct painter painter = {raster, looks, sun_camera(mesh, &eye), NULL, eye.toward};
    size_t count = (size_t)SHADOW_SIZE * SHADOW_SIZE;
    painter.shadow = wd_alloc_array(count, sizeof(float));
    for (size_t i = 0; i < count; i++)
        painter.shadow[i] = -1e30f;
    struct scan shadow = {.plot = plot_shadow, .user = &painter, .width = SHADOW_SIZE,
                          .height = SHADOW_SIZE};
    scan_mesh(mesh, &painter.sun, &shadow);
    struct scan color = {.plot = plot_color, .user = &painter, .width = raster->width,
                         .height = raster->height};
    scan_mesh(mesh, &eye, &color);
    free(painter.shadow);
}

static void plot_cover(void *user, int x, int y, float depth, const float weight[3],
                       const struct wd_tree_vertex *const vertex[3])
{
    (void)depth, (void)weight, (void)vertex;
    struct wd_raster *raster = user;
    raster->covered[(size_t)y * (size_t)raster->width + (size_t)x] = 1;
}

void wd_raster_silhouette(struct wd_raster *raster, const struct wd_tree_mesh *mesh,
                          const struct wd_raster_view *view)
{
    struct camera eye = camera_of(view);
    struct scan cover = {.plot = plot_cover, .user = raster, .width = raster->width,
                         .height = raster->height};
    scan_mesh(mesh, &eye, &cover);
}
