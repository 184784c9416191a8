#include "tree/wood.h"

#include <stdlib.h>

#include "base/memory.h"
#include "tree/buttress.h"
#include "tree/look.h"
#include "tree/look_map.h"

enum { MAX_RINGS = 48, MAX_SIDES = 64, LEAST_SIDES = 3, MOST_STEP = 32 };
#define MOST_RADIUS_M 20.0f /* no branch is thicker */
/* Turns of the bark's tile a metre: what repeats up the stem comes to stand beside itself. */
#define BARK_DRIFT 0.09f

struct ring {
    struct wd_vec3 center_m, direction;
    float radius_m, along_m, flexibility;
    float flare; /* extra radius of the root flare, as a share */
    float jag_m; /* splinters of broken wood stand up so far */
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
                                       node->along_m, node->flexibility, 0, 0};
    }
    return count;
}

static bool folds(const struct ring *a, const struct ring *b)
{
    struct wd_vec3 way = wd_v3_sub(b->center_m, a->center_m);
    struct wd_vec3 bend = wd_v3_sub(b->direction, a->direction);
    float thick = wd_maxf(a->radius_m * (1 + a->flare), b->radius_m * (1 + b->flare));
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

/* The foot needs more rings than the skeleton has nodes: the flare falls off within two stem
 * diameters. The first ring is below ground, so that no gap shows on slopes. */
static int trunk_rings(const struct wd_skeleton *skeleton, const struct wd_branch *trunk,
                       const struct wd_tree_form *form, int node_step, struct ring *rings)
{
    static const float heights[] = {-1, 0, 0.25f, 0.6f, 1.1f, 1.9f};
    struct ring nodes[MAX_RINGS];
    int node_count = gather_rings(skeleton, trunk, node_step, nodes), count = 0;
    float dbh = skeleton->stem_count > 1 ? 2 * nodes[0].radius_m : form->dbh_m;
    float below = -wd_clampf(0.75f * dbh, 0.02f, 0.3f);
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        float z = heights[i] < 0 ? below : heights[i] * dbh;
        float share = wd_clampf(z / wd_maxf(nodes[1].center_m.z, 0.01f), -1, 1);
        struct ring ring = nodes[0];
        ring.center_m = wd_v3_mix(nodes[0].center_m, nodes[1].center_m, share);
        ring.radius_m = wd_mixf(nodes[0].radius_m, nodes[1].radius_m, wd_maxf(share, 0));
        ring.along_m = z;
        ring.direction = wd_v3_unit(wd_v3_mix(WD_V3(0, 0, 1), ring.direction, wd_maxf(share, 0)));
        if (count == 0 || z < 0.95f * nodes[1].center_m.z)
            rings[count++] = ring;
    }
    for (int i = 1; i < node_count; i++)
        rings[count++] = nodes[i];
    for (int i = 0; i < count; i++)
        rings[i].flare = wd_root_flare(form, dbh, rings[i].center_m.z);
    return count;
}

struct tube {
    struct wd_tree_mesh *mesh;
    const struct wd_tree_form *form;
    const struct wd_tree_density *crown;
    const struct wd_bark_tint *bark;
    int sides;
    bool trunk, fins; /* fins: buttresses shape its rings */
    float turns;      /* of the bark's tile around it */
    float circle[MAX_SIDES][2];
};

/* A trunk has bark, however thin its top is; a sapling's is as smooth and dark as a twig. */
static uint32_t ring_tint(const struct tube *tube, const struct ring *ring)
{
    float barked = tube->trunk ? 0.06f * (1 - tube->form->youth) : 0;
    float sky = wd_tree_density_sky(tube->crown, ring->center_m);
    float height = ring->center_m.z / tube->form->height_m;
    return wd_bark_tint_at(tube->bark, height, ring->radius_m + barked, sky);
}

/* Root buttresses: the flare is stronger in some directions. */
static float ring_radius(const struct tube *tube, const struct ring *ring, float turn)
{
    if (!tube->trunk)
        return ring->radius_m;
    float phase = wd_hash_unit(tube->form->key);
    float five = (float)wd_dcos(2 * WD_PI * (double)(5 * turn + phase));
    float two = (float)wd_dcos(2 * WD_PI * (double)(2 * turn + 3 * phase));
    return ring->radius_m * (1 + ring->flare * (1 + 0.4f * five + 0.25f * two) +
                             0.02f * two);
}

