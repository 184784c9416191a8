/* The public interface, through a small scene on software Vulkan.
 *   test-api ROOT   (the folder of the sources) */
#include "parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/exr.h"
#include "weald/reference.h"
#include "weald/tree.h"

enum { PIXELS = PICTURE_WIDTH * PICTURE_HEIGHT, MIDDLE = PIXELS / 2 + PICTURE_WIDTH / 2 };

static struct wd_picture render_layers(struct suite *suite, const char *camera, uint32_t layers)
{
    struct wd_render_params params = suite_params(suite->forest, camera);
    params.layers = layers;
    return suite_render(suite, &params);
}

/* --- what is refused --------------------------------------------------------------------- */

static void assert_refused(struct suite *suite, const struct wd_render_params *params, const char *part)
{
    struct wd_picture picture;
    suite_clear(suite);
    assert_int_equal(wd_renderer_render(suite->renderer, params, &picture), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, part));
    assert_true(picture.width == 0 && !picture.display);
}

static void impossible_pictures_are_refused(void **state)
{
    struct suite *suite = *state;
    const struct wd_render_params good = suite_params(suite->forest, "over");
    struct wd_render_params params = good;
    params.method = "octtree";
    assert_refused(suite, &params, "octtree");
    params = good;
    params.width = 0;
    assert_refused(suite, &params, "0 x 120");
    params.width = 100000;
    assert_refused(suite, &params, "100000 x 120");
    params = good;
    params.height = 0;
    assert_refused(suite, &params, "160 x 0");
    params.height = 100000;
    assert_refused(suite, &params, "160 x 100000");
    params = good;
    params.samples = 1u << 30;
    assert_refused(suite, &params, "1073741824 samples");
    params = good;
    params.camera.fov_rad = NAN;
    assert_refused(suite, &params, "field of view");
    params = good;
    params.camera.position_m[2] = INFINITY;
    assert_refused(suite, &params, "camera");
    params = suite_params(suite->forest, NULL);
    const double errors[] = {0.2, 33.0, -1.0, NAN};
    for (int i = 0; i < 4; i++) {
        params.max_error_px = errors[i];
        assert_refused(suite, &params, "0.25 to 32 are possible");
    }
}

static void trees_on_demand_need_continuum(void **state)
{
    struct suite *suite = *state;
    const char *const settings[] = {"planting=on_demand", NULL};
    const struct wd_forest_params forest_params = {
        .scene_path = suite->small_path, .settings = settings, .log = suite->log};
    struct wd_forest *forest;
    assert_int_equal(wd_forest_create(&forest, &forest_params), WD_OK);
    assert_int_equal(wd_renderer_set_forest(suite->renderer, forest), WD_OK);
    struct wd_render_params params = suite_params(forest, "over");
    params.method = "octree";
    assert_refused(suite, &params, "method octree needs all trees in memory");

    const struct wd_reference_params reference_params = {.log = suite->log};
    const struct wd_reference_picture_params trace = {
        .camera = params.camera, .width = 8, .height = 6, .samples = 1};
    struct wd_reference *reference;
    struct wd_picture picture;
    suite_clear(suite);
    assert_int_equal(wd_reference_create(&reference, forest, &reference_params), WD_OK);
    assert_int_equal(wd_reference_render(reference, &trace, &picture), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, "the path tracer needs all trees in memory"));
    wd_reference_destroy(&reference);
    assert_int_equal(wd_renderer_set_forest(suite->renderer, suite->forest), WD_OK);
    wd_forest_destroy(&forest);
}

static void without_a_forest_nothing_is_drawn(void **state)
{
    struct suite *suite = *state;
    const struct wd_render_params params = suite_params(suite->forest, "over");
    assert_int_equal(wd_renderer_set_forest(suite->renderer, NULL), WD_OK);
    assert_refused(suite, &params, "forest");
    assert_int_equal(wd_renderer_set_forest(suite->renderer, suite->forest), WD_OK);
}

static void a_wish_to_stop_stops(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "over");
    struct wd_picture picture;
    params.samples = 4;
    suite->stop_stage = "samples";
    suite->stop_at = 2;
    enum wd_result result = wd_renderer_render(suite->renderer, &params, &picture);
    suite->stop_stage = NULL;
    assert_int_equal(result, WD_ERROR_INTERRUPTED);
    assert_null(picture.display);
    picture = suite_render(suite, &params); /* and the renderer goes on */
    assert_non_null(picture.display);
    wd_picture_finish(&picture);
}

