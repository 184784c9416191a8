/* The path tracer: does it see what the renderer draws, and how fast. */
#include "figures.h"

#include <stdio.h>

#include "agreement.h"

bool bench_reference_agreement(const char *gpu)
{
    struct bench_agreement a;
    if (!bench_agreement_measure(&a, "tests/api/small.json", "walk", gpu))
        return false;
    printf("full meshes, %u x %u, %llu pixels away from edges: normals %.2f degrees apart, depth "
           "%.2f mm (medians); mean albedo of trees %+.2f%%, of ground %+.2f%%\n",
           a.width, a.height, (unsigned long long)a.inner_pixels, a.normal_deg, a.depth_mm,
           a.albedo_pct, a.ground_albedo_pct);
    printf("reference-agreement-pct %.2f %%\n", a.id_pct);
    return true;
}

bool bench_reference_rays(const char *gpu)
{
    const struct wd_forest_params params = {.scene_path = "scenes/bench75k.json"};
    const struct wd_reference_params reference_params = {0};
    struct wd_reference_picture_params picture_params = {
        .width = 400, .height = 300, .samples = 4, .layers = WD_LAYER_COLOR};
    struct wd_forest *forest = NULL;
    struct wd_reference *reference = NULL;
    struct wd_picture picture = {0};
    struct wd_reference_stats stats;
    (void)gpu; /* rays run on the processor */
    bool ok = wd_forest_create(&forest, &params) == WD_OK &&
              wd_forest_get_camera(forest, "overview", &picture_params.camera) == WD_OK &&
              wd_reference_create(&reference, forest, &reference_params) == WD_OK &&
              wd_reference_render(reference, &picture_params, &picture) == WD_OK;
    if (ok) {
        wd_reference_get_stats(reference, &stats);
        printf("75,000 trees, 400 x 300, 4 samples: built in %.2f s, %.1f M rays in %.2f s\n",
               stats.build_s, (double)stats.rays * 1e-6, stats.trace_s);
        printf("reference-mrays-s %.2f Mrays/s\n", (double)stats.rays * 1e-6 / stats.trace_s);
    }
    wd_picture_finish(&picture);
    wd_reference_destroy(&reference);
    wd_forest_destroy(&forest);
    return ok;
}
