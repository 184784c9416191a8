/* motion.h: a camera that flies, or walks on the ground. Knows neither windows nor forests. */
#ifndef VIEWER_MOTION_H
#define VIEWER_MOTION_H

#include "weald/forest.h"

#define VIEWER_EYE_M 1.7           /* height of a walker's eye above the ground */
#define VIEWER_FLY_CLEARANCE_M 0.5 /* nearest to the ground that flying comes */
#define VIEWER_WADE_M 0.4          /* so deep in water the ground is taken to be */

enum viewer_gait {
    VIEWER_FLY,
    VIEWER_WALK,
};

struct viewer_motion {
    struct wd_camera camera;
    enum viewer_gait gait;
    double speed_factor; /* 1: 20 m/s in the air, 2 m/s on foot */
    double fall_mps;     /* downward speed on foot; 0 on the ground */
    bool grounded;       /* on foot: the last step ended on the ground */
};

/* What the controls asked for since the last step. */
struct viewer_push {
    double forward_s, right_s, up_s; /* seconds that keys were held, signed */
    double yaw_rad, pitch_rad;       /* turned by the mouse */
    bool fast;                       /* five times the speed */
};

/* Without `fast`, in the gait and at the factor of now. */
double viewer_motion_speed_mps(const struct viewer_motion *motion);

struct viewer_ground {
    double (*height_m)(const void *user, double x_m, double y_m);
    const void *user;
};

/* Stands below, or above, where the camera is. */
void viewer_motion_land(struct viewer_motion *motion, const struct viewer_ground *ground);

/* Moves by `push`, then lets `dt_s` of gravity pass. Afterwards the camera is within what can be drawn, and never
 * below the ground plus its clearance; on foot it stands at VIEWER_EYE_M above it, or is falling to there. */
void viewer_motion_step(struct viewer_motion *motion, const struct viewer_push *push, double dt_s,
                        const struct viewer_ground *ground);

#endif
