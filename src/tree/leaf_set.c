#include "tree/leaf_set.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/four.h"

/* --- forms ------------------------------------------------------------------------------- */

static struct wd_leaf_vertex pack_corner(const struct wd_leaf_corner *corner)
{
    const float normal[3] = {corner->n.x, corner->n.y, corner->n.z};
    return (struct wd_leaf_vertex){
        .place = {corner->p.x, corner->p.y, corner->p.z},
        .normal = wd_pack_normal(normal),
        .uv = wd_pack_uv(corner->u, corner->v),
        .kind = corner->kind | (uint32_t)(45 * corner->stiff + 0.5f),
    };
}

void wd_leaf_set_init(struct wd_leaf_set *set, const struct wd_leaf_template *templates,
                      uint32_t forms)
{
    size_t corners = templates->corner_count;
    *set = (struct wd_leaf_set){
        .corners = wd_alloc_array(forms * corners + 1, sizeof *set->corners),
        .indices = wd_alloc_array(templates->index_count + 1, sizeof *set->indices),
        .forms = forms,
        .corner_count = (uint32_t)corners,
        .index_count = (uint32_t)templates->index_count,
        .grain = 1,
        .own = 0.4f,
        .arch_least = 1,
    };
    for (uint32_t form = 0; form < forms; form++)
        for (size_t i = 0; i < corners; i++)
            set->corners[form * corners + i] = pack_corner(&templates[form].corners[i]);
    for (uint32_t i = 0; i < set->index_count; i++)
        set->indices[i] = templates->indices[i];
}

void wd_leaf_set_finish(struct wd_leaf_set *set)
{
    free(set->corners);
    free(set->indices);
    *set = (struct wd_leaf_set){0};
}

static uint32_t root_of(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
    return i;
}

/* parts[corner]: the least corner of what it hangs together with. */
static void find_parts(uint32_t *parts, const struct wd_leaf_set *set)
{
    for (uint32_t i = 0; i < set->corner_count; i++)
        parts[i] = i;
    for (uint32_t i = 0; i < set->index_count; i++) {
        uint32_t a = root_of(parts, set->indices[i / 3 * 3]), b = root_of(parts, set->indices[i]);
        parts[a < b ? b : a] = a < b ? a : b;
    }
    for (uint32_t i = 0; i < set->corner_count; i++)
        parts[i] = root_of(parts, i);
}

/* Midribs and stalks: leaflets hang on them. */
static void find_stalks(bool *stalks, const struct wd_leaf_set *set, const uint32_t *parts)
{
    for (uint32_t i = 0; i < set->corner_count; i++)
        stalks[i] = true;
    for (uint32_t i = 0; i < set->corner_count; i++) {
        float uv[2];
        wd_unpack_uv(set->corners[i].uv, uv);
        stalks[parts[i]] = stalks[parts[i]] && fabsf(uv[0] - 0.5f) < 0.01f;
    }
}

static void scale_form(struct wd_leaf_vertex *corners, uint32_t count, const uint32_t *parts,
                       const bool *stalks, float factor)
{
    struct wd_vec3 *sums = wd_alloc_array(count + 1, sizeof *sums);
    uint32_t *members = wd_alloc_array(count + 1, sizeof *members);
    for (uint32_t i = 0; i < count; i++) {
        sums[parts[i]] = wd_v3_add(sums[parts[i]], wd_v3_of(corners[i].place));
        members[parts[i]]++;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (stalks[parts[i]])
            continue;
        struct wd_vec3 middle = wd_v3_scale(sums[parts[i]], 1 / (float)members[parts[i]]);
        struct wd_vec3 p = wd_v3_mix(middle, wd_v3_of(corners[i].place), factor);
        corners[i].place[0] = p.x;
        corners[i].place[1] = p.y;
        corners[i].place[2] = p.z;
    }
    free(sums);
    free(members);
}

void wd_leaf_set_scale_parts(struct wd_leaf_set *set, float factor)
{
    uint32_t *parts = wd_alloc_array(set->corner_count + 1, sizeof *parts);
    bool *stalks = wd_alloc_array(set->corner_count + 1, sizeof *stalks);
    find_parts(parts, set);
    find_stalks(stalks, set, parts);
    for (uint32_t form = 0; form < set->forms; form++)
        scale_form(set->corners + form * set->corner_count, set->corner_count, parts, stalks,
                   factor);
    free(stalks);
    free(parts);
}

