#include "tree_test.h"

#include "tree/foliage.h"
#include "tree/leaf_spray.h"
#include "tree/leaf_sprig.h"
#include "tree/leaf_template.h"
#include "tree/mesh.h"

/* A species with the given leaf on everything else of the oak. */
static struct wd_species leafy(struct wd_arena *arena, int shape, int compound)
{
    struct wd_species species = test_species(arena, "oak");
    species.leaf.shape = shape;
    species.leaf.compound = compound;
    species.leaf.leaflets = compound == WD_COMPOUND_BIPINNATE ? 40 : 7;
    species.leaf.leaflet_length_cm = 6;
    species.leaf.leaflet_width_cm = 3;
    species.leaf.stalk_cm = 2;
    species.leaf.arch = 0.6f;
    if (shape == WD_LEAF_NEEDLES) {
        species.leaf.length_cm = 2;
        species.leaf.width_cm = 0.12f;
        species.leaf.stalk_cm = 0;
        species.leaf.bundle = 2;
    }
    return species;
}

static void check_template(const struct wd_leaf_template *leaf)
{
    assert_true(leaf->index_count >= 3 && leaf->index_count % 3 == 0);
    for (size_t i = 0; i < leaf->index_count; i++)
        assert_true(leaf->indices[i] < leaf->corner_count);
    for (size_t i = 0; i < leaf->corner_count; i++) {
        const struct wd_leaf_corner *corner = &leaf->corners[i];
        assert_float_equal(wd_v3_length(corner->n), 1, 1e-4f);
        assert_true(corner->u >= 0 && corner->u <= 1 && corner->v >= 0 && corner->v <= 1);
        assert_true(corner->stiff >= 0 && corner->stiff <= 1);
        assert_true(wd_v3_length(corner->p) < 2.5f);
    }
}

/* Blades lie flat enough that their upper side is that of their winding. */
static void check_winding(const struct wd_leaf_template *leaf)
{
    for (size_t i = 0; i < leaf->index_count; i += 3) {
        struct wd_vec3 a = leaf->corners[leaf->indices[i]].p;
        struct wd_vec3 b = wd_v3_sub(leaf->corners[leaf->indices[i + 1]].p, a);
        struct wd_vec3 c = wd_v3_sub(leaf->corners[leaf->indices[i + 2]].p, a);
        assert_true(wd_v3_cross(b, c).z > 0);
    }
}

static void every_shape_is_sound(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int shape = 0; shape <= WD_LEAF_SERRATE; shape++)
        for (int compound = 0; compound <= WD_COMPOUND_BIPINNATE; compound++) {
            struct wd_species species = leafy(&arena, shape, compound);
            struct wd_leaf_template leaf, near;
            wd_leaf_template_init(&leaf, &species, WD_LEAF_AS_BLADE, 0);
            wd_leaf_template_init(&near, &species, WD_LEAF_AS_NEAR, 0);
            check_template(&leaf);
            check_template(&near);
            if (compound == WD_COMPOUND_SIMPLE && (shape < WD_LEAF_BLADE || shape == WD_LEAF_SERRATE)) {
                assert_in_range(leaf.index_count / 3, 4, 15);
                assert_in_range(near.index_count / 3, 12, 29);
                check_winding(&leaf);
                check_winding(&near);
            }
            wd_leaf_template_finish(&leaf);
            wd_leaf_template_finish(&near);
        }
    wd_arena_finish(&arena);
}

/* parts[corner]: the least corner that it hangs together with. */
static void find_leaflets(const struct wd_leaf_template *leaf, size_t *parts)
{
    for (size_t i = 0; i < leaf->corner_count; i++)
        parts[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t i = 0; i < leaf->index_count; i++) {
            size_t *a = &parts[leaf->indices[i]], *b = &parts[leaf->indices[i / 3 * 3 + (i + 1) % 3]];
            size_t least = *a < *b ? *a : *b;
            changed = changed || *a != *b;
            *a = *b = least;
        }
    }
}

static float turn_of(struct wd_vec3 a, struct wd_vec3 b, struct wd_vec3 c)
{
    return wd_v3_cross(wd_v3_sub(b, a), wd_v3_sub(c, a)).z;
}

