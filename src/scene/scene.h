/* scene.h: what a scene file says, validated, as plain structs. */
#ifndef WD_SCENE_SCENE_H
#define WD_SCENE_SCENE_H

#include "scene/methods.h"
#include "scene/nearest.h"
#include "scene/species.h"

enum wd_terrain_kind { WD_TERRAIN_FLAT, WD_TERRAIN_DIAMOND_SQUARE, WD_TERRAIN_RASTER };
enum wd_nodata_rule { WD_NODATA_FILL, WD_NODATA_CUT };

struct wd_scene_terrain {
    int kind;                /* enum wd_terrain_kind */
    double size_m[2];        /* flat, diamond-square: east, north extent; flat and
                                0, 0: fitted to the inventories */
    double cell_m;           /* diamond-square: sample spacing; raster: wanted spacing, 0: its own; flat: not used */
    double relief_m;         /* diamond-square: highest minus lowest */
    double roughness;        /* diamond-square: y of R1; smooth from 0.8 */
    double valley;           /* diamond-square: 0 none .. 1 a valley carved along the y axis */
    double base_m;           /* flat: its height; others: added to every height */
    const char *file;        /* raster: any GDAL raster, beside the scene file */
    const char *crs;         /* raster: CRS to assume where the file has none, e.g. "EPSG:4326" */
    const char *target_crs;  /* raster: metres CRS to reproject to; NULL: the UTM zone for degrees */
    const char *unit;        /* raster without CRS: "metres" says x and y are metres already */
    int64_t band;            /* raster: 1.. */
    double nodata;           /* raster: value to take as missing besides the file's own; NaN: none */
    int nodata_rule;         /* enum wd_nodata_rule */
    double *window_m;        /* raster: xmin, ymin, xmax, ymax in the target CRS; NULL: all */
    size_t window_count;     /* 0 or 4 */
    double vertical_scale;
    bool checked;            /* read from a file, without an error but for files that are not there */
};

/* A raster that gives a probability (or a height) at each place. */
struct wd_scene_map {
    const char *file;        /* NULL: no map */
    const char *crs;         /* to assume where the file has none; "local": stretched over the terrain */
    int64_t band;
    int64_t *classes;        /* land cover: probability 1 where the value is listed */
    size_t class_count;
    double *class_density;   /* parallel to classes: probability of each; NULL: 1 */
    size_t class_density_count;
    float value_range[2];    /* otherwise: value at probability 0 and at 1; may fall */
};

struct wd_scene_share {
    const char *name;        /* species */
    double share;            /* exact probability of this species in the layer, relative */
};

enum wd_layer_placement { WD_PLACE_GRID, WD_PLACE_POISSON, WD_PLACE_CANOPY };
/* A species whose individuals are cut to a box or a mesh: rows of them are a hedge (W9). */
struct wd_scene_clip {
    const char *name;        /* species */
    float box_m[3];          /* width along the tree's own x, depth, height; 0: a mesh */
    const char *mesh;        /* NULL, or a model file */
};

struct wd_scene_layer {
    const char *name;
    int placement;           /* grid: one per jittered cell (I1); poisson: R2; canopy: one a local
                                maximum of a canopy-height raster, with that height */
    struct wd_scene_share *species;
    size_t species_count;
    double spacing_m;        /* grid: cell size; poisson: square size; canopy: least distance */
    double jitter;           /* 0 centres .. 1 anywhere in the cell */
    double density;          /* grid: probability a cell is planted; poisson: mean a square */
    struct wd_scene_map map; /* probability map */
    struct wd_scene_map canopy; /* canopy heights in metres */
    float slope_deg[2];      /* planted only between; soft over slope_fade_deg */
    double slope_fade_deg;
    double altitude_m[2];    /* planted only between; soft over altitude_fade_m */
    double altitude_fade_m;
    double patchiness;       /* 0 even .. 1 groves and clearings, of patch_size_m, by hashed noise */
    double patch_size_m;
    float height_m[2];       /* drawn evenly between */
    float aspect[2];         /* crown width, as a factor of the species' own at that height */
    double tint;             /* spread of colour between trees, 0..1 */
    int64_t *yaw_deg;        /* all are turned so far, counter-clockwise; NULL: each its own way */
    size_t yaw_count;
    double fade_near_m[2];   /* 0, 0: none. Seen only beyond, fading in over this span (I7) */
    double fade_far_m[2];    /* 0, 0: none. Fades out over this span */
    double mesh_distance_m;  /* 3D meshes nearer than this (I6); 0: the quality's own */
};

