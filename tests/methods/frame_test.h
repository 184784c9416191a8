/* frame_test.h: whole frames of a small scene on software Vulkan, with chosen features missing. */
#ifndef WD_TEST_FRAME_H
#define WD_TEST_FRAME_H

#include "frame/frame.h"

struct frame_test {
    struct wd_log log;
    struct wd_gpu *gpu; /* shared with tests before and after this one */
    struct wd_scene scene;
    struct wd_world world;
    struct wd_forest_device forest;
    struct wd_frame frame;
    uint32_t page_budget; /* as in struct wd_frame_params */
    float max_error_px;   /* likewise */
    double time_s; /* of the wind, in the frames to come */
    uint32_t height; /* of pictures; 0: 240 */
};

struct frame_test_params {
    uint32_t disabled; /* wd_gpu_feature bits that the device is to lack, */
    uint32_t asked;    /* and that it is to use though software */
    const char *const *settings; /* in place of the scene's; NULL: none */
};
/* Opens the scene of the API's tests; `root` is the source folder. Validation is on. */
void frame_test_init(struct frame_test *test, const char *root,
                     const struct frame_test_params *params);
void frame_test_finish(struct frame_test *test);
/* Teardown of a group: closes the devices. */
int frame_tests_finish(void **state);

/* What one frame left in the G-buffer. */
struct frame_picture {
    uint32_t width, height;
    uint32_t *surface, *albedo;
    float *depth;
};
/* Draws the scene's camera of that index; arrays are to be freed with frame_picture_finish. */
void frame_test_draw(struct frame_test *test, const char *method, uint32_t camera,
                     struct frame_picture *picture);
/* Records the same, and fails at its end, as where memory has run out. */
void frame_test_abandon(struct frame_test *test, const char *method, uint32_t camera);
void frame_picture_finish(struct frame_picture *picture);

#endif
