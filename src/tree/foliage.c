#include "tree/foliage.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "tree/fronds.h"
#include "tree/look.h"
#include "tree/progressive.h"

enum { MAX_LEAF_TRIANGLES = 600000, BARE_TWIGS = 5000 };
#define SPRIG_SHARE 0.6f /* sprigs in place of leaves, each with more triangles */
enum { SPRIG_TRIANGLES = 8, LEAST_SPRIG_TRIANGLES = 2, ALL_SPRIG_TRIANGLES = 80000 };
#define HEDGE_SHARE 0.4f /* of the leaf area index of a forest */
#define HEDGE_SHELL_M 0.18f

/* A piece of a twig that bears leaves. */
struct carrier {
    size_t branch;
    float from, length_m, weight; /* from: share of the branch where leaves begin */
};

struct carriers {
    struct carrier *items;
    size_t count, capacity;
    float weight;
};

void wd_foliage_finish(struct wd_foliage *foliage)
{
    free(foliage->leaves);
    free(foliage->flowers);
    wd_tree_density_finish(&foliage->crown);
    *foliage = (struct wd_foliage){0};
}

/* Leaves stand on the last order all along and on the outer ends of the one before. */
static float grown_leafy_from(const struct wd_tree_form *form, const struct wd_branch *branch)
{
    int last = (int)form->species->order_count - 1;
    bool tuft = form->species->leaf.shape == WD_LEAF_NEEDLES &&
                form->species->leaf.needles == WD_NEEDLES_FASCICLES;
    if (branch->order == last)
        return tuft ? 0.45f : 0.12f;
    if (branch->order == last - 1 && branch->order >= 0 && tuft)
        return 0.85f;
    if (branch->order == last - 1 && branch->order >= 0)
        return form->species->form == WD_FORM_CONIFER && last < 2 ? 0.35f : 0.55f;
    if (branch->order == WD_TRUNK && form->species->form == WD_FORM_BRAMBLE)
        return 0.12f;
    if (branch->order == WD_TRUNK && form->species->form == WD_FORM_SHRUB)
        return 0.8f;
    return branch->order == WD_TRUNK ? 0.975f : 0.9f;
}

/* A young tree's limbs are twigs, and so is the end of its leader. */
static float leafy_from(const struct wd_tree_form *form, const struct wd_branch *branch)
{
    float grown = grown_leafy_from(form, branch), young = branch->order == WD_TRUNK ? 0.86f : 0.15f;
    return wd_mixf(grown, wd_minf(grown, young), form->youth);
}

static void gather_carriers(struct carriers *carriers, const struct wd_skeleton *skeleton,
                            const struct wd_tree_form *form)
{
    for (size_t b = 0; b < skeleton->branch_count; b++) {
        float from = leafy_from(form, &skeleton->branches[b]);
        struct carrier *carrier = wd_push(carriers->items, carriers->count, carriers->capacity);
        *carrier = (struct carrier){b, from, (1 - from) * skeleton->branches[b].length_m, 0};
    }
}

static void fill_crown(struct wd_foliage *foliage, const struct wd_skeleton *skeleton,
                       const struct carriers *carriers, float area_per_weight, bool weighted)
{
    for (size_t i = 0; i < carriers->count; i++) {
        const struct carrier *carrier = &carriers->items[i];
        float amount = area_per_weight * (weighted ? carrier->weight : carrier->length_m);
        for (int part = 0; part < 3; part++) {
            struct wd_vec3 d;
            size_t node;
            float share = wd_mixf(carrier->from, 1, ((float)part + 0.5f) / 3);
            struct wd_vec3 p = wd_branch_point(skeleton, &skeleton->branches[carrier->branch],
                                               share, &d, &node);
            wd_tree_density_add(&foliage->crown, p, amount / 3);
        }
    }
}

/* 0 where the crown is wide .. 1 at the end of a pointed one. */
static float spire(const struct wd_tree_form *form, float z)
{
    float wide = wd_tree_envelope_m(form, WD_V3(0, 0, z)) / form->crown_radius_m;
    return 1 - wd_smoothf(0.1f, 0.6f, wide);
}

