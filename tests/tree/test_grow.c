#include "tree_test.h"

#include "raster.h"

/* Runs `check` on a forest-grown, an open-grown, a young and a tall tree of every species. */
static void for_all(void (*check)(const struct wd_species *species,
                                  const struct wd_tree_model *model, float height_m))
{
    struct wd_arena arena = {0};
    for (int s = 0; s < SPECIES_COUNT; s++) {
        struct wd_species species = test_species(&arena, test_species_names[s]);
        float young = fminf(3, 0.4f * species.height_range_m[1]);
        const float cases[][2] = {{0, 0}, {0, 1}, {young, 0.5f}, {species.height_range_m[1], 0.2f},
                                  {species.height_range_m[0], 0}};
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            struct wd_tree_model model =
                test_grow_tree(&species, 3 + (uint32_t)i, cases[i][0], cases[i][1]);
            check(&species, &model, cases[i][0] > 0 ? cases[i][0] : species.typical_height_m);
            wd_tree_model_finish(&model);
        }
    }
    wd_arena_finish(&arena);
}

static void check_mesh(const struct wd_tree_mesh *mesh, bool leafy)
{
    assert_true(mesh->index_count % 3 == 0 && mesh->wood_index_count % 3 == 0);
    assert_true(mesh->wood_index_count > 0);
    assert_true(leafy == (mesh->wood_index_count < mesh->index_count));
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        assert_true(mesh->indices[i] < mesh->vertex_count);
        uint32_t leaf = mesh->vertices[mesh->indices[i]].kind & WD_VERTEX_LEAF;
        assert_int_equal(leaf != 0, i >= mesh->wood_index_count);
    }
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++) {
            float p = mesh->vertices[i].position_m[axis];
            assert_true(isfinite(p));
            assert_true(p >= mesh->min_m[axis] && p <= mesh->max_m[axis]);
        }
}

static void check_model(const struct wd_species *species, const struct wd_tree_model *model,
                        float height_m)
{
    bool leafy = species->leaf.count > 0;
    check_mesh(&model->full, leafy);
    check_mesh(&model->reduced, leafy);
    assert_float_equal(model->height_m / height_m, 1, 1e-4);
    assert_float_equal(model->full.max_m[2] / height_m, 1, 0.03);
    if (fabsf(model->reduced.max_m[2] / height_m - 1) > 0.06f)
        print_error("%s %g m: reduced %g m\n", species->name, (double)height_m,
                    (double)model->reduced.max_m[2]);
    assert_float_equal(model->reduced.max_m[2] / height_m, 1, 0.06);
    /* to where roots end on a slope of twenty degrees: those of a stem of a metre reach 1.25 m out */
    float deepest = fmaxf(0.375f * (species->buttress.count ? species->buttress.reach : 1.25f) * model->dbh_m, 0.4f);
    if (!(model->full.min_m[2] <= -0.0005f && model->full.min_m[2] >= -deepest))
        print_error("%s %g m: lowest %g m\n", species->name, (double)height_m,
                    (double)model->full.min_m[2]);
    assert_true(model->full.min_m[2] <= -0.0005f && model->full.min_m[2] >= -deepest);
    assert_true(!leafy || model->crown_radius_m > 0.02f * height_m);
    assert_true(model->crown_radius_m < 2 * height_m);
    assert_true(model->crown_base_m >= 0 && model->crown_base_m < height_m);
}

/* Where the plane at height z cuts a triangle of wood: from where its edge goes down to where one goes up. */
static bool cut_at(const struct wd_tree_mesh *mesh, uint32_t triangle, double z, double from[2], double to[2])
{
    int count = 0;
    for (uint32_t k = 0; k < 3; k++) {
        const float *a = mesh->vertices[mesh->indices[triangle + k]].position_m;
        const float *b = mesh->vertices[mesh->indices[triangle + (k + 1) % 3]].position_m;
        if (((double)a[2] < z) == ((double)b[2] < z))
            continue;
        double t = (z - (double)a[2]) / ((double)b[2] - (double)a[2]);
        double *cut = (double)a[2] < z ? to : from;
        for (int axis = 0; axis < 2; axis++)
            cut[axis] = (double)a[axis] + t * ((double)b[axis] - (double)a[axis]);
        count++;
    }
    return count == 2;
}

