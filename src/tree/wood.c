#include "tree/wood.h"

#include <stdlib.h>

#include "base/memory.h"
#include "tree/buttress.h"
#include "tree/look.h"
#include "tree/look_map.h"

enum { MAX_RINGS = 48, FOOT_RINGS = 11, MAX_SIDES = 64, LEAST_SIDES = 3, MOST_STEP = 32 };
#define MOST_RADIUS_M 20.0f /* no branch is thicker */
/* Turns of the bark's tile a metre: what repeats up the stem comes to stand beside itself. */
#define BARK_DRIFT 0.09f
#define MOST_DEPTH_M 1.2f

struct ring {
    struct wd_vec3 center_m, direction;
    float radius_m, along_m, flexibility;
    float jag_m; /* splinters of broken wood stand up so far */
    struct wd_root_shape shape; /* what roots make of it, on a trunk */
    bool foot;   /* has the sides of the foot */
};

static int sides_of(float radius_m, int most)
{
    int sides = radius_m > 0.10f ? 12 : radius_m > 0.05f ? 8 : radius_m > 0.025f ? 6
              : radius_m > 0.012f ? 4 : 3;
    return sides < most ? sides : most;
}

static int gather_rings(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                        int node_step, struct ring *rings)
{
    int count = 0, last = (int)branch->node_count - 1;
    for (int i = 0; i <= last; i++) {
        if (i % node_step && i != last)
            continue;
        const struct wd_skeleton_node *node = &skeleton->nodes[branch->first_node + (size_t)i];
        rings[count++] = (struct ring){node->position_m, node->direction, node->radius_m,
                                       node->along_m, node->flexibility, .jag_m = 0};
    }
    return count;
}

static bool folds(const struct ring *a, const struct ring *b)
{
    struct wd_vec3 way = wd_v3_sub(b->center_m, a->center_m);
    struct wd_vec3 bend = wd_v3_sub(b->direction, a->direction);
    float thick = wd_maxf(a->radius_m * (1 + a->shape.flare), b->radius_m * (1 + b->shape.flare));
    return wd_v3_dot(way, wd_v3_add(a->direction, b->direction)) <
           2.2f * thick * wd_v3_length(bend);
}

/* Where wood bends more sharply than it is thick, rings would cut through one another: those that
 * would are left out, but never the first and the last. */
static int drop_folds(struct ring *rings, int count)
{
    int kept = 1;
    for (int i = 1; i < count; i++) {
        bool last = i == count - 1;
        while (last && kept > 1 && folds(&rings[kept - 1], &rings[i]))
            kept--;
        if (last || !folds(&rings[kept - 1], &rings[i]))
            rings[kept++] = rings[i];
    }
    return kept;
}

/* The collar where a branch leaves its parent. */
static int branch_rings(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                        int node_step, struct ring *rings)
{
    int count = gather_rings(skeleton, branch, node_step, rings);
    float joint = skeleton->nodes[branch->parent_node].radius_m;
    rings[0].radius_m = wd_minf(1.25f * rings[0].radius_m, 0.95f * joint);
    return count;
}

/* How a trunk's foot is made. Its lowest ring lies below ground, so that no gap shows on slopes. */
struct foot {
    struct wd_root_lobes lobes;
    const float *heights; /* of its rings, in stem diameters; the first for what is below ground */
    int count;
    int sides; /* 0: those of the stem above */
};

static struct foot foot_of(const struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                           const struct wd_wood_style *style)
{
    /* the flare falls off within two stem diameters, where the skeleton has few nodes */
    static const float round[] = {-1, 0, 0.25f, 0.6f, 1.1f, 1.9f};
    static const float lobed[FOOT_RINGS] = {-1,   0,     0.07f, 0.16f, 0.28f, 0.45f,
                                            0.7f, 1.02f, 1.4f,  1.85f, 2.3f};
    static const float coarse[] = {-1, 0, 0.12f, 0.3f, 0.6f, 1.02f, 1.6f, 2.3f};
    float dbh = skeleton->stem_count > 1 ? 2 * skeleton->nodes[0].radius_m : form->dbh_m;
    struct foot foot = {{.dbh_m = dbh}, round, sizeof round / sizeof *round, 0};
    if (skeleton->stem_count > 1 || style->foot_sides < WD_LOBE_PLACES)
        return foot;
    foot.lobes = wd_root_lobes_of(form, dbh);
    if (foot.lobes.strength <= 0)
        return foot;
    bool fine = style->foot_sides > WD_LOBE_PLACES;
    foot.sides = style->foot_sides;
    foot.heights = fine ? lobed : coarse;
    foot.count = fine ? FOOT_RINGS : (int)(sizeof coarse / sizeof *coarse);
    return foot;
}

