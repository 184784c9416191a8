#include "tree/skeleton.h"

/* Leonardo's rule: the cross-section of the wood above a joint equals that below it, so the radius
 * goes with the square root of the length of twigs carried. */

/* Of a grown tree's thinnest branches that are drawn, and of a seedling's shoots. */
#define TIP_RADIUS_M 0.0035f
#define SHOOT_RADIUS_M 0.0013f

/* Radius of a young tree's side branches at their joint over that of its leader, at most: it would not lead
 * otherwise. */
#define YOUNG_RATIO 0.45f

/* Where a stem or a limb forks into two of like thickness. */
#define HEAVY_RATIO 0.92f

static float tip_radius_m(const struct wd_tree_form *form)
{
    return wd_mixf(TIP_RADIUS_M, SHOOT_RADIUS_M, form->youth);
}

static void set_loads(struct wd_skeleton *skeleton)
{
    for (size_t b = skeleton->branch_count; b-- > 0;) {
        const struct wd_branch *branch = &skeleton->branches[b];
        struct wd_skeleton_node *nodes = &skeleton->nodes[branch->first_node];
        float step = branch->length_m / (float)(branch->node_count - 1), sum = 0.05f;
        for (size_t i = branch->node_count; i-- > 0;) {
            sum += nodes[i].load + (branch->order == WD_TRUNK ? 0.3f * step : step);
            nodes[i].load = sum;
        }
        if (branch->parent >= 0)
            skeleton->nodes[branch->parent_node].load += sum;
    }
}

float wd_root_flare(const struct wd_tree_form *form, float dbh_m, float z_m)
{
    double above = (double)wd_maxf(z_m, -0.1f * dbh_m);
    return (form->species->root_flare - 1) *
           (float)wd_dexp(-above / (0.75 * (double)wd_maxf(dbh_m, 1e-4f)));
}

/* Radius of a stem at height z, between its nodes. */
static float radius_at_m(const struct wd_skeleton *skeleton, const struct wd_branch *stem, float z)
{
    const struct wd_skeleton_node *nodes = &skeleton->nodes[stem->first_node];
    size_t i = 0;
    while (i + 2 < stem->node_count && nodes[i + 1].position_m.z < z)
        i++;
    float low = nodes[i].position_m.z, high = nodes[i + 1].position_m.z;
    return wd_mixf(nodes[i].radius_m, nodes[i + 1].radius_m,
                   wd_clampf((z - low) / wd_maxf(high - low, 1e-4f), 0, 1));
}

/* Where diameters are taken there is a little of the flare, and taper has begun. */
static void fit_diameter(struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                         const struct wd_branch *stem)
{
    float at = (float)form->species->allometry.diameter_at_m;
    if (at <= 0 || form->height_m < 1.2f * at)
        return;
    float found = radius_at_m(skeleton, stem, at) * (1 + wd_root_flare(form, form->dbh_m, at));
    float factor = 0.5f * form->dbh_m / wd_maxf(found, tip_radius_m(form));
    for (size_t i = 0; i < stem->node_count; i++)
        skeleton->nodes[stem->first_node + i].radius_m *= factor;
}

/* A stem with one leader tapers by height alone; one that dissolves, by what it carries, the more the less young
 * it is. */
static void set_trunk(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    const struct wd_branch *trunk = &skeleton->branches[0];
    bool leads = form->species->apical_dominance > 0.85f;
    float all = skeleton->nodes[0].load, least = tip_radius_m(form);
    float whole = form->height_m / form->species->decay.broken_at; /* before it broke */
    float clear_m = wd_maxf(form->crown_base_m, 1e-3f); /* a crown may begin at the ground */
    float base = 0.5f * form->dbh_m, above = wd_maxf(whole - 1.3f, 0.3f * whole);
    for (size_t i = 0; i < trunk->node_count; i++) {
        struct wd_skeleton_node *node = &skeleton->nodes[trunk->first_node + i];
        float height = wd_clampf((whole - node->position_m.z) / above, 0, 1.1f);
        float clear = 1 - 0.16f * wd_clampf(node->position_m.z / clear_m, 0, 1);
        float carried = clear * sqrtf(node->load / all);
        float taper = (float)wd_dpow((double)height, 0.85);
        float thick = leads ? taper : wd_mixf(carried, taper, form->youth);
        node->radius_m = wd_maxf(base * thick, least);
    }
}