/* --- layers ------------------------------------------------------------------------------ */

static double length3(const float *v)
{
    return sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
}

static void assert_pixel(const struct suite *suite, const struct wd_picture *p, size_t i)
{
    bool sky = isinf(p->depth_m[i]);
    struct wd_tree_info tree;
    assert_true(sky || p->depth_m[i] > 0.0f);
    assert_true(fabs(length3(p->normal + 3 * i) - (sky ? 0.0 : 1.0)) < 1e-3);
    assert_int_equal(p->display[4 * i + 3], 255);
    for (size_t k = 3 * i; k < 3 * i + 3; k++) {
        assert_true(p->albedo[k] >= 0.0f && p->albedo[k] <= 1.0f);
        assert_true(p->color[k] >= 0.0f && isfinite(p->color[k]));
    }
    if (p->tree_id[i] == 0) {
        assert_int_equal(p->species[i], 0);
        return;
    }
    assert_false(sky);
    assert_true(wd_forest_get_tree(suite->forest, p->tree_id[i], &tree));
    assert_int_equal(p->species[i], tree.species + 1);
}

static void every_layer_holds_what_it_says(void **state)
{
    struct suite *suite = *state;
    struct wd_picture p = render_layers(suite, "over", WD_LAYER_ALL);
    size_t sky = 0, trees = 0;
    assert_true(p.width == PICTURE_WIDTH && p.height == PICTURE_HEIGHT);
    assert_non_null(p.velocity_px);
    for (size_t i = 0; i < PIXELS; i++) {
        assert_pixel(suite, &p, i);
        sky += isinf(p.depth_m[i]);
        trees += p.tree_id[i] != 0;
    }
    assert_true(sky > PIXELS / 50 && trees > PIXELS / 10); /* so that all of it was tested */
    assert_true(sky + trees < PIXELS);
    wd_picture_finish(&p);
    assert_null(p.display);
}

/* The crown that a pixel shows is where the pixel looks. */
static void depths_lead_to_the_trees(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "over");
    params.layers = WD_LAYER_DEPTH | WD_LAYER_TREE_ID;
    struct wd_picture p = suite_render(suite, &params);
    const struct wd_camera *c = &params.camera;
    double per_px = 2.0 * tan(0.5 * c->fov_rad) / PICTURE_HEIGHT;
    size_t near = 0, trees = 0;
    assert_null(p.display);
    assert_null(p.color);
    for (size_t i = 0; i < PIXELS; i++) {
        struct wd_tree_info tree;
        if (!wd_forest_get_tree(suite->forest, p.tree_id[i], &tree))
            continue;
        double z = p.depth_m[i];
        double right = ((double)(i % PICTURE_WIDTH) + 0.5 - PICTURE_WIDTH / 2) * per_px * z;
        double up = (PICTURE_HEIGHT / 2 - (double)(i / PICTURE_WIDTH) - 0.5) * per_px * z;
        /* the camera looks north */
        double x = c->position_m[0] + right;
        double y = c->position_m[1] + z * cos(c->pitch_rad) - up * sin(c->pitch_rad);
        double height = c->position_m[2] + z * sin(c->pitch_rad) + up * cos(c->pitch_rad);
        double side = hypot(x - tree.position_m[0], y - tree.position_m[1]);
        height -= tree.position_m[2];
        trees++;
        near += side < 0.6 * tree.crown_diameter_m + 1.0 && height > -1.0 && height < 1.1 * tree.height_m + 1.0;
    }
    assert_true(near >= 0.98 * (double)trees);
    wd_picture_finish(&p);
}

static void the_same_picture_twice(void **state)
{
    struct suite *suite = *state;
    struct wd_picture a = render_layers(suite, "walk", WD_LAYER_ALL);
    struct wd_picture other = render_layers(suite, "over", 0); /* leaves no trace */
    struct wd_picture b = render_layers(suite, "walk", WD_LAYER_ALL);
    assert_memory_equal(a.display, b.display, PIXELS * 4);
    assert_memory_equal(a.color, b.color, PIXELS * 12);
    assert_memory_equal(a.depth_m, b.depth_m, PIXELS * 4);
    assert_memory_equal(a.normal, b.normal, PIXELS * 12);
    assert_memory_equal(a.albedo, b.albedo, PIXELS * 12);
    assert_memory_equal(a.tree_id, b.tree_id, PIXELS * 4);
    assert_memory_equal(a.velocity_px, b.velocity_px, PIXELS * 8);
    assert_true(memcmp(a.display, other.display, PIXELS * 4) != 0);
    wd_picture_finish(&a);
    wd_picture_finish(&b);
    wd_picture_finish(&other);
}