/* Diameter of the circle with the area that the plane at height z cuts from the wood around the
 * axis: the stem, not the branches that cross the plane elsewhere. Every triangle that the plane
 * cuts adds one side of the outline. */
static double diameter_at(const struct wd_tree_mesh *mesh, double z)
{
    double area = 0, from[2], to[2];
    for (uint32_t i = 0; i < mesh->wood_index_count; i += 3)
        if (cut_at(mesh, i, z, from, to))
            area += 0.5 * (from[0] * to[1] - from[1] * to[0]);
    return 2 * sqrt(fabs(area) / 3.14159265);
}

/* The stem is as thick as the allometry says, and as the model says, where diameters are taken. */
static void stems_are_as_thick_as_asked(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int s = 0; s < SPECIES_COUNT; s++)
        for (uint32_t seed = 1; seed <= 5; seed++) {
            struct wd_species species = test_species(&arena, test_species_names[s]);
            float height = species.typical_height_m * (0.6f + 0.1f * (float)seed);
            struct wd_grow_params params = {.seed = seed, .openness = 0.2f * (float)(seed - 1)};
            params.height_m = fminf(height, species.height_range_m[1]);
            struct wd_tree_model model =
                test_grow_tree(&species, seed, params.height_m, params.openness);
            assert_true(wd_grow_params_resolve(&params, &species, NULL));
            double at = species.allometry.diameter_at_m, wanted = (double)params.dbh_m;
            double found = (double)model.dbh_m;
            if (at > 0 && species.buttress.count == 0 && (double)model.crown_base_m > at)
                found = diameter_at(&model.full, at);
            if (fabs(found / wanted - 1) > 0.05)
                fail_msg("%s %g m: %g cm thick, wanted %g, said %g", species.name,
                         (double)params.height_m, 100 * found, 100 * wanted,
                         100 * (double)model.dbh_m);
            wd_tree_model_finish(&model);
        }
    wd_arena_finish(&arena);
}

static void models_are_sound(void **state)
{
    (void)state;
    for_all(check_model);
}

/* The middle of a wood triangle lies on the side of its branch that its vertices' normals say. */
static void check_winding(const struct wd_species *species, const struct wd_tree_model *model,
                          float height_m)
{
    const struct wd_tree_mesh *mesh = &model->full;
    uint32_t inward = 0;
    for (uint32_t i = 0; i < mesh->wood_index_count; i += 3) {
        const struct wd_tree_vertex *v[3];
        float normal[3], sum[3] = {0};
        for (uint32_t k = 0; k < 3; k++) {
            v[k] = &mesh->vertices[mesh->indices[i + k]];
            wd_unpack_normal(v[k]->normal, normal);
            for (int axis = 0; axis < 3; axis++)
                sum[axis] += normal[axis];
        }
        float a[3], b[3];
        for (int axis = 0; axis < 3; axis++) {
            a[axis] = v[1]->position_m[axis] - v[0]->position_m[axis];
            b[axis] = v[2]->position_m[axis] - v[0]->position_m[axis];
        }
        float face = sum[0] * (a[1] * b[2] - a[2] * b[1]) + sum[1] * (a[2] * b[0] - a[0] * b[2]) +
                     sum[2] * (a[0] * b[1] - a[1] * b[0]);
        inward += face < 0;
    }
    if (inward * 2000 > mesh->wood_index_count / 3)
        print_error("%s %g m: %u of %u inward\n", species->name, (double)height_m, inward,
                    mesh->wood_index_count / 3);
    assert_true(inward * 1000 <= mesh->wood_index_count / 3);
}

static void wood_faces_outward(void **state)
{
    (void)state;
    for_all(check_winding);
}