/* Stems of a stool are thinner the shorter they are; a palm's stem hardly tapers; a rootstock is a low dome. */
static void set_stem(struct wd_skeleton *skeleton, const struct wd_tree_form *form, size_t index)
{
    const struct wd_branch *stem = &skeleton->branches[index];
    struct wd_skeleton_node *nodes = &skeleton->nodes[stem->first_node];
    bool stool = form->species->form == WD_FORM_SHRUB || form->species->form == WD_FORM_BRAMBLE;
    float base = 0.5f * form->dbh_m, highest = 0;
    float tip = form->species->form == WD_FORM_FERN ? 0.15f : 0.75f;
    for (size_t i = 0; i < stem->node_count; i++)
        highest = wd_maxf(highest, nodes[i].position_m.z);
    if (stool) {
        base *= wd_clampf(highest / form->height_m, 0.3f, 1) *
                (0.8f + 0.2f * wd_hash_unit(stem->key));
        tip = 0.12f;
    }
    for (size_t i = 0; i < stem->node_count; i++) {
        float share = (float)i / (float)(stem->node_count - 1);
        nodes[i].radius_m = wd_maxf(base * wd_mixf(1, tip, share), wd_minf(0.3f * base, TIP_RADIUS_M));
    }
}

/* The trunk's part grows with height; each branch begins as its parent does there, so that nothing
 * tears at the joints. */
void wd_skeleton_set_flexibility(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    static const float share[3] = {0.45f, 0.55f, 0.8f};
    for (size_t b = 0; b < skeleton->branch_count; b++) {
        const struct wd_branch *branch = &skeleton->branches[b];
        struct wd_skeleton_node *nodes = &skeleton->nodes[branch->first_node];
        for (size_t i = 0; i < branch->node_count; i++) {
            float t = (float)i / (float)(branch->node_count - 1);
            if (branch->order == WD_TRUNK) {
                float height = nodes[i].position_m.z / form->height_m;
                nodes[i].flexibility = 100 * wd_clampf(height, 0, 1);
                continue;
            }
            float base = skeleton->nodes[branch->parent_node].flexibility;
            nodes[i].flexibility = wd_mixf(base, 200, t * share[branch->order]);
        }
    }
}

static void set_branch(struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                       const struct wd_branch *branch)
{
    struct wd_skeleton_node *nodes = &skeleton->nodes[branch->first_node];
    const struct wd_skeleton_node *foot =
        &skeleton->nodes[skeleton->branches[branch->stem].first_node];
    float base = skeleton->stem_count > 1 ? foot->radius_m : 0.5f * form->dbh_m;
    float joint = skeleton->nodes[branch->parent_node].radius_m;
    float ratio = form->species->orders[branch->order].radius_ratio, tip_m = tip_radius_m(form);
    if (branch->order == 0)
        ratio = wd_mixf(ratio, wd_maxf(ratio, HEAVY_RATIO), form->dissolved);
    float most = wd_mixf(ratio, wd_minf(ratio, YOUNG_RATIO), form->youth) * joint;
    float wanted = base * sqrtf(nodes[0].load / foot->load), shrink = 1;
    if (wanted > most)
        shrink = most / wanted;
    if (form->species->form == WD_FORM_SNAG) /* it no longer bears what made it thick */
        shrink = most * (0.55f + 0.45f * wd_hash_unit(branch->key)) / wanted;
    for (size_t i = 0; i < branch->node_count; i++) {
        float share = (float)i / (float)branch->node_count, tip = 1 - 0.35f * share;
        float radius = base * sqrtf(nodes[i].load / foot->load) * shrink * tip;
        if (form->species->form == WD_FORM_SNAG) /* broken off where it was still thick */
            radius = wanted * shrink * (1 - 0.45f * share);
        nodes[i].radius_m = wd_clampf(radius, wd_minf(tip_m, 0.9f * joint), joint);
    }
}

void wd_skeleton_set_radii(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    bool lone = form->species->order_count > 0 && skeleton->stem_count == 1 &&
                form->species->form != WD_FORM_SHRUB && form->species->form != WD_FORM_BRAMBLE;
    set_loads(skeleton);
    if (lone)
        set_trunk(skeleton, form);
    for (size_t i = 0; !lone && i < skeleton->stem_count; i++)
        set_stem(skeleton, form, i);
    if (skeleton->stem_count == 1)
        fit_diameter(skeleton, form, &skeleton->branches[0]);
    for (size_t b = skeleton->stem_count; b < skeleton->branch_count; b++)
        set_branch(skeleton, form, &skeleton->branches[b]);
}
