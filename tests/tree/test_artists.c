#include "imported.h"

/* --- names of files beside the model ------------------------------------------------------- */

static void write_texture(const char *name)
{
    enum { SIZE = 8 };
    struct wd_model_image image = {SIZE, SIZE, wd_alloc(4 * SIZE * SIZE)};
    for (int i = 0; i < SIZE * SIZE; i++) /* dark, and clear, in the half that is no leaf */
        memcpy(image.rgba + 4 * i, i % SIZE < SIZE / 2 ? (uint8_t[4]){30, 120, 20, 255} : (uint8_t[4]){0}, 4);
    size_t size;
    uint8_t *png = wd_model_image_encode(&image, &size);
    write_file(name, png, size);
    free(png);
    wd_model_image_finish(&image);
}

#define CARD "v 0 0 0\nv 1 0 0\nv 1 9 0\nv 0 9 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl Karte\nf 1/1 2/2 3/3 4/4\n"

/* As on systems that take names of any case for one; and a library of the model's own name. */
static void names_of_another_case_are_found(void **state)
{
    (void)state;
    write_texture("case.png");
    write_text("case.mtl", "newmtl Karte\nmap_Kd tex\\Case.PNG\n");
    write_text("case.obj", "mtllib CASE.MTL\no tree\n" CARD);
    write_text("case2.mtl", "newmtl Karte\nmap_Kd CASE.png\n");
    write_text("case2.obj", "mtllib no-such.mtl\no tree\n" CARD);
    for (int i = 0; i < 2; i++) {
        struct result *result = import(i ? "case2.obj" : "case.obj");
        assert_true(result->ok);
        assert_null(strstr(result->record.text, "stands in"));
        assert_int_equal(result->import.materials.picture_count, 1);
        drop(result);
    }
}

static void names_in_gltf_may_have_escapes(void **state)
{
    static const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 3, 0};
    (void)state;
    write_file("my tr\xc3\xa9\x65.bin", positions, sizeof positions);
    write_texture("my leaf.png");
    write_text("escapes.gltf",
               "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"mesh\": 0}], "
               "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"material\": 0}]}], "
               "\"materials\": [{\"name\": \"leaf\", \"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0}}}], "
               "\"textures\": [{\"source\": 0}], \"images\": [{\"uri\": \"my%20leaf.png\"}], "
               "\"buffers\": [{\"byteLength\": 36, \"uri\": \"my%20tr%C3%A9e.bin\"}], "
               "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"accessors\": [{\"bufferView\": 0, "
               "\"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}]}");
    struct result *result = import("escapes.gltf");
    if (!result->ok)
        fail_msg("%s", result->record.text);
    assert_null(strstr(result->record.text, "stands in"));
    assert_int_equal(result->import.materials.picture_count, 1);
    drop(result);
}

/* Formats without a word on it leave alpha to the texture. */
static void clear_texels_of_leaves_are_holes(void **state)
{
    (void)state;
    write_texture("clear.png");
    write_text("clear.mtl", "newmtl Karte\nmap_Kd clear.png\n");
    write_text("clear.obj", "mtllib clear.mtl\no tree\n" CARD);
    struct result *result = import("clear.obj");
    assert_true(result->ok);
    assert_int_equal(test_leaf_triangles(&result->import.model.full), 2);
    assert_true(result->import.materials.pictures[0].holes);
    drop(result);
}

/* --- what is read well and is no tree as meant --------------------------------------------- */

static void sizes_of_no_tree_are_told(void **state)
{
    static const char *const files[][2] = {
        {"v 0 0 0\nv 1e-3 0 0\nv 0 3e-3 0\nf 1 2 3\n", "is 0.003 m high"},
        {"v 0 0 0\nv 1e6 0 0\nv 0 3e6 0\nf 1 2 3\n", "is 3e+03 m high with 1 unit = 0.001 m"},
        {"mtllib tree.mtl\n" TRUNK "v -2000 0 -2000\nv 2000 0 -2000\nv 2000 0 2000\nf 9 10 11\n", "stands on wood 40 m wide"}};
    (void)state;
    write_text("tree.mtl", LIBRARY);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        write_text("size.obj", files[i][0]);
        struct result *result = import("size.obj");
        if (!result->ok)
            fail_msg("%s", result->record.text);
        expect_message(result, files[i][1]);
        drop(result);
    }
}

/* Of levels that stand in one place the highest is read; what is named alike in one of them stays. */
static void lower_levels_are_left_out(void **state)
{
    (void)state;
    write_text("levels.obj", "v 0 0 0\nv 1 0 0\nv 0 3 0\nv 0 3 1\no tree_LOD0\nf 1 2 3\nf 1 2 4\no tree_LOD1\nf 1 2 3\n"
                             "o tree_LOD2\nf 1 2 4\no other_LOD1\nf 2 3 4\n");
    struct result *result = import("levels.obj");
    assert_true(result->ok);
    expect_message(result, "lower levels of detail, by their names; left out: 2 nodes");
    assert_int_equal(result->import.model.full.index_count / 3, 3);
    drop(result);
}