enum wd_outside_rule { WD_OUTSIDE_DROP, WD_OUTSIDE_KEEP, WD_OUTSIDE_ERROR };
struct wd_scene_inventory {
    const char *file;
    const char *delimiter;   /* NULL: by a line sep=; or the header row (, ; tab) */
    struct {
        const char *x, *y, *species, *dbh, *height, *crown_diameter, *id, *status;
    } columns;               /* NULL: found out from usual names */
    const char *dbh_unit;    /* "cm", "mm", "dm", "m", "in", "ft"; NULL: as the column's name says, else cm */
    const char *height_unit; /* "m", "dm", "cm", "mm", "ft", "in"; NULL: as the column's name says, else m */
    const char *frame;       /* "local" (default): metres from the terrain's south-west corner;
                                "projected": the terrain's own coordinates; or "EPSG:n" */
    double offset_m[2];      /* added to x, y; of a frame in degrees or feet, to the terrain's own */
    double rotate_deg;       /* local frame: turned counter-clockwise about its origin, before */
    struct wd_string_pair *species; /* name in the file -> species name; "*": any other */
    size_t species_count;
    const char **dead;       /* values of the status column that mean dead: left out, counted */
    size_t dead_count;
    int outside;             /* enum wd_outside_rule */
    float height_m[2];       /* where neither height nor dbh is given: drawn evenly between */
};

struct wd_scene_camera {
    const char *name;
    const char *frame;       /* "local" (default) or "projected" */
    double position_m[3];    /* x, y, z; z above the ground unless absolute */
    double *look_at_m;       /* x, y, z, or NULL: yaw and pitch count */
    size_t look_at_count;    /* 0 or 3 */
    double yaw_deg;          /* clockwise from north */
    double pitch_deg;        /* up */
    double fov_deg;          /* vertical */
    bool absolute;           /* z is above the world's zero, not above the ground */
    bool automatic;          /* no camera was given: the renderer frames the scene */
};

struct wd_scene_path {
    const char *name;
    double duration_s;
    struct wd_scene_camera *keys; /* evenly spaced in time; Catmull-Rom between */
    size_t key_count;
};

/* A moment and a place on earth. */
struct wd_scene_time {
    const char *date;        /* "YYYY-MM-DD", or NULL: summer. Says the season */
    const char *clock;       /* "HH:MM[:SS]", or NULL: the sun stands where "sun" says */
    double utc_offset_h;     /* of the clock; NaN: the zone of the longitude */
    double latitude_deg, longitude_deg; /* north, east; NaN: not given */
};

/* Whether the trees of grids are all placed and kept, or found anew by whoever looks at them. */
enum wd_planting { WD_PLANTING_AUTO, WD_PLANTING_STORED, WD_PLANTING_ON_DEMAND };

/* How the shadows of trees are kept: parallel-split, or one map warped toward the camera. */
enum wd_shadow_maps { WD_SHADOW_CASCADES, WD_SHADOW_PERSPECTIVE };

/* Where there is a map of the sky: whose sun shines. */
enum wd_sky_sun { WD_SKY_SUN_FILE, WD_SKY_SUN_SCENE };

