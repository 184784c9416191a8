#include "tree_test.h"

const char *const test_species_names[SPECIES_COUNT] = {
    "oak", "beech", "birch", "spruce", "pine", "maple", "willow", "catalpa", "camellia-red",
    "larch", "coconut", "angelique", "hazel", "bramble", "fern", "grass", "snag"};

struct wd_species test_species(struct wd_arena *arena, const char *name)
{
    struct wd_species species;
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.json", WD_TEST_SPECIES, name);
    assert_true(wd_species_load(&species, path, arena, NULL));
    return species;
}

static void keep_message(void *user, enum wd_log_level level, const char *message)
{
    struct test_log *log = user;
    (void)level;
    snprintf(log->message, sizeof log->message, "%s", message);
    log->count++;
}

void test_log_init(struct test_log *log)
{
    memset(log, 0, sizeof *log);
    log->log = (struct wd_log){keep_message, log};
}

uint32_t test_leaf_triangles(const struct wd_tree_mesh *mesh)
{
    return (mesh->index_count - mesh->wood_index_count) / 3;
}

static const float *corner(const struct wd_tree_mesh *mesh, uint32_t index)
{
    return mesh->vertices[mesh->indices[index]].position_m;
}

double test_leaf_area(const struct wd_tree_mesh *mesh, uint32_t first, uint32_t count)
{
    double area = 0;
    for (uint32_t t = 0; t < count; t++) {
        uint32_t at = mesh->wood_index_count + 3 * (first + t);
        const float *a = corner(mesh, at), *b = corner(mesh, at + 1), *c = corner(mesh, at + 2);
        double u[3], v[3];
        for (int i = 0; i < 3; i++) {
            u[i] = (double)b[i] - (double)a[i];
            v[i] = (double)c[i] - (double)a[i];
        }
        double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2];
        double z = u[0] * v[1] - u[1] * v[0];
        area += 0.5 * sqrt(x * x + y * y + z * z);
    }
    return area;
}

struct wd_tree_model test_grow_tree(const struct wd_species *species, uint32_t seed,
                                    float height_m, float openness)
{
    struct wd_tree_model model;
    struct wd_grow_params params = {.seed = seed, .height_m = height_m, .openness = openness};
    assert_true(wd_tree_grow(&model, species, &params, NULL));
    return model;
}