/* Vertex i of a ring, in metres along its two axes. */
static void ring_place(const struct tube *tube, const struct ring *ring, int i, float place[2])
{
    float turn = (float)i / (float)tube->sides, radius = ring_radius(tube, ring, turn);
    if (tube->fins) {
        wd_buttress_outline(tube->form, ring->center_m.z, ring->radius_m, tube->sides, i, place);
    } else {
        place[0] = tube->circle[i][0];
        place[1] = tube->circle[i][1];
    }
    place[0] *= radius;
    place[1] *= radius;
}

/* Square to the outline, from the neighbours' places; of a round ring, away from its middle. */
static struct wd_vec3 ring_normal(const struct tube *tube, const struct ring *ring, int i,
                                  const float place[2], struct wd_vec3 side, struct wd_vec3 over)
{
    float x = place[0], y = place[1];
    if (tube->fins) {
        float before[2], after[2];
        ring_place(tube, ring, (i + tube->sides - 1) % tube->sides, before);
        ring_place(tube, ring, (i + 1) % tube->sides, after);
        x = after[1] - before[1];
        y = before[0] - after[0];
    }
    return wd_v3_unit(wd_v3_mad(wd_v3_scale(side, x), over, y));
}

static float splinter_m(const struct tube *tube, const struct ring *ring, int i)
{
    uint32_t place = (uint32_t)(int32_t)(1000 * ring->along_m);
    return ring->jag_m * wd_hash_unit(wd_hash3(tube->form->key, place, (uint32_t)i));
}

static uint32_t add_ring(const struct tube *tube, const struct ring *ring, struct wd_vec3 side)
{
    struct wd_vec3 over = wd_v3_cross(ring->direction, side);
    uint32_t first = tube->mesh->vertex_count, tint = ring_tint(tube, ring);
    for (int i = 0; i <= tube->sides; i++) {
        float place[2];
        int at = i < tube->sides ? i : 0;
        ring_place(tube, ring, at, place);
        struct wd_vec3 out = ring_normal(tube, ring, at, place, side, over);
        struct wd_vec3 p = wd_v3_mad(ring->center_m, side, place[0]);
        p = wd_v3_mad(p, over, place[1]);
        if (ring->jag_m > 0)
            p = wd_v3_mad(p, ring->direction, splinter_m(tube, ring, at));
        float normal[3] = {out.x, out.y, out.z};
        struct wd_tree_vertex vertex = {
            .position_m = {p.x, p.y, p.z},
            .normal = wd_pack_normal(normal),
            .uv = wd_pack_uv(tube->turns * (float)i / (float)tube->sides +
                                 BARK_DRIFT * ring->along_m,
                             ring->along_m),
            .tint = tint,
            .kind = (uint32_t)ring->flexibility & 0xffu,
        };
        wd_tree_mesh_add_vertex(tube->mesh, &vertex);
    }
    return first;
}