/* Below ground, where roots end on a slope of twenty degrees. */
static float depth_m(const struct foot *foot, const struct wd_species *species)
{
    float dbh = foot->lobes.dbh_m, least = wd_clampf(0.75f * dbh, 0.02f, 0.3f);
    bool fins = wd_buttress_sides(species, 12) > 12;
    float reach = fins ? species->buttress.reach : foot->sides ? 1.25f : 0;
    return wd_maxf(least, wd_minf(0.37f * reach * dbh, MOST_DEPTH_M));
}

/* Between the nodes of a trunk, and below its first by as much as the way to the second at most. */
static struct ring trunk_ring(const struct ring *nodes, int count, float z)
{
    int i = 0;
    while (i + 2 < count && nodes[i + 1].center_m.z < z)
        i++;
    const struct ring *low = &nodes[i], *high = &nodes[i + 1];
    float share = (z - low->center_m.z) / wd_maxf(high->center_m.z - low->center_m.z, 0.01f);
    float up = wd_clampf(share, 0, 1);
    struct ring ring = *low;
    ring.center_m = wd_v3_mix(low->center_m, high->center_m, wd_clampf(share, -1, 1));
    ring.radius_m = wd_mixf(low->radius_m, high->radius_m, up);
    ring.flexibility = wd_mixf(low->flexibility, high->flexibility, up);
    ring.along_m = z;
    struct wd_vec3 from = i ? low->direction : WD_V3(0, 0, 1);
    ring.direction = wd_v3_unit(wd_v3_mix(from, high->direction, up));
    return ring;
}

static int trunk_rings(const struct wd_skeleton *skeleton, const struct wd_branch *trunk,
                       const struct wd_tree_form *form, const struct foot *foot, int node_step,
                       struct ring *rings)
{
    struct ring nodes[MAX_RINGS] = {0};
    int node_count = gather_rings(skeleton, trunk, node_step, nodes), count = 0;
    float dbh = foot->lobes.dbh_m, top = nodes[foot->sides ? node_count - 1 : 1].center_m.z;
    for (int i = 0; i < foot->count; i++) {
        float z = foot->heights[i] < 0 ? -depth_m(foot, form->species) : foot->heights[i] * dbh;
        if (count && z >= 0.95f * top)
            break;
        rings[count] = trunk_ring(nodes, node_count, z);
        rings[count++].foot = foot->sides > 0;
    }
    float above = rings[count - 1].center_m.z + 0.2f * dbh;
    for (int i = 1; i < node_count; i++)
        if (!foot->sides || i == node_count - 1 || nodes[i].center_m.z > above)
            rings[count++] = nodes[i];
    for (int i = 0; i < count; i++)
        rings[i].shape = wd_root_shape_at(&foot->lobes, form, rings[i].center_m.z);
    return count;
}

/* What is the same for all rings of as many sides: a circle, and on a trunk what roots and stem differ by. */
struct outline {
    int sides;
    float circle[MAX_SIDES][2];
    float low[MAX_SIDES], high[MAX_SIDES], oval[MAX_SIDES];
};

struct tube {
    struct wd_tree_mesh *mesh;
    const struct wd_tree_form *form;
    const struct wd_tree_density *crown;
    const struct wd_bark_tint *bark;
    bool trunk, fins; /* fins: buttresses shape its rings */
    float turns;      /* of the bark's tile around it */
    const struct foot *foot;               /* of a trunk */
    struct outline branch, stem, foot_line; /* foot_line: of rings of the foot */
};

