/* What keys do, told by events without a window. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "viewer/state.h"

static void press(struct viewer_state *viewer, SDL_Keysym key, Uint8 repeat)
{
    SDL_Event event = {.key = {.type = SDL_KEYDOWN, .repeat = repeat, .keysym = key}};
    viewer_input_event(viewer, &event);
}

static void keys_act_once_however_long_they_are_held(void **state)
{
    (void)state;
    struct viewer_state viewer = {0};
    SDL_Keysym t = {.scancode = SDL_SCANCODE_T, .sym = SDLK_t};
    press(&viewer, t, 0);
    press(&viewer, t, 1);
    assert_true(viewer.times_shown);
}

static void keys_act_while_shift_makes_fast(void **state)
{
    (void)state;
    struct viewer_state viewer = {0};
    press(&viewer, (SDL_Keysym){.scancode = SDL_SCANCODE_T, .sym = SDLK_t, .mod = KMOD_LSHIFT}, 0);
    assert_true(viewer.times_shown);
    press(&viewer, (SDL_Keysym){.scancode = SDL_SCANCODE_ESCAPE, .sym = SDLK_ESCAPE, .mod = KMOD_RSHIFT}, 0);
    assert_true(viewer.quit);
}

static void methods_go_both_ways(void **state)
{
    (void)state;
    struct viewer_state viewer = {.method = wd_method_names()[0]};
    SDL_Keysym m = {.scancode = SDL_SCANCODE_M, .sym = SDLK_m}, shift_m = m;
    shift_m.mod = KMOD_LSHIFT;
    press(&viewer, shift_m, 0);
    assert_string_not_equal(viewer.method, wd_method_names()[0]);
    press(&viewer, m, 0);
    assert_string_equal(viewer.method, wd_method_names()[0]);
    press(&viewer, m, 0);
    assert_string_equal(viewer.method, wd_method_names()[1]);
    press(&viewer, shift_m, 0);
    assert_string_equal(viewer.method, wd_method_names()[0]);
}

static void levels_are_explained_by_method(void **state)
{
    (void)state;
    const struct wd_viewer_params params = {.view = WD_VIEW_ALBEDO};
    struct viewer_state viewer = {.params = &params, .view = params.view, .method = "octree"};
    SDL_Keysym l = {.scancode = SDL_SCANCODE_L, .sym = SDLK_l};
    press(&viewer, l, 0);
    assert_non_null(strstr(viewer.notice, "blue: billboard"));
    assert_true(viewer.notice_until_frame > viewer.frame_count + 1); /* however slow frames are */
    press(&viewer, l, 0);
    assert_int_equal(viewer.view, WD_VIEW_ALBEDO);
    viewer.method = "continuum";
    press(&viewer, l, 0);
    assert_null(strstr(viewer.notice, "billboard"));
}

static void letters_of_other_scripts_act_by_place(void **state)
{
    (void)state;
    struct viewer_state viewer = {0};
    press(&viewer, (SDL_Keysym){.scancode = SDL_SCANCODE_T, .sym = 0x435}, 0); /* Cyrillic ie */
    assert_true(viewer.times_shown);
    press(&viewer, (SDL_Keysym){.scancode = SDL_SCANCODE_T, .sym = SDLK_k}, 0); /* t is elsewhere */
    assert_true(viewer.times_shown);
    press(&viewer, (SDL_Keysym){.scancode = SDL_SCANCODE_K, .sym = SDLK_t}, 0);
    assert_false(viewer.times_shown);
}

static void keys_that_are_held_when_focus_is_lost_are_let_go(void **state)
{
    (void)state;
    struct viewer_state viewer = {0};
    press(&viewer, (SDL_Keysym){.scancode = SDL_SCANCODE_W, .sym = SDLK_w}, 0);
    assert_true(viewer.holds[VIEWER_FORWARD].down);
    SDL_Event event = {.window = {.type = SDL_WINDOWEVENT, .event = SDL_WINDOWEVENT_FOCUS_LOST}};
    viewer_input_event(&viewer, &event);
    assert_false(viewer.holds[VIEWER_FORWARD].down);
}

static void no_time_passes_in_a_pause(void **state)
{
    (void)state;
    double begun_s = viewer_seconds();
    struct viewer_state viewer = {.begin_s = begun_s - 7, .now_s = begun_s};
    press(&viewer, (SDL_Keysym){.scancode = SDL_SCANCODE_W, .sym = SDLK_w}, 0);
    viewer.holds[VIEWER_FORWARD].since_s -= 60;
    viewer_input_pause(&viewer, 60); /* as after a picture that took a minute */
    SDL_Event up = {.key = {.type = SDL_KEYUP, .keysym = {.scancode = SDL_SCANCODE_W, .sym = SDLK_w}}};
    viewer_input_event(&viewer, &up);
    assert_true(viewer.holds[VIEWER_FORWARD].held_s < 30);
    assert_true(fabs(viewer.now_s - (begun_s + 60)) < 1e-3);
    assert_true(fabs(viewer.now_s - viewer.begin_s - 7) < 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_act_once_however_long_they_are_held),
        cmocka_unit_test(keys_act_while_shift_makes_fast),
        cmocka_unit_test(methods_go_both_ways),
        cmocka_unit_test(levels_are_explained_by_method),
        cmocka_unit_test(letters_of_other_scripts_act_by_place),
        cmocka_unit_test(keys_that_are_held_when_focus_is_lost_are_let_go),
        cmocka_unit_test(no_time_passes_in_a_pause),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
