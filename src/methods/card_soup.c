#include "methods/card_soup.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static const uint32_t card_count_comp[] =
#include "card_count.comp.inc"
    ;
static const uint32_t card_scan_comp[] =
#include "card_scan.comp.inc"
    ;
static const uint32_t card_expand_comp[] =
#include "card_expand.comp.inc"
    ;

static const uint32_t card_soup_vert[] =
#include "card_soup.vert.inc"
    ;
static const uint32_t card_soup_frag[] =
#include "card_soup.frag.inc"
    ;
static const uint32_t card_soup_shadow_frag[] =
#include "card_soup_shadow.frag.inc"
    ;
static const uint32_t whole_target_vert[] =
#include "whole_target.vert.inc"
    ;
static const uint32_t card_resolve_frag[] =
#include "card_resolve.frag.inc"
    ;

enum {
    GROUP = 64,
    MAX_CARDS = WD_CARD_BATCH * WD_CARD_VERTICES / 4,
    CORNERS_BYTES = 4 * sizeof(struct wd_card_vertex),
};
static const VkDescriptorType IMAGE = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
static const VkDescriptorType BUFFER = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
static const VkDescriptorType UNIFORM = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;

/* --- pipelines --------------------------------------------------------------------------- */

/* `first`: type of the first binding; the others are storage buffers. */
static bool init_compute(struct wd_pipeline *pipeline, struct wd_gpu *gpu, struct wd_spirv shader,
                         VkDescriptorType first, uint32_t bindings, uint32_t shadow)
{
    struct wd_compute_params params = {
        .shader = shader,
        .bindings = {bindings, {first}},
        .push_size = sizeof(struct wd_card_soup_push),
        .constants = {1, &shadow},
    };
    for (uint32_t i = 1; i < bindings; i++)
        params.bindings.types[i] = BUFFER;
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

static bool init_draw(struct wd_pipeline *pipeline, struct wd_gpu *gpu, enum wd_tree_pass pass)
{
    struct wd_graphics_params params = {
        .vertex = WD_SPIRV(card_soup_vert),
        .fragment = WD_SPIRV(card_soup_frag),
        .vertices = {sizeof(struct wd_card_vertex), 2,
                     {{VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(struct wd_card_vertex, clip)},
                      {VK_FORMAT_R32G32B32_UINT, offsetof(struct wd_card_vertex, layer_lod)}}},
        .bindings = {2, {UNIFORM, IMAGE}},
        .color_count = 1,
        .color_formats = {WD_SURFACE_FORMAT},
        .depth_format = WD_DEPTH_FORMAT,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    if (pass == WD_PASS_SHADOW) {
        params.fragment = (struct wd_spirv)WD_SPIRV(card_soup_shadow_frag);
        params.color_count = 0;
        params.depth_bias_slope = WD_SHADOW_SLOPE;
    }
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

static bool init_resolve(struct wd_pipeline *pipeline, struct wd_gpu *gpu)
{
    const struct wd_graphics_params params = {
        .vertex = WD_SPIRV(whole_target_vert),
        .fragment = WD_SPIRV(card_resolve_frag),
        .bindings = {7, {UNIFORM, IMAGE, IMAGE, BUFFER, BUFFER, IMAGE, IMAGE}},
        .color_count = 3,
        .color_formats = {WD_ALBEDO_FORMAT, WD_NORMAL_FORMAT, WD_SURFACE_FORMAT},
        .depth_format = WD_DEPTH_FORMAT,
        .depth_compare = VK_COMPARE_OP_LESS, /* it lies behind all that has depth */
        .depth_read_only = true,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    return wd_pipeline_init_graphics(pipeline, gpu, &params);
}

bool wd_card_soup_init(struct wd_card_soup *soup, struct wd_gpu *gpu)
{
    const struct wd_buffer_params command = {
        "card draw", sizeof(struct wd_draw_indexed),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, WD_MEMORY_DEVICE};
    *soup = (struct wd_card_soup){0};
    const struct wd_spirv scan = WD_SPIRV(card_scan_comp), count = WD_SPIRV(card_count_comp),
                          expand = WD_SPIRV(card_expand_comp);
    bool ok = init_compute(&soup->scan, gpu, scan, BUFFER, 2, 0) &&
              init_resolve(&soup->resolve, gpu) &&
              wd_buffer_init(&soup->command, gpu, &command);
    for (uint32_t pass = WD_PASS_CAMERA; ok && pass <= WD_PASS_SHADOW; pass++)
        ok = init_compute(&soup->count[pass], gpu, count, UNIFORM, 7, pass == WD_PASS_SHADOW) &&
             init_compute(&soup->expand[pass], gpu, expand, UNIFORM, 9, pass == WD_PASS_SHADOW) &&
             init_draw(&soup->draw[pass], gpu, (enum wd_tree_pass)pass);
    if (!ok)
        wd_card_soup_finish(soup, gpu);
    return ok;
}

void wd_card_soup_finish(struct wd_card_soup *soup, struct wd_gpu *gpu)
{
    wd_image_finish(&soup->visible, gpu);
    wd_buffer_finish(&soup->firsts, gpu);
    wd_buffer_finish(&soup->command, gpu);
    wd_buffer_finish(&soup->cards, gpu);
    wd_buffer_finish(&soup->vertices, gpu);
    free(soup->chunks);
    *soup = (struct wd_card_soup){0};
}

/* --- what goes into it ------------------------------------------------------------------- */

static void add_chunks(struct wd_card_soup *soup, uint32_t begin, uint32_t end, uint32_t slots)
{
    for (uint32_t at = begin; at < end; at += WD_CHUNK_TREES) {
        uint32_t trees = end - at < WD_CHUNK_TREES ? end - at : WD_CHUNK_TREES;
        *wd_push(soup->chunks, soup->chunk_count, soup->chunk_capacity) =
            (struct wd_card_chunk){at, trees | slots << 8};
    }
}

/* Moves ranges into chunks. */
static void take_ranges(struct wd_card_soup *soup, struct wd_selection *selection,
                        enum wd_tree_pass pass, uint32_t most_cards)
{
    size_t taken = 0;
    soup->chunk_count = soup->tree_count = soup->most_cards = 0;
    for (; taken < selection->range_count; taken++) {
        struct wd_range *range = &selection->ranges[taken];
        uint32_t slots = pass == WD_PASS_SHADOW ? 1 : range->card_vertices / 4;
        uint32_t room = (most_cards - soup->most_cards) / slots, trees = range->end - range->begin;
        uint32_t count = trees < room ? trees : room;
        add_chunks(soup, range->begin, range->begin + count, slots);
        soup->most_cards += count * slots;
        soup->tree_count += count;
        range->begin += count;
        if (count < trees)
            break;
    }
    selection->range_count -= taken;
    memmove(selection->ranges, selection->ranges + taken,
            selection->range_count * sizeof *selection->ranges);
}

/* Twice what is needed now: a moving camera seldom asks again. */
static bool make_room(struct wd_buffer *buffer, const struct wd_tree_draw *draw, const char *name,
                      VkDeviceSize count, VkDeviceSize size, VkDeviceSize most)
{
    if (buffer->size >= count * size)
        return true;
    const VkBufferUsageFlags usage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
    const struct wd_buffer_params params = {name, (2 * count < most ? 2 * count : most) * size,
                                            usage, WD_MEMORY_DEVICE};
    wd_cmd_defer_buffer(draw->cmd, buffer);
    return wd_buffer_init(buffer, draw->cmd->gpu, &params);
}

static bool upload(const struct wd_tree_draw *draw, const void *data, size_t size,
                   struct wd_binding *binding)
{
    void *memory = wd_cmd_upload(draw->cmd, size, binding);
    if (memory)
        memcpy(memory, data, size);
    return memory != NULL;
}

static bool upload_planes(const struct wd_tree_draw *draw, struct wd_binding *binding)
{
    const struct wd_frustum *frustum = &draw->view->frustum;
    struct wd_cull_planes planes = {0};
    _Static_assert(WD_CULL_PLANES == WD_FRUSTUM_PLANES, "all planes of a view fit");
    memcpy(planes.plane, frustum->planes, frustum->count * sizeof *frustum->planes);
    for (uint32_t i = frustum->count; i < WD_CULL_PLANES; i++)
        planes.plane[i][3] = 1e9f;
    return upload(draw, &planes, sizeof planes, binding);
}

/* --- recording --------------------------------------------------------------------------- */

static void dispatch(const struct wd_tree_draw *draw, const struct wd_pipeline *pipeline,
                     const struct wd_binding *bindings, const struct wd_card_soup_push *push,
                     uint64_t groups)
{
    wd_cmd_bind(draw->cmd, pipeline, bindings);
    wd_cmd_push(draw->cmd, pipeline, push, sizeof *push);
    wd_cmd_dispatch_1d(draw->cmd, groups);
}

static void record_make(struct wd_card_soup *soup, const struct wd_tree_draw *draw,
                        struct wd_binding planes, struct wd_binding chunks)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_card_soup_push push = {(uint32_t)soup->chunk_count, forest->variants,
                                           draw->view->cascade, draw->view->pixels_per_radian};
    const struct wd_binding trees[] = {draw->uniforms,
                                       WD_BIND_BUFFER(&forest->trees),
                                       WD_BIND_BUFFER(&forest->models),
                                       WD_BIND_BUFFER(&forest->fades),
                                       planes,
                                       chunks,
                                       WD_BIND_BUFFER(&soup->firsts),
                                       WD_BIND_BUFFER(&soup->cards),
                                       WD_BIND_BUFFER(&soup->vertices)};
    const struct wd_binding scan[] = {WD_BIND_BUFFER(&soup->firsts),
                                      WD_BIND_BUFFER(&soup->command)};
    uint64_t groups = (soup->chunk_count + GROUP - 1) / GROUP;
    wd_cmd_use_buffer(draw->cmd, &soup->firsts, WD_USE_COMPUTE_WRITE);
    dispatch(draw, &soup->count[draw->pass], trees, &push, groups);
    wd_cmd_use_buffer(draw->cmd, &soup->firsts, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(draw->cmd, &soup->command, WD_USE_COMPUTE_WRITE);
    dispatch(draw, &soup->scan, scan, &push, 1);
    wd_cmd_use_buffer(draw->cmd, &soup->firsts, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(draw->cmd, &soup->cards, WD_USE_COMPUTE_WRITE);
    wd_cmd_use_buffer(draw->cmd, &soup->vertices, WD_USE_COMPUTE_WRITE);
    dispatch(draw, &soup->expand[draw->pass], trees, &push, groups);
    wd_cmd_use_buffer(draw->cmd, &soup->command, WD_USE_INDIRECT);
    wd_cmd_use_buffer(draw->cmd, &soup->cards, WD_USE_GRAPHICS_READ);
    wd_cmd_use_buffer(draw->cmd, &soup->vertices, WD_USE_GRAPHICS_READ);
    wd_cmd_use_buffer(draw->cmd, &soup->vertices, WD_USE_INDEX);
}

static void record_draw(const struct wd_card_soup *soup, const struct wd_tree_draw *draw)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_pipeline *pipeline = &soup->draw[draw->pass];
    VkSampler sampler =
        draw->pass == WD_PASS_SHADOW ? forest->point_sampler : forest->card_sampler;
    const struct wd_binding bindings[] = {draw->uniforms,
                                          WD_BIND_IMAGE(&forest->card_albedo, sampler)};
    wd_cmd_bind(draw->cmd, pipeline, bindings);
    wd_cmd_bind_vertices(draw->cmd, &soup->vertices);
    wd_cmd_bind_indices(draw->cmd, &forest->card_indices);
    wd_cmd_draw_indexed_indirect(draw->cmd, &soup->command, 0);
}

/* Makes the image fit the picture. */
static bool fit_visible(struct wd_card_soup *soup, const struct wd_tree_draw *draw)
{
    const struct wd_image_params params = {
        .name = "visible cards",
        .format = WD_SURFACE_FORMAT,
        .width = draw->targets->width,
        .height = draw->targets->height,
        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        .by_texel = true,
    };
    if (soup->visible.width == params.width && soup->visible.height == params.height)
        return true;
    wd_cmd_defer_image(draw->cmd, &soup->visible);
    return wd_image_init(&soup->visible, draw->cmd->gpu, &params);
}

/* Depth goes to the G-buffer's own. */
static void record_visible(struct wd_card_soup *soup, const struct wd_tree_draw *draw)
{
    const struct wd_rendering rendering = {
        .width = draw->targets->width,
        .height = draw->targets->height,
        .color_count = 1,
        .color = {{.image = &soup->visible, .load = WD_LOAD_CLEAR}},
        .depth = &draw->targets->depth,
        .depth_load = WD_LOAD_KEEP,
    };
    wd_cmd_begin_rendering(draw->cmd, &rendering);
    record_draw(soup, draw);
    wd_cmd_end_rendering(draw->cmd);
    wd_cmd_use_image(draw->cmd, &soup->visible, WD_USE_GRAPHICS_READ);
}

void wd_card_soup_make(struct wd_card_soup *soup, const struct wd_tree_draw *draw,
                       struct wd_selection *selection)
{
    soup->chunk_count = 0;
    if (!selection->range_count || draw->cmd->failed)
        return;
    take_ranges(soup, selection, draw->pass, draw->forest->quads_a_draw);
    uint32_t cards = soup->most_cards;
    struct wd_binding planes, chunks;
    bool ok = make_room(&soup->firsts, draw, "card counts", soup->chunk_count, sizeof(uint32_t),
                        MAX_CARDS) &&
              make_room(&soup->cards, draw, "cards", cards, sizeof(struct wd_card_flat),
                        MAX_CARDS) &&
              make_room(&soup->vertices, draw, "card vertices", cards, CORNERS_BYTES, MAX_CARDS) &&
              upload_planes(draw, &planes) &&
              upload(draw, soup->chunks, soup->chunk_count * sizeof *soup->chunks, &chunks);
    if (draw->pass == WD_PASS_CAMERA)
        ok = ok && fit_visible(soup, draw);
    if (!ok) {
        draw->cmd->failed = true;
        return;
    }
    record_make(soup, draw, planes, chunks);
    if (draw->pass == WD_PASS_CAMERA)
        record_visible(soup, draw);
}

static void record_resolve(const struct wd_card_soup *soup, const struct wd_tree_draw *draw)
{
    const struct wd_forest_device *forest = draw->forest;
    const struct wd_binding bindings[] = {draw->uniforms,
                                          WD_BIND_IMAGE(&forest->card_albedo, forest->card_sampler),
                                          WD_BIND_IMAGE(&forest->card_normal, forest->point_sampler),
                                          WD_BIND_BUFFER(&soup->cards),
                                          WD_BIND_BUFFER(&soup->vertices),
                                          WD_BIND_IMAGE(&soup->visible, forest->point_sampler),
                                          WD_BIND_IMAGE(&forest->card_leaf, forest->point_sampler)};
    wd_cmd_bind(draw->cmd, &soup->resolve, bindings);
    wd_cmd_draw(draw->cmd, 3, 1);
}

void wd_card_soup_draw(const struct wd_card_soup *soup, const struct wd_tree_draw *draw)
{
    if (!soup->chunk_count || draw->cmd->failed)
        return;
    if (draw->pass == WD_PASS_CAMERA)
        record_resolve(soup, draw);
    else
        record_draw(soup, draw);
    draw->stats->draw_calls++;
    draw->stats->triangles += 2 * (uint64_t)soup->most_cards;
    draw->stats->trees[WD_LEVEL_CARD] += soup->tree_count;
}