static const struct outline *outline_of(const struct tube *tube, const struct ring *ring)
{
    return !tube->trunk ? &tube->branch : ring->foot ? &tube->foot_line : &tube->stem;
}

/* A trunk has bark, however thin its top is; a sapling's is as smooth and dark as a twig. */
static uint32_t ring_tint(const struct tube *tube, const struct ring *ring)
{
    float barked = tube->trunk ? 0.06f * (1 - tube->form->youth) : 0;
    float sky = wd_tree_density_sky(tube->crown, ring->center_m);
    float height = ring->center_m.z / tube->form->height_m;
    return wd_bark_tint_at(tube->bark, height, ring->radius_m + barked, sky);
}

/* Vertex i of a ring, in metres along its two axes. */
static void ring_place(const struct tube *tube, const struct ring *ring, int i, float place[2])
{
    const struct outline *outline = outline_of(tube, ring);
    float radius = ring->radius_m * (1 + ring->shape.flare + ring->shape.low * outline->low[i] +
                                     ring->shape.high * outline->high[i] + outline->oval[i]);
    if (tube->fins) {
        wd_buttress_outline(tube->form, ring->center_m.z, ring->radius_m, outline->sides, i, place);
    } else {
        place[0] = outline->circle[i][0];
        place[1] = outline->circle[i][1];
    }
    place[0] *= radius;
    place[1] *= radius;
}

/* The same trunk a little higher or lower. */
static struct ring ring_beside(const struct tube *tube, const struct ring *ring, float up_m)
{
    struct ring beside = *ring;
    beside.center_m.z += up_m;
    beside.shape = wd_root_shape_at(&tube->foot->lobes, tube->form, beside.center_m.z);
    return beside;
}

/* Square to the outline and to its slope, from places beside it; of a branch, away from its middle. */
static struct wd_vec3 ring_normal(const struct tube *tube, const struct ring near[3], int i,
                                  const float place[2], struct wd_vec3 side, struct wd_vec3 over)
{
    float x = place[0], y = place[1], z = 0;
    if (tube->trunk) {
        int sides = outline_of(tube, &near[1])->sides;
        float before[2], after[2], below[2], above[2];
        ring_place(tube, &near[1], (i + sides - 1) % sides, before);
        ring_place(tube, &near[1], (i + 1) % sides, after);
        ring_place(tube, &near[0], i, below);
        ring_place(tube, &near[2], i, above);
        x = after[1] - before[1];
        y = before[0] - after[0];
        z = -(x * (above[0] - below[0]) + y * (above[1] - below[1])) /
            (near[2].center_m.z - near[0].center_m.z);
    }
    struct wd_vec3 out = wd_v3_mad(wd_v3_scale(side, x), over, y);
    return wd_v3_unit(wd_v3_mad(out, near[1].direction, z));
}

static float splinter_m(const struct tube *tube, const struct ring *ring, int i)
{
    uint32_t place = (uint32_t)(int32_t)(1000 * ring->along_m);
    return ring->jag_m * wd_hash_unit(wd_hash3(tube->form->key, place, (uint32_t)i));
}

/* The bark's way down a root is longer than that down the stem. */
static float root_run_m(const struct tube *tube, const struct ring *ring, const float place[2])
{
    if (!tube->trunk || tube->foot->lobes.strength <= 0)
        return 0;
    return 0.45f * (sqrtf(place[0] * place[0] + place[1] * place[1]) - ring->radius_m);
}

