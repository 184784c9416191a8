#include "methods/continuum_pipelines.h"

static const uint32_t cull_comp[] =
#include "continuum_cull.comp.inc"
    ;
static const uint32_t args_comp[] =
#include "continuum_args.comp.inc"
    ;
static const uint32_t pyramid_comp[] =
#include "continuum_pyramid.comp.inc"
    ;
static const uint32_t select_comp[] =
#include "continuum_select.comp.inc"
    ;
static const uint32_t sort_comp[] =
#include "continuum_sort.comp.inc"
    ;
static const uint32_t splat_comp[] =
#include "continuum_splat.comp.inc"
    ;
static const uint32_t splat_twice_comp[] =
#include "continuum_splat_twice.comp.inc"
    ;
static const uint32_t wood_comp[] =
#include "continuum_wood.comp.inc"
    ;
static const uint32_t wood_twice_comp[] =
#include "continuum_wood_twice.comp.inc"
    ;
static const uint32_t depth_vert[] =
#include "continuum_depth.vert.inc"
    ;
static const uint32_t resolve_vert[] =
#include "continuum_resolve.vert.inc"
    ;
static const uint32_t depth_frag[] =
#include "continuum_depth.frag.inc"
    ;
static const uint32_t resolve_frag[] =
#include "continuum_resolve.frag.inc"
    ;
static const uint32_t resolve_comp[] =
#include "continuum_resolve.comp.inc"
    ;
static const uint32_t cascade_comp[] =
#include "continuum_cascade.comp.inc"
    ;
static const uint32_t cascade_store_comp[] =
#include "continuum_cascade_store.comp.inc"
    ;

#define BUFFER VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
#define UNIFORM VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
#define TEXELS VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
#define STORED VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
#define STORED_TEXELS VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER

/* llvmpipe's subgroups are 8 wide; a wider group only idles on small trees. */
static uint32_t threads_of(const struct wd_gpu *gpu)
{
    return gpu->software ? 8 : 64;
}

/* That draw a small tree together; and groups that draw an item of wood. */
static uint32_t lanes_of(const struct wd_gpu *gpu)
{
    return gpu->features & WD_GPU_FEATURE_MANY_LANES ? 8 : 1;
}

enum large { LARGE_AS_ALL, LARGE_LISTED, LARGE_ALONE }; /* lib/wood_draw.glsl */

struct draw_kind {
    uint32_t shape, pass, ids; /* WD_SHAPE_*: of splats as lib/splat_draw.glsl numbers whose they are */
    enum large large;
};

