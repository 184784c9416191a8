#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "bake/cache.h"
#include "base/memory.h"
#include "shared/hash.h"

enum { BYTES = 200000 };
static const uint64_t KEY = 0x0123456789abcdefull;

struct fixture {
    char directory[64];
    struct wd_bake_cache cache;
    struct wd_log log;
    char messages[4096];
    int count;
};

static void remember(void *user, enum wd_log_level level, const char *message)
{
    struct fixture *f = user;
    (void)level;
    snprintf(f->messages, sizeof f->messages, "%s", message);
    f->count++;
}

static int setup(void **state)
{
    struct fixture *f = *state = wd_alloc(sizeof *f);
    strcpy(f->directory, "/tmp/weald-test-XXXXXX");
    f->log = (struct wd_log){remember, f};
    f->cache.directory = f->directory;
    f->cache.log = &f->log;
    return mkdtemp(f->directory) ? 0 : -1;
}

static int teardown(void **state)
{
    struct fixture *f = *state;
    char *command[] = {"rm", "-rf", f->directory, NULL};
    pid_t child = fork();
    if (child == 0)
        execvp(command[0], command);
    int status = -1;
    waitpid(child, &status, 0);
    free(f);
    return status;
}

static uint8_t *some_data(void)
{
    uint8_t *data = wd_alloc(BYTES);
    for (uint32_t i = 0; i < BYTES; i++)
        data[i] = (uint8_t)wd_hash1(i / 3);
    return data;
}

static void store(struct fixture *f, uint64_t key)
{
    uint8_t *data = some_data();
    wd_cache_store(&f->cache, "test", key, data, BYTES);
    free(data);
}

static bool holds(struct fixture *f, uint64_t key)
{
    size_t size;
    uint8_t *data = some_data(), *found = wd_cache_load(&f->cache, "test", key, BYTES, &size);
    bool same = found && size == BYTES && memcmp(found, data, BYTES) == 0;
    assert_true(same || !found); /* never something else */
    free(found);
    free(data);
    return same;
}

static char *path_of(const struct fixture *f, uint64_t key)
{
    return wd_format("%s/test-%016llx.bin", f->directory, (unsigned long long)key);
}

static void what_is_stored_is_loaded(void **state)
{
    struct fixture *f = *state;
    assert_false(holds(f, KEY));
    store(f, KEY);
    assert_true(holds(f, KEY));
    assert_int_equal(f->count, 0);
}

static void other_keys_and_kinds_are_misses(void **state)
{
    struct fixture *f = *state;
    size_t size;
    store(f, KEY);
    assert_false(holds(f, KEY + 1));
    assert_null(wd_cache_load(&f->cache, "other", KEY, BYTES, &size));
    char *from = path_of(f, KEY), *to = path_of(f, KEY + 2);
    assert_int_equal(rename(from, to), 0); /* a file that somebody renamed */
    assert_false(holds(f, KEY + 2));
    free(from);
    free(to);
}

static void keys_depend_on_every_byte(void **state)
{
    (void)state;
    uint64_t key = wd_cache_key(wd_cache_code_key(), "abc", 3);
    assert_true(key == wd_cache_key(wd_cache_code_key(), "abc", 3));
    assert_true(key != wd_cache_key(wd_cache_code_key(), "abd", 3));
    assert_true(key != wd_cache_key(wd_cache_code_key() + 1, "abc", 3)); /* other code */
}

/* Cuts the file to `size` bytes, or flips one bit of byte `flip`; negative: does not. */
static void damage(const struct fixture *f, long size, long flip)
{
    char *path = path_of(f, KEY);
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

static void damaged_files_are_misses_and_are_replaced(void **state)
{
    static const long sizes[] = {0, 1, 8, 31, 32, 1000}, flips[] = {0, 6, 8, 16, 23, 24, 60, 4000};
    struct fixture *f = *state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        store(f, KEY);
        damage(f, sizes[i], -1);
        assert_false(holds(f, KEY));
    }
    for (size_t i = 0; i < sizeof flips / sizeof *flips; i++) {
        store(f, KEY);
        damage(f, -1, flips[i]);
        assert_false(holds(f, KEY));
    }
    store(f, KEY);
    assert_true(holds(f, KEY));
    assert_int_equal(f->count, 0);
}

