/* What a specimen is cut to: a box by its size, or the closed mesh of a model file. */
#include <math.h>
#include <stdio.h>

#include "api/specimen.h"
#include "tree/clip.h"
#include "tree/model_file.h"

/* "1.2x0.6x1.8", and nothing after it. */
static bool parse_box(const char *text, float size_m[3])
{
    int end = 0;
    return sscanf(text, "%fx%fx%f%n", &size_m[0], &size_m[1], &size_m[2], &end) == 3 &&
           text[end] == 0;
}

static void widen(float low[3], float high[3], const float p[3])
{
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = fminf(low[axis], p[axis]);
        high[axis] = fmaxf(high[axis], p[axis]);
    }
}

/* Turned z up, and put over the foot. */
static void take_mesh(struct wd_specimen *specimen, const struct wd_model_file *file)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    float *positions = wd_arena_alloc(&specimen->arena, 3 * (size_t)file->vertex_count *
                                                            sizeof *positions + 1);
    uint32_t *indices = wd_arena_alloc(&specimen->arena,
                                       file->index_count * sizeof *indices + 1);
    for (uint32_t i = 0; i < file->vertex_count; i++) {
        const float *from = file->vertices[i].position;
        const float p[3] = {from[0], -from[2], from[1]};
        for (uint32_t axis = 0; axis < 3; axis++)
            positions[3 * i + axis] = p[axis];
        widen(low, high, p);
    }
    const float foot[3] = {0.5f * (low[0] + high[0]), 0.5f * (low[1] + high[1]), low[2]};
    for (uint32_t i = 0; i < 3 * file->vertex_count; i++)
        positions[i] -= foot[i % 3];
    for (uint32_t i = 0; i < file->index_count; i++)
        indices[i] = file->indices[i];
    specimen->clip = (struct wd_clip_volume){
        .positions_m = positions,
        .indices = indices,
        .vertex_count = file->vertex_count,
        .triangle_count = file->index_count / 3,
    };
}

bool wd_specimen_set_clip(struct wd_specimen *specimen, const char *clip)
{
    const struct wd_species *species = &specimen->species;
    float size_m[3];
    if (!clip)
        return true;
    if (species->model.file || species->order_count == 0)
        return wd_error(&specimen->log, "%s cannot be cut: %s; allowed are grown species with "
                                        "branches", species->name,
                        species->model.file ? "it is a model" : "it has no branches");
    specimen->params.clip = &specimen->clip;
    if (wd_species_is_model_file(clip)) {
        struct wd_model_file file;
        if (!wd_model_file_read(&file, clip, &specimen->log))
            return false;
        take_mesh(specimen, &file);
        wd_model_file_finish(&file);
        return true;
    }
    if (!parse_box(clip, size_m))
        return wd_error(&specimen->log, "found \"%s\" to cut %s to; allowed are "
                                        "WIDTHxDEPTHxHEIGHT in metres, as in 1.2x0.6x1.8, and model "
                                        "files (.obj, .gltf, .glb, .fbx, .dae)", clip,
                        species->name);
    specimen->clip = wd_clip_box(size_m);
    return true;
}
