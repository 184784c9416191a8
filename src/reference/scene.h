/* scene.h: everything that rays can meet: the ground, and an instance of its model for every tree.
 * Rays run in the camera-relative frame of shared/frame.h. */
#ifndef WD_REFERENCE_SCENE_H
#define WD_REFERENCE_SCENE_H

#include "reference/ground.h"
#include "reference/models.h"
#include "reference/near.h"
#include "world/world.h"

struct wd_trace_scene {
    const struct wd_world *world;
    const struct wd_scene *scene;
    const struct wd_trace_models *models;
    const struct wd_frame_uniforms *frame; /* camera, light, wind and ground colours */
    struct wd_trace_ground ground;
    struct wd_trace_near near; /* trees in arm's reach */
    /* Ids: the tree's index; the ground's is world->tree_count; after it the twigs' of near.trees. */
    RTCScene top;
};

/* A place where a ray ends. */
struct wd_trace_hit {
    float at_m;          /* infinite: the sky */
    uint32_t tree;       /* index; world->tree_count for the ground */
    bool twig;           /* of the tree's twigs, not its model */
    uint32_t triangle;   /* of the model or the twigs, or of the ground */
    float u, v;          /* on the tree's triangle */
    struct wd_vec3 normal; /* of the ground's triangle */
};

/* Places every tree as it stands at frame->time_s: leaning in the wind, without flutter; leaves that
 * fall are where they have come to; leaves near the eye that are in view, or whose shadows are, are the twigs that they
 * stand for. Layers that show only in part at the tree's distance show that share of their trees. All arguments but
 * the view must outlive the result and must not move. */
bool wd_trace_scene_init(struct wd_trace_scene *scene, const struct wd_trace_models *models,
                         const struct wd_scene *description, const struct wd_world *world,
                         const struct wd_frame_uniforms *frame, const struct wd_trace_view *view,
                         const struct wd_log *log);
void wd_trace_scene_finish(struct wd_trace_scene *scene); /* accepts {0} */

/* What a hit's triangle is one of: a tree's model, or its twigs. Thread-safe. */
const struct wd_trace_model *wd_trace_hit_model(const struct wd_trace_scene *scene, const struct wd_trace_hit *hit);

struct wd_trace_ray {
    struct wd_vec3 from, direction; /* unit */
    float far_m;
};

/* The nearest hit; at_m infinite if there is none. Thread-safe. */
struct wd_trace_hit wd_trace_nearest(const struct wd_trace_scene *scene,
                                     const struct wd_trace_ray *ray);
/* Whether anything, or the ground alone, stands in the way. Thread-safe. */
bool wd_trace_blocked(const struct wd_trace_scene *scene, const struct wd_trace_ray *ray);
bool wd_trace_blocked_by_ground(const struct wd_trace_scene *scene, const struct wd_trace_ray *ray);

#endif