/* Whether p, seen from above, lies well inside a triangle. */
static bool covers(const struct wd_vec3 t[3], struct wd_vec3 p)
{
    float least = 1e-3f * turn_of(t[0], t[1], t[2]);
    return turn_of(t[0], t[1], p) > least && turn_of(t[1], t[2], p) > least && turn_of(t[2], t[0], p) > least;
}

static void get_triangle(const struct wd_leaf_template *leaf, size_t first, struct wd_vec3 t[3])
{
    for (size_t k = 0; k < 3; k++)
        t[k] = leaf->corners[leaf->indices[first + k]].p;
}

/* Stalks and midribs have no width in the leaf's map. */
static bool is_blade(const struct wd_leaf_template *leaf, size_t first)
{
    bool wide = false;
    for (size_t k = 0; k < 3; k++)
        wide = wide || fabsf(leaf->corners[leaf->indices[first + k]].u - 0.5f) > 0.01f;
    return wide;
}

static void check_leaflets_apart(const struct wd_leaf_template *leaf, size_t wanted)
{
    size_t *parts = calloc(leaf->corner_count, sizeof *parts), found = 0;
    bool *seen = calloc(leaf->corner_count, sizeof *seen);
    find_leaflets(leaf, parts);
    for (size_t i = 0; i < leaf->index_count; i += 3) {
        struct wd_vec3 t[3], middle;
        if (!is_blade(leaf, i))
            continue;
        get_triangle(leaf, i, t);
        middle = wd_v3_scale(wd_v3_add(wd_v3_add(t[0], t[1]), t[2]), 1.0f / 3);
        found += !seen[parts[leaf->indices[i]]];
        seen[parts[leaf->indices[i]]] = true;
        for (size_t other = 0; other < leaf->index_count; other += 3) {
            struct wd_vec3 u[3];
            if (!is_blade(leaf, other) || parts[leaf->indices[other]] == parts[leaf->indices[i]])
                continue;
            get_triangle(leaf, other, u);
            assert_false(covers(u, middle));
            for (int k = 0; k < 3; k++)
                assert_false(covers(u, t[k]) || covers(u, wd_v3_mix(t[k], t[(k + 1) % 3], 0.5f)));
        }
    }
    assert_int_equal(found, wanted);
    free(parts);
    free(seen);
}

/* Leaflets from one point stand apart, near and far. */
static void leaflets_of_a_hand_do_not_overlap(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    static const int64_t counts[] = {3, 5, 7, 9};
    for (int i = 0; i < 4; i++)
        for (int form = 0; form < 2; form++) {
            struct wd_species species = test_species(&arena, "bramble");
            struct wd_leaf_template leaf;
            if (counts[i] > 5) /* slender ones of a kapok */
                species.leaf.leaflet_width_cm = 2.2f;
            species.leaf.leaflets = counts[i];
            wd_leaf_template_init(&leaf, &species, form ? WD_LEAF_AS_NEAR : WD_LEAF_AS_BLADE, 0);
            check_template(&leaf);
            check_leaflets_apart(&leaf, (size_t)counts[i]);
            wd_leaf_template_finish(&leaf);
        }
    wd_arena_finish(&arena);
}

static void both_forms_have_one_area(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int shape = 0; shape <= WD_LEAF_SERRATE; shape++) {
        if (shape == WD_LEAF_NEEDLES)
            continue;
        struct wd_species species = leafy(&arena, shape, WD_COMPOUND_SIMPLE);
        struct wd_leaf_template blade, kite;
        wd_leaf_template_init(&blade, &species, WD_LEAF_AS_BLADE, 0);
        wd_leaf_template_init(&kite, &species, WD_LEAF_AS_KITE, 0);
        assert_int_equal(kite.index_count, 6);
        assert_float_equal(wd_leaf_template_area(&kite) / wd_leaf_template_area(&blade), 1, 1e-3f);
        wd_leaf_template_finish(&blade);
        wd_leaf_template_finish(&kite);
    }
    wd_arena_finish(&arena);
}