/* A twig bears leaves by its length and by the light that reaches it. */
static void weigh_carriers(struct carriers *carriers, struct wd_foliage *foliage,
                           const struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                           float area_m2)
{
    float length = 0;
    for (size_t i = 0; i < carriers->count; i++)
        length += carriers->items[i].length_m;
    fill_crown(foliage, skeleton, carriers, area_m2 / length, false);
    wd_tree_density_light(&foliage->crown);
    for (size_t i = 0; i < carriers->count; i++) {
        struct carrier *carrier = &carriers->items[i];
        struct wd_vec3 d;
        size_t node;
        struct wd_vec3 p = wd_branch_point(skeleton, &skeleton->branches[carrier->branch], 0.7f,
                                           &d, &node);
        float sky = wd_tree_density_sky(&foliage->crown, p);
        carrier->weight = carrier->length_m * (0.35f + sky);
        if (form->species->form == WD_FORM_CONIFER) /* few and short twigs hide a spire's stem */
            carrier->weight *= 1 + 0.35f * spire(form, p.z);
        if (form->clip) /* lit from its sides, and what is cut buds behind the cut */
            carrier->weight = carrier->length_m *
                              (wd_clip_near_shell(form->clip, p, HEDGE_SHELL_M) ? 4 : 1);
        carriers->weight += carrier->weight;
    }
    wd_tree_density_clear(&foliage->crown);
    fill_crown(foliage, skeleton, carriers, area_m2 / carriers->weight, true);
    wd_tree_density_light(&foliage->crown);
    wd_tree_density_blur(&foliage->crown);
    wd_tree_density_blur(&foliage->crown);
}

static int leaves_a_node(const struct wd_species *species)
{
    if (species->leaf.shape == WD_LEAF_NEEDLES)
        return 1;
    return species->leaf.phyllotaxis == WD_PHYLLOTAXIS_OPPOSITE  ? 2
           : species->leaf.phyllotaxis == WD_PHYLLOTAXIS_WHORLED ? 3
                                                                 : 1;
}

/* Where around the twig the n-th leaf stands: pairs and whorls turn from node to node so that each
 * stands over the gap of the one before; single leaves in two rows on flat sprays, else a spiral. */
static struct wd_vec3 leaf_side(const struct wd_tree_form *form, struct wd_vec3 twig, int n,
                                struct wd_random *random)
{
    const struct wd_species *species = form->species;
    struct wd_vec3 side = wd_v3_side(twig), over = wd_v3_cross(side, twig);
    bool rows = species->orders[species->order_count - 1].flatness > 0.6f;
    int per = leaves_a_node(species), node = n / per;
    float angle = (float)n * 2.3999632f;
    if (per > 1)
        angle = (float)WD_PI * ((float)(2 * (n % per)) + (float)(node & 1)) / (float)per;
    else if (rows)
        angle = (float)WD_PI * (float)(n & 1);
    angle += (per > 1 || rows ? 0.3f : 0.15f) * wd_random_signed(random);
    return wd_v3_turn(side, over, angle);
}

static void turn_broadleaf(struct wd_leaf *leaf, const struct wd_tree_form *form,
                           struct wd_vec3 twig, struct wd_vec3 side, struct wd_random *random)
{
    float droop = form->species->leaf.droop;
    struct wd_vec3 axis = wd_v3_mad(wd_v3_scale(twig, 0.6f), side, 0.8f);
    axis = wd_v3_add(axis, WD_V3(0, 0, -1.2f * droop * wd_random_range(random, 0.5f, 1.2f)));
    leaf->axis = wd_v3_unit(wd_v3_mad(axis, wd_random_vec3(random), 0.25f));
    struct wd_vec3 light = wd_v3_mad(WD_V3(0, 0, 0.75f), leaf->shading, 0.7f);
    light = wd_v3_mad(light, wd_random_vec3(random), 0.45f);
    leaf->normal = wd_v3_square(light, leaf->axis);
}

static void turn_shoot(struct wd_leaf *leaf, const struct wd_tree_form *form, struct wd_vec3 twig,
                       struct wd_vec3 side, struct wd_random *random)
{
    float droop = form->species->leaf.droop;
    bool tuft = form->species->leaf.shape == WD_LEAF_NEEDLES &&
                form->species->leaf.needles == WD_NEEDLES_FASCICLES;
    struct wd_vec3 axis = wd_v3_mad(twig, side, (tuft ? 0.7f : 0.55f) *
                                                    wd_random_range(random, 0.5f, 1.2f));
    axis = wd_v3_add(axis, WD_V3(0, 0, (tuft ? 0.5f : -1.3f * droop) *
                                           wd_random_range(random, 0.5f, 1)));
    leaf->axis = wd_v3_unit(wd_v3_mad(axis, wd_random_vec3(random), 0.15f));
    struct wd_vec3 light = wd_v3_mad(WD_V3(0, 0, 1), leaf->shading, 0.5f);
    leaf->normal = wd_v3_square(wd_v3_mad(light, wd_random_vec3(random), 1.3f), leaf->axis);
}

