#include "reference/scatter.h"

#include "base/dmath.h"
#include "shared/wax.h"
#include "tree/vec.h"

static const float PI = (float)WD_PI;

/* A leaf's measured albedo holds what its surface reflects; the rest is what comes from within. */
static struct wd_vec3 inner_albedo(const struct wd_surface *surface)
{
    struct wd_vec3 a = surface->albedo;
    if (!surface->glossy)
        return a;
    float rest = 1 / (1 - WD_WAX);
    return WD_V3(fmaxf(a.x - WD_WAX, 0.25f * a.x) * rest,
                 fmaxf(a.y - WD_WAX, 0.25f * a.y) * rest,
                 fmaxf(a.z - WD_WAX, 0.25f * a.z) * rest);
}

static struct wd_vec3 inner_transmittance(const struct wd_surface *surface)
{
    float rest = surface->glossy ? 1 / (1 - WD_WAX) : 1;
    return wd_v3_scale(surface->transmittance, rest);
}

/* --- the coat: GGX (Walter et al. 2007) ---------------------------------------------------- */

static float coat_toward(struct wd_vec3 normal, float alpha, struct wd_vec3 eye,
                         struct wd_vec3 light)
{
    float ne = wd_v3_dot(normal, eye), nl = wd_v3_dot(normal, light);
    if (ne <= 0 || nl <= 0)
        return 0;
    struct wd_vec3 half_way = wd_v3_unit(wd_v3_add(eye, light));
    return wd_wax_mirrors(ne, nl, wd_v3_dot(normal, half_way), wd_v3_dot(half_way, eye), alpha * alpha) / PI;
}