/* --- triangles --------------------------------------------------------------------------- */

/* Corners of a form, unpacked, or of a leaf in the tree: four. */
struct corners {
    struct wd_four_vec3 p, n;
};

static uint32_t four_count(const struct wd_leaf_set *set)
{
    return (set->corner_count + 3) / 4;
}

/* [form][four_count] */
static struct corners *unpack_corners(const struct wd_leaf_set *set)
{
    struct corners *all = wd_alloc_array(set->forms * four_count(set), sizeof *all);
    for (uint32_t i = 0; i < set->forms * set->corner_count; i++) {
        uint32_t form = i / set->corner_count, corner = i % set->corner_count, at = corner % 4;
        struct corners *four = &all[form * four_count(set) + corner / 4];
        const float *p = set->corners[i].place;
        float n[3];
        wd_unpack_normal(set->corners[i].normal, n);
        four->p.x[at] = p[0], four->p.y[at] = p[1], four->p.z[at] = p[2];
        four->n.x[at] = n[0], four->n.y[at] = n[1], four->n.z[at] = n[2];
    }
    return all;
}

static struct wd_four_vec3 to_tree(const struct wd_leaf_axes *axes, const struct wd_four_vec3 *v)
{
    const struct wd_vec3 across = axes->across, along = axes->along, above = axes->above;
    return (struct wd_four_vec3){
        across.x * v->x + along.x * v->y + above.x * v->z,
        across.y * v->x + along.y * v->y + above.y * v->z,
        across.z * v->x + along.z * v->y + above.z * v->z,
    };
}

static float arch_of(const struct wd_leaf_set *set, const struct wd_tree_leaf *leaf)
{
    return set->arch_least + set->arch_range * WD_LEAF_ARCH(*leaf);
}

static wd_four_ints pack_snorm16(wd_four value)
{
    const wd_four one = wd_four_of(1);
    value = wd_four_min(wd_four_max(value, -one), one);
    return (wd_four_truncate(value * 32767 + 32768.5f) - 32768) & 0xffff;
}

/* wd_pack_normal of four. */
static void pack_normals(uint32_t packed[4], const struct wd_four_vec3 *n)
{
    const wd_four none = {0}, one = wd_four_of(1);
    wd_four sum = wd_four_abs(n->x) + wd_four_abs(n->y) + wd_four_abs(n->z);
    wd_four over = wd_four_choose(sum > none, one / sum, none), x = n->x * over, y = n->y * over;
    wd_four sign_x = wd_four_choose(x < none, -one, one), sign_y = wd_four_choose(y < none, -one, one);
    wd_four_ints lower = n->z < none;
    wd_four folded = (one - wd_four_abs(y)) * sign_x;
    y = wd_four_choose(lower, (one - wd_four_abs(x)) * sign_y, y);
    x = wd_four_choose(lower, folded, x);
    wd_four_ints both = pack_snorm16(x) | pack_snorm16(y) << 16;
    memcpy(packed, &both, sizeof both);
}

/* How a leaf stands. */
struct stand {
    struct wd_leaf_axes axes;
    struct wd_vec3 foot, shading;
    float size_m, arch;
};

static struct stand stand_of(const struct wd_leaf_set *set, const struct wd_tree_leaf *leaf,
                             const struct wd_leaf_box *box)
{
    return (struct stand){wd_leaf_axes_of(leaf->turn), wd_leaf_foot(*leaf, *box),
                          wd_leaf_shading(leaf->shading), wd_leaf_size_m(*leaf, *box),
                          arch_of(set, leaf)};
}

static struct wd_four_vec3 places(const struct wd_four_vec3 *form, const struct stand *stand)
{
    const struct wd_four_vec3 arched = {form->x, form->y, stand->arch * form->z};
    const struct wd_four_vec3 p = to_tree(&stand->axes, &arched);
    return (struct wd_four_vec3){stand->foot.x + p.x * stand->size_m,
                                 stand->foot.y + p.y * stand->size_m,
                                 stand->foot.z + p.z * stand->size_m};
}

/* Of the sheet and of the crown together; `own` as in struct wd_leaf_set. Of any length. */
static struct wd_four_vec3 normals(const struct wd_four_vec3 *form, const struct stand *stand,
                                   float own)
{
    const struct wd_four_vec3 n = to_tree(&stand->axes, form);
    const struct wd_vec3 crown = wd_v3_scale(stand->shading, 1 - own);
    const wd_four none = {0};
    wd_four side = wd_four_choose(wd_four_dot(&n, stand->shading) < none, wd_four_of(-own),
                                  wd_four_of(own));
    return (struct wd_four_vec3){crown.x + n.x * side, crown.y + n.y * side, crown.z + n.z * side};
}

