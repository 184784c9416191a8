#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "bake/cards.h"
#include "base/memory.h"
#include "shared/hash.h"

static const uint64_t KEY = 0x0123456789abcdefull;
static const char FILE_NAME[] = "cards-0123456789abcdef.bin";

static int make_directory(void **state)
{
    char *directory = wd_strdup("/tmp/weald-test-XXXXXX");
    *state = directory;
    return mkdtemp(directory) ? 0 : -1;
}

static int remove_directory(void **state)
{
    char *file = wd_format("%s/%s", (char *)*state, FILE_NAME);
    unlink(file);
    free(file);
    int result = rmdir(*state);
    free(*state);
    return result;
}

static struct wd_cards some_cards(void)
{
    struct wd_cards cards = {.albedo = wd_alloc(wd_cards_bytes()),
                             .normal = wd_alloc(wd_cards_bytes()),
                             .half_width_m = 3.5f,
                             .half_depth_m = 3.25f,
                             .bottom_m = -0.3f,
                             .top_m = 21.0f};
    for (size_t i = 0; i < wd_cards_bytes(); i++) {
        cards.albedo[i] = (uint8_t)wd_hash1((uint32_t)i / 7);
        cards.normal[i] = (uint8_t)wd_hash1((uint32_t)i / 5 + 1);
    }
    return cards;
}

static void store(const char *directory)
{
    struct wd_cards cards = some_cards();
    wd_cards_store(&cards, directory, KEY, NULL);
    wd_cards_finish(&cards);
}

static void what_is_stored_is_loaded(void **state)
{
    struct wd_cards stored = some_cards(), loaded;
    wd_cards_store(&stored, *state, KEY, NULL);
    assert_true(wd_cards_load(&loaded, *state, KEY));
    assert_memory_equal(loaded.albedo, stored.albedo, wd_cards_bytes());
    assert_memory_equal(loaded.normal, stored.normal, wd_cards_bytes());
    assert_true(loaded.half_width_m == 3.5f && loaded.half_depth_m == 3.25f);
    assert_true(loaded.bottom_m == -0.3f && loaded.top_m == 21.0f);
    wd_cards_finish(&stored);
    wd_cards_finish(&loaded);
}

static void another_key_is_a_miss(void **state)
{
    struct wd_cards cards;
    store(*state);
    assert_false(wd_cards_load(&cards, *state, KEY + 1));
    assert_null(cards.albedo);
}

/* Cuts the file to `size` bytes, or flips one bit of byte `flip` where that is not negative. */
static void damage(const char *directory, long size, long flip)
{
    char *path = wd_format("%s/%s", directory, FILE_NAME);
    if (size >= 0)
        assert_int_equal(truncate(path, size), 0);
    if (flip >= 0) {
        FILE *file = fopen(path, "r+b");
        assert_non_null(file);
        fseek(file, flip, SEEK_SET);
        int byte = fgetc(file);
        fseek(file, flip, SEEK_SET);
        fputc(byte ^ 1, file);
        fclose(file);
    }
    free(path);
}

static void damaged_files_are_misses(void **state)
{
    static const long sizes[] = {0, 1, 8, 47, 48, 1000};
    static const long flips[] = {0, 8, 16, 24, 60, 4000};
    struct wd_cards cards;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        store(*state);
        damage(*state, sizes[i], -1);
        assert_false(wd_cards_load(&cards, *state, KEY));
    }
    for (size_t i = 0; i < sizeof flips / sizeof *flips; i++) {
        store(*state);
        damage(*state, -1, flips[i]);
        assert_false(wd_cards_load(&cards, *state, KEY));
    }
    store(*state);
    assert_true(wd_cards_load(&cards, *state, KEY));
    wd_cards_finish(&cards);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_is_stored_is_loaded, make_directory, remove_directory),
        cmocka_unit_test_setup_teardown(another_key_is_a_miss, make_directory, remove_directory),
        cmocka_unit_test_setup_teardown(damaged_files_are_misses, make_directory, remove_directory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
