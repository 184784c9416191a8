#include "bake/views.h"

#include <stdlib.h>
#include <string.h>

#include "bake/mixed.h"
#include "bake/pyramid.h"
#include "base/memory.h"

/* Rows that may be asked for: 4,900 views at most. */
enum { MAX_ROWS = 64, MAX_COLUMNS = 360, LEAST_TILE = 8 };

static void fill_in(struct wd_view_set_params *params)
{
    static const struct wd_hemisphere usual[] = {
        {WD_VIEWS_EVEN, 9, 0}, {WD_VIEWS_RINGS, 10, 30}, {WD_VIEWS_OCTAHEDRAL, 12, 0}};
    struct wd_hemisphere *h = &params->hemisphere;
    if (h->kind < sizeof usual / sizeof *usual) {
        h->rows = h->rows ? h->rows : usual[h->kind].rows;
        h->columns = h->columns ? h->columns : usual[h->kind].columns;
    }
    params->size = params->size ? params->size : WD_VIEW_SIZE;
    params->samples = params->samples ? params->samples : 4;
}

static bool check(const struct wd_view_set_params *params, const struct wd_log *log)
{
    const struct wd_hemisphere *h = &params->hemisphere;
    uint32_t least_rows = h->kind == WD_VIEWS_EVEN ? 1 : 2, size = params->size;
    if (h->kind > WD_VIEWS_OCTAHEDRAL)
        return wd_error(log, "view set: layout %u; allowed are 0 even, 1 rings, 2 octahedral",
                        h->kind);
    if (h->rows < least_rows || h->rows > MAX_ROWS)
        return wd_error(log, "view set: %u rows of views; allowed are %u to %d", h->rows,
                        least_rows, MAX_ROWS);
    if (h->kind == WD_VIEWS_RINGS && (h->columns < 3 || h->columns > MAX_COLUMNS))
        return wd_error(log, "view set: %u views a ring; allowed are 3 to %d", h->columns,
                        MAX_COLUMNS);
    if (size < WD_VIEW_SIZE_MIN || size > WD_VIEW_SIZE_MAX || (size & (size - 1)) != 0)
        return wd_error(log, "view set: views of %u texels; allowed are powers of two, %d to %d",
                        size, WD_VIEW_SIZE_MIN, WD_VIEW_SIZE_MAX);
    if (params->samples > WD_VIEW_SAMPLES_MAX)
        return wd_error(log, "view set: %u samples a texel's side; allowed are 1 to %d",
                        params->samples, WD_VIEW_SAMPLES_MAX);
    if (size * params->samples > WD_BAKE_SIDE_MAX)
        return wd_error(log,
                        "view set: %u texels of %u samples a side make %u; allowed are %d", size,
                        params->samples, size * params->samples, WD_BAKE_SIDE_MAX);
    return true;
}

bool wd_view_atlas_init(struct wd_view_atlas *atlas, struct wd_view_set_params *params,
                        const struct wd_gpu *gpu, const struct wd_log *log)
{
    fill_in(params);
    *atlas = (struct wd_view_atlas){0};
    if (!check(params, log))
        return false;
    uint32_t views = wd_hemisphere_count(params->hemisphere), columns = 1, mips = 1;
    while (columns * columns < views)
        columns++;
    while (params->size >> mips >= LEAST_TILE)
        mips++;
    uint32_t limit = gpu->properties.limits.maxImageDimension2D;
    if (columns * params->size > limit)
        return wd_error(log,
                        "view set: %u views of %u texels make a layer of %u texels a side, "
                        "%s has %u: use fewer or smaller views",
                        views, params->size, columns * params->size, gpu->properties.deviceName,
                        limit);
    *atlas = (struct wd_view_atlas){params->hemisphere, params->size, columns, mips};
    return true;
}

uint32_t wd_view_layer_size(const struct wd_view_atlas *atlas, uint32_t mip)
{
    return atlas->columns * (atlas->size >> mip);
}

size_t wd_view_mip_offset(const struct wd_view_atlas *atlas, uint32_t mip)
{
    size_t bytes = 0;
    for (uint32_t i = 0; i < mip; i++)
        bytes += (size_t)4 * wd_view_layer_size(atlas, i) * wd_view_layer_size(atlas, i);
    return bytes;
}

size_t wd_view_plane_bytes(const struct wd_view_atlas *atlas)
{
    return wd_view_mip_offset(atlas, atlas->mips);
}

void wd_view_set_finish(struct wd_view_set *set)
{
    for (int plane = 0; plane < WD_PLANES; plane++)
        free(set->planes[plane]);
    *set = (struct wd_view_set){0};
}

static void init_set(struct wd_view_set *set, const struct wd_view_atlas *atlas,
                     const struct wd_view_model *model)
{
    *set = (struct wd_view_set){.atlas = *atlas, .model = *model};
    for (int plane = 0; plane < WD_PLANES; plane++)
        set->planes[plane] = wd_alloc(wd_view_plane_bytes(atlas));
}

