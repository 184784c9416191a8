#include <math.h>

#include "state.h"

#define LOOK_RAD_PER_PX 0.003
#define WHEEL_FACTOR 1.25
#define MIN_SPEED 0.05
#define MAX_SPEED 100.0
#define TAP_SECONDS 0.03 /* press and release within one frame still move this long */

static const SDL_Scancode hold_keys[VIEWER_HOLD_KEYS] = {
    [VIEWER_FORWARD] = SDL_SCANCODE_W, [VIEWER_BACK] = SDL_SCANCODE_S,
    [VIEWER_LEFT] = SDL_SCANCODE_A,    [VIEWER_RIGHT] = SDL_SCANCODE_D,
    [VIEWER_DOWN] = SDL_SCANCODE_Q,    [VIEWER_UP] = SDL_SCANCODE_E,
};

static const struct binding {
    SDL_Keycode key;
    Uint16 modifiers; /* one of these must be down; 0: whatever is, but for a binding before */
    void (*act)(struct viewer_state *viewer);
} bindings[] = {
    {SDLK_f, 0, viewer_act_gait},         {SDLK_m, KMOD_SHIFT, viewer_act_method_before},
    {SDLK_m, 0, viewer_act_method},
    {SDLK_o, KMOD_SHIFT, viewer_act_earlier}, {SDLK_o, 0, viewer_act_later},
    {SDLK_l, 0, viewer_act_lod},          {SDLK_t, 0, viewer_act_times},
    {SDLK_h, 0, viewer_act_help},         {SDLK_g, 0, viewer_act_grab},
    {SDLK_b, 0, viewer_act_accumulate},
    {SDLK_p, 0, viewer_act_play},         {SDLK_c, KMOD_SHIFT, viewer_act_save_camera},
    {SDLK_ESCAPE, 0, viewer_act_quit},    {SDLK_c, 0, viewer_act_next_camera},
    {SDLK_F12, 0, viewer_act_screenshot}, {SDLK_F9, 0, viewer_act_report},
};

static void press(struct viewer_hold *hold, double now_s)
{
    if (!hold->down)
        *hold = (struct viewer_hold){true, now_s, hold->held_s};
}

static void release(struct viewer_hold *hold, double now_s)
{
    if (!hold->down)
        return;
    hold->down = false;
    hold->held_s = fmax(hold->held_s + now_s - hold->since_s, TAP_SECONDS);
}

static double take(struct viewer_hold *hold, double now_s)
{
    double held_s = hold->held_s;
    if (hold->down)
        held_s += now_s - hold->since_s;
    hold->since_s = now_s;
    hold->held_s = 0;
    return held_s;
}

/* Where the keyboard has letters of another script, the Latin ones by their places. */
static SDL_Keycode letter(const SDL_Keysym *key)
{
    bool latin = key->sym < 0x80 || (key->sym & SDLK_SCANCODE_MASK);
    bool place = key->scancode >= SDL_SCANCODE_A && key->scancode <= SDL_SCANCODE_Z;
    return latin || !place ? key->sym : SDLK_a + (SDL_Keycode)(key->scancode - SDL_SCANCODE_A);
}

static void key_event(struct viewer_state *viewer, const SDL_KeyboardEvent *event)
{
    double now_s = viewer_seconds();
    for (int i = 0; i < VIEWER_HOLD_KEYS; i++) {
        if (event->keysym.scancode != hold_keys[i])
            continue;
        if (event->type == SDL_KEYDOWN)
            press(&viewer->holds[i], now_s);
        else
            release(&viewer->holds[i], now_s);
        return;
    }
    if (event->type != SDL_KEYDOWN || event->repeat)
        return;
    SDL_Keycode key = letter(&event->keysym);
    for (size_t i = 0; i < sizeof bindings / sizeof *bindings; i++) {
        const struct binding *binding = &bindings[i];
        if (binding->key == key && (!binding->modifiers || (event->keysym.mod & binding->modifiers))) {
            binding->act(viewer);
            return;
        }
    }
}

