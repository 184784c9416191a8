/* Reduced forms of a tree show as much of it, and as much light, as its full mesh. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../bench/bias.h"
#include "suite.h"

struct range {
    double least, most;
};

/* Ranges lie about what was measured, zero or not: coverage and light of forms against the path tracer's, where `traced`,
 * or against the drawn full mesh's. */
struct bound {
    const char *form;
    struct range coverage_pct, radiance_pct;
    bool traced;
    double most_error_pct; /* of single pixels, root mean square, beside the drawn mesh; 0: not asked */
};
enum { MOST_FORMS = 4 };
static const struct row {
    const char *species;
    int height; /* of bias_height_px */
    struct bound bounds[MOST_FORMS];
    bool clouds;
    bool level; /* seen by a standing eye, else from above */
} rows[] = {
    /* cards: +2.2 (+7.6 while they showed as much of the stem as from its own height); discs: +0.9 (-3.3 while their first triangles of wood were a small part of a stem with root lobes) */
    {"species/pine.json",
     2,
     {{"full", {-0.5, 2.5}, {-2, 1}, false},
      {"reduced", {-0.5, 2.5}, {-2.5, 1}, true},
      {"cards", {-1, 2}, {0, 4}, true},
      {"splats", {-2, 1}, {-1, 1.5}, true}}},
    /* discs have less of what is overhead than of the low sky: +10.6 otherwise, +3.8 */
    {"species/pine.json", 2, {{"splats", {-2, 1}, {2, 5.5}, true}}, true},
    /* plumes let as little through as blades: +13.3 otherwise, +0.1 */
    {"species/grass.json", 0, {{"full", {-1.5, 1.5}, {-1.5, 2}, true}}},
    /* tufts that stand free have their models' tables, and are as wide as they grew: -12.9 otherwise, +0.5 */
    {"species/grass.json", 2, {{"zfield", {-2, 1.5}, {-1.5, 2.5}, true}}},
    /* leaves scatter light to flowers, not flowers alone: +18.8 and +28.5 otherwise, +2.8 and +2.9. Flowers of reduced meshes
       are as large as lets them cover as much: +28 while all were scaled as leaves are, +11 */
    {"species/catalpa.json",
     1,
     {{"full", {-1, 1}, {0.5, 5.5}, true}, {"reduced", {-1.5, 1}, {8.5, 13.5}, true}, {"splats", {-2, 1}, {0.5, 5.5}, true}}},
    /* reduced meshes of shrubs are lit by their tables at 128 px, too: -13.9 by shadow maps, +1.4 */
    {"species/bramble.json", 1, {{"reduced", {-2, 0.5}, {-1, 4}, true}}},
    /* pictures of wide plants lie on their side: an error of 84.1 % if drawn upright, 74.9 mirrored, 72.7 */
    {"species/grass.json", 1, {{"cards", {-2, 1.5}, {-2, 1.5}, false, 73.8}}, .level = true},
    /* discs of wood show less of the white stem than they would: +8.3 otherwise. These two models have -7.7, and had -8.6
       before discs had less of what is overhead, when other pairs had -8.1, -4.0, -2.5 and +2.1, ten at once -3.0 (-2.2
       while feet were round, these two +0.9) */
    {"species/birch.json", 3, {{"splats", {-2, 2}, {-10.5, -6.5}, true}}},
    /* what shows leaves from above shows those that are the more open: +8.3 and +6.8 otherwise, -2.1 and -2.8 */
    {"species/spruce.json", 2, {{"views", {-1.5, 2}, {-3.5, -0.5}, true}, {"zfield", {2, 4}, {-4.5, -1}, true}}},
    /* as they fall leaves do not lie as their model has them (+48 otherwise, +19); far ones are not traced so */
    {"species/falling-leaves.json", 2, {{"reduced", {16, 22}, {-1, 4}, false}}},
    /* octants have colours of pictures taken level: +19.2 if of such as the eye would see, -0.1 */
    {"species/maple.json", 3, {{"octants", {-3, 0}, {-1.5, 2}, true}}},
};

/* One of bias_elevation_deg. */
static int view_of(const struct row *row)
{
    return row->level ? 0 : 1;
}

