/* Trees drawn by their pictures against the same trees drawn as meshes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/memory.h"
#include "frame_test.h"
#include "shared/canopy_map.h"

enum { OVER };

static const char *root;

/* Every tree a reduced mesh in `octree`, every tree a picture in `views` and `zfield`. */
static int open_test(void **state)
{
    struct frame_test *test = *state = wd_alloc(sizeof *test);
    frame_test_init(test, root, &(struct frame_test_params){0});
    struct wd_method_options *methods = &test->scene.methods;
    test->scene.quality.mesh_distance_m = 0.0;
    test->scene.quality.reduced_distance_m = 1e5;
    test->scene.quality.shadow_taps = 0; /* takes time and changes no surface */
    methods->views.near_m = methods->zfield.near_m = 0.0;
    methods->views.layout = WD_VIEWS_EVEN;
    methods->views.rows = methods->zfield.rows = 5;
    methods->views.size = methods->zfield.size = 64;
    methods->views.variants = methods->zfield.variants = 0;
    methods->zfield.range_m = 0.0;
    return 0;
}

static int close_test(void **state)
{
    frame_test_finish(*state);
    free(*state);
    return frame_tests_finish(state);
}

struct comparison {
    double covered, reference_covered; /* share of pixels with trees */
    double same_tree;                  /* of pixels with trees in both */
    double depth_error_m;              /* mean, where the same tree shows */
    double brightness, reference_brightness; /* mean green of trees */
};

/* Along the view axis. */
static double distance_m(const struct frame_test *test, float depth)
{
    return (double)test->frame.near_m / fmax((double)depth, 1e-9);
}

static struct comparison compare(const struct frame_picture *picture,
                                 const struct frame_picture *reference,
                                 const struct frame_test *test)
{
    struct comparison sum = {0};
    size_t pixels = (size_t)picture->width * picture->height, both = 0, same = 0, trees = 0;
    size_t reference_trees = 0;
    for (size_t i = 0; i < pixels; i++) {
        bool here = picture->surface[i] != 0, there = reference->surface[i] != 0;
        trees += here;
        reference_trees += there;
        both += here && there;
        sum.brightness += here ? (picture->albedo[i] >> 8 & 0xff) / 255.0 : 0.0;
        sum.reference_brightness += there ? (reference->albedo[i] >> 8 & 0xff) / 255.0 : 0.0;
        if (here && picture->surface[i] == reference->surface[i]) {
            same++;
            sum.depth_error_m +=
                fabs(distance_m(test, picture->depth[i]) - distance_m(test, reference->depth[i]));
        }
    }
    sum.covered = (double)trees / (double)pixels;
    sum.reference_covered = (double)reference_trees / (double)pixels;
    sum.same_tree = (double)same / fmax((double)both, 1.0);
    sum.depth_error_m /= fmax((double)same, 1.0);
    sum.brightness /= fmax((double)trees, 1.0);
    sum.reference_brightness /= fmax((double)reference_trees, 1.0);
    return sum;
}

static struct comparison compare_methods(struct frame_test *test, const char *method)
{
    struct frame_picture picture, reference;
    frame_test_draw(test, "octree", OVER, &reference);
    frame_test_draw(test, method, OVER, &picture);
    struct comparison result = compare(&picture, &reference, test);
    frame_picture_finish(&picture);
    frame_picture_finish(&reference);
    print_message("%s: %.1f%% covered, meshes %.1f%%; %.0f%% the same tree, %.2f m off; "
                  "brightness %.3f, meshes %.3f\n",
                  method, 100 * result.covered, 100 * result.reference_covered,
                  100 * result.same_tree, result.depth_error_m, result.brightness,
                  result.reference_brightness);
    return result;
}