/* Rays of a view that is nearly half a turn high fall by many metres a metre along its axis. Where they meet nothing
 * there is no water either: no part of the picture is left as the one before was. */
static void the_widest_view_is_lit_all_over(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "over");
    params.camera = (struct wd_camera){{-400, 150, 60}, -1.5707963, 0, 3.1}; /* away from the ground */
    params.layers = WD_LAYER_COLOR;
    struct wd_picture shown[2];
    for (int i = 0; i < 2; i++) {
        struct wd_picture before = render_layers(suite, i ? "walk" : "over", WD_LAYER_COLOR);
        wd_picture_finish(&before);
        shown[i] = suite_render(suite, &params);
    }
    for (size_t i = 0; i < 3 * (size_t)PIXELS; i++) {
        assert_true(shown[0].color[i] > 0 && isfinite(shown[0].color[i]));
        assert_true(shown[0].color[i] == shown[1].color[i]);
    }
    wd_picture_finish(&shown[0]);
    wd_picture_finish(&shown[1]);
}

/* Trees stand where they stand whatever draws them: as much of the picture is covered by them as
 * octree covers, by the same trees. */
static void methods_agree(void **state)
{
    struct suite *suite = *state;
    const char *const cameras[] = {"over", "walk"};
    for (int c = 0; c < 2; c++) {
        struct wd_render_params params = suite_params(suite->forest, cameras[c]);
        params.layers = WD_LAYER_TREE_ID;
        params.method = "octree";
        struct wd_picture octree = suite_render(suite, &params);
        for (const char *const *name = wd_method_names(); *name; name++) {
            params.method = *name;
            struct wd_picture own = suite_render(suite, &params);
            size_t same = 0, trees = 0, own_trees = 0;
            for (size_t i = 0; i < PIXELS; i++) {
                same += octree.tree_id[i] == own.tree_id[i];
                trees += octree.tree_id[i] != 0;
                own_trees += own.tree_id[i] != 0;
            }
            print_message("%s, %s: %zu of %d pixels show the same tree, %zu a tree, octree %zu\n",
                          *name, cameras[c], same, PIXELS, own_trees, trees);
            /* others choose among the meshes and cards, or draw other shapes */
            bool exact = !strcmp(*name, "octree") || !strcmp(*name, "separate") || !strcmp(*name, "grid");
            assert_true(same >= PIXELS * (exact ? 99u : 72u) / 100);
            size_t off = trees * (exact ? 5 : 8) / 100; /* continuum from within: 6 */
            assert_in_range(own_trees, trees - off, trees + off);
            wd_picture_finish(&own);
        }
        wd_picture_finish(&octree);
    }
}

/* How many spruces show that stand farther off than that. */
static size_t spruces_beyond(struct suite *suite, struct wd_render_params *params, double least_m)
{
    struct wd_picture p = suite_render(suite, params);
    size_t count = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        struct wd_tree_info tree;
        if (p.tree_id[i] == 0 || !wd_forest_get_tree(suite->forest, p.tree_id[i], &tree))
            continue;
        double squared = 0;
        for (int k = 0; k < 3; k++)
            squared += pow(tree.position_m[k] - params->camera.position_m[k], 2);
        count += tree.species == 1 && sqrt(squared) > least_m;
    }
    wd_picture_finish(&p);
    return count;
}

/* A layer goes by its own distances, whichever method draws it. */
static void layers_fade_with_distance(void **state)
{
    struct suite *suite = *state;
    const char *const methods[] = {"octree", "continuum"};
    assert_true(suite_write_variant(suite, "fades.json", "\"name\": \"spruces\",",
                                    "\"name\": \"spruces\", \"fade_far_m\": [120, 140],"));
    struct wd_forest *fading = suite_forest(suite, suite_path(suite, "fades.json"));
    assert_non_null(fading);
    for (int m = 0; m < 2; m++) {
        struct wd_render_params params = suite_params(suite->forest, "over");
        params.layers = WD_LAYER_TREE_ID;
        params.method = methods[m];
        size_t whole = spruces_beyond(suite, &params, 141);
        assert_int_equal(wd_renderer_set_forest(suite->renderer, fading), WD_OK);
        size_t far = spruces_beyond(suite, &params, 141), all = spruces_beyond(suite, &params, 0);
        assert_int_equal(wd_renderer_set_forest(suite->renderer, suite->forest), WD_OK);
        print_message("%s: %zu pixels of spruces beyond 141 m, %zu where they fade, %zu nearer\n",
                      methods[m], whole, far, all);
        assert_true(whole > 500 && all > 100);
        assert_int_equal(far, 0);
    }
    wd_forest_destroy(&fading);
}

