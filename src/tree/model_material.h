/* model_material.h: what an artist's materials mean for a tree: wood or leaf, and their pictures. */
#ifndef WD_TREE_MODEL_MATERIAL_H
#define WD_TREE_MODEL_MATERIAL_H

#include "scene/species.h"
#include "tree/model_file.h"
#include "tree/model_image.h"

struct wd_model_picture {
    const char *texture, *cutout; /* as the material names them */
    struct wd_model_image image;
    float mean[3]; /* linear, of the texels that are no holes */
    bool holes;
};

struct wd_model_material {
    const struct wd_file_material *file;
    int picture;    /* index into pictures, -1: none */
    bool used;      /* by a triangle */
    bool leaf;
    float color[3]; /* linear multiplier of the picture, or the colour itself */
    float vertex_mean[3]; /* mean of the vertices' colours, which multiply it, too */
};

struct wd_model_materials {
    struct wd_model_material *items; /* parallel to the file's */
    size_t count;
    struct wd_model_picture *pictures;
    size_t picture_count, picture_capacity;
};

/* Loads the pictures of the used materials and tells leaves from wood: by the species' own lists,
 * else by holes in the texture, by words in the names of material and meshes, by two-sidedness, by
 * green. A picture that cannot be read is a warning, and the material's colour stands in.
 * Fails on a list that names a material that is not there. */
bool wd_model_materials_init(struct wd_model_materials *materials, const struct wd_model_file *file,
                             const struct wd_species *species, const struct wd_log *log);
void wd_model_materials_finish(struct wd_model_materials *materials);

#endif
