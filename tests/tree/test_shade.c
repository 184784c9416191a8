/* The ellipsoid that stands for a crown's shade, beside the shade of the mesh. */
#include "tree_test.h"

#include "base/dmath.h"
#include "shared/sky_rings.h"
#include "tree/crown_shade.h"
#include "tree/silhouette.h"

enum { RINGS = WD_SKY_RINGS };
static const float sines[RINGS] = {WD_SKY_RING_SINES};

static struct wd_vec3 toward(int ring)
{
    return WD_V3(sqrtf(1 - sines[ring] * sines[ring]), 0, sines[ring]);
}

/* Area across the rays of a ring that the mesh covers. */
static double covered_m2(const struct wd_tree_mesh *mesh, int ring)
{
    struct wd_silhouette view;
    wd_silhouette_init(&view, mesh, toward(ring));
    wd_silhouette_cover(&view, 1, mesh, 0, mesh->index_count);
    return (double)wd_silhouette_count(&view) / ((double)view.scale * (double)view.scale);
}

/* And what the ellipsoid keeps of them from level ground. */
static double kept_m2(const struct wd_crown_shade *shade, const struct wd_tree_mesh *mesh, int ring)
{
    const double step_m = 0.2, tall_m = (double)mesh->max_m[2], wide_m = 3 * (double)shade->radius_m;
    const struct wd_vec3 ray = toward(ring);
    double slope = (double)(ray.x / ray.z), rise = (double)ray.z, sum = 0;
    for (double x = -wide_m - 2 * tall_m * slope; x < wide_m; x += step_m / rise)
        for (double y = -wide_m; y < wide_m; y += step_m)
            sum += 1 - wd_crown_shade_transmittance(shade, WD_V3((float)x, (float)y, 0), ray);
    return sum * step_m * step_m;
}

static const struct {
    const char *species;
    float height_m, openness;
} trees[] = {{"oak", 16, 1}, {"beech", 28, 0}, {"spruce", 24, 0.3f}, {"hazel", 3, 0.6f}, {"coconut", 12, 1}};

static void ellipsoids_hide_as_much_sky_as_crowns(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof trees / sizeof *trees; i++) {
        struct wd_arena arena = {0};
        struct wd_species species = test_species(&arena, trees[i].species);
        struct wd_tree_model model = test_grow_tree(&species, 2, trees[i].height_m, trees[i].openness);
        struct wd_crown_shade shade = wd_crown_shade_of(&model.full);
        for (int ring = 0; ring < RINGS - 1; ring++) { /* the last one's rays lie too low to be summed so */
            double ratio = kept_m2(&shade, &model.full, ring) / covered_m2(&model.full, ring);
            if (ratio < 0.9 || ratio > 1.1)
                fail_msg("%s, ring %d: the ellipsoid hides %.2f of what the crown does", trees[i].species, ring, ratio);
        }
        wd_tree_model_finish(&model);
        wd_arena_finish(&arena);
    }
}

/* Of the sky half a turn about, from more than halfway up: lower light comes in between ground and crown. */
static double sky_at(const struct wd_crown_shade *shade, float away_m)
{
    enum { SIDES = 8 };
    double sum = 0;
    for (int side = 0; side < SIDES; side++) {
        double turn = WD_PI * (side + 0.5) / SIDES;
        sum += wd_crown_shade_transmittance(shade, WD_V3(away_m, 0, 0.5f),
                                   WD_V3(0.6f * (float)wd_dcos(turn), 0.6f * (float)wd_dsin(turn), 0.8f));
    }
    return sum / SIDES;
}

static void shade_is_deepest_at_the_stem(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "oak");
    struct wd_tree_model model = test_grow_tree(&species, 1, 16, 1);
    struct wd_crown_shade shade = wd_crown_shade_of(&model.full);
    double stem = sky_at(&shade, 0), edge = sky_at(&shade, model.crown_radius_m);
    assert_true(stem < 0.4 && edge > 1.5 * stem && sky_at(&shade, 4 * model.crown_radius_m) > 0.9);
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
}

static void add_square(struct wd_tree_mesh *mesh, float half_m, float z_m)
{
    uint32_t first = mesh->vertex_count;
    for (int corner = 0; corner < 4; corner++)
        wd_tree_mesh_add_vertex(mesh, &(struct wd_tree_vertex){
            .position_m = {corner & 1 ? half_m : -half_m, corner & 2 ? half_m : -half_m, z_m}});
    wd_tree_mesh_add_triangle(mesh, first, first + 1, first + 2);
    wd_tree_mesh_add_triangle(mesh, first + 1, first + 3, first + 2);
}

static void degenerate_meshes_have_finite_shades(void **state)
{
    (void)state;
    struct wd_tree_mesh mesh = {0};
    wd_tree_mesh_update_bounds(&mesh);
    struct wd_crown_shade shade = wd_crown_shade_of(&mesh);
    assert_true(shade.per_m == 0 && shade.radius_m > 0 && shade.half_m > 0);
    add_square(&mesh, 2, 3);
    wd_tree_mesh_update_bounds(&mesh);
    shade = wd_crown_shade_of(&mesh);
    assert_true(isfinite(shade.per_m) && shade.per_m > 0 && shade.radius_m > 1 && shade.radius_m < 4);
    assert_true(fabsf(shade.middle_m - 3) < 1);
    wd_tree_mesh_finish(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ellipsoids_hide_as_much_sky_as_crowns),
        cmocka_unit_test(shade_is_deepest_at_the_stem),
        cmocka_unit_test(degenerate_meshes_have_finite_shades),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