struct outline {
    double mean_m, least_m, most_m; /* radius around the stem's middle */
    int ridges;                     /* a tenth farther out than what lies between them */
};

enum { MOST_CUTS = 512 };

static int by_turn(const void *a, const void *b)
{
    const double *left = a, *right = b;
    return (left[0] > right[0]) - (left[0] < right[0]);
}

static int ridges_of(double places[][2], int count)
{
    int ridges = 0, most = 0;
    for (int i = 0; i < count; i++)
        most = places[i][1] > places[most][1] ? i : most;
    double high = places[most][1], low = high;
    bool down = false;
    for (int i = 1; i <= count; i++) { /* from the highest around to it again */
        double radius = places[(most + i) % count][1];
        low = fmin(low, radius);
        high = fmax(high, radius);
        if (!down && radius < high / 1.1) {
            ridges++;
            down = true;
            low = radius;
        } else if (down && radius > 1.1 * low) {
            down = false;
            high = radius;
        }
    }
    return ridges;
}

/* Below the crown. */
static struct outline outline_at(const struct wd_tree_mesh *mesh, double z)
{
    double middle[2] = {0}, length = 0, from[2], to[2], places[MOST_CUTS][2];
    struct outline outline = {.least_m = 1e9};
    int count = 0;
    for (uint32_t i = 0; i < mesh->wood_index_count; i += 3)
        if (cut_at(mesh, i, z, from, to)) {
            double side = hypot(to[0] - from[0], to[1] - from[1]);
            length += side;
            for (int axis = 0; axis < 2; axis++)
                middle[axis] += 0.5 * side * (from[axis] + to[axis]);
        }
    for (int axis = 0; axis < 2; axis++)
        middle[axis] /= length;
    double around = 0;
    for (uint32_t i = 0; i < mesh->wood_index_count; i += 3) {
        if (!cut_at(mesh, i, z, from, to))
            continue;
        for (int axis = 0; axis < 2; axis++) {
            from[axis] -= middle[axis];
            to[axis] -= middle[axis];
        }
        double one = hypot(from[0], from[1]), other = hypot(to[0], to[1]);
        double turn = fabs(atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]));
        outline.mean_m += 0.5 * turn * (one + other);
        around += turn;
        outline.least_m = fmin(outline.least_m, one);
        outline.most_m = fmax(outline.most_m, one);
        assert_true(count < MOST_CUTS);
        places[count][0] = atan2(from[1], from[0]);
        places[count++][1] = one;
    }
    outline.mean_m /= around;
    qsort(places, (size_t)count, sizeof *places, by_turn);
    outline.ridges = ridges_of(places, count);
    return outline;
}

static bool same_place(const struct wd_tree_vertex *a, const struct wd_tree_vertex *b)
{
    return memcmp(a->position_m, b->position_m, sizeof a->position_m) == 0;
}

/* Every edge of the foot between the heights has a triangle at either side, and each vertex is as square to its
 * triangles as such large ones allow. */