static void a_block_larger_than_expected_is_a_miss(void **state)
{
    struct fixture *f = *state;
    size_t size;
    store(f, KEY);
    assert_null(wd_cache_load(&f->cache, "test", KEY, BYTES - 1, &size));
    assert_int_equal(size, 0);
}

static void without_a_folder_nothing_happens(void **state)
{
    struct fixture *f = *state;
    f->cache.directory = "";
    store(f, KEY);
    assert_false(holds(f, KEY));
    f->cache.directory = NULL;
    store(f, KEY);
    assert_false(holds(f, KEY));
    assert_int_equal(f->count, 0);
}

/* A file where the folder should be: nobody, not even root, can write there. */
static void an_unwritable_folder_warns_once(void **state)
{
    struct fixture *f = *state;
    char *file = wd_format("%s/file", f->directory), *inside = wd_format("%s/cache", file);
    fclose(fopen(file, "w"));
    f->cache.directory = inside;
    store(f, KEY);
    store(f, KEY + 1);
    assert_int_equal(f->count, 1);
    assert_non_null(strstr(f->messages, "are not cached"));
    assert_non_null(strstr(f->messages, inside));
    assert_false(holds(f, KEY));
    free(file);
    free(inside);
}

/* A disk that is full, as a limit on the size of files: a warning, and no half file. */
static void a_full_disk_leaves_nothing(void **state)
{
    struct fixture *f = *state;
    struct rlimit before, small;
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    small = before;
    small.rlim_cur = 1000;
    setrlimit(RLIMIT_FSIZE, &small);
    store(f, KEY);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(f->count, 1);
    assert_false(holds(f, KEY));
    assert_int_equal(rmdir(f->directory), 0); /* it is empty */
    assert_int_equal(mkdir(f->directory, 0777), 0);
}

static void the_least_used_go_when_it_is_full(void **state)
{
    struct fixture *f = *state;
    char *first = path_of(f, 1);
    struct stat info;
    store(f, 1);
    assert_int_equal(stat(first, &info), 0);
    f->cache.max_bytes = (uint64_t)info.st_size * 3 + 100;
    for (uint64_t key = 2; key <= 3; key++)
        store(f, key);
    for (uint64_t key = 1; key <= 3; key++) { /* used long ago: 2 the longest */
        char *path = path_of(f, key);
        long ago = key == 2 ? 3000 : 2000;
        struct timespec times[2] = {{time(NULL) - ago, 0}, {time(NULL) - ago, 0}};
        assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
        free(path);
    }
    char *foreign = wd_format("%s/notes.txt", f->directory);
    fclose(fopen(foreign, "w"));
    assert_true(holds(f, 1)); /* and so is used now */
    store(f, 4);
    assert_false(holds(f, 2));
    assert_true(holds(f, 1) && holds(f, 3) && holds(f, 4));
    assert_int_equal(stat(foreign, &info), 0);
    free(foreign);
    free(first);
}

static void abandoned_temporary_files_go(void **state)
{
    struct fixture *f = *state;
    char *old = wd_format("%s/.99-test-0123456789abcdef.bin", f->directory);
    char *fresh = wd_format("%s/.98-test-0123456789abcdef.bin", f->directory);
    struct timespec times[2] = {{time(NULL) - 7200, 0}, {time(NULL) - 7200, 0}};
    struct stat info;
    fclose(fopen(old, "w"));
    fclose(fopen(fresh, "w"));
    assert_int_equal(utimensat(AT_FDCWD, old, times, 0), 0);
    store(f, KEY);
    assert_int_not_equal(stat(old, &info), 0);
    assert_int_equal(stat(fresh, &info), 0); /* somebody may be writing it */
    free(old);
    free(fresh);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_is_stored_is_loaded),
        TEST(other_keys_and_kinds_are_misses),
        TEST(keys_depend_on_every_byte),
        TEST(damaged_files_are_misses_and_are_replaced),
        TEST(a_block_larger_than_expected_is_a_miss),
        TEST(without_a_folder_nothing_happens),
        TEST(an_unwritable_folder_warns_once),
        TEST(a_full_disk_leaves_nothing),
        TEST(the_least_used_go_when_it_is_full),
        TEST(abandoned_temporary_files_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