/* The picture that wd_view_project describes. */
static struct wd_bake_shot shot_of(const struct wd_view_frame *frame, float samples)
{
    float x = 0.5f * samples / frame->half_width_m, y = -0.5f * samples / frame->half_height_m;
    float depth = 0.5f / frame->half_depth_m;
    return (struct wd_bake_shot){
        .x = {frame->right.x * x, frame->right.y * x, 0.0f, 0.5f * samples},
        .y = {frame->up.x * y, frame->up.y * y, frame->up.z * y,
              0.5f * samples - frame->up.z * y * frame->middle_m},
        .depth = {frame->toward.x * depth, frame->toward.y * depth, frame->toward.z * depth,
                  0.5f - frame->toward.z * depth * frame->middle_m},
    };
}

/* A set while it is baked, and what tells wood and leaves apart of each view: by texels of twice the finest's size. */
enum { MIXED_MIP = 1 };
struct baked_set {
    struct wd_view_set *set;
    struct wd_mixed_sums *mixed;
};

static void take_view(void *user, uint32_t view, const struct wd_bake_picture *picture)
{
    const struct baked_set *baked = user;
    const struct wd_view_set *set = baked->set;
    const struct wd_view_atlas *atlas = &set->atlas;
    struct wd_pyramid pyramid;
    wd_pyramid_init(&pyramid, atlas->size, atlas->size, atlas->mips);
    wd_pyramid_set(&pyramid, picture->planes);
    wd_pyramid_tell_mixed(&pyramid, atlas->mips > MIXED_MIP ? MIXED_MIP : 0, picture->leaves, &baked->mixed[view]);
    for (uint32_t mip = 0; mip < atlas->mips; mip++) {
        size_t stride = (size_t)4 * wd_view_layer_size(atlas, mip), tile = atlas->size >> mip;
        size_t at = wd_view_mip_offset(atlas, mip) + view / atlas->columns * tile * stride +
                    view % atlas->columns * tile * 4;
        for (int plane = 0; plane < WD_PLANES; plane++)
            wd_pyramid_get(&pyramid, mip, plane, set->planes[plane] + at, stride);
    }
    wd_pyramid_finish(&pyramid);
}

bool wd_view_set_bake(struct wd_view_set *set, struct wd_baker *baker,
                      const struct wd_bake_mesh *mesh, const struct wd_view_model *model,
                      const struct wd_view_atlas *atlas, const struct wd_view_set_params *params)
{
    uint32_t views = wd_hemisphere_count(atlas->hemisphere);
    struct wd_bake_shot *shots = wd_alloc_array(views, sizeof *shots);
    for (uint32_t i = 0; i < views; i++) {
        struct wd_view_frame frame =
            wd_view_frame_of(*model, wd_hemisphere_direction(atlas->hemisphere, i));
        shots[i] = shot_of(&frame, (float)(atlas->size * params->samples));
    }
    const struct wd_bake_job job = {
        .mesh = *mesh,
        .parts = params->parts,
        .shots = shots,
        .shot_count = views,
        .width = atlas->size,
        .height = atlas->size,
        .samples = params->samples,
    };
    init_set(set, atlas, model);
    struct baked_set baked = {set, wd_alloc_array(views, sizeof *baked.mixed)};
    bool ok = wd_baker_run(baker, &job, take_view, &baked);
    if (ok)
        set->model.mixed = wd_mixed_ratios(baked.mixed, views);
    free(baked.mixed);
    free(shots);
    if (!ok)
        wd_view_set_finish(set);
    return ok;
}

/* --- cache ------------------------------------------------------------------------------- */

static uint64_t set_key(const struct wd_view_set_params *params, const struct wd_view_model *model,
                        uint64_t model_key)
{
    const struct wd_hemisphere *h = &params->hemisphere;
    const uint32_t form[] = {h->kind, h->rows, h->columns, params->size, params->samples,
                             (uint32_t)params->parts};
    const float bounds[] = {model->radius_m, model->bottom_m, model->top_m};
    uint64_t key = wd_cache_key(wd_cache_code_key(), &model_key, sizeof model_key);
    return wd_cache_key(wd_cache_key(key, form, sizeof form), bounds, sizeof bounds);
}

bool wd_view_set_load(struct wd_view_set *set, const struct wd_view_atlas *atlas,
                      const struct wd_view_set_name *name)
{
    size_t plane = wd_view_plane_bytes(atlas), bytes = WD_PLANES * plane + sizeof set->model.mixed, size;
    uint64_t key = set_key(name->params, name->model, name->model_key);
    uint8_t *block = wd_cache_load(name->cache, "views", key, bytes, &size);
    bool found = block && size == bytes;
    *set = (struct wd_view_set){0};
    if (found) {
        init_set(set, atlas, name->model);
        for (int i = 0; i < WD_PLANES; i++)
            memcpy(set->planes[i], block + (size_t)i * plane, plane);
        set->model.mixed = wd_cache_get_word(block + WD_PLANES * plane, 0);
    }
    free(block);
    return found;
}

void wd_view_set_store(const struct wd_view_set *set, const struct wd_view_set_name *name)
{
    size_t plane = wd_view_plane_bytes(&set->atlas);
    size_t bytes = WD_PLANES * plane + sizeof set->model.mixed;
    uint8_t *block = wd_alloc(bytes);
    for (int i = 0; i < WD_PLANES; i++)
        memcpy(block + (size_t)i * plane, set->planes[i], plane);
    wd_cache_put_word(block + WD_PLANES * plane, 0, set->model.mixed);
    wd_cache_store(name->cache, "views", set_key(name->params, name->model, name->model_key), block, bytes);
    free(block);
}