static void check_foot_surface(const struct wd_tree_mesh *mesh, float from_m, float to_m)
{
    uint32_t end = 0;
    while (end < mesh->wood_index_count && mesh->vertices[mesh->indices[end]].position_m[2] < 2 * to_m)
        end += 3;
    double sum = 0, worst = 0;
    int count = 0;
    for (uint32_t i = 0; i < end; i++) {
        const struct wd_tree_vertex *v = &mesh->vertices[mesh->indices[i]];
        const struct wd_tree_vertex *next = &mesh->vertices[mesh->indices[i / 3 * 3 + (i + 1) % 3]];
        if (v->position_m[2] < from_m || v->position_m[2] > to_m || next->position_m[2] < from_m)
            continue;
        double face[3] = {0};
        float normal[3];
        int beside = 0;
        for (uint32_t t = 0; t < end; t += 3) {
            const struct wd_tree_vertex *c[3];
            double a[3], b[3];
            bool meets = false;
            for (uint32_t k = 0; k < 3; k++)
                c[k] = &mesh->vertices[mesh->indices[t + k]];
            for (uint32_t k = 0; k < 3; k++) {
                meets |= same_place(c[k], v);
                beside += same_place(c[k], next) && same_place(c[(k + 1) % 3], v);
                a[k] = (double)(c[1]->position_m[k] - c[0]->position_m[k]);
                b[k] = (double)(c[2]->position_m[k] - c[0]->position_m[k]);
            }
            for (uint32_t k = 0; k < 3 && meets; k++)
                face[k] += a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        }
        assert_int_equal(beside, 1);
        wd_unpack_normal(v->normal, normal);
        double size = sqrt(face[0] * face[0] + face[1] * face[1] + face[2] * face[2]), dot = 0;
        for (int k = 0; k < 3; k++)
            dot += (double)normal[k] * face[k] / size;
        double off = acos(fmin(dot, 1)) * 57.29578;
        sum += off;
        worst = fmax(worst, off);
        count++;
    }
    print_message("  normals off by %.1f degrees, %.1f at most\n", sum / count, worst);
    assert_true(count > 100);
    assert_true(sum / count < 2.5 && worst < 9);
}

static void roots_run_out_from_old_stems(void **state)
{
    static const char *const names[] = {"beech", "oak", "maple", "spruce"};
    struct wd_arena arena = {0};
    (void)state;
    for (int i = 0; i < 4; i++)
        for (uint32_t seed = 1; seed <= 3; seed++) {
            struct wd_species species = test_species(&arena, names[i]);
            struct wd_grow_params params = {.seed = seed, .height_m = 30, .dbh_m = 0.6f};
            struct wd_tree_model model;
            assert_true(wd_tree_grow(&model, &species, &params, NULL));
            double dbh = (double)model.dbh_m;
            for (int level = 0; level < 2; level++) {
                const struct wd_tree_mesh *mesh = level ? &model.reduced : &model.full;
                struct outline ground = outline_at(mesh, 0.001), chest = outline_at(mesh, 1.3);
                struct outline above = outline_at(mesh, 2.4 * dbh);
                print_message("%s: %d ridges, %.2f to %.2f of the stem, %.2f on average, above %.3f\n", names[i],
                              ground.ridges, ground.least_m / chest.mean_m, ground.most_m / chest.mean_m,
                              ground.mean_m / chest.mean_m, above.most_m / above.least_m);
                assert_in_range(ground.ridges, level ? 2 : 3, 7);
                assert_true(ground.most_m > 1.35 * ground.least_m);
                assert_true(above.most_m < 1.15 * above.least_m);
                assert_float_equal(ground.mean_m / chest.mean_m / (double)species.root_flare, 1, 0.03);
            }
            check_foot_surface(&model.full, 0.03f * model.dbh_m, 2 * model.dbh_m); /* above what the ground hides */
            wd_tree_model_finish(&model);
        }
    wd_arena_finish(&arena);
}

static void saplings_and_palms_have_round_feet(void **state)
{
    static const struct {
        const char *name;
        float height_m;
    } cases[] = {{"beech", 3}, {"oak", 4}, {"coconut", 14}, {"spruce", 2}};
    struct wd_arena arena = {0};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct wd_species species = test_species(&arena, cases[i].name);
        struct wd_tree_model model = test_grow_tree(&species, 3, cases[i].height_m, 0);
        float least = 1e9f, most = 0;
        for (uint32_t k = 0; k < model.full.vertex_count; k++) {
            const float *p = model.full.vertices[k].position_m;
            if (fabsf(p[2]) > 1e-5f || model.full.vertices[k].kind & WD_VERTEX_LEAF)
                continue;
            least = fminf(least, hypotf(p[0], p[1]));
            most = fmaxf(most, hypotf(p[0], p[1]));
        }
        assert_true(most > 0 && most < 1.06f * least);
        wd_tree_model_finish(&model);
    }
    wd_arena_finish(&arena);
}