/* Leaves differ a little one by one, more from branch to branch; those in the light are paler. */
static void tint_leaf(struct wd_leaf *leaf, uint32_t clump_key, struct wd_random *random)
{
    float clump = wd_hash_unit(wd_hash2(clump_key, 0xc1)) - 0.5f;
    float warm = 0.10f * (wd_hash_unit(wd_hash2(clump_key, 0xc2)) - 0.5f) +
                 0.10f * wd_random_signed(random);
    float bright = WD_LEAF_TINT_MEAN * (1 + 0.16f * clump + 0.12f * wd_random_signed(random)) +
                   0.12f * (leaf->sky - 0.4f);
    leaf->tint[0] = wd_clampf(bright * (1 + warm), 0, 1);
    leaf->tint[1] = wd_clampf(bright, 0, 1);
    leaf->tint[2] = wd_clampf(bright * (1 - warm), 0, 1);
}

static void place_leaf(struct wd_leaf *leaf, const struct wd_foliage *foliage,
                       const struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                       const struct carrier *carrier, int n, int of)
{
    const struct wd_branch *branch = &skeleton->branches[carrier->branch];
    leaf->key = wd_hash3(branch->key, 0x1eaf, (uint32_t)n);
    struct wd_random random = wd_random_of(leaf->key, 1);
    int per = leaves_a_node(form->species), nodes = (of + per - 1) / per;
    struct wd_random joint = wd_random_of(wd_hash3(branch->key, 0x70de, (uint32_t)(n / per)), 1);
    float place = ((float)(n / per) + wd_random_unit(&joint)) / (float)nodes;
    struct wd_vec3 twig;
    size_t node;
    struct wd_vec3 p = wd_branch_point(skeleton, branch, wd_mixf(carrier->from, 1, place), &twig,
                                       &node);
    struct wd_vec3 side = leaf_side(form, twig, n, &random);
    bool needles = form->species->leaf.shape == WD_LEAF_NEEDLES;
    leaf->sky = wd_tree_density_sky(&foliage->crown, p);
    struct wd_vec3 outward = wd_tree_density_outward(&foliage->crown, p);
    leaf->shading = wd_v3_unit(wd_v3_mad(wd_tree_crown_direction(form, p), outward, 1.2f));
    if (needles)
        turn_shoot(leaf, form, twig, side, &random);
    else
        turn_broadleaf(leaf, form, twig, side, &random);
    leaf->size_m = wd_mixf(1.2f, 0.85f, wd_clampf(1.5f * leaf->sky, 0, 1)) *
                   wd_random_range(&random, 0.8f, 1.15f);
    float gap = form->species->orders[form->species->order_count - 1].spacing_m;
    float loose = needles ? 0.02f : form->species->leaf.count == 0 ? 0 : 0.3f * gap;
    if (needles) /* a spire ends in short shoots */
        leaf->size_m *= wd_clampf(0.32f + 2.2f * wd_tree_envelope_m(form, WD_V3(0, 0, p.z)) /
                                              form->crown_radius_m, 0.42f, 1);
    leaf->position_m = wd_v3_mad(p, wd_random_vec3(&joint), loose * form->scale);
    leaf->flexibility = skeleton->nodes[node].flexibility;
    int parent = branch->parent >= 0 ? branch->parent : 0;
    tint_leaf(leaf, skeleton->branches[parent].key, &random);
}

/* leaves[i] becomes what leaves[order[i]] is, cycle by cycle; `order` is used up. */
static void put_in_order(struct wd_leaf *leaves, uint32_t *order, size_t count)
{
    for (size_t first = 0; first < count; first++) {
        struct wd_leaf kept = leaves[first];
        size_t at = first, next = order[at];
        for (; next != first; at = next, next = order[at]) {
            leaves[at] = leaves[next];
            order[at] = (uint32_t)at;
        }
        leaves[at] = kept;
        order[at] = (uint32_t)at;
    }
}

