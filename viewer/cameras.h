/* cameras.h: cameras that the visitor saved, in SCENE.cameras.json. */
#ifndef VIEWER_CAMERAS_H
#define VIEWER_CAMERAS_H

#include "weald/forest.h"

struct viewer_saved_camera {
    char *name;
    struct wd_camera camera;
};

struct viewer_cameras {
    const struct wd_log *log;
    char *path; /* of the file, existing or to be */
    struct viewer_saved_camera *saved;
    size_t count;
};

/* Reads the file beside the scene, or of that name in the working directory; there may be none. A
 * file that cannot be understood is complained about and an error, so that it is not overwritten.
 */
bool viewer_cameras_init(struct viewer_cameras *cameras, const char *scene_path,
                         const struct wd_log *log);
void viewer_cameras_finish(struct viewer_cameras *cameras);

/* NULL if none is called so. */
const struct viewer_saved_camera *viewer_cameras_find(const struct viewer_cameras *cameras, const char *name);

/* Appends a camera under a fresh name and writes the file. */
bool viewer_cameras_save(struct viewer_cameras *cameras, const struct wd_camera *camera);

#endif
