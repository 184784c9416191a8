#include "scene/scene_parts.h"
#include "weald/forest.h"

static const char *const frames[] = {"local", "projected", NULL};

/* Cameras and the keys of paths say the same but for the name. */
#define CAMERA(member) offsetof(struct wd_scene_camera, member)
#define CAMERA_ROWS                                                                                \
    {"frame", WD_KEY_STRING, CAMERA(frame), .fallback = "\"local\"", .choices = frames,            \
     .doc = "local: metres from the terrain's south-west corner; projected: its coordinates."},    \
    {"position_m", WD_KEY_VECTOR, CAMERA(position_m), -1e8, 1e8, .length = 3,                      \
     .flags = WD_KEY_REQUIRED,                                                                     \
     .doc = "East, north, up in metres; up counts from the ground unless absolute."},              \
    {"look_at_m", WD_KEY_NUMBERS, CAMERA(look_at_m), -1e8, 1e8, .length = 3,                       \
     .count_offset = CAMERA(look_at_count),                                                        \
     .doc = "Point to look at, as position_m; without it yaw_deg and pitch_deg count."},           \
    {"yaw_deg", WD_KEY_DOUBLE, CAMERA(yaw_deg), -360, 360, "0",                                    \
     "Direction of view, clockwise from north, in degrees."},                                      \
    {"pitch_deg", WD_KEY_DOUBLE, CAMERA(pitch_deg), -90, 90, "0",                                  \
     "Upward tilt of the view in degrees."},                                                       \
    {"fov_deg", WD_KEY_DOUBLE, CAMERA(fov_deg), WD_LEAST_FOV_DEG, WD_MOST_FOV_DEG, "50",           \
     "Vertical field of view in degrees."},                                                        \
    {"absolute", WD_KEY_BOOL, CAMERA(absolute), .fallback = "false",                               \
     .doc = "Up counts from the world's zero, not from the ground."},                              \
    {0}

static const struct wd_key camera_keys[] = {
    {"name", WD_KEY_STRING, CAMERA(name), .doc = "Name, for --camera.", .flags = WD_KEY_REQUIRED},
    CAMERA_ROWS,
};
const struct wd_keys wd_scene_camera_keys = {"camera", camera_keys, sizeof(struct wd_scene_camera),
                                             wd_scene_check_camera};

static const struct wd_key path_camera_keys[] = {CAMERA_ROWS};
static const struct wd_keys path_camera_table = {
    "path key", path_camera_keys, sizeof(struct wd_scene_camera), wd_scene_check_camera};

#define PATH(member) offsetof(struct wd_scene_path, member)
static const struct wd_key path_keys[] = {
    {"name", WD_KEY_STRING, PATH(name), .doc = "Name, for --path.", .flags = WD_KEY_REQUIRED},
    {"duration_s", WD_KEY_DOUBLE, PATH(duration_s), 0, 86400, "10",
     "Time from the first key to the last, in seconds.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"keys", WD_KEY_LIST, PATH(keys), .table = &path_camera_table, .count_offset = PATH(key_count),
     .doc = "Cameras along the way, evenly spaced in time; at least two.",
     .flags = WD_KEY_REQUIRED},
    {0},
};
const struct wd_keys wd_scene_path_keys = {"path", path_keys, sizeof(struct wd_scene_path),
                                           wd_scene_check_path};
