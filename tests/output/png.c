#include "limits.h"
#include "output/image.h"

static void pictures_round_trip(void **state)
{
    struct fixture *f = *state;
    static const uint32_t sizes[][2] = {{1, 1}, {3, 7}, {320, 200}};
    for (size_t i = 0; i < 3; i++) {
        uint32_t width = sizes[i][0], height = sizes[i][1];
        uint8_t *rgb = make_picture(width, height, 5);
        assert_true(wd_png_write(in_folder(f, "a.png"), rgb, width, height, &f->log));
        struct wd_image8 image;
        assert_true(wd_png_read(&image, f->path, &f->log));
        assert_true(image.width == width && image.height == height);
        assert_memory_equal(image.pixels, rgb, (size_t)width * height * 3);
        wd_image8_finish(&image);
        free(rgb);
    }
    assert_int_equal(file_count(f), 1);
}

static void files_say_srgb(void **state)
{
    struct fixture *f = *state;
    const uint8_t rgb[2 * 3] = {0, 1, 2, 255, 128, 3};
    assert_true(wd_png_write(in_folder(f, "b.png"), rgb, 2, 1, &f->log));
    FILE *file = fopen(f->path, "rb");
    uint8_t bytes[256];
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    assert_int_equal(bytes[24], 8); /* bit depth */
    assert_non_null(memmem(bytes, size, "sRGB", 4));
    assert_non_null(memmem(bytes, size, "gAMA\x00\x00\xb1\x8f", 8)); /* 45455 */
    static const uint8_t white[] = {'c', 'H', 'R', 'M', 0, 0, 0x7a, 0x26, 0, 0, 0x80, 0x84};
    assert_non_null(memmem(bytes, size, white, sizeof white)); /* 31270, 32900 */
}

static void outputs_that_cannot_be_are_errors(void **state)
{
    struct fixture *f = *state;
    uint8_t rgb[3] = {1, 2, 3};
    assert_false(wd_png_write(f->folder, rgb, 1, 1, &f->log));
    assert_true(logged(f, "is a directory"));
    assert_false(wd_png_write(in_folder(f, "no/a.png"), rgb, 1, 1, &f->log));
    assert_true(logged(f, "no/a.png: cannot be written: No such file or directory"));
    assert_false(wd_png_write(in_folder(f, "a.png"), rgb, 0, 1, &f->log));
    assert_true(logged(f, "a picture of 0 x 1 pixels"));
    assert_false(wd_png_write(in_folder(f, "a.png"), rgb, 1, 40000, &f->log));
    assert_true(logged(f, "allowed are 1 to 32768 a side"));
    assert_int_equal(file_count(f), 0);
}

static bool write_too_much(struct fixture *f)
{
    uint8_t *rgb = make_picture(300, 300, 1);
    bool ok = wd_png_write(in_folder(f, "a.png"), rgb, 300, 300, &f->log);
    free(rgb);
    return !ok && logged(f, "a.png: cannot be written: File too large");
}

static void full_disk_leaves_the_old_file(void **state)
{
    struct fixture *f = *state;
    uint8_t *rgb = make_picture(8, 8, 1);
    assert_true(wd_png_write(in_folder(f, "a.png"), rgb, 8, 8, &f->log));
    const unsigned limits[] = {10, 4096, 20000}; /* the first write fails, one between, one of the last */
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
        assert_true(with_small_files(write_too_much, f, limits[i]));
    assert_int_equal(file_count(f), 1);
    struct wd_image8 image;
    assert_true(wd_png_read(&image, in_folder(f, "a.png"), &f->log));
    assert_int_equal(image.width, 8);
    wd_image8_finish(&image);
    free(rgb);
}

static void damaged_files_are_errors(void **state)
{
    struct fixture *f = *state;
    uint8_t *rgb = make_picture(40, 30, 9);
    assert_true(wd_png_write(in_folder(f, "a.png"), rgb, 40, 30, &f->log));
    free(rgb);
    FILE *file = fopen(f->path, "rb");
    uint8_t bytes[8192];
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    for (size_t cut = 0; cut < size - 12; cut += 7) {
        file = fopen(in_folder(f, "cut.png"), "wb");
        fwrite(bytes, 1, cut, file);
        fclose(file);
        struct wd_image8 image;
        assert_false(wd_png_read(&image, f->path, &f->log));
        assert_true(logged(f, "cut.png: is not a PNG that can be read"));
        assert_null(image.pixels);
    }
    struct wd_image8 image;
    assert_false(wd_png_read(&image, in_folder(f, "none.png"), &f->log));
    assert_true(logged(f, "cannot be opened"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(pictures_round_trip, setup, teardown),
        cmocka_unit_test_setup_teardown(files_say_srgb, setup, teardown),
        cmocka_unit_test_setup_teardown(outputs_that_cannot_be_are_errors, setup, teardown),
        cmocka_unit_test_setup_teardown(full_disk_leaves_the_old_file, setup, teardown),
        cmocka_unit_test_setup_teardown(damaged_files_are_errors, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