static void window_event(struct viewer_state *viewer, const SDL_WindowEvent *event)
{
    switch (event->event) {
    case SDL_WINDOWEVENT_CLOSE:
        viewer->quit = true;
        break;
    case SDL_WINDOWEVENT_SIZE_CHANGED:
        viewer->stale = true;
        break;
    case SDL_WINDOWEVENT_MINIMIZED:
    case SDL_WINDOWEVENT_HIDDEN:
        viewer->minimised = true;
        break;
    case SDL_WINDOWEVENT_RESTORED:
    case SDL_WINDOWEVENT_SHOWN:
    case SDL_WINDOWEVENT_EXPOSED:
        viewer->minimised = false;
        viewer->stale = true;
        break;
    case SDL_WINDOWEVENT_FOCUS_LOST:
        for (int i = 0; i < VIEWER_HOLD_KEYS; i++)
            release(&viewer->holds[i], viewer_seconds());
        break;
    default:
        break;
    }
}

/* A mouse that is grabbed points nowhere: it picks what is in the middle. */
static void mouse_button(struct viewer_state *viewer, const SDL_MouseButtonEvent *event)
{
    bool down = event->type == SDL_MOUSEBUTTONDOWN;
    int x = event->x, y = event->y;
    if (event->button == SDL_BUTTON_RIGHT && !viewer->grabbed)
        SDL_SetRelativeMouseMode(down ? SDL_TRUE : SDL_FALSE);
    if (event->button != SDL_BUTTON_LEFT || !down)
        return;
    if (viewer->grabbed) {
        SDL_GetWindowSize(viewer->window, &x, &y);
        x /= 2;
        y /= 2;
    }
    viewer_act_pick(viewer, x, y);
}

static void mouse_motion(struct viewer_state *viewer, const SDL_MouseMotionEvent *event)
{
    if (!viewer->grabbed && !(event->state & SDL_BUTTON_RMASK))
        return;
    viewer->look_yaw_rad += event->xrel * LOOK_RAD_PER_PX;
    viewer->look_pitch_rad -= event->yrel * LOOK_RAD_PER_PX;
}

static void change_speed(struct viewer_state *viewer, int clicks)
{
    double factor = viewer->motion.speed_factor * pow(WHEEL_FACTOR, clicks);
    viewer->motion.speed_factor = fmin(fmax(factor, MIN_SPEED), MAX_SPEED);
}

void viewer_input_event(struct viewer_state *viewer, const SDL_Event *event)
{
    switch (event->type) {
    case SDL_QUIT:
        viewer->quit = true;
        break;
    case SDL_WINDOWEVENT:
        window_event(viewer, &event->window);
        break;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
        key_event(viewer, &event->key);
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        mouse_button(viewer, &event->button);
        break;
    case SDL_MOUSEMOTION:
        mouse_motion(viewer, &event->motion);
        break;
    case SDL_MOUSEWHEEL:
        change_speed(viewer, event->wheel.y);
        break;
    default:
        break;
    }
}

void viewer_input_pause(struct viewer_state *viewer, double paused_s)
{
    viewer->begin_s += paused_s;
    viewer->now_s += paused_s;
    for (int i = 0; i < VIEWER_HOLD_KEYS; i++)
        viewer->holds[i].since_s += paused_s;
}

void viewer_input_step(struct viewer_state *viewer)
{
    double held_s[VIEWER_HOLD_KEYS];
    for (int i = 0; i < VIEWER_HOLD_KEYS; i++)
        held_s[i] = take(&viewer->holds[i], viewer->now_s);
    struct viewer_push push = {
        .forward_s = held_s[VIEWER_FORWARD] - held_s[VIEWER_BACK],
        .right_s = held_s[VIEWER_RIGHT] - held_s[VIEWER_LEFT],
        .up_s = held_s[VIEWER_UP] - held_s[VIEWER_DOWN],
        .yaw_rad = viewer->look_yaw_rad,
        .pitch_rad = viewer->look_pitch_rad,
        .fast = (SDL_GetModState() & KMOD_SHIFT) != 0,
    };
    viewer->look_yaw_rad = viewer->look_pitch_rad = 0;
    if (push.forward_s != 0 || push.right_s != 0 || push.up_s != 0)
        viewer->path_time_s = -1;
    struct viewer_ground ground = viewer_ground(viewer);
    if (viewer->path_time_s < 0)
        viewer_motion_step(&viewer->motion, &push, viewer->step_s, &ground);
}
