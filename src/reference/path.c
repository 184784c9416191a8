#include "reference/path.h"

#include "shared/air.h"
#include "shared/river.h"
#include "shared/waves.h"
#include "tree/vec.h"
#include "world/river.h"

/* Scatterings after which paths may end by chance. */
enum { SURE_BOUNCES = 2 };

struct path {
    const struct wd_tracer *tracer;
    struct wd_trace_counts *counts;
    struct wd_sampler sampler;
    struct wd_trace_ray ray;
    struct wd_vec3 radiance, throughput;
    uint32_t left_tree, left_triangle; /* what the ray has just left */
    bool mirrored, under_water;
    uint32_t bounce;
    float per_sr;                      /* density with which its direction was chosen; 0: it had to be */
    float seen_m;                      /* how far off the eye sees something; infinite: the sky */
};

static const struct wd_frame_uniforms *frame_of(const struct path *path)
{
    return path->tracer->scene->frame;
}

static void add(struct path *path, struct wd_vec3 radiance)
{
    path->radiance = wd_v3_add(path->radiance, wd_v3_mul(path->throughput, radiance));
}

static struct wd_trace_hit nearest(struct path *path)
{
    struct wd_trace_hit hit = wd_trace_nearest(path->tracer->scene, &path->ray);
    path->counts->rays++;
    path->counts->self_hits += hit.at_m < INFINITY && hit.tree == path->left_tree &&
                               hit.triangle == path->left_triangle;
    return hit;
}

static bool sky_reaches(struct path *path, const struct wd_trace_ray *ray)
{
    path->counts->rays++;
    return !wd_trace_blocked(path->tracer->scene, ray);
}

/* --- the sun --------------------------------------------------------------------------------- */

/* A direction to the sun's disc, evenly over it; `*share`: brightness there over the disc's mean. */
static struct wd_vec3 toward_sun(struct path *path, float *share)
{
    const struct wd_frame_uniforms *frame = frame_of(path);
    struct wd_vec3 sun = wd_v3_of(frame->sun_direction), side = wd_v3_side(sun);
    float point[2];
    wd_sampler_next(&path->sampler, point);
    float inside = point[0], cosine = 1 - (1 - frame->sun_cos_radius) * (1 - inside);
    float sine = sqrtf(fmaxf(1 - cosine * cosine, 0)), turn = 6.2831853f * point[1];
    struct wd_vec3 across = wd_v3_add(wd_v3_scale(side, cosf(turn)),
                                      wd_v3_scale(wd_v3_cross(sun, side), sinf(turn)));
    *share = 1.25f * sqrtf(sqrtf(inside));
    return wd_v3_unit(wd_v3_mad(wd_v3_scale(sun, cosine), across, sine));
}

static void add_sun(struct path *path, const struct wd_surface *surface)
{
    struct wd_vec3 irradiance = wd_v3_of(frame_of(path)->sun_irradiance);
    float share;
    struct wd_vec3 toward = toward_sun(path, &share);
    if (irradiance.y <= 0)
        return;
    struct wd_vec3 eye = wd_v3_scale(path->ray.direction, -1);
    struct wd_vec3 scattered = wd_scatter_toward(surface, eye, toward);
    if (scattered.x + scattered.y + scattered.z <= 0)
        return;
    struct wd_trace_ray ray = wd_surface_leave(surface, toward);
    if (sky_reaches(path, &ray))
        add(path, wd_v3_scale(wd_v3_mul(scattered, irradiance), share));
}

/* --- a map of the sky ------------------------------------------------------------------------ */

/* Light from a direction chosen by the map's brightness. The scattered rays that escape bring the
 * same light; each counts by its share of both densities (the balance heuristic: Veach and Guibas
 * 1995). */
static void add_map(struct path *path, const struct wd_surface *surface)
{
    const struct wd_sky_map *map = path->tracer->sky_map;
    float part[2], within[2];
    wd_sampler_next(&path->sampler, part);
    wd_sampler_next(&path->sampler, within);
    struct wd_vec3 toward = wd_sky_map_sample(map, part, within);
    struct wd_vec3 eye = wd_v3_scale(path->ray.direction, -1);
    struct wd_scatter_density density = wd_scatter_density_of(surface, eye, toward);
    struct wd_vec3 scattered = density.scattered;
    if (scattered.x + scattered.y + scattered.z <= 0)
        return;
    struct wd_trace_ray ray = wd_surface_leave(surface, toward);
    if (!sky_reaches(path, &ray))
        return;
    float chance = wd_sky_map_density(map, toward) + density.per_sr;
    add(path, wd_v3_scale(wd_v3_mul(scattered, wd_sky_map_toward(map, toward)), 1 / chance));
}