static void join_rings(const struct tube *tube, uint32_t low, uint32_t high)
{
    for (uint32_t i = 0; i < (uint32_t)tube->sides; i++) {
        wd_tree_mesh_add_triangle(tube->mesh, low + i, low + i + 1, high + i);
        wd_tree_mesh_add_triangle(tube->mesh, low + i + 1, high + i + 1, high + i);
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
    for (uint32_t i = 0; i < (uint32_t)tube->sides; i++)
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
        join_rings(tube, low, high);
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

static int round_sides(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                       const struct wd_wood_style *style)
{
    return sides_of(skeleton->nodes[branch->first_node].radius_m, style->most_sides);
}

static int branch_sides(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                        const struct wd_species *species, const struct wd_wood_style *style)
{
    int sides = round_sides(skeleton, branch, style);
    return branch->order == WD_TRUNK ? wd_buttress_sides(species, sides) : sides;
}

/* Bark has the same grain on thick and thin wood: whole turns where the seam would be seen, part of
 * the tile on branches. */
static float bark_turns(float radius_m)
{
    float turns = 2 * (float)WD_PI * radius_m / WD_BARK_TILE_WIDTH_M;
    return turns < 0.5f ? wd_maxf(turns, 0.02f) : floorf(turns + 0.5f);
}

static void set_circle(struct tube *tube, int sides)
{
    /* as wide from all sides together as the round branch: of the same girth (Cauchy) */
    double out = WD_PI / ((double)sides * wd_dsin(WD_PI / (double)sides));
    tube->sides = sides;
    for (int i = 0; i < sides; i++) {
        double angle = 2 * WD_PI * (double)i / (double)sides;
        tube->circle[i][0] = (float)(out * wd_dcos(angle));
        tube->circle[i][1] = (float)(out * wd_dsin(angle));
    }
}

void wd_wood_mesh(struct wd_tree_mesh *mesh, const struct wd_skeleton *skeleton,
                  const struct wd_tree_form *form, const struct wd_tree_density *crown,
                  const struct wd_wood_style *style)
{
    struct wd_bark_tint bark = wd_bark_tint_of(form->species);
    struct tube tube = {.mesh = mesh, .form = form, .crown = crown, .bark = &bark};
    for (size_t b = 0; b < skeleton->branch_count; b++) {
        const struct wd_branch *branch = &skeleton->branches[b];
        if (!is_drawn(skeleton, branch, style))
            continue;
        struct ring rings[MAX_RINGS + 8];
        bool trunk = branch->order == WD_TRUNK;
        int sides = branch_sides(skeleton, branch, form->species, style);
        if (sides != tube.sides)
            set_circle(&tube, sides);
        tube.trunk = trunk;
        tube.fins = sides > round_sides(skeleton, branch, style);
        int count = trunk ? trunk_rings(skeleton, branch, form, style->node_step, rings)
                          : branch_rings(skeleton, branch, style->node_step, rings);
        count = drop_folds(rings, count);
        if (form->species->form == WD_FORM_SNAG)
            rings[count - 1].jag_m = 1.6f * rings[count - 1].radius_m;
        tube.turns = bark_turns(trunk ? 0.5f * form->dbh_m : rings[0].radius_m);
        add_tube(&tube, rings, count);
    }
}

static size_t branch_triangles(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                               const struct wd_species *species, const struct wd_wood_style *style)
{
    size_t last = branch->node_count - 1, step = (size_t)style->node_step;
    size_t segments = (last + step - 1) / step + (branch->order == WD_TRUNK ? 5 : 0);
    return (2 * segments - 1) * (size_t)branch_sides(skeleton, branch, species, style);
}

static size_t stem_triangles(const struct wd_skeleton *skeleton, const struct wd_species *species,
                             const struct wd_wood_style *style)
{
    size_t triangles = 0;
    for (size_t b = 0; b < skeleton->branch_count; b++)
        if (skeleton->branches[b].order == WD_TRUNK)
            triangles += branch_triangles(skeleton, &skeleton->branches[b], species, style);
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
                       const struct wd_species *species, size_t triangles)
{
    while (stem_triangles(skeleton, species, style) > triangles &&
           (style->most_sides > LEAST_SIDES || style->node_step < MOST_STEP)) {
        style->node_step *= style->most_sides > LEAST_SIDES ? 1 : 2;
        style->most_sides -= style->most_sides > LEAST_SIDES;
    }
    struct cost *costs = wd_alloc_array(skeleton->branch_count, sizeof *costs);
    for (size_t b = 0; b < skeleton->branch_count; b++) {
        const struct wd_branch *branch = &skeleton->branches[b];
        bool stem = branch->order == WD_TRUNK;
        costs[b].radius_m = stem ? INFINITY : skeleton->nodes[branch->first_node].radius_m;
        costs[b].triangles = (uint32_t)branch_triangles(skeleton, branch, species, style);
    }
    while (style->least_radius_m < MOST_RADIUS_M &&
           costs_from(costs, skeleton->branch_count, style->least_radius_m) > triangles)
        style->least_radius_m = 1.08f * style->least_radius_m + 1e-4f;
    free(costs);
}