static void wd_method_names_are_known(void **state)
{
    (void)state;
    const char *const *names = wd_method_names();
    struct wd_method_info info;
    struct wd_method_option option;
    assert_string_equal(names[0], "octree");
    for (uint32_t i = 0; names[i]; i++) {
        assert_true(wd_method_get_info(i, &info));
        assert_string_equal(info.name, names[i]);
        assert_true(info.rows && info.summary);
        for (uint32_t k = 0; wd_method_get_option(i, k, &option); k++)
            assert_true(option.row && option.fallback && option.allowed[0] && option.summary);
        assert_false(wd_method_get_info(i + 1, &info) && !names[i + 1]);
    }
    assert_true(wd_method_get_option(0, 0, &option) && !wd_method_get_option(0, 99, &option));
    assert_false(wd_method_get_option(99, 0, &option));
}

/* --- velocity ---------------------------------------------------------------------------- */

static void nothing_moves_in_a_still_world(void **state)
{
    struct suite *suite = *state;
    struct wd_picture p = render_layers(suite, "walk", WD_LAYER_VELOCITY);
    for (size_t i = 0; i < PIXELS * 2; i++)
        assert_true(fabsf(p.velocity_px[i]) < 1e-3f);
    wd_picture_finish(&p);
}

/* A camera that turned right by `turn` sees the middle of its picture move left by turn * f. */
static void surfaces_move_against_the_camera(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "walk");
    struct wd_camera previous = params.camera;
    const double turn = 0.02;
    double focal_px = 0.5 * PICTURE_HEIGHT / tan(0.5 * params.camera.fov_rad);
    params.previous_camera = &previous;
    params.layers = WD_LAYER_VELOCITY;
    previous.yaw_rad -= turn;
    struct wd_picture p = suite_render(suite, &params);
    assert_true(fabs(p.velocity_px[2 * MIDDLE] + turn * focal_px) < 0.1);
    assert_true(fabs(p.velocity_px[2 * MIDDLE + 1]) < 0.1);
    wd_picture_finish(&p);
    previous = params.camera;
    previous.pitch_rad -= turn; /* looked up since: all goes down */
    p = suite_render(suite, &params);
    assert_true(fabs(p.velocity_px[2 * MIDDLE + 1] - turn * focal_px) < 0.1);
    wd_picture_finish(&p);
}

static void wind_moves_trees_and_nothing_else(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "walk");
    params.layers = WD_LAYER_VELOCITY | WD_LAYER_TREE_ID;
    params.time_s = 1.5;
    params.previous_time_s = 1.0;
    struct wd_picture p = suite_render(suite, &params);
    size_t moved = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        float speed = hypotf(p.velocity_px[2 * i], p.velocity_px[2 * i + 1]);
        assert_true(p.tree_id[i] || speed < 1e-3f);
        moved += p.tree_id[i] && speed > 0.01f;
    }
    assert_true(moved > PIXELS / 100);
    wd_picture_finish(&p);
}

/* --- files ------------------------------------------------------------------------------- */

static void exr_files_keep_ids_and_depths(void **state)
{
    struct suite *suite = *state;
    struct wd_picture p = render_layers(suite, "over", WD_LAYER_ALL);
    const char *path = suite_path(suite, "layers.exr");
    struct wd_exr_image image;
    p.tree_id[0] = 0xfedcba98u; /* a float would lose the last digits */
    assert_int_equal(wd_picture_write(&p, path, &suite->log), WD_OK);
    assert_true(wd_exr_read(&image, path, &suite->log));
    assert_true(image.width == PICTURE_WIDTH && image.height == PICTURE_HEIGHT);
    assert_int_equal(image.plane_count, 14);
    const struct wd_exr_plane *id = wd_exr_find(&image, "tree_id");
    const struct wd_exr_plane *depth = wd_exr_find(&image, "Z");
    const struct wd_exr_plane *species = wd_exr_find(&image, "species");
    assert_true(id && depth && species && id->type == WD_EXR_UINT);
    assert_memory_equal(id->data, p.tree_id, PIXELS * 4);
    assert_memory_equal(depth->data, p.depth_m, PIXELS * 4);
    assert_memory_equal(species->data, p.species, PIXELS * 4);
    wd_exr_image_finish(&image);
    wd_picture_finish(&p);
}

