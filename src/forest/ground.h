/* ground.h: the terrain on the device, and a pyramid of its heights for culling. */
#ifndef WD_FOREST_GROUND_H
#define WD_FOREST_GROUND_H

#include "gpu/command.h"
#include "shared/terrain_patch.h"
#include "world/world.h"

struct wd_height_range {
    float min_m, max_m;
};

/* Level k has one entry a patch of WD_PATCH_CELLS << k cells, rows from the south. */
struct wd_ground_level {
    uint32_t columns, rows;
    struct wd_height_range *ranges;
    float error_m; /* how far the mesh of this level strays from the terrain at 95% of places */
};

struct wd_ground {
    const struct wd_terrain *terrain; /* must outlive this */
    struct wd_buffer heights;         /* float[width * height], metres above the world's zero */
    struct wd_buffer holes;           /* uint8_t[width * height] padded to 4; 4 bytes without holes */
    struct wd_buffer waters;          /* float[width * height]: terrain->water_m; 4 bytes without */
    struct wd_image slopes;           /* R16G16_SFLOAT, mips: rise over run eastward, northward */
    struct wd_image cover;            /* RGBA8, mips: of the canopy; its mean about; a quarter of the
                                         layers of the sward */
    VkSampler sampler;                /* trilinear, clamped, for both */
    uint32_t slopes_step;             /* samples from texel to texel of `slopes` */
    double cover_cell_m;
    struct wd_ground_level levels[WD_TERRAIN_LEVELS]; /* up to one patch that holds everything */
    uint32_t level_count;
};

/* Uploads `world`'s terrain and canopy cover; `world` must outlive the ground. */
bool wd_ground_init(struct wd_ground *ground, struct wd_gpu *gpu, const struct wd_world *world,
                    const struct wd_log *log);
void wd_ground_finish(struct wd_ground *ground, struct wd_gpu *gpu); /* accepts {0} */

/* Bounds of the heights in a rectangle of local metres: never narrower than the truth. */
struct wd_height_range wd_ground_range(const struct wd_ground *ground, const double min_m[2],
                                       const double max_m[2]);

/* Declares that shaders of this frame read the ground. */
void wd_ground_use(struct wd_ground *ground, struct wd_cmd *cmd);

#endif
