/* Thousands of damaged pictures and models: each is read or refused with a reason, soon and with little memory. */
#include "../base/damage.h"
#include "imported.h"

#include <sys/stat.h>
#include <turbojpeg.h>

#include "tree/model_image.h"

static const char *const pieces[] = {
    "1e400", "-1", "4294967295", "null", "{", "]", "\xff\xff\xff\xff", "\x7f\xff\xff\xff"};
enum { PIECES = sizeof pieces / sizeof *pieces };

/* --- pictures ---------------------------------------------------------------------------- */

enum { SIDE = 40 };

static uint8_t *some_texels(void)
{
    uint8_t *rgba = malloc(SIDE * SIDE * 4);
    uint32_t seed = 3;
    for (size_t i = 0; i < SIDE * SIDE * 4; i++)
        rgba[i] = (uint8_t)damage_next(&seed);
    return rgba;
}

static uint8_t *some_png(size_t *size)
{
    struct wd_model_image image = {SIDE, SIDE, some_texels()};
    uint8_t *png = wd_model_image_encode(&image, size);
    assert_non_null(png);
    wd_model_image_finish(&image);
    return png;
}

static uint8_t *some_jpeg(size_t *size)
{
    uint8_t *rgba = some_texels(), *packed = NULL;
    unsigned long length = 0;
    tjhandle encoder = tjInitCompress();
    assert_int_equal(tjCompress2(encoder, rgba, SIDE, 0, SIDE, TJPF_RGBA, &packed, &length, TJSAMP_420, 90, 0), 0);
    tjDestroy(encoder);
    uint8_t *jpeg = malloc(length);
    memcpy(jpeg, packed, length);
    *size = length;
    tjFree(packed);
    free(rgba);
    return jpeg;
}

/* NULL: it is read. */
static const char *refused(const uint8_t *bytes, size_t size)
{
    struct wd_model_image image;
    const char *why = NULL;
    uint8_t *exact = malloc(size ? size : 1); /* so that a read beyond the end is seen */
    memcpy(exact, bytes, size);
    bool ok = wd_model_image_decode(&image, exact, size, &why);
    free(exact);
    if (!ok) {
        assert_null(image.rgba);
        assert_true(why && *why);
    }
    wd_model_image_finish(&image);
    return ok ? NULL : why;
}

static void batter(const uint8_t *whole, size_t size)
{
    enum { ROUNDS = 3000 };
    uint32_t seed = 5;
    unsigned count = 0;
    uint8_t *bytes = malloc(size);
    assert_null(refused(whole, size));
    for (unsigned i = 0; i < ROUNDS; i++) {
        size_t length = size;
        memcpy(bytes, whole, size);
        damage(bytes, &length, &seed, pieces, PIECES);
        count += refused(bytes, length) != NULL;
    }
    assert_true(count > ROUNDS / 10);
    free(bytes);
}

static void damaged_pictures_never_crash(void **state)
{
    (void)state;
    size_t size;
    uint8_t *png = some_png(&size);
    batter(png, size);
    for (size_t length = 0; length + 12 < size; length += 7)
        assert_non_null(refused(png, length));
    free(png);
    uint8_t *jpeg = some_jpeg(&size);
    batter(jpeg, size);
    for (size_t length = 0; length + 8 < size; length += 7)
        assert_non_null(refused(jpeg, length));
    assert_null(refused(jpeg, size - 2)); /* nothing but the end's marker is missing */
    free(jpeg);
}

/* As PNG has it (RFC 2083, appendix 15). */
static uint32_t crc_of(const uint8_t *bytes, size_t size)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++)
            crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return ~crc;
}

/* A head of a gigabyte of texels before a few bytes. */
static void heads_that_lie_take_no_memory(void **state)
{
    (void)state;
    enum { IHDR = 12, IHDR_BYTES = 17, SOF_HEIGHT = 5 };
    size_t size;
    uint8_t *png = some_png(&size);
    png[IHDR + 6] = png[IHDR + 10] = 16000 >> 8;
    uint32_t crc = crc_of(png + IHDR, IHDR_BYTES);
    for (int k = 0; k < 4; k++)
        png[IHDR + IHDR_BYTES + k] = (uint8_t)(crc >> (24 - 8 * k));
    assert_non_null(strstr(refused(png, size), "cut short"));
    free(png);
    uint8_t *jpeg = some_jpeg(&size), *frame = memmem(jpeg, size, "\xff\xc0", 2);
    frame[SOF_HEIGHT] = frame[SOF_HEIGHT + 2] = 16000 >> 8;
    assert_non_null(strstr(refused(jpeg, size), "too few bytes"));
    free(jpeg);
}

