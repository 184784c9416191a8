#include "tree/skeleton_parts.h"

#include <stdlib.h>

#include "base/memory.h"

void wd_skeleton_finish(struct wd_skeleton *skeleton)
{
    free(skeleton->nodes);
    free(skeleton->branches);
    wd_tree_density_finish(&skeleton->crowd);
    *skeleton = (struct wd_skeleton){0};
}

void wd_skeleton_scale(struct wd_skeleton *skeleton, float factor)
{
    for (size_t i = 0; i < skeleton->node_count; i++) {
        struct wd_skeleton_node *node = &skeleton->nodes[i];
        node->position_m = wd_v3_scale(node->position_m, factor);
        node->along_m *= factor;
    }
    for (size_t i = 0; i < skeleton->branch_count; i++)
        skeleton->branches[i].length_m *= factor;
}

struct wd_vec3 wd_branch_point(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                               float share, struct wd_vec3 *direction, size_t *node)
{
    float place = wd_clampf(share, 0, 1) * (float)(branch->node_count - 1);
    size_t step = (size_t)place;
    if (step > branch->node_count - 2)
        step = branch->node_count - 2;
    const struct wd_skeleton_node *a = &skeleton->nodes[branch->first_node + step];
    float t = place - (float)step;
    *direction = wd_v3_unit(wd_v3_mix(a[0].direction, a[1].direction, t));
    *node = branch->first_node + step;
    return wd_v3_mix(a[0].position_m, a[1].position_m, t);
}

void wd_skeleton_add_node(struct wd_skeleton *skeleton, struct wd_vec3 position,
                          struct wd_vec3 direction, float along_m)
{
    struct wd_skeleton_node *node =
        wd_push(skeleton->nodes, skeleton->node_count, skeleton->node_capacity);
    node->position_m = position;
    node->direction = direction;
    node->along_m = along_m;
}

struct wd_branch *wd_skeleton_add_branch(struct wd_skeleton *skeleton, const struct wd_stem *stem)
{
    struct wd_branch *branch =
        wd_push(skeleton->branches, skeleton->branch_count, skeleton->branch_capacity);
    branch->order = stem->order;
    branch->parent = stem->parent;
    branch->parent_node = stem->parent_node;
    branch->first_node = skeleton->node_count;
    branch->key = stem->key;
    branch->stem = stem->parent < 0 ? (int)skeleton->branch_count - 1
                                    : skeleton->branches[stem->parent].stem;
    return branch;
}

/* Bends d by `angle` radians up (or down, where negative), without passing the vertical. */
static struct wd_vec3 bend_up(struct wd_vec3 d, float angle)
{
    struct wd_vec3 up = wd_v3_square(WD_V3(0, 0, angle < 0 ? -1 : 1), d);
    float level = sqrtf(d.x * d.x + d.y * d.y);
    return wd_v3_unit(wd_v3_mad(d, up, fabsf(angle) * level));
}

/* Twigs that hang in curtains are bounded by the ground alone. */
static bool hangs(const struct wd_branch_order *spec)
{
    return spec->tip_upturn < -1.8f;
}

/* How heavy limbs turn to the light, radians a metre. */
#define OUTWARD 0.08f

/* Grows a branch node by node: wander, bending, and a turn back where it would leave the crown. Heavy limbs end there:
 * turned back they would cross others. */
