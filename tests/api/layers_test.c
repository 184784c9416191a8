/* Layers without colour: as those of lit pictures, by less work. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "shared/vec.h"
#include "suite.h"

enum { PIXELS = PICTURE_WIDTH * PICTURE_HEIGHT };
static struct suite suite;

static struct wd_render_params params_of(const char *method, uint32_t layers)
{
    struct wd_render_params params = suite_params(suite.forest, "over");
    params.method = method;
    params.samples = 2;
    params.timing = WD_TIME_PASSES;
    params.layers = layers;
    return params;
}

static bool has_pass(const struct wd_frame_stats *stats, const char *name)
{
    for (uint32_t i = 0; i < stats->pass_count; i++)
        if (!strcmp(stats->passes[i].name, name))
            return true;
    return false;
}

/* `samples` were drawn, lit or not; passes are of the first of these, "post" goes with the last. */
static struct wd_picture draw(const struct wd_render_params *params, uint32_t samples, bool lit)
{
    struct wd_frame_stats stats;
    struct wd_picture picture = suite_render(&suite, params);
    wd_renderer_get_stats(suite.renderer, &stats);
    assert_int_equal(stats.samples, samples);
    assert_true(has_pass(&stats, "terrain"));
    assert_int_equal(has_pass(&stats, "shadow trees"), lit);
    assert_int_equal(has_pass(&stats, "light"), lit);
    assert_false(has_pass(&stats, "post"));
    assert_int_equal(picture.color != NULL, lit);
    return picture;
}

/* The first that a renderer draws: nothing is there yet that only light prepares. */
static void nothing_lit_has_to_be_before(void **state)
{
    (void)state;
    struct wd_picture first, later;
    struct wd_render_params params = params_of("patch", WD_LAYER_VELOCITY | WD_LAYER_TREE_ID);
    const struct wd_renderer_params validated = {
        .gpu = "software", .validation = WD_VALIDATION_ON, .log = suite.log};
    struct wd_renderer *renderer = NULL;
    assert_int_equal(wd_renderer_create(&renderer, &validated), WD_OK);
    assert_int_equal(wd_renderer_set_forest(renderer, suite.forest), WD_OK);
    assert_int_equal(wd_renderer_render(renderer, &params, &first), WD_OK);
    params.layers |= WD_LAYER_COLOR;
    assert_int_equal(wd_renderer_render(renderer, &params, &later), WD_OK);
    assert_memory_equal(first.tree_id, later.tree_id, PIXELS * sizeof *first.tree_id);
    wd_renderer_destroy(&renderer);
    wd_picture_finish(&first);
    wd_picture_finish(&later);
}

/* And light that comes after is what it would have been. */
static void layers_need_no_light(void **state)
{
    (void)state;
    const char *const methods[] = {"octree", "patch", "impostor", "continuum"};
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
        const uint32_t dark = WD_LAYER_ALL & ~(uint32_t)(WD_LAYER_COLOR | WD_LAYER_DISPLAY);
        const struct wd_render_params params[] = {params_of(methods[m], WD_LAYER_ALL), params_of(methods[m], dark)};
        struct wd_picture lit = draw(&params[0], 2, true), p = draw(&params[1], 1, false);
        struct wd_picture again = draw(&params[0], 2, true);
        assert_memory_equal(p.depth_m, lit.depth_m, PIXELS * sizeof *p.depth_m);
        assert_memory_equal(p.normal, lit.normal, 3 * PIXELS * sizeof *p.normal);
        assert_memory_equal(p.albedo, lit.albedo, 3 * PIXELS * sizeof *p.albedo);
        assert_memory_equal(p.species, lit.species, PIXELS * sizeof *p.species);
        assert_memory_equal(p.tree_id, lit.tree_id, PIXELS * sizeof *p.tree_id);
        assert_memory_equal(p.velocity_px, lit.velocity_px, 2 * PIXELS * sizeof *p.velocity_px);
        assert_memory_equal(again.color, lit.color, 3 * PIXELS * sizeof *lit.color);
        wd_picture_finish(&lit);
        wd_picture_finish(&p);
        wd_picture_finish(&again);
    }
}

/* Each sample is counted. */
static void mattes_are_of_all_samples(void **state)
{
    (void)state;
    struct wd_render_params params = params_of("octree", WD_LAYER_CRYPTOMATTE);
    struct wd_picture matte = draw(&params, 2, false);
    assert_non_null(matte.rank_tree);
    wd_picture_finish(&matte);
}

