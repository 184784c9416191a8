#include "forest/octant_pictures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/memory.h"
#include "forest/model_bakes.h"

static const uint32_t bake_octant_vert[] =
#include "bake_octant.vert.inc"
    ;
static const uint32_t bake_octant_frag[] =
#include "bake_octant.frag.inc"
    ;

/* Rendered at once: at most so many entries, and a square of pixels that any device allows. */
enum { ATLAS_PIXELS = 2048, MAX_ENTRIES = 1 << 19, ENTRY_VERTICES = 6 };

/* --- means ------------------------------------------------------------------------------- */

static uint32_t mixed_of(const struct wd_octant_mean *mean)
{
    const float all[WD_MIXED_KINDS] = {mean->color[0], mean->color[1], mean->color[2], mean->openness};
    const float few = 0.004f * mean->coverage, wood = mean->coverage - mean->leaf;
    uint32_t packed = 0;
    if (wood < few || mean->leaf < few)
        return WD_MIXED_EVEN;
    for (uint32_t k = 0; k < WD_MIXED_KINDS; k++) {
        float leaf = fmaxf(mean->leaves[k] / mean->leaf, 1e-4f), rest = fmaxf(all[k] - mean->leaves[k], 0);
        packed |= wd_mixed_byte(rest / wood / leaf) << (8 * k);
    }
    return packed;
}

struct wd_octant_mean wd_octant_mean_of(const struct wd_octant_look *look, uint32_t side)
{
    uint32_t color = look->color[side], normal = look->normal[side];
    uint32_t leaf = look->leaf[side / 4] >> (8 * (side % 4)) & 0xffu;
    struct wd_octant_mean mean = {.coverage = wd_octant_coverage(color)};
    for (int k = 0; k < 3; k++) {
        mean.color[k] = mean.coverage * wd_srgb_decode((uint8_t)(color >> (8 * k)));
        mean.normal[k] = mean.coverage * ((float)(normal >> (8 * k) & 0xffu) / 127.5f - 1.0f);
    }
    mean.openness = mean.coverage * (float)(normal >> 24) / 255.0f;
    mean.leaf = mean.coverage * (float)leaf / 255.0f;
    for (uint32_t k = 0; k < WD_MIXED_KINDS; k++) {
        float all = k < 3 ? mean.color[k] : mean.openness, share = (float)leaf / 255.0f;
        mean.leaves[k] = share * wd_mixed_leaf(all, share, wd_mixed_ratio(look->mixed[side], k));
    }
    return mean;
}

void wd_octant_mean_pack(const struct wd_octant_mean *mean, struct wd_octant_look *look,
                         uint32_t side)
{
    uint32_t *color = &look->color[side], *normal = &look->normal[side], at = 8 * (side % 4);
    *color = *normal = look->mixed[side] = 0;
    look->leaf[side / 4] &= ~(0xffu << at);
    uint32_t root = wd_unorm_encode(sqrtf(mean->coverage));
    if (root == 0)
        return;
    float scale = 1.0f / mean->coverage;
    for (int k = 0; k < 3; k++) {
        *color |= (uint32_t)wd_srgb_encode(mean->color[k] * scale) << (8 * k);
        *normal |= (uint32_t)wd_unorm_encode(mean->normal[k] * scale * 0.5f + 0.5f) << (8 * k);
    }
    *color |= root << 24;
    *normal |= (uint32_t)wd_unorm_encode(mean->openness * scale) << 24;
    look->mixed[side] = mixed_of(mean);
    look->leaf[side / 4] |= (uint32_t)wd_unorm_encode(mean->leaf * scale) << at;
}

static float leaf_of(float opacity)
{
    const float wood = (float)WD_OCTANT_SHOWN;
    return fmaxf(opacity - wood, 0.0f) / (1.0f - wood);
}

/* Of a square of pixels whose least is (x, y). */
static struct wd_octant_mean mean_of_pixels(const struct wd_octant_pictures *p, size_t x, size_t y)
{
    struct wd_octant_mean sum = {0};
    const float *linear = wd_srgb_table();
    float weight = 1.0f / (float)(p->pixels * p->pixels);
    for (size_t row = y; row < y + p->pixels; row++) {
        for (size_t column = x; column < x + p->pixels; column++) {
            const uint8_t *albedo = p->albedo_bytes + 4 * (row * ATLAS_PIXELS + column);
            const uint8_t *normal = p->normal_bytes + 4 * (row * ATLAS_PIXELS + column);
            if (albedo[3] == 0)
                continue;
            for (int k = 0; k < 3; k++) {
                sum.color[k] += weight * linear[albedo[k]];
                sum.normal[k] += weight * ((float)normal[k] / 127.5f - 1.0f);
            }
            float openness = weight * (float)normal[3] / 255.0f, leaf = leaf_of((float)albedo[3] / 255.0f);
            for (int k = 0; k < 3; k++)
                sum.leaves[k] += leaf * weight * linear[albedo[k]];
            sum.leaves[3] += leaf * openness;
            sum.openness += openness;
            sum.leaf += weight * leaf;
            sum.coverage += weight;
        }
    }
    return sum;
}