static void grow_stem(struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                      const struct wd_stem *stem)
{
    struct wd_random random = wd_random_of(stem->key, 0x57e);
    struct wd_branch *branch = wd_skeleton_add_branch(skeleton, stem);
    struct wd_vec3 p = stem->start, d = stem->direction, drift = WD_V3(0, 0, 0);
    float step = stem->length_m / (float)stem->steps;
    float ground = wd_minf(0.35f, 0.06f * form->height_m);
    bool hanging = hangs(&form->species->orders[stem->order]);
    float beyond = wd_mixf(1.04f, 1.16f, form->dissolved);
    float outward = stem->order == 0 ? OUTWARD * form->dissolved : 0;
    bool ends = stem->order == 0 && wd_hash_unit(wd_hash2(stem->key, 0xe4d)) < form->dissolved;
    /* crowns down to the ground have many twigs just above it: they level out before they would turn in a hairpin */
    float ahead_m = (form->youth > 0 ? 2 : 1) * step;
    if (form->youth > 0 && d.z < 0 && p.z + ahead_m * d.z < ground)
        d = wd_v3_unit_or(WD_V3(d.x, d.y, 0), WD_V3(0, 0, 1));
    wd_skeleton_add_node(skeleton, p, d, stem->along_m);
    for (int i = 1; i <= stem->steps; i++) {
        float t = ((float)i - 0.5f) / (float)stem->steps;
        drift = wd_v3_mad(wd_v3_scale(drift, 0.5f), wd_random_vec3(&random), 1);
        float bend = wd_mixf(stem->upturn, stem->tip_upturn, wd_smoothf(0.3f, 0.9f, t));
        d = wd_v3_unit(wd_v3_mad(d, drift, wd_minf(stem->wander * step, 0.35f)));
        d = bend_up(d, wd_clampf(bend * step / form->spread, -0.8f, 0.8f));
        if (outward > 0)
            d = wd_v3_unit(wd_v3_mad(d, wd_tree_crown_direction(form, p), outward * step));
        struct wd_vec3 next = wd_v3_mad(p, d, step);
        if (d.z < 0 && (next.z < ground || p.z + ahead_m * d.z < ground)) {
            if (hanging && i > 1)
                break;
            d = wd_v3_unit(WD_V3(d.x, d.y, 0.1f));
            next = wd_v3_mad(p, d, step);
        }
        if (wd_tree_is_cut(form, next)) {
            if (i > 1)
                break;
            next = wd_v3_mad(p, d, 0.2f * step);
        } else if (!hanging && wd_tree_envelope_share(form, next) > beyond) {
            if (ends && i > 1)
                break;
            struct wd_vec3 out = wd_v3_unit_or(WD_V3(p.x, p.y, 0), WD_V3(0, 0, 1));
            d = wd_v3_unit(wd_v3_mad(d, out, -0.6f * wd_maxf(wd_v3_dot(d, out), 0)));
            next = wd_v3_mad(p, d, 0.6f * step);
        }
        branch->length_m += wd_v3_length(wd_v3_sub(next, p));
        p = next;
        wd_skeleton_add_node(skeleton, p, d, stem->along_m + branch->length_m);
    }
    branch->node_count = skeleton->node_count - branch->first_node;
}

/* How good a place for a new branch is: free of others, in the crown, toward light. */
static float place_score(const struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                         struct wd_vec3 start, struct wd_vec3 d, float length_m,
                         struct wd_vec3 crown)
{
    struct wd_vec3 middle = wd_v3_mad(start, d, 0.55f * length_m);
    struct wd_vec3 end = wd_v3_mad(start, d, length_m);
    float crowd = wd_tree_density_at(&skeleton->crowd, middle) +
                  wd_tree_density_at(&skeleton->crowd, end);
    float over = wd_tree_envelope_share(form, end) - 1;
    float outward = wd_v3_dot(d, crown);
    return 0.35f * outward + 0.2f * d.z - 0.5f * crowd - (over > 0 ? 2 * over : 0);
}

static void mark_crowd(struct wd_skeleton *skeleton, const struct wd_branch *branch)
{
    float step = branch->length_m / (float)branch->node_count;
    for (size_t i = branch->node_count / 3; i < branch->node_count; i++)
        wd_tree_density_add(&skeleton->crowd, skeleton->nodes[branch->first_node + i].position_m,
                            step);
}

/* A joint where a branch of `order` is to start. */
struct joint {
    int parent;
    float share;     /* along the parent */
    float height;    /* 0 crown base .. 1 top, for the angle */
    float around_rad, jitter_rad;
    float length_m;
    uint32_t key;
};

/* So many more has a heavy limb, which is long and crooked. */
#define HEAVY_STEPS 6.0f

