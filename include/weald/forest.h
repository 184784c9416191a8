/* weald/forest.h: a scene file come to life on the CPU: ground, standing trees, cameras. */
#ifndef WEALD_FOREST_H
#define WEALD_FOREST_H

#include "weald/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Frames of reference. Local: metres east (x), north (y), up (z) of the terrain's south-west
 * corner; z 0 is the terrain's vertical datum. Projected: the terrain's own coordinate system;
 * projected = local + wd_forest_info.origin_m in x and y, z alike. */

struct wd_forest;

struct wd_forest_params {
    const char *scene_path; /* a scene file; required */
    const char *data_dir;   /* what ${data} stands for in the scene's file names; NULL: none given */
    /* "key.key=value" each, in place of what the scene file says, such as "wind.speed_mps=0",
     * "layers.0.spacing_m=5" or, of the scene's own method, "methods.@method.faithful=true"; ended
     * by NULL. NULL: none. Values are JSON or plain text. */
    const char *const *settings;
    const char *seed;       /* decimal, replaces the scene's seed; NULL: the scene's own */
    unsigned threads;       /* 0: one a processor. The forest is the same for any number */
    uint64_t max_trees;     /* 0: 64 million; a scene with more is refused */
    struct wd_progress progress;
    struct wd_log log;
};

/* Reads the scene, makes the ground and plants every tree. A forest does not change: for another season or weather
 * make another, with other settings; pictures may have another sun. The same scene and seed give the same
 * forest on any machine, compiler and number of threads. Takes about a second for a million trees.
 *   forest  receives the new object, NULL on failure; destroy with wd_forest_destroy
 *   params  read during the call only
 * Errors: WD_ERROR_INPUT (the log names file, line and key), WD_ERROR_MEMORY (for a sky's picture),
 * WD_ERROR_INTERRUPTED. Thread-safe for different forests. */
enum wd_result wd_forest_create(struct wd_forest **forest, const struct wd_forest_params *params);

/* Frees the forest; no renderer may still use it. Accepts NULL and a pointer to NULL. */
void wd_forest_destroy(struct wd_forest **forest);

struct wd_forest_info {
    const char *name;
    uint64_t tree_count;       /* of layers planted on demand the number to be expected */
    uint32_t last_id;          /* no tree has a greater one */
    bool on_demand;            /* some layers are not stored: not every id is a tree's */
    uint32_t species_count, layer_count, inventory_count;
    double min_m[3], max_m[3]; /* local frame: ground and trees */
    double origin_m[2];        /* projected coordinates of local (0, 0) */
    const char *crs;           /* WKT of the projected frame, or NULL */
    uint64_t host_bytes;       /* memory held for terrain, trees and octree */
    uint64_t hash;             /* equal worlds have equal hashes */
    uint32_t seed;
    uint32_t octant_count, octree_depth;
    double terrain_cell_m, terrain_ha;
};

/* Fills `*info`; its strings live as long as the forest. Thread-safe. */
void wd_forest_get_info(const struct wd_forest *forest, struct wd_forest_info *info);

/* A number that changes with all that pictures of the forest follow from: weald's own code, the scene
 * and species files, settings, ground, trees, sky and models; of forests of specimens (weald/tree.h) it
 * knows their places alone. Takes a fraction of a second for a million trees. Thread-safe. */
uint64_t wd_forest_key(const struct wd_forest *forest);

struct wd_species_info {
    const char *name, *latin; /* as the scene calls it; as botanists do, "unknown" of some models */
    uint64_t tree_count;      /* of layers on demand the number to be expected */
};
/* Fills `*info`, whose strings live as long as the forest; false from species_count on. Thread-safe. */
bool wd_forest_get_species(const struct wd_forest *forest, uint32_t index,
                           struct wd_species_info *info);

/* What became of the rows of a table of trees. */
struct wd_inventory_info {
    const char *file; /* as the scene names it */
    uint64_t rows, planted, dead, duplicates, outside, invalid; /* outside: the ground; invalid: without a position */
};
/* Fills `*info`, whose string lives as long as the forest; false from inventory_count on. Thread-safe. */
bool wd_forest_get_inventory(const struct wd_forest *forest, uint32_t index,
                             struct wd_inventory_info *info);

struct wd_tree_info {
    uint32_t id;
    uint32_t species;      /* index for wd_forest_get_species */
    double position_m[3];  /* local: the trunk's foot */
    double height_m, crown_diameter_m, yaw_rad;
};
/* The tree with this id (as in the tree_id layer of a picture; stored trees have 1, 2, ..., those of
 * layers on demand the number of their cell after these, modulo 2^32). Thread-safe. */
bool wd_forest_get_tree(const struct wd_forest *forest, uint32_t id, struct wd_tree_info *info);

/* Height of the ground at a local place, metres; outside, that of the nearest edge. Thread-safe. */
double wd_forest_ground_m(const struct wd_forest *forest, double x_m, double y_m);
/* Height of the water that stands over that ground, metres; -INFINITY where none does. Thread-safe. */
double wd_forest_water_m(const struct wd_forest *forest, double x_m, double y_m);

/* Least and greatest vertical field of view, in scene files as in struct wd_camera: 0.001746 to 3.124139
 * radians. Narrower views take ever longer to draw (minutes, below 0.005 degrees). */
#define WD_LEAST_FOV_DEG 0.1
#define WD_MOST_FOV_DEG 179.0

/* How far from the local frame's origin a camera may be, each way, in metres. */
#define WD_MOST_PLACE_M 2.0e6
/* Most pixels of a picture each way. */
#define WD_MOST_SIZE_PX 16384

