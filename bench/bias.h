/* bias.h: how far a reduced form of trees is from their full mesh, both drawn by the renderer, and from the truth. */
#ifndef WD_BENCH_BIAS_H
#define WD_BENCH_BIAS_H

#include "weald/reference.h"
#include "weald/renderer.h"

enum { BIAS_HEIGHTS = 4, BIAS_VIEWS = 2, BIAS_FORMS = 9 };
extern const int bias_height_px[BIAS_HEIGHTS];
extern const double bias_elevation_deg[BIAS_VIEWS];

struct bias_form {
    const char *name;
    const char *settings[9]; /* of the forest, NULL after the last */
    bool used[BIAS_HEIGHTS];                 /* drawn there by default */
};
extern const struct bias_form bias_forms[BIAS_FORMS]; /* the first is the reference */

/* A row of trees of one species, as a scene in a folder of its own. */
struct bias_stand {
    char folder[32], scene[64];
    double height_m, spacing_m;
    double width_m; /* of one tree, about */
    bool quick;     /* a fourth of the samples that what is compared with has else */
};

/* What trees show in a picture: pixels and radiance. */
struct bias_shown {
    double covered; /* pixels of the form's own size */
    double radiance; /* mean of covered pixels, luminance */
    float *luminance; /* a pixel, 0 where no tree is */
    uint32_t width, height;
};

struct bias {
    double coverage_pct, radiance_pct, error_pct;
};

/* Makes the scene of a species' file, under a clear sky or under clouds; false, with a message, on failure. */
bool bias_stand_init(struct bias_stand *stand, const char *species, bool clouds);
void bias_stand_finish(struct bias_stand *stand); /* removes the scene's files */

/* A forest of the stand in that form; NULL on failure. */
struct wd_forest *bias_forest(const struct bias_stand *stand, const struct bias_form *form);

/* `renderer` holds the stand as full meshes: 64 samples a pixel. Free `luminance`. */
bool bias_show_reference(struct bias_shown *sum, struct wd_renderer *renderer,
                         const struct bias_stand *stand, int height, int view);

/* The same trees by the path tracer, of a forest of full meshes: what they cover and their radiance, no luminance. */
bool bias_trace(struct bias_shown *sum, struct wd_reference *tracer, const struct bias_stand *stand,
                int height, int view);

/* `renderer` holds the stand in the form that is measured against the reference; without luminance in that the
 * picture's error is 0. */
bool bias_measure(struct bias *bias, struct wd_renderer *renderer, const struct bias_stand *stand,
                  int height, int view, const struct bias_shown *reference);

#endif
