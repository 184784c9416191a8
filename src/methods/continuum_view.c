#include "methods/continuum_view.h"

#include <math.h>
#include <string.h>

#include "frame/uniforms.h"

_Static_assert((int)WD_SPLAT_SIDES == (int)WD_SLICE_SIDES, "sides are copied whole");
_Static_assert((int)WD_SPLAT_PLANES == (int)WD_FRUSTUM_PLANES, "planes are copied whole");

uint32_t wd_pyramid_offsets(uint32_t first[WD_PYRAMID_LEVELS], uint32_t width, uint32_t height)
{
    uint32_t total = 0;
    for (uint32_t level = 0; level < WD_PYRAMID_LEVELS; level++) {
        uint32_t texel = 2u << level;
        first[level] = total;
        total += (width + texel - 1) / texel * ((height + texel - 1) / texel);
    }
    return total;
}

/* --- history ----------------------------------------------------------------------------- */

void wd_continuum_history_keep(struct wd_continuum_history *history, const struct wd_view *view)
{
    history->width = view->width;
    history->height = view->height;
    memcpy(history->eye_m, view->eye_m, sizeof history->eye_m);
    history->camera = view->camera;
    memcpy(history->clip_from_rel, view->clip_from_rel, sizeof history->clip_from_rel);
}

/* What the frame before hid may be seen from any other place: a camera that has moved knows nothing of it for certain.
 * One that has only turned knows it of whatever lay wholly in that frame. */
static void set_history(struct wd_splat_view *values, const struct wd_continuum_view_params *params)
{
    const struct wd_continuum_history *history = params->history;
    const struct wd_view *view = params->draw->view;
    const struct wd_camera *was = &history->camera, *is = &view->camera;
    wd_pyramid_offsets(values->pyramid_first, view->width, view->height);
    memcpy(values->history_from_rel, history->clip_from_rel, sizeof values->history_from_rel);
    for (int k = 0; k < 3; k++) {
        float step_m = (float)(view->eye_m[k] - history->eye_m[k]);
        for (int row = 0; row < 4; row++)
            values->history_from_rel[3][row] += history->clip_from_rel[k][row] * step_m;
    }
    values->moved = memcmp(view->eye_m, history->eye_m, sizeof history->eye_m) != 0;
    values->has_history = history->width == view->width && history->height == view->height &&
                          (params->puts_off || !values->moved);
    values->still = was->yaw_rad == is->yaw_rad && was->pitch_rad == is->pitch_rad &&
                    was->fov_rad == is->fov_rad;
}

void wd_continuum_view_again(struct wd_splat_view *values)
{
    memcpy(values->history_from_rel, values->clip_from_rel, sizeof values->history_from_rel);
    values->moved = 0;
    values->still = 1;
}

/* --- the whole --------------------------------------------------------------------------- */

/* Where trees that stand for others find the ground's slope. */
static void set_slopes(struct wd_splat_view *values, const struct wd_ground *ground,
                       const struct wd_view *view)
{
    double texel_m = ground->slopes_step * ground->terrain->cell_m;
    const uint32_t size[2] = {ground->slopes.width, ground->slopes.height};
    for (int k = 0; k < 2; k++) {
        values->slopes_scale[k] = (float)(1.0 / (texel_m * size[k]));
        values->slopes_offset[k] =
            (float)((view->eye_m[k] / texel_m + 0.5) / size[k]); /* of rel (0, 0) */
    }
    values->slopes_texel_m = (float)texel_m;
}

float wd_texels_per_m(const struct wd_view *view)
{
    float squared = 0.0f;
    for (int k = 0; k < 3; k++)
        squared += view->clip_from_rel[k][0] * view->clip_from_rel[k][0];
    return 0.5f * sqrtf(squared) * (float)view->width;
}

