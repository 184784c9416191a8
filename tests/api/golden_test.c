/* Pictures of small.json against those that were looked at and found right.
 *   test-golden ROOT                 compares
 *   test-golden ROOT --update OUT    replaces the pictures in ROOT/tests/api/golden and leaves
 *                                    NAME-old.png, NAME-new.png and NAME-difference.png in OUT:
 *   ninja -C BUILD && BUILD/tests/api/test-golden . --update OUT
 * Look at all three before committing the new ones. */
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "../output/image_compare.h"

enum { PIXELS = PICTURE_WIDTH * PICTURE_HEIGHT, SAMPLES = 4, DIFFERENCE_GAIN = 4 };

/* Blocks of 16 x 16 pixels average out how single leaves fall; what remains is light and colour. */
static const double MAX_BLOCK_RMSE = 0.02, MAX_BRIGHTNESS_CHANGE = 0.06;

struct golden {
    const char *name, *camera;
    enum wd_view_mode view;
};
static const struct golden GOLDENS[] = {
    {"over", "over", WD_VIEW_LIT},
    {"walk", "walk", WD_VIEW_LIT},
    {"lod", "over", WD_VIEW_LOD},
};
enum { GOLDEN_COUNT = sizeof GOLDENS / sizeof *GOLDENS };

/* The display of the forest on the renderer, 3 bytes a pixel; free() it. */
static uint8_t *draw(struct suite *suite, const struct golden *golden)
{
    struct wd_render_params params = suite_params(suite->forest, golden->camera);
    struct wd_picture picture;
    params.samples = SAMPLES;
    params.view = golden->view;
    params.method = "octree";
    if (wd_renderer_render(suite->renderer, &params, &picture) != WD_OK) {
        fprintf(stderr, "%s: no picture:\n%s", golden->name, suite->messages);
        return NULL;
    }
    uint8_t *rgb = malloc(PIXELS * 3);
    for (size_t i = 0; rgb && i < PIXELS; i++)
        memcpy(rgb + 3 * i, picture.display + 4 * i, 3);
    wd_picture_finish(&picture);
    return rgb;
}

static void golden_path(const struct suite *suite, const struct golden *golden, char path[1280])
{
    snprintf(path, 1280, "%s/tests/api/golden/%s.png", suite->root, golden->name);
}

static bool within_bounds(const uint8_t *golden, const uint8_t *drawn, const char *name)
{
    struct wd_image_difference d = wd_image_compare(golden, drawn, PICTURE_WIDTH, PICTURE_HEIGHT);
    print_message("%s: blocks differ by %.5f, brightness by a factor of %.4f\n", name,
                  d.block_rmse_linear, d.brightness_ratio);
    return d.block_rmse_linear < MAX_BLOCK_RMSE &&
           d.brightness_ratio > 1.0 - MAX_BRIGHTNESS_CHANGE &&
           d.brightness_ratio < 1.0 + MAX_BRIGHTNESS_CHANGE;
}

static struct wd_image8 load(const struct suite *suite, const struct golden *golden)
{
    struct wd_image8 image;
    char path[1280];
    golden_path(suite, golden, path);
    assert_true(wd_png_read(&image, path, &suite->log));
    assert_true(image.width == PICTURE_WIDTH && image.height == PICTURE_HEIGHT);
    return image;
}

static void pictures_look_as_they_did(void **state)
{
    struct suite *suite = *state;
    bool ok = true;
    for (int i = 0; i < GOLDEN_COUNT; i++) {
        struct wd_image8 golden = load(suite, &GOLDENS[i]);
        uint8_t *drawn = draw(suite, &GOLDENS[i]);
        assert_non_null(drawn);
        ok &= within_bounds(golden.pixels, drawn, GOLDENS[i].name);
        free(drawn);
        wd_image8_finish(&golden);
    }
    assert_true(ok);
}

/* --- the bounds are worth something ------------------------------------------------------ */

static void another_view_is_noticed(void **state)
{
    struct suite *suite = *state;
    struct wd_image8 over = load(suite, &GOLDENS[0]), lod = load(suite, &GOLDENS[2]);
    assert_false(within_bounds(over.pixels, lod.pixels, "lit against lod"));
    wd_image8_finish(&over);
    wd_image8_finish(&lod);
}

static void a_wrong_colour_is_noticed(void **state)
{
    struct suite *suite = *state;
    struct wd_image8 walk = load(suite, &GOLDENS[1]);
    uint8_t *wrong = malloc(PIXELS * 3);
    assert_non_null(wrong);
    for (size_t i = 0; i < PIXELS; i++) { /* red and green exchanged */
        const uint8_t *from = walk.pixels + 3 * i;
        memcpy(wrong + 3 * i, (uint8_t[]){from[1], from[0], from[2]}, 3);
    }
    assert_false(within_bounds(walk.pixels, wrong, "red for green"));
    free(wrong);
    wd_image8_finish(&walk);
}

