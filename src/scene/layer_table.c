#include "scene/scene_parts.h"

_Static_assert(sizeof(struct wd_scene_share) == sizeof(struct wd_number_pair) &&
                   offsetof(struct wd_scene_share, share) == offsetof(struct wd_number_pair, value),
               "shares are read as pairs of a name and a number");

static const char *const placements[] = {"grid", "poisson", "canopy", NULL};
static const char *const outside_rules[] = {"drop", "keep", "error", NULL};
static const char *const dbh_units[] = {"cm", "mm", "dm", "m", "in", "ft", NULL};
static const char *const height_units[] = {"m", "dm", "cm", "mm", "ft", "in", NULL};

#define MAP(member) offsetof(struct wd_scene_map, member)
static const struct wd_key map_keys[] = {
    {"file", WD_KEY_STRING, MAP(file), .doc = "Any GDAL raster, beside the scene file."},
    {"crs", WD_KEY_STRING, MAP(crs),
     .doc = "Coordinates to assume where the file has none, such as \"EPSG:32611\"; \"local\": "
            "stretched over the terrain."},
    {"band", WD_KEY_INTEGER, MAP(band), 1, 10000, "1", "Band of the raster, from 1."},
    {"classes", WD_KEY_INTEGERS, MAP(classes), .count_offset = MAP(class_count),
     .doc = "Land cover: values of the raster where trees stand."},
    {"class_density", WD_KEY_NUMBERS, MAP(class_density), 0, 1,
     .count_offset = MAP(class_density_count),
     .doc = "Probability of each of the classes, in their order; 1 where it is not given."},
    {"value_range", WD_KEY_FLOATS, MAP(value_range), -1e30, 1e30, .length = 2,
     .doc = "Without classes: value at probability 0 and value at probability 1; may fall."},
    {0},
};
const struct wd_keys wd_scene_map_keys = {"map", map_keys, sizeof(struct wd_scene_map),
                                          wd_scene_check_map};

#define LAYER(member) offsetof(struct wd_scene_layer, member)
static const struct wd_key layer_keys[] = {
    {"name", WD_KEY_STRING, LAYER(name), .doc = "Name for messages and reports."},
    {"placement", WD_KEY_ENUM, LAYER(placement), .fallback = "\"grid\"", .choices = placements,
     .doc = "grid: one tree a jittered cell; poisson: a random number a square; canopy: one a "
            "top of a canopy-height raster, with that height."},
    {"species", WD_KEY_NUMBER_MAP, LAYER(species), 0, 1e9, .count_offset = LAYER(species_count),
     .doc = "Species and their shares: {\"oak\": 0.6, \"birch\": 0.4}, or one name.",
     .flags = WD_KEY_REQUIRED},
    {"spacing_m", WD_KEY_DOUBLE, LAYER(spacing_m), 0.1, 100000, "6",
     "grid: size of a cell; poisson: of a square; canopy: least distance; in metres."},
    {"jitter", WD_KEY_DOUBLE, LAYER(jitter), 0, 1, "0.9",
     "0: in the middle of its cell, 1: anywhere in it."},
    {"density", WD_KEY_DOUBLE, LAYER(density), 0, 10000, "1",
     "grid: probability that a cell is planted; poisson: mean number of trees a square."},
    {"map", WD_KEY_OBJECT, LAYER(map), .table = &wd_scene_map_keys,
     .doc = "Raster that gives the probability of trees."},
    {"canopy", WD_KEY_OBJECT, LAYER(canopy), .table = &wd_scene_map_keys,
     .doc = "Raster of canopy heights in metres."},
    {"slope_deg", WD_KEY_RANGE, LAYER(slope_deg), 0, 90, "[0, 42]",
     "Planted only on slopes between these, in degrees."},
    {"slope_fade_deg", WD_KEY_DOUBLE, LAYER(slope_fade_deg), 0, 90, "6",
     "Density falls over this span at either end of slope_deg, in degrees."},
    {"altitude_m", WD_KEY_VECTOR, LAYER(altitude_m), -12000, 12000, "[-12000, 12000]",
     "Planted only at heights between these, in metres.", .length = 2, .flags = WD_KEY_SORTED},
    {"altitude_fade_m", WD_KEY_DOUBLE, LAYER(altitude_fade_m), 0, 10000, "60",
     "Density falls over this span at either end of altitude_m, in metres."},
    {"patchiness", WD_KEY_DOUBLE, LAYER(patchiness), 0, 1, "0",
     "0: even; 1: groves and clearings."},
    {"patch_size_m", WD_KEY_DOUBLE, LAYER(patch_size_m), 0, 100000, "150",
     "Size of groves and clearings in metres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"height_m", WD_KEY_RANGE, LAYER(height_m), 0, 130, "[14, 28]",
     "Heights of trees of any species, drawn evenly between, in metres.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"aspect", WD_KEY_RANGE, LAYER(aspect), 0.1, 10, "[0.85, 1.15]",
     "Crown width over that of the species at the tree's height, drawn evenly between."},
    {"tint", WD_KEY_DOUBLE, LAYER(tint), 0, 1, "0.3", "Spread of colour between trees."},
    {"yaw_deg", WD_KEY_INTEGERS, LAYER(yaw_deg), -360, 360,
     .count_offset = LAYER(yaw_count),
     .doc = "Every tree is turned so many degrees, counter-clockwise from above: 0 lays the "
            "width of a clipped one from west to east. Without it each has an angle of its own."},
    {"fade_near_m", WD_KEY_VECTOR, LAYER(fade_near_m), 0, 1e6, "[0, 0]",
     "Trees are seen only beyond this span of distances and fade in over it, in metres.",
     .length = 2, .flags = WD_KEY_SORTED},
    {"fade_far_m", WD_KEY_VECTOR, LAYER(fade_far_m), 0, 1e6, "[0, 0]",
     "Trees fade out over this span of distances, in metres; 0, 0: never.",
     .length = 2, .flags = WD_KEY_SORTED},
    {"mesh_distance_m", WD_KEY_DOUBLE, LAYER(mesh_distance_m), 0, 1e6, "0",
     "Meshes are drawn nearer than this, in metres, in a picture of 600 lines that is 60 degrees "
     "high, whatever the tree's height; 0: as the quality says."},
    {0},
};
const struct wd_keys wd_scene_layer_keys = {"layer", layer_keys, sizeof(struct wd_scene_layer),
                                            wd_scene_check_layer};

