#include <math.h>

#include "limits.h"
#include "output/exr.h"

enum { WIDTH = 37, HEIGHT = 45 };

struct layers {
    float rgba[WIDTH * HEIGHT * 4], z[WIDTH * HEIGHT], normal[WIDTH * HEIGHT * 3];
    uint32_t id[WIDTH * HEIGHT];
};

static struct layers *make_layers(void)
{
    struct layers *layers = wd_alloc(sizeof *layers);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        for (size_t c = 0; c < 4; c++)
            layers->rgba[i * 4 + c] = (float)(i * 4 + c) / 64;
        for (size_t c = 0; c < 3; c++)
            layers->normal[i * 3 + c] = sinf((float)(i * 3 + c));
        layers->z[i] = i % 50 == 0 ? INFINITY : 0.1f * (float)i;
        layers->id[i] = 0xfffffff0u - (uint32_t)i * 77777u;
    }
    return layers;
}

/* Not in the order of the alphabet, as callers may. */
static bool write_layers(const char *path, const struct layers *l, const struct wd_log *log)
{
    const struct wd_exr_channel channels[] = {
        {"tree_id", WD_EXR_UINT, l->id, 0},       {"R", WD_EXR_HALF, l->rgba, 4},
        {"G", WD_EXR_HALF, l->rgba + 1, 4},       {"B", WD_EXR_HALF, l->rgba + 2, 4},
        {"A", WD_EXR_HALF, l->rgba + 3, 4},       {"Z", WD_EXR_FLOAT, l->z, 1},
        {"N.X", WD_EXR_FLOAT, l->normal, 3},      {"N.Y", WD_EXR_FLOAT, l->normal + 1, 3},
        {"N.Z", WD_EXR_FLOAT, l->normal + 2, 3},
    };
    const struct wd_exr_text texts[] = {{"crs", "EPSG:32611"}, {"weald_scene", "valley"}};
    struct wd_exr_params params = {WIDTH, HEIGHT, channels, sizeof channels / sizeof *channels,
                                   texts, 2};
    return wd_exr_write(path, &params, log);
}

static void layers_round_trip(void **state)
{
    struct fixture *f = *state;
    struct layers *layers = make_layers();
    assert_true(write_layers(in_folder(f, "a.exr"), layers, &f->log));
    struct wd_exr_image image;
    assert_true(wd_exr_read(&image, f->path, &f->log));
    assert_true(image.width == WIDTH && image.height == HEIGHT);
    assert_int_equal(image.plane_count, 9);
    const struct wd_exr_plane *id = wd_exr_find(&image, "tree_id"), *z = wd_exr_find(&image, "Z");
    assert_true(id->type == WD_EXR_UINT && z->type == WD_EXR_FLOAT);
    assert_memory_equal(id->data, layers->id, sizeof layers->id);
    assert_memory_equal(z->data, layers->z, sizeof layers->z);
    const float *green = wd_exr_find(&image, "G")->data, *ny = wd_exr_find(&image, "N.Y")->data;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        float wanted = layers->rgba[i * 4 + 1];
        assert_true(fabsf(green[i] - wanted) <= wanted / 2048 + 1e-6f); /* half a unit of a half */
        assert_true(ny[i] == layers->normal[i * 3 + 1]);
    }
    assert_null(wd_exr_find(&image, "albedo.R"));
    wd_exr_image_finish(&image);
    free(layers);
    assert_int_equal(file_count(f), 1);
}

static void texts_stand_in_the_header(void **state)
{
    struct fixture *f = *state;
    struct layers *layers = make_layers();
    assert_true(write_layers(in_folder(f, "a.exr"), layers, &f->log));
    char header[1024];
    FILE *file = fopen(f->path, "rb");
    size_t size = fread(header, 1, sizeof header, file);
    fclose(file);
    assert_non_null(memmem(header, size, "EPSG:32611", 10));
    static const char noted[] = "chromaticities\0chromaticities\0\x20\0\0";
    const char *at = memmem(header, size, noted, sizeof noted);
    assert_non_null(at);
    float primaries[8];
    memcpy(primaries, at + sizeof noted, sizeof primaries);
    assert_float_equal(primaries[0], 0.64, 1e-6);
    assert_float_equal(primaries[7], 0.3290, 1e-6);
    assert_non_null(memmem(header, size, "linear sRGB", 11));
    free(layers);
}