static uint32_t add_ring(const struct tube *tube, const struct ring *ring, struct wd_vec3 side)
{
    struct wd_vec3 over = wd_v3_cross(ring->direction, side);
    uint32_t first = tube->mesh->vertex_count, tint = ring_tint(tube, ring);
    int sides = outline_of(tube, ring)->sides;
    struct ring near[3] = {*ring, *ring, *ring};
    for (int k = 0; k < 3 && tube->trunk; k += 2)
        near[k] = ring_beside(tube, ring, (float)(k - 1) * (0.03f * tube->foot->lobes.dbh_m + 1e-3f));
    for (int i = 0; i <= sides; i++) {
        float place[2];
        int at = i < sides ? i : 0;
        ring_place(tube, ring, at, place);
        struct wd_vec3 out = ring_normal(tube, near, at, place, side, over);
        struct wd_vec3 p = wd_v3_mad(ring->center_m, side, place[0]);
        p = wd_v3_mad(p, over, place[1]);
        if (ring->jag_m > 0)
            p = wd_v3_mad(p, ring->direction, splinter_m(tube, ring, at));
        float normal[3] = {out.x, out.y, out.z};
        float along = ring->along_m - root_run_m(tube, ring, place);
        struct wd_tree_vertex vertex = {
            .position_m = {p.x, p.y, p.z},
            .normal = wd_pack_normal(normal),
            .uv = wd_pack_uv(tube->turns * (float)i / (float)sides + BARK_DRIFT * ring->along_m,
                             along),
            .tint = tint,
            .kind = (uint32_t)ring->flexibility & 0xffu,
        };
        wd_tree_mesh_add_vertex(tube->mesh, &vertex);
    }
    return first;
}

/* Rings of as many sides or not: of either, the side that ends first around the stem is next. */
static void join_rings(const struct tube *tube, uint32_t low, uint32_t low_sides, uint32_t high,
                       uint32_t high_sides)
{
    for (uint32_t i = 0, k = 0; i < low_sides || k < high_sides;) {
        if ((i + 1) * high_sides <= (k + 1) * low_sides) {
            wd_tree_mesh_add_triangle(tube->mesh, low + i, low + i + 1, high + k);
            i++;
        } else {
            wd_tree_mesh_add_triangle(tube->mesh, low + i, high + k + 1, high + k);
            k++;
        }
    }
}

static void close_tip(const struct tube *tube, const struct ring *ring, uint32_t low,
                      float beyond_m)
{
    struct wd_vec3 p = wd_v3_mad(ring->center_m, ring->direction, beyond_m);
    float normal[3] = {ring->direction.x, ring->direction.y, ring->direction.z};
    struct wd_tree_vertex vertex = {
        .position_m = {p.x, p.y, p.z},
        .normal = wd_pack_normal(normal),
        .uv = wd_pack_uv(0.5f * tube->turns + BARK_DRIFT * ring->along_m, ring->along_m),
        .tint = ring_tint(tube, ring),
        .kind = (uint32_t)ring->flexibility & 0xffu,
    };
    uint32_t tip = wd_tree_mesh_add_vertex(tube->mesh, &vertex);
    for (uint32_t i = 0; i < (uint32_t)outline_of(tube, ring)->sides; i++)
        wd_tree_mesh_add_triangle(tube->mesh, low + i, low + i + 1, tip);
}

/* The broken face has a hard edge: the ring again, facing along the stem. */
static uint32_t add_break(const struct tube *tube, const struct ring *ring, struct wd_vec3 side)
{
    uint32_t first = add_ring(tube, ring, side);
    float normal[3] = {ring->direction.x, ring->direction.y, ring->direction.z};
    for (uint32_t i = first; i < tube->mesh->vertex_count; i++)
        tube->mesh->vertices[i].normal = wd_pack_normal(normal);
    return first;
}

/* Rings share their vertices with the next segment; the frame is carried along without twist. A
 * thin branch ends in a point, a trunk that has dissolved in a blunt end between its limbs. */
static void add_tube(const struct tube *tube, const struct ring *rings, int count)
{
    struct wd_vec3 side = wd_v3_side(rings[0].direction);
    uint32_t low = add_ring(tube, &rings[0], side);
    float end = rings[count - 1].radius_m;
    int tubes = end > 0.02f || rings[count - 1].jag_m > 0 ? count : count - 1;
    for (int i = 1; i < tubes; i++) {
        side = wd_v3_square(side, rings[i].direction);
        uint32_t high = add_ring(tube, &rings[i], side);
        join_rings(tube, low, (uint32_t)outline_of(tube, &rings[i - 1])->sides, high,
                   (uint32_t)outline_of(tube, &rings[i])->sides);
        low = high;
    }
    bool broken = rings[count - 1].jag_m > 0 && tubes == count;
    float beyond = broken ? -0.4f * end : 0.7f * end;
    if (broken)
        low = add_break(tube, &rings[count - 1], side);
    close_tip(tube, &rings[count - 1], low, tubes == count ? beyond : 0);
}

