/* meshes.h: the meshes of a forest's models on the device: wood, and leaves as places and forms.
 *
 * A leaf costs 20 bytes, whatever its form. All leaves of a form are drawn with one list of 16-bit
 * indices, made of (leaf << corner_bits | corner): WD_LEAF_DRAW_VERTICES of them at once, the next
 * ones with a vertex offset. */
#ifndef WD_FOREST_MESHES_H
#define WD_FOREST_MESHES_H

#include "gpu/command.h"
#include "shared/forest.h"
#include "tree/grow.h"

#define WD_LEAF_DRAW_VERTICES 65536u

/* A set of leaves (tree/leaf_set.h). */
struct wd_leaf_draw {
    uint32_t first_leaf, leaf_count; /* of the model's leaves */
    uint32_t first_corner, corner_count, forms; /* in `corners`: form after form */
    uint32_t corner_bits;
    uint32_t first_index, index_count; /* 16-bit ones of the first leaf; as many follow for each */
    float own, arch_least, arch_range;
};

/* Where a mesh is in the common buffers. Its indices count from its own first vertex: the vertex
 * buffer is bound from there, since all of it may be more than a device binds at once. */
enum { WD_LEAF_STEPS = 6 };
struct wd_mesh_range {
    uint32_t first_vertex, vertex_count; /* first: a multiple of WD_MESH_ALIGNMENT */
    uint32_t first_index, index_count;   /* of index_type; of grown trees wood alone */
    uint32_t wood_index_count;           /* of index_count, these come first */
    VkIndexType index_type;
    struct wd_mesh_box box;
    struct wd_leaf_draw sets[WD_LEAF_SETS];
    uint32_t leaf_count; /* drawn leaves that thin out with distance, or 0: those that stand for
                            more than one */
    float leaf_m;        /* their mean length; of sprigs that of a leaf on them */
};
/* Elements; a multiple of every storage buffer alignment (256 bytes) that Vulkan allows. */
#define WD_MESH_ALIGNMENT 64

/* The leaves of one model, and the twig that each stands for. */
struct wd_twig_range {
    struct wd_mesh_range mesh;       /* index_count 0: they are single leaves */
    struct wd_mesh_range shade;      /* the same as shadow maps show it, and pixels that are as wide as its leaves */
    float shade_grain;               /* root of the mean area of a leaf of that, in units of the drawn leaf's length */
    uint32_t first_leaf, leaf_count; /* flowers included; first: a multiple of WD_MESH_ALIGNMENT */
    struct wd_leaf_box box;
    float reach;    /* of wd_spray_share; 0 without twigs */
    uint32_t forms; /* in either mesh, one after another; 0 without twigs */
};

struct wd_forest_meshes {
    struct wd_buffer vertices; /* struct wd_packed_vertex[] of all models and levels */
    struct wd_buffer indices;  /* uint16_t[], and uint32_t[] of large meshes */
    struct wd_buffer leaves;   /* struct wd_tree_leaf[] */
    struct wd_buffer corners;  /* struct wd_leaf_vertex[] */
    struct wd_mesh_range (*ranges)[2]; /* [model][WD_LEVEL_MESH, WD_LEVEL_REDUCED] */
    struct wd_twig_range *twigs;       /* [model] */
    struct wd_tree_leaf *host_leaves;  /* as `leaves` */
};

bool wd_forest_meshes_init(struct wd_forest_meshes *meshes, struct wd_gpu *gpu,
                           const struct wd_tree_model *models, uint32_t count);
void wd_forest_meshes_finish(struct wd_forest_meshes *meshes, struct wd_gpu *gpu);
/* Declares that the frame's passes read all of it. */
void wd_forest_meshes_use(struct wd_forest_meshes *meshes, struct wd_cmd *cmd);

#endif