static void escape_to_map(struct path *path)
{
    const struct wd_sky_map *map = path->tracer->sky_map;
    struct wd_vec3 direction = path->ray.direction;
    float share = path->per_sr > 0
                      ? path->per_sr / (path->per_sr + wd_sky_map_density(map, direction))
                      : 1;
    add(path, wd_v3_scale(wd_sky_map_toward(map, direction), share));
}

/* --- water ----------------------------------------------------------------------------------- */

/* How far off the ray meets the level water from above; infinite if it does not. */
static float level_water_m(const struct path *path)
{
    const struct wd_frame_uniforms *frame = frame_of(path);
    const struct wd_trace_ground *ground = &path->tracer->scene->ground;
    float above_m = path->ray.from.z - (float)((double)frame->water_level_m - ground->origin_m[2]);
    if (path->under_water || frame->water_level_m < -1e8f || above_m <= 0 ||
        path->ray.direction.z >= -1e-6f)
        return INFINITY;
    float at_m = -above_m / path->ray.direction.z;
    if (path->tracer->is_sea)
        return at_m;
    double x_m = (double)(path->ray.from.x + path->ray.direction.x * at_m) + ground->origin_m[0];
    double y_m = (double)(path->ray.from.y + path->ray.direction.y * at_m) + ground->origin_m[1];
    const struct wd_terrain *terrain = ground->terrain;
    bool within = x_m > 0 && y_m > 0 && x_m < wd_terrain_extent_x_m(terrain) &&
                  y_m < wd_terrain_extent_y_m(terrain);
    return within ? at_m : INFINITY;
}

/* Height over the ray's beginning of a map's water about a place on the ray. */
static float river_over_m(const struct path *path, float at_m)
{
    const struct wd_trace_ground *ground = &path->tracer->scene->ground;
    struct wd_vec3 from = path->ray.from, direction = path->ray.direction;
    double x_m = (double)(from.x + direction.x * at_m) + ground->origin_m[0];
    double y_m = (double)(from.y + direction.y * at_m) + ground->origin_m[1];
    double zero_m = (double)from.z + ground->origin_m[2];
    return (float)((double)wd_river_level(ground->terrain, x_m, y_m) - zero_m);
}

/* The same of a map's waters: a ray that ends `hit_m` off under one has come through its surface. */
static float river_m(const struct path *path, float hit_m)
{
    float end_m = path->ray.direction.z * hit_m;
    if (!path->tracer->scene->ground.terrain->water_m || path->under_water || hit_m >= INFINITY || end_m >= -1e-6f)
        return INFINITY;
    float surface_m = river_over_m(path, hit_m);
    if (surface_m <= end_m || surface_m >= 0)
        return INFINITY;
    float share = wd_river_share(end_m, surface_m), nearer_m = river_over_m(path, hit_m * share);
    if (nearer_m > 0.5f * WD_NO_WATER_M)
        share = wd_river_share_between(end_m, surface_m, nearer_m);
    return hit_m * share;
}

/* How far off the ray meets water, before what is `hit_m` off or behind that. */
static float water_ahead_m(const struct path *path, float hit_m)
{
    return fminf(level_water_m(path), river_m(path, hit_m));
}

/* Light from below: what the water itself throws back, and, dimmed, what lies at `bottom_m`. */
static void look_under(struct path *path, struct wd_vec3 at, float depth_m, float lit)
{
    const struct wd_frame_uniforms *frame = frame_of(path);
    struct wd_vec3 through = wd_water_through(frame, depth_m);
    struct wd_vec3 lost = wd_v3_sub(WD_V3(1, 1, 1), through);
    add(path, wd_v3_mul(wd_water_body(frame, lit), lost));
    path->throughput = wd_v3_mul(path->throughput, through);
    path->ray.from = at;
    path->under_water = true;
}