static void check_sprig(const struct wd_species *species, struct wd_sprig kind)
{
    struct wd_leaf_template sprigs[WD_LEAF_VARIANTS];
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++) {
        struct wd_leaf_template *sprig = &sprigs[i];
        wd_leaf_sprig_init(sprig, species, kind, i);
        check_template(sprig);
        assert_int_equal(sprig->index_count, 3 * kind.leaves * kind.triangles);
        assert_int_equal(sprig->corner_count, sprigs[0].corner_count);
        assert_memory_equal(sprig->indices, sprigs[0].indices,
                            sprig->index_count * sizeof *sprig->indices);
        assert_float_equal(wd_leaf_template_area(sprig) / wd_leaf_unit_area(species), 1, 1e-3f);
        /* leaves' upper sides are those of their windings */
        for (size_t k = 0; k < sprig->index_count; k += 3) {
            const struct wd_leaf_corner *a = &sprig->corners[sprig->indices[k]];
            struct wd_vec3 b = wd_v3_sub(sprig->corners[sprig->indices[k + 1]].p, a->p);
            struct wd_vec3 c = wd_v3_sub(sprig->corners[sprig->indices[k + 2]].p, a->p);
            assert_true(wd_v3_dot(wd_v3_cross(b, c), a->n) > 0);
        }
    }
    assert_memory_not_equal(sprigs[0].corners, sprigs[1].corners,
                            sprigs[0].corner_count * sizeof *sprigs[0].corners);
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++)
        wd_leaf_template_finish(&sprigs[i]);
}

/* Several leaves have the area of the one that they are drawn for, in any number and form. */
static void sprigs_have_the_area_of_a_leaf(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    static const char *const names[] = {"oak", "beech", "birch", "maple", "willow", "angelique"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct wd_species species = test_species(&arena, names[i]);
        for (uint32_t leaves = 2; leaves <= WD_SPRIG_LEAVES; leaves += 3) {
            check_sprig(&species, (struct wd_sprig){leaves, 1});
            check_sprig(&species, (struct wd_sprig){leaves, 2});
        }
    }
    wd_arena_finish(&arena);
}

/* What a large tree shows as a leaf is no more than twice as long as one; a young one's leaves are
 * as long as real ones, and drawn singly. */
static void leaves_of_large_trees_stay_small(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    static const char *const names[] = {"oak", "beech", "birch", "maple"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct wd_species species = test_species(&arena, names[i]);
        for (int young = 0; young < 2; young++) {
            const struct wd_grow_params params = {.seed = 3, .height_m = young ? 2.0f : 20.0f,
                                                  .openness = young ? 0 : 1};
            struct wd_tree_model model;
            assert_true(wd_tree_grow(&model, &species, &params, NULL));
            const struct wd_leaf_set *set = &model.sets[0][WD_SET_LEAVES];
            double sum = 0;
            for (uint32_t k = 0; k < model.leaf_count; k++)
                sum += (double)wd_leaf_size_m(model.leaves[k], model.leaf_box);
            double shown_m = (double)set->grain * sum / model.leaf_count;
            double real = shown_m / (0.01 * (double)species.leaf.length_cm);
            if (!(real > 0.7 && real < (young ? 1.6 : 2.2)))
                fail_msg("%s: %g of a leaf's length", names[i], real);
            assert_int_equal(set->forms, young ? 1 : WD_LEAF_VARIANTS);
            wd_tree_model_finish(&model);
        }
    }
    wd_arena_finish(&arena);
}

static double spray_leaf_area(const struct wd_tree_mesh *mesh)
{
    double area = 0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        const struct wd_tree_vertex *v[3];
        for (uint32_t k = 0; k < 3; k++)
            v[k] = &mesh->vertices[mesh->indices[i + k]];
        if (!(v[0]->kind & WD_VERTEX_LEAF))
            continue;
        struct wd_vec3 a = wd_v3_of(v[0]->position_m);
        area += 0.5 * (double)wd_v3_length(wd_v3_cross(wd_v3_sub(wd_v3_of(v[1]->position_m), a),
                                                       wd_v3_sub(wd_v3_of(v[2]->position_m), a)));
    }
    return area;
}