static void budgets_of_mature_trees_hold(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int s = 0; s < MANY_LEAVES; s++)
        for (int open = 0; open <= 1; open++) {
            struct wd_species species = test_species(&arena, test_species_names[s]);
            struct wd_tree_model model = test_grow_tree(&species, 11, 0, (float)open);
            uint32_t wood = model.full.wood_index_count / 3;
            uint32_t leaves = model.full.index_count / 3 - wood;
            /* most of wood open beeches, 25,425, of leaves spruces, 208,981 (11,000 shoots of 19
             * triangles: of 4,800 one was 63 cm long, a fan of palm leaves); least of forest pines
             * and birches: 5,879 and 55,898 */
            assert_in_range(wood, 5500, 26000);
            assert_in_range(leaves, 55000, 215000);
            /* 4,000 leaves of two and 1,600 of wood at most, and all but 8 of them (oak); least
             * open spruces, 5,685: 2,600 shoots and few branches */
            assert_in_range(model.reduced.index_count / 3, 5400, 9600);
            double radius = (double)model.crown_radius_m;
            double index = (double)model.leaf_area_m2 / (3.14159265 * radius * radius);
            double wanted = (double)species.leaf.area_index;
            double lit = open ? 1.3 : 1; /* from the side as well */
            assert_true(index > 0.75 * wanted && index < 1.3 * lit * wanted);
            wd_tree_model_finish(&model);
        }
    wd_arena_finish(&arena);
}

struct sample {
    double area, tint[4], normal[3], position[3];
};

static struct sample sample_leaves(const struct wd_tree_mesh *mesh, uint32_t count)
{
    struct sample sample = {0};
    for (uint32_t t = 0; t < count; t++) {
        double area = test_leaf_area(mesh, t, 1);
        const struct wd_tree_vertex *v =
            &mesh->vertices[mesh->indices[mesh->wood_index_count + 3 * t]];
        float normal[3];
        wd_unpack_normal(v->normal, normal);
        sample.area += area;
        for (int i = 0; i < 4; i++)
            sample.tint[i] += area * (double)(v->tint >> (8 * i) & 255) / 255;
        for (int i = 0; i < 3; i++) {
            sample.normal[i] += area * (double)normal[i];
            sample.position[i] += area * (double)v->position_m[i];
        }
    }
    for (int i = 0; i < 4; i++)
        sample.tint[i] /= sample.area;
    for (int i = 0; i < 3; i++) {
        sample.normal[i] /= sample.area;
        sample.position[i] /= sample.area;
    }
    return sample;
}

static void assert_alike(const struct sample *a, const struct sample *b, double crown_m,
                         double normal)
{
    for (int i = 0; i < 4; i++)
        assert_float_equal(a->tint[i], b->tint[i], 0.02);
    for (int i = 0; i < 3; i++) {
        assert_float_equal(a->normal[i], b->normal[i], normal);
        assert_float_equal(a->position[i], b->position[i], 0.06 * crown_m);
    }
}

static void check_prefix(const struct wd_species *species, const struct wd_tree_model *model,
                         float height_m)
{
    uint32_t all = test_leaf_triangles(&model->full), part = all / 4;
    if (height_m < 5 || species->leaf.count < 4000 || species->flower.count > 0)
        return; /* too few leaves for statistics; flowers come after leaves */
    struct sample whole = sample_leaves(&model->full, all);
    struct sample prefix = sample_leaves(&model->full, part);
    assert_float_equal(4 * prefix.area / whole.area, 1, 0.03);
    float half = 0.5f * (model->height_m - model->crown_base_m);
    assert_alike(&prefix, &whole, (double)fmaxf(model->crown_radius_m, half), 0.04);
}

static void any_prefix_of_leaves_is_fair(void **state)
{
    (void)state;
    for_all(check_prefix);
}

