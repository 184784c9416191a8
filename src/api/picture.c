#include "api/renderer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/shown.h"
#include "base/color.h"

void wd_picture_finish(struct wd_picture *picture)
{
    if (!picture)
        return;
    free(picture->display);
    free(picture->color);
    free(picture->depth_m);
    free(picture->normal);
    free(picture->albedo);
    free(picture->species);
    free(picture->tree_id);
    free(picture->velocity_px);
    free(picture->rank_tree);
    free(picture->rank_share);
    free(picture->about);
    *picture = (struct wd_picture){0};
}

/* Reads a target of `texel` bytes a pixel. */
static bool read_into(struct wd_renderer *renderer, struct wd_image *image, size_t texel, void *data)
{
    size_t size = (size_t)image->width * image->height * texel;
    return wd_image_read(&renderer->gpu, image, 0, 0, data, size);
}

/* The same into memory of its own, to be freed; NULL on failure. */
static void *read_target(struct wd_renderer *renderer, struct wd_image *image, size_t texel)
{
    void *data = wd_picture_try_scratch(image->width, image->height, texel, &renderer->log);
    renderer->no_memory |= !data;
    if (data && read_into(renderer, image, texel, data))
        return data;
    free(data);
    return NULL;
}

static bool read_color(struct wd_picture *picture, struct wd_renderer *renderer, size_t pixels)
{
    float *sum = read_target(renderer, &renderer->frame.targets.radiance, 16);
    if (!sum)
        return false;
    float share = 1.0f / (float)renderer->frame.params.samples;
    for (size_t i = 0; i < pixels; i++) {
        for (int k = 0; k < 3; k++)
            picture->color[3 * i + k] = sum[4 * i + k] * share;
    }
    free(sum);
    return true;
}

static bool read_depth(struct wd_picture *picture, struct wd_renderer *renderer, size_t pixels)
{
    if (!read_into(renderer, &renderer->frame.targets.depth, 4, picture->depth_m))
        return false;
    for (size_t i = 0; i < pixels; i++) {
        float reversed = picture->depth_m[i];
        picture->depth_m[i] = reversed > 0.0f ? renderer->frame.near_m / reversed : INFINITY;
    }
    return true;
}

/* As shaders/lib/disc.glsl has it: folded to an octahedron. */
static void unfold(float normal[3])
{
    float x = normal[0], y = normal[1], z = 1.0f - fabsf(x) - fabsf(y), below = fmaxf(-z, 0.0f);
    normal[0] = x + (x < 0.0f ? below : -below);
    normal[1] = y + (y < 0.0f ? below : -below);
    normal[2] = z;
}

/* A2B10G10R10: R in the low bits. Where nothing was drawn the target is 0 and so is the normal. */
static bool read_normal(struct wd_picture *picture, struct wd_renderer *renderer, size_t pixels)
{
    struct wd_rays rays;
    wd_rays_init(&rays, &renderer->frame.params.camera, picture->width, picture->height);
    uint32_t *packed = read_target(renderer, &renderer->frame.targets.normal, 4);
    uint32_t *surface = read_target(renderer, &renderer->frame.targets.surface, 4);
    if (!packed || !surface) {
        free(packed);
        free(surface);
        return false;
    }
    for (size_t i = 0; i < pixels; i++) {
        float normal[3], squared = 0.0f;
        for (int k = 0; k < 3; k++)
            normal[k] = (float)(packed[i] >> (10 * k) & 1023u) / 511.5f - 1.0f;
        if (packed[i] >> 30 == WD_MATERIAL_GROUND && surface[i] != 0)
            unfold(normal);
        for (int k = 0; k < 3; k++)
            squared += normal[k] * normal[k];
        float scale = (packed[i] & 0x3fffffffu) && squared > 0.0f ? 1.0f / sqrtf(squared) : 0.0f;
        struct wd_vec3 seen = wd_normal_seen(wd_v3_scale(wd_v3_of(normal), scale),
                                             wd_ray_through(&rays, (uint32_t)i % picture->width,
                                                            (uint32_t)(i / picture->width)),
                                             packed[i] >> 30 >= WD_MATERIAL_LEAF);
        memcpy(picture->normal + 3 * i, &seen, sizeof seen);
    }
    free(packed);
    free(surface);
    return true;
}

