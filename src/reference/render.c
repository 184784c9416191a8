#include "reference/render.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/jobs.h"
#include "base/log.h"
#include "base/memory.h"
#include "tree/vec.h"

/* Samples a tile takes in one go: few enough that all tiles keep about the same number. */
enum { SAMPLES_PER_PASS = 4 };

bool wd_trace_sums_init(struct wd_trace_sums *sums, uint32_t width, uint32_t height)
{
    *sums = (struct wd_trace_sums){
        .width = width,
        .height = height,
        .tile_columns = (width + WD_TRACE_TILE - 1) / WD_TRACE_TILE,
        .tile_rows = (height + WD_TRACE_TILE - 1) / WD_TRACE_TILE,
        .radiance = wd_try_array((size_t)width * height, 3 * sizeof(float)),
    };
    if (!sums->radiance) {
        *sums = (struct wd_trace_sums){0};
        return false;
    }
    sums->tile_samples =
        wd_alloc_array((size_t)sums->tile_columns * sums->tile_rows, sizeof *sums->tile_samples);
    return true;
}

void wd_trace_sums_finish(struct wd_trace_sums *sums)
{
    free(sums->radiance);
    free(sums->tile_samples);
    *sums = (struct wd_trace_sums){0};
}

/* A place on the lens, evenly over its disc. */
static struct wd_vec3 lens_place(const struct wd_trace_view *view, struct wd_sampler *sampler)
{
    float point[2];
    wd_sampler_next(sampler, point);
    float r = view->lens_m * sqrtf(point[0]), turn = 6.2831853f * point[1];
    struct wd_vec3 across = wd_v3_scale(wd_v3_unit(view->right), r * cosf(turn));
    return wd_v3_mad(across, wd_v3_unit(view->up), r * sinf(turn));
}

/* --- tiles ----------------------------------------------------------------------------------- */

/* What the threads of one pass share. */
struct pass {
    struct wd_trace_job *job;
    struct wd_trace_sums *sums;  /* NULL: layers are wanted */
    struct wd_picture *picture;
    uint32_t target;             /* samples that tiles are brought to */
    uint64_t done_before, total; /* samples of tiles, for the progress */
    pthread_t caller;
    atomic_bool stop;
    atomic_uint_fast64_t rays, self_hits, done;
};

struct area {
    uint32_t left, top, right, bottom;
};

static struct area tile_area(const struct wd_trace_view *view, size_t tile)
{
    uint32_t columns = (view->width + WD_TRACE_TILE - 1) / WD_TRACE_TILE;
    struct area area = {(uint32_t)(tile % columns) * WD_TRACE_TILE,
                        (uint32_t)(tile / columns) * WD_TRACE_TILE, 0, 0};
    area.right = area.left + WD_TRACE_TILE;
    area.bottom = area.top + WD_TRACE_TILE;
    area.right = area.right < view->width ? area.right : view->width;
    area.bottom = area.bottom < view->height ? area.bottom : view->height;
    return area;
}

static void trace_pixel(struct pass *pass, uint32_t x, uint32_t y, uint32_t from,
                        struct wd_trace_counts *counts)
{
    const struct wd_trace_view *view = &pass->job->view;
    float *sum = pass->sums->radiance + 3 * ((size_t)y * view->width + x);
    for (uint32_t i = from; i < pass->target; i++) {
        struct wd_sampler sampler = wd_sampler_of(x, y, pass->job->stream, i);
        float place[2];
        wd_sampler_next(&sampler, place);
        if (pass->job->middles)
            place[0] = place[1] = 0.5f;
        struct wd_vec3 ray = wd_trace_view_ray(view, (float)x + place[0], (float)y + place[1]);
        struct wd_vec3 eye = {0, 0, 0};
        if (view->lens_m > 0) {
            eye = lens_place(view, &sampler);
            ray = wd_v3_sub(wd_v3_scale(ray, view->focus_m), eye);
        }
        struct wd_vec3 radiance =
            wd_path_radiance(pass->job->tracer, eye, wd_v3_unit(ray), sampler, counts);
        sum[0] += radiance.x;
        sum[1] += radiance.y;
        sum[2] += radiance.z;
    }
}

/* Progress is reported on the thread that called. */
static void report(struct pass *pass, uint64_t done)
{
    if (pthread_equal(pthread_self(), pass->caller) &&
        !wd_progress_report(pass->job->progress, "samples", pass->done_before + done, pass->total))
        atomic_store(&pass->stop, true);
}

