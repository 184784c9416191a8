#include "tree/skeleton.h"

/* Leonardo's rule: the cross-section of the wood above a joint equals that below it, so the radius
 * goes with the square root of the length of twigs carried. */

#define TIP_RADIUS_M 0.0035f

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

/* A stem with one leader tapers by height alone; one that dissolves, by what it carries. */
static void set_trunk(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    const struct wd_branch *trunk = &skeleton->branches[0];
    float leader = form->species->apical_dominance, all = skeleton->nodes[0].load;
    float base = 0.5f * form->dbh_m, above = fmaxf(form->height_m - 1.3f, 0.3f * form->height_m);
    for (size_t i = 0; i < trunk->node_count; i++) {
        struct wd_skeleton_node *node = &skeleton->nodes[trunk->first_node + i];
        float height = wd_clampf((form->height_m - node->position_m.z) / above, 0, 1.1f);
        float clear = 1 - 0.16f * wd_clampf(node->position_m.z / form->crown_base_m, 0, 1);
        float carried = clear * sqrtf(node->load / all);
        float taper = (float)wd_dpow((double)height, 0.85);
        node->radius_m = fmaxf(base * (leader > 0.85f ? taper : carried), TIP_RADIUS_M);
    }
}

/* The trunk's part grows with height; each branch begins as its parent does there, so that nothing
 * tears at the joints. */
static void set_flexibility(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
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

void wd_skeleton_set_radii(struct wd_skeleton *skeleton, const struct wd_tree_form *form)
{
    set_loads(skeleton);
    set_trunk(skeleton, form);
    set_flexibility(skeleton, form);
    float base = 0.5f * form->dbh_m, all = skeleton->nodes[0].load;
    for (size_t b = 1; b < skeleton->branch_count; b++) {
        const struct wd_branch *branch = &skeleton->branches[b];
        struct wd_skeleton_node *nodes = &skeleton->nodes[branch->first_node];
        float joint = skeleton->nodes[branch->parent_node].radius_m;
        float most = form->species->orders[branch->order].radius_ratio * joint;
        float wanted = base * sqrtf(nodes[0].load / all), shrink = 1;
        if (wanted > most)
            shrink = most / wanted;
        for (size_t i = 0; i < branch->node_count; i++) {
            float tip = 1 - 0.35f * (float)i / (float)branch->node_count;
            float radius = base * sqrtf(nodes[i].load / all) * shrink * tip;
            nodes[i].radius_m = wd_clampf(radius, fminf(TIP_RADIUS_M, 0.9f * joint), joint);
        }
    }
}