/* Two directions that with `normal` make a right-handed frame (Duff et al. 2017). */
static void frame_about(struct wd_vec3 n, struct wd_vec3 *s, struct wd_vec3 *t)
{
    float sign = copysignf(1, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    *s = WD_V3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *t = WD_V3(b, sign + n.y * n.y * a, -n.y);
}

/* A microfacet's normal among those that the eye sees (Heitz 2018); z along the surface's normal. */
static struct wd_vec3 visible_facet(struct wd_vec3 eye, float alpha, const float point[2])
{
    struct wd_vec3 view = wd_v3_unit(WD_V3(alpha * eye.x, alpha * eye.y, eye.z));
    float level = view.x * view.x + view.y * view.y;
    struct wd_vec3 s = {1, 0, 0};
    if (level > 0)
        s = wd_v3_scale(WD_V3(-view.y, view.x, 0), 1 / sqrtf(level));
    struct wd_vec3 t = wd_v3_cross(view, s);
    float r = sqrtf(point[0]), turn = 2 * PI * point[1], split = 0.5f * (1 + view.z);
    float a = r * cosf(turn), b = r * sinf(turn);
    b = (1 - split) * sqrtf(fmaxf(1 - a * a, 0)) + split * b;
    struct wd_vec3 n = wd_v3_add(wd_v3_add(wd_v3_scale(s, a), wd_v3_scale(t, b)),
                                 wd_v3_scale(view, sqrtf(fmaxf(1 - a * a - b * b, 0))));
    return wd_v3_unit(WD_V3(alpha * n.x, alpha * n.y, fmaxf(n.z, 1e-6f)));
}

static bool sample_coat(struct wd_scattered *scattered, const struct wd_surface *surface,
                        struct wd_vec3 eye, const float point[2], float chosen)
{
    struct wd_vec3 n = surface->normal, s, t;
    frame_about(n, &s, &t);
    struct wd_vec3 own = {wd_v3_dot(eye, s), wd_v3_dot(eye, t), wd_v3_dot(eye, n)};
    struct wd_vec3 m = visible_facet(own, surface->coat_alpha, point);
    float em = wd_v3_dot(own, m);
    struct wd_vec3 mirrored = wd_v3_mad(wd_v3_scale(own, -1), m, 2 * em);
    if (mirrored.z <= 0)
        return false;
    scattered->direction =
        wd_v3_unit(wd_v3_add(wd_v3_add(wd_v3_scale(s, mirrored.x), wd_v3_scale(t, mirrored.y)),
                             wd_v3_scale(n, mirrored.z)));
    float alpha2 = surface->coat_alpha * surface->coat_alpha, in = wd_facets_hidden(own.z, alpha2);
    float masked = (1 + in) / (1 + in + wd_facets_hidden(mirrored.z, alpha2));
    float weight = wd_wax(em) * masked / chosen;
    scattered->weight = WD_V3(weight, weight, weight);
    return wd_v3_dot(scattered->direction, surface->flat) > 0;
}

/* --- all together ---------------------------------------------------------------------------- */

struct wd_vec3 wd_scatter_toward(const struct wd_surface *surface, struct wd_vec3 eye,
                                 struct wd_vec3 light)
{
    float cosine = wd_v3_dot(surface->normal, light);
    bool same_side = wd_v3_dot(surface->flat, light) > 0;
    float coat = 0, within = 1;
    if (surface->glossy) {
        within = 1 - wd_wax(wd_v3_dot(surface->normal, eye));
        coat = same_side ? coat_toward(surface->normal, surface->coat_alpha, eye, light) : 0;
    }
    struct wd_vec3 color = {0, 0, 0};
    if (same_side && cosine > 0)
        color = wd_v3_scale(inner_albedo(surface), within * cosine / PI);
    else if (!same_side && cosine < 0)
        color = wd_v3_scale(inner_transmittance(surface), -within * cosine / PI);
    return wd_v3_add(color, WD_V3(coat, coat, coat));
}

static float mean_of(struct wd_vec3 v)
{
    return (v.x + v.y + v.z) * (1 / 3.0f);
}

/* Cosine-weighted about `normal`, kept on the side of `flat`: what falls through to the other side
 * is turned back, so that no energy is lost where both differ. */
static struct wd_vec3 cosine_direction(struct wd_vec3 normal, struct wd_vec3 flat,
                                       const float point[2])
{
    struct wd_vec3 s, t;
    frame_about(normal, &s, &t);
    float r = sqrtf(point[0]), turn = 2 * PI * point[1];
    struct wd_vec3 d = wd_v3_add(wd_v3_scale(s, r * cosf(turn)), wd_v3_scale(t, r * sinf(turn)));
    d = wd_v3_unit(wd_v3_mad(d, normal, sqrtf(fmaxf(1 - point[0], 1e-6f))));
    float beyond = wd_v3_dot(d, flat);
    return beyond < 0 ? wd_v3_unit(wd_v3_mad(d, flat, -2 * beyond)) : d;
}

/* Chances of the three ways light may have come. */
struct lobes {
    struct wd_vec3 albedo, through;
    float fresnel, coat, front, back;
};

static struct lobes lobes_of(const struct wd_surface *surface, struct wd_vec3 eye)
{
    struct lobes lobes = {.albedo = inner_albedo(surface), .through = inner_transmittance(surface)};
    lobes.fresnel = surface->glossy ? wd_wax(wd_v3_dot(surface->normal, eye)) : 0;
    float reflected = mean_of(lobes.albedo), transmitted = mean_of(lobes.through);
    float inner = (1 - lobes.fresnel) * (reflected + transmitted);
    lobes.coat = lobes.fresnel > 0 ? lobes.fresnel / (lobes.fresnel + inner) : 0;
    if (inner <= 0)
        return lobes;
    lobes.back = (1 - lobes.coat) * (transmitted / (reflected + transmitted));
    lobes.front = (1 - lobes.coat) * (1 - transmitted / (reflected + transmitted));
    return lobes;
}

bool wd_scatter_sample(struct wd_scattered *scattered, const struct wd_surface *surface,
                       struct wd_vec3 eye, struct wd_sampler *sampler)
{
    float choice[2], point[2];
    wd_sampler_next(sampler, choice);
    wd_sampler_next(sampler, point);
    struct lobes lobes = lobes_of(surface, eye);
    if (choice[0] < lobes.coat)
        return sample_coat(scattered, surface, eye, point, lobes.coat);
    if (lobes.front + lobes.back <= 0)
        return false;
    bool back = choice[1] * (lobes.front + lobes.back) < lobes.back;
    struct wd_vec3 normal = surface->normal, flat = surface->flat;
    if (back) {
        normal = wd_v3_scale(normal, -1);
        flat = wd_v3_scale(flat, -1);
    }
    scattered->direction = cosine_direction(normal, flat, point);
    scattered->weight = wd_v3_scale(back ? lobes.through : lobes.albedo,
                                    (1 - lobes.fresnel) / (back ? lobes.back : lobes.front));
    return true;
}

/* Of cosine_direction. */
static float cosine_density(struct wd_vec3 normal, struct wd_vec3 flat, struct wd_vec3 direction)
{
    struct wd_vec3 turned = wd_v3_mad(direction, flat, -2 * wd_v3_dot(direction, flat));
    return (fmaxf(wd_v3_dot(normal, direction), 0) + fmaxf(wd_v3_dot(normal, turned), 0)) / PI;
}

struct wd_scatter_density wd_scatter_density_of(const struct wd_surface *surface,
                                                struct wd_vec3 eye, struct wd_vec3 light)
{
    struct lobes lobes = lobes_of(surface, eye);
    bool front = wd_v3_dot(surface->flat, light) > 0;
    struct wd_vec3 normal = surface->normal, flat = surface->flat;
    if (!front) {
        normal = wd_v3_scale(normal, -1);
        flat = wd_v3_scale(flat, -1);
    }
    float within = cosine_density(normal, flat, light);
    struct wd_scatter_density density = {
        (front ? lobes.front : lobes.back) * within,
        wd_v3_scale(front ? lobes.albedo : lobes.through, (1 - lobes.fresnel) * within)};
    float coat = front && lobes.coat > 0
                     ? coat_toward(surface->normal, surface->coat_alpha, eye, light)
                     : 0;
    if (coat <= 0)
        return density;
    /* chosen by visible facets: without what hides light on its way in, and whatever it reflects */
    struct wd_vec3 half_way = wd_v3_unit(wd_v3_add(eye, light));
    float alpha2 = surface->coat_alpha * surface->coat_alpha;
    float in = wd_facets_hidden(wd_v3_dot(surface->normal, eye), alpha2);
    float out = wd_facets_hidden(wd_v3_dot(surface->normal, light), alpha2);
    density.per_sr += lobes.coat * coat / wd_wax(wd_v3_dot(half_way, eye)) * (1 + in + out) /
                      (1 + in);
    density.scattered = wd_v3_add(density.scattered, WD_V3(coat, coat, coat));
    return density;
}
