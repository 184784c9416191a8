#include "painters.h"

bool painters_init(struct painters *painters, const char *scene, const char *const *settings,
                   const char *gpu)
{
    const struct wd_forest_params forest = {.scene_path = scene, .settings = settings};
    const struct wd_renderer_params renderer = {.gpu = gpu};
    const struct wd_reference_params reference = {0};
    *painters = (struct painters){0};
    return wd_forest_create(&painters->forest, &forest) == WD_OK &&
           wd_renderer_create(&painters->renderer, &renderer) == WD_OK &&
           wd_renderer_set_forest(painters->renderer, painters->forest) == WD_OK &&
           wd_reference_create(&painters->reference, painters->forest, &reference) == WD_OK;
}

void painters_finish(struct painters *painters)
{
    wd_renderer_destroy(&painters->renderer);
    wd_reference_destroy(&painters->reference);
    wd_forest_destroy(&painters->forest);
}

bool painters_paint(const struct painters *painters, const struct wd_render_params *draw,
                    const struct wd_reference_picture_params *trace, struct wd_picture *drawn,
                    struct wd_picture *traced)
{
    return wd_renderer_render(painters->renderer, draw, drawn) == WD_OK &&
           wd_reference_render(painters->reference, trace, traced) == WD_OK;
}