static void add_corners(struct wd_tree_vertex *vertices, const struct corners *corners,
                        const struct wd_leaf_vertex *form, const struct wd_tree_leaf *leaf,
                        uint32_t count)
{
    uint32_t flexibility = WD_LEAF_FLEXIBILITY(*leaf), packed[4];
    pack_normals(packed, &corners->n);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bend = flexibility + (form[i].kind & 0xffu);
        vertices[i] = (struct wd_tree_vertex){
            .position_m = {corners->p.x[i], corners->p.y[i], corners->p.z[i]},
            .normal = packed[i],
            .uv = form[i].uv,
            .tint = leaf->tint,
            .kind = (form[i].kind & ~0xffu) | (bend < 255 ? bend : 255),
        };
    }
}

static void add_triangles(struct wd_tree_mesh *mesh, const struct wd_leaf_set *set)
{
    uint32_t *indices = mesh->indices + mesh->index_count;
    for (uint32_t i = 0; i < set->index_count; i++)
        indices[i] = mesh->vertex_count + set->indices[i];
    mesh->index_count += set->index_count;
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

void wd_leaf_set_mesh(const struct wd_leaf_set *set, const struct wd_tree_leaf *leaves,
                      const struct wd_leaf_box *box, struct wd_tree_mesh *mesh)
{
    uint32_t fours = four_count(set), count = set->corner_count;
    struct corners *corners = unpack_corners(set);
    wd_tree_mesh_reserve(mesh, set->leaf_count * count, set->leaf_count * set->index_count);
    for (uint32_t i = 0; i < set->leaf_count; i++) {
        uint32_t form = WD_LEAF_FORM(leaves[i]) % set->forms;
        const struct stand stand = stand_of(set, &leaves[i], box);
        add_triangles(mesh, set);
        for (uint32_t at = 0; at < count; at += 4) {
            const struct corners *from = &corners[form * fours + at / 4];
            const struct corners made = {places(&from->p, &stand),
                                         normals(&from->n, &stand, set->own)};
            add_corners(mesh->vertices + mesh->vertex_count + at, &made,
                        set->corners + form * count + at, &leaves[i], least(count - at, 4));
        }
        mesh->vertex_count += count;
    }
    free(corners);
}

void wd_leaf_set_move(const struct wd_leaf_set *set, const struct wd_tree_leaf *leaves,
                      const struct wd_leaf_box *box, struct wd_tree_vertex *vertices)
{
    uint32_t fours = four_count(set), count = set->corner_count;
    struct corners *corners = unpack_corners(set);
    for (uint32_t i = 0; i < set->leaf_count; i++, vertices += count) {
        uint32_t form = WD_LEAF_FORM(leaves[i]) % set->forms;
        const struct stand stand = stand_of(set, &leaves[i], box);
        for (uint32_t at = 0; at < count; at += 4) {
            struct wd_four_vec3 p = places(&corners[form * fours + at / 4].p, &stand);
            for (uint32_t k = 0; k < least(count - at, 4); k++) {
                float *position_m = vertices[at + k].position_m;
                position_m[0] = p.x[k], position_m[1] = p.y[k], position_m[2] = p.z[k];
            }
        }
    }
    free(corners);
}

float wd_leaf_set_top_m(const struct wd_leaf_set *set, const struct wd_tree_leaf *leaves,
                        const struct wd_leaf_box *box)
{
    float top = 0;
    for (uint32_t i = 0; i < set->leaf_count; i++) {
        const struct wd_leaf_axes axes = wd_leaf_axes_of(leaves[i].turn);
        uint32_t form = WD_LEAF_FORM(leaves[i]) % set->forms;
        const struct wd_leaf_vertex *corners = set->corners + form * set->corner_count;
        float arch = arch_of(set, &leaves[i]), highest = -INFINITY;
        for (uint32_t k = 0; k < set->corner_count; k++)
            highest = wd_maxf(highest, axes.across.z * corners[k].place[0] +
                                           axes.along.z * corners[k].place[1] +
                                           axes.above.z * arch * corners[k].place[2]);
        top = wd_maxf(top, wd_leaf_foot(leaves[i], *box).z +
                               highest * wd_leaf_size_m(leaves[i], *box));
    }
    return top;
}

/* --- packing ----------------------------------------------------------------------------- */

struct wd_leaf_box wd_leaf_box_of(const struct wd_leaf_stand *places, size_t count)
{
    struct wd_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    float size_m = 0;
    for (size_t i = 0; i < count; i++) {
        low = wd_v3_min(places[i].position_m, low);
        high = wd_v3_max(places[i].position_m, high);
        size_m = wd_maxf(size_m, places[i].size_m);
    }
    if (!count)
        return (struct wd_leaf_box){0};
    return (struct wd_leaf_box){
        .feet = wd_mesh_box_of((float[3]){low.x, low.y, low.z}, (float[3]){high.x, high.y, high.z}),
        .size_step_m = size_m / WD_BOX_STEPS,
    };
}

void wd_leaf_box_scale(struct wd_leaf_box *box, float factor)
{
    for (int axis = 0; axis < 3; axis++) {
        box->feet.least_m[axis] *= factor;
        box->feet.step_m[axis] *= factor;
    }
    box->size_step_m *= factor;
}

/* Parts w, x, y, z of the turn that brings x, y, z to across, along, above (Shepperd 1978). */
static void quaternion_of(float q[4], struct wd_vec3 across, struct wd_vec3 along,
                          struct wd_vec3 above)
{
    float squares[4] = {1 + across.x + along.y + above.z, 1 + across.x - along.y - above.z,
                        1 - across.x + along.y - above.z, 1 - across.x - along.y + above.z};
    int largest = 0;
    for (int i = 1; i < 4; i++)
        largest = squares[i] > squares[largest] ? i : largest;
    /* products of two parts, four times */
    float wx = along.z - above.y, wy = above.x - across.z, wz = across.y - along.x;
    float xy = across.y + along.x, xz = across.z + above.x, yz = along.z + above.y;
    const float products[4][4] = {{squares[0], wx, wy, wz},
                                  {wx, squares[1], xy, xz},
                                  {wy, xy, squares[2], yz},
                                  {wz, xz, yz, squares[3]}};
    float length = 0;
    for (int i = 0; i < 4; i++)
        length += products[largest][i] * products[largest][i];
    for (int i = 0; i < 4; i++)
        q[i] = products[largest][i] / sqrtf(length);
}

static uint32_t pack_turn(struct wd_vec3 axis, struct wd_vec3 normal)
{
    float q[4];
    quaternion_of(q, wd_v3_cross(axis, normal), axis, normal);
    uint32_t largest = 0, packed = 0, shift = 0;
    for (uint32_t i = 1; i < 4; i++)
        largest = fabsf(q[i]) > fabsf(q[largest]) ? i : largest;
    for (uint32_t i = 0; i < 4; i++) {
        if (i == largest)
            continue;
        float part = (q[largest] < 0 ? -q[i] : q[i]) / WD_QUATERNION_PART;
        packed |= (uint32_t)(wd_clampf(0.5f * part + 0.5f, 0, 1) * 1023 + 0.5f) << shift;
        shift += 10;
    }
    return packed | largest << 30;
}

/* Two 8-bit snorm of the 16-bit ones. */
static uint32_t pack_shading(struct wd_vec3 v)
{
    const float normal[3] = {v.x, v.y, v.z};
    return wd_normal8(wd_pack_normal(normal));
}

struct wd_tree_leaf wd_leaf_pack(const struct wd_leaf_stand *place, const struct wd_leaf_box *box)
{
    const float p[3] = {place->position_m.x, place->position_m.y, place->position_m.z};
    uint32_t steps[3];
    wd_mesh_box_steps(steps, &box->feet, p);
    uint32_t size = box->size_step_m > 0
                        ? (uint32_t)wd_clampf(place->size_m / box->size_step_m + 0.5f, 0,
                                              WD_BOX_STEPS)
                        : 0;
    return (struct wd_tree_leaf){
        .xy = steps[0] | steps[1] << 16,
        .z_size = steps[2] | size << 16,
        .turn = pack_turn(place->axis, place->normal),
        .shading = pack_shading(place->shading) |
                   (uint32_t)wd_clampf(place->flexibility, 0, 255) << 16 |
                   (uint32_t)(wd_clampf(place->arch, 0, 1) * 63 + 0.5f) << 24 |
                   (place->form & 3u) << 30,
        .tint = place->tint,
    };
}
