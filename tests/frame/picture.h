/* picture.h: a bare landscape, without trees, drawn through the passes of a frame. */
#ifndef WD_TEST_PICTURE_H
#define WD_TEST_PICTURE_H

#include "frame/passes/light.h"
#include "frame/passes/post.h"
#include "frame/passes/terrain.h"
#include "world/sun.h"

struct picture_test {
    struct wd_log log;
    struct wd_gpu gpu;
    struct wd_frames frames;
    struct wd_scene scene;
    struct wd_world world;
    struct wd_forest_device forest;
    struct wd_targets targets;
    struct wd_terrain_pass terrain;
    struct wd_light_pass light;
    struct wd_post_pass post;
    struct wd_frame_uniforms uniforms; /* of the newest picture */
    struct wd_view view;
    uint32_t samples; /* 0: 1 */
    uint32_t view_mode;
    struct wd_buffer velocity_px; /* of the newest picture_velocity */
    const struct wd_camera *previous_camera; /* NULL: as the camera */
};

/* Opens the software device with validation and makes diamond-square ground of `cells` x `cells`
 * cells of `cell_m` with some canopy cover; the scene's weather can be changed afterwards. */
bool picture_init(struct picture_test *test, uint32_t width, uint32_t height, uint32_t cells,
                  double cell_m, double relief_m);
void picture_finish(struct picture_test *test);

/* Draws the view of `camera` into the targets and waits. */
bool picture_draw(struct picture_test *test, const struct wd_camera *camera);

/* Height of the ground at a local place plus `above_m`. */
struct wd_camera picture_camera(const struct picture_test *test, double x_m, double y_m,
                                double above_m, double yaw_deg, double pitch_deg);

/* width * height * 4 bytes; free() them. */
uint8_t *picture_display(struct picture_test *test);
/* Draws too; width * height * 2; free() them. */
float *picture_velocity(struct picture_test *test, const struct wd_camera *camera,
                        const struct wd_camera *previous);
/* width * height; free() them. */
float *picture_depth(struct picture_test *test);

#endif