/* A twig's leaves have the area of the drawn leaf that they take the place of. */
static void twigs_keep_the_area(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    static const char *const names[] = {"oak", "beech", "birch", "spruce", "pine"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct wd_species species = test_species(&arena, names[i]);
        struct wd_tree_mesh spray = {0}, shade = {0};
        wd_leaf_spray_mesh(&spray, &species, 0.25f);
        assert_in_range(spray.index_count / 3, 20, WD_SPRAY_TRIANGLES);
        assert_float_equal(spray_leaf_area(&spray) / (double)wd_leaf_unit_area(&species), 1, 0.2);
        wd_tree_mesh_finish(&spray);
        for (int k = 0; k < 4; k++) {
            const float sizes_m[] = {0.1f, 0.25f, 0.4f, 0.7f};
            wd_leaf_spray_mesh(&spray, &species, sizes_m[k]);
            wd_leaf_spray_shade_mesh(&shade, &species, sizes_m[k]);
            assert_true(shade.index_count <= spray.index_count && shade.index_count / 3 <= WD_SPRAY_SHADE_TRIANGLES);
            assert_float_equal(spray_leaf_area(&shade) / spray_leaf_area(&spray), 1, 0.08);
            wd_tree_mesh_finish(&spray);
            wd_tree_mesh_finish(&shade);
        }
    }
    wd_arena_finish(&arena);
}

/* Short twigs of young spruces were half wood, brown beside the needles that they are drawn as from afar. */
static void needles_hide_the_wood_of_their_twig(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species spruce = test_species(&arena, "spruce");
    static const float sizes_m[] = {0.09f, 0.12f, 0.2f, 0.35f};
    for (size_t i = 0; i < sizeof sizes_m / sizeof *sizes_m; i++) {
        struct wd_tree_mesh spray = {0};
        wd_leaf_spray_mesh(&spray, &spruce, sizes_m[i]);
        double needles = spray_leaf_area(&spray);
        for (uint32_t k = 0; k < spray.vertex_count; k++)
            spray.vertices[k].kind ^= WD_VERTEX_LEAF;
        assert_true(spray_leaf_area(&spray) < 0.25 * needles);
        wd_tree_mesh_finish(&spray);
    }
    wd_arena_finish(&arena);
}

/* Near, a leaf of its real size is itself with all its lobes; a palm's frond is whole at any distance. */
static void a_leaf_of_its_real_size_needs_no_twig(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species oak = test_species(&arena, "oak"), palm = test_species(&arena, "coconut");
    struct wd_tree_mesh spray = {0}, frond = {0};
    wd_leaf_spray_mesh(&spray, &oak, 0.01f * oak.leaf.length_cm);
    assert_int_equal(spray.index_count / 3, 28);
    assert_float_equal(spray_leaf_area(&spray) / (double)wd_leaf_unit_area(&oak), 1, 1e-3);
    wd_leaf_spray_mesh(&frond, &palm, 0.01f * palm.leaf.length_cm);
    assert_int_equal(frond.index_count, 0);
    wd_tree_mesh_finish(&spray);
    wd_arena_finish(&arena);
}

/* Near, each of a fern's fronds has many more triangles along the same midribs, of the same area as far off, and throws
 * the shadow of what it is far off. */
static void a_frond_has_a_near_form_of_each_of_its_forms(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species fern = test_species(&arena, "fern");
    struct wd_tree_mesh near = {0}, shade = {0};
    wd_leaf_spray_mesh(&near, &fern, 0.01f * fern.leaf.length_cm);
    wd_leaf_spray_shade_mesh(&shade, &fern, 0.01f * fern.leaf.length_cm);
    assert_int_equal(wd_leaf_spray_forms(&fern), WD_LEAF_VARIANTS);
    assert_int_equal(near.vertex_count % WD_LEAF_VARIANTS, 0);
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++) {
        struct wd_leaf_template far;
        wd_leaf_template_init(&far, &fern, WD_LEAF_AS_BLADE, i);
        struct wd_tree_mesh part = near;
        uint32_t corners = near.vertex_count / WD_LEAF_VARIANTS;
        part.indices += i * (near.index_count / WD_LEAF_VARIANTS);
        part.index_count /= WD_LEAF_VARIANTS;
        for (uint32_t k = 0; k < part.index_count; k++)
            assert_in_range(part.indices[k], i * corners, (i + 1) * corners - 1);
        assert_true(part.index_count > 2 * far.index_count);
        assert_float_equal(spray_leaf_area(&part) / (double)wd_leaf_template_area(&far), 1, 0.02);
        assert_int_equal(shade.vertex_count, WD_LEAF_VARIANTS * far.corner_count);
        for (uint32_t k = 0; k < 14; k++) { /* of its midrib */
            const float *seen = near.vertices[i * corners + k].position_m;
            const float *shown = shade.vertices[i * far.corner_count + k].position_m;
            struct wd_vec3 p = far.corners[k].p;
            assert_float_equal(wd_v3_length(wd_v3_sub(wd_v3_of(seen), p)), 0, 0.01f);
            assert_float_equal(wd_v3_length(wd_v3_sub(wd_v3_of(shown), p)), 0, 1e-6f);
        }
        wd_leaf_template_finish(&far);
    }
    wd_tree_mesh_finish(&near);
    wd_tree_mesh_finish(&shade);
    wd_arena_finish(&arena);
}