/* The ray meets the surface `at_m` off, and ground or nothing at `hit_m`. */
static void meet_water(struct path *path, float at_m, float hit_m)
{
    const struct wd_frame_uniforms *frame = frame_of(path);
    struct wd_vec3 at = wd_v3_mad(path->ray.from, path->ray.direction, at_m);
    struct wd_vec3 direction = path->ray.direction;
    float pixel_rad = path->bounce == 0 ? path->tracer->pixel_rad : 0.02f;
    struct wd_waves waves =
        wd_waves_at(frame, at.x, at.y, wd_water_footprint_m(direction, at_m, pixel_rad));
    float choice[2], point[2], share;
    wd_sampler_next(&path->sampler, choice);
    wd_sampler_next(&path->sampler, point);
    struct wd_vec3 facet = wd_water_facet(waves, direction, point[0], point[1]);
    struct wd_vec3 above = wd_v3_add(at, WD_V3(0, 0, 2e-3f));
    struct wd_trace_ray to_sun = {above, toward_sun(path, &share), INFINITY};
    float lit = frame->sun_irradiance[1] > 0 && sky_reaches(path, &to_sun) ? share : 0;
    add(path, wd_v3_scale(wd_water_glint(frame, waves, direction), lit));
    if (choice[0] >= wd_water_fresnel(facet, direction)) {
        look_under(path, at, fminf(hit_m - at_m, 1e4f), lit);
        return;
    }
    struct wd_vec3 mirrored = wd_water_mirrored(facet, direction);
    path->ray = (struct wd_trace_ray){above, mirrored, INFINITY};
    path->per_sr = 0;
    path->mirrored = true;
}

/* Haze between the water and what the eye sees mirrored in it. */
static void pass_haze(struct path *path, float length_m)
{
    const struct wd_frame_uniforms *frame = frame_of(path);
    struct wd_vec3 direction = path->ray.direction;
    struct wd_vec3 through = wd_fog_through(frame, direction, length_m);
    struct wd_vec3 lost = wd_v3_sub(WD_V3(1, 1, 1), through);
    add(path, wd_v3_mul(wd_horizon_toward(frame, direction, 1), lost));
    path->throughput = wd_v3_mul(path->throughput, through);
}

/* --- the path -------------------------------------------------------------------------------- */

/* The eye sees the sun's disc; everything else has it sampled, and water its glint. */
static void escape(struct path *path)
{
    const struct wd_frame_uniforms *frame = frame_of(path);
    if (path->tracer->sky_map)
        escape_to_map(path);
    else
        add(path, path->tracer->sky(frame, path->ray.direction));
    if (path->bounce == 0 && !path->mirrored && !path->under_water)
        add(path, wd_sun_disc_toward(frame, path->ray.direction));
}

/* Whether the path goes on; what does is weighted so that the mean stays. */
static bool survives(struct path *path)
{
    struct wd_vec3 *t = &path->throughput;
    float point[2], chance = fminf(fmaxf(t->x, fmaxf(t->y, t->z)), 1);
    wd_sampler_next(&path->sampler, point);
    if (path->bounce < SURE_BOUNCES)
        return chance > 0;
    if (point[0] >= chance)
        return false;
    *t = wd_v3_scale(*t, 1 / chance);
    return true;
}

static bool scatter(struct path *path, const struct wd_trace_hit *hit)
{
    struct wd_surface surface;
    struct wd_scattered scattered;
    if (path->bounce >= path->tracer->bounces) /* only what escapes still brings light */
        return false;
    wd_surface_at(&surface, path->tracer->scene, &path->ray, hit,
                  path->bounce == 0 ? path->tracer->pixel_rad : 0);
    path->bounce++;
    add_sun(path, &surface);
    struct wd_vec3 eye = wd_v3_scale(path->ray.direction, -1);
    if (path->tracer->sky_map)
        add_map(path, &surface);
    if (!wd_scatter_sample(&scattered, &surface, eye, &path->sampler))
        return false;
    if (path->tracer->sky_map)
        path->per_sr = wd_scatter_density_of(&surface, eye, scattered.direction).per_sr;
    path->throughput = wd_v3_mul(path->throughput, scattered.weight);
    path->ray = wd_surface_leave(&surface, scattered.direction);
    path->left_tree = hit->tree;
    path->left_triangle = hit->triangle;
    path->mirrored = path->under_water = false;
    return survives(path);
}

