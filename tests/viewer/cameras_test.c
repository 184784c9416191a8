/* Saved cameras come back as they went; files that cannot be understood are left alone. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "viewer/cameras.h"

static void ignore(void *user, enum wd_log_level level, const char *message)
{
    (void)level;
    snprintf(user, 512, "%s", message);
}

static char message[512];
static const struct wd_log test_log = {ignore, message};

static int enter_scratch(void **state)
{
    static char directory[] = "/tmp/weald-cameras-XXXXXX";
    *state = mkdtemp(directory);
    return *state && chdir(*state) ? -1 : 0;
}

static int leave_scratch(void **state)
{
    unlink("scene.cameras.json");
    return chdir("/") || rmdir(*state);
}

static void names_are_not_given_twice(void **state)
{
    (void)state;
    struct viewer_cameras cameras;
    const struct wd_camera camera = {{1, 2, 3}, 0, 0, 1};
    FILE *file = fopen("scene.cameras.json", "w");
    assert_non_null(file);
    fputs("{\"cameras\": [{\"name\": \"saved-2\", \"position_m\": [7, 0, 0], \"yaw_deg\": 0, \"pitch_deg\": 0, "
          "\"fov_deg\": 50}]}", file);
    fclose(file);
    assert_true(viewer_cameras_init(&cameras, "./scene.json", &test_log));
    assert_true(viewer_cameras_save(&cameras, &camera));
    assert_string_equal(cameras.saved[1].name, "saved-3");
    assert_float_equal(viewer_cameras_find(&cameras, "saved-2")->camera.position_m[0], 7, 0);
    assert_null(viewer_cameras_find(&cameras, "saved-1"));
    viewer_cameras_finish(&cameras);
    unlink("scene.cameras.json");
}

static void come_back_exactly(void **state)
{
    (void)state;
    struct viewer_cameras cameras;
    const struct wd_camera camera = {{12.5, 5764321.0625, -3}, 1.25, -0.5, 0.875};
    assert_true(viewer_cameras_init(&cameras, "./scene.json", &test_log));
    assert_int_equal(cameras.count, 0);
    assert_true(viewer_cameras_save(&cameras, &camera));
    assert_true(viewer_cameras_save(&cameras, &camera));
    viewer_cameras_finish(&cameras);

    assert_true(viewer_cameras_init(&cameras, "./scene.json", &test_log));
    assert_int_equal(cameras.count, 2);
    assert_string_equal(cameras.saved[0].name, "saved-1");
    assert_string_equal(cameras.saved[1].name, "saved-2");
    const struct wd_camera *back = &cameras.saved[1].camera;
    for (int i = 0; i < 3; i++)
        assert_float_equal(back->position_m[i], camera.position_m[i], 1e-4);
    assert_float_equal(back->yaw_rad, camera.yaw_rad, 1e-9);
    assert_float_equal(back->pitch_rad, camera.pitch_rad, 1e-9);
    assert_float_equal(back->fov_rad, camera.fov_rad, 1e-9);
    viewer_cameras_finish(&cameras);
}

static void refuse(const char *text, const char *expected)
{
    struct viewer_cameras cameras;
    FILE *file = fopen("scene.cameras.json", "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    message[0] = 0;
    assert_false(viewer_cameras_init(&cameras, "scene.json", &test_log));
    assert_non_null(strstr(message, expected));
    assert_null(cameras.saved);
}

static void bad_files_are_refused(void **state)
{
    (void)state;
    refuse("", "scene.cameras.json:1");
    refuse("{\"cameras\": [", "scene.cameras.json:1");
    refuse("{}", "\"cameras\" is missing");
    refuse("[]", "\"cameras\" is missing");
    refuse("{\"cameras\": [{\"name\": \"a\"}]}", "cameras[0]");
    refuse("{\"cameras\": [{\"name\": \"a\", \"position_m\": [1, 2, 3], \"yaw_deg\": 0,"
           "\"pitch_deg\": 0, \"fov_deg\": 200}]}",
           "cameras[0]");
}

static void an_unwritable_scene_folder_gives_way(void **state)
{
    (void)state;
    struct viewer_cameras cameras;
    unlink("scene.cameras.json");
    assert_true(viewer_cameras_init(&cameras, "/proc/scene.json", &test_log));
    assert_true(viewer_cameras_save(&cameras, &(struct wd_camera){.fov_rad = 1}));
    assert_string_equal(cameras.path, "scene.cameras.json");
    viewer_cameras_finish(&cameras);

    assert_true(viewer_cameras_init(&cameras, "/proc/scene.json", &test_log));
    assert_int_equal(cameras.count, 1);
    viewer_cameras_finish(&cameras);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_not_given_twice),
        cmocka_unit_test(come_back_exactly),
        cmocka_unit_test(bad_files_are_refused),
        cmocka_unit_test(an_unwritable_scene_folder_gives_way),
    };
    return cmocka_run_group_tests(tests, enter_scratch, leave_scratch);
}
