/* crown_sky.h: what neighbours leave of the sky to the crowns of trees that are large in the picture, and crowns to the
 * ground about the eye; found on the device when they come near and kept (shared/crown_sky.h). Of stored trees; of those
 * planted on demand the canopy's field alone tells. */
#ifndef WD_FRAME_CROWN_SKY_H
#define WD_FRAME_CROWN_SKY_H

#include "forest/forest.h"
#include "frame/view.h"
#include "shared/crown_sky.h"

struct wd_crown_sky {
    struct wd_pipeline crowns, floor;
    struct wd_buffer table; /* the sets' heads, then their slots, then the ground */
    struct wd_crown_sky_slot {
        uint32_t record; /* of its tree, + 1; 0: free */
        uint64_t used;   /* the last update that asked for it */
    } *slots;
    struct wd_floor_sky_tile {
        int32_t column, row; /* counted from the world's corner */
        bool known;
    } tiles[WD_FLOOR_SKY_TILES * WD_FLOOR_SKY_TILES]; /* that the table holds */
    uint64_t updates;
    bool told; /* the table's heads say what slots hold */
};

bool wd_crown_sky_init(struct wd_crown_sky *sky, struct wd_gpu *gpu);
void wd_crown_sky_finish(struct wd_crown_sky *sky, struct wd_gpu *gpu); /* accepts {0} */

/* Finds what is not known yet of the trees in the view, and declares that compute shaders read the table. Where more
 * trees are that near than a set has slots, those that come last have none. */
void wd_crown_sky_update(struct wd_crown_sky *sky, struct wd_cmd *cmd, const struct wd_forest_device *forest,
                         const struct wd_view *view);
/* How far off the table tells what reaches the ground of the view; 0: it does not. */
float wd_crown_sky_floor_m(const struct wd_forest_device *forest, const struct wd_view *view);
/* The device never ran what was recorded: all is found anew. */
void wd_crown_sky_forget(struct wd_crown_sky *sky);
/* Forgets what is kept of a forest; no frame that uses it may be in flight. */
void wd_crown_sky_drop_forest(struct wd_crown_sky *sky, struct wd_gpu *gpu);

#endif
