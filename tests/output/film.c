#include "../base/comma_locale.h"
#include "limits.h"
#include "output/film.h"
#include "output/image.h"
#include "weald/renderer.h"

static const char script[] = "#!/bin/sh\n";

/* A program that stands in for ffmpeg to fail in a known way. */
static char *make_program(struct fixture *f, const char *body)
{
    char *path = wd_format("%s/fake", f->folder);
    FILE *file = fopen(path, "wb");
    fprintf(file, "%s%s\n", script, body);
    fclose(file);
    chmod(path, 0755);
    return path;
}

static bool add_frames(struct wd_film_writer *film, uint32_t width, uint32_t height, int count,
                       const struct wd_log *log)
{
    bool ok = true;
    for (int i = 0; i < count && ok; i++) {
        uint8_t *rgb = make_picture(width, height, (uint32_t)i + 1);
        ok = wd_film_writer_add(film, rgb, log);
        free(rgb);
    }
    return ok;
}

/* Frames of a film as ffprobe counts them, 0 when it is none. */
static int count_frames(const char *path)
{
    char *command = wd_format("ffprobe -v error -count_frames -show_entries stream=nb_read_frames "
                              "-of csv=p=0 %s", path);
    FILE *pipe = popen(command, "r");
    int count = 0;
    if (fscanf(pipe, "%d", &count) != 1)
        count = 0;
    pclose(pipe);
    free(command);
    return count;
}

static void films_hold_their_frames(void **state)
{
    struct fixture *f = *state;
    static const char *const names[] = {"a.mp4", "a.m4v", "a.mov", "a.MKV"};
    for (size_t i = 0; i < 4; i++) {
        struct wd_film_writer film;
        struct wd_film_writer_params params = {in_folder(f, names[i]), 64, 48, .frame_rate = 25};
        assert_true(wd_film_has_ending(params.path));
        assert_true(wd_film_writer_open(&film, &params, &f->log));
        assert_true(add_frames(&film, 64, 48, 7, &f->log));
        assert_false(access(f->path, F_OK) == 0); /* not before it is whole */
        assert_true(wd_film_writer_commit(&film, &f->log));
        assert_int_equal(count_frames(f->path), 7);
        assert_int_equal(file_count(f), (int)i + 1);
    }
    static const char *const others[] = {"a.png", "a.exr", "mp4", ".mp4", "a.mp4/b", "", NULL};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        assert_false(wd_film_has_ending(others[i]));
}

/* A flat colour comes back through the matrix and range that the film says it has. */
static void films_need_no_locale(void **state)
{
    struct fixture *f = *state;
    struct wd_film_writer film;
    struct wd_film_writer_params params = {in_folder(f, "a.mp4"), 64, 48, .frame_rate = 12.5};
    locale_t comma = comma_locale();
    if (!comma) {
        print_message("there is no locale with decimal commas: skipped\n");
        skip();
    }
    locale_t before = uselocale(comma);
    bool ok = wd_film_writer_open(&film, &params, &f->log) && add_frames(&film, 64, 48, 3, &f->log) &&
              wd_film_writer_commit(&film, &f->log);
    uselocale(before);
    freelocale(comma);
    assert_true(ok);
    assert_int_equal(count_frames(f->path), 3);
}

static void colours_are_kept(void **state)
{
    struct fixture *f = *state;
    struct wd_film_writer film;
    struct wd_film_writer_params params = {in_folder(f, "a.mp4"), 32, 32, .crf = 1};
    uint8_t rgb[32 * 32 * 3];
    for (size_t i = 0; i < sizeof rgb; i += 3) {
        rgb[i] = 30;
        rgb[i + 1] = 180;
        rgb[i + 2] = 60;
    }
    assert_true(wd_film_writer_open(&film, &params, &f->log));
    assert_true(wd_film_writer_add(&film, rgb, &f->log));
    assert_true(wd_film_writer_commit(&film, &f->log));
    char *command = wd_format("ffmpeg -v error -i %s -vf scale=in_color_matrix=bt709 -f rawvideo "
                              "-pix_fmt rgb24 -", f->path);
    FILE *pipe = popen(command, "r");
    uint8_t got[sizeof rgb];
    assert_int_equal(fread(got, 1, sizeof got, pipe), sizeof got);
    pclose(pipe);
    free(command);
    for (size_t i = 0; i < sizeof rgb; i++)
        assert_in_range(got[i], rgb[i] - 4, rgb[i] + 4);
}