/* Ranks are what one-sample pictures of the same samples would count. */
static void ranks_are_the_samples_trees(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "over");
    params.samples = 8;
    params.layers = WD_LAYER_CRYPTOMATTE | WD_LAYER_TREE_ID;
    struct wd_picture p = suite_render(suite, &params);
    size_t parted = 0, whole = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const uint32_t *tree = &p.rank_tree[i * WD_RANKS];
        const float *share = &p.rank_share[i * WD_RANKS];
        float sum = 0.0f;
        bool found = p.tree_id[i] == 0; /* of the last sample, which counts as one */
        for (int k = 0; k < WD_RANKS; k++) {
            assert_true((tree[k] != 0) == (share[k] > 0.0f));
            assert_true(k == 0 || share[k] <= share[k - 1]);
            assert_true(share[k] * 8.0f == floorf(share[k] * 8.0f));
            for (int j = 0; j < k; j++)
                assert_true(tree[k] == 0 || tree[j] != tree[k]);
            found = found || tree[k] == p.tree_id[i] || tree[WD_RANKS - 1] != 0;
            sum += share[k];
        }
        assert_true(found && sum <= 1.0f);
        assert_true(sum > 0.0f || p.tree_id[i] == 0);
        parted += sum > 0.0f && sum < 1.0f;
        whole += sum == 1.0f;
    }
    assert_true(parted > PIXELS / 100 && whole > PIXELS / 20);
    wd_picture_finish(&p);
}

static void cryptomatte_files_say_what_they_hold(void **state)
{
    struct suite *suite = *state;
    struct wd_render_params params = suite_params(suite->forest, "over");
    params.samples = 4;
    params.layers = WD_LAYER_CRYPTOMATTE;
    struct wd_picture p = suite_render(suite, &params);
    const char *path = suite_path(suite, "matte.exr");
    struct wd_exr_image image;
    assert_int_equal(wd_picture_write(&p, path, &suite->log), WD_OK);
    assert_true(wd_exr_read(&image, path, &suite->log));
    assert_int_equal(image.plane_count, 2 * WD_RANKS);
    const float *id = wd_exr_find(&image, "weald_tree00.R")->data;
    const float *share = wd_exr_find(&image, "weald_tree00.G")->data;
    for (size_t i = 0; i < PIXELS; i++) {
        assert_true(share[i] == p.rank_share[i * WD_RANKS]);
        assert_true((id[i] != 0.0f) == (p.rank_tree[i * WD_RANKS] != 0));
    }
    wd_exr_image_finish(&image);
    wd_picture_finish(&p);
}

static void pictures_need_a_known_ending(void **state)
{
    struct suite *suite = *state;
    uint8_t pixel[4] = {1, 2, 3, 255};
    const struct wd_picture shown = {.width = 1, .height = 1, .display = pixel};
    suite_clear(suite);
    assert_int_equal(wd_picture_write(&shown, suite_path(suite, "a.jpg"), &suite->log),
                     WD_ERROR_INPUT);
    assert_true(suite_logged(suite, "a.jpg"));
    suite_clear(suite);
    assert_int_equal(wd_picture_write(&shown, suite_path(suite, "no/a.png"), &suite->log),
                     WD_ERROR_OUTPUT);
    assert_true(suite_logged(suite, "no/a.png"));
    assert_int_equal(wd_picture_write(&shown, suite_path(suite, "a.exr"), &suite->log),
                     WD_ERROR_INPUT);
}

/* --- precision --------------------------------------------------------------------------- */