/* So that the first n leaves are spread over the crown as evenly as all of them. */
static void order_leaves(struct wd_foliage *foliage, uint32_t key)
{
    size_t count = foliage->count;
    struct wd_vec3 *places = wd_alloc_array(count + 1, sizeof *places);
    uint32_t *order = wd_alloc_array(count + 1, sizeof *order);
    for (size_t i = 0; i < count; i++)
        places[i] = foliage->leaves[i].position_m;
    wd_progressive_order(order, places, count, key);
    put_in_order(foliage->leaves, order, count);
    free(places);
    free(order);
}

/* What a sapling has had the years to grow, by its height. */
static float young_area_m2(const struct wd_tree_form *form)
{
    return 0.11f * form->species->leaf.area_index * form->height_m * form->height_m;
}

/* Leaf area of the whole tree from the leaf area index over the crown's projection. Crowns in the
 * open are lit from the side as well: they carry as much more as they are longer than wide. So are
 * those of young trees, down to the ground. */
static float leaf_area_m2(const struct wd_tree_form *form)
{
    float projection = (float)WD_PI * form->crown_radius_m * form->crown_radius_m;
    if (form->clip) /* light comes to its sides too: leaves all over them, less deep */
        return HEDGE_SHARE * form->clip->shell_m2 * form->species->leaf.area_index;
    float slender = (form->height_m - form->crown_base_m) / (2 * form->crown_radius_m);
    float lit = wd_mixf(1, wd_clampf(slender, 1, 1.3f), form->openness);
    lit = wd_mixf(lit, wd_clampf(slender, 1, 2), form->youth);
    float area = 1.1f * lit * projection * form->species->leaf.area_index;
    if (form->species->form == WD_FORM_BROADLEAF) /* an oak of 2 m has some 500 leaves, however wide it is */
        area = wd_mixf(area, wd_minf(area, young_area_m2(form)), form->youth);
    return area;
}

/* Small trees draw fewer leaves, and never smaller ones than real. Large ones draw larger leaves,
 * but for plants that are seen from near. */
static size_t leaf_count(const struct wd_tree_form *form, float area_m2)
{
    const struct wd_species *species = form->species;
    bool needles = species->leaf.shape == WD_LEAF_NEEDLES;
    double spread = wd_dpow((double)form->spread, form->spread < 1 ? 0.9 : 1.1);
    if (species->leaf.count == 0)
        return 0;
    double count = (double)species->leaf.count * (double)form->detail;
    bool low = species->form == WD_FORM_SHRUB || species->form == WD_FORM_BRAMBLE;
    count *= fmin(spread, needles ? 1 : low ? 4 : 1.2);
    double real_m = 0.01 * (double)(needles ? species->leaf.shoot_cm : species->leaf.length_cm);
    double most = (double)(area_m2 / wd_leaf_unit_area(species)) / (real_m * real_m);
    if (form->clip) /* a hedge is seen from near, and cut shoots bear smaller leaves */
        count = 1.25 * most;
    else if (count > most)
        count = most;
    size_t triangles = wd_leaf_least_triangles(species);
    if (!needles && !wd_species_has_fronds(species) && most > (double)WD_SPRIG_FROM * count) {
        count *= (double)SPRIG_SHARE;
        triangles = SPRIG_TRIANGLES;
    }
    size_t bound = MAX_LEAF_TRIANGLES / triangles;
    return count < 40 ? 40 : count > (double)bound ? bound : (size_t)count;
}

/* Sprays that would hang into the ground lie on it; of sprigs, which reach beyond a length, the
 * leaves hang a little below the axis. */
static void lift_leaf(struct wd_leaf *leaf, float reach)
{
    float edge = 0.5f * leaf->size_m * (1 - fabsf(leaf->normal.z)); /* it stands on its side */
    float below = reach > 1 ? 0.25f * leaf->size_m : 0, length = reach * leaf->size_m;
    leaf->position_m.z = wd_maxf(leaf->position_m.z, 0.01f + edge + below);
    float room = 0.03f + below - leaf->position_m.z;
    if (leaf->axis.z * length >= room)
        return;
    leaf->axis = wd_v3_unit(WD_V3(leaf->axis.x, leaf->axis.y,
                                  wd_clampf(room / length, -0.9f, 0.5f)));
    leaf->normal = wd_v3_square(leaf->normal, leaf->axis);
}