static void discarded_films_leave_nothing(void **state)
{
    struct fixture *f = *state;
    struct wd_film_writer film = {0};
    wd_film_writer_discard(&film);
    struct wd_film_writer_params params = {in_folder(f, "a.mp4"), 64, 48};
    assert_true(wd_film_writer_open(&film, &params, &f->log));
    assert_true(add_frames(&film, 64, 48, 3, &f->log));
    wd_film_writer_discard(&film);
    assert_int_equal(file_count(f), 0);
    assert_true(wd_film_writer_open(&film, &params, &f->log));
    assert_false(wd_film_writer_commit(&film, &f->log));
    assert_true(logged(f, "the film has no frames"));
    assert_int_equal(file_count(f), 0);
}

static void sequences_are_written_frame_by_frame(void **state)
{
    struct fixture *f = *state;
    struct wd_film_writer film;
    struct wd_film_writer_params params = {in_folder(f, "f-%03d.png"), 9, 5};
    assert_true(wd_film_writer_open(&film, &params, &f->log));
    assert_true(add_frames(&film, 9, 5, 3, &f->log));
    wd_film_writer_discard(&film); /* what is finished stays */
    assert_int_equal(file_count(f), 3);
    struct wd_image8 image;
    assert_true(wd_png_read(&image, in_folder(f, "f-002.png"), &f->log));
    uint8_t *third = make_picture(9, 5, 3);
    assert_memory_equal(image.pixels, third, 9 * 5 * 3);
    free(third);
    wd_image8_finish(&image);
}

