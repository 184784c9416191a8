#include "cli.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREES (180 / M_PI)

/* What a forester asks of a species' trees. */
struct stand {
    double stems_per_ha, mean_height_m, max_height_m, mean_crown_m;
};

/* Of worlds that are planted on demand so many cells are looked at. */
enum { SURVEYED = 200000 };

/* A row a species; free() it. */
static struct stand *survey(const struct wd_forest *forest, const struct wd_forest_info *info)
{
    struct stand *stands = calloc((size_t)info->species_count + 1, sizeof *stands);
    struct wd_tree_info tree;
    struct wd_species_info species;
    if (!stands)
        abort();
    uint32_t step = info->on_demand && info->last_id > SURVEYED ? info->last_id / SURVEYED : 1;
    for (uint64_t id = 1; id <= info->last_id; id += step) {
        if (!wd_forest_get_tree(forest, (uint32_t)id, &tree))
            continue;
        struct stand *stand = &stands[tree.species];
        stand->stems_per_ha += 1; /* until all are seen, sums */
        stand->mean_height_m += tree.height_m;
        stand->mean_crown_m += tree.crown_diameter_m;
        stand->max_height_m = fmax(stand->max_height_m, tree.height_m);
    }
    for (uint32_t i = 0; i < info->species_count; i++) {
        struct stand *stand = &stands[i];
        double count = fmax(stand->stems_per_ha, 1);
        stand->mean_height_m /= count;
        stand->mean_crown_m /= count;
        wd_forest_get_species(forest, i, &species);
        stand->stems_per_ha = (double)species.tree_count / info->terrain_ha;
    }
    return stands;
}

static void print_species(const struct wd_species_info *species, const struct stand *stand)
{
    printf("  %10llu  %s%s%s%s", (unsigned long long)species->tree_count, species->name,
           species->latin ? " (" : "", species->latin ? species->latin : "",
           species->latin ? ")" : "");
    if (species->tree_count > 0)
        printf(": %.3g/ha, %.1f m high (highest %.1f m), crowns of %.1f m", stand->stems_per_ha,
               stand->mean_height_m, stand->max_height_m, stand->mean_crown_m);
    putchar('\n');
}

static void print_trees(const struct wd_forest *forest, const struct wd_forest_info *info)
{
    printf("\ntrees       %llu in %u layers and %u inventories; stems a hectare of all ground, means of height and crown\n",
           (unsigned long long)info->tree_count, info->layer_count, info->inventory_count);
    struct stand *stands = survey(forest, info);
    struct wd_species_info species;
    for (uint32_t i = 0; wd_forest_get_species(forest, i, &species); i++)
        print_species(&species, &stands[i]);
    free(stands);
    struct wd_inventory_info inventory;
    for (uint32_t i = 0; wd_forest_get_inventory(forest, i, &inventory); i++)
        printf("inventory   %s: %llu rows, %llu planted, %llu dead, %llu duplicate, %llu outside, "
               "%llu without a position\n",
               inventory.file, (unsigned long long)inventory.rows,
               (unsigned long long)inventory.planted, (unsigned long long)inventory.dead,
               (unsigned long long)inventory.duplicates, (unsigned long long)inventory.outside,
               (unsigned long long)inventory.invalid);
}

static void print_cameras(const struct wd_forest *forest)
{
    const char *name;
    struct wd_camera camera;
    printf("\n");
    for (uint32_t i = 0; (name = wd_forest_camera_name(forest, i)); i++)
        if (wd_forest_get_camera(forest, name, &camera) == WD_OK)
            printf("camera      %s: at %.1f, %.1f, %.1f, %.0f° from north, %.0f° up\n", name,
                   camera.position_m[0], camera.position_m[1], camera.position_m[2],
                   camera.yaw_rad * DEGREES, camera.pitch_rad * DEGREES);
    double duration_s;
    for (uint32_t i = 0; (name = wd_forest_path_name(forest, i)); i++)
        if (wd_forest_get_path_camera(forest, name, 0, &camera, &duration_s) == WD_OK)
            printf("path        %s: %.1f s\n", name, duration_s);
}

