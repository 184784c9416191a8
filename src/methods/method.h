/* method.h: a method is only how trees get into the buffers; all else is shared. */
#ifndef WD_METHODS_METHOD_H
#define WD_METHODS_METHOD_H

#include "frame/passes/light.h"
#include "methods/tree_draw.h"

/* What `fill` has done of a view. */
enum wd_filled {
    WD_FILLED_NOT,  /* nothing: its targets are to be cleared, then drawn to */
    WD_FILLED,      /* all of the targets; `draw` adds to them */
    WD_FILLED_LAST, /* all there is: nothing is left to draw */
};

/* One way of drawing trees. Functions but `draw` may be NULL. For every view (the cascades of the
 * sun, where the frame is lit, then the camera) a frame calls `select`, then `draw`. */
struct wd_method {
    const char *name;
    bool on_demand;    /* draws worlds whose trees are planted on demand */
    bool cards;        /* draws trees as the forest's cards, in some view at least */
    /* Cascades that are calm (struct wd_cascade_box) are drawn without wind but its mean, as a function
     * of their box alone, and kept for later frames. */
    enum wd_cascade_use { WD_CASCADES_DRAWN, WD_CASCADES_KEPT } cascades;
    /* Whether the camera's view has the ground before trees are drawn; after them, what they hide of
     * it is not shaded. */
    enum wd_ground_order { WD_GROUND_FIRST, WD_GROUND_LAST } ground;
    bool eye_pictures; /* what it shows of trees besides meshes was pictured as the eye sees it; cards, level */
    bool stores_shadow; /* stores cascades' depth where targets can be stored to (wd_targets.stored_shadow) */
    bool single_leaves; /* each leaf in the camera's view says how it lies (shaders/lib/disc.glsl) */
    size_t state_size; /* bytes of what one renderer keeps for it; zeroed before `init` */
    /* Pipelines and the like. On failure `finish` is called all the same. */
    bool (*init)(void *state, struct wd_gpu *gpu);
    void (*finish)(void *state, struct wd_gpu *gpu);
    /* Makes (or bakes) what it needs of a forest, before the first frame that shows it; no frame is
     * being recorded. On failure `drop_forest` is called all the same. */
    bool (*use_forest)(void *state, struct wd_gpu *gpu, struct wd_forest_device *forest);
    void (*drop_forest)(void *state, struct wd_gpu *gpu);
    /* Outside of any rendering: chooses what `draw->view` shows, records compute and transfers. */
    void (*select)(void *state, const struct wd_tree_draw *draw);
    /* Outside of any rendering, after `select`: may fill the view's targets without one (of a method that draws before
     * the ground does). */
    enum wd_filled (*fill)(void *state, const struct wd_tree_draw *draw);
    /* Inside the open rendering of the view's targets: the G-buffer over the terrain that is there
     * already, or one cascade's depth. */
    void (*draw)(void *state, const struct wd_tree_draw *draw);
    /* Outside of any rendering, after `draw`. */
    void (*merge)(void *state, const struct wd_tree_draw *draw);
    /* Outside of any rendering, with the camera's depth complete: what it saw, for the next frame. */
    void (*keep)(void *state, const struct wd_tree_draw *draw);
    /* The newest frame was abandoned: nothing that `keep` or other functions left for later ones is there. */
    void (*forget)(void *state);
    /* With no frame in flight: discs that the newest view of the camera was drawn with. */
    uint64_t (*discs)(void *state, struct wd_gpu *gpu);
    /* With no frame in flight: warns of what newest frames could not hold. */
    void (*check)(void *state, struct wd_gpu *gpu);
    /* Of methods that blend, and only when pixels show light: outside of any rendering, with the
     * camera's G-buffer complete: draws lit trees into targets->overlay, all of it. */
    void (*blend)(void *state, const struct wd_tree_draw *draw,
                  const struct wd_light_inputs *light);
    /* Goes with `blend`: inside the open rendering of the G-buffer, after the light if there is any: the blended
     * trees for its layers. */
    void (*draw_layers)(void *state, const struct wd_tree_draw *draw);
};

extern const struct wd_method wd_method_separate; /* every tree by itself (row G9) */
extern const struct wd_method wd_method_octree;   /* static geometry in octree order (row G5) */
extern const struct wd_method wd_method_grid;     /* cells of a fixed grid (row G9) */
extern const struct wd_method wd_method_continuum; /* cost by pixels: splats in compute */
extern const struct wd_method wd_method_lod;      /* levels by distances of the user's (row O1) */
extern const struct wd_method wd_method_views;    /* pictures from all around (rows R3, R4, R6) */
extern const struct wd_method wd_method_zfield;   /* the same with their depths (row R6) */
extern const struct wd_method wd_method_patch;    /* blended back to front (rows I1-I9) */
extern const struct wd_method wd_method_dissolve; /* leaf and branch levels (rows W4-W7) */
extern const struct wd_method wd_method_impostor; /* six colours an octant (rows G2-G4) */

/* The method of that name, or NULL. Names are in wd_scene_method_names, scene/methods.h. */
const struct wd_method *wd_method_find(const char *name);

/* The state of a method for another that leaves a part of its views to it: one that keeps nothing of
 * a forest. NULL when it could not be made. */
void *wd_method_borrow(const struct wd_method *method, struct wd_gpu *gpu);
void wd_method_give_back(const struct wd_method *method, void **state, struct wd_gpu *gpu);

/* What one renderer keeps of the methods it has used. {0} is valid and holds none. */
enum { WD_METHODS_MAX = 16 };
struct wd_methods {
    struct wd_method_slot {
        const struct wd_method *method;
        void *state;
        struct wd_forest_device *forest; /* that the state is made for, or NULL */
    } slots[WD_METHODS_MAX];
    uint32_t count;
};

/* False, logged, where the method needs all trees in memory and some of the world are planted on demand. */
bool wd_method_can_draw(const struct wd_method *method, const struct wd_world *world,
                        const struct wd_log *log);

/* The state of `method`, made for `forest`; NULL when it could not be made (logged). No frame that
 * uses the method may be in flight when the forest is another one. */
void *wd_methods_open(struct wd_methods *methods, struct wd_gpu *gpu,
                      const struct wd_method *method, struct wd_forest_device *forest);
void wd_methods_drop_forest(struct wd_methods *methods, struct wd_gpu *gpu);
void wd_methods_forget(struct wd_methods *methods); /* after an abandoned frame */
void wd_methods_finish(struct wd_methods *methods, struct wd_gpu *gpu);

#endif
