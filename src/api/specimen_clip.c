/* What a specimen is cut to: a box by its size, or the closed mesh of a model file. */
#include <stdio.h>

#include "api/specimen.h"
#include "base/point_locale.h"
#include "tree/clip.h"

/* "1.2x0.6x1.8", and nothing after it. */
static bool parse_box(const char *text, float size_m[3])
{
    int end = 0;
    struct wd_point_locale point;
    wd_point_locale_enter(&point);
    int sizes = sscanf(text, "%fx%fx%f%n", &size_m[0], &size_m[1], &size_m[2], &end);
    wd_point_locale_leave(&point);
    return sizes == 3 && text[end] == 0;
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
        if (!wd_clip_mesh_read(&specimen->clip_mesh, clip, &specimen->log))
            return false;
        specimen->clip = specimen->clip_mesh.volume;
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
