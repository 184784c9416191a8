/* Leaves of near meshes that are listed for a view: all that it shows, and not the rest of the crown. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/memory.h"
#include "frame/view.h"
#include "methods/leaf_view.h"
#include "tree/grow.h"

/* One oak of 10 m, drawn 12 m high, turned and mirrored, without a device. */
struct fixture {
    struct wd_arena arena;
    struct wd_species species;
    struct wd_tree_model grown;
    struct wd_tree tree;
    struct wd_scene scene;
    struct wd_world world;
    struct wd_model model;
    struct wd_mesh_range ranges[1][2];
    struct wd_twig_range twigs;
    struct wd_forest_device forest;
    struct wd_view view;
    struct wd_tree_draw draw;
    uint32_t *list, listed;
};

static const char *species_path;

static void fixture_init(struct fixture *f)
{
    const struct wd_grow_params params = {.seed = 2, .height_m = 14};
    *f = (struct fixture){0};
    assert_true(wd_species_load(&f->species, species_path, &f->arena, NULL));
    assert_true(wd_tree_grow(&f->grown, &f->species, &params, NULL));
    const struct wd_leaf_set *set = &f->grown.sets[0][WD_SET_LEAVES];
    f->tree = (struct wd_tree){.x_mm = 4000, .y_mm = 30000, .size = 1200 | 700u << 16,
                               .look = WD_TREE_LOOK(5000u, 128u, 1u)};
    f->scene.quality.leaf_px = 3;
    f->world.trees = &f->tree;
    f->model = (struct wd_model){.height_m = f->grown.height_m,
                                 .crown_m = 2 * f->grown.crown_radius_m};
    for (int i = 0; i < WD_GAIN_SIDES * WD_LEAF_GROWTHS; i++)
        f->model.full_growth.of[i / WD_LEAF_GROWTHS][i % WD_LEAF_GROWTHS] = 1;
    f->ranges[0][0].sets[WD_SET_LEAVES].leaf_count = set->leaf_count;
    f->twigs.box = f->grown.leaf_box;
    f->forest = (struct wd_forest_device){
        .scene = &f->scene, .world = &f->world, .host_models = &f->model, .variants = 1,
        .meshes = {.ranges = f->ranges, .twigs = &f->twigs, .host_leaves = f->grown.leaves}};
    f->draw = (struct wd_tree_draw){.forest = &f->forest, .view = &f->view,
                                    .pass = WD_PASS_CAMERA};
    f->list = wd_alloc_array(set->leaf_count, sizeof *f->list);
}

static void fixture_finish(struct fixture *f)
{
    free(f->list);
    wd_tree_model_finish(&f->grown);
    wd_arena_finish(&f->arena);
}

static void look(struct fixture *f, double yaw_rad, double fov_rad)
{
    const struct wd_view_params params = {
        .camera = {.position_m = {4, 22, 8}, .yaw_rad = yaw_rad, .fov_rad = fov_rad},
        .width = 320, .height = 240, .near_m = 0.1f};
    const struct wd_leaf_draw *set = &f->ranges[0][0].sets[WD_SET_LEAVES];
    wd_view_init(&f->view, &params);
    f->listed = wd_leaves_in_view(&f->draw, 0, set, set->leaf_count, f->list);
}

static bool shows(const struct wd_view *view, const float at[3])
{
    float clip[4];
    for (int row = 0; row < 4; row++) {
        clip[row] = view->clip_from_rel[3][row];
        for (int k = 0; k < 3; k++)
            clip[row] += view->clip_from_rel[k][row] * at[k];
    }
    return clip[3] > 0.1f && fabsf(clip[0]) <= clip[3] && fabsf(clip[1]) <= clip[3];
}

/* Whether the picture shows a corner of the leaf, as the full mesh has it. */
static bool leaf_shows(const struct fixture *f, uint32_t leaf)
{
    const struct wd_leaf_set *sets = f->grown.sets[0], *set = &sets[WD_SET_LEAVES];
    const struct wd_tree_mesh *mesh = &f->grown.full;
    const struct wd_stand stand = wd_stand_of(&f->draw, 0);
    uint32_t flowers = sets[WD_SET_FLOWERS].leaf_count * sets[WD_SET_FLOWERS].corner_count;
    uint32_t first = mesh->vertex_count - flowers - set->leaf_count * set->corner_count;
    for (uint32_t i = 0; i < set->corner_count; i++) {
        float at[3];
        const float *p = mesh->vertices[first + leaf * set->corner_count + i].position_m;
        wd_stand_place(&stand, WD_V3(p[0], p[1], p[2]), at);
        if (shows(&f->view, at))
            return true;
    }
    return false;
}

