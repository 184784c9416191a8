#include "scene/scene_parts.h"
#include "weald/forest.h"

#define SCENE(member) offsetof(struct wd_scene, member)
#define IN(group, member) (SCENE(group.member) - SCENE(group))
#define GROUP(title, keys, group) {title, keys, sizeof(((struct wd_scene *)0)->group), NULL}

static const char *const terrain_kinds[] = {"flat", "diamond-square", "raster", NULL};
static const char *const nodata_rules[] = {"fill", "cut", NULL};
static const char *const plantings[] = {"auto", "stored", "on_demand", NULL};
static const char *const shadow_maps[] = {"cascades", "perspective", NULL};
static const char *const sky_suns[] = {"file", "scene", NULL};
static const char *const raster_units[] = {"metres", NULL};

#define TERRAIN(member) offsetof(struct wd_scene_terrain, member)
static const struct wd_key terrain_keys[] = {
    {"kind", WD_KEY_ENUM, TERRAIN(kind), .fallback = "\"flat\"", .choices = terrain_kinds,
     .doc = "Flat ground, diamond-square fractal, or a raster file."},
    {"size_m", WD_KEY_VECTOR, TERRAIN(size_m), 0, 1e6, "[1000, 1000]",
     "flat, diamond-square: extent to the east and north, in metres; flat and 0, 0: fitted to the "
     "inventories.", .length = 2},
    {"cell_m", WD_KEY_DOUBLE, TERRAIN(cell_m), 0, 10000, "0",
     "raster, diamond-square: distance between samples in metres; 0: the raster's own, or 1024 samples a "
     "side. Flat ground has none to choose."},
    {"relief_m", WD_KEY_DOUBLE, TERRAIN(relief_m), 0, 12000, "200",
     "diamond-square: highest minus lowest, in metres."},
    {"roughness", WD_KEY_DOUBLE, TERRAIN(roughness), 0, 4, "0.9",
     "diamond-square: fall of the offsets by 2^-y a pass; low is rough, smooth from 0.8."},
    {"valley", WD_KEY_DOUBLE, TERRAIN(valley), 0, 1, "0",
     "diamond-square: 0 none, 1 a valley carved from south to north."},
    {"base_m", WD_KEY_DOUBLE, TERRAIN(base_m), -12000, 12000, "0",
     "Added to every height, in metres."},
    {"file", WD_KEY_STRING, TERRAIN(file), .doc = "raster: any GDAL raster, beside the scene."},
    {"crs", WD_KEY_STRING, TERRAIN(crs),
     .doc = "raster: coordinates to assume where the file has none, such as \"EPSG:4326\"."},
    {"target_crs", WD_KEY_STRING, TERRAIN(target_crs),
     .doc = "Coordinates in metres, of rasters to reproject to; by default the UTM zone for degrees "
            "and Mercator."},
    {"unit", WD_KEY_STRING, TERRAIN(unit), .choices = raster_units,
     .doc = "raster without coordinates: \"metres\" says that x and y are metres already."},
    {"band", WD_KEY_INTEGER, TERRAIN(band), 1, 10000, "1", "raster: band, from 1."},
    {"nodata", WD_KEY_DOUBLE, TERRAIN(nodata), .flags = WD_KEY_NAN_IF_ABSENT,
     .doc = "raster: value that means missing, besides the file's own."},
    {"nodata_rule", WD_KEY_ENUM, TERRAIN(nodata_rule), .fallback = "\"fill\"",
     .choices = nodata_rules, .doc = "raster: missing heights are filled, or cut out."},
    {"window_m", WD_KEY_NUMBERS, TERRAIN(window_m), -1e8, 1e8, .length = 4,
     .count_offset = TERRAIN(window_count),
     .doc = "raster: xmin, ymin, xmax, ymax in the target coordinates; all where absent."},
    {"vertical_scale", WD_KEY_DOUBLE, TERRAIN(vertical_scale), 0, 1000, "1",
     "raster: factor on every height.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {0},
};
static const struct wd_keys terrain_table = {
    "terrain", terrain_keys, sizeof(struct wd_scene_terrain), wd_scene_check_terrain};

#define TIME(member) offsetof(struct wd_scene_time, member)
static const struct wd_key time_keys[] = {
    {"date", WD_KEY_STRING, TIME(date),
     .doc = "Day as \"YYYY-MM-DD\": the season that leaves show, but those of artists' models; "
            "summer where absent."},
    {"clock", WD_KEY_STRING, TIME(clock),
     .doc = "Time of day as \"HH:MM\" or \"HH:MM:SS\": where the sun stands then. Needs date, "
            "latitude_deg and longitude_deg."},
    {"utc_offset_h", WD_KEY_DOUBLE, TIME(utc_offset_h), -14, 14,
     .doc = "What the clock is ahead of universal time, in hours; by default that of the "
            "longitude's zone, without summer time.", .flags = WD_KEY_NAN_IF_ABSENT},
    {"latitude_deg", WD_KEY_DOUBLE, TIME(latitude_deg), -90, 90, .doc = "North, in degrees.",
     .flags = WD_KEY_NAN_IF_ABSENT},
    {"longitude_deg", WD_KEY_DOUBLE, TIME(longitude_deg), -180, 180, .doc = "East, in degrees.",
     .flags = WD_KEY_NAN_IF_ABSENT},
    {0},
};
static const struct wd_keys time_table = {"time", time_keys, sizeof(struct wd_scene_time),
                                          wd_scene_check_time};

static const struct wd_key sun_keys[] = {
    {"azimuth_deg", WD_KEY_DOUBLE, IN(sun, azimuth_deg), -360, 360,
     .doc = "Where the sun stands, clockwise from north, in degrees; 150 where neither it nor a "
            "clock is given.", .flags = WD_KEY_NAN_IF_ABSENT},
    {"elevation_deg", WD_KEY_DOUBLE, IN(sun, elevation_deg), -90, 90,
     .doc = "Height of the sun above the horizon in degrees; 35 where neither it nor a clock is "
            "given. Far below the horizon (-9.5) a full moon stands in its place, 35 degrees high on the other side.",
     .flags = WD_KEY_NAN_IF_ABSENT},
    {"angular_diameter_deg", WD_KEY_DOUBLE, IN(sun, angular_diameter_deg), 0, 20, "0.53",
     "Width of the sun's disc in degrees; softens shadows."},
    {"strength", WD_KEY_DOUBLE, IN(sun, strength), 0, 1000, "1", "1: the sun of a clear day."},
    {0},
};
static const struct wd_keys sun_table = GROUP("sun", sun_keys, sun);

static const struct wd_key sky_keys[] = {
    {"turbidity", WD_KEY_DOUBLE, IN(sky, turbidity), 1.5, 20, "2.5", "1.8 clear to 10 hazy."},
    {"cover", WD_KEY_DOUBLE, IN(sky, cover), 0, 1, "0", "Clouds: 0 clear, 1 overcast."},
    {"strength", WD_KEY_DOUBLE, IN(sky, strength), 0, 1000, "1", "Factor on the sky's light."},
    {"file", WD_KEY_STRING, IN(sky, file),
     .doc = "Environment map in place of the computed sky, beside the scene: OpenEXR by longitude "
            "and latitude, twice as wide as high, channels R, G, B in linear sRGB; zenith at the "
            "top, north in the middle, east to the right of it."},
    {"turn_deg", WD_KEY_DOUBLE, IN(sky, turn_deg), -360, 360, "0",
     "The map is turned clockwise by this, in degrees."},
    {"sun", WD_KEY_ENUM, IN(sky, sun), .fallback = "\"file\"", .choices = sky_suns,
     .doc = "With a map: \"file\": the sun is what is brightest in the map, taken out of it; "
            "\"scene\": the sun stands and shines as \"sun\" and \"time\" say, and the map stays "
            "as it is."},
    {0},
};
static const struct wd_keys sky_table = {"sky", sky_keys, sizeof(struct wd_scene_sky),
                                         wd_scene_check_sky};

static const struct wd_key fog_keys[] = {
    {"visibility_m", WD_KEY_DOUBLE, IN(fog, visibility_m), 1, 1e7, "30000",
     "Distance at which contrast falls to 2%, in metres. Where fog is thick it hides the sky and the sun."},
    {"height_m", WD_KEY_DOUBLE, IN(fog, height_m), 1, 1e6, "1200",
     "The haze thins by e over this height, in metres; the lower, the more of the sky shows through fog."},
    {"base_m", WD_KEY_DOUBLE, IN(fog, base_m), -12000, 12000, "0",
     "Height of full density above the world's zero, in metres."},
    {0},
};
static const struct wd_keys fog_table = GROUP("fog", fog_keys, fog);

static const struct wd_key wind_keys[] = {
    {"speed_mps", WD_KEY_DOUBLE, IN(wind, speed_mps), 0, 60, "3",
     "Mean speed at 10 m in metres a second."},
    {"direction_deg", WD_KEY_DOUBLE, IN(wind, direction_deg), -360, 360, "250",
     "Where the wind blows from, clockwise from north, in degrees."},
    {"gust", WD_KEY_DOUBLE, IN(wind, gust), 0, 2, "0.4", "Gusts as a share of the mean speed."},
    {0},
};
static const struct wd_keys wind_table = GROUP("wind", wind_keys, wind);

static const struct wd_key water_keys[] = {
    {"enabled", WD_KEY_BOOL, IN(water, enabled), .fallback = "false",
     .doc = "Whether there is water."},
    {"level_m", WD_KEY_DOUBLE, IN(water, level_m), -12000, 12000, "0",
     "Height of the water above the world's zero, in metres."},
    {"color", WD_KEY_COLOR, IN(water, color), .fallback = "[0.008, 0.02, 0.018]",
     .doc = "Colour of deep water (linear)."},
    {"map", WD_KEY_OBJECT, IN(water, map), .table = &wd_scene_map_keys,
     .doc = "Raster of rivers and lakes: each lies as high as its shores let it, a river falls with "
            "the terrain. With or without \"enabled\", which is about level_m."},
    {"depth_m", WD_KEY_DOUBLE, IN(water, depth_m), 0.1, 100, "1.5",
     "How deep beds of waters of the map are dug, in metres."},
    {"clarity_m", WD_KEY_DOUBLE, IN(water, clarity_m), 0, 100, "2.5",
     "Depth at which the ground fades by e, in metres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {0},
};
static const struct wd_keys water_table = GROUP("water", water_keys, water);

static const struct wd_key ground_keys[] = {
    {"grass", WD_KEY_COLOR, IN(ground, grass), .fallback = "[0.075, 0.105, 0.035]",
     .doc = "Colour of grass (linear albedo)."},
    {"soil", WD_KEY_COLOR, IN(ground, soil), .fallback = "[0.13, 0.095, 0.065]",
     .doc = "Colour of bare soil (linear albedo)."},
    {"rock", WD_KEY_COLOR, IN(ground, rock), .fallback = "[0.2, 0.19, 0.175]",
     .doc = "Colour of rock (linear albedo)."},
    {"litter", WD_KEY_COLOR, IN(ground, litter), .fallback = "[0.1, 0.07, 0.045]",
     .doc = "Colour of litter below trees (linear albedo)."},
    {"rock_slope_deg", WD_KEY_DOUBLE, IN(ground, rock_slope_deg), 0, 90, "40",
     "Slopes steeper than this show rock, in degrees.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"snow_line_m", WD_KEY_DOUBLE, IN(ground, snow_line_m), -12000, 12000, "0",
     "Snow lies above this height over the world's zero, in metres; 0: nowhere."},
    {"tree_line_m", WD_KEY_DOUBLE, IN(ground, tree_line_m), -12000, 12000, "0",
     "Grass thins above this height over the world's zero, in metres; 0: nowhere."},
    {"snow", WD_KEY_DOUBLE, IN(ground, snow), 0, 1, "0",
     "Share of level ground and of the upper sides of trees that lies under fresh snow."},
    {0},
};
static const struct wd_keys ground_table = GROUP("ground", ground_keys, ground);

static const struct wd_key lens_keys[] = {
    {"f_number", WD_KEY_DOUBLE, IN(lens, f_number), 0, 1000, "0",
     "Focal length over aperture of a lens for film of 36 x 24 mm: depth of field, drawn by the "
     "picture's samples; 0: all is sharp."},
    {"focus_m", WD_KEY_DOUBLE, IN(lens, focus_m), 0, 1e6, "20",
     "Distance along the view axis that is sharp, in metres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"shutter", WD_KEY_DOUBLE, IN(lens, shutter), 0, 1, "0",
     "Share of the time between a film's frames (of a still, before it) for which the shutter is open: motion "
     "blur, drawn by the picture's samples; 0.5 is usual."},
    {"bloom", WD_KEY_DOUBLE, IN(lens, bloom), 0, 0.5, "0",
     "Share of the light that the lens spreads about bright places."},
    {0},
};
static const struct wd_keys lens_table = GROUP("lens", lens_keys, lens);

static const struct wd_key quality_keys[] = {
    {"width", WD_KEY_INTEGER, IN(quality, width), 1, WD_MOST_SIZE_PX, "1280", "Width in pixels."},
    {"height", WD_KEY_INTEGER, IN(quality, height), 1, WD_MOST_SIZE_PX, "720", "Height in pixels."},
    {"samples", WD_KEY_INTEGER, IN(quality, samples), 1, 65536, "4", "Samples a pixel."},
    {"mesh_distance_m", WD_KEY_DOUBLE, IN(quality, mesh_distance_m), 0, 1e6, "40",
     "Full meshes are drawn nearer than this, in metres, for a tree of 20 m in a picture of 600 "
     "lines that is 60 degrees high, or smaller; in larger ones at the same size in pixels."},
    {"reduced_distance_m", WD_KEY_DOUBLE, IN(quality, reduced_distance_m), 0, 1e6, "140",
     "Reduced meshes are drawn nearer than this, in metres; for what trees and pictures, see "
     "mesh_distance_m."},
    {"blend", WD_KEY_DOUBLE, IN(quality, blend), 0, 0.9, "0.25",
     "Share of a distance over which levels blend."},
    {"leaf_px", WD_KEY_DOUBLE, IN(quality, leaf_px), 0, 100, "3",
     "Leaves of meshes that are shorter than this on screen thin out; of pictures of n samples, shorter "
     "than this over the root of n. 0: none do."},
    {"shadow_size", WD_KEY_INTEGER, IN(quality, shadow_size), 16, 16384, "2048",
     "Texels a side of a shadow cascade; of pictures of 4 samples and more twice as many, up to 2048."},
    {"shadow_distance_m", WD_KEY_DOUBLE, IN(quality, shadow_distance_m), 1, 1e6, "2500",
     "Shadows reach this far from the camera, in metres."},
    {"shadow_taps", WD_KEY_INTEGER, IN(quality, shadow_taps), 0, 64, "5",
     "Shadow look-ups a pixel, of pictures of 4 samples and more three times as many; 0: no shadows of trees."},
    {"shadow_maps", WD_KEY_ENUM, IN(quality, shadow_maps), .fallback = "\"cascades\"",
     .choices = shadow_maps,
     .doc = "\"cascades\": five maps, finer near the camera; \"perspective\": one, warped toward it, for "
            "comparison (continuum draws cascades all the same)."},
    {"exposure_ev", WD_KEY_DOUBLE, IN(quality, exposure_ev), -20, 20, "0",
     "Stops added to the automatic exposure."},
    {"terrain_error_px", WD_KEY_DOUBLE, IN(quality, terrain_error_px), 0, 100, "1.5",
     "Terrain may be off by this many pixels.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {0},
};
static const struct wd_keys quality_table = GROUP("quality", quality_keys, quality);

#define CLIP(member) offsetof(struct wd_scene_clip, member)
static const struct wd_key clip_keys[] = {
    {"box_m", WD_KEY_FLOATS, CLIP(box_m), 0.1, 50,
     .doc = "Width, depth and height of the box, in metres.", .length = 3},
    {"mesh", WD_KEY_STRING, CLIP(mesh),
     .doc = "In place of a box: a closed mesh in metres, y up (.obj, .gltf, .glb, .fbx, .dae), "
            "beside the scene; the middle of its bounds goes over the foot."},
    {0},
};
static const struct wd_keys clip_table = {"clip", clip_keys, sizeof(struct wd_scene_clip), NULL};

static const struct wd_key scene_keys[] = {
    {"name", WD_KEY_STRING, SCENE(name), .doc = "Title; the file's name where absent."},
    {"seed", WD_KEY_INTEGER, SCENE(seed), 0, 4294967295.0, "1",
     "The same seed makes the same world."},
    {"terrain", WD_KEY_OBJECT, SCENE(terrain), .table = &terrain_table, .doc = "The ground."},
    {"species", WD_KEY_STRING_MAP, SCENE(species_files), .count_offset = SCENE(species_file_count),
     .doc = "Names of species and their files, beside the scene, or what installed ones are called; others "
            "are looked for in species/ and ../species/ beside the scene, then among the installed ones."},
    {"clips", WD_KEY_MAP, SCENE(clips), .table = &clip_table, .count_offset = SCENE(clip_count),
     .doc = "Names of species whose individuals are cut to a box or a mesh, as plants of a hedge are. "
            "A name of its own in \"species\" keeps the same species' free trees apart."},
    {"openness", WD_KEY_NUMBER_MAP, SCENE(openness), 0, 1, .count_offset = SCENE(openness_count),
     .doc = "How openly a species' trees have grown: {\"oak\": 1} is as wide and low crowned as in a "
            "meadow, 0 as among close neighbours; without it 0.2, as in a stand. A name of its own in "
            "\"species\" keeps the same species' other trees apart."},
    {"when_young", WD_KEY_STRING_MAP, SCENE(when_young), .count_offset = SCENE(when_young_count),
     .doc = "What trees are that are lower than 0.45 of their species' typical height: {\"oak\": \"young oak\"} grows them "
            "as saplings; without it they are small grown trees. A name that \"species\" does not have is of the same file. "
            "Stored trees only."},
    {"in_the_open", WD_KEY_STRING_MAP, SCENE(in_the_open), .count_offset = SCENE(in_the_open_count),
     .doc = "What trees are that stand in the open, by those about them: {\"oak\": \"open oak\"} has oaks with light from "
            "the sides wide and low crowned, the others as in a stand. A name that \"species\" does not have is of the same "
            "file, with an openness of 0.8 where \"openness\" says no other; {\"oak\": \"edge oak\", \"edge oak\": "
            "\"open oak\"} goes in two steps. Stored trees only."},
    {"variants", WD_KEY_INTEGER, SCENE(variants), 1, 64, "5",
     "Individuals grown a species, from half grown to tall; or as low as they are planted where the scene has "
     "saplings of it alone, as under a name of their own in \"species\"."},
    {"layers", WD_KEY_LIST, SCENE(layers), .table = &wd_scene_layer_keys,
     .count_offset = SCENE(layer_count), .doc = "Trees placed by rule."},
    {"inventories", WD_KEY_LIST, SCENE(inventories), .table = &wd_scene_inventory_keys,
     .count_offset = SCENE(inventory_count), .doc = "Trees from tables."},
    {"planting", WD_KEY_ENUM, SCENE(planting), .fallback = "\"auto\"", .choices = plantings,
     .doc = "Trees of grid layers: stored one by one, or on demand, found again where the camera "
            "looks, so that any number takes no memory (method continuum only). auto: on demand "
            "from 4 million on."},
    {"time", WD_KEY_OBJECT, SCENE(time), .table = &time_table,
     .doc = "Date, time of day and place: season and sun."},
    {"sun", WD_KEY_OBJECT, SCENE(sun), .table = &sun_table, .doc = "Sun."},
    {"sky", WD_KEY_OBJECT, SCENE(sky), .table = &sky_table, .doc = "Sky."},
    {"fog", WD_KEY_OBJECT, SCENE(fog), .table = &fog_table, .doc = "Haze."},
    {"wind", WD_KEY_OBJECT, SCENE(wind), .table = &wind_table, .doc = "Wind."},
    {"water", WD_KEY_OBJECT, SCENE(water), .table = &water_table, .doc = "Water."},
    {"ground", WD_KEY_OBJECT, SCENE(ground), .table = &ground_table, .doc = "Look of the ground."},
    {"lens", WD_KEY_OBJECT, SCENE(lens), .table = &lens_table, .doc = "Lens and shutter."},
    {"cameras", WD_KEY_LIST, SCENE(cameras), .table = &wd_scene_camera_keys,
     .count_offset = SCENE(camera_count),
     .doc = "Points of view; without any, one is made that overlooks the scene."},
    {"paths", WD_KEY_LIST, SCENE(paths), .table = &wd_scene_path_keys,
     .count_offset = SCENE(path_count), .doc = "Camera paths for films."},
    {"method", WD_KEY_STRING, SCENE(method), .fallback = "\"continuum\"",
     .choices = wd_scene_method_names,
     .doc = "How trees are drawn."},
    {"methods", WD_KEY_OBJECT, SCENE(methods), .table = &wd_scene_method_keys,
     .doc = "Options of the methods, each by its name; see docs/methods.md."},
    {"quality", WD_KEY_OBJECT, SCENE(quality), .table = &quality_table,
     .doc = "Size of the picture and effort spent on it."},
    {0},
};
const struct wd_keys wd_scene_keys = {"scene", scene_keys, sizeof(struct wd_scene), wd_scene_check,
                                      .check_always = true};