float wd_continuum_detail(const struct wd_tree_draw *draw)
{
    double spacing_px = 1.0 / sqrt(draw->forest->scene->methods.continuum.density);
    if (draw->max_error_px <= 0.0f || (draw->pass == WD_PASS_SHADOW && draw->view->box.calm))
        return 1.0f;
    return (float)(spacing_px / draw->max_error_px);
}

/* Samples of a picture that nothing bounds the error of. */
static float free_samples(const struct wd_tree_draw *draw)
{
    return draw->max_error_px > 0.0f ? 1.0f : (float)draw->view->samples;
}

/* Samples whose discs lie elsewhere each are blurred by the discs' size still. Twice as many make FLIP of
 * trees of 16 to 256 px a twelfth less, for a seventh more time; so many times more are worth it at most. */
static const float MOST_DENSITY = 4.0f;

static float camera_density(const struct wd_tree_draw *draw)
{
    float samples = free_samples(draw);
    float denser = samples > 1.0f ? wd_clampf(sqrtf(samples), 2.0f, MOST_DENSITY) : 1.0f;
    return (float)draw->forest->scene->methods.continuum.density * denser;
}

/* Pictures of several samples tell discs from leaves farther off than pixels alone do: FLIP of trees of 256 px
 * falls from 0.25 to 0.18 with 16 of them. Up to so many times as far, for that many. */
static const float MOST_FARTHER = 10.0f;

static float near_farther(const struct wd_tree_draw *draw)
{
    return fminf(powf(free_samples(draw), 0.87f), MOST_FARTHER);
}

/* The nearest cascades hold the leaves that the camera sees as meshes; the others hold crowns. */
static bool holds_leaves(const struct wd_view *view)
{
    return view->cascade < WD_LEAF_CASCADES && !view->box.calm;
}

/* Of the reach of meshes in the first cascade of others: it is for what lies close by; crowns farther off have
 * penumbras wider than discs. With all of it walks cost a tenth more, with a quarter an understory's FLIP
 * is 0.05 more, with this 0.002. */
static const float FIRST_REACH = 0.5f;

struct wd_near_rule wd_continuum_near_rule(const struct wd_tree_draw *draw,
                                           const struct wd_continuum_forest *forest)
{
    const struct wd_continuum_options *options = &draw->forest->scene->methods.continuum;
    struct wd_near_rule rule = {.grains = forest->grains};
    if (draw->forest->pages.capacity || (draw->pass == WD_PASS_SHADOW && !holds_leaves(draw->view)))
        return rule;
    rule.leaves_m = (float)options->near_leaves_m;
    if (options->near_px > 0.0)
        rule.reach = draw->view->pixels_per_radian * wd_continuum_detail(draw) *
                     near_farther(draw) / (float)options->near_px;
    if (draw->pass == WD_PASS_SHADOW && draw->view->cascade == 0 && free_samples(draw) < (float)WD_FINE_SAMPLES)
        rule.reach *= FIRST_REACH;
    rule.farthest_m = fmaxf(rule.leaves_m, rule.reach * forest->coarsest_m);
    return rule;
}

/* Of the tallest trees all, if a small part of the world's is much taller than the rest, as trees in a meadow are. */
struct wd_cascade_share wd_cascade_share_of(uint32_t capacity, const uint32_t taller[WD_HEIGHT_STEPS])
{
    const uint32_t trees = taller[0];
    size_t tallest = WD_HEIGHT_STEPS - 1, step = 1;
    if (trees <= capacity)
        return (struct wd_cascade_share){WD_CLUSTER_TREES, INFINITY};
    while (tallest > 0 && taller[tallest] == 0)
        tallest--;
    while (step <= tallest && taller[step] > capacity / 2)
        step++;
    bool apart = 2 * step <= tallest;
    uint32_t whole = apart ? taller[step] : 0;
    uint64_t records = (uint64_t)(capacity - whole) * WD_CLUSTER_TREES / (trees - whole);
    return (struct wd_cascade_share){records < 1 ? 1 : (uint32_t)records,
                                     apart ? 0.01f * (float)(step * WD_HEIGHT_STEP_CM) : INFINITY};
}

