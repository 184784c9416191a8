/* weald/tree.h: single trees, grown from a species or read from an artist's model. */
#ifndef WEALD_TREE_H
#define WEALD_TREE_H

#include "weald/forest.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One individual: meshes in metres, z up, the trunk's foot at (0, 0, 0). Pure CPU. */
struct wd_specimen;

/* Zeroes are a typical tree of the species in summer. Models take height_m (scaling them) only, any
 * other value is refused. */
struct wd_specimen_params {
    const char *source; /* required: a species ("oak": looked for in species/, ../species/, the tree that
                           the program and the library lie in, and among the installed
                           ones), a species file (.json) or a model (.obj, .gltf, .glb,
                           .fbx, .dae) */
    uint32_t seed;      /* another seed, another individual */
    double height_m, dbh_m, age_years; /* at most two that do not contradict each other; 0: open */
    double openness;    /* 0 grown in a forest .. 1 in the open */
    double detail;      /* leaves and twigs relative to the species' own number; 0: 1 */
    const char *clip;   /* NULL; what a hedge plant is cut to, in place of a size: a box,
                           "1.2x0.6x1.8" (width, depth, height in metres), or a model file with a
                           closed mesh, in metres, y up, put on the ground over the foot */
    double month;       /* 1 the first of January .. 13 the last of December; 0: summer */
    struct wd_log log;
};

/* Grows or reads the tree. The same parameters give the same bytes on any machine.
 *   specimen  receives the new object, NULL on failure; destroy with wd_specimen_destroy
 * Errors: WD_ERROR_INPUT (no such species, a size that its file does not allow, a broken model; the
 * log names it). Thread-safe. Takes some 50 ms for a grown tree. */
enum wd_result wd_specimen_create(struct wd_specimen **specimen,
                                  const struct wd_specimen_params *params);
void wd_specimen_destroy(struct wd_specimen **specimen); /* accepts NULL and a pointer to NULL */

/* Names of the species that `source` may name here, one a line; free() it. */
char *wd_species_names(void);

struct wd_specimen_info {
    const char *name, *latin; /* live as long as the specimen */
    double height_m, crown_diameter_m, crown_base_m, dbh_m, age_years, leaf_area_m2;
    uint32_t level_count;
};
void wd_specimen_get_info(const struct wd_specimen *specimen, struct wd_specimen_info *info);

/* A level of detail: 0 the full mesh, then ever fewer triangles. */
struct wd_specimen_level {
    uint32_t vertices, wood_triangles, leaf_triangles;
};
/* False from level_count on. */
bool wd_specimen_get_level(const struct wd_specimen *specimen, uint32_t level,
                           struct wd_specimen_level *info);

/* Whether `path` can be written without loss of what the specimens were read from (species, models
 * with their materials and textures, clips), whatever links lead there; of an .obj also the files beside
 * it. Writing as a model asks this by itself. WD_ERROR_INPUT, logged, if not. */
enum wd_result wd_specimens_check_output(const struct wd_specimen *const *specimens, uint32_t count,
                                         const char *path);

/* Writes specimens (one at least), side by side in a row, as a whole or not at all.
 *   path  ".glb": every level of detail (MSFT_lod), textures within, metres, y up; ".obj": the full
 *         meshes, with NAME.mtl and NAME-*.png beside it
 * Errors: WD_ERROR_INPUT (another ending, more than a GLB can hold, a file that the specimens were read
 * from, no specimen), WD_ERROR_OUTPUT. */
enum wd_result wd_specimens_write(const struct wd_specimen *const *specimens, uint32_t count,
                                  const char *path, const struct wd_log *log);

/* A forest of nothing but these specimens (one at least), in a row on plain level ground under a clear sky, with
 * cameras "fit" (all of it in a frame of the given shape) and "eye" (a person's eye at the given
 * distance). The specimens must outlive the forest.
 *   aspect      width over height of the pictures to come, 1/16384 to 16384
 *   distance_m  of "eye", to 1e6; 0: that of "fit"
 * Errors: WD_ERROR_INPUT. */
enum wd_result wd_forest_create_specimens(struct wd_forest **forest,
                                          const struct wd_specimen *const *specimens,
                                          uint32_t count, double aspect, double distance_m,
                                          const struct wd_log *log);

/* Which form of its trees such a forest draws, whatever the distance. */
enum wd_specimen_form {
    WD_SPECIMEN_AS_SEEN, /* by distance, as in any scene */
    WD_SPECIMEN_FULL,
    WD_SPECIMEN_REDUCED,
    WD_SPECIMEN_CARDS,
};
/* Before wd_renderer_set_forest. */
void wd_forest_set_specimen_form(struct wd_forest *forest, enum wd_specimen_form form);

/* Writes a forest for other programs. As ".csv": a row for each tree: id as in the tree_id layer of
 * a picture, species, the trunk's foot in the terrain's own coordinates, height, crown diameter,
 * layer, and of an inventory's tree what its column for "id" calls it (tag), the file, the line in
 * it (row) and the stem diameter as measured (dbh_cm). As ".glb": each individual's meshes once
 * (MSFT_lod), its trees as instances (EXT_mesh_gpu_instancing, with tree ids), the ground as a mesh;
 * metres, y up, about the middle of the ground, whose true coordinates are in the scene's extras.
 *   max_trees  a forest with more is refused; 0: a million in a .glb, any number in a .csv
 * Errors: as wd_specimens_write; WD_ERROR_MEMORY, WD_ERROR_INTERRUPTED (nothing is written). */
enum wd_result wd_forest_write(const struct wd_forest *forest, const char *path, uint64_t max_trees,
                               const struct wd_progress *progress, const struct wd_log *log);

#ifdef __cplusplus
}
#endif
#endif