/* One tree at x, y, seen from 14 m. */
static struct wd_picture render_lone_tree(struct suite *suite, const char *frame, double x, double y)
{
    char text[2048];
    snprintf(text, sizeof text, "x,y,species,height\n%.2f,%.2f,beech,12\n", x, y);
    assert_true(suite_write(suite, "one.csv", text));
    snprintf(text, sizeof text,
             "{\"name\": \"one\", \"terrain\": {\"kind\": \"flat\", \"size_m\": [0, 0]},"
             "\"species\": {\"beech\": \"%s/species/beech.json\"}, \"variants\": 1,"
             "\"inventories\": [{\"file\": \"one.csv\", \"frame\": \"%s\","
             "\"species\": {\"beech\": \"beech\"}}],"
             "\"quality\": {\"shadow_size\": 512}}",
             suite->root, frame);
    assert_true(suite_write(suite, "one.json", text));
    struct wd_forest *forest = suite_forest(suite, suite_path(suite, "one.json"));
    assert_non_null(forest);
    struct wd_forest_info info;
    struct wd_tree_info tree;
    wd_forest_get_info(forest, &info);
    assert_int_equal(info.tree_count, 1);
    assert_true(wd_forest_get_tree(forest, 1, &tree));
    assert_true(fabs(tree.position_m[0] + info.origin_m[0] - x) < 1e-3);
    assert_true(fabs(tree.position_m[1] + info.origin_m[1] - y) < 1e-3);
    struct wd_render_params params = {
        .camera = {{tree.position_m[0] - 4.0, tree.position_m[1] - 13.0, 3.0}, 0.3, 0.15, 1.0},
        .width = PICTURE_WIDTH, .height = PICTURE_HEIGHT, .layers = WD_LAYER_ALL};
    assert_int_equal(wd_renderer_set_forest(suite->renderer, forest), WD_OK);
    struct wd_picture picture = suite_render(suite, &params);
    assert_int_equal(wd_renderer_set_forest(suite->renderer, suite->forest), WD_OK);
    wd_forest_destroy(&forest);
    return picture;
}

/* The ground starts at whole tens of metres, so whole tens between the two change nothing. */
static void far_coordinates_lose_nothing(void **state)
{
    struct suite *suite = *state;
    struct wd_picture here = render_lone_tree(suite, "local", 50.25, 51.5);
    struct wd_picture far = render_lone_tree(suite, "projected", 3512340.25, 6345671.5);
    size_t trees = 0, same_id = 0, same_display = 0;
    double depth_off_m = 0.0;
    for (size_t i = 0; i < PIXELS; i++) {
        trees += here.tree_id[i] != 0;
        same_id += here.tree_id[i] == far.tree_id[i];
        if (here.tree_id[i] && far.tree_id[i])
            depth_off_m = fmax(depth_off_m, fabs((double)here.depth_m[i] - far.depth_m[i]));
        int most = 0;
        for (size_t k = 4 * i; k < 4 * i + 3; k++)
            most = abs(here.display[k] - far.display[k]) > most
                       ? abs(here.display[k] - far.display[k]) : most;
        same_display += most <= 1;
    }
    assert_true(trees > PIXELS / 40);
    assert_true(same_id == PIXELS && depth_off_m < 1e-4);
    assert_true(same_display == PIXELS);
    wd_picture_finish(&here);
    wd_picture_finish(&far);
}

int main(int argc, char **argv)
{
    static struct suite suite;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(trees_on_demand_need_continuum, &suite),
        cmocka_unit_test_prestate(without_a_forest_nothing_is_drawn, &suite),
        cmocka_unit_test_prestate(impossible_pictures_are_refused, &suite),
        cmocka_unit_test_prestate(a_wish_to_stop_stops, &suite),
        cmocka_unit_test_prestate(every_layer_holds_what_it_says, &suite),
        cmocka_unit_test_prestate(depths_lead_to_the_trees, &suite),
        cmocka_unit_test_prestate(the_same_picture_twice, &suite),
        cmocka_unit_test_prestate(the_widest_view_is_lit_all_over, &suite),
        cmocka_unit_test_prestate(methods_agree, &suite),
        cmocka_unit_test_prestate(layers_fade_with_distance, &suite),
        cmocka_unit_test_prestate(wd_method_names_are_known, &suite),
        cmocka_unit_test_prestate(nothing_moves_in_a_still_world, &suite),
        cmocka_unit_test_prestate(surfaces_move_against_the_camera, &suite),
        cmocka_unit_test_prestate(wind_moves_trees_and_nothing_else, &suite),
        cmocka_unit_test_prestate(exr_files_keep_ids_and_depths, &suite),
        cmocka_unit_test_prestate(ranks_are_the_samples_trees, &suite),
        cmocka_unit_test_prestate(cryptomatte_files_say_what_they_hold, &suite),
        cmocka_unit_test_prestate(pictures_need_a_known_ending, &suite),
        cmocka_unit_test_prestate(far_coordinates_lose_nothing, &suite),
    };
    if (argc != 2) {
        fprintf(stderr, "usage: %s ROOT\n", argv[0]);
        return 2;
    }
    int failed = 1;
    if (suite_init(&suite, argv[1]))
        failed = cmocka_run_group_tests(tests, NULL, NULL) + forest_tests(&suite) + argument_tests(&suite) +
                 film_tests(&suite) + memory_tests(&suite);
    suite_finish(&suite);
    return failed;
}