static void pictures_look_like_meshes(void **state)
{
    struct frame_test *test = *state;
    static const char *const methods[] = {"views", "zfield"};
    struct comparison found[2];
    for (int i = 0; i < 2; i++) {
        found[i] = compare_methods(test, methods[i]);
        assert_float_equal(found[i].covered / found[i].reference_covered, 1.0, 0.1);
        assert_float_equal(found[i].brightness / found[i].reference_brightness, 1.0, 0.12);
        assert_true(found[i].same_tree > 0.5);
    }
    /* a quad's depth is the trunk's; a z-field's is the leaf's */
    assert_true(found[1].depth_error_m < 0.7 * found[0].depth_error_m);
}

static void more_refinement_is_no_worse(void **state)
{
    struct frame_test *test = *state;
    test->scene.methods.zfield.refine = 0;
    struct comparison none = compare_methods(test, "zfield");
    test->scene.methods.zfield.refine = 2;
    struct comparison two = compare_methods(test, "zfield");
    assert_true(two.depth_error_m < 1.02 * none.depth_error_m);
    test->scene.methods.zfield.refine = 1;
}

/* Far ground shows trees that stand there, about as much as there are. */
static void the_canopy_map_stands_for_far_trees(void **state)
{
    const double range_m = 130.0;
    struct frame_test *test = *state;
    struct frame_picture near, map;
    frame_test_draw(test, "zfield", OVER, &near);
    test->scene.methods.zfield.range_m = range_m;
    frame_test_draw(test, "zfield", OVER, &map);
    size_t trees = 0, mapped = 0;
    for (size_t i = 0; i < (size_t)map.width * map.height; i++) {
        if (distance_m(test, map.depth[i]) < range_m * 1.1 || map.depth[i] <= 0.0f)
            continue;
        mapped += map.surface[i] != 0;
        trees += near.surface[i] != 0;
        assert_true(map.surface[i] <= test->world.tree_count);
    }
    print_message("%zu pixels of the map, %zu of trees\n", mapped, trees);
    assert_true(trees > 500);
    assert_float_equal((double)mapped / (double)trees, 1.0, 0.3);
    test->scene.methods.zfield.canopy_map = false;
    struct frame_picture bare;
    frame_test_draw(test, "zfield", OVER, &bare);
    for (size_t i = 0; i < (size_t)bare.width * bare.height; i++)
        if (bare.depth[i] > 0.0f && distance_m(test, bare.depth[i]) > range_m * 1.3)
            assert_int_equal(bare.surface[i], 0);
    frame_picture_finish(&near);
    frame_picture_finish(&map);
    frame_picture_finish(&bare);
    test->scene.methods.zfield.range_m = 0.0;
    test->scene.methods.zfield.canopy_map = true;
}

static void canopies_hide_more_from_the_side(void **state)
{
    (void)state;
    assert_float_equal(wd_canopy_hides(0.4f, 2.0f, 1.0f), 0.4, 1e-5);
    assert_true(wd_canopy_hides(0.0f, 2.0f, 0.1f) == 0.0f);
    float before = 0.0f;
    for (float cosine = 1.0f; cosine > 0.06f; cosine -= 0.05f) {
        float hides = wd_canopy_hides(0.3f, 2.0f, cosine);
        assert_true(hides > before && hides < 1.0f);
        before = hides;
    }
    for (float d = 0.0f; d < 2000.0f; d += 10.0f) {
        float trees = wd_canopy_trees(1000.0f, 0.3f, d), map = wd_canopy_shows(1000.0f, 0.3f, d);
        assert_true(trees >= 0.0f && trees <= 1.0f && map >= 0.0f && map <= 1.0f);
        assert_true(trees == 1.0f || map == 1.0f); /* nothing shines through */
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(canopies_hide_more_from_the_side),
        cmocka_unit_test(pictures_look_like_meshes),
        cmocka_unit_test(more_refinement_is_no_worse),
        cmocka_unit_test(the_canopy_map_stands_for_far_trees),
    };
    if (argc != 2)
        return 2;
    root = argv[1];
    return cmocka_run_group_tests(tests, open_test, close_test);
}