static struct wd_leaf_stand any_stand(struct wd_random *random)
{
    struct wd_vec3 axis = wd_random_vec3(random), normal = wd_random_vec3(random);
    axis = wd_v3_unit(axis);
    return (struct wd_leaf_stand){
        .position_m = WD_V3(wd_random_range(random, -9, 9), wd_random_range(random, -8, 8),
                            wd_random_range(random, 3, 30)),
        .axis = axis,
        .normal = wd_v3_square(normal, axis),
        .shading = wd_v3_unit(wd_random_vec3(random)),
        .size_m = wd_random_range(random, 0.05f, 0.4f),
        .flexibility = wd_random_range(random, 0, 255),
        .arch = wd_random_unit(random),
        .form = wd_hash1((uint32_t)wd_random_range(random, 0, 1e6f)) & 3,
        .tint = 0x12345678,
    };
}

static void assert_near(struct wd_vec3 a, struct wd_vec3 b, float distance)
{
    if (!(wd_v3_length(wd_v3_sub(a, b)) <= distance))
        fail_msg("%g %g %g is not %g %g %g", (double)a.x, (double)a.y, (double)a.z, (double)b.x,
                 (double)b.y, (double)b.z);
}

/* Places to half a millimetre in a large tree, directions to a quarter of a degree. */
static void packed_leaves_stand_where_they_grew(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    static struct wd_leaf_stand stands[COUNT];
    struct wd_random random = wd_random_of(7, 1);
    for (int i = 0; i < COUNT; i++)
        stands[i] = any_stand(&random);
    const struct wd_leaf_box box = wd_leaf_box_of(stands, COUNT);
    for (int i = 0; i < COUNT; i++) {
        const struct wd_leaf_stand *stand = &stands[i];
        const struct wd_tree_leaf leaf = wd_leaf_pack(stand, &box);
        const struct wd_leaf_axes axes = wd_leaf_axes_of(leaf.turn);
        assert_near(wd_leaf_foot(leaf, box), stand->position_m, 5e-4f);
        assert_near(axes.along, stand->axis, 4.5e-3f);
        assert_near(axes.above, stand->normal, 4.5e-3f);
        assert_near(axes.across, wd_v3_cross(stand->axis, stand->normal), 4.5e-3f);
        assert_near(wd_leaf_shading(leaf.shading), stand->shading, 0.02f);
        assert_float_equal(wd_leaf_size_m(leaf, box), stand->size_m, 1e-5);
        assert_float_equal(WD_LEAF_ARCH(leaf), stand->arch, 0.009);
        assert_float_equal(WD_LEAF_FLEXIBILITY(leaf), stand->flexibility, 1);
        assert_int_equal(WD_LEAF_FORM(leaf), stand->form);
        assert_int_equal(leaf.tint, stand->tint);
    }
}

