/* What keys do, told by events without a window. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_act_once_however_long_they_are_held),
        cmocka_unit_test(keys_act_while_shift_makes_fast),
        cmocka_unit_test(letters_of_other_scripts_act_by_place),
        cmocka_unit_test(keys_that_are_held_when_focus_is_lost_are_let_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