#define INVENTORY(member) offsetof(struct wd_scene_inventory, member)
#define COLUMN(member) (INVENTORY(columns.member) - INVENTORY(columns))
static const struct wd_key column_keys[] = {
    {"x", WD_KEY_STRING, COLUMN(x), .doc = "Column of the position to the east."},
    {"y", WD_KEY_STRING, COLUMN(y), .doc = "Column of the position to the north."},
    {"species", WD_KEY_STRING, COLUMN(species), .doc = "Column of the species' name."},
    {"dbh", WD_KEY_STRING, COLUMN(dbh), .doc = "Column of the stem diameter at 1.3 m."},
    {"height", WD_KEY_STRING, COLUMN(height), .doc = "Column of the tree's height."},
    {"crown_diameter", WD_KEY_STRING, COLUMN(crown_diameter),
     .doc = "Column of the crown's diameter, in metres if its name has no unit."},
    {"id", WD_KEY_STRING, COLUMN(id), .doc = "Column of the tree's own number or name: rows of others are no "
     "duplicates, and lists of trees have it as tag."},
    {"status", WD_KEY_STRING, COLUMN(status), .doc = "Column that says which stems are dead."},
    {0},
};
static const struct wd_keys column_table = {
    "columns", column_keys, sizeof(((struct wd_scene_inventory *)0)->columns), NULL};

static const struct wd_key inventory_keys[] = {
    {"file", WD_KEY_STRING, INVENTORY(file), .doc = "CSV file with a header row, beside the scene.",
     .flags = WD_KEY_REQUIRED},
    {"delimiter", WD_KEY_STRING, INVENTORY(delimiter),
     .doc = "One character between columns; where absent that of a first line like sep=;, else found out from "
            "the header row."},
    {"columns", WD_KEY_OBJECT, INVENTORY(columns), .table = &column_table,
     .doc = "Names of the columns; found out from usual names where absent."},
    {"dbh_unit", WD_KEY_STRING, INVENTORY(dbh_unit), .choices = dbh_units,
     .doc = "Unit of the stem diameters; where absent what the column's name says, else cm."},
    {"height_unit", WD_KEY_STRING, INVENTORY(height_unit), .choices = height_units,
     .doc = "Unit of the heights; where absent what the column's name says, else m."},
    {"frame", WD_KEY_STRING, INVENTORY(frame), .fallback = "\"local\"",
     .doc = "\"local\": metres from the terrain's south-west corner; \"projected\": the terrain's "
            "own coordinates; or \"EPSG:n\"."},
    {"offset_m", WD_KEY_VECTOR, INVENTORY(offset_m), -1e8, 1e8, "[0, 0]",
     "Added to x and y, in metres: to the file's own, or, where its frame is in degrees or feet, once "
     "they are the terrain's coordinates.", .length = 2},
    {"rotate_deg", WD_KEY_DOUBLE, INVENTORY(rotate_deg), -360, 360, "0",
     "Local frame: turned counter-clockwise about its origin before the offset, in degrees."},
    {"species", WD_KEY_STRING_MAP, INVENTORY(species), .count_offset = INVENTORY(species_count),
     .doc = "Name in the file to name of the species; \"*\": any other."},
    {"dead", WD_KEY_STRINGS, INVENTORY(dead), .count_offset = INVENTORY(dead_count),
     .doc = "Values of the status column that mean a dead stem: left out and counted."},
    {"outside", WD_KEY_ENUM, INVENTORY(outside), .fallback = "\"drop\"", .choices = outside_rules,
     .doc = "Trees outside the terrain: dropped, kept, or an error."},
    {"height_m", WD_KEY_RANGE, INVENTORY(height_m), 0, 130, "[12, 25]",
     "Heights where the file gives neither height nor stem diameter, drawn evenly between.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {0},
};
const struct wd_keys wd_scene_inventory_keys = {
    "inventory", inventory_keys, sizeof(struct wd_scene_inventory), wd_scene_check_inventory};