static void every_leaf_that_shows_is_listed_once(void **state)
{
    (void)state;
    struct fixture f;
    fixture_init(&f);
    uint32_t count = f.ranges[0][0].sets[WD_SET_LEAVES].leaf_count;
    for (int turn = -2; turn <= 2; turn++) {
        look(&f, 0.15 * turn, 0.2);
        uint32_t shown = 0, at = 0;
        for (uint32_t i = 0; i < count; i++) {
            bool listed = at < f.listed && f.list[at] == i; /* in order */
            at += listed;
            shown += leaf_shows(&f, i);
            assert_true(listed || !leaf_shows(&f, i));
        }
        assert_int_equal(at, f.listed);
        assert_true(turn != 0 || (shown > 200 && shown < count / 2)); /* a part of the crown */
    }
    fixture_finish(&f);
}

static void the_rest_of_the_crown_is_not(void **state)
{
    (void)state;
    struct fixture f;
    fixture_init(&f);
    uint32_t count = f.ranges[0][0].sets[WD_SET_LEAVES].leaf_count, shown = 0;
    look(&f, 0, 0.2);
    for (uint32_t i = 0; i < count; i++)
        shown += leaf_shows(&f, i);
    print_message("%u leaves, %u listed, %u shown\n", count, f.listed, shown);
    /* a picture of 2.1 x 1.6 m, and up to a metre around it for what leaves may reach */
    assert_true(f.listed < 5 * shown && f.listed < 2 * count / 3);
    look(&f, 3.14159, 0.2);
    assert_int_equal(f.listed, 0);
    fixture_finish(&f);
}

/* A shadow map of coarse texels has a part of the leaves: those that shaders/methods/tree_leaf.vert lets
 * stand, and hardly more. */
static void shadow_maps_have_no_more_leaves_than_they_show(void **state)
{
    (void)state;
    struct fixture f;
    fixture_init(&f);
    struct wd_mesh_range *range = &f.ranges[0][0];
    uint32_t count = range->sets[WD_SET_LEAVES].leaf_count, standing = 0, at = 0;
    range->sets[WD_SET_LEAVES].index_count = f.grown.sets[0][WD_SET_LEAVES].index_count;
    range->leaf_count = count;
    range->leaf_m = 0.1f;
    for (int k = 0; k < 3; k++)
        f.model.seen_m2[k] = 20;
    look(&f, 0, 1.2);
    f.draw.pass = WD_PASS_SHADOW;
    f.view.box.radius = 0.06 * f.view.width;
    f.view.box.toward[2] = 1;
    f.listed = wd_leaves_in_view(&f.draw, 0, &range->sets[WD_SET_LEAVES], count, f.list);
    const struct wd_stand stand = wd_stand_of(&f.draw, 0);
    float pixels = wd_leaf_pixels(&f.forest, &f.view, WD_PASS_SHADOW);
    float most = wd_leaf_most(&f.forest, &f.view, WD_PASS_SHADOW, 0, WD_LEVEL_MESH);
    assert_true(most > 0.02f && most < 0.5f);
    for (uint32_t i = 0; i < count; i++) {
        float place[3];
        wd_stand_place(&stand, wd_leaf_foot(f.grown.leaves[i], f.twigs.box), place);
        float far_m = sqrtf(place[0] * place[0] + place[1] * place[1] + place[2] * place[2]);
        float px = range->leaf_m * stand.pose.across * pixels / far_m;
        bool stands = (float)i < wd_leaf_stand(px, most, stand.pose.across) * (float)count;
        bool listed = at < f.listed && f.list[at] == i;
        at += listed;
        standing += stands;
        assert_true(listed || !stands || !leaf_shows(&f, i));
    }
    print_message("%u leaves, %u stand, %u listed\n", count, standing, f.listed);
    assert_true(standing > 100 && f.listed < standing + standing / 20 + 8);
    f.view.box.radius *= 2;
    uint32_t fewer = wd_leaves_in_view(&f.draw, 0, &range->sets[WD_SET_LEAVES], count, f.list);
    assert_in_range(fewer, f.listed / 5, f.listed / 3);
    fixture_finish(&f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_leaf_that_shows_is_listed_once),
        cmocka_unit_test(the_rest_of_the_crown_is_not),
        cmocka_unit_test(shadow_maps_have_no_more_leaves_than_they_show),
    };
    if (argc != 2)
        return 2;
    species_path = argv[1];
    return cmocka_run_group_tests(tests, NULL, NULL);
}