/* Hanging twigs need as many steps as their bend, others as few as their length allows. */
static int steps_of(const struct wd_branch_order *spec, int order, float length_m, float dissolved)
{
    static const int most[3] = {9, 5, 2};
    int steps = 2 + (int)(length_m * (order == 0 ? 1.6f : 2.5f));
    int bends = 1 + (int)(2.5f * length_m * fabsf(spec->tip_upturn));
    int limit = most[order] + (order == 0 ? (int)(HEAVY_STEPS * dissolved) : 0);
    if (steps > limit)
        steps = limit;
    return bends <= steps ? steps : bends < 7 ? bends : 7;
}

/* Most limbs of dead trees are stubs, a few are nearly whole. */
static float stub_share(struct wd_random *random)
{
    float share = wd_random_unit(random);
    return wd_mixf(0.07f, 1, share * share * share);
}

/* Away from `axis` by an angle: of a few ways around it the one with the best place. */
static struct wd_vec3 best_direction(const struct wd_skeleton *skeleton,
                                     const struct wd_tree_form *form, const struct joint *joint,
                                     struct wd_random *random, struct wd_vec3 start,
                                     struct wd_vec3 axis, float angle_rad)
{
    enum { TRIES = 5 };
    struct wd_vec3 side = wd_v3_side(axis), over = wd_v3_cross(side, axis), best = axis;
    struct wd_vec3 crown = wd_tree_crown_direction(form, start);
    float most = -1e30f;
    double out, along;
    wd_dsincos((double)angle_rad, &out, &along);
    for (int i = 0; i < TRIES; i++) {
        float around = joint->around_rad + joint->jitter_rad * wd_random_signed(random);
        struct wd_vec3 d = wd_v3_add(wd_v3_scale(axis, (float)along),
                                     wd_v3_scale(wd_v3_turn(side, over, around), (float)out));
        float score = place_score(skeleton, form, start, d, joint->length_m, crown);
        if (score > most) {
            most = score;
            best = d;
        }
    }
    return best;
}

/* Angle of a limb to the stem; `height` is 0 at the crown's foot, 1 where the stem ends. No limb of a young tree rises
 * beside its leader. Those of a free broadleaf have light from the side: the lowest are nearly level. Cut ones are
 * level down to the ground. */
static float limb_angle_deg(const struct wd_tree_form *form, const struct wd_branch_order *spec, float height)
{
    float angle = wd_mixf(spec->angle_deg[0], spec->angle_deg[1], height);
    angle = wd_mixf(angle, wd_maxf(angle, wd_mixf(68, 46, height)), form->youth);
    angle = wd_mixf(angle, wd_maxf(angle, wd_mixf(74, 36, height)), form->free);
    angle = wd_mixf(angle, wd_mixf(64, 44, height), form->dissolved);
    return form->clip ? wd_mixf(100, 20, height) : angle;
}

/* Limbs of a free broadleaf wander less: they bear all that grows on the way to their end, and that weight lets
 * none rise. */
#define FREE_WANDER 0.6f

/* Where the stem has dissolved they are few and crooked, each piece once the shoot with most light, and so much longer
 * than the straight way to the crown's envelope. */
#define HEAVY_WANDER 1.3f
#define HEAVY_LONGER 0.3f

/* A limb from a limb: two of like thickness part there. */
static float fork_angle_deg(const struct wd_branch_order *spec, float height)
{
    return wd_mixf(0.5f * (spec->angle_deg[0] + spec->angle_deg[1]), 36, 0.5f + 0.5f * height);
}

