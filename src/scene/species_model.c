/* Species that are an artist's model: their own files, and model files taken as they are. */
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/json_text.h"
#include "scene/species_parts.h"

#define FIELD(member) offsetof(struct wd_species, member)
#define IN(group, member) (offsetof(struct wd_species, group.member) - FIELD(group))
#define SIZE(group) sizeof(((struct wd_species *)0)->group)

static const char *const axes[] = {"auto", "x", "y", "z", NULL};
static const char *const units[] = {"auto", "m", "cm", "mm", "ft", "in", NULL};

static const struct wd_key model_keys[] = {
    {"file", WD_KEY_STRING, IN(model, file), .flags = WD_KEY_REQUIRED,
     .doc = "The model, beside this file: .obj, .gltf, .glb, .fbx or .dae."},
    {"height_m", WD_KEY_FLOAT, IN(model, height_m), 0, 130, "0",
     "Height it is brought to, in metres; 0: as the file has it."},
    {"up", WD_KEY_ENUM, IN(model, up), .fallback = "\"auto\"", .choices = axes,
     .doc = "The file's axis that points up; auto: y, unless the model plainly stands on z = 0."},
    {"unit", WD_KEY_ENUM, IN(model, unit), .fallback = "\"auto\"", .choices = units,
     .doc = "Unit of the file where height_m is 0; auto: metres, and centimetres where that would "
            "make a tree of over 130 m."},
    {"leaf_reflectance", WD_KEY_FLOAT, IN(model, leaf_reflectance), 0, 1, "0.09",
     "Leaf textures brighter than this on the average are brought down to it: pictures of leaves are "
     "mostly exposed, not measured. 1: as the file has them."},
    {"leaves", WD_KEY_STRINGS, IN(model, leaves), .count_offset = IN(model, leaf_count),
     .doc = "Materials that are leaves; others are told by name, holes and colour."},
    {"wood", WD_KEY_STRINGS, IN(model, wood), .count_offset = IN(model, wood_count),
     .doc = "Materials that are wood."},
    {0},
};
static const struct wd_keys model_table = {"model", model_keys, SIZE(model), NULL};

static const struct wd_key leaf_keys[] = {
    {"color", WD_KEY_COLOR, IN(leaf, color), .fallback = "[0.066, 0.111, 0.034]",
     .doc = "Colour that transmittance belongs to (linear albedo)."},
    {"transmittance", WD_KEY_COLOR, IN(leaf, transmittance), .fallback = "[0.06, 0.106, 0.012]",
     .doc = "Light let through by a leaf of that colour (linear)."},
    {"color_spread", WD_KEY_FLOAT, IN(leaf, color_spread), 0, 1, "0.2",
     "Spread of brightness and hue between trees."},
    {0},
};
static const struct wd_keys leaf_table = {"leaf", leaf_keys, SIZE(leaf), NULL};

#define ALLOMETRY(member) offsetof(struct wd_allometry, member)
static const struct wd_key allometry_keys[] = {
    {"height_a", WD_KEY_DOUBLE, ALLOMETRY(height_a), 0, 150, "45",
     "Height above diameter_at_m that the largest trees tend to, in metres.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"height_b", WD_KEY_DOUBLE, ALLOMETRY(height_b), 0, 2, "0.02",
     "Rate of h = diameter_at_m + a (1 - exp(-b d))^c, per centimetre of stem diameter.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"height_c", WD_KEY_DOUBLE, ALLOMETRY(height_c), 0, 10, "1",
     "Exponent of h = diameter_at_m + a (1 - exp(-b d))^c.", .flags = WD_KEY_EXCLUSIVE_MIN},
    {"crown_a", WD_KEY_DOUBLE, ALLOMETRY(crown_a), 0, 30, "0",
     "Crown diameter of the thinnest stems, in metres: w = a + b d^c."},
    {"crown_b", WD_KEY_DOUBLE, ALLOMETRY(crown_b), 0, 10, "0",
     "Growth of the crown's diameter with the stem's; 0: crowns keep the model's proportions."},
    {"crown_c", WD_KEY_DOUBLE, ALLOMETRY(crown_c), 0, 2, "1", "Exponent of w = a + b d^c.",
     .flags = WD_KEY_EXCLUSIVE_MIN},
    {"diameter_at_m", WD_KEY_DOUBLE, ALLOMETRY(diameter_at_m), 0, 1.3, "1.3",
     "Height above the ground where stem diameters are taken, in metres."},
    {"source", WD_KEY_STRING, ALLOMETRY(source), .doc = "Where the figures are from."},
    {0},
};
static const struct wd_keys allometry_table = {"allometry", allometry_keys,
                                               sizeof(struct wd_allometry), NULL};