static void print_devices(const char *devices)
{
    for (const char *line = devices; line && *line;) {
        int length = (int)strcspn(line, "\n");
        printf("device      %.*s\n", length, line);
        line += length + (line[length] == '\n');
    }
}

static void print_text(const struct wd_forest *forest, const struct wd_forest_info *info,
                       const struct wd_render_defaults *defaults, const char *devices)
{
    printf("scene       %s\n", info->name);
    printf("seed        %u, hash %016llx\n", info->seed, (unsigned long long)info->hash);
    printf("extent      %.1f x %.1f m, heights %.1f to %.1f m, ground sampled every %.2f m\n",
           info->max_m[0] - info->min_m[0], info->max_m[1] - info->min_m[1], info->min_m[2],
           info->max_m[2], info->terrain_cell_m);
    printf("origin      %.2f, %.2f%s\n", info->origin_m[0], info->origin_m[1],
           info->crs ? "" : " (no coordinate system)");
    if (info->crs)
        printf("crs         %.*s\n", (int)strcspn(info->crs, "\n"), info->crs);
    printf("octree      %u octants, %u levels\n", info->octant_count, info->octree_depth);
    printf("memory      %.2f MB for terrain, trees and octree\n", (double)info->host_bytes / 1e6);
    printf("picture     %ux%u, %u samples, method %s\n", defaults->width, defaults->height,
           defaults->samples, defaults->method);
    print_trees(forest, info);
    print_cameras(forest);
    print_devices(devices);
}

/* `text` as a JSON string, at most `length` bytes of it; NULL is null. */
static void json_string(const char *text, size_t length)
{
    if (!text) {
        printf("null");
        return;
    }
    putchar('"');
    for (; length && *text; length--, text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\')
            printf("\\%c", c);
        else if (c < 0x20)
            printf("\\u%04x", c);
        else
            putchar(c);
    }
    putchar('"');
}

static void json_text(const char *key, const char *text)
{
    printf("  \"%s\": ", key);
    json_string(text, SIZE_MAX);
    printf(",\n");
}

static void json_species(const struct wd_forest *forest, const struct wd_forest_info *info)
{
    struct stand *stands = survey(forest, info);
    struct wd_species_info species;
    printf("  \"species\": [");
    for (uint32_t i = 0; wd_forest_get_species(forest, i, &species); i++) {
        printf("%s\n    {\"name\": ", i ? "," : "");
        json_string(species.name, SIZE_MAX);
        printf(", \"latin\": ");
        json_string(species.latin, SIZE_MAX);
        printf(", \"tree_count\": %llu, \"stems_per_ha\": %.10g, \"mean_height_m\": %.10g, "
               "\"max_height_m\": %.10g, \"mean_crown_diameter_m\": %.10g}",
               (unsigned long long)species.tree_count, stands[i].stems_per_ha,
               stands[i].mean_height_m, stands[i].max_height_m, stands[i].mean_crown_m);
    }
    free(stands);
    printf("\n  ],\n");
}

static void json_inventories(const struct wd_forest *forest)
{
    struct wd_inventory_info inventory;
    printf("  \"inventories\": [");
    for (uint32_t i = 0; wd_forest_get_inventory(forest, i, &inventory); i++) {
        printf("%s\n    {\"file\": ", i ? "," : "");
        json_string(inventory.file, SIZE_MAX);
        printf(", \"rows\": %llu, \"planted\": %llu, \"dead\": %llu, \"duplicates\": %llu, "
               "\"outside\": %llu, \"without_position\": %llu}",
               (unsigned long long)inventory.rows, (unsigned long long)inventory.planted,
               (unsigned long long)inventory.dead, (unsigned long long)inventory.duplicates,
               (unsigned long long)inventory.outside, (unsigned long long)inventory.invalid);
    }
    printf("\n  ],\n");
}