static void expect_toward_eye(const struct wd_picture *p)
{
    const struct wd_camera *c = &p->camera;
    double cy = cos(c->yaw_rad), sy = sin(c->yaw_rad), cp = cos(c->pitch_rad), sp = sin(c->pitch_rad);
    const double forward[3] = {sy * cp, cy * cp, sp}, right[3] = {cy, -sy, 0}, up[3] = {-sy * sp, -cy * sp, cp};
    double tall = tan(0.5 * c->fov_rad), wide = tall * p->width / p->height;
    for (uint32_t i = 0; i < PIXELS; i++) {
        double x = wide * (2 * (i % p->width + 0.5) / p->width - 1), away = 0;
        double y = tall * (1 - 2 * (i / p->width + 0.5) / p->height);
        for (int k = 0; k < 3; k++)
            away += p->normal[3 * i + k] * (forward[k] + x * right[k] + y * up[k]);
        assert_true(away < 1e-5);
    }
}

/* Solid things are not turned inside out where their smooth normals look past the eye. */
static void solid_normals_are_bent_not_turned(void **state)
{
    (void)state;
    const struct wd_vec3 ahead = {0, 2, -0.1f}, ground = {0, 0.08f, 0.9968f}, leaf = {0, 0.8f, 0.6f};
    struct wd_vec3 solid = wd_normal_seen(ground, ahead, false), sheet = wd_normal_seen(leaf, ahead, true);
    assert_true(solid.z > 0.99f && fabsf(wd_v3_dot(solid, ahead)) < 1e-5f);
    assert_true(wd_v3_dot(sheet, leaf) < -0.99f);
    assert_true(wd_v3_dot(wd_normal_seen(leaf, wd_v3_scale(ahead, -1), true), leaf) > 0.99f);
}

static bool holds(const char *path, const char *text)
{
    static char bytes[1 << 16];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    return memmem(bytes, size, text, strlen(text));
}

/* Whoever reads a file knows where its pixels are; sheets are seen from the side that the normal says. */
static void pictures_tell_what_they_show(void **state)
{
    (void)state;
    const char *const methods[] = {"octree", "lod", "continuum"};
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
        struct wd_render_params params = params_of(methods[m], WD_LAYER_NORMAL);
        params.time_s = 90000.5;
        struct wd_picture picture = draw(&params, 1, false);
        assert_memory_equal(&picture.camera, &params.camera, sizeof params.camera);
        expect_toward_eye(&picture);
        assert_non_null(strstr(picture.about, "\"time_s\":90000.5,\"camera\":{\"position_m\":["));
        char path[] = "/tmp/weald-layers-XXXXXX.exr";
        close(mkstemps(path, 4));
        assert_int_equal(wd_picture_write(&picture, path, NULL), WD_OK);
        assert_true(holds(path, picture.about) && holds(path, "worldToCamera"));
        unlink(path);
        wd_picture_finish(&picture);
    }
}

/* --- places ------------------------------------------------------------------------------- */

/* A breast-high look at each of some trunks: id, place and depth agree. */
static void trees_are_where_they_are_said_to_be(void **state)
{
    (void)state;
    const double away_m = 4, up_m = 0.8, thickest_m = 0.3;
    const char *const set[] = {"wind.speed_mps=0", NULL};
    struct wd_forest_params still = {.scene_path = suite.small_path, .settings = set, .log = suite.log};
    struct wd_forest *forest;
    assert_int_equal(wd_forest_create(&forest, &still), WD_OK);
    assert_int_equal(wd_renderer_set_forest(suite.renderer, forest), WD_OK);
    for (uint32_t id = 20; id < 1400; id += 230) {
        struct wd_tree_info tree;
        struct wd_render_params params = {
            .width = 41, .height = 25, .method = "continuum", .layers = WD_LAYER_DEPTH | WD_LAYER_TREE_ID};
        assert_true(wd_forest_get_tree(forest, id, &tree));
        const double *foot = tree.position_m, axis_m[3] = {foot[0], foot[1], foot[2] + up_m};
        assert_float_equal(foot[2], wd_forest_ground_m(forest, foot[0], foot[1]), 1e-3);
        params.camera = (struct wd_camera){
            .position_m = {foot[0] - away_m * sin(id), foot[1] - away_m * cos(id), foot[2] + 2 * up_m}, .fov_rad = 0.2};
        wd_camera_look_at(&params.camera, axis_m);
        params.camera.yaw_rad += 0.05;
        double pixel[2], depth_m, place_m[3];
        assert_true(wd_camera_project(&params.camera, params.width, params.height, axis_m, pixel, &depth_m));
        assert_true(pixel[0] > 4 && pixel[0] < 18 && fabs(pixel[1] - 12.5) < 0.5);
        struct wd_picture picture = suite_render(&suite, &params);
        size_t at = (size_t)pixel[1] * params.width + (size_t)pixel[0];
        assert_int_equal(picture.tree_id[at], id);
        wd_camera_place(&params.camera, params.width, params.height, pixel, (double)picture.depth_m[at], place_m);
        assert_true(hypot(place_m[0] - foot[0], place_m[1] - foot[1]) < thickest_m);
        wd_picture_finish(&picture);
    }
    assert_int_equal(wd_renderer_set_forest(suite.renderer, suite.forest), WD_OK);
    wd_forest_destroy(&forest);
}