static void frames_are_known_by_their_names(void **state)
{
    (void)state;
    static const struct {
        const char *pattern, *name;
        long frame; /* -1: none */
    } cases[] = {{"a/f-%03d.png", "f-002.png", 2},  {"f-%d.png", "f-12.png", 12},
                 {"50% out/f-%d.png", "f-12.png", 12}, {"90%-%d.png", "90%-7.png", 7},
                 {"f-%03d.png", "f-1002.png", 1002}, {"f-%3d.png", "f-  7.png", 7},
                 {"f-%03d.png", "f-2.png", -1},      {"f-%d.png", "f-012.png", -1},
                 {"f-%d.png", "f-.png", -1},         {"f-%d.png", "f-+1.png", -1},
                 {"f-%d.png", "f--1.png", -1},       {"f-%d.png", "f-1.png.partial", -1},
                 {"%d", "5", 5},                     {"f-%d.png", "g-1.png", -1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint64_t frame;
        bool is_frame = wd_film_frame_number(cases[i].pattern, cases[i].name, &frame);
        assert_int_equal(is_frame ? (long)frame : -1, cases[i].frame);
    }
}

static void names_and_sizes_are_checked(void **state)
{
    struct fixture *f = *state;
    static const struct {
        struct wd_film_writer_params params;
        const char *message;
    } cases[] = {
        {{"/tmp/a.mp4", 63, 48}, "must be even; found 63 x 48, 64 x 48 would do"},
        {{"/tmp/a.mp4", 0, 48}, "found 0 x 48 pixels"},
        {{"/tmp/a.mp4", 100000, 48}, "found 100000 x 48 pixels"},
        {{"/tmp/a.mp4", 64, 48, .frame_rate = -1}, "found -1 frames a second"},
        {{"/tmp/a.mp4", 64, 48, .crf = 99}, "found a crf of 99"},
        {{"/tmp/a.avi", 64, 48}, "films are .mp4, .m4v, .mov or .mkv"},
        {{"/tmp/%s.png", 64, 48}, "not a name for a sequence"},
        {{"/tmp/%d-%d.png", 64, 48}, "not a name for a sequence"},
        {{"/tmp/%d/a.png", 64, 48}, "films are .mp4"},
        {{"/tmp/%d/%q.png", 64, 48}, "not a name for a sequence"},
        {{"/tmp/%03d.mp4", 64, 48}, "numbered frames are .png or .exr files"},
        {{"/tmp/%999999d.png", 64, 48}, "not a name for a sequence"},
        {{"/nowhere/at/all/a.mp4", 64, 48}, "No such file or directory"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct wd_film_writer film;
        f->text[0] = '\0';
        assert_false(wd_film_writer_open(&film, &cases[i].params, &f->log));
        assert_true(logged(f, cases[i].message));
    }
    mkdir(in_folder(f, "d.mp4"), 0777);
    struct wd_film_writer film;
    struct wd_film_writer_params params = {f->path, 64, 48};
    assert_false(wd_film_writer_open(&film, &params, &f->log));
    assert_true(logged(f, "d.mp4: is a directory"));
}

static void missing_ffmpeg_is_told(void **state)
{
    struct fixture *f = *state;
    struct wd_film_writer film;
    struct wd_film_writer_params params = {in_folder(f, "a.mp4"), 64, 48, .ffmpeg = "no-such-ffmpeg"};
    assert_false(wd_film_writer_open(&film, &params, &f->log));
    assert_true(logged(f, "need the program no-such-ffmpeg, which is not there; install"));
    assert_int_equal(file_count(f), 0);
}

/* ffmpeg ends at once: the write finds a closed pipe, and SIGPIPE (at its default, deadly action)
 * stays away. */
static void failing_ffmpeg_is_told(void **state)
{
    struct fixture *f = *state;
    char *program = make_program(f, "echo first >&2; echo the disk is on fire >&2; exit 3");
    struct wd_film_writer film;
    struct wd_film_writer_params params = {in_folder(f, "a.mp4"), 640, 480, .ffmpeg = program};
    assert_true(wd_film_writer_open(&film, &params, &f->log));
    assert_false(add_frames(&film, 640, 480, 4, &f->log));
    assert_true(logged(f, "a.mp4: the film cannot be written: ffmpeg stopped early: the disk is on "
                          "fire"));
    free(program);
    program = make_program(f, "cat > /dev/null; echo no room >&2; exit 5");
    params.ffmpeg = program;
    params.path = in_folder(f, "a.mp4");
    assert_true(wd_film_writer_open(&film, &params, &f->log));
    assert_true(add_frames(&film, 640, 480, 1, &f->log));
    assert_false(wd_film_writer_commit(&film, &f->log));
    assert_true(logged(f, "ffmpeg failed with status 5: no room"));
    assert_int_equal(file_count(f), 1); /* the program */
    free(program);
}

static bool film_too_much(struct fixture *f)
{
    struct wd_film_writer film;
    struct wd_film_writer_params params = {in_folder(f, "a.mp4"), 320, 240};
    bool ok = wd_film_writer_open(&film, &params, &f->log) && add_frames(&film, 320, 240, 40, &f->log) &&
              wd_film_writer_commit(&film, &f->log);
    return !ok && logged(f, "a.mp4: the film cannot be written: ffmpeg");
}

static void full_disk_leaves_nothing(void **state)
{
    struct fixture *f = *state;
    assert_true(with_small_files(film_too_much, f, 30000));
    assert_int_equal(file_count(f), 0);
}

/* Ctrl-C reaches the whole group of the terminal; ffmpeg goes on, and the caller may commit. */
static bool interrupted_film(struct fixture *f)
{
    struct wd_film_writer film;
    struct wd_film_writer_params params = {in_folder(f, "a.mp4"), 64, 48};
    signal(SIGINT, SIG_IGN);
    bool ok = wd_film_writer_open(&film, &params, &f->log) && add_frames(&film, 64, 48, 4, &f->log);
    ok = ok && kill(film.encoder.process, SIGINT) == 0;
    return ok && getpgid(film.encoder.process) == film.encoder.process &&
           wd_film_writer_commit(&film, &f->log);
}

static void interrupt_spares_ffmpeg(void **state)
{
    struct fixture *f = *state;
    assert_true(with_small_files(interrupted_film, f, 1u << 30));
    assert_int_equal(count_frames(in_folder(f, "a.mp4")), 4);
}

int main(void)
{
    signal(SIGPIPE, SIG_DFL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(films_hold_their_frames, setup, teardown),
        cmocka_unit_test_setup_teardown(films_need_no_locale, setup, teardown),
        cmocka_unit_test_setup_teardown(colours_are_kept, setup, teardown),
        cmocka_unit_test_setup_teardown(discarded_films_leave_nothing, setup, teardown),
        cmocka_unit_test_setup_teardown(sequences_are_written_frame_by_frame, setup, teardown),
        cmocka_unit_test(frames_are_known_by_their_names),
        cmocka_unit_test_setup_teardown(names_and_sizes_are_checked, setup, teardown),
        cmocka_unit_test_setup_teardown(missing_ffmpeg_is_told, setup, teardown),
        cmocka_unit_test_setup_teardown(failing_ffmpeg_is_told, setup, teardown),
        cmocka_unit_test_setup_teardown(full_disk_leaves_nothing, setup, teardown),
        cmocka_unit_test_setup_teardown(interrupt_spares_ffmpeg, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
