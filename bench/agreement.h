/* agreement.h: how well the renderer's layers agree with the path tracer's where every tree is
 * drawn with its full mesh. */
#ifndef WD_BENCH_AGREEMENT_H
#define WD_BENCH_AGREEMENT_H

#include "weald/reference.h"

struct bench_agreement {
    uint32_t width, height;
    uint64_t inner_pixels;      /* those whose eight neighbours show the same tree, or ground, or sky */
    double id_pct;              /* of them: with the same tree in the renderer's picture */
    double normal_deg;          /* median angle between normals where the tree is the same */
    double albedo_pct;          /* mean albedo of tree pixels over the path tracer's, less 100 */
    double ground_albedo_pct;   /* the same of ground */
    double depth_mm;            /* median difference where the tree is the same */
};

/* Draws the scene's camera with both. The renderer is told to use full meshes at any distance and
 * the wind is still. False on failure, which has been logged. */
bool bench_agreement_measure(struct bench_agreement *agreement, const char *scene_path,
                             const char *camera, const char *gpu);

#endif