/* What is seen of the ground lies on it, right to the picture's edges. */
static void depths_are_of_places(void **state)
{
    (void)state;
    struct wd_render_params params = suite_params(suite.forest, "walk");
    params.layers = WD_LAYER_DEPTH | WD_LAYER_TREE_ID;
    params.camera.position_m[2] += 30;
    params.camera.pitch_rad = -1.2;
    struct wd_picture picture = suite_render(&suite, &params);
    double off_m = 0, place_m[3], again[2], depth_m;
    size_t ground = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const double pixel[2] = {(double)(i % PICTURE_WIDTH) + 0.5, (double)(i / PICTURE_WIDTH) + 0.5};
        if (picture.tree_id[i] || isinf(picture.depth_m[i]))
            continue;
        wd_camera_place(&params.camera, params.width, params.height, pixel, (double)picture.depth_m[i], place_m);
        assert_true(wd_camera_project(&params.camera, params.width, params.height, place_m, again, &depth_m));
        assert_true(hypot(again[0] - pixel[0], again[1] - pixel[1]) < 1e-6);
        assert_float_equal(depth_m, picture.depth_m[i], 1e-6);
        off_m += fabs(place_m[2] - wd_forest_ground_m(suite.forest, place_m[0], place_m[1]));
        ground++;
    }
    assert_true(ground > 1000 && off_m < 0.01 * (double)ground);
    wd_picture_finish(&picture);
}

static void cameras_turn_to_places(void **state)
{
    (void)state;
    struct wd_camera camera = {.position_m = {10, 20, 30}, .yaw_rad = 0.7, .fov_rad = 1};
    double pixel[2] = {-1, -1}, depth_m = -1;
    wd_camera_look_at(&camera, (const double[3]){13, 20, 30});
    assert_float_equal(camera.yaw_rad, 1.57079632679, 1e-9);
    assert_true(wd_camera_project(&camera, 40, 30, (const double[3]){13, 20, 30}, pixel, NULL));
    assert_true(fabs(pixel[0] - 20) < 1e-9 && fabs(pixel[1] - 15) < 1e-9);
    assert_true(wd_camera_project(&camera, 40, 30, (const double[3]){13, 19, 31}, pixel, &depth_m));
    assert_true(pixel[0] > 20 && pixel[1] < 15 && fabs(depth_m - 3) < 1e-9);
    assert_false(wd_camera_project(&camera, 40, 30, (const double[3]){10, 20, 30}, pixel, &depth_m));
    assert_false(wd_camera_project(&camera, 40, 30, (const double[3]){9, 20, 30}, pixel, &depth_m));
    assert_float_equal(depth_m, 3, 1e-9);
    wd_camera_look_at(&camera, (const double[3]){10, 20, 0});
    assert_float_equal(camera.yaw_rad, 1.57079632679, 1e-9);
    assert_float_equal(camera.pitch_rad, -1.57079632679, 1e-9);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_lit_has_to_be_before),
        cmocka_unit_test(layers_need_no_light),
        cmocka_unit_test(mattes_are_of_all_samples),
        cmocka_unit_test(solid_normals_are_bent_not_turned),
        cmocka_unit_test(pictures_tell_what_they_show),
        cmocka_unit_test(trees_are_where_they_are_said_to_be),
        cmocka_unit_test(depths_are_of_places),
        cmocka_unit_test(cameras_turn_to_places),
    };
    if (argc < 2 || !suite_init(&suite, argv[1]) || wd_renderer_set_forest(suite.renderer, suite.forest) != WD_OK)
        return 1;
    int failed = cmocka_run_group_tests_name("layers", tests, NULL, NULL);
    suite_finish(&suite);
    return failed;
}