static bool is_drawn(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                     const struct wd_wood_style *style)
{
    return branch->order == WD_TRUNK ||
           skeleton->nodes[branch->first_node].radius_m >= style->least_radius_m;
}

/* A trunk's without buttresses, above its foot. */
static int round_sides(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                       const struct foot *foot, const struct wd_wood_style *style)
{
    int most = style->most_sides, half = foot->sides / 2;
    bool rounder = branch->order == WD_TRUNK && half > most;
    return sides_of(skeleton->nodes[branch->first_node].radius_m, rounder ? half : most);
}

static int branch_sides(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                        const struct wd_species *species, const struct foot *foot,
                        const struct wd_wood_style *style)
{
    int sides = round_sides(skeleton, branch, foot, style);
    return branch->order == WD_TRUNK ? wd_buttress_sides(species, sides) : sides;
}

/* Bark has the same grain on thick and thin wood: whole turns where the seam would be seen, part of
 * the tile on branches. */
static float bark_turns(float radius_m)
{
    float turns = 2 * (float)WD_PI * radius_m / WD_BARK_TILE_WIDTH_M;
    return turns < 0.5f ? wd_maxf(turns, 0.02f) : floorf(turns + 0.5f);
}

static void set_circle(struct outline *outline, int sides)
{
    /* as wide from all sides together as the round branch: of the same girth (Cauchy) */
    double out = WD_PI / ((double)sides * wd_dsin(WD_PI / (double)sides));
    outline->sides = sides;
    for (int i = 0; i < sides; i++) {
        double angle = 2 * WD_PI * (double)i / (double)sides;
        outline->circle[i][0] = (float)(out * wd_dcos(angle));
        outline->circle[i][1] = (float)(out * wd_dsin(angle));
    }
}

static void take_off_mean(float *values, int count)
{
    float sum = 0;
    for (int i = 0; i < count; i++)
        sum += values[i];
    for (int i = 0; i < count; i++)
        values[i] -= sum / (float)count;
}

/* Stems are a little oval, and as thick on average as without their roots' lobes. */
static void set_trunk_outline(struct outline *outline, int sides, const struct wd_tree_form *form,
                              const struct wd_root_lobes *lobes)
{
    float phase = wd_hash_unit(form->key);
    set_circle(outline, sides);
    for (int i = 0; i < sides; i++) {
        float turn = (float)i / (float)sides;
        outline->oval[i] = 0.02f * (float)wd_dcos(2 * WD_PI * (double)(2 * turn + 3 * phase));
        if (lobes->strength > 0)
            wd_root_lobes_at(lobes, turn, &outline->low[i], &outline->high[i]);
    }
    take_off_mean(outline->low, sides);
    take_off_mean(outline->high, sides);
}

static void add_branch(struct tube *tube, const struct wd_skeleton *skeleton,
                       const struct wd_branch *branch, const struct wd_wood_style *style)
{
    struct ring rings[MAX_RINGS + FOOT_RINGS + 1];
    const struct foot *foot = tube->foot;
    const struct wd_tree_form *form = tube->form;
    int sides = branch_sides(skeleton, branch, form->species, foot, style), count;
    tube->trunk = branch->order == WD_TRUNK;
    tube->fins = sides > round_sides(skeleton, branch, foot, style);
    if (tube->trunk) {
        if (sides != tube->stem.sides)
            set_trunk_outline(&tube->stem, sides, form, &foot->lobes);
        if (foot->sides && foot->sides != tube->foot_line.sides)
            set_trunk_outline(&tube->foot_line, foot->sides, form, &foot->lobes);
        count = trunk_rings(skeleton, branch, form, foot, style->node_step, rings);
    } else {
        if (sides != tube->branch.sides)
            set_circle(&tube->branch, sides);
        count = branch_rings(skeleton, branch, style->node_step, rings);
    }
    count = drop_folds(rings, count);
    if (form->species->form == WD_FORM_SNAG)
        rings[count - 1].jag_m = 1.6f * rings[count - 1].radius_m;
    tube->turns = bark_turns(tube->trunk ? 0.5f * form->dbh_m : rings[0].radius_m);
    add_tube(tube, rings, count);
}