static void json_cameras(const struct wd_forest *forest)
{
    const char *name;
    struct wd_camera camera;
    printf("  \"cameras\": [");
    for (uint32_t i = 0; (name = wd_forest_camera_name(forest, i)); i++) {
        if (wd_forest_get_camera(forest, name, &camera) != WD_OK)
            continue;
        printf("%s\n    {\"name\": ", i ? "," : "");
        json_string(name, SIZE_MAX);
        printf(", \"position_m\": [%.17g, %.17g, %.17g], \"yaw_deg\": %.10g, \"pitch_deg\": %.10g, "
               "\"fov_deg\": %.10g}",
               camera.position_m[0], camera.position_m[1], camera.position_m[2],
               camera.yaw_rad * DEGREES, camera.pitch_rad * DEGREES, camera.fov_rad * DEGREES);
    }
    printf("\n  ],\n  \"paths\": [");
    double duration_s;
    for (uint32_t i = 0; (name = wd_forest_path_name(forest, i)); i++) {
        if (wd_forest_get_path_camera(forest, name, 0, &camera, &duration_s) != WD_OK)
            continue;
        printf("%s\n    {\"name\": ", i ? "," : "");
        json_string(name, SIZE_MAX);
        printf(", \"duration_s\": %.10g}", duration_s);
    }
    printf("\n  ],\n");
}

static void json_devices(const char *devices)
{
    printf("  \"devices\": [");
    for (const char *line = devices; line && *line;) {
        size_t length = strcspn(line, "\n");
        printf("%s", line == devices ? "" : ", ");
        json_string(line, length);
        line += length + (line[length] == '\n');
    }
    printf("]\n");
}

static void print_json(const struct wd_forest *forest, const struct wd_forest_info *info,
                       const struct wd_render_defaults *defaults, const char *devices)
{
    printf("{\n");
    json_text("name", info->name);
    printf("  \"seed\": %u,\n  \"hash\": \"%016llx\",\n", info->seed,
           (unsigned long long)info->hash);
    printf("  \"tree_count\": %llu,\n  \"layer_count\": %u,\n",
           (unsigned long long)info->tree_count, info->layer_count);
    printf("  \"min_m\": [%.17g, %.17g, %.17g],\n  \"max_m\": [%.17g, %.17g, %.17g],\n",
           info->min_m[0], info->min_m[1], info->min_m[2], info->max_m[0], info->max_m[1],
           info->max_m[2]);
    printf("  \"origin_m\": [%.17g, %.17g],\n", info->origin_m[0], info->origin_m[1]);
    json_text("crs", info->crs);
    printf("  \"terrain_cell_m\": %.17g,\n  \"host_bytes\": %llu,\n", info->terrain_cell_m,
           (unsigned long long)info->host_bytes);
    printf("  \"octant_count\": %u,\n  \"octree_depth\": %u,\n", info->octant_count,
           info->octree_depth);
    printf("  \"width\": %u,\n  \"height\": %u,\n  \"samples\": %u,\n", defaults->width,
           defaults->height, defaults->samples);
    json_text("method", defaults->method);
    json_species(forest, info);
    json_inventories(forest);
    json_cameras(forest);
    json_devices(devices);
    printf("}\n");
}

enum cli_status cli_info(struct cli_session *session)
{
    struct wd_forest *forest = NULL;
    if (!cli_method_check(session))
        return CLI_USAGE;
    enum wd_result result = cli_forest_open(session, &forest);
    if (result != WD_OK)
        return cli_session_status(session, result);
    struct wd_forest_info info;
    struct wd_render_defaults defaults;
    wd_forest_get_info(forest, &info);
    wd_forest_get_render_defaults(forest, &defaults);
    if (session->options->method)
        defaults.method = session->options->method;
    char *devices = wd_device_list();
    cli_meter_clear(&session->meter);
    if (session->options->json)
        print_json(forest, &info, &defaults, devices);
    else
        print_text(forest, &info, &defaults, devices);
    free(devices);
    cli_forest_close(session, &forest);
    return CLI_OK;
}