static bool read_albedo(struct wd_picture *picture, struct wd_renderer *renderer, size_t pixels)
{
    uint8_t *bytes = read_target(renderer, &renderer->frame.targets.albedo, 4);
    if (!bytes)
        return false;
    for (size_t i = 0; i < pixels * 3; i++)
        picture->albedo[i] = wd_srgb_decode(bytes[i / 3 * 4 + i % 3]);
    free(bytes);
    return true;
}

static bool read_velocity(struct wd_picture *picture, struct wd_renderer *renderer, size_t pixels)
{
    size_t size = pixels * 2 * sizeof(float);
    return wd_buffer_read(&renderer->gpu, &renderer->frame.velocity_px, 0, picture->velocity_px,
                          size);
}

/* The tree found last: pixels side by side mostly show the same. */
struct last_tree {
    uint32_t surface; /* that it was found by; 0: none yet */
    struct wd_tree tree;
};

/* The tree that a pixel of the surface target shows, which is its record + 1; NULL: none. */
static const struct wd_tree *tree_seen(struct last_tree *last, const struct wd_renderer *renderer,
                                       uint32_t surface)
{
    if (surface && surface != last->surface)
        last->surface = wd_forest_tree_at(&renderer->device, surface - 1, &last->tree) ? surface : 0;
    return surface && surface == last->surface ? &last->tree : NULL;
}

static bool read_trees(struct wd_picture *picture, struct wd_renderer *renderer, size_t pixels)
{
    struct last_tree last = {0};
    uint32_t *surface = read_target(renderer, &renderer->frame.targets.surface, 4);
    if (!surface)
        return false;
    for (size_t i = 0; i < pixels; i++) {
        const struct wd_tree *tree = tree_seen(&last, renderer, surface[i]);
        if (tree && picture->species)
            picture->species[i] = WD_TREE_SPECIES(*tree) + 1;
        if (tree && picture->tree_id)
            picture->tree_id[i] = tree->id;
    }
    free(surface);
    return true;
}

bool wd_picture_count_trees(struct wd_renderer *renderer)
{
    struct wd_coverage *coverage = &renderer->coverage;
    if (!wd_frames_wait(&renderer->frame.ring))
        return false;
    struct last_tree last = {0};
    uint32_t *surface = read_target(renderer, &renderer->frame.targets.surface, 4);
    if (!surface)
        return false;
    for (size_t i = 0; i < coverage->pixels; i++) {
        const struct wd_tree *tree = tree_seen(&last, renderer, surface[i]);
        if (tree)
            wd_coverage_add(coverage, i, tree->id);
    }
    free(surface);
    return true;
}

bool wd_picture_read(struct wd_picture *picture, struct wd_renderer *renderer, uint32_t layers)
{
    struct wd_targets *targets = &renderer->frame.targets;
    size_t pixels = (size_t)targets->width * targets->height;
    if (layers & WD_LAYER_CRYPTOMATTE)
        wd_coverage_rank(&renderer->coverage, renderer->frame.params.samples, picture);
    if (layers & WD_LAYER_DISPLAY && !read_into(renderer, &targets->display, 4, picture->display))
        return false;
    return (!(layers & WD_LAYER_VELOCITY) || read_velocity(picture, renderer, pixels)) &&
           (!(layers & WD_LAYER_COLOR) || read_color(picture, renderer, pixels)) &&
           (!(layers & WD_LAYER_DEPTH) || read_depth(picture, renderer, pixels)) &&
           (!(layers & WD_LAYER_NORMAL) || read_normal(picture, renderer, pixels)) &&
           (!(layers & WD_LAYER_ALBEDO) || read_albedo(picture, renderer, pixels)) &&
           (!(layers & (WD_LAYER_SPECIES | WD_LAYER_TREE_ID)) ||
            read_trees(picture, renderer, pixels));
}