/* Few or narrow leaves that would have to be longer than this share of the tree to have its leaf area leave it less. */
#define LONGEST_LEAF 0.25f

static float longest_leaf_m(const struct wd_tree_form *form)
{
    const struct wd_species *species = form->species;
    bool needles = species->leaf.shape == WD_LEAF_NEEDLES;
    float own_m = 0.01f * (needles ? species->leaf.shoot_cm : species->leaf.length_cm);
    return wd_maxf(LONGEST_LEAF * form->height_m, 1.5f * own_m);
}

static void scale_leaves(struct wd_foliage *foliage, const struct wd_tree_form *form, float area_m2)
{
    float unit = wd_leaf_unit_area(form->species), sum = 0, longest = 0;
    for (size_t i = 0; i < foliage->count; i++) {
        sum += unit * foliage->leaves[i].size_m * foliage->leaves[i].size_m;
        longest = wd_maxf(longest, foliage->leaves[i].size_m);
    }
    float grow = sum > 0 ? sqrtf(area_m2 / sum) : 0, most_m = longest_leaf_m(form);
    if (grow * longest > most_m) {
        grow = most_m / longest;
        area_m2 = grow * grow * sum;
    }
    for (size_t i = 0; i < foliage->count; i++)
        foliage->leaves[i].size_m *= grow;
    float reach = wd_foliage_reach(foliage, form->species);
    for (size_t i = 0; i < foliage->count; i++)
        lift_leaf(&foliage->leaves[i], reach);
    foliage->area_m2 = area_m2;
}

/* The grid around wood and leaves, from a little below the crown. */
static void init_crown(struct wd_foliage *foliage, const struct wd_skeleton *skeleton,
                       const struct wd_tree_form *form)
{
    float cell = wd_maxf(0.09f * form->crown_radius_m, 0.012f * form->height_m);
    bool fronds = wd_species_has_fronds(form->species);
    float around = fronds ? form->crown_radius_m : 4 * cell;
    struct wd_vec3 low = WD_V3(0, 0, form->crown_base_m), high = WD_V3(0, 0, form->height_m);
    for (size_t b = 0; b < skeleton->branch_count; b++) {
        const struct wd_branch *branch = &skeleton->branches[b];
        for (size_t i = 0; i < branch->node_count; i++) {
            struct wd_vec3 p = skeleton->nodes[branch->first_node + i].position_m;
            if (branch->order == WD_TRUNK)
                p.z = wd_maxf(p.z, form->crown_base_m);
            low = wd_v3_min(p, low);
            high = wd_v3_max(p, high);
        }
    }
    low = wd_v3_sub(low, WD_V3(around, around, fronds ? around : 3 * cell));
    high = wd_v3_add(high, WD_V3(around, around, 4 * cell));
    low.z = wd_maxf(low.z, -cell);
    wd_tree_density_init(&foliage->crown, low, high, cell);
}

static void scale_all(struct wd_leaf *leaves, size_t count, float factor)
{
    for (size_t i = 0; i < count; i++) {
        leaves[i].position_m = wd_v3_scale(leaves[i].position_m, factor);
        leaves[i].size_m *= factor;
    }
}

void wd_foliage_scale(struct wd_foliage *foliage, float factor)
{
    scale_all(foliage->leaves, foliage->count + foliage->twig_count, factor);
    scale_all(foliage->flowers, foliage->flower_count, factor);
    foliage->area_m2 *= factor * factor;
    foliage->crown.origin_m = wd_v3_scale(foliage->crown.origin_m, factor);
    foliage->crown.cell_m *= factor;
}

/* Flowers stand where light reaches, the best lit first; those of leafless months where leaves
 * would. `places` are in progressive order. */
static void choose_flowers(struct wd_foliage *foliage, const struct wd_tree_form *form,
                           const struct wd_leaf *places, size_t count)
{
    const struct wd_species *species = form->species;
    double spread = wd_species_has_fronds(species)
                        ? (double)count / fmax((double)species->leaf.count, 1)
                        : wd_dpow((double)form->spread, 1.1);
    size_t wanted = (size_t)((double)species->flower.count * fmin(spread, 4) + 0.5);
    foliage->flowers = wd_alloc_array(wanted + 1, sizeof *foliage->flowers);
    for (float least = 0.6f; least > 0.1f; least -= 0.1f)
        for (size_t i = 0; i < count && foliage->flower_count < wanted; i++)
            if (places[i].sky > least && (least > 0.55f || places[i].sky <= least + 0.1f))
                foliage->flowers[foliage->flower_count++] = places[i];
}