/* --- models ------------------------------------------------------------------------------ */

#define ASSET "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
#define MESH                                                                                       \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"             \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},"                                           \
    "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":6}],\"buffers\":[{\"byteLength\":42,\"uri\":"  \
    "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA\"}],"
#define ACCESSORS(sparse)                                                                          \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"" sparse \
    "},{\"bufferView\":1,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}]}"
#define NODE "\"nodes\":[{\"mesh\":0}],"

static void expect_fault(const char *text, const char *part)
{
    write_text("fault.gltf", text);
    struct result *result = import("fault.gltf");
    assert_false(result->ok);
    expect_message(result, part);
    drop(result);
}

static void damaged_models_never_crash(void **state)
{
    (void)state;
    enum { ROUNDS = 250 };
    static const char whole[] = ASSET NODE MESH ACCESSORS("");
    uint32_t seed = 9;
    unsigned count = 0;
    write_text("whole.gltf", whole);
    struct result *result = import("whole.gltf");
    assert_true(result->ok);
    drop(result);
    for (unsigned i = 0; i < ROUNDS; i++) {
        uint8_t bytes[sizeof whole];
        size_t size = sizeof whole - 1;
        memcpy(bytes, whole, sizeof whole);
        damage(bytes, &size, &seed, pieces, PIECES);
        write_file("damaged.gltf", bytes, size);
        result = import("damaged.gltf");
        assert_true(result->ok || *result->record.text);
        count += !result->ok;
        drop(result);
    }
    assert_true(count > ROUNDS / 2);
}

static void nodes_without_end_are_told(void **state)
{
    (void)state;
    char *twice = wd_strdup(ASSET "\"nodes\":[");
    for (int i = 1; i <= 60; i++) { /* 2^60 meshes */
        char *longer = wd_format("%s{\"children\":[%d,%d]},", twice, i, i);
        free(twice);
        twice = longer;
    }
    char *text = wd_format("%s{\"mesh\":0}]," MESH ACCESSORS(""), twice);
    expect_fault(text, "more than 1000000, each counted");
    free(text);
    free(twice);
    expect_fault(ASSET "\"nodes\":[{\"mesh\":0,\"children\":[0]}]," MESH ACCESSORS(""), "in a circle");
    expect_fault(ASSET NODE MESH ACCESSORS(",\"sparse\":{\"count\":1000000000}"),
                 "accessors[0] has 3 values, but 1000000000 sparse ones");
    expect_fault(ASSET NODE "\"meshes\":[{", "its JSON is malformed: line 1, column");
}

/* Of four gigabytes in the head of the first chunk. */
static void chunks_beyond_the_file_are_told(void **state)
{
    (void)state;
    static const char bytes[] = "glTF\2\0\0\0\x16\0\0\0\xff\xff\xff\xffJSON{";
    write_file("chunk.glb", bytes, sizeof bytes);
    struct result *result = import("chunk.glb");
    assert_false(result->ok);
    expect_message(result, "its chunk 1 says 4294967295 bytes, the file has 2 after its head");
    drop(result);
}

/* Nobody writes into the pipe. */
static void pipes_beside_models_are_not_waited_for(void **state)
{
    (void)state;
    char *path = path_of("pipe.mtl");
    assert_int_equal(mkfifo(path, 0600), 0);
    free(path);
    write_text("textured.mtl", "newmtl Bark\nmap_Kd pipe.mtl\nnewmtl Blatt\nmap_Kd /dev/zero\n");
    write_text("piped.obj", "mtllib pipe.mtl\n" TRUNK LEAF);
    write_text("textured.obj", "mtllib textured.mtl\n" TRUNK LEAF);
    alarm(60);
    struct result *result = import("piped.obj");
    assert_true(result->ok);
    expect_message(result, "pipe.mtl is not there: grey stands in");
    drop(result);
    result = import("textured.obj");
    assert_true(result->ok);
    expect_message(result, "texture pipe.mtl cannot be used");
    expect_message(result, "texture /dev/zero cannot be used: there is no such file");
    drop(result);
    alarm(0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged_pictures_never_crash),
        cmocka_unit_test(heads_that_lie_take_no_memory),
        cmocka_unit_test(damaged_models_never_crash),
        cmocka_unit_test(nodes_without_end_are_told),
        cmocka_unit_test(chunks_beyond_the_file_are_told),
        cmocka_unit_test(pipes_beside_models_are_not_waited_for),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
