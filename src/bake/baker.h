/* baker.h: orthographic pictures of tree meshes, rasterised in compute: tree triangles are about a
 * sample large, where one thread a triangle beats the graphics pipeline. Depth, the farthest surface
 * and the sheets on a ray come out of the same pass. What a triangle of few samples shows is found once
 * a mesh, of others at each sample. Pictures of one device are the same each time. */
#ifndef WD_BAKE_BAKER_H
#define WD_BAKE_BAKER_H

#include "gpu/command.h"
#include "shared/bake.h"

/* Which of a mesh shows (W6: branches and leaves apart). */
enum wd_bake_parts { WD_BAKE_ALL, WD_BAKE_WOOD, WD_BAKE_LEAVES };

/* Whether the depth plane's front, back and leaves on the ray are wanted; its share of leaves always
 * comes. */
enum wd_bake_depths { WD_BAKE_DEPTHS, WD_BAKE_NO_DEPTHS };

/* A mesh on the device, and the look textures that its leaves and bark show. */
struct wd_bake_mesh {
    struct wd_buffer *vertices; /* struct wd_tree_vertex[]; both with texels of WD_BAKE_WORDS */
    struct wd_buffer *indices;  /* uint32_t[] */
    uint32_t index_count;
    uint32_t wood_index_count;  /* of index_count, these come first */
    struct wd_image *looks;
    uint32_t look_layer;        /* the first of WD_LOOK_LAYERS */
    uint32_t cut_out;           /* 1: the looks' alpha cuts holes (imported leaves) */
};
#define WD_BAKE_WORDS VK_FORMAT_R32_UINT

/* A form of the raster's pipeline; made when the first job needs it. */
enum wd_bake_raster {
    WD_BAKE_RASTER_IDENTITY = 1, /* never where 64-bit atomics find it in the first pass */
    WD_BAKE_RASTER_LARGE = 2,
    WD_BAKE_RASTER_DEPTHS = 4,
    WD_BAKE_RASTER_CUT_OUT = 8,
    WD_BAKE_RASTERS = 16,
};

struct wd_baker {
    struct wd_gpu *gpu;
    struct wd_frames frames;
    uint32_t passes;
    struct wd_pipeline raster[WD_BAKE_RASTERS], flat, resolve[2]; /* [depths] */
    VkSampler sampler;
    struct wd_buffer samples, rays, texels; /* of one batch; grow on demand */
    struct wd_buffer flats;                 /* of one job, likewise */
    struct wd_buffer list;                  /* of large triangles */
    const struct wd_log *log;
};
bool wd_baker_init(struct wd_baker *baker, struct wd_gpu *gpu, const struct wd_log *log);
void wd_baker_finish(struct wd_baker *baker); /* accepts {0} */

struct wd_bake_job {
    struct wd_bake_mesh mesh;
    enum wd_bake_parts parts;
    enum wd_bake_depths depths;
    const struct wd_bake_shot *shots; /* all of one size */
    uint32_t shot_count;
    uint32_t width, height; /* texels */
    uint32_t samples;       /* a texel, along each side; times width or height: at most
                               WD_BAKE_SIDE_MAX */
};
#define WD_BAKE_SIDE_MAX 1024

/* What a shot shows. */
struct wd_bake_picture {
    const uint8_t *planes; /* the finest mip: WD_PLANES images of width x height texels of 4 bytes (see
                              shared/view_set.h), one after the other */
    double leaves[4];      /* linear colour and openness of leaves, summed over texels by what of each they cover */
};

/* Calls `take` once for each shot, in any order and from several threads at once. */
bool wd_baker_run(struct wd_baker *baker, const struct wd_bake_job *job,
                  void (*take)(void *user, uint32_t shot, const struct wd_bake_picture *picture),
                  void *user);

#endif