static void grow_joint(struct wd_skeleton *skeleton, const struct wd_tree_form *form, int order,
                       const struct joint *joint)
{
    const struct wd_branch_order *spec = &form->species->orders[order];
    struct wd_random random = wd_random_of(joint->key, 0x101);
    struct wd_stem stem = {.order = order, .parent = joint->parent, .key = joint->key,
                        .upturn = spec->upturn, .tip_upturn = spec->tip_upturn,
                        .wander = spec->wander};
    if (order == 0) {
        stem.upturn *= 1 - form->free;
        stem.wander *= wd_mixf(1, FREE_WANDER, form->free);
        stem.wander *= wd_mixf(1, HEAVY_WANDER / FREE_WANDER, form->dissolved);
    }
    struct wd_vec3 axis;
    const struct wd_branch *parent = &skeleton->branches[joint->parent];
    stem.start = wd_branch_point(skeleton, parent, joint->share, &axis, &stem.parent_node);
    if (order == 0 && form->dissolved > 0) /* above the node its parent is thinner by what it takes away */
        stem.start = wd_v3_mix(stem.start, skeleton->nodes[stem.parent_node].position_m, form->dissolved);
    stem.along_m = skeleton->nodes[stem.parent_node].along_m;
    float angle = order > 0               ? wd_mixf(spec->angle_deg[0], spec->angle_deg[1], joint->height)
                  : parent->order == order ? fork_angle_deg(spec, joint->height)
                                           : limb_angle_deg(form, spec, joint->height);
    angle *= (float)(WD_PI / 180) * wd_random_range(&random, 0.88f, 1.12f);
    stem.direction = best_direction(skeleton, form, joint, &random, stem.start, axis, angle);
    struct wd_vec3 ahead = bend_up(stem.direction, 0.3f * stem.upturn * joint->length_m);
    stem.length_m = joint->length_m;
    if (!hangs(spec))
        stem.length_m = wd_tree_envelope_reach_m(form, stem.start, ahead, joint->length_m);
    stem.length_m *= wd_random_range(&random, 0.9f, 1.05f);
    if (order == 0)
        stem.length_m *= 1 + HEAVY_LONGER * form->dissolved;
    if (stem.length_m < 0.3f * joint->length_m)
        stem.length_m = 0.3f * joint->length_m;
    if (form->species->form == WD_FORM_SNAG) /* broken off anywhere */
        stem.length_m *= stub_share(&random);
    stem.steps = steps_of(spec, order, stem.length_m, form->dissolved);
    grow_stem(skeleton, form, &stem);
    if (order < 2)
        mark_crowd(skeleton, &skeleton->branches[skeleton->branch_count - 1]);
}

#define YOUNG_SPACING 0.65f
#define FREE_SPACING 0.7f

static float spacing_m(const struct wd_tree_form *form, int order)
{
    /* a year's growth is long in young trees too: they have fewer branches, not smaller gaps */
    double power = form->spread < 1 ? 0.5 : order == 0 ? 0.6 : 0.9;
    double squeeze = wd_dpow((double)form->spread, power);
    float spacing = form->species->orders[order].spacing_m * (float)squeeze;
    if (order == 0) /* buds all along a young leader have shot, and none has died in the shade */
        spacing *= wd_mixf(1, YOUNG_SPACING, form->youth) * wd_mixf(1, FREE_SPACING, form->free);
    if (form->clip) /* cut shoots branch again: a hedge is as dense as its light allows */
        spacing = wd_minf(spacing, (order == 0 ? 0.03f : 0.05f) * form->crown_radius_m + 0.02f);
    return spacing;
}

static bool still_there(const struct wd_tree_form *form, uint32_t key)
{
    return wd_hash_unit(wd_hash2(key, 0xdeca)) < form->species->decay.limbs;
}

/* How many a stem dissolves into. */
static float heavy_limbs(const struct wd_tree_form *form)
{
    return 5.5f + 2.5f * wd_hash_unit(wd_hash2(form->key, 0x11b6));
}