/* --- device ------------------------------------------------------------------------------ */

static bool init_pipeline(struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    const VkDescriptorType table = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType image = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const struct wd_graphics_params params = {
        .vertex = WD_SPIRV(bake_octant_vert),
        .fragment = WD_SPIRV(bake_octant_frag),
        .bindings = {7, {table, table, table, table, image, image, image}},
        .push_size = sizeof(struct wd_octant_push),
        .color_count = 2,
        .color_formats = {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM},
        .depth_format = VK_FORMAT_D32_SFLOAT,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

static bool init_atlas(struct wd_octant_pictures *p)
{
    struct wd_image_params image = {"octant albedo", VK_FORMAT_R8G8B8A8_SRGB, ATLAS_PIXELS,
                                    ATLAS_PIXELS, 1, 1, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, 0};
    bool ok = wd_image_init(&p->albedo, p->gpu, &image);
    image.name = "octant normal";
    image.format = VK_FORMAT_R8G8B8A8_UNORM;
    ok = ok && wd_image_init(&p->normal, p->gpu, &image);
    image.name = "octant depth";
    image.format = VK_FORMAT_D32_SFLOAT;
    image.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    return ok && wd_image_init(&p->depth, p->gpu, &image);
}

bool wd_octant_pictures_init(struct wd_octant_pictures *p, struct wd_gpu *gpu,
                             struct wd_forest_device *forest)
{
    struct wd_image *planes[WD_PLANES] = {[WD_PLANE_DEPTH] = &p->card_depth};
    p->gpu = gpu;
    p->forest = forest;
    p->columns = ATLAS_PIXELS / (p->cells * p->pixels);
    p->albedo_bytes = wd_alloc((size_t)4 * ATLAS_PIXELS * ATLAS_PIXELS);
    p->normal_bytes = wd_alloc((size_t)4 * ATLAS_PIXELS * ATLAS_PIXELS);
    bool ok = wd_frames_init(&p->frames, gpu) && init_pipeline(&p->pipeline, gpu) &&
              init_atlas(p) && wd_forest_make_cards(forest, gpu) &&
              wd_forest_bake_cards(forest, gpu, WD_BAKE_ALL, planes, WD_CARD_DEPTH_ALL);
    if (!ok)
        wd_octant_pictures_finish(p);
    return ok;
}

void wd_octant_pictures_finish(struct wd_octant_pictures *p)
{
    if (!p->gpu)
        return;
    struct wd_image *images[] = {&p->albedo, &p->normal, &p->depth, &p->card_depth};
    wd_frames_finish(&p->frames);
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        wd_image_finish(images[i], p->gpu);
    free(p->albedo_bytes);
    free(p->normal_bytes);
    free(p->pictures);
    free(p->owners);
    free(p->entries);
    *p = (struct wd_octant_pictures){0};
}

/* --- pictures ---------------------------------------------------------------------------- */

/* Whether a tree reaches into a slice, seen along the side's axis. */
static bool touches(const struct wd_octant_cube *cube, uint32_t side, uint32_t slice,
                    uint32_t slices, const float min_m[3], const float max_m[3])
{
    uint32_t axis = side / 2, from_least = side % 2 == 0 ? slice : slices - 1 - slice;
    float step_m = cube->size_m / (float)slices;
    float low = cube->min_m[axis] + step_m * (float)from_least;
    for (uint32_t k = 0; k < 3; k++)
        if (k != axis && (max_m[k] < cube->min_m[k] || min_m[k] > cube->min_m[k] + cube->size_m))
            return false;
    return max_m[axis] >= low && min_m[axis] <= low + step_m;
}

static void add_picture(struct wd_octant_pictures *p, const struct wd_octant_cube *cube,
                        uint32_t side, uint32_t slice)
{
    struct wd_octant_picture picture = {
        .size_m = cube->size_m,
        .side = side,
        .slice = slice,
        .slices = p->cells,
        .tile = (uint32_t)p->picture_count,
    };
    for (int k = 0; k < 3; k++)
        picture.corner_mm[k] = (int32_t)lround((double)cube->min_m[k] * 1000.0);
    p->owners = wd_grow(p->owners, p->picture_count, &p->owner_capacity, sizeof *p->owners);
    p->owners[p->picture_count] = cube->owner;
    *wd_push(p->pictures, p->picture_count, p->picture_capacity) = picture;
}

bool wd_octant_pictures_add(struct wd_octant_pictures *p, const struct wd_octant_cube *cube,
                            const uint32_t *trees, size_t tree_count)
{
    for (uint32_t at = 0; at < WD_OCTANT_SIDES * p->cells; at++) {
        uint32_t side = at / p->cells, slice = at % p->cells;
        if ((p->picture_count == p->columns * p->columns || p->entry_count > MAX_ENTRIES) &&
            !wd_octant_pictures_flush(p))
            return false;
        uint32_t picture = (uint32_t)p->picture_count;
        size_t before = p->entry_count;
        for (size_t i = 0; i < tree_count; i++) {
            float min_m[3], max_m[3];
            wd_tree_bounds(&p->forest->world->trees[trees[i]], min_m, max_m);
            if (touches(cube, side, slice, p->cells, min_m, max_m))
                *wd_push(p->entries, p->entry_count, p->entry_capacity) =
                    (struct wd_octant_entry){trees[i], picture};
        }
        if (p->entry_count > before)
            add_picture(p, cube, side, slice);
    }
    return true;
}

static void record(struct wd_octant_pictures *p, struct wd_cmd *cmd)
{
    struct wd_forest_device *forest = p->forest;
    struct wd_binding pictures, entries;
    size_t picture_bytes = p->picture_count * sizeof *p->pictures;
    size_t entry_bytes = p->entry_count * sizeof *p->entries;
    void *to = wd_cmd_upload(cmd, picture_bytes, &pictures);
    if (to)
        memcpy(to, p->pictures, picture_bytes);
    to = wd_cmd_upload(cmd, entry_bytes, &entries);
    if (to)
        memcpy(to, p->entries, entry_bytes);
    const struct wd_binding bindings[] = {
        WD_BIND_BUFFER(&forest->trees),
        WD_BIND_BUFFER(&forest->models),
        pictures,
        entries,
        WD_BIND_IMAGE(&forest->card_albedo, forest->card_sampler),
        WD_BIND_IMAGE(&forest->card_normal, forest->card_sampler),
        WD_BIND_IMAGE(&p->card_depth, forest->card_sampler)};
    /* whole tiles: the atlas may have room for a part of one more */
    uint32_t side = p->columns * p->cells * p->pixels;
    const struct wd_rendering rendering = {
        .width = side,
        .height = side,
        .color_count = 2,
        .color = {{.image = &p->albedo, .load = WD_LOAD_CLEAR},
                  {.image = &p->normal, .load = WD_LOAD_CLEAR}},
        .depth = &p->depth,
        .depth_load = WD_LOAD_CLEAR,
    };
    const struct wd_octant_push push = {forest->variants, p->cells * p->pixels, p->columns, 0};
    wd_forest_device_use(forest, cmd);
    wd_cmd_use_image(cmd, &p->card_depth, WD_USE_GRAPHICS_READ);
    wd_cmd_begin_rendering(cmd, &rendering);
    wd_cmd_bind(cmd, &p->pipeline, bindings);
    wd_cmd_push(cmd, &p->pipeline, &push, sizeof push);
    wd_cmd_draw(cmd, (uint32_t)p->entry_count * ENTRY_VERTICES, 1);
    wd_cmd_end_rendering(cmd);
}

static void hand_out(struct wd_octant_pictures *p)
{
    struct wd_octant_mean *means = wd_alloc_array((size_t)p->cells * p->cells, sizeof *means);
    size_t tile_pixels = (size_t)p->cells * p->pixels;
    for (size_t i = 0; i < p->picture_count; i++) {
        size_t x = i % p->columns * tile_pixels, y = i / p->columns * tile_pixels;
        for (size_t cell = 0; cell < (size_t)p->cells * p->cells; cell++)
            means[cell] = mean_of_pixels(p, x + cell % p->cells * p->pixels,
                                         y + cell / p->cells * p->pixels);
        p->take(p->user, p->owners[i], &p->pictures[i], means);
    }
    p->renders += (uint32_t)p->picture_count;
    p->picture_count = p->entry_count = 0;
    free(means);
}

bool wd_octant_pictures_flush(struct wd_octant_pictures *p)
{
    const size_t bytes = (size_t)4 * ATLAS_PIXELS * ATLAS_PIXELS;
    struct wd_cmd cmd;
    if (p->picture_count == 0)
        return true;
    if (!wd_frame_begin(&p->frames, &cmd))
        return false;
    record(p, &cmd);
    bool ok = wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE) &&
              wd_frames_wait(&p->frames) &&
              wd_image_read(p->gpu, &p->albedo, 0, 0, p->albedo_bytes, bytes) &&
              wd_image_read(p->gpu, &p->normal, 0, 0, p->normal_bytes, bytes);
    if (ok)
        hand_out(p);
    return ok;
}