void wd_wood_mesh(struct wd_tree_mesh *mesh, const struct wd_skeleton *skeleton,
                  const struct wd_tree_form *form, const struct wd_tree_density *crown,
                  const struct wd_wood_style *style)
{
    struct wd_bark_tint bark = wd_bark_tint_of(form->species);
    struct foot foot = foot_of(skeleton, form, style);
    struct tube tube = {.mesh = mesh, .form = form, .crown = crown, .bark = &bark, .foot = &foot};
    for (size_t b = 0; b < skeleton->branch_count; b++) {
        bool first = mesh->index_count == 0;
        if (is_drawn(skeleton, &skeleton->branches[b], style))
            add_branch(&tube, skeleton, &skeleton->branches[b], style);
        if (first && tube.trunk && foot.sides)
            mesh->stem_index_count = mesh->index_count;
    }
}

/* Rings that would fold are left out; ends that are broken or thick, of snags and coconuts, take two more a side. */
static size_t branch_triangles(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                               const struct wd_species *species, const struct foot *foot,
                               const struct wd_wood_style *style)
{
    size_t last = branch->node_count - 1, step = (size_t)style->node_step;
    size_t segments = (last + step - 1) / step, below = 0;
    size_t sides = (size_t)branch_sides(skeleton, branch, species, foot, style);
    if (branch->order == WD_TRUNK && foot->sides) /* rings of two kinds: one for each side of both; a blunt end */
        below = (2 * (size_t)foot->count - 1) * (size_t)foot->sides + sides;
    else if (branch->order == WD_TRUNK)
        below = 2 * (size_t)(foot->count - 1) * sides;
    return (2 * segments - 1) * sides + below;
}

static size_t stem_triangles(const struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                             const struct wd_wood_style *style)
{
    size_t triangles = 0;
    const struct foot foot = foot_of(skeleton, form, style);
    for (size_t b = 0; b < skeleton->branch_count; b++)
        if (skeleton->branches[b].order == WD_TRUNK)
            triangles += branch_triangles(skeleton, &skeleton->branches[b], form->species, &foot, style);
    return triangles;
}

/* What a branch costs, and the radius below which it is left out. */
struct cost {
    float radius_m;
    uint32_t triangles;
};

static size_t costs_from(const struct cost *costs, size_t count, float least_radius_m)
{
    size_t triangles = 0;
    for (size_t i = 0; i < count; i++)
        triangles += costs[i].radius_m >= least_radius_m ? costs[i].triangles : 0;
    return triangles;
}

void wd_wood_style_fit(struct wd_wood_style *style, const struct wd_skeleton *skeleton,
                       const struct wd_tree_form *form, size_t triangles)
{
    while (stem_triangles(skeleton, form, style) > triangles && style->foot_sides >= WD_LOBE_PLACES)
        style->foot_sides /= 2;
    while (stem_triangles(skeleton, form, style) > triangles &&
           (style->most_sides > LEAST_SIDES || style->node_step < MOST_STEP)) {
        style->node_step *= style->most_sides > LEAST_SIDES ? 1 : 2;
        style->most_sides -= style->most_sides > LEAST_SIDES;
    }
    const struct foot foot = foot_of(skeleton, form, style);
    struct cost *costs = wd_alloc_array(skeleton->branch_count, sizeof *costs);
    for (size_t b = 0; b < skeleton->branch_count; b++) {
        const struct wd_branch *branch = &skeleton->branches[b];
        bool stem = branch->order == WD_TRUNK;
        costs[b].radius_m = stem ? INFINITY : skeleton->nodes[branch->first_node].radius_m;
        costs[b].triangles = (uint32_t)branch_triangles(skeleton, branch, form->species, &foot, style);
    }
    while (style->least_radius_m < MOST_RADIUS_M &&
           costs_from(costs, skeleton->branch_count, style->least_radius_m) > triangles)
        style->least_radius_m = 1.08f * style->least_radius_m + 1e-4f;
    free(costs);
}