/* A pinhole camera. All of it is finite. It looks along
 *   ahead = (sin yaw cos pitch, cos yaw cos pitch, sin pitch), with
 *   right = (cos yaw, -sin yaw, 0) and up = right x ahead: never rolled.
 * Pixels are square: the focal length is height / (2 tan(fov_rad / 2)) pixels both ways, the principal point the
 * picture's middle, (width / 2, height / 2). Without distortion. Places in a picture are in pixels from its upper
 * left corner, x right and y down: the middle of the pixel in column i and row j is at (i + 0.5, j + 0.5). */
struct wd_camera {
    double position_m[3]; /* local frame, less than WD_MOST_PLACE_M from its origin; z above the datum */
    double yaw_rad;       /* clockwise from north */
    double pitch_rad;     /* up from the horizon */
    double fov_rad;       /* vertical field of view, WD_LEAST_FOV_DEG..WD_MOST_FOV_DEG as radians */
};

/* Turns the camera toward a local place. Straight up or down, or where the place is its own, yaw stays. Thread-safe,
 * as the next two. */
void wd_camera_look_at(struct wd_camera *camera, const double place_m[3]);

/* Where a picture of this size shows a local place, within the picture or beside it, and at which depth, as in the
 * layer depth_m. False, and both are left as they are, if the place is not ahead of the camera.
 *   depth_m  may be NULL */
bool wd_camera_project(const struct wd_camera *camera, uint32_t width, uint32_t height, const double place_m[3],
                       double pixel[2], double *depth_m);
/* The other way: the local place that is seen there at this depth. */
void wd_camera_place(const struct wd_camera *camera, uint32_t width, uint32_t height, const double pixel[2],
                     double depth_m, double place_m[3]);

/* Names of the scene's cameras and paths, in file order; NULL beyond the last. Every scene has at
 * least one camera. The strings live as long as the forest. Thread-safe. */
const char *wd_forest_camera_name(const struct wd_forest *forest, uint32_t index);
const char *wd_forest_path_name(const struct wd_forest *forest, uint32_t index);

/* The camera called `name` (NULL: the first). WD_ERROR_INPUT if there is none; the log then lists the names
 * there are. */
enum wd_result wd_forest_get_camera(const struct wd_forest *forest, const char *name,
                                    struct wd_camera *camera);

/* The camera on path `name` (NULL: the first) at `time_s`, clamped to the path's duration;
 * `duration_s` may be NULL. Catmull-Rom through the path's keys, field of view within those of the keys
 * before and after. Errors: WD_ERROR_INPUT (a time that is not finite; no such path: the log lists the
 * names there are). */
enum wd_result wd_forest_get_path_camera(const struct wd_forest *forest, const char *name,
                                         double time_s, struct wd_camera *camera,
                                         double *duration_s);

/* Where the sun stands. */
struct wd_sun {
    double azimuth_deg;   /* clockwise from north */
    double elevation_deg; /* of its middle over the horizon, -90..90; where twilight is over the moon stands in for it */
};

/* Where the scene has it. */
struct wd_sun wd_forest_sun(const struct wd_forest *forest);
/* Whether pictures may have it elsewhere: not under a sky map, whose light does not move. */
bool wd_forest_sun_moves(const struct wd_forest *forest);
/* Where it stands at an hour of the scene's clock on its date, -24..48: before 0 and past 24 it is another day.
 * WD_ERROR_INPUT where the scene has no date, latitude or longitude. */
enum wd_result wd_forest_sun_at(const struct wd_forest *forest, double hour, struct wd_sun *sun);
/* Where it will stand `hours` later (earlier, below 0) on its way of a day about the sky's pole at the scene's latitude,
 * 45 degrees north where it has none. */
struct wd_sun wd_forest_sun_later(const struct wd_forest *forest, const struct wd_sun *sun, double hours);

/* Whether `path` can be written without loss of what the forest was read from: its scene, species,
 * models, inventories, rasters, sky and clips, whatever links lead there. Writing pictures and films does
 * not ask; wd_forest_write (weald/tree.h) does.
 *   frames  of numbered pictures (frame-%05d.png) how many; 0: `path` is one file
 * Errors: WD_ERROR_INPUT. Thread-safe. */
enum wd_result wd_forest_check_output(const struct wd_forest *forest, const char *path,
                                      uint64_t frames, const struct wd_log *log);

/* What the scene asks for where the caller does not say otherwise. */
struct wd_render_defaults {
    uint32_t width, height, samples; /* pixels; pictures averaged */
    const char *method;              /* lives as long as the forest */
};
/* Thread-safe. */
void wd_forest_get_render_defaults(const struct wd_forest *forest,
                                   struct wd_render_defaults *defaults);

/* Checks a file: a scene or species (.json), an inventory (.csv) or a raster. A scene's ground is made, its
 * inventories are planted and the maps of its layers read as it would; layers are not planted (they may turn out
 * to have too many trees, or none), models not read, and its sky need only be there and readable.
 *   data_dir  as in struct wd_forest_params; NULL: none given
 * Errors: WD_ERROR_INPUT, each fault logged with file and line or key. Thread-safe. */
enum wd_result wd_file_check(const char *path, const char *data_dir, const struct wd_log *log);

/* JSON Schema of scene ("scene") files, or of species that are grown ("species") or an artist's
 * model ("model"); free() the text. NULL otherwise. */
char *wd_schema_text(const char *kind);

#ifdef __cplusplus
}
#endif
#endif
