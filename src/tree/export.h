/* export.h: trees as files for other programs: GLB (glTF 2.0) and OBJ. Pure CPU. */
#ifndef WD_TREE_EXPORT_H
#define WD_TREE_EXPORT_H

#include "scene/species.h"
#include "tree/mesh.h"

enum { WD_EXPORT_LEVELS = 4, WD_EXPORT_TEXTURE = 512 };

/* One standing instance: metres in a z-up frame near the origin. */
struct wd_export_instance {
    float position_m[3];
    float yaw_rad, across, up; /* turn about z; scales, `across` negative where mirrored in x */
    uint32_t id;
};

struct wd_export_tree {
    const char *name;
    const struct wd_species *species; /* trees with the same one share textures */
    const struct wd_tree_mesh *levels[WD_EXPORT_LEVELS]; /* from the full mesh on */
    uint32_t level_count;
    const struct wd_export_instance *instances; /* NULL: one, at `place_m` east */
    uint32_t instance_count;
    double place_m;
};

/* Ground to stand on: z up, triangles counter-clockwise from above. */
struct wd_export_ground {
    const float (*positions_m)[3], (*normals)[3];
    uint32_t vertex_count;
    const uint32_t *indices;
    uint32_t index_count;
    float color[3]; /* linear */
};

struct wd_export {
    const struct wd_export_tree *trees;
    uint32_t tree_count;
    const struct wd_export_ground *ground; /* NULL: none */
    double origin_m[3]; /* what the file's (0, 0, 0) is in the scene's own frame; kept in extras */
    const char *crs;    /* of origin_m, or NULL */
    const struct wd_progress *progress; /* of a GLB, stages "writing trees" and "writing the file"; or NULL */
};

/* glTF 2.0 binary: metres, y up; levels by MSFT_lod, instances by EXT_mesh_gpu_instancing; colour,
 * normal and roughness maps within as PNG. The file appears whole or not at all. Refuses what
 * needs more than 2 GiB, and trees with ids over 2^24, which _TREE_ID, a float, would not tell apart:
 * WD_ERROR_INPUT. Others are WD_ERROR_OUTPUT, WD_ERROR_MEMORY and WD_ERROR_INTERRUPTED. */
enum wd_result wd_export_glb(const struct wd_export *what, const char *path,
                             const struct wd_log *log);

/* The full meshes with NAME.mtl and NAME-SPECIES-*.png beside them; metres, y up. */
bool wd_export_obj(const struct wd_export *what, const char *path, const struct wd_log *log);

/* Files that wd_export_obj may write beside `path` for a species, from `index` 0 on; free() the name.
 * NULL: there are no more, or `path` is no .obj. */
char *wd_export_obj_beside(const char *path, const char *species, uint32_t index);

/* The maps of a layer (WD_LOOK_*) as PNG files in memory; free each. `normal` and `surface` may be
 * NULL. `*holes`: whether the colour's alpha cuts. False: no memory. */
struct wd_export_maps {
    uint8_t *color, *normal, *surface; /* surface: G roughness, B metal */
    size_t color_size, normal_size, surface_size;
    bool holes;
};
bool wd_export_maps_make(struct wd_export_maps *maps, const struct wd_species *species,
                         uint32_t layer, uint32_t size);
void wd_export_maps_finish(struct wd_export_maps *maps);

#endif