/* A slope of 45 degrees, stretched to three times its height, has normals of 18 degrees above the level. */
static void normals_turn_with_stretched_surfaces(void **state)
{
    static const float data[18] = {0, 0, 0, 0, 0, 1, 1, 1, 0, -0.70710678f, 0.70710678f, 0, -0.70710678f, 0.70710678f, 0,
                                   -0.70710678f, 0.70710678f, 0};
    (void)state;
    write_file("stretched.bin", data, sizeof data);
    write_text("stretched.gltf",
               "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"mesh\": 0, \"scale\": "
               "[1, 3, 1]}], \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0, \"NORMAL\": 1}}]}], "
               "\"buffers\": [{\"byteLength\": 72, \"uri\": \"stretched.bin\"}], "
               "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}, {\"buffer\": 0, \"byteOffset\": 36, "
               "\"byteLength\": 36}], \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, "
               "\"type\": \"VEC3\"}, {\"bufferView\": 1, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}]}");
    struct result *result = import("stretched.gltf");
    assert_true(result->ok);
    float normal[3];
    wd_unpack_normal(result->import.model.full.vertices[0].normal, normal);
    assert_float_equal(normal[0], -0.9487f, 0.01);
    assert_float_equal(normal[2], 0.3162f, 0.01);
    drop(result);
}

/* Leaves are darkened to what leaves reflect once, whether the colour is the material's or the vertices'. */
static void colours_of_vertices_count_as_leaves_colours(void **state)
{
    uint32_t tints[2];
    (void)state;
    write_text("bright.mtl", "newmtl leaf\nKd 0.4 0.8 0.2\n");
    write_text("bright.obj", "mtllib bright.mtl\nv 0 0 0\nv 1 0 0\nv 0 3 0\nusemtl leaf\nf 1 2 3\n");
    write_text("dark.mtl", "newmtl leaf\nKd 1 1 0.5\n");
    write_text("dark.obj", "mtllib dark.mtl\nv 0 0 0 0.04 0.08 0.04\nv 1 0 0 0.04 0.08 0.04\nv 0 3 0 0.04 0.08 0.04\n"
                           "usemtl leaf\nf 1 2 3\n");
    for (int i = 0; i < 2; i++) {
        struct result *result = import(i ? "dark.obj" : "bright.obj");
        assert_true(result->ok);
        tints[i] = result->import.model.full.vertices[0].tint;
        drop(result);
    }
    assert_in_range(tints[0] >> 8 & 255, 20, 40);
    assert_in_range(tints[1] >> 8 & 255, 19, 22);
}

/* Of a texture's coordinates, as the format has it, and of positions by an extension. */
static void whole_numbers_for_places_are_refused(void **state)
{
    static const char *const names[] = {"POSITION", "TEXCOORD_0"};
    char text[1024];
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        snprintf(text, sizeof text, "{\"asset\": {\"version\": \"2.0\"}, \"meshes\": [{\"primitives\": [{\"attributes\": "
                 "{\"NORMAL\": 0, \"%s\": 1}}]}], \"accessors\": [{\"componentType\": 5126}, {\"componentType\": 5123}]}",
                 names[i]);
        write_text("whole.gltf", text);
        struct result *result = import("whole.gltf");
        assert_false(result->ok);
        expect_message(result, names[i]);
        expect_message(result, "as whole numbers (quantized)");
        drop(result);
    }
}

static void cards_of_branches_are_leaves(void **state)
{
    (void)state;
    write_texture("cards.png");
    write_text("cards.mtl", "newmtl Karte\nmap_Kd cards.png\nnewmtl Branches\nmap_Kd cards.png\nmap_d cards.png\n");
    write_text("cards.obj", "mtllib cards.mtl\n" CARD "usemtl Branches\nf 1/1 2/2 3/3\n");
    struct result *result = import("cards.obj");
    assert_true(result->ok);
    assert_int_equal(test_leaf_triangles(&result->import.model.full), 3);
    drop(result);
    write_text("cards.json", "{\"name\": \"cards\", \"model\": {\"file\": \"cards.obj\", \"wood\": [\"Branches\"]}}");
    result = import("cards.json");
    assert_true(result->ok);
    assert_int_equal(test_leaf_triangles(&result->import.model.full), 2);
    drop(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_of_another_case_are_found),
        cmocka_unit_test(names_in_gltf_may_have_escapes),
        cmocka_unit_test(clear_texels_of_leaves_are_holes),
        cmocka_unit_test(sizes_of_no_tree_are_told),
        cmocka_unit_test(lower_levels_are_left_out),
        cmocka_unit_test(normals_turn_with_stretched_surfaces),
        cmocka_unit_test(whole_numbers_for_places_are_refused),
        cmocka_unit_test(cards_of_branches_are_leaves),
        cmocka_unit_test(colours_of_vertices_count_as_leaves_colours),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
