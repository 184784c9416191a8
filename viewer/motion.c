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

double viewer_motion_speed_mps(const struct viewer_motion *motion)
{
    return (motion->gait == VIEWER_WALK ? WALK_MPS : FLY_MPS) * motion->speed_factor;
}

/* Makes two or three keys at once no faster than one. */
static double one_key(double forward_s, double right_s, double up_s)
{
    double longest_s = fmax(fabs(forward_s), fmax(fabs(right_s), fabs(up_s)));
    return longest_s > 0 ? longest_s / sqrt(forward_s * forward_s + right_s * right_s + up_s * up_s) : 0;
}

/* Forward is where the camera looks when flying, and level on foot. Yaw is clockwise from north. */
static void move(struct viewer_motion *motion, const struct viewer_push *push)
{
    struct wd_camera *camera = &motion->camera;
    double up_s = motion->gait == VIEWER_WALK ? 0 : push->up_s;
    double speed_mps = viewer_motion_speed_mps(motion) * (push->fast ? FAST : 1);
    speed_mps *= one_key(push->forward_s, push->right_s, up_s);
    double level = motion->gait == VIEWER_WALK ? 1 : cos(camera->pitch_rad);
    double rise = motion->gait == VIEWER_WALK ? 0 : sin(camera->pitch_rad);
    double sin_yaw = sin(camera->yaw_rad), cos_yaw = cos(camera->yaw_rad);
    double forward_m = push->forward_s * speed_mps, right_m = push->right_s * speed_mps;
    camera->position_m[0] += forward_m * level * sin_yaw + right_m * cos_yaw;
    camera->position_m[1] += forward_m * level * cos_yaw - right_m * sin_yaw;
    camera->position_m[2] += forward_m * rise + up_s * speed_mps;
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

void viewer_motion_land(struct viewer_motion *motion, const struct viewer_ground *ground)
{
    double *p = motion->camera.position_m;
    p[2] = ground->height_m(ground->user, p[0], p[1]) + VIEWER_EYE_M;
    motion->fall_mps = 0;
    motion->grounded = true;
}

/* Beyond that nothing is drawn. */
static void keep_near(double position_m[3])
{
    const double most_m = 0.99 * WD_MOST_PLACE_M;
    for (int i = 0; i < 3; i++)
        position_m[i] = fmin(fmax(position_m[i], -most_m), most_m);
}

void viewer_motion_step(struct viewer_motion *motion, const struct viewer_push *push, double dt_s,
                        const struct viewer_ground *ground)
{
    struct wd_camera *camera = &motion->camera;
    turn(camera, push);
    move(motion, push);
    keep_near(camera->position_m);
    double ground_m = ground->height_m(ground->user, camera->position_m[0], camera->position_m[1]);
    if (motion->gait == VIEWER_WALK) {
        stand(motion, ground_m + VIEWER_EYE_M, dt_s);
        return;
    }
    motion->fall_mps = 0;
    motion->grounded = false;
    camera->position_m[2] = fmax(camera->position_m[2], ground_m + VIEWER_FLY_CLEARANCE_M);
}
