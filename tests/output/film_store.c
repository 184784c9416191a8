#include "common.h"

#include "output/film_store.h"

enum { BYTES = 4000, FRAMES = 5 };
static const uint64_t KEY = 0x1234567890abcdefu;

static void make_frame(uint8_t frame[BYTES], unsigned number)
{
    for (unsigned i = 0; i < BYTES; i++)
        frame[i] = (uint8_t)(i * (number + 3) + number);
}

static void add_frames(struct fixture *f, unsigned from, unsigned to)
{
    struct wd_film_store store;
    uint8_t frame[BYTES], there[BYTES];
    assert_true(wd_film_store_open(&store, f->path, KEY, &f->log));
    while (store.frames < from)
        assert_true(wd_film_store_read(&store, there, BYTES));
    for (unsigned i = from; i < to; i++) {
        make_frame(frame, i);
        assert_true(wd_film_store_add(&store, frame, BYTES, &f->log));
    }
    wd_film_store_close(&store);
}

/* Frames that are there, each the one that was added. */
static unsigned whole_frames(struct fixture *f)
{
    struct wd_film_store store;
    uint8_t frame[BYTES], there[BYTES];
    assert_true(wd_film_store_open(&store, f->path, KEY, &f->log));
    while (wd_film_store_read(&store, there, BYTES)) {
        make_frame(frame, (unsigned)store.frames - 1);
        assert_memory_equal(frame, there, BYTES);
    }
    unsigned count = (unsigned)store.frames;
    wd_film_store_close(&store);
    return count;
}

static long size_of(const struct fixture *f)
{
    struct stat info;
    return stat(f->path, &info) == 0 ? (long)info.st_size : -1;
}

static void begin(struct fixture *f)
{
    snprintf(f->path, sizeof f->path, "%s/film.partial", f->folder);
    unlink(f->path);
    f->text[0] = '\0';
    add_frames(f, 0, FRAMES);
}

static void frames_come_back_and_more_follow(void **state)
{
    struct fixture *f = *state;
    begin(f);
    assert_int_equal(whole_frames(f), FRAMES);
    add_frames(f, FRAMES, FRAMES + 2);
    assert_int_equal(whole_frames(f), FRAMES + 2);
    add_frames(f, 2, 3); /* what was not read is dropped */
    assert_int_equal(whole_frames(f), 3);
}

/* Wherever a kill cuts it, the frames before are there, and the film can go on. */
static void cut_anywhere(void **state)
{
    struct fixture *f = *state;
    begin(f);
    long size = size_of(f);
    for (long cut = size - 1; cut >= 0; cut -= 1 + cut / 40) {
        begin(f);
        assert_int_equal(truncate(f->path, cut), 0);
        unsigned kept = whole_frames(f);
        assert_in_range(kept, 0, FRAMES - 1);
        add_frames(f, kept, FRAMES);
        assert_int_equal(whole_frames(f), FRAMES);
        assert_int_equal(size_of(f), size);
    }
}

/* No changed byte goes unseen: in the head it is another film, later the frames before are left. */
static void damage_is_found(void **state)
{
    struct fixture *f = *state;
    begin(f);
    long size = size_of(f);
    for (long at = 0; at < size; at += 1 + at / 40) {
        begin(f);
        FILE *file = fopen(f->path, "r+b");
        fseek(file, at, SEEK_SET);
        int byte = fgetc(file) ^ 0x10;
        fseek(file, at, SEEK_SET);
        fputc(byte, file);
        fclose(file);
        if (at >= 16) {
            assert_in_range(whole_frames(f), 0, FRAMES - 1);
            continue;
        }
        struct wd_film_store store;
        assert_false(wd_film_store_open(&store, f->path, KEY, &f->log));
        assert_true(logged(f, "remove it to begin anew"));
        assert_int_equal(size_of(f), size);
    }
}

static void others_are_refused(void **state)
{
    struct fixture *f = *state;
    struct wd_film_store store, second;
    begin(f);
    assert_false(wd_film_store_open(&store, f->path, KEY + 1, &f->log));
    assert_true(logged(f, "another scene"));
    assert_true(wd_film_store_open(&store, f->path, KEY, &f->log));
    assert_false(wd_film_store_open(&second, f->path, KEY, &f->log));
    assert_true(logged(f, "another process"));
    wd_film_store_close(&store);
    assert_int_equal(whole_frames(f), FRAMES);
    assert_false(wd_film_store_open(&store, f->folder, KEY, &f->log));
    wd_film_store_close(&store);
}

static void nothing_is_left_of_no_frames(void **state)
{
    struct fixture *f = *state;
    struct wd_film_store store;
    begin(f);
    assert_true(wd_film_store_open(&store, f->path, KEY, &f->log));
    wd_film_store_remove(&store);
    assert_int_equal(file_count(f), 0);
    assert_true(wd_film_store_open(&store, f->path, KEY, &f->log));
    wd_film_store_close(&store);
    assert_int_equal(file_count(f), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(frames_come_back_and_more_follow, setup, teardown),
        cmocka_unit_test_setup_teardown(cut_anywhere, setup, teardown),
        cmocka_unit_test_setup_teardown(damage_is_found, setup, teardown),
        cmocka_unit_test_setup_teardown(others_are_refused, setup, teardown),
        cmocka_unit_test_setup_teardown(nothing_is_left_of_no_frames, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