static const struct wd_key species_keys[] = {
    {"name", WD_KEY_STRING, FIELD(name), .doc = "Short name, as scenes use it: \"maple\".",
     .flags = WD_KEY_REQUIRED},
    {"latin", WD_KEY_STRING, FIELD(latin), .fallback = "\"unknown\"",
     .doc = "Botanical name: \"Acer pseudoplatanus\"."},
    {"citation", WD_KEY_STRING, FIELD(citation), .doc = "Whose model this is, and its licence."},
    {"model", WD_KEY_OBJECT, FIELD(model), .table = &model_table,
     .doc = "The artist's model that every tree of the species is.", .flags = WD_KEY_REQUIRED},
    {"height_range_m", WD_KEY_RANGE, FIELD(height_range_m), 0.01, 130, "[0.01, 130]",
     "Heights that trees of this species may have, in metres."},
    {"leaf", WD_KEY_OBJECT, FIELD(leaf), .table = &leaf_table, .doc = "Light in leaves."},
    {"allometry", WD_KEY_OBJECT, FIELD(allometry), .table = &allometry_table,
     .doc = "Height and crown from stem diameter, for inventories."},
    {"flexibility", WD_KEY_FLOAT, FIELD(flexibility), 0, 0.3, "0.012",
     "Displacement of the top over the height in a wind of 10 m/s."},
    {0},
};

static bool check_species(void *object, const struct wd_keys_place *place)
{
    struct wd_species *species = object;
    struct wd_keys_place model = {place->reader, place, "model", 0};
    char *path = wd_path_beside(wd_keys_path(place), species->model.file);
    bool ok = wd_file_exists(path) ||
              wd_keys_error(&model, "file", "there is no file %.200s", path);
    species->model.file = wd_arena_strdup(wd_keys_arena(place), path);
    free(path);
    species->typical_height_m = species->model.height_m;
    return ok;
}

const struct wd_keys wd_species_model_keys = {"model species", species_keys,
                                              sizeof(struct wd_species), check_species};

bool wd_species_text_has_model(const char *path, const char *text, size_t size)
{
    char *json = wd_json_blank_comments(path, text, size, &wd_log_quiet);
    json_t *root = json ? json_loadb(json, strlen(json), JSON_REJECT_DUPLICATES, NULL) : NULL;
    bool found = json_object_get(root, "model") != NULL;
    json_decref(root);
    free(json);
    return found;
}

bool wd_species_is_model_file(const char *path)
{
    static const char *const endings[] = {".obj", ".gltf", ".glb", ".fbx", ".dae"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (wd_has_ending(path, endings[i]))
            return true;
    return false;
}

/* Every default of a model species, and the file's name without its ending. */
bool wd_species_of_model_file(struct wd_species *species, const char *path, struct wd_arena *arena,
                              const struct wd_log *log)
{
    static const char text[] = "{\"name\": \"model\", \"model\": {\"file\": \".\"}}";
    const char *slash = strrchr(path, '/');
    char *name = wd_arena_strdup(arena, slash ? slash + 1 : path);
    if (!wd_file_exists(path))
        return wd_error(log, "%s: there is no such file", path);
    if (!wd_keys_read(&wd_species_model_keys, path, text, sizeof text - 1, arena, log, species))
        return false;
    *strrchr(name, '.') = '\0';
    species->name = name;
    species->model.file = wd_arena_strdup(arena, path);
    return true;
}
