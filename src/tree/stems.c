#include "tree/skeleton_parts.h"

enum { TRUNK_STEPS = 30, STEM_STEPS = 14, PALM_STEPS = 36 };
#define MAX_REACH 1.9f
#define LYING_M 0.03f
/* A free tree's stem goes so much higher before it dissolves: it has limbs from far down on. */
#define FREE_STEM_END 0.15f

/* Some boles end in one fork of limbs, on others limbs stand along a stem that is soon no thicker than they are. */
static float dissolved_end(const struct wd_tree_form *form)
{
    float leader = form->species->apical_dominance, chance = wd_hash_unit(wd_hash2(form->key, 0xd155));
    float above = wd_mixf(0.08f, 0.22f, chance) + 0.3f * leader, height = form->height_m;
    float end_m = form->bole_m + above * (height - form->bole_m);
    return (end_m - form->crown_base_m) / (height - form->crown_base_m);
}

float wd_tree_trunk_end(const struct wd_tree_form *form)
{
    float leader = form->species->apical_dominance;
    if (form->clip) /* what is cut fills up to the cut */
        return 1;
    float grown = 0.22f + 0.8f * leader + FREE_STEM_END * form->free;
    grown = wd_mixf(grown, dissolved_end(form), form->dissolved);
    return leader > 0.85f ? 1 : wd_mixf(grown, 1, form->youth);
}

/* Of one step of a trunk, in shares of its length: more would turn it down to the ground. */
#define MOST_BEND 0.4f

/* A leader that its limbs have overtaken bends as they do, from the upper bole on. */
static float crook(const struct wd_species *species, float step, float boles)
{
    return wd_minf(0.5f * species->orders[0].wander * step * wd_smoothf(0.4f, 1.2f, boles), 0.5f * MOST_BEND);
}

/* The trunk keeps upright as far as it goes. */
static void grow_trunk(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    const struct wd_species *species = form->species;
    struct wd_stem stem = {.order = WD_TRUNK, .parent = -1, .key = wd_hash2(form->key, 0x7)};
    struct wd_random random = wd_random_of(stem.key, 0x57e);
    struct wd_branch *branch = wd_skeleton_add_branch(skeleton, &stem);
    float crown = form->height_m - form->crown_base_m;
    float step = (form->crown_base_m + crown * wd_tree_trunk_end(form)) / TRUNK_STEPS;
    float loose = 1 - form->leader;
    struct wd_vec3 p = WD_V3(0, 0, 0), drift = WD_V3(0, 0, 0);
    struct wd_vec3 d = wd_v3_unit(WD_V3(0.06f * loose * wd_random_signed(&random),
                                        0.06f * loose * wd_random_signed(&random), 1));
    wd_skeleton_add_node(skeleton, p, d, 0);
    for (int i = 1; i <= TRUNK_STEPS; i++) {
        float inside = wd_smoothf(form->crown_base_m, form->height_m, p.z);
        drift = wd_v3_mad(wd_v3_scale(drift, 0.45f), wd_random_vec3(&random), 1);
        float bend = wd_minf(species->trunk_wander * (1 + 4 * loose * inside) * step, MOST_BEND);
        if (form->dissolved > 0)
            bend += form->dissolved * crook(species, step, p.z / form->bole_m);
        d = wd_v3_mad(d, drift, bend);
        d = wd_v3_add(d, WD_V3(-0.03f * p.x * step, -0.03f * p.y * step, 0.10f * step));
        d = wd_v3_unit(d);
        p = wd_v3_mad(p, d, step / wd_maxf(d.z, 0.5f));
        if (i > 2 && wd_tree_is_cut(form, p))
            break;
        branch->length_m += step / wd_maxf(d.z, 0.5f);
        wd_skeleton_add_node(skeleton, p, d, branch->length_m);
    }
    branch->node_count = skeleton->node_count - branch->first_node;
}

/* A stem that leans away from the stool and bends along its way. */
struct lean {
    struct wd_vec3 foot;
    float azimuth_rad, lean_rad;
    float upturn[2]; /* radians over its lower and upper half; positive: up */
    float top_m;     /* its highest point */
    float least_m;   /* what would dip into the ground lies this high */
    int steps;
};

static struct wd_vec3 lean_direction(float lean_rad, float azimuth_rad)
{
    float out = (float)wd_dsin((double)lean_rad), up = (float)wd_dcos((double)lean_rad);
    return WD_V3(out * (float)wd_dcos((double)azimuth_rad),
                 out * (float)wd_dsin((double)azimuth_rad), up);
}

/* Places of a stem of unit step. The bend of each half is spread along it, so that the curve is
 * smooth; random wander turns the azimuth and the lean. */
static float trace_lean(const struct lean *lean, const struct wd_tree_form *form, uint32_t key,
                        struct wd_vec3 *points, struct wd_vec3 *directions)
{
    struct wd_random random = wd_random_of(key, 0x1ea);
    float angle = lean->lean_rad, turn = lean->azimuth_rad, highest = 0;
    float wander = form->species->trunk_wander, drift = 0, veer = 0;
    points[0] = WD_V3(0, 0, 0);
    directions[0] = lean_direction(angle, turn);
    for (int i = 1; i <= lean->steps; i++) {
        float t = ((float)i - 0.5f) / (float)lean->steps, each = 2 / (float)lean->steps;
        float low = lean->upturn[0] * each * wd_clampf(2 - 2 * t, 0, 1);
        float high = lean->upturn[1] * each * wd_clampf(2 * t, 0, 1);
        drift = 0.6f * drift + wander * wd_random_signed(&random);
        veer = 0.6f * veer + wander * wd_random_signed(&random);
        angle = wd_clampf(angle - 0.67f * (low + high) + 0.5f * drift, 0, 2.8f);
        turn += 0.8f * veer;
        directions[i] = lean_direction(angle, turn);
        struct wd_vec3 middle = wd_v3_unit(wd_v3_add(directions[i - 1], directions[i]));
        points[i] = wd_v3_add(points[i - 1], middle);
        highest = wd_maxf(highest, points[i].z);
    }
    return highest;
}

