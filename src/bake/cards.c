#include "bake/cards.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/card_filter.h"
#include "base/dmath.h"
#include "base/memory.h"

static const uint32_t bake_card_vert[] =
#include "bake_card.vert.inc"
    ;
static const uint32_t bake_card_frag[] =
#include "bake_card.frag.inc"
    ;

enum {
    RENDER_WIDTH = WD_CARD_WIDTH * WD_CARD_SUPERSAMPLING,
    RENDER_HEIGHT = WD_CARD_HEIGHT * WD_CARD_SUPERSAMPLING,
};

void wd_card_size(uint32_t mip, uint32_t *width, uint32_t *height)
{
    *width = WD_CARD_WIDTH >> mip ? WD_CARD_WIDTH >> mip : 1;
    *height = WD_CARD_HEIGHT >> mip ? WD_CARD_HEIGHT >> mip : 1;
}

size_t wd_card_offset(uint32_t card, uint32_t mip)
{
    size_t one = 0, before = 0;
    for (uint32_t i = 0; i < WD_CARD_MIPS; i++) {
        uint32_t width, height;
        wd_card_size(i, &width, &height);
        if (i == mip)
            before = one;
        one += (size_t)4 * width * height;
    }
    return card * one + (mip < WD_CARD_MIPS ? before : 0);
}

size_t wd_cards_bytes(void)
{
    return wd_card_offset(WD_CARDS, WD_CARD_MIPS);
}

void wd_cards_finish(struct wd_cards *cards)
{
    free(cards->albedo);
    free(cards->normal);
    *cards = (struct wd_cards){0};
}

bool wd_card_baker_init(struct wd_card_baker *baker, struct wd_gpu *gpu, const struct wd_log *log)
{
    *baker = (struct wd_card_baker){.gpu = gpu, .log = log};
    const struct wd_graphics_params pipeline = {
        .vertex = {bake_card_vert, sizeof bake_card_vert, "bake_card.vert"},
        .fragment = {bake_card_frag, sizeof bake_card_frag, "bake_card.frag"},
        .bindings = {2, {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                         VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}},
        .push_size = sizeof(float[16]),
        .color_count = 2,
        .color_formats = {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM},
        .depth_format = VK_FORMAT_D32_SFLOAT,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    struct wd_image_params image = {"card albedo", VK_FORMAT_R8G8B8A8_SRGB, RENDER_WIDTH,
                                    RENDER_HEIGHT, 1, 1, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, 0};
    bool ok = wd_frames_init(&baker->frames, gpu) &&
              wd_pipeline_init_graphics(&baker->pipeline, gpu, &pipeline) &&
              wd_sampler_init(&baker->sampler, gpu, WD_SAMPLER_TRILINEAR_REPEAT) &&
              wd_image_init(&baker->albedo, gpu, &image);
    image.name = "card normal";
    image.format = VK_FORMAT_R8G8B8A8_UNORM;
    ok = ok && wd_image_init(&baker->normal, gpu, &image);
    image.name = "card depth";
    image.format = VK_FORMAT_D32_SFLOAT;
    image.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    ok = ok && wd_image_init(&baker->depth, gpu, &image);
    if (!ok)
        wd_card_baker_finish(baker);
    return ok;
}

void wd_card_baker_finish(struct wd_card_baker *baker)
{
    if (!baker->gpu)
        return;
    wd_frames_finish(&baker->frames);
    wd_pipeline_finish(&baker->pipeline, baker->gpu);
    vkDestroySampler(baker->gpu->device, baker->sampler, NULL);
    wd_image_finish(&baker->albedo, baker->gpu);
    wd_image_finish(&baker->normal, baker->gpu);
    wd_image_finish(&baker->depth, baker->gpu);
    *baker = (struct wd_card_baker){0};
}

/* Card i of the upright ones spans u = (cos a, sin a, 0) and z and is seen from u x z; the level
 * one spans x and y and is seen from above. Depth is reversed: 1 nearest the viewer. */
static void card_matrix(float clip_from_model[4][4], const struct wd_cards *cards, uint32_t card)
{
    memset(clip_from_model, 0, sizeof(float[4][4]));
    float (*m)[4] = clip_from_model;
    m[3][3] = 1.0f;
    if (card == WD_CARD_SIDES) {
        m[0][0] = 1.0f / cards->half_depth_m;
        m[1][1] = -1.0f / cards->half_depth_m;
        m[2][2] = 1.0f / (cards->top_m - cards->bottom_m);
        m[3][2] = -cards->bottom_m * m[2][2];
        return;
    }
    double angle = WD_PI / WD_CARD_SIDES * card;
    float c = (float)wd_dcos(angle), s = (float)wd_dsin(angle);
    float depth = 0.5f / (1.5f * cards->half_depth_m);
    m[0][0] = c / cards->half_width_m;
    m[1][0] = s / cards->half_width_m;
    m[2][1] = -2.0f / (cards->top_m - cards->bottom_m);
    m[3][1] = (cards->top_m + cards->bottom_m) / (cards->top_m - cards->bottom_m);
    m[0][2] = s * depth;
    m[1][2] = -c * depth;
    m[3][2] = 0.5f;
}

/* How far the model reaches from its axis: along a card, and in any direction along x or y. */
static void card_extent(struct wd_cards *cards, const struct wd_tree_mesh *mesh)
{
    float radius_squared = 0.0f, side = 0.0f;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *p = mesh->vertices[i].position_m;
        radius_squared = fmaxf(radius_squared, p[0] * p[0] + p[1] * p[1]);
        side = fmaxf(side, fmaxf(fabsf(p[0]), fabsf(p[1])));
    }
    cards->half_width_m = fmaxf(sqrtf(radius_squared) * 1.01f, 0.01f);
    cards->half_depth_m = fmaxf(side * 1.01f, 0.01f);
    cards->bottom_m = mesh->min_m[2];
    cards->top_m = fmaxf(mesh->max_m[2], mesh->min_m[2] + 0.01f);
}