static const struct bias_form *form_named(const char *name)
{
    for (int i = 0; i < BIAS_FORMS; i++)
        if (strcmp(bias_forms[i].name, name) == 0)
            return &bias_forms[i];
    fail_msg("no form %s", name);
    return NULL;
}

static void take(struct wd_renderer *renderer, const struct bias_stand *stand, const char *form,
                 struct wd_forest **forest)
{
    *forest = bias_forest(stand, form_named(form));
    assert_non_null(*forest);
    assert_int_equal(wd_renderer_set_forest(renderer, *forest), WD_OK);
}

static void leave(struct wd_renderer *renderer, struct wd_forest **forest)
{
    wd_renderer_set_forest(renderer, NULL);
    wd_forest_destroy(forest);
}

static bool lies_in(double value, const struct range *range)
{
    return value > range->least && value < range->most;
}

static void measure_bound(struct wd_renderer *renderer, const struct bias_stand *stand, const struct row *row,
                          const struct bound *bound, const struct bias_shown *reference)
{
    struct wd_forest *forest;
    struct bias bias;
    take(renderer, stand, bound->form, &forest);
    assert_true(bias_measure(&bias, renderer, stand, row->height, view_of(row), reference));
    leave(renderer, &forest);
    print_message("%s, %s: coverage %+.1f%%, radiance %+.1f%%, error %.1f%%\n", row->species, bound->form,
                  bias.coverage_pct, bias.radiance_pct, bias.error_pct);
    assert_true(lies_in(bias.coverage_pct, &bound->coverage_pct));
    assert_true(lies_in(bias.radiance_pct, &bound->radiance_pct));
    assert_true(bound->most_error_pct == 0 || bias.error_pct < bound->most_error_pct);
}

static void trace_reference(struct bias_shown *traced, const struct bias_stand *stand, const struct row *row)
{
    struct wd_reference *tracer = NULL;
    struct wd_forest *forest = bias_forest(stand, form_named("reference"));
    assert_non_null(forest);
    assert_int_equal(wd_reference_create(&tracer, forest, &(struct wd_reference_params){0}), WD_OK);
    assert_true(bias_trace(traced, tracer, stand, row->height, view_of(row)));
    wd_reference_destroy(&tracer);
    wd_forest_destroy(&forest);
}

static void draw_reference(struct bias_shown *drawn, struct wd_renderer *renderer,
                           const struct bias_stand *stand, const struct row *row)
{
    struct wd_forest *forest;
    take(renderer, stand, "reference", &forest);
    assert_true(bias_show_reference(drawn, renderer, stand, row->height, view_of(row)));
    leave(renderer, &forest);
}

static void measure_row(struct wd_renderer *renderer, const struct row *row)
{
    struct bias_stand stand;
    struct bias_shown traced = {0}, drawn = {0};
    bool any_traced = false, any_drawn = false;
    for (int i = 0; i < MOST_FORMS && row->bounds[i].form; i++) {
        any_traced |= row->bounds[i].traced;
        any_drawn |= !row->bounds[i].traced;
    }
    assert_true(bias_stand_init(&stand, row->species, row->clouds));
    stand.quick = true;
    if (any_traced)
        trace_reference(&traced, &stand, row);
    if (any_drawn)
        draw_reference(&drawn, renderer, &stand, row);
    for (const struct bound *bound = row->bounds; bound < row->bounds + MOST_FORMS && bound->form; bound++)
        measure_bound(renderer, &stand, row, bound, bound->traced ? &traced : &drawn);
    free(drawn.luminance);
    bias_stand_finish(&stand);
}

static void forms_show_what_the_mesh_shows(void **state)
{
    (void)state;
    const struct wd_renderer_params params = {.gpu = "software"};
    struct wd_renderer *renderer = NULL;
    assert_int_equal(wd_renderer_create(&renderer, &params), WD_OK);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        measure_row(renderer, &rows[i]);
    wd_renderer_destroy(&renderer);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(forms_show_what_the_mesh_shows)};
    if (argc != 2 || chdir(argv[1]) != 0) {
        fputs("usage: test-bias SOURCE_ROOT\n", stderr);
        return 2;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