static double coverage(const struct wd_tree_mesh *mesh, float height_m, float azimuth_rad, float elevation_rad)
{
    enum { SIDE = 400 };
    struct wd_raster_view view = {0.5f * SIDE, 0.8f * SIDE, 0.6f * SIDE / height_m, azimuth_rad,
                                  elevation_rad};
    struct wd_raster raster;
    wd_raster_init(&raster, SIDE, SIDE);
    wd_raster_silhouette(&raster, mesh, &view);
    double share = wd_raster_coverage(&raster);
    wd_raster_finish(&raster);
    return share;
}

static void reduced_mesh_keeps_area_and_coverage(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int s = 0; s < MANY_LEAVES; s++)
        for (int open = 0; open <= 1; open++) {
            struct wd_species species = test_species(&arena, test_species_names[s]);
            struct wd_tree_model model = test_grow_tree(&species, 5, 0, 0.6f * (float)open);
            const struct wd_tree_mesh *full = &model.full, *reduced = &model.reduced;
            uint32_t full_count = test_leaf_triangles(full);
            uint32_t reduced_count = test_leaf_triangles(reduced);
            /* not all of the area: fewer, larger leaves overlap less */
            double ratio = test_leaf_area(reduced, 0, reduced_count) /
                           test_leaf_area(full, 0, full_count);
            assert_true(ratio > 0.5 && ratio < 1.1);
            struct sample a = sample_leaves(full, full_count);
            struct sample b = sample_leaves(reduced, reduced_count);
            assert_alike(&a, &b, 1.5 * (double)model.crown_radius_m, 0.07);
            for (int view = 0; view < 3; view++) {
                float azimuth = 2.1f * (float)view, up = view == 2 ? 0.9f : 0.05f;
                double one = coverage(full, model.height_m, azimuth, up);
                double two = coverage(reduced, model.height_m, azimuth, up);
                print_message("%s open %d view %d: reduced covers %+.1f%%\n",
                              test_species_names[s], open, view, 100 * (two / one - 1));
                /* of a spruce of a stand, whose crown is 4.3 m wide, reduced shoots stand out: 6.7 % */
                bool narrow = strcmp(test_species_names[s], "spruce") == 0 && !open;
                assert_float_equal(two / one, 1, narrow ? 0.07 : 0.055);
            }
            wd_tree_model_finish(&model);
        }
    wd_arena_finish(&arena);
}

static void absurd_parameters_are_refused(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "spruce");
    static const struct {
        struct wd_grow_params params;
        const char *say;
    } cases[] = {{{.height_m = 4000}, "4000 m"},       {{.height_m = -2}, "-2 m"},
                 {{.height_m = NAN}, "nan m"},         {{.openness = 2}, "openness 2"},
                 {{.openness = NAN}, "openness nan"},  {{.openness = -0.1f}, "openness -0.1"},
                 {{.detail = 1e9f}, "detail 1e+09"},   {{.detail = NAN}, "detail nan"},
                 {{.height_m = INFINITY}, "inf m"},    {{.dbh_m = -1}, "dbh_m -1"},
                 {{.dbh_m = NAN}, "dbh_m nan"},        {{.age_years = 9000}, "9000 years"},
                 {{.age_years = -1}, "-1 years"},      {{.age_years = NAN}, "nan years"},
                 {{.age_years = 50, .height_m = 9}, "one of the two"},
                 {{.dbh_m = 2, .height_m = 9}, "dbh_m 2"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct test_log log;
        struct wd_tree_model model;
        memset(&model, 0xaa, sizeof model);
        test_log_init(&log);
        assert_false(wd_tree_grow(&model, &species, &cases[i].params, &log.log));
        assert_int_equal(log.count, 1);
        assert_non_null(strstr(log.message, cases[i].say));
        assert_non_null(strstr(log.message, "spruce"));
        assert_null(model.full.vertices);
        wd_tree_model_finish(&model);
    }
    wd_arena_finish(&arena);
}