/* Limbs up the trunk, golden angle apart or in whorls, as long as the crown is wide there. */
static bool grow_limbs(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    const struct wd_species *species = form->species;
    struct wd_random random = wd_random_of(form->key, 0x11b5);
    float crown = form->height_m - form->crown_base_m, spacing = spacing_m(form, 0);
    float end = crown * wd_tree_trunk_end(form), top = form->crown_base_m + end;
    int whorl = (int)species->whorl, index = 0;
    float first = form->bole_m - form->crown_base_m;
    spacing = wd_mixf(spacing, (end - first) * (float)whorl / heavy_limbs(form), form->dissolved);
    for (float z = first + 0.1f * spacing; z < 0.98f * end; index++) {
        float around = (float)index * 2.3999632f + wd_random_unit(&random), t = z / end;
        float height = wd_mixf(t, (z - first) / (end - first), form->dissolved);
        for (int i = 0; i < whorl; i++) {
            if (skeleton->branch_count >= WD_MAX_BRANCHES || index >= WD_MAX_BRANCHES)
                return false;
            float lift = whorl > 1 ? 0.12f * spacing * wd_random_signed(&random) : 0;
            float share = (form->crown_base_m + z + lift) / top;
            struct joint joint = {.share = wd_clampf(share, 0.02f, 0.99f), .height = height,
                                  .jitter_rad = whorl > 1 ? 0.25f : 0.8f};
            joint.around_rad = around + (float)i * (float)(2 * WD_PI) / (float)whorl;
            joint.length_m = 1.6f * form->crown_radius_m * species->orders[0].length_ratio;
            if (end < crown)
                joint.length_m = wd_maxf(joint.length_m, t * (crown - z));
            joint.length_m *= wd_random_range(&random, 0.85f, 1.0f);
            joint.key = wd_hash3(form->key, 0x11b, (uint32_t)(index * 16 + i));
            if (still_there(form, joint.key))
                grow_joint(skeleton, form, 0, &joint);
        }
        float dense = 1 - 0.4f * t;
        if (end < crown)
            dense = wd_mixf(0.7f + 0.7f * t, dense, form->youth);
        dense = wd_mixf(dense, 1, form->dissolved);
        z += spacing * wd_random_range(&random, 0.8f, 1.2f) * dense;
    }
    return true;
}

/* Branches of one order along one parent, left and right in turn. */
static bool grow_along(struct wd_skeleton *skeleton, const struct wd_tree_form *form, int order,
                       int parent_index)
{
    const struct wd_branch_order *spec = &form->species->orders[order];
    struct wd_branch parent = skeleton->branches[parent_index];
    struct wd_random random = wd_random_of(parent.key, 0xa1);
    bool stool = parent.order == WD_TRUNK && order == 0;
    float spacing = spacing_m(form, order), start = spec->start, crown_low = form->crown_base_m;
    if (parent.order == WD_TRUNK)
        start = wd_mixf(crown_low / form->height_m, 1, stool ? 0 : 0.72f);
    float limb = parent.length_m * (parent.order == WD_TRUNK ? 0.25f : 1), index = 0;
    if (stool)
        limb = 1.6f * form->crown_radius_m;
    for (float at = start * parent.length_m; at < 0.99f * parent.length_m; index++) {
        if (skeleton->branch_count >= WD_MAX_BRANCHES || index >= WD_MAX_BRANCHES)
            return false;
        float share = at / parent.length_m, z = skeleton->nodes[parent.first_node].position_m.z;
        struct joint joint = {.parent = parent_index, .share = share};
        joint.height = stool ? share : wd_clampf((z - crown_low) / (form->height_m - crown_low),
                                                 0, 1);
        float left = wd_random_range(&random, 0, 1) < 0.08f ? 0.5f : 0;
        float turn = ((int)index & 1) + left;
        joint.around_rad = (float)WD_PI * turn;
        joint.jitter_rad = (1 - (form->clip ? 0 : spec->flatness)) * (float)WD_PI * 0.55f;
        joint.length_m = spec->length_ratio * limb * (1.15f - 0.75f * share);
        joint.length_m *= wd_random_range(&random, 0.8f, 1.1f);
        joint.key = wd_hash3(parent.key, 0xb0, (uint32_t)index);
        if (still_there(form, joint.key))
            grow_joint(skeleton, form, order, &joint);
        at += spacing * wd_random_range(&random, 0.7f, 1.3f);
    }
    return true;
}

/* In radii of the crown: of forks that fork again, and between forks. */
#define LEAST_FORKED 0.45f
#define FORK_SPACING 0.16f
#define FORK_START 0.28f /* share of the limb */