/* Draws a changed scene; the lit pictures must be seen to differ. */
static void assert_change_is_noticed(struct suite *suite, const char *from, const char *to)
{
    struct wd_forest *own = suite->forest;
    assert_true(suite_write_variant(suite, "variant.json", from, to));
    suite->forest = suite_forest(suite, suite_path(suite, "variant.json"));
    assert_non_null(suite->forest);
    assert_int_equal(wd_renderer_set_forest(suite->renderer, suite->forest), WD_OK);
    bool noticed = false;
    for (int i = 0; i < 2; i++) {
        struct wd_image8 golden = load(suite, &GOLDENS[i]);
        uint8_t *drawn = draw(suite, &GOLDENS[i]);
        assert_non_null(drawn);
        noticed |= !within_bounds(golden.pixels, drawn, to);
        free(drawn);
        wd_image8_finish(&golden);
    }
    assert_int_equal(wd_renderer_set_forest(suite->renderer, own), WD_OK);
    wd_forest_destroy(&suite->forest);
    suite->forest = own;
    assert_true(noticed);
}

static void missing_shadows_are_noticed(void **state)
{
    assert_change_is_noticed(*state, "\"shadow_distance_m\": 400", "\"shadow_distance_m\": 1");
}

static void another_hour_is_noticed(void **state)
{
    assert_change_is_noticed(*state, "\"elevation_deg\": 40", "\"elevation_deg\": 20");
}

/* --- new pictures ------------------------------------------------------------------------ */

static bool write_beside(const char *folder, const struct golden *golden, const char *kind,
                         const uint8_t *rgb, const struct wd_log *log)
{
    char path[1280];
    snprintf(path, sizeof path, "%s/%s-%s.png", folder, golden->name, kind);
    return wd_png_write(path, rgb, PICTURE_WIDTH, PICTURE_HEIGHT, log);
}

/* Keeps the old picture, if there is one, and how the new one differs. */
static bool write_old(const struct suite *suite, const struct golden *golden, const uint8_t *drawn,
                      const char *folder)
{
    char path[1280];
    struct wd_image8 old;
    golden_path(suite, golden, path);
    if (!wd_file_exists(path))
        return true;
    if (!wd_png_read(&old, path, NULL))
        return false;
    uint8_t *difference = malloc(PIXELS * 3);
    bool ok = difference && old.width == PICTURE_WIDTH && old.height == PICTURE_HEIGHT;
    if (ok) {
        within_bounds(old.pixels, drawn, golden->name);
        wd_image_difference_picture(old.pixels, drawn, PICTURE_WIDTH, PICTURE_HEIGHT,
                                    DIFFERENCE_GAIN, difference);
        ok = write_beside(folder, golden, "old", old.pixels, NULL) &&
             write_beside(folder, golden, "difference", difference, NULL);
    }
    free(difference);
    wd_image8_finish(&old);
    return ok;
}

static int update(struct suite *suite, const char *folder)
{
    bool ok = wd_make_directories(folder, NULL);
    for (int i = 0; ok && i < GOLDEN_COUNT; i++) {
        char path[1280];
        golden_path(suite, &GOLDENS[i], path);
        uint8_t *drawn = draw(suite, &GOLDENS[i]);
        ok = drawn && write_old(suite, &GOLDENS[i], drawn, folder) &&
             write_beside(folder, &GOLDENS[i], "new", drawn, NULL) &&
             wd_png_write(path, drawn, PICTURE_WIDTH, PICTURE_HEIGHT, NULL);
        free(drawn);
    }
    return ok ? 0 : 1;
}

static bool start(struct suite *suite, const char *root)
{
    if (!suite_init(suite, root))
        return false;
    bool ok = wd_renderer_set_forest(suite->renderer, suite->forest) == WD_OK;
    if (!ok)
        fprintf(stderr, "the forest is not on the device:\n%s", suite->messages);
    return ok;
}

int main(int argc, char **argv)
{
    static struct suite suite;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(pictures_look_as_they_did, &suite),
        cmocka_unit_test_prestate(another_view_is_noticed, &suite),
        cmocka_unit_test_prestate(a_wrong_colour_is_noticed, &suite),
        cmocka_unit_test_prestate(missing_shadows_are_noticed, &suite),
        cmocka_unit_test_prestate(another_hour_is_noticed, &suite),
    };
    bool updating = argc == 4 && strcmp(argv[2], "--update") == 0;
    if (argc != 2 && !updating) {
        fprintf(stderr, "usage: %s ROOT [--update OUT]\n", argv[0]);
        return 2;
    }
    int failed = 1;
    if (start(&suite, argv[1]))
        failed = updating ? update(&suite, argv[3]) : cmocka_run_group_tests(tests, NULL, NULL);
    suite_finish(&suite);
    return failed;
}
