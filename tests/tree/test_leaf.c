#include "tree_test.h"

#include "tree/foliage.h"
#include "tree/leaf_spray.h"
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
    for (int shape = 0; shape <= WD_LEAF_NEEDLES; shape++)
        for (int compound = 0; compound <= WD_COMPOUND_BIPINNATE; compound++) {
            struct wd_species species = leafy(&arena, shape, compound);
            struct wd_leaf_template leaf;
            wd_leaf_template_init(&leaf, &species, WD_LEAF_AS_BLADE, 0);
            check_template(&leaf);
            if (compound == WD_COMPOUND_SIMPLE && shape < WD_LEAF_BLADE) {
                assert_in_range(leaf.index_count / 3, 4, 15);
                check_winding(&leaf);
            }
            wd_leaf_template_finish(&leaf);
        }
    wd_arena_finish(&arena);
}

static void both_forms_have_one_area(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int shape = 0; shape < WD_LEAF_NEEDLES; shape++) {
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
        struct wd_tree_mesh spray = {0};
        wd_leaf_spray_mesh(&spray, &species, 0.25f);
        assert_in_range(spray.index_count / 3, 20, WD_SPRAY_TRIANGLES);
        assert_float_equal(spray_leaf_area(&spray) / (double)wd_leaf_unit_area(&species), 1, 0.2);
        wd_tree_mesh_finish(&spray);
    }
    wd_arena_finish(&arena);
}

static void a_leaf_of_its_real_size_needs_no_twig(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species oak = test_species(&arena, "oak");
    struct wd_tree_mesh spray = {0};
    wd_leaf_spray_mesh(&spray, &oak, 0.01f * oak.leaf.length_cm);
    assert_int_equal(spray.index_count, 0);
    wd_tree_mesh_finish(&spray);
    wd_arena_finish(&arena);
}

/* Every vertex of a full mesh's leaves names a leaf, whose record is near it. */
static void vertices_name_their_leaves(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species oak = test_species(&arena, "oak");
    struct wd_tree_model model;
    const struct wd_grow_params params = {.seed = 3};
    assert_true(wd_tree_grow(&model, &oak, &params, NULL));
    assert_non_null(model.leaves);
    for (uint32_t i = model.full.wood_index_count; i < model.full.index_count; i++) {
        const struct wd_tree_vertex *vertex = &model.full.vertices[model.full.indices[i]];
        uint32_t name = vertex->kind >> WD_VERTEX_LEAF_SHIFT;
        assert_in_range(name, 1, model.leaf_count);
        const struct wd_tree_leaf *leaf = &model.leaves[name - 1];
        float d = wd_v3_length(wd_v3_sub(wd_v3_of(vertex->position_m),
                                         wd_v3_of(leaf->position_m)));
        assert_true(d <= 1.6f * leaf->size_m);
    }
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shape_is_sound),
        cmocka_unit_test(both_forms_have_one_area),
        cmocka_unit_test(twigs_keep_the_area),
        cmocka_unit_test(a_leaf_of_its_real_size_needs_no_twig),
        cmocka_unit_test(vertices_name_their_leaves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