static void wrong_requests_are_errors(void **state)
{
    struct fixture *f = *state;
    float value = 1;
    const struct wd_exr_channel twice[] = {{"R", WD_EXR_HALF, &value, 0},
                                           {"R", WD_EXR_FLOAT, &value, 0}};
    struct wd_exr_params params = {1, 1, twice, 2, NULL, 0};
    assert_false(wd_exr_write(in_folder(f, "a.exr"), &params, &f->log));
    assert_true(logged(f, "channel R is given twice"));
    params = (struct wd_exr_params){0, 1, twice, 1, NULL, 0};
    assert_false(wd_exr_write(in_folder(f, "a.exr"), &params, &f->log));
    assert_true(logged(f, "a picture of 0 x 1 pixels"));
    params = (struct wd_exr_params){1, 1, twice, 0, NULL, 0};
    assert_false(wd_exr_write(in_folder(f, "a.exr"), &params, &f->log));
    assert_true(logged(f, "has no channels"));
    params = (struct wd_exr_params){1, 1, twice, 1, NULL, 0};
    assert_false(wd_exr_write(f->folder, &params, &f->log));
    assert_true(logged(f, "is a directory"));
    assert_false(wd_exr_write(in_folder(f, "no/a.exr"), &params, &f->log));
    assert_true(logged(f, "No such file or directory"));
    assert_int_equal(file_count(f), 0);
}

static bool write_too_much(struct fixture *f)
{
    struct layers *layers = make_layers();
    bool ok = write_layers(in_folder(f, "a.exr"), layers, &f->log);
    free(layers);
    return !ok && logged(f, "a.exr: cannot be written: File too large");
}

static void full_disk_leaves_nothing(void **state)
{
    struct fixture *f = *state;
    assert_true(with_small_files(write_too_much, f, 8000));
    assert_int_equal(file_count(f), 0);
}

static size_t read_bytes(const char *path, uint8_t *bytes, size_t size)
{
    FILE *file = fopen(path, "rb");
    size_t got = fread(bytes, 1, size, file);
    fclose(file);
    return got;
}

static void write_bytes(const char *path, const uint8_t *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    fwrite(bytes, 1, size, file);
    fclose(file);
}

static void foreign_compressions_are_named(void **state)
{
    struct fixture *f = *state;
    struct layers *layers = make_layers();
    assert_true(write_layers(in_folder(f, "a.exr"), layers, &f->log));
    free(layers);
    uint8_t bytes[65536];
    size_t size = read_bytes(f->path, bytes, sizeof bytes);
    static const char attribute[] = "compression\0compression\0\1\0\0";
    uint8_t *at = memmem(bytes, size, attribute, sizeof attribute);
    assert_non_null(at);
    at[sizeof attribute] = 9; /* DWAB */
    write_bytes(in_folder(f, "dwab.exr"), bytes, size);
    struct wd_exr_image image;
    assert_false(wd_exr_read(&image, f->path, &f->log));
    assert_true(logged(f, "dwab.exr: is compressed with DWAB, which cannot be read here"));
}

static void damaged_files_are_errors(void **state)
{
    struct fixture *f = *state;
    struct layers *layers = make_layers();
    assert_true(write_layers(in_folder(f, "a.exr"), layers, &f->log));
    free(layers);
    uint8_t bytes[65536];
    size_t size = read_bytes(f->path, bytes, sizeof bytes);
    assert_true(size < sizeof bytes);
    struct wd_exr_image image;
    for (size_t cut = 0; cut < size; cut += size / 60) {
        write_bytes(in_folder(f, "cut.exr"), bytes, cut);
        assert_false(wd_exr_read(&image, f->path, &f->log));
        assert_true(logged(f, "cut.exr: is not an EXR that can be read"));
        assert_null(image.planes);
    }
    uint32_t seed = 3;
    for (int i = 0; i < 300; i++) { /* whatever comes of it, it ends */
        size_t copy_size = read_bytes(in_folder(f, "a.exr"), bytes, sizeof bytes);
        for (int j = 0; j < 3; j++) {
            seed = seed * 1664525u + 1013904223u;
            bytes[(seed >> 8) % (j ? copy_size : 500)] = (uint8_t)(seed >> 3);
        }
        write_bytes(in_folder(f, "bad.exr"), bytes, copy_size);
        if (wd_exr_read(&image, f->path, &f->log))
            wd_exr_image_finish(&image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(layers_round_trip, setup, teardown),
        cmocka_unit_test_setup_teardown(texts_stand_in_the_header, setup, teardown),
        cmocka_unit_test_setup_teardown(wrong_requests_are_errors, setup, teardown),
        cmocka_unit_test_setup_teardown(full_disk_leaves_nothing, setup, teardown),
        cmocka_unit_test_setup_teardown(foreign_compressions_are_named, setup, teardown),
        cmocka_unit_test_setup_teardown(damaged_files_are_errors, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