/* A splat's texel in the first cascade, where what lies close by is meshes, is as large at most. */
static const float DISC_TEXEL_M = 0.07f;

/* Texels, each way, for one of the splats' own. Beyond the cascades of leaves there are crowns. Two in the
 * second would spare a tenth of a walk's frame, but at 256 px FLIP is 0.016 more. */
static uint32_t disc_texels(const struct wd_tree_draw *draw)
{
    const struct wd_view *view = draw->view;
    float samples = free_samples(draw), largest_m = DISC_TEXEL_M / sqrtf(samples);
    uint32_t texels = view->cascade < WD_LEAF_CASCADES || samples >= (float)WD_FINE_SAMPLES ? 1 : 2;
    while (view->cascade == 0 && texels < 4 &&
           2.0f * (float)texels <= largest_m * wd_texels_per_m(view))
        texels *= 2;
    return view->width % texels ? 1 : texels;
}

static void set_cascade(struct wd_splat_view *values, const struct wd_tree_draw *draw,
                        const struct wd_continuum_forest *forest)
{
    const struct wd_view *view = draw->view;
    float detail = values->detail;
    values->density =
        (float)draw->forest->scene->methods.continuum.shadow_density * detail * detail;
    values->min_splats = WD_SPLAT_STRATA;
    struct wd_cascade_share share = wd_cascade_share_of(values->tree_capacity, forest->taller);
    values->cascade_records = share.records;
    values->cascade_whole_m = share.whole_m;
    values->texels = disc_texels(draw);
    values->width /= values->texels;
    values->height /= values->texels;
    values->pixels = wd_texels_per_m(view) / (float)values->texels;
    for (int side = 0; side < WD_SPLAT_SIDES; side++)
        memcpy(values->slice[side], view->box.slice[side], sizeof view->box.slice[side]);
}

/* Of a world's tallest tree: by this height far clusters are told how many trees they need. */
static const float TYPICAL_HEIGHT = 0.7f;

void wd_continuum_view_fill(struct wd_splat_view *values,
                            const struct wd_continuum_view_params *params)
{
    const struct wd_tree_draw *draw = params->draw;
    const struct wd_view *view = draw->view;
    const struct wd_continuum_options *options = &draw->forest->scene->methods.continuum;
    bool shadow = draw->pass == WD_PASS_SHADOW;
    float detail = wd_continuum_detail(draw);
    const struct wd_near_rule near = wd_continuum_near_rule(draw, params->forest);
    *values = (struct wd_splat_view){
        .plane_count = view->frustum.count,
        .calm = shadow && view->box.calm,
        .pixels = view->pixels_per_radian,
        .near_m = WD_NEAR_M,
        .typical_m = TYPICAL_HEIGHT * draw->forest->max_tree_height_m,
        .width = view->width,
        .height = view->height,
        .texels = 1,
        .density = camera_density(draw) * detail * detail,
        .detail = detail,
        .min_splats = (uint32_t)options->min_splats,
        .near_leaves_m = near.leaves_m,
        .near_grains = near.reach,
        .wood_px = (float)options->wood_px,
        .cluster_count = params->forest->cluster_count,
        .page_count = params->page_count,
        .variants = draw->forest->variants,
        .tree_capacity = params->tree_capacity,
        .item_capacity = params->item_capacity,
        .put_off_words = 2 * params->cluster_capacity,
    };
    memcpy(values->clip_from_rel, view->clip_from_rel, sizeof values->clip_from_rel);
    memcpy(values->planes, view->frustum.planes, sizeof values->planes);
    set_slopes(values, &draw->forest->ground, view);
    if (shadow)
        set_cascade(values, draw, params->forest);
    else
        set_history(values, params);
}
