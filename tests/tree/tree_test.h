/* tree_test.h: what the tests of src/tree have in common. */
#ifndef WD_TEST_TREE_TEST_H
#define WD_TEST_TREE_TEST_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tree/grow.h"

enum {
    SPECIES_COUNT = 17, /* all, but one camellia for the three colours */
    MANY_LEAVES = 5,    /* the first of them: large trees for statistics */
#ifdef TEST_SANITIZED
    SPECIES_STEP = 4, /* sanitizers look for what the code does, which some species show as well as all */
#else
    SPECIES_STEP = 1,
#endif
};
extern const char *const test_species_names[SPECIES_COUNT];

/* Loads species/NAME.json of the source tree; fails the test when that does not work. */
struct wd_species test_species(struct wd_arena *arena, const char *name);

/* Fails the test when nothing grows. wd_tree_model_finish it. */
struct wd_tree_model test_grow_tree(const struct wd_species *species, uint32_t seed,
                                    float height_m, float openness);

/* A log that keeps the last message. */
struct test_log {
    struct wd_log log;
    char message[1024];
    int count;
};
void test_log_init(struct test_log *log);

/* One side, of leaf triangles [first, first + count). */
double test_leaf_area(const struct wd_tree_mesh *mesh, uint32_t first, uint32_t count);
uint32_t test_leaf_triangles(const struct wd_tree_mesh *mesh);

#endif
