#include "motion.h"

#include <math.h>

#define GRAVITY_MPS2 9.81
#define FLY_MPS 20.0
#define WALK_MPS 2.0
#define FAST 5.0
#define STEP_DOWN_M 0.6 /* drops up to this are stepped, not fallen */
#define MAX_PITCH_RAD (89.0 * M_PI / 180)

static void turn(struct wd_camera *camera, const struct viewer_push *push)
{
    camera->yaw_rad = remainder(camera->yaw_rad + push->yaw_rad, 2 * M_PI);
    camera->pitch_rad =
        fmin(fmax(camera->pitch_rad + push->pitch_rad, -MAX_PITCH_RAD), MAX_PITCH_RAD);
}

/* Forward is where the camera looks when flying, and level on foot. Yaw is clockwise from north. */
static void move(struct viewer_motion *motion, const struct viewer_push *push)
{
    struct wd_camera *camera = &motion->camera;
    double speed_mps = motion->gait == VIEWER_WALK ? WALK_MPS : FLY_MPS;
    speed_mps *= motion->speed_factor * (push->fast ? FAST : 1);
    double level = motion->gait == VIEWER_WALK ? 1 : cos(camera->pitch_rad);
    double rise = motion->gait == VIEWER_WALK ? 0 : sin(camera->pitch_rad);
    double sin_yaw = sin(camera->yaw_rad), cos_yaw = cos(camera->yaw_rad);
    double forward_m = push->forward_s * speed_mps, right_m = push->right_s * speed_mps;
    camera->position_m[0] += forward_m * level * sin_yaw + right_m * cos_yaw;
    camera->position_m[1] += forward_m * level * cos_yaw - right_m * sin_yaw;
    camera->position_m[2] += forward_m * rise;
    if (motion->gait == VIEWER_FLY)
        camera->position_m[2] += push->up_s * speed_mps;
}

static void stand(struct viewer_motion *motion, double eye_m, double dt_s)
{
    double *z_m = &motion->camera.position_m[2];
    if (*z_m <= eye_m || (motion->grounded && *z_m - eye_m <= STEP_DOWN_M)) {
        *z_m = eye_m;
        motion->fall_mps = 0;
        motion->grounded = true;
        return;
    }
    motion->fall_mps += GRAVITY_MPS2 * dt_s;
    *z_m -= motion->fall_mps * dt_s;
    motion->grounded = *z_m <= eye_m;
    if (motion->grounded) {
        *z_m = eye_m;
        motion->fall_mps = 0;
    }
}

void viewer_motion_step(struct viewer_motion *motion, const struct viewer_push *push, double dt_s,
                        const struct viewer_ground *ground)
{
    struct wd_camera *camera = &motion->camera;
    turn(camera, push);
    move(motion, push);
    double ground_m = ground->height_m(ground->user, camera->position_m[0], camera->position_m[1]);
    if (motion->gait == VIEWER_WALK) {
        stand(motion, ground_m + VIEWER_EYE_M, dt_s);
        return;
    }
    motion->fall_mps = 0;
    motion->grounded = false;
    camera->position_m[2] = fmax(camera->position_m[2], ground_m + VIEWER_FLY_CLEARANCE_M);
}