/* Grown at unit step, then scaled to its height, but to no more than `MAX_REACH` heights of length;
 * what would dip into the ground lies on it. */
static void grow_leaning(struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                         const struct lean *lean, uint32_t key)
{
    struct wd_vec3 points[PALM_STEPS + 1], directions[PALM_STEPS + 1];
    struct wd_stem stem = {.order = WD_TRUNK, .parent = -1, .key = key};
    struct wd_branch *branch = wd_skeleton_add_branch(skeleton, &stem);
    float scale = lean->top_m / wd_maxf(trace_lean(lean, form, key, points, directions), 0.5f);
    scale = wd_minf(scale, MAX_REACH * form->height_m / (float)lean->steps);
    int last = 0;
    for (int i = 0; i <= lean->steps; i++) {
        struct wd_vec3 p = wd_v3_mad(lean->foot, points[i], scale), d = directions[i];
        if (i > 2 && wd_tree_is_cut(form, p))
            break;
        last = i;
        if (i > 1 && p.z < lean->least_m) {
            p.z = lean->least_m;
            d = wd_v3_unit(WD_V3(d.x, d.y, 0));
        }
        wd_skeleton_add_node(skeleton, p, d, scale * (float)i);
    }
    branch->length_m = scale * (float)last;
    branch->node_count = skeleton->node_count - branch->first_node;
}

/* Stems of a stool, golden angle apart; the inner ones stand upright and are the tallest. */
static void grow_stool(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    const struct wd_species *species = form->species;
    int count = (int)species->stems.count;
    struct wd_random random = wd_random_of(form->key, 0x5700);
    float turn = 2 * (float)WD_PI * wd_random_unit(&random);
    for (int i = 0; i < count; i++) {
        float share = ((float)i + wd_random_unit(&random)) / (float)count;
        float out = form->spread * species->stems.spread_m * sqrtf(share);
        struct lean lean = {.steps = STEM_STEPS, .least_m = LYING_M};
        lean.azimuth_rad = turn + 2.3999632f * (float)i + 0.5f * wd_random_signed(&random);
        lean.foot = wd_v3_scale(lean_direction((float)WD_PI / 2, lean.azimuth_rad), out);
        lean.lean_rad = (float)(WD_PI / 180) * wd_mixf(species->stems.lean_deg[0],
                                                       species->stems.lean_deg[1], share);
        lean.lean_rad *= wd_random_range(&random, 0.8f, 1.2f);
        for (int half = 0; half < 2; half++)
            lean.upturn[half] = species->stems.upturn[half] * wd_random_range(&random, 0.6f, 1.4f);
        lean.top_m = form->height_m * wd_mixf(0.96f, 0.62f, share * share);
        lean.top_m *= i == 0 ? 1 : wd_random_range(&random, 0.78f, 1);
        grow_leaning(skeleton, form, &lean, wd_hash2(form->key, 0x5700 + (uint32_t)i));
    }
}

/* A palm leans once for light in its youth, then rises upright: its foot is bent, its top not. */
static void grow_palm(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    const struct wd_species *species = form->species;
    struct wd_random random = wd_random_of(form->key, 0xa1f);
    struct lean lean = {.steps = PALM_STEPS, .top_m = form->crown_base_m, .least_m = LYING_M};
    float share = wd_random_unit(&random);
    lean.azimuth_rad = 2 * (float)WD_PI * wd_random_unit(&random);
    lean.lean_rad = (float)(WD_PI / 180) *
                    wd_mixf(species->stems.lean_deg[0], species->stems.lean_deg[1], share);
    for (int half = 0; half < 2; half++)
        lean.upturn[half] = species->stems.upturn[half] * (0.3f + share) *
                            wd_random_range(&random, 0.7f, 1.2f);
    grow_leaning(skeleton, form, &lean, wd_hash2(form->key, 0xa1f));
}

/* The rootstock of a fern, which hardly shows above the ground, the foot of a tuft of grass. */
static void grow_rootstock(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    bool air = form->species->form == WD_FORM_FALLING; /* a straw on the ground */
    bool fern = form->species->form == WD_FORM_FERN;
    struct lean lean = {.steps = 2, .top_m = air ? 0.02f : (fern ? 0.015f : 0.03f) * form->height_m};
    lean.least_m = fern ? 0 : LYING_M;
    grow_leaning(skeleton, form, &lean, wd_hash2(form->key, 0x5700));
}

void wd_skeleton_grow_stems(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    switch (form->species->form) {
    case WD_FORM_PALM:
        grow_palm(skeleton, form);
        break;
    case WD_FORM_FERN:
    case WD_FORM_GRASS:
    case WD_FORM_FALLING:
        grow_rootstock(skeleton, form);
        break;
    case WD_FORM_SHRUB:
    case WD_FORM_BRAMBLE:
        grow_stool(skeleton, form);
        break;
    default:
        grow_trunk(skeleton, form);
    }
    skeleton->stem_count = skeleton->branch_count;
}