struct wd_grow_params;
struct wd_scene {
    const char *path;        /* of the file */
    const char *name;
    int64_t seed;
    struct wd_scene_terrain terrain;
    struct wd_string_pair *species_files; /* name -> file, ready to open; once loaded, also those
                                             that layers and inventories name */
    size_t species_file_count;
    struct wd_species *species; /* loaded, parallel to species_files */
    struct wd_scene_clip *clips; /* hedges among the species */
    size_t clip_count;
    struct wd_number_pair *openness; /* how openly species stand: 0 to 1 */
    size_t openness_count;
    struct wd_string_pair *when_young; /* names of species -> of those that stand for their young trees */
    size_t when_young_count;
    struct wd_string_pair *in_the_open; /* names of species -> of those that stand for their trees in the open */
    size_t in_the_open_count;
    int64_t variants;        /* grown individuals a species */
    const struct wd_grow_params *individuals; /* NULL; or, not from a file, one a species: each is
                                grown so (tree/grow.h), and `variants` is 1 */
    struct wd_scene_layer *layers;
    size_t layer_count;
    struct wd_scene_inventory *inventories;
    size_t inventory_count;
    int planting;            /* enum wd_planting */
    struct wd_scene_time time;
    struct {
        double azimuth_deg;  /* clockwise from north */
        double elevation_deg;
        double angular_diameter_deg;
        double strength;     /* 1: the sun of a clear day */
    } sun;
    struct wd_scene_sky {
        double turbidity;    /* 1.8 clear .. 10 hazy */
        double cover;        /* of clouds: 0 clear .. 1 overcast */
        double strength;
        const char *file;    /* environment map, EXR by longitude and latitude; NULL: computed */
        double turn_deg;     /* of the map, clockwise */
        int sun;             /* enum wd_sky_sun */
    } sky;
    struct {
        double visibility_m; /* distance at which contrast falls to 2% */
        double height_m;     /* the haze thins by e over this height */
        double base_m;       /* height of full density, above the world's zero */
    } fog;
    struct {
        double speed_mps;    /* mean at 10 m */
        double direction_deg;/* where it blows from, clockwise from north */
        double gust;         /* share of the mean */
    } wind;
    struct {
        bool enabled;
        double level_m;      /* above the world's zero */
        float color[3];      /* linear, of deep water */
        double clarity_m;    /* depth at which the ground fades by e */
        struct wd_scene_map map; /* rivers and lakes, each at its own height */
        double depth_m;      /* how deep their beds are dug */
    } water;
    struct {
        float grass[3], soil[3], rock[3], litter[3]; /* linear albedo */
        double rock_slope_deg;
        double snow_line_m;  /* above the world's zero; 0: none */
        double tree_line_m;  /* 0: none */
        double snow;         /* share of level ground and of upper sides under fresh snow */
    } ground;
    struct {
        double f_number;     /* 0: a pinhole, all is sharp */
        double focus_m;      /* distance along the view axis that is sharp */
        double shutter;      /* share of the time between frames for which it is open */
        double bloom;        /* share of the light that the lens spreads about */
    } lens;
    struct wd_scene_camera *cameras;
    size_t camera_count;
    struct wd_scene_path *paths;
    size_t path_count;
    const char *method;      /* one of wd_scene_method_names */
    struct wd_method_options methods;
    struct {
        int64_t width, height;
        int64_t samples;
        double mesh_distance_m;    /* full meshes nearer than this, for a tree of 20 m */
        double reduced_distance_m; /* reduced meshes nearer than this */
        double blend;              /* share of a distance over which levels blend */
        double leaf_px;            /* leaves of meshes shorter than this thin out; 0: none */
        int64_t shadow_size;       /* texels a side of a cascade */
        double shadow_distance_m;
        int64_t shadow_taps;
        int shadow_maps;           /* enum wd_shadow_maps */
        double exposure_ev;        /* added to automatic exposure */
        double terrain_error_px;
    } quality;
    struct wd_arena arena;   /* owns all of the above */
};

extern const struct wd_keys wd_scene_keys;

/* What a scene is loaded with. */
struct wd_scene_params {
    const char *data_dir;    /* what ${data} in file names stands for; NULL: none */
    bool find_files;         /* rasters, maps, inventories and the sky must be there and readable */
    bool planted;            /* trees come from elsewhere: bare ground is no cause to warn */
    const char *const *settings; /* "key=value" in place of the file's: struct wd_keys_input */
};

/* Reads a scene file and every species file it names. On failure `*scene` is `{0}`; all errors
 * that can be found in one pass have been logged. A species without an entry in "species" is
 * looked for as species/NAME.json and ../species/NAME.json beside the scene file, then among the
 * installed ones. File names that begin with ${data} become absolute. `params` may be NULL. */
bool wd_scene_load_with(struct wd_scene *scene, const char *path,
                        const struct wd_scene_params *params, const struct wd_log *log);

/* By its name, what a file of vector data or a workbook is and what becomes of it; NULL: it is of another kind. */
const char *wd_scene_table_advice(const char *path);

/* Whether a file's text has more keys of a species, of either kind, than of a scene at its root. Text
 * that is no JSON object has none. */
bool wd_scene_text_is_species(const char *path, const char *text, size_t size);
void wd_scene_finish(struct wd_scene *scene);

/* The sun's place at an hour of the scene's clock on its date; below 0 or over 24 is another day. False: the
 * scene has no date, latitude or longitude. */
bool wd_scene_sun_at(const struct wd_scene *scene, double hour, double *azimuth_deg, double *elevation_deg);

const struct wd_scene_camera *wd_scene_find_camera(const struct wd_scene *scene, const char *name);
/* Radius of the opening of the scene's lens, behind which film of 36 x 24 mm sees `fov_rad` from top
 * to bottom, in metres; 0: a pinhole. */
double wd_scene_lens_radius_m(const struct wd_scene *scene, double fov_rad);
/* Index into scene->species, or -1. */
int wd_scene_find_species(const struct wd_scene *scene, const char *name);

#endif