/* A vertex on the device is within a step of where it was. */
static void packed_vertices_stay_in_their_box(void **state)
{
    (void)state;
    const float low[3] = {-10, -10, -0.5f}, high[3] = {10, 10, 35};
    const struct wd_mesh_box box = wd_mesh_box_of(low, high);
    struct wd_random random = wd_random_of(8, 1);
    for (int i = 0; i < 1000; i++) {
        const struct wd_tree_vertex vertex = {
            .position_m = {wd_random_range(&random, -10, 10), i % 2 ? -10 : 10,
                           wd_random_range(&random, -0.5f, 35)},
            .normal = wd_pack_normal((const float[3]){0.6f, 0, 0.8f}),
            .uv = 2,
            .tint = 0x80ff4010,
            .kind = WD_VERTEX_LEAF | 77,
        };
        const struct wd_packed_vertex packed = wd_vertex_pack(&vertex, &box);
        assert_near(wd_box_place(box, packed.xy, packed.z_kind), wd_v3_of(vertex.position_m), 4e-4f);
        assert_int_equal(WD_PACKED_KIND(packed), vertex.kind);
        assert_int_equal(packed.z_kind >> 26, 32);                   /* of 63: 0x80 of 255 */
        assert_int_equal(packed.uv, 2);
        assert_int_equal(packed.normal_tint & 0xffff, 54);           /* 0.6 / 1.4 of 127, 0 */
        assert_int_equal(packed.normal_tint >> 16 & 31, 8);          /* the root of 0x10 / 255, of 31 */
        assert_int_equal(packed.normal_tint >> 21 & 63, 32);         /* of 0x40 / 255, of 63 */
        assert_int_equal(packed.normal_tint >> 27, 31);              /* of 1 */
    }
}

/* Every vertex of a full mesh's leaves is near the place that it comes from; without them the mesh
 * is wood, and with them again it is the same. */
static void leaves_come_from_their_places(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species oak = test_species(&arena, "oak");
    struct wd_tree_model model, other;
    const struct wd_grow_params params = {.seed = 3};
    assert_true(wd_tree_grow(&model, &oak, &params, NULL));
    assert_true(wd_tree_grow(&other, &oak, &params, NULL));
    const struct wd_leaf_set *set = &model.sets[0][WD_SET_LEAVES];
    assert_int_equal(set->leaf_count, model.leaf_count);
    uint32_t first = model.full.vertex_count - set->leaf_count * set->corner_count;
    for (uint32_t i = first; i < model.full.vertex_count; i++) {
        const struct wd_tree_leaf leaf = model.leaves[(i - first) / set->corner_count];
        assert_near(wd_v3_of(model.full.vertices[i].position_m),
                    wd_leaf_foot(leaf, model.leaf_box),
                    1.6f * wd_leaf_size_m(leaf, model.leaf_box));
    }
    wd_tree_model_drop_leaves(&other);
    assert_int_equal(other.full.index_count, model.full.wood_index_count);
    assert_int_equal(other.full.vertex_count, first);
    assert_int_equal(other.reduced.index_count, model.reduced.wood_index_count);
    wd_tree_model_drop_leaves(&other);
    assert_int_equal(other.full.vertex_count, first);
    wd_tree_model_add_leaves(&other);
    wd_tree_model_add_leaves(&other);
    assert_int_equal(other.reduced.vertex_count, model.reduced.vertex_count);
    assert_memory_equal(other.full.vertices, model.full.vertices,
                        model.full.vertex_count * sizeof *model.full.vertices);
    assert_memory_equal(other.reduced.vertices, model.reduced.vertices,
                        model.reduced.vertex_count * sizeof *model.reduced.vertices);
    wd_tree_model_finish(&model);
    wd_tree_model_finish(&other);
    wd_arena_finish(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shape_is_sound),
        cmocka_unit_test(leaflets_of_a_hand_do_not_overlap),
        cmocka_unit_test(both_forms_have_one_area),
        cmocka_unit_test(sprigs_have_the_area_of_a_leaf),
        cmocka_unit_test(leaves_of_large_trees_stay_small),
        cmocka_unit_test(twigs_keep_the_area),
        cmocka_unit_test(needles_hide_the_wood_of_their_twig),
        cmocka_unit_test(a_leaf_of_its_real_size_needs_no_twig),
        cmocka_unit_test(a_frond_has_a_near_form_of_each_of_its_forms),
        cmocka_unit_test(packed_leaves_stand_where_they_grew),
        cmocka_unit_test(packed_vertices_stay_in_their_box),
        cmocka_unit_test(leaves_come_from_their_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
