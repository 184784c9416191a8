#include "tree/wood.h"

#include "tree/look.h"

enum { MAX_SIDES = 12, MAX_RINGS = 48 };

struct ring {
    struct wd_vec3 center_m, direction;
    float radius_m, along_m, flexibility;
    float flare; /* extra radius of the root flare, as a share */
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
                                       node->along_m, node->flexibility, 0};
    }
    return count;
}

/* The collar where a branch leaves its parent. */
static int branch_rings(const struct wd_skeleton *skeleton, const struct wd_branch *branch,
                        int node_step, struct ring *rings)
{
    int count = gather_rings(skeleton, branch, node_step, rings);
    float joint = skeleton->nodes[branch->parent_node].radius_m;
    rings[0].radius_m = fminf(1.25f * rings[0].radius_m, 0.95f * joint);
    return count;
}

/* The foot needs more rings than the skeleton has nodes: the flare falls off within two stem
 * diameters. The first ring is below ground, so that no gap shows on slopes. */
static int trunk_rings(const struct wd_skeleton *skeleton, const struct wd_tree_form *form,
                       int node_step, struct ring *rings)
{
    static const float heights[] = {-1, 0, 0.25f, 0.6f, 1.1f, 1.9f};
    struct ring nodes[MAX_RINGS];
    int node_count = gather_rings(skeleton, &skeleton->branches[0], node_step, nodes), count = 0;
    float dbh = form->dbh_m, below = -wd_clampf(0.75f * dbh, 0.02f, 0.3f);
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        float z = heights[i] < 0 ? below : heights[i] * dbh;
        float share = wd_clampf(z / fmaxf(nodes[1].center_m.z, 0.01f), -1, 1);
        struct ring ring = nodes[0];
        ring.center_m = wd_v3_mix(nodes[0].center_m, nodes[1].center_m, share);
        ring.radius_m = wd_mixf(nodes[0].radius_m, nodes[1].radius_m, fmaxf(share, 0));
        ring.along_m = z;
        ring.direction = wd_v3_unit(wd_v3_mix(WD_V3(0, 0, 1), ring.direction, fmaxf(share, 0)));
        if (count == 0 || z < 0.95f * nodes[1].center_m.z)
            rings[count++] = ring;
    }
    for (int i = 1; i < node_count; i++)
        rings[count++] = nodes[i];
    for (int i = 0; i < count; i++) {
        double fall = wd_dexp(-fmaxf(rings[i].center_m.z, -0.1f * dbh) / (0.75 * (double)dbh));
        rings[i].flare = (form->species->root_flare - 1) * (float)fall;
    }
    return count;
}

struct tube {
    struct wd_tree_mesh *mesh;
    const struct wd_tree_form *form;
    const struct wd_tree_density *crown;
    const struct wd_bark_tint *bark;
    int sides;
    bool trunk;
};

static uint32_t ring_tint(const struct tube *tube, const struct ring *ring)
{
    float sky = wd_tree_density_sky(tube->crown, ring->center_m);
    float height = ring->center_m.z / tube->form->height_m;
    return wd_bark_tint_at(tube->bark, height, tube->trunk ? 1 : ring->radius_m, sky);
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

static uint32_t add_ring(const struct tube *tube, const struct ring *ring, struct wd_vec3 side)
{
    struct wd_vec3 over = wd_v3_cross(ring->direction, side);
    uint32_t first = tube->mesh->vertex_count, tint = ring_tint(tube, ring);
    for (int i = 0; i <= tube->sides; i++) {
        float turn = (float)i / (float)tube->sides;
        float angle_turn = i == tube->sides ? 0 : turn;
        struct wd_vec3 out = wd_v3_turn(side, over, angle_turn * (float)(2 * WD_PI));
        struct wd_vec3 p = wd_v3_mad(ring->center_m, out, ring_radius(tube, ring, angle_turn));
        float normal[3] = {out.x, out.y, out.z};
        struct wd_tree_vertex vertex = {
            .position_m = {p.x, p.y, p.z},
            .normal = wd_pack_normal(normal),
            .uv = wd_pack_uv(turn, ring->along_m),
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
        .uv = wd_pack_uv(0.5f, ring->along_m),
        .tint = ring_tint(tube, ring),
        .kind = (uint32_t)ring->flexibility & 0xffu,
    };
    uint32_t tip = wd_tree_mesh_add_vertex(tube->mesh, &vertex);
    for (uint32_t i = 0; i < (uint32_t)tube->sides; i++)
        wd_tree_mesh_add_triangle(tube->mesh, low + i, low + i + 1, tip);
}

/* Rings share their vertices with the next segment; the frame is carried along without twist. A
 * thin branch ends in a point, a trunk that has dissolved in a blunt end between its limbs. */
static void add_tube(const struct tube *tube, const struct ring *rings, int count)
{
    struct wd_vec3 side = wd_v3_side(rings[0].direction);
    uint32_t low = add_ring(tube, &rings[0], side);
    float end = rings[count - 1].radius_m;
    int tubes = end > 0.02f ? count : count - 1;
    for (int i = 1; i < tubes; i++) {
        side = wd_v3_square(side, rings[i].direction);
        uint32_t high = add_ring(tube, &rings[i], side);
        join_rings(tube, low, high);
        low = high;
    }
    close_tip(tube, &rings[count - 1], low, tubes == count ? 0.7f * end : 0);
}

void wd_wood_mesh(struct wd_tree_mesh *mesh, const struct wd_skeleton *skeleton,
                  const struct wd_tree_form *form, const struct wd_tree_density *crown,
                  const struct wd_wood_style *style)
{
    struct wd_bark_tint bark = wd_bark_tint_of(form->species);
    for (size_t b = 0; b < skeleton->branch_count; b++) {
        const struct wd_branch *branch = &skeleton->branches[b];
        struct ring rings[MAX_RINGS + 8];
        float radius = skeleton->nodes[branch->first_node].radius_m;
        bool trunk = branch->order == WD_TRUNK;
        if (!trunk && radius < style->least_radius_m)
            continue;
        struct tube tube = {mesh, form, crown, &bark, sides_of(radius, style->most_sides), trunk};
        int count = trunk ? trunk_rings(skeleton, form, style->node_step, rings)
                          : branch_rings(skeleton, branch, style->node_step, rings);
        add_tube(&tube, rings, count);
    }
}

size_t wd_wood_triangles(const struct wd_skeleton *skeleton, const struct wd_wood_style *style)
{
    size_t triangles = 0;
    for (size_t b = 0; b < skeleton->branch_count; b++) {
        const struct wd_branch *branch = &skeleton->branches[b];
        float radius = skeleton->nodes[branch->first_node].radius_m;
        if (branch->order != WD_TRUNK && radius < style->least_radius_m)
            continue;
        size_t last = branch->node_count - 1, step = (size_t)style->node_step;
        size_t segments = (last + step - 1) / step + (branch->order == WD_TRUNK ? 5 : 0);
        triangles += (2 * segments - 1) * (size_t)sides_of(radius, style->most_sides);
    }
    return triangles;
}