static void trace_tile(void *user, size_t tile)
{
    struct pass *pass = user;
    uint32_t *samples = &pass->sums->tile_samples[tile];
    struct wd_trace_counts counts = {0};
    if (*samples >= pass->target || atomic_load(&pass->stop))
        return;
    struct area area = tile_area(&pass->job->view, tile);
    for (uint32_t y = area.top; y < area.bottom; y++)
        for (uint32_t x = area.left; x < area.right; x++)
            trace_pixel(pass, x, y, *samples, &counts);
    uint64_t more = pass->target - *samples;
    *samples = pass->target;
    atomic_fetch_add(&pass->rays, counts.rays);
    atomic_fetch_add(&pass->self_hits, counts.self_hits);
    report(pass, atomic_fetch_add(&pass->done, more) + more);
}

static uint64_t samples_done(const struct wd_trace_sums *sums, uint32_t *least)
{
    uint64_t done = 0;
    *least = UINT32_MAX;
    for (size_t i = 0; i < (size_t)sums->tile_columns * sums->tile_rows; i++) {
        done += sums->tile_samples[i];
        *least = sums->tile_samples[i] < *least ? sums->tile_samples[i] : *least;
    }
    return done;
}

void wd_trace_run(struct wd_trace_job *job, struct wd_trace_sums *sums, uint32_t samples)
{
    size_t tiles = (size_t)sums->tile_columns * sums->tile_rows;
    uint32_t least;
    for (uint64_t done = samples_done(sums, &least); least < samples && !job->stopped;
         done = samples_done(sums, &least)) {
        uint32_t target = least + SAMPLES_PER_PASS;
        struct pass pass = {
            .job = job,
            .sums = sums,
            .target = target < samples ? target : samples,
            .done_before = done,
            .total = (uint64_t)tiles * samples,
            .caller = pthread_self(),
        };
        wd_jobs_run(job->threads, tiles, trace_tile, &pass);
        job->counts.rays += atomic_load(&pass.rays);
        job->counts.self_hits += atomic_load(&pass.self_hits);
        job->stopped = atomic_load(&pass.stop);
    }
}

/* --- layers ---------------------------------------------------------------------------------- */

static void put(float *layer, size_t pixel, struct wd_vec3 v)
{
    if (!layer)
        return;
    layer[3 * pixel] = v.x;
    layer[3 * pixel + 1] = v.y;
    layer[3 * pixel + 2] = v.z;
}

static void layer_pixel(const struct pass *pass, uint32_t x, uint32_t y)
{
    const struct wd_tracer *tracer = pass->job->tracer;
    const struct wd_world *world = tracer->scene->world;
    struct wd_picture *picture = pass->picture;
    struct wd_vec3 through = wd_trace_view_ray(&pass->job->view, (float)x + 0.5f, (float)y + 0.5f);
    struct wd_trace_ray ray = {{0, 0, 0}, wd_v3_unit(through), INFINITY};
    struct wd_trace_hit hit = wd_trace_nearest(tracer->scene, &ray);
    size_t pixel = (size_t)y * pass->job->view.width + x;
    if (picture->depth_m)
        picture->depth_m[pixel] = hit.at_m / wd_v3_length(through);
    if (hit.at_m >= INFINITY)
        return;
    struct wd_surface surface;
    wd_surface_at(&surface, tracer->scene, &ray, &hit, tracer->pixel_rad);
    put(picture->normal, pixel, wd_normal_seen(surface.outward, through, surface.sheet));
    put(picture->albedo, pixel, surface.albedo);
    if (hit.tree >= world->tree_count)
        return;
    if (picture->species)
        picture->species[pixel] = WD_TREE_SPECIES(world->trees[hit.tree]) + 1;
    if (picture->tree_id)
        picture->tree_id[pixel] = world->trees[hit.tree].id;
}

static void layer_tile(void *user, size_t tile)
{
    struct pass *pass = user;
    struct area area = tile_area(&pass->job->view, tile);
    for (uint32_t y = area.top; y < area.bottom; y++)
        for (uint32_t x = area.left; x < area.right; x++)
            layer_pixel(pass, x, y);
}

void wd_trace_layers(struct wd_trace_job *job, struct wd_picture *picture)
{
    size_t columns = (job->view.width + WD_TRACE_TILE - 1) / WD_TRACE_TILE;
    size_t rows = (job->view.height + WD_TRACE_TILE - 1) / WD_TRACE_TILE;
    struct pass pass = {.job = job, .picture = picture};
    wd_jobs_run(job->threads, columns * rows, layer_tile, &pass);
    job->counts.rays += (uint64_t)job->view.width * job->view.height;
}
