/* made_scene.h: scenes of a few triangles, made by hand, for rays. */
#ifndef WD_TESTS_REFERENCE_MADE_SCENE_H
#define WD_TESTS_REFERENCE_MADE_SCENE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "reference/render.h"
#include "world/surroundings.h"

enum { MADE_TREES = 16 };

/* One model of quads and any number of trees of it, 1 m high and wide where they stand, on ground
 * of 2 x 2 samples that is all hole unless it is filled. */
struct made_scene {
    struct wd_scene scene;
    struct wd_world world;
    struct wd_trace_models models;
    struct wd_trace_model model;
    struct wd_trace_look look;
    struct wd_frame_uniforms frame;
    struct wd_trace_scene traced;
    struct wd_tracer tracer;
    struct wd_tree trees[MADE_TREES];
    uint8_t layers[MADE_TREES], holes[4];
    float heights[4];
};

/* Empty: no trees, a black sky, no sun, clear air; the camera stands at the origin. */
void made_scene_init(struct made_scene *made);
void made_scene_finish(struct made_scene *made);

/* Adds a quad to the model: corner, corner + a, corner + a + b, corner + b; `kind` as in struct
 * wd_tree_vertex. Its texture's upper side is that of a x b. */
void made_scene_add_quad(struct made_scene *made, struct wd_vec3 corner, struct wd_vec3 a,
                         struct wd_vec3 b, uint32_t kind);
void made_scene_add_tree(struct made_scene *made, float x_m, float y_m, float z_m);
/* All texels of all layers, sRGB bytes; `detail` is the alpha of the detail map. */
void made_scene_set_look(struct made_scene *made, uint8_t value, uint8_t detail);

/* Builds what rays meet; after it nothing may be added. */
void made_scene_build(struct made_scene *made);

/* Mean radiance along one direction. */
struct wd_vec3 made_scene_look(const struct made_scene *made, struct wd_vec3 direction,
                               uint32_t samples);

struct wd_vec3 made_sky_white(const struct wd_frame_uniforms *frame, struct wd_vec3 direction);
struct wd_vec3 made_sky_black(const struct wd_frame_uniforms *frame, struct wd_vec3 direction);

#endif