/* A limb's forks, left and right in turn, each nearly as long as what is left of it. Low ones have room all about. */
static bool fork_limb(struct wd_skeleton *skeleton, const struct wd_tree_form *form, int parent_index)
{
    struct wd_branch parent = skeleton->branches[parent_index];
    struct wd_random random = wd_random_of(parent.key, 0xf02c);
    float spacing = FORK_SPACING * form->crown_radius_m;
    float lower = 1 - wd_smoothf(form->bole_m, 0.5f * form->height_m, skeleton->nodes[parent.first_node].position_m.z);
    spacing *= 1 - 0.3f * lower;
    int index = wd_random_unit(&random) < 0.5f;
    for (float at = FORK_START * parent.length_m; at < 0.95f * parent.length_m; index++) {
        float share = at / parent.length_m;
        struct joint joint = {.parent = parent_index, .share = share, .height = share, .jitter_rad = 1.1f};
        joint.around_rad = (float)WD_PI * (float)(index & 1);
        joint.length_m = parent.length_m * (1.05f - 0.85f * share) * wd_random_range(&random, 0.65f, 1);
        joint.length_m *= 1 + 0.4f * lower;
        joint.key = wd_hash3(parent.key, 0xf0, (uint32_t)index);
        if (skeleton->branch_count >= WD_MAX_BRANCHES)
            return false;
        if (wd_hash_unit(joint.key) < form->dissolved)
            grow_joint(skeleton, form, 0, &joint);
        at += spacing * wd_random_range(&random, 0.6f, 1.4f);
    }
    return true;
}

/* Limbs of a stem that has dissolved fork, and their forks do. */
static bool grow_forks(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    for (int i = 1; form->dissolved > 0 && i < (int)skeleton->branch_count; i++) {
        const struct wd_branch *limb = &skeleton->branches[i];
        const struct wd_branch *parent = &skeleton->branches[limb->parent];
        bool long_fork = parent->parent == 0 && limb->length_m > LEAST_FORKED * form->crown_radius_m;
        if ((limb->parent == 0 || long_fork) && !fork_limb(skeleton, form, i))
            return false;
    }
    return true;
}

/* Order by order, so that branches of one order compete for the same gaps. Twigs also stand on the
 * ends of everything thicker. */
static bool grow_order(struct wd_skeleton *skeleton, const struct wd_tree_form *form, int order)
{
    int count = (int)skeleton->branch_count;
    bool leader = form->species->form == WD_FORM_BROADLEAF && wd_tree_trunk_end(form) > 0.7f;
    for (int i = 0; i < count; i++) {
        int parent = skeleton->branches[i].order;
        bool next = parent == order - 1 || (parent == WD_TRUNK && leader && order == 1);
        if (next && !grow_along(skeleton, form, order, i))
            return false;
    }
    return true;
}

static bool grow_branches(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    const struct wd_species *species = form->species;
    bool stool = species->form == WD_FORM_SHRUB || species->form == WD_FORM_BRAMBLE;
    bool ok = true;
    if (species->order_count == 0)
        return true;
    if (!stool)
        ok = grow_limbs(skeleton, form) && grow_forks(skeleton, form);
    for (size_t i = 0; ok && stool && i < skeleton->stem_count; i++)
        ok = grow_along(skeleton, form, 0, (int)i);
    for (int order = 1; ok && order < (int)species->order_count; order++)
        ok = grow_order(skeleton, form, order);
    return ok;
}

bool wd_skeleton_grow(struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                      const struct wd_log *log)
{
    *skeleton = (struct wd_skeleton){0};
    float reach = 1.3f * form->crown_radius_m;
    wd_tree_density_init(&skeleton->crowd, WD_V3(-reach, -reach, 0),
                         WD_V3(reach, reach, 1.1f * form->height_m),
                         wd_maxf(0.12f * form->crown_radius_m, 0.05f));
    wd_skeleton_grow_stems(skeleton, form);
    if (!grow_branches(skeleton, form)) {
        wd_skeleton_finish(skeleton);
        return wd_error(log, "%s: orders: %s of %g m has more than %d branches; allowed are wider "
                             "spacing_m or fewer orders",
                        form->species->path ? form->species->path : "species",
                        form->species->name, (double)form->height_m, WD_MAX_BRANCHES);
    }
    wd_skeleton_set_flexibility(skeleton, form);
    return true;
}