/* One ray on; false at the path's end. */
static bool advance(struct path *path)
{
    struct wd_trace_hit hit = nearest(path);
    float water_m = water_ahead_m(path, hit.at_m);
    bool primary = path->bounce == 0 && !path->mirrored && !path->under_water;
    if (primary)
        path->seen_m = fminf(hit.at_m, water_m);
    if (water_m < hit.at_m) {
        meet_water(path, water_m, hit.at_m);
        path->left_tree = UINT32_MAX;
        return true;
    }
    if (hit.at_m >= INFINITY) {
        escape(path);
        return false;
    }
    if (path->bounce == 0 && path->mirrored)
        pass_haze(path, hit.at_m);
    return scatter(path, &hit);
}

/* Where the eye looks through haze: a place on the way, chosen as haze there adds to what arrives. */
static struct wd_vec3 place_in_haze(struct path *path, struct wd_vec3 direction)
{
    const struct wd_frame_uniforms *frame = frame_of(path);
    float through = wd_fog_through(frame, direction, path->seen_m).y, point[2];
    float depth = through > 0 ? -logf(through) : frame->fog_per_m * wd_fog_path_m(frame, direction, path->seen_m);
    wd_sampler_next(&path->sampler, point);
    float share = through < 0.999f ? -logf(1 - point[0] * (1 - through)) / depth : point[0];
    return wd_v3_scale(direction, share * path->seen_m);
}

/* Trees farther off stand in haze themselves, and so does what they hide. */
static const float HAZE_SHADOWS_M = 300;

/* Toward all the sky alike. */
static bool sky_lights_haze(struct path *path, struct wd_vec3 at)
{
    float point[2];
    wd_sampler_next(&path->sampler, point);
    float across = sqrtf(1 - point[0] * point[0]), turn = 6.2831853f * point[1];
    struct wd_vec3 toward = WD_V3(across * cosf(turn), across * sinf(turn), point[0]);
    return sky_reaches(path, &(struct wd_trace_ray){at, toward, HAZE_SHADOWS_M});
}

static bool sun_lights_haze(struct path *path, struct wd_vec3 at)
{
    float share;
    struct wd_vec3 toward = toward_sun(path, &share);
    return sky_reaches(path, &(struct wd_trace_ray){at, toward, HAZE_SHADOWS_M});
}

/* Fog before the sky, as far as trees are looked for that shade it. */
static struct wd_vec3 shaded_sky(struct path *path, struct wd_vec3 direction)
{
    const struct wd_frame_uniforms *frame = frame_of(path);
    if (frame->fog_over <= 0)
        return path->radiance;
    path->seen_m = WD_FOG_SHADED_M;
    struct wd_vec3 at = place_in_haze(path, direction);
    float sky = sky_lights_haze(path, at) ? 1.0f : 0.0f, sun = sun_lights_haze(path, at) ? 1.0f : 0.0f;
    return wd_fog_shade_sky(frame, path->radiance, direction, sky, sun);
}

/* Haze between the eye and what it sees is lit where the ground there lets the sun pass, and trees near by. */
static struct wd_vec3 through_haze(struct path *path, struct wd_vec3 direction)
{
    const struct wd_frame_uniforms *frame = frame_of(path);
    if (path->seen_m >= INFINITY)
        return shaded_sky(path, direction);
    struct wd_trace_ray to_sun = {wd_v3_mad(wd_v3_scale(direction, path->seen_m),
                                            WD_V3(0, 0, 1), 0.05f),
                                  wd_v3_of(frame->sun_direction), INFINITY};
    bool shaded = wd_trace_blocked_by_ground(path->tracer->scene, &to_sun);
    path->counts->rays++;
    struct wd_vec3 at = place_in_haze(path, direction);
    float sky = sky_lights_haze(path, at) ? 1.0f : 0.0f, sun = sun_lights_haze(path, at) ? 1.0f : 0.0f;
    return wd_fog_apply(frame, path->radiance, direction, path->seen_m, shaded ? 0.0f : 1.0f, sky, sun);
}

struct wd_vec3 wd_path_radiance(const struct wd_tracer *tracer, struct wd_vec3 from,
                                struct wd_vec3 direction, struct wd_sampler sampler, struct wd_trace_counts *counts)
{
    struct path path = {
        .tracer = tracer,
        .counts = counts,
        .sampler = sampler,
        .ray = {from, direction, INFINITY},
        .throughput = {1, 1, 1},
        .left_tree = UINT32_MAX,
        .seen_m = INFINITY,
    };
    while (advance(&path))
        ;
    return through_haze(&path, direction);
}
