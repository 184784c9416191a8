/* models.h: the grown individuals of a scene with the textures of their bark and leaves, as rays
 * meet them. */
#ifndef WD_REFERENCE_MODELS_H
#define WD_REFERENCE_MODELS_H

#include <embree3/rtcore.h>

#include "shared/tree_pose.h"
#include "tree/variant.h"

/* Textures of one species: WD_LOOK_LAYERS maps as of tree/look_map.h. */
#define WD_TRACE_LOOK_SIZE 256
#define WD_TRACE_MAP_BYTES ((size_t)4 * WD_TRACE_LOOK_SIZE * WD_TRACE_LOOK_SIZE)
struct wd_trace_look {
    uint8_t *albedo, *detail; /* WD_LOOK_LAYERS * WD_TRACE_MAP_BYTES each, one after the other */
    bool has_holes;           /* texels of less than half alpha */
};

struct wd_trace_model {
    struct wd_tree_model grown; /* Embree reads the full mesh's vertices and indices in place */
    struct wd_model model;      /* sizes, flexibility, transmittance */
    const struct wd_trace_look *look;
    RTCScene scene;             /* of the full mesh alone */
};

struct wd_trace_models {
    struct wd_trace_model *models; /* [species * variants] */
    uint32_t count, variants;
    struct wd_trace_look *looks;   /* [species] */
    uint32_t species_count;
    RTCDevice device;
};

/* Fills a species' textures: all of their albedo, then all detail. Called by several threads. */
struct wd_trace_looks {
    void (*get)(void *user, const struct wd_species *species, uint8_t *albedo_detail);
    void *user;
};

/* Grows every individual and builds its scene. `scene` is read during the call only. */
bool wd_trace_models_init(struct wd_trace_models *models, RTCDevice device, const struct wd_scene *scene,
                          const struct wd_trace_looks *looks, unsigned threads, const struct wd_log *log);
void wd_trace_models_finish(struct wd_trace_models *models); /* accepts {0} */

/* A scene for rays that pass what a filter of their own tells them. */
RTCScene wd_trace_new_scene(RTCDevice device);

/* Whether its leaves stand for twigs, which are seen next to the eye (near.h). */
bool wd_trace_has_twigs(const struct wd_trace_model *model);

/* Builds the scene of a model whose mesh and look are set. */
void wd_trace_model_build(struct wd_trace_model *model, RTCDevice device);

/* The model of a tree. */
const struct wd_trace_model *wd_trace_model_of(const struct wd_trace_models *models,
                                               const struct wd_tree *tree);

/* A place on a triangle's textures. */
struct wd_trace_texel {
    float uv[2];
    uint32_t layer;   /* of the upper side */
    size_t offset;    /* of the texel in that layer, bytes */
};
/* At (1 - u - v, u, v) of the triangle's corners; textures repeat. */
struct wd_trace_texel wd_trace_texel_at(const struct wd_trace_model *model, uint32_t triangle,
                                        float u, float v);

/* 1 where textures run counter-clockwise seen from the side that the triangle's corners do, too,
 * -1 where they are mirrored. */
float wd_trace_uv_turn(const struct wd_trace_model *model, uint32_t triangle);

#endif