static bool init_draw(struct wd_pipeline *pipeline, struct wd_gpu *gpu, const struct draw_kind *kind)
{
    const struct wd_spirv shaders[WD_SHAPES][2] = {
        {WD_SPIRV(splat_twice_comp), WD_SPIRV(splat_comp)},
        {WD_SPIRV(splat_twice_comp), WD_SPIRV(splat_comp)},
        {WD_SPIRV(splat_twice_comp), WD_SPIRV(splat_comp)},
        {WD_SPIRV(wood_twice_comp), WD_SPIRV(wood_comp)}};
    bool once = gpu->features & WD_GPU_FEATURE_INT64_ATOMICS && kind->pass == WD_PASS_CAMERA;
    const uint32_t constants[] = {threads_of(gpu), kind->pass == WD_PASS_SHADOW, kind->ids,
                                  kind->shape, gpu->runs, lanes_of(gpu),
                                  kind->large};
    const struct wd_compute_params params = {
        .shader = shaders[kind->shape][once],
        .bindings = {9, {UNIFORM, BUFFER, TEXELS, TEXELS, TEXELS, BUFFER, TEXELS, STORED_TEXELS,
                         BUFFER}},
        .constants = {7, constants},
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

static bool init_draws(struct wd_continuum_pipelines *p, struct wd_gpu *gpu)
{
    bool wide = gpu->features & WD_GPU_FEATURE_INT64_ATOMICS;
    bool many = gpu->features & WD_GPU_FEATURE_MANY_LANES;
    for (uint32_t i = 0; i < WD_SHAPES * 2 * 2; i++) {
        struct draw_kind kind = {.shape = i / 4, .pass = i / 2 % 2, .ids = i % 2};
        bool twice = !wide && kind.pass == WD_PASS_CAMERA;
        bool lists = kind.shape == WD_SHAPE_WOOD && !twice && many;
        bool apart = kind.shape == WD_SHAPE_SPLATS || kind.shape == WD_SHAPE_SMALL;
        if ((kind.ids && !twice) || (many ? apart : kind.shape == WD_SHAPE_BOTH))
            continue;
        kind.large = lists ? LARGE_LISTED : LARGE_AS_ALL;
        if (!init_draw(&p->draw[kind.shape][kind.pass][kind.ids], gpu, &kind))
            return false;
        kind.large = LARGE_ALONE;
        if (lists && !init_draw(&p->large[kind.pass], gpu, &kind))
            return false;
    }
    return true;
}

/* By fragments; llvmpipe leaves out those of which nothing is to be drawn. */
static bool init_resolve_draws(struct wd_continuum_pipelines *p, struct wd_gpu *gpu)
{
    struct wd_graphics_params params = {
        .vertex = WD_SPIRV(resolve_vert),
        .fragment = WD_SPIRV(resolve_frag),
        .bindings = {10, {UNIFORM, TEXELS, TEXELS, TEXELS, TEXELS, TEXELS, TEXELS, TEXELS,
                          VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, TEXELS}},
        .color_count = 3,
        .color_formats = {WD_ALBEDO_FORMAT, WD_NORMAL_FORMAT, WD_SURFACE_FORMAT},
        .depth_format = WD_DEPTH_FORMAT,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    struct wd_graphics_params depth = params;
    depth.vertex = (struct wd_spirv)WD_SPIRV(depth_vert);
    depth.fragment = (struct wd_spirv)WD_SPIRV(depth_frag);
    depth.bindings.count = 4;
    depth.color_writes = WD_COLORS_KEPT;
    params.depth_compare = VK_COMPARE_OP_LESS; /* the triangle lies behind all that has depth */
    params.depth_read_only = true;
    for (uint32_t wood = 0; wood < 2; wood++) {
        params.constants = depth.constants = (struct wd_spec_constants){1, &wood};
        if (!wd_pipeline_init_graphics(&p->depth[wood], gpu, &depth) ||
            !wd_pipeline_init_graphics(&p->resolve[wood], gpu, &params))
            return false;
    }
    return true;
}

static bool init_resolve(struct wd_continuum_pipelines *p, struct wd_gpu *gpu)
{
    const struct wd_compute_params resolve = {
        .shader = WD_SPIRV(resolve_comp),
        .bindings = {14, {UNIFORM, TEXELS, TEXELS, TEXELS, TEXELS, TEXELS, TEXELS, TEXELS,
                          VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, TEXELS, STORED, STORED, STORED,
                          BUFFER}}};
    const struct wd_compute_params cascade_store = {
        .shader = WD_SPIRV(cascade_store_comp),
        .bindings = {4, {UNIFORM, TEXELS, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, STORED}},
        .push_size = sizeof(struct wd_cascade_push)};
    const struct wd_compute_params cascade = {.shader = WD_SPIRV(cascade_comp),
                                              .bindings = {3, {UNIFORM, TEXELS, BUFFER}}};
    if (gpu->features & WD_GPU_FEATURE_STORED_TARGETS)
        return wd_pipeline_init_compute(&p->resolve_all, gpu, &resolve) &&
               wd_pipeline_init_compute(&p->cascade_store, gpu, &cascade_store);
    return init_resolve_draws(p, gpu) && wd_pipeline_init_compute(&p->cascade, gpu, &cascade);
}

static bool init_level(struct wd_pipeline *pipeline, struct wd_gpu *gpu, uint32_t level,
                       uint32_t trees_alone)
{
    const uint32_t constants[] = {level, trees_alone};
    const struct wd_compute_params params = {
        .shader = WD_SPIRV(pyramid_comp),
        .bindings = {4, {UNIFORM, BUFFER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, BUFFER}},
        .constants = {2, constants},
    };
    return wd_pipeline_init_compute(pipeline, gpu, &params);
}

static bool init_pyramid(struct wd_continuum_pipelines *p, struct wd_gpu *gpu)
{
    for (uint32_t i = 0; i < WD_PYRAMID_LEVELS - 1; i++) {
        if (!init_level(&p->pyramid[i], gpu, i ? i + 1 : 0, 0))
            return false;
    }
    return init_level(&p->pyramid_of_trees, gpu, 0, 1) &&
           wd_sampler_init(&p->nearest, gpu, WD_SAMPLER_NEAREST_CLAMP);
}

static bool init_choose(struct wd_continuum_pipelines *p, struct wd_gpu *gpu)
{
    struct wd_pipeline *const pipelines[] = {&p->choose[WD_PASS_CAMERA], &p->choose[WD_PASS_SHADOW],
                                             &p->choose_again};
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t constants[] = {threads_of(gpu), i == WD_PASS_SHADOW, i == 2,
                                      gpu->runs};
        const struct wd_compute_params choose = {
            .shader = WD_SPIRV(select_comp),
            .bindings = {15, {UNIFORM, UNIFORM, BUFFER, BUFFER, BUFFER, TEXELS, BUFFER, TEXELS,
                              STORED_TEXELS, BUFFER, BUFFER, TEXELS,
                              VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, BUFFER, BUFFER}},
            .constants = {4, constants}};
        if (!wd_pipeline_init_compute(pipelines[i], gpu, &choose))
            return false;
    }
    return true;
}

static bool init_args(struct wd_continuum_pipelines *p, struct wd_gpu *gpu)
{
    for (uint32_t again = 0; again < 2; again++) {
        const uint32_t constants[] = {threads_of(gpu), again, lanes_of(gpu), lanes_of(gpu)};
        const struct wd_compute_params args = {.shader = WD_SPIRV(args_comp),
                                               .bindings = {5, {UNIFORM, BUFFER, BUFFER, BUFFER,
                                                                BUFFER}},
                                               .constants = {4, constants}};
        if (!wd_pipeline_init_compute(&p->args[again], gpu, &args))
            return false;
    }
    return true;
}

static bool init_sort(struct wd_continuum_pipelines *p, struct wd_gpu *gpu)
{
    const uint32_t threads = threads_of(gpu);
    const struct wd_compute_params sort = {.shader = WD_SPIRV(sort_comp),
                                           .bindings = {3, {UNIFORM, BUFFER, BUFFER}},
                                           .constants = {1, &threads}};
    return wd_pipeline_init_compute(&p->sort, gpu, &sort);
}

bool wd_continuum_pipelines_init(struct wd_continuum_pipelines *p, struct wd_gpu *gpu)
{
    const struct wd_compute_params cull = {
        .shader = WD_SPIRV(cull_comp),
        .bindings = {8, {UNIFORM, UNIFORM, BUFFER, BUFFER, BUFFER, TEXELS, BUFFER, BUFFER}}};
    return wd_pipeline_init_compute(&p->cull, gpu, &cull) && init_args(p, gpu) &&
           init_choose(p, gpu) && init_sort(p, gpu) && init_draws(p, gpu) && init_resolve(p, gpu) &&
           init_pyramid(p, gpu);
}

void wd_continuum_pipelines_finish(struct wd_continuum_pipelines *p, struct wd_gpu *gpu)
{
    if (p->nearest)
        vkDestroySampler(gpu->device, p->nearest, NULL);
}