/* Age, stem and height name the same tree. */
static void size_follows_from_age_or_stem(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    for (int s = 0; s < SPECIES_COUNT; s++) {
        struct wd_species species = test_species(&arena, test_species_names[s]);
        struct wd_grow_params old = {.age_years = 0.3f * (float)species.growth.span_years},
                              again = {.age_years = 0.5f * old.age_years};
        assert_true(wd_grow_params_resolve(&old, &species, NULL));
        assert_true(wd_grow_params_resolve(&again, &species, NULL));
        assert_true(old.height_m > again.height_m && old.dbh_m > again.dbh_m);
        struct wd_grow_params stem = {.dbh_m = again.dbh_m}, tall = {.height_m = again.height_m};
        assert_true(wd_grow_params_resolve(&stem, &species, NULL));
        assert_true(wd_grow_params_resolve(&tall, &species, NULL));
        assert_float_equal(stem.height_m, again.height_m, 0.01);
        assert_float_equal(tall.age_years, again.age_years, 0.1);
        struct wd_grow_params both = {.dbh_m = 1.5f * again.dbh_m, .height_m = again.height_m};
        struct wd_tree_model model;
        assert_true(wd_tree_grow(&model, &species, &both, NULL));
        if (fabsf(model.dbh_m / both.dbh_m - 1) > 0.2f)
            print_error("%s: stem of %g m, not %g m\n", species.name, (double)model.dbh_m,
                        (double)both.dbh_m);
        assert_float_equal(model.dbh_m / both.dbh_m, 1, 0.2);
        wd_tree_model_finish(&model);
    }
    wd_arena_finish(&arena);
}

static uint32_t wood_triangles(const struct wd_tree_model *model)
{
    return model->full.wood_index_count / 3;
}

/* In winter the thinnest twigs are all that is left of a crown's outside; a snag has none. */
static void bare_crowns_have_twigs(void **state)
{
    (void)state;
    static const char *const names[] = {"oak", "larch", "hazel", "snag"};
    struct wd_arena arena = {0};
    for (int i = 0; i < 4; i++) {
        struct wd_species species = test_species(&arena, names[i]), winter;
        assert_true(wd_species_in_month(&winter, &species, 1.1, NULL));
        struct wd_tree_model leafy = test_grow_tree(&species, 2, 0, 0.5f);
        struct wd_tree_model bare = test_grow_tree(&winter, 2, 0, 0.5f);
        assert_int_equal(bare.leaf_count, 0);
        check_winding(&winter, &bare, bare.height_m);
        if (i < 3)
            assert_true(wood_triangles(&bare) > wood_triangles(&leafy) + 3000);
        else
            assert_int_equal(wood_triangles(&bare), wood_triangles(&leafy));
        wd_tree_model_finish(&leafy);
        wd_tree_model_finish(&bare);
    }
    wd_arena_finish(&arena);
}

static void too_many_branches_are_refused(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "oak");
    for (size_t i = 0; i < species.order_count; i++)
        species.orders[i].spacing_m = 0.001f;
    struct test_log log;
    struct wd_tree_model model;
    struct wd_grow_params params = {.seed = 1};
    test_log_init(&log);
    assert_false(wd_tree_grow(&model, &species, &params, &log.log));
    assert_int_equal(log.count, 1);
    assert_non_null(strstr(log.message, "species/oak.json: orders: "));
    assert_non_null(strstr(log.message, "branches"));
    assert_null(model.full.vertices);
    wd_arena_finish(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_are_sound),
        cmocka_unit_test(stems_are_as_thick_as_asked),
        cmocka_unit_test(wood_faces_outward),
        cmocka_unit_test(roots_run_out_from_old_stems),
        cmocka_unit_test(saplings_and_palms_have_round_feet),
        cmocka_unit_test(budgets_of_mature_trees_hold),
        cmocka_unit_test(any_prefix_of_leaves_is_fair),
        cmocka_unit_test(reduced_mesh_keeps_area_and_coverage),
        cmocka_unit_test(absurd_parameters_are_refused),
        cmocka_unit_test(size_follows_from_age_or_stem),
        cmocka_unit_test(bare_crowns_have_twigs),
        cmocka_unit_test(too_many_branches_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
