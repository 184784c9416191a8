#include "sheet_error.h"

#include <math.h>
#include <stdlib.h>

void cli_shown_finish(struct cli_shown *shown)
{
    free(shown->luminance);
    *shown = (struct cli_shown){0};
}

uint32_t cli_shown_zoom(uint32_t side)
{
    enum { MOST_ZOOM = 8, MOST_PIXELS = 2048 };
    uint32_t zoom = MOST_ZOOM;
    while (zoom > 1 && side * zoom > MOST_PIXELS)
        zoom /= 2;
    return zoom;
}

bool cli_shown_take(struct cli_shown *shown, const struct wd_picture *picture, uint32_t zoom)
{
    uint32_t side = picture->width / zoom;
    float share = 1.0f / (float)(zoom * zoom);
    *shown = (struct cli_shown){.side = side,
                                .luminance = calloc((size_t)side * side, sizeof(float))};
    if (!shown->luminance)
        return false;
    for (uint32_t y = 0; y < side * zoom; y++) {
        for (uint32_t x = 0; x < side * zoom; x++) {
            size_t at = (size_t)y * picture->width + x;
            const float *c = picture->color + 3 * at;
            float luminance = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
            if (!picture->tree_id[at])
                continue;
            shown->luminance[(size_t)(y / zoom) * side + x / zoom] += share * luminance;
            shown->pixels += 1;
            shown->radiance += (double)luminance;
        }
    }
    shown->radiance /= fmax(shown->pixels, 1);
    shown->pixels *= (double)share;
    return true;
}

struct cli_form_error cli_form_error_of(const struct cli_shown *form, const struct cli_shown *full)
{
    double squares = 0, shown = 0;
    for (size_t i = 0; i < (size_t)full->side * full->side; i++) {
        double off = (double)form->luminance[i] - (double)full->luminance[i];
        squares += off * off;
        shown += form->luminance[i] > 0 || full->luminance[i] > 0;
    }
    return (struct cli_form_error){
        .coverage_pct = 100 * (form->pixels / fmax(full->pixels, 1e-9) - 1),
        .radiance_pct = 100 * (form->radiance / fmax(full->radiance, 1e-12) - 1),
        .picture_pct = 100 * sqrt(squares / fmax(shown, 1)) / fmax(full->radiance, 1e-12),
    };
}
