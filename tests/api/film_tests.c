/* Films through the public interface: what they refuse, and what a failure leaves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "parts.h"

enum { SIDE = 32 };

struct pixels {
    uint8_t display[4 * SIDE * SIDE];
    float depth_m[SIDE * SIDE];
};

static struct wd_picture picture_of(struct pixels *pixels, uint32_t side)
{
    return (struct wd_picture){
        .width = side, .height = side, .display = pixels->display, .depth_m = pixels->depth_m};
}

static struct wd_film *open_film(struct suite *suite, const char *name)
{
    const struct wd_film_params params = {
        .path = suite_path(suite, name), .width = SIDE, .height = SIDE, .frames_per_second = 25};
    struct wd_film *film;
    suite_clear(suite);
    assert_int_equal(wd_film_open(&film, &params, &suite->log), WD_OK);
    return film;
}

/* A picture of another size is no frame; the film goes on without it. */
static void frames_have_the_films_size(void **state)
{
    static struct pixels pixels;
    struct suite *suite = *state;
    const char *const names[] = {"size-%d.png", "size-%d.exr"};
    const struct wd_picture right = picture_of(&pixels, SIDE);
    struct wd_picture wrong[] = {picture_of(&pixels, SIDE / 2), right, right};
    wrong[1].width = SIDE / 2;
    wrong[2].height = SIDE + 1;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct wd_film *film = open_film(suite, names[i]);
        for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
            suite_clear(suite);
            assert_int_equal(wd_film_add(film, &wrong[k]), WD_ERROR_INPUT);
            assert_true(suite_logged(suite, names[i]) && suite_logged(suite, "the film's have 32 x 32"));
        }
        assert_int_equal(wd_film_add(film, NULL), WD_ERROR_INPUT);
        assert_int_equal(wd_film_add(film, &right), WD_OK);
        assert_int_equal(wd_film_commit(&film), WD_OK);
    }
    assert_int_equal(access(suite_path(suite, "size-0.png"), F_OK), 0);
    assert_int_not_equal(access(suite_path(suite, "size-1.exr"), F_OK), 0);
}

/* The folder goes: the frame fails, and so does all that comes after it, by name. */
static void films_end_with_a_failed_frame(void **state)
{
    static struct pixels pixels;
    struct suite *suite = *state;
    const char *const names[] = {"gone/x-%d.png", "gone/x-%d.exr"};
    const struct wd_picture picture = picture_of(&pixels, SIDE);
    char *folder = strdup(suite_path(suite, "gone"));
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_int_equal(mkdir(folder, 0777), 0);
        struct wd_film *film = open_film(suite, names[i]);
        assert_int_equal(rmdir(folder), 0);
        assert_int_equal(wd_film_add(film, &picture), WD_ERROR_OUTPUT);
        assert_int_equal(mkdir(folder, 0777), 0);
        suite_clear(suite);
        assert_int_equal(wd_film_add(film, &picture), WD_ERROR_OUTPUT);
        assert_true(suite_logged(suite, names[i]));
        assert_true(suite_logged(suite, "frame 0 could not be written: the film cannot go on"));
        suite_clear(suite);
        assert_int_equal(wd_film_commit(&film), WD_ERROR_OUTPUT);
        assert_true(suite_logged(suite, names[i]));
        assert_null(film);
        assert_int_equal(rmdir(folder), 0); /* and it is empty */
    }
    free(folder);
}

/* What is wrong with the call is told from what is wrong with the disk. */
static void wrong_films_are_input(void **state)
{
    struct suite *suite = *state;
    static const struct {
        const char *name;
        uint32_t width;
        double rate;
        enum wd_result result;
        const char *message;
    } cases[] = {
        {"odd.mp4", 33, 24, WD_ERROR_INPUT, "must be even"},
        {"nan-%d.png", 32, NAN, WD_ERROR_INPUT, "found nan frames a second; allowed are 0.01 to 1000"},
        {"slow-%d.exr", 32, 0.009, WD_ERROR_INPUT, "allowed are 0.01 to 1000"},
        {"fast.mp4", 32, 1001, WD_ERROR_INPUT, "allowed are 0.01 to 1000"},
        {"s-%s.png", 32, 24, WD_ERROR_INPUT, "not a name for a sequence"},
        {"s-%s.exr", 32, 24, WD_ERROR_INPUT, "not a name for a sequence"},
        {"two-%d-%d.png", 32, 24, WD_ERROR_INPUT, "not a name for a sequence"},
        {"jpg-%d.jpg", 32, 24, WD_ERROR_INPUT, ".png or .exr files"},
        {"none-%d.exr", 0, 24, WD_ERROR_INPUT, "found 0 x 32 pixels"},
        {"no.gif", 32, 24, WD_ERROR_INPUT, "films end in"},
        {"nowhere/a.mp4", 32, 24, WD_ERROR_OUTPUT, "No such file"},
        {"least-%d.PNG", 32, 0.01, WD_OK, ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct wd_film_params params = {suite_path(suite, cases[i].name), cases[i].width, 32,
                                              cases[i].rate};
        struct wd_film *film;
        suite_clear(suite);
        assert_int_equal(wd_film_open(&film, &params, &suite->log), cases[i].result);
        assert_true(suite_logged(suite, cases[i].message));
        assert_true((film != NULL) == (cases[i].result == WD_OK));
        wd_film_discard(&film);
    }
}

/* Frames are kept from the first on or not at all, and what is no film is no crash. */
static void films_are_kept_once_and_from_the_first_frame(void **state)
{
    static struct pixels pixels;
    struct suite *suite = *state;
    const struct wd_picture picture = picture_of(&pixels, SIDE);
    struct wd_film *film = open_film(suite, "keep-%d.png");
    assert_int_equal(wd_film_keep(film, 1, 5), WD_OK);
    assert_int_equal(wd_film_keep(film, 1, 5), WD_ERROR_INPUT);
    assert_true(suite_logged(suite, "keep-%d.png: wd_film_keep is to be called once, before the first frame"));
    wd_film_discard(&film);
    film = open_film(suite, "keep-%d.png");
    assert_int_equal(wd_film_add(film, &picture), WD_OK);
    assert_int_equal(wd_film_keep(film, 1, 5), WD_ERROR_INPUT);
    assert_int_equal(wd_film_commit(&film), WD_OK);
    assert_int_not_equal(access(suite_path(suite, "keep-%d.png.partial"), F_OK), 0);
    assert_int_equal(wd_film_commit(&film), WD_ERROR_INPUT);
    assert_int_equal(wd_film_commit(NULL), WD_ERROR_INPUT);
}

int film_tests(struct suite *suite)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(frames_have_the_films_size, suite),
        cmocka_unit_test_prestate(films_end_with_a_failed_frame, suite),
        cmocka_unit_test_prestate(wrong_films_are_input, suite),
        cmocka_unit_test_prestate(films_are_kept_once_and_from_the_first_frame, suite),
    };
    return cmocka_run_group_tests_name("films", tests, NULL, NULL);
}