struct bake {
    struct wd_card_baker *baker;
    struct wd_buffer vertices, indices;
    struct wd_image *looks;
    uint32_t index_count;
};

static bool render_card(struct bake *bake, const struct wd_cards *cards, uint32_t card)
{
    struct wd_card_baker *baker = bake->baker;
    struct wd_cmd cmd;
    if (!wd_frame_begin(&baker->frames, &cmd))
        return false;
    const struct wd_rendering rendering = {
        .width = RENDER_WIDTH,
        .height = RENDER_HEIGHT,
        .color_count = 2,
        .color = {{.image = &baker->albedo, .load = WD_LOAD_CLEAR},
                  {.image = &baker->normal, .load = WD_LOAD_CLEAR}},
        .depth = &baker->depth,
        .depth_load = WD_LOAD_CLEAR,
    };
    const struct wd_binding bindings[] = {WD_BIND_BUFFER(&bake->vertices),
                                          WD_BIND_IMAGE(bake->looks, baker->sampler)};
    float clip_from_model[4][4];
    card_matrix(clip_from_model, cards, card);
    wd_cmd_use_image(&cmd, bake->looks, WD_USE_GRAPHICS_READ);
    wd_cmd_use_buffer(&cmd, &bake->vertices, WD_USE_GRAPHICS_READ);
    wd_cmd_use_buffer(&cmd, &bake->indices, WD_USE_INDEX);
    wd_cmd_begin_rendering(&cmd, &rendering);
    wd_cmd_bind(&cmd, &baker->pipeline, bindings);
    wd_cmd_push(&cmd, &baker->pipeline, clip_from_model, sizeof clip_from_model);
    wd_cmd_bind_indices(&cmd, &bake->indices);
    wd_cmd_draw_indexed(&cmd, &(VkDrawIndexedIndirectCommand){bake->index_count, 1, 0, 0, 0});
    wd_cmd_end_rendering(&cmd);
    return wd_frame_submit(&cmd, VK_NULL_HANDLE, VK_NULL_HANDLE) && wd_frames_wait(&baker->frames);
}

static bool bake_buffers(struct bake *bake, const struct wd_tree_mesh *mesh)
{
    struct wd_gpu *gpu = bake->baker->gpu;
    const struct wd_buffer_params vertices = {"card vertices",
                                              mesh->vertex_count * sizeof *mesh->vertices,
                                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, 0};
    const struct wd_buffer_params indices = {"card indices",
                                             mesh->index_count * sizeof *mesh->indices,
                                             VK_BUFFER_USAGE_INDEX_BUFFER_BIT, 0};
    return wd_buffer_init(&bake->vertices, gpu, &vertices) &&
           wd_buffer_init(&bake->indices, gpu, &indices) &&
           wd_buffer_upload(gpu, &bake->vertices, 0, mesh->vertices, vertices.size) &&
           wd_buffer_upload(gpu, &bake->indices, 0, mesh->indices, indices.size);
}

bool wd_cards_bake(struct wd_cards *cards, struct wd_card_baker *baker,
                   const struct wd_tree_model *model, struct wd_image *looks)
{
    const size_t render_bytes = (size_t)4 * RENDER_WIDTH * RENDER_HEIGHT;
    struct bake bake = {.baker = baker, .looks = looks, .index_count = model->full.index_count};
    uint8_t *albedo = wd_alloc(render_bytes), *normal = wd_alloc(render_bytes);
    *cards = (struct wd_cards){.albedo = wd_alloc(wd_cards_bytes()),
                               .normal = wd_alloc(wd_cards_bytes())};
    card_extent(cards, &model->full);
    bool ok = bake_buffers(&bake, &model->full);
    for (uint32_t card = 0; card < WD_CARDS && ok; card++) {
        ok = render_card(&bake, cards, card) &&
             wd_image_read(baker->gpu, &baker->albedo, 0, 0, albedo, render_bytes) &&
             wd_image_read(baker->gpu, &baker->normal, 0, 0, normal, render_bytes);
        if (ok)
            wd_card_filter(cards, card, albedo, normal);
    }
    wd_buffer_finish(&bake.vertices, baker->gpu);
    wd_buffer_finish(&bake.indices, baker->gpu);
    free(albedo);
    free(normal);
    if (!ok)
        wd_cards_finish(cards);
    return ok;
}