/* They have fallen where leaves stand, in no particular month too. */
static bool flowers_before_leaves(const struct wd_species *species)
{
    return !species->leaf.evergreen && species->flower.months[1] < species->leaf.months[0];
}

/* Leaves by the weight of what carries them. */
static void place_leaves(struct wd_foliage *foliage, const struct wd_skeleton *skeleton,
                         const struct wd_tree_form *form, const struct carriers *carriers,
                         size_t wanted)
{
    foliage->leaves = wd_alloc_array(wanted + 1, sizeof *foliage->leaves);
    double given = 0, weight = 0;
    for (size_t i = 0; i < carriers->count; i++) {
        weight += (double)carriers->items[i].weight;
        int of = (int)((double)wanted * weight / (double)carriers->weight - given);
        given += of;
        for (int n = 0; n < of && foliage->count < wanted; n++) {
            struct wd_leaf *leaf = &foliage->leaves[foliage->count];
            place_leaf(leaf, foliage, skeleton, form, &carriers->items[i], n, of);
            foliage->count += !wd_tree_is_cut(form, leaf->position_m);
        }
    }
}

/* The thinnest twigs grow with the leaves that hide them; where these have fallen they are what is
 * seen of a crown. A bramble's leaves stand on its canes. */
static size_t twig_count(const struct wd_tree_form *form)
{
    if (form->species->order_count == 0 || form->species->form == WD_FORM_SNAG ||
        form->species->form == WD_FORM_BRAMBLE)
        return 0;
    double spread = wd_dpow((double)form->spread, form->spread < 1 ? 0.9 : 1.1);
    return (size_t)(BARE_TWIGS * (double)form->detail * fmin(spread, 1.5));
}

/* Places of a leafless month: for twigs, and for flowers that come before the leaves. */
static void place_bare(struct wd_foliage *foliage, const struct wd_skeleton *skeleton,
                       const struct wd_tree_form *form, const struct carriers *carriers)
{
    size_t twigs = twig_count(form), flowers = 4 * (size_t)form->species->flower.count;
    place_leaves(foliage, skeleton, form, carriers, twigs > flowers ? twigs : flowers);
    for (size_t i = 0; i < foliage->count; i++)
        foliage->leaves[i].size_m *= 0.01f * form->species->leaf.length_cm;
    order_leaves(foliage, form->key);
    choose_flowers(foliage, form, foliage->leaves, foliage->count);
    foliage->twig_count = twigs < foliage->count ? twigs : foliage->count;
    foliage->count = 0;
}

void wd_foliage_grow(struct wd_foliage *foliage, const struct wd_skeleton *skeleton,
                     const struct wd_tree_form *form)
{
    float detail = fminf(form->detail, 1);
    *foliage = (struct wd_foliage){
        .sprig_triangles = (uint32_t)wd_mixf(LEAST_SPRIG_TRIANGLES, SPRIG_TRIANGLES, detail),
        .all_sprig_triangles = (uint32_t)(ALL_SPRIG_TRIANGLES * detail * detail)};
    struct carriers carriers = {0};
    float area = leaf_area_m2(form);
    size_t wanted = leaf_count(form, area);
    area = wanted > 0 ? area : 0;
    init_crown(foliage, skeleton, form);
    if (wd_species_has_fronds(form->species)) {
        wd_fronds_place(foliage, skeleton, form);
        order_leaves(foliage, form->key);
        choose_flowers(foliage, form, foliage->leaves, foliage->count);
        return;
    }
    gather_carriers(&carriers, skeleton, form);
    weigh_carriers(&carriers, foliage, skeleton, form, area);
    if (wanted == 0) {
        place_bare(foliage, skeleton, form, &carriers);
        free(carriers.items);
        return;
    }
    place_leaves(foliage, skeleton, form, &carriers, wanted);
    free(carriers.items);
    scale_leaves(foliage, form, area);
    order_leaves(foliage, form->key);
    if (!flowers_before_leaves(form->species))
        choose_flowers(foliage, form, foliage->leaves, foliage->count);
}
