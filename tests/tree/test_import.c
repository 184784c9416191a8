#include "imported.h"

#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <locale.h>

#include "base/memory.h"
#include "shared/hash.h"
#include "tree/export.h"

static void expect_refusal(const char *name, const char *part)
{
    struct result *result = import(name);
    assert_false(result->ok);
    expect_message(result, part);
    expect_message(result, name);
    drop(result);
}

static void a_tree_stands_on_its_foot_in_metres(void **state)
{
    (void)state;
    write_text("tree.mtl", LIBRARY);
    write_text("tree.obj", "mtllib tree.mtl\no tree\n" TRUNK LEAF);
    struct result *result = import("tree.obj");
    assert_true(result->ok);
    expect_message(result, "1 unit = 0.01 m");
    const struct wd_tree_model *model = &result->import.model;
    assert_int_equal(model->full.wood_index_count / 3, 8);
    assert_int_equal(test_leaf_triangles(&model->full), 2);
    assert_float_equal(model->height_m, 3.1f, 1e-4);
    assert_float_equal(model->full.min_m[0], -0.1f, 1e-4);
    assert_float_equal(model->full.max_m[0], 1.0f, 1e-4);
    assert_float_equal(model->full.min_m[2], -0.1f, 1e-4); /* the leaf hangs below the foot */
    assert_float_equal(model->dbh_m, 0.24f, 0.05);
    for (uint32_t i = 0; i < model->full.index_count; i++) {
        uint32_t kind = model->full.vertices[model->full.indices[i]].kind;
        assert_int_equal((kind & WD_VERTEX_LEAF) != 0, i >= model->full.wood_index_count);
    }
    drop(result);
}

/* Some exporters leave out the zero before the point; materials may begin with one, too. */
static void numbers_may_begin_with_the_point(void **state)
{
    (void)state;
    write_text("short.mtl", "newmtl .5bark\nKd .3 .2 .1\nnewmtl Blatt\nKd .1 .4 .1\n");
    write_text("short.obj", "mtllib short.mtl\no tree\nv 0 -.25 0\nv\t.5 0 0\nv .5 5 .25\n"
                            "v 0 5 -.25\nvt .5 .5\nusemtl .5bark\nf 1/1 2/1 3/1 4/1\n"
                            "v .75 5.5 .125\nusemtl Blatt\nf 3/1 4/1 5/1\n");
    struct result *result = import("short.obj");
    if (!result->ok)
        fail_msg("%s", result->record.text);
    assert_int_equal(result->import.model.full.wood_index_count / 3, 2);
    assert_int_equal(test_leaf_triangles(&result->import.model.full), 1);
    assert_float_equal(result->import.model.height_m, 5.75f, 1e-3);
    drop(result);
}

static size_t read_whole(const char *name, char *bytes, size_t most)
{
    char *path = path_of(name);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t size = fread(bytes, 1, most, file);
    fclose(file);
    free(path);
    return size;
}

/* The same tree, brought to another format by assimp's own exporter (whose binary FBX not even
 * assimp can read). */
static void convert(const char *from, const char *format, const char *to)
{
    char *source = path_of(from), *target = path_of(to);
    const struct aiScene *scene = aiImportFile(source, aiProcess_Triangulate);
    assert_non_null(scene);
    assert_int_equal(aiExportScene(scene, format, target, 0), aiReturn_SUCCESS);
    aiReleaseImport(scene);
    free(source);
    free(target);
}

static void other_formats_hold_the_same_tree(void **state)
{
    static const char *const formats[][2] = {
        {"collada", "tree.dae"}, {"fbxa", "tree.fbx"}, {"gltf2", "tree.gltf"},
        {"glb2", "tree.glb"}};
    (void)state;
    write_text("tree.mtl", LIBRARY);
    write_text("tree.obj", "mtllib tree.mtl\no tree\n" TRUNK LEAF);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        convert("tree.obj", formats[i][0], formats[i][1]);
        struct result *result = import(formats[i][1]);
        if (!result->ok)
            fail_msg("%s: %s", formats[i][1], result->record.text);
        const struct wd_tree_model *model = &result->import.model;
        assert_int_equal(model->full.wood_index_count / 3, 8);
        assert_int_equal(test_leaf_triangles(&model->full), 2);
        assert_float_equal(model->height_m, 3.1f, 1e-3);
        drop(result);
    }
}

static void webp_textures_are_told(void **state)
{
    enum { MOST = 1 << 16 };
    static const char extension[] = "{\"extensionsUsed\": [\"EXT_texture_webp\"],";
    char text[MOST + sizeof extension];
    (void)state;
    write_text("plain.mtl", LIBRARY);
    write_text("plain.obj", "mtllib plain.mtl\no tree\n" TRUNK LEAF);
    convert("plain.obj", "gltf2", "plain.gltf");
    size_t used = sizeof extension - 1;
    size_t size = read_whole("plain.gltf", text + used - 1, MOST);
    assert_int_equal(text[used - 1], '{');
    memcpy(text, extension, used);
    write_file("webp.gltf", text, used - 1 + size);
    struct result *result = import("webp.gltf");
    assert_true(result->ok);
    expect_message(result, "EXT_texture_webp");
    drop(result);
}

static void a_species_file_says_height_axis_and_materials(void **state)
{
    (void)state;
    write_text("tree.mtl", LIBRARY);
    write_text("up.obj", "mtllib tree.mtl\no tree\nv 0 0 0\nv 1 0 0\nv 0 0 5\nusemtl Bark\n"
                         "f 1 2 3\nv 0 1 5\nusemtl Blatt\nf 2 3 4\n");
    write_text("up.json", "{\"name\": \"up\", \"model\": {\"file\": \"up.obj\", \"height_m\": 10,"
                          " \"up\": \"z\", \"leaves\": [\"Bark\"], \"wood\": [\"Blatt\"]}}");
    struct result *result = import("up.json");
    assert_true(result->ok);
    assert_float_equal(result->import.model.height_m, 10, 1e-4);
    assert_int_equal(test_leaf_triangles(&result->import.model.full), 1);
    expect_message(result, "leaves (Bark)");
    drop(result);
    write_text("bad.json", "{\"name\": \"up\", \"model\": {\"file\": \"up.obj\", \"leaves\": "
                           "[\"Brak\"]}}");
    result = import("bad.json");
    assert_false(result->ok);
    expect_message(result, "no material \"Brak\"");
    expect_message(result, "Bark, Blatt");
    drop(result);
}

static void strays_are_dropped_and_told(void **state)
{
    (void)state;
    write_text("tree.mtl", LIBRARY);
    write_text("stray.obj", "mtllib tree.mtl\no tree\n" TRUNK LEAF
                            "f 1 1 2\nf 1 2 2\nl 1 2\nl 3 4\np 5\n");
    struct result *result = import("stray.obj");
    assert_true(result->ok);
    assert_int_equal(result->import.model.full.index_count / 3, 10);
    expect_message(result, "left out");
    expect_message(result, "2 lines");
    drop(result);
}

static void what_cannot_be_is_told(void **state)
{
    (void)state;
    write_text("far.obj", "o crown\nv 0 0 0\nv 1e30 1 0\nv 0 1 0\nf 1 2 3\n");
    expect_refusal("far.obj", "mesh crown");
    write_text("points.obj", "o none\nv 0 0 0\nv 1 0 0\nv 0 1 0\np 1\np 2\n");
    expect_refusal("points.obj", "no triangles");
    write_text("flat.obj", "o none\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    expect_refusal("flat.obj", "has an area");
    write_text("level.obj", "o none\nv 0 0 -1\nv 1 0 -1\nv 0 0 1\nf 1 2 3\n");
    expect_refusal("level.obj", "no height");
    write_text("range.obj", "o none\nv 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 99999\n");
    expect_refusal("range.obj", "");
    write_text("empty.obj", "");
    expect_refusal("empty.obj", "");
    write_text("noise.glb", "glTF\2\0\0\0 and then nothing that makes sense");
    expect_refusal("noise.glb", "");
    struct result *result = import("missing.obj");
    assert_false(result->ok);
    expect_message(result, "no such file");
    drop(result);
}

static void a_missing_texture_is_a_warning(void **state)
{
    (void)state;
    write_text("lost.mtl", "newmtl Bark\nmap_Kd no-such.png\nnewmtl Blatt\nmap_Kd broken.jpg\n"
                           "newmtl Apfel\nmap_Kd apple.webp\n");
    write_text("apple.webp", "RIFF----WEBPVP8 and so on");
    write_text("broken.jpg", "\xff\xd8 this is no JPEG");
    write_text("lost.obj", "mtllib lost.mtl\no tree\n" TRUNK LEAF
                           "v 0 0 0\nv 9 0 0\nv 0 9 0\nusemtl Apfel\nf 13 14 15\n");
    struct result *result = import("lost.obj");
    assert_true(result->ok);
    expect_message(result, "no-such.png");
    expect_message(result, "broken.jpg");
    expect_message(result, "apple.webp cannot be used: it is WebP");
    drop(result);
}

static void missing_materials_are_warnings(void **state)
{
    static const char *const files[][2] = {
        {"mtllib no-such.mtl\n" TRUNK LEAF, "no-such.mtl is not there: grey stands in"},
        {TRUNK LEAF, "names materials (usemtl) but no library that has them (mtllib): grey"}};
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        write_text("bare.obj", files[i][0]);
        struct result *result = import("bare.obj");
        assert_true(result->ok);
        expect_message(result, files[i][1]);
        drop(result);
    }
}

static void marks_of_byte_order_are_no_text(void **state)
{
    (void)state;
    write_text("mark.mtl", "\xef\xbb\xbf" LIBRARY);
    write_text("mark.obj", "\xef\xbb\xbfv 490 0 -10\n" /* the first vertex, which all indices count */
                           "v 510 0 -10\nv 510 300 10\nmtllib mark.mtl\nusemtl Blatt\nf 1 2 3\n");
    struct result *result = import("mark.obj");
    if (!result->ok)
        fail_msg("%s", result->record.text);
    assert_int_equal(test_leaf_triangles(&result->import.model.full), 1);
    expect_message(result, "of leaves (Blatt)");
    assert_null(strstr(result->record.text, "grey"));
    drop(result);
    write_text("mark.obj", "\xef\xbb\xbfmtllib mark.mtl\n" TRUNK);
    result = import("mark.obj");
    assert_true(result->ok);
    const struct wd_model_file *file = &result->import.file;
    bool found = false; /* the library's first */
    for (uint32_t i = 0; i < file->material_count; i++)
        found = found || (strcmp(file->materials[i].name, "Bark") == 0 && file->materials[i].color[0] == 0.3f);
    assert_true(found);
    drop(result);
}

/* Where a skin has no matrices, assimp 5.2 ends the process. */
static void skins_are_passed_over_and_told(void **state)
{
    (void)state;
    write_text("skin.gltf",
               "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0, 1]}], \"nodes\": "
               "[{\"mesh\": 0, \"skin\" : 0, \"name\": \"skin\"}, {\"name\": \"root\"}], \"meshes\": [{\"primitives\": "
               "[{\"attributes\": {\"POSITION\": 0}}]}], \"buffers\": [{\"byteLength\": 36, \"uri\": \"skin.bin\"}], "
               "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"accessors\": [{\"bufferView\": 0, "
               "\"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", \"min\": [0, 0, 0], \"max\": [1, 3, 0]}], "
               "\"skins\": [{\"joints\": [1]}]}");
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 3, 0};
    write_file("skin.bin", corners, sizeof corners);
    struct result *result = import("skin.gltf");
    if (!result->ok)
        fail_msg("%s", result->record.text);
    expect_message(result, "has skins, which are not read");
    assert_float_equal(result->import.model.height_m, 3, 1e-4);
    drop(result);
}

static void holes_of_textures_reach_the_look(void **state)
{
    (void)state;
    enum { SIZE = 32 };
    struct wd_model_image image = {SIZE, SIZE, wd_alloc(4 * SIZE * SIZE)};
    for (int i = 0; i < SIZE * SIZE; i++)
        memcpy(image.rgba + 4 * i, (uint8_t[4]){30, 120, 20, i % SIZE < SIZE / 2 ? 255 : 0}, 4);
    size_t size;
    uint8_t *png = wd_model_image_encode(&image, &size);
    write_file("half.png", png, size);
    write_text("half.mtl", "newmtl Bark\nKd 0.3 0.2 0.1\nnewmtl Karte\nmap_Kd half.png\n"
                           "map_d half.png\n");
    write_text("half.obj", "mtllib half.mtl\no tree\nv 0 0 0\nv 1 0 0\nv 1 9 0\nv 0 9 0\n"
                           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl Karte\nf 1/1 2/2 3/3 4/4\n");
    struct result *result = import("half.obj");
    assert_true(result->ok);
    assert_int_equal(result->import.model.full.wood_index_count, 0);
    uint8_t albedo[4 * 64 * 64], detail[4 * 64 * 64];
    const struct wd_look_map map = {64, albedo, detail};
    wd_tree_import_look(&result->import, &map, WD_LOOK_LEAF);
    int holes = 0;
    for (int i = 0; i < 64 * 64; i++)
        holes += albedo[4 * i + 3] < 128;
    assert_in_range(holes, 64 * 64 * 2 / 5, 64 * 64 * 3 / 5);
    drop(result);
    free(png);
    wd_model_image_finish(&image);
}

static void many_triangles_are_reduced_by_count(void **state)
{
    (void)state;
    enum { LEAVES = 20000 };
    char *text = wd_alloc(LEAVES * 120 + 4096), *end = text;
    end += sprintf(end, "mtllib tree.mtl\no tree\n" TRUNK "usemtl Blatt\n");
    for (int i = 0; i < LEAVES; i++) {
        int x = 300 + i % 400, y = 300 + i / 400 * 10, z = i * 7919 % 400 - 200;
        end += sprintf(end, "v %d %d %d\nv %d.5 %d %d\nv %d %d.5 %d\nf -3 -2 -1\n", x, y, z, x, y,
                       z, x, y, z);
    }
    write_text("tree.mtl", LIBRARY);
    write_text("many.obj", text);
    free(text);
    struct result *result = import("many.obj");
    assert_true(result->ok);
    const struct wd_tree_model *model = &result->import.model;
    assert_int_equal(test_leaf_triangles(&model->full), LEAVES);
    uint32_t kept = test_leaf_triangles(&model->reduced);
    assert_in_range(kept, 5000, 6000);
    double full = test_leaf_area(&model->full, 0, LEAVES);
    assert_float_equal(test_leaf_area(&model->reduced, 0, kept) / full, 1, 0.05);
    drop(result);
}

/* --- files of our own, whole and damaged -------------------------------------------------- */

static void export_one(const char *name, const struct wd_export_tree *tree, const struct wd_log *log, bool expected)
{
    const struct wd_export what = {.trees = tree, .tree_count = 1};
    char *path = path_of(name);
    bool glb = strstr(name, ".glb") != NULL;
    bool ok = glb ? wd_export_glb(&what, path, log) == WD_OK : wd_export_obj(&what, path, log);
    assert_int_equal(ok, expected);
    free(path);
}

static struct wd_tree_model export_oak(const char *name)
{
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "oak");
    struct wd_tree_model model;
    const struct wd_grow_params params = {.seed = 3, .height_m = 4, .detail = 0.2f};
    assert_true(wd_tree_grow(&model, &species, &params, NULL));
    const struct wd_export_tree tree = {
        .name = "oak", .species = &species, .levels = {&model.full, &model.reduced},
        .level_count = 2};
    export_one(name, &tree, NULL, true);
    wd_arena_finish(&arena);
    return model;
}

static void exported_trees_come_back(void **state)
{
    (void)state;
    static const char *const names[] = {"oak.glb", "oak.obj"};
    for (int i = 0; i < 2; i++) {
        struct wd_tree_model model = export_oak(names[i]);
        struct result *result = import(names[i]);
        assert_true(result->ok);
        const struct wd_tree_mesh *mesh = &result->import.model.full;
        assert_int_equal(mesh->wood_index_count, model.full.wood_index_count);
        assert_in_range(mesh->index_count, model.full.index_count * 98 / 100,
                        model.full.index_count);
        assert_float_equal(result->import.model.height_m, model.height_m, 0.05); /* the flare ends below ground */
        drop(result);
        wd_tree_model_finish(&model);
    }
}

/* To 0.1 mm, with points, wherever a tree stands and whatever numbers look like to the program around. */
static void places_in_text_are_exact(void **state)
{
    (void)state;
    enum { MOST = 64 << 20 };
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "fern");
    struct wd_tree_model model = test_grow_tree(&species, 1, 0, 0);
    const struct wd_export_tree tree = {
        .name = "fern", .species = &species, .levels = {&model.full}, .level_count = 1, .place_m = 1234.5};
    setlocale(LC_NUMERIC, "de_DE.UTF-8"); /* where there is one */
    export_one("far.obj", &tree, NULL, true);
    setlocale(LC_NUMERIC, "C");
    char *text = malloc(MOST);
    text[read_whole("far.obj", text, MOST - 1)] = '\0';
    uint32_t count = 0;
    for (char *line = text, *end; count < model.full.vertex_count && (end = strchr(line, '\n')); line = end + 1) {
        *end = '\0'; /* what looks for the end of a string would go to the text's for each line */
        if (strncmp(line, "v ", 2) != 0)
            continue;
        const struct wd_tree_vertex *vertex = &model.full.vertices[count++];
        char *rest;
        double x = strtod(line + 2, &rest), y = strtod(rest, NULL);
        assert_float_equal(x, 1234.5 + (double)vertex->position_m[0], 6e-5);
        assert_float_equal(y, (double)vertex->position_m[2], 6e-5);
    }
    assert_int_equal(count, model.full.vertex_count);
    free(text);
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
}

static void ids_that_no_float_holds_are_refused(void **state)
{
    (void)state;
    struct wd_arena arena = {0};
    struct wd_species species = test_species(&arena, "fern");
    struct wd_tree_model model = test_grow_tree(&species, 1, 0, 0);
    struct wd_export_instance places[2] = {{.across = 1, .up = 1, .id = 1u << 24}, {.across = 1, .up = 1, .id = 1}};
    const struct wd_export_tree tree = {.name = "fern", .species = &species, .levels = {&model.full},
                                        .level_count = 1, .instances = places, .instance_count = 2};
    struct test_log log;
    test_log_init(&log);
    export_one("ids.glb", &tree, &log.log, true);
    places[1].id = (1u << 24) + 1;
    export_one("over.glb", &tree, &log.log, false);
    assert_non_null(strstr(log.message, "16777217"));
    wd_tree_model_finish(&model);
    wd_arena_finish(&arena);
}

/* The first bytes of the binary chunk are the first vertex's position. */
static void a_position_that_is_no_number_is_an_error(void **state)
{
    (void)state;
    enum { MOST = 8 << 20, HEADER = 20, CHUNK_HEADER = 8 };
    struct wd_tree_model model = export_oak("number.glb");
    wd_tree_model_finish(&model);
    char *bytes = malloc(MOST);
    size_t size = read_whole("number.glb", bytes, MOST);
    uint32_t json_size;
    const float none = NAN;
    memcpy(&json_size, bytes + 12, sizeof json_size);
    memcpy(bytes + HEADER + json_size + CHUNK_HEADER, &none, sizeof none);
    write_file("nan.glb", bytes, size);
    expect_refusal("nan.glb", "mesh oak LOD0");
    free(bytes);
}

/* A GLB of one mesh: JSON, then nine 16-bit indices and four positions. */
static void write_glb(const char *name, uint16_t index, int length_off)
{
    static const char json[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":1},\"indices\":0}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5123,\"count\":9,\"type\":\"SCALAR\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":18},"
        "{\"buffer\":0,\"byteOffset\":20,\"byteLength\":48}],\"buffers\":[{\"byteLength\":68}]}";
    const uint16_t indices[10] = {0, 1, 2, 0, 1, index, 1, 2, 3, 0};
    const float positions[12] = {0, 0, 0, 1, 0, 0, 0, 4, 0, 1, 4, 0};
    enum { JSON = (sizeof json + 2) / 4 * 4, BINARY = sizeof indices + sizeof positions,
           WHOLE = 12 + 8 + JSON + 8 + BINARY };
    const uint32_t head[5] = {0x46546c67, 2, (uint32_t)(WHOLE + length_off), JSON, 0x4e4f534a};
    const uint32_t binary[2] = {BINARY, 0x004e4942};
    uint8_t bytes[WHOLE];
    memset(bytes, ' ', sizeof bytes);
    memcpy(bytes, head, sizeof head);
    memcpy(bytes + sizeof head, json, sizeof json - 1);
    memcpy(bytes + sizeof head + JSON, binary, sizeof binary);
    memcpy(bytes + WHOLE - BINARY, indices, sizeof indices);
    memcpy(bytes + WHOLE - sizeof positions, positions, sizeof positions);
    write_file(name, bytes, sizeof bytes);
}

static void triangles_left_out_are_told(void **state)
{
    (void)state;
    write_glb("nine.glb", 9, 0);
    struct result *result = import("nine.glb");
    assert_true(result->ok);
    assert_int_equal(result->import.model.full.index_count / 3, 2);
    expect_message(result, "out-of-range indices");
    drop(result);
    write_glb("whole.glb", 3, 0);
    result = import("whole.glb");
    assert_true(result->ok);
    assert_int_equal(result->import.model.full.index_count / 3, 3);
    assert_null(strstr(result->record.text, "out-of-range"));
    drop(result);
}

/* More triangles than are kept, each across the whole model: no two can be joined. */
static void a_soup_of_triangles_is_thinned_out(void **state)
{
    (void)state;
    enum { VERTICES = 3000, TRIANGLES = 1000000, MOST = 600000 };
    static struct {
        float positions[3 * VERTICES];
        uint32_t indices[3 * TRIANGLES];
    } soup;
    for (uint32_t i = 0; i < 3 * VERTICES; i++)
        soup.positions[i] = (float)(wd_hash1(i) % 10000) * 1e-3f;
    for (uint32_t i = 0; i < 3 * TRIANGLES; i++)
        soup.indices[i] = wd_hash1(~i) % VERTICES;
    write_file("soup.bin", &soup, sizeof soup);
    write_text("soup.gltf",
               "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
               "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
               "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3000,\"type\":\"VEC3\"},"
               "{\"bufferView\":1,\"componentType\":5125,\"count\":3000000,\"type\":\"SCALAR\"}],"
               "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36000},"
               "{\"buffer\":0,\"byteOffset\":36000,\"byteLength\":12000000}],"
               "\"buffers\":[{\"uri\":\"soup.bin\",\"byteLength\":12036000}]}");
    struct result *result = import("soup.gltf");
    assert_true(result->ok);
    assert_in_range(result->import.model.full.index_count / 3, MOST * 9 / 10, MOST);
    drop(result);
}

static void a_length_that_is_not_the_files_is_told(void **state)
{
    (void)state;
    write_glb("longer.glb", 3, 100);
    expect_refusal("longer.glb", "is malformed: its header says");
    write_glb("shorter.glb", 3, -40);
    expect_refusal("shorter.glb", "is malformed: its header says");
}

/* Their squares are infinite. */
static void normals_that_are_no_direction_are_told(void **state)
{
    (void)state;
    write_text("normals.obj", "v 0 0 0\nv 1 0 0\nv 1 3 0\nv 0 3 0\nvn 3e38 3e38 3e38\n"
                              "f 1//1 2//1 3//1\nf 1//1 3//1 4//1\n");
    struct result *result = import("normals.obj");
    assert_true(result->ok);
    expect_message(result, "6 corners have normals that are no finite numbers");
    float normal[3];
    wd_unpack_normal(result->import.model.full.vertices[0].normal, normal);
    assert_float_equal(normal[2], 1, 1e-3);
    drop(result);
}

static void damaged_files_end_in_a_message_or_a_tree(void **state)
{
    (void)state;
    enum { CASES = 40, MOST = 8 << 20 };
    struct wd_tree_model model = export_oak("whole.glb");
    wd_tree_model_finish(&model);
    char *bytes = malloc(MOST);
    size_t size = read_whole("whole.glb", bytes, MOST);
    uint32_t random = 1;
    int refused = 0;
    for (int i = 0; i < CASES; i++) {
        char *damaged = malloc(size);
        size_t length = size;
        memcpy(damaged, bytes, size);
        if (i % 2 == 0) /* cut */
            length = size * (size_t)(i + 1) / (CASES + 2);
        for (int k = 0; k < 12 && i % 2; k++) { /* flipped, half of it in the JSON */
            random = random * 1664525u + 1013904223u;
            damaged[(k % 2 ? 20 + random % 4000 : random % size)] ^= (char)(1 << random % 7);
        }
        write_file("damaged.glb", damaged, length);
        struct result *result = import("damaged.glb");
        refused += !result->ok;
        if (!result->ok)
            expect_message(result, "damaged.glb");
        drop(result);
        free(damaged);
    }
    free(bytes);
    assert_in_range(refused, CASES / 2, CASES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tree_stands_on_its_foot_in_metres),
        cmocka_unit_test(numbers_may_begin_with_the_point),
        cmocka_unit_test(other_formats_hold_the_same_tree),
        cmocka_unit_test(webp_textures_are_told),
        cmocka_unit_test(a_species_file_says_height_axis_and_materials),
        cmocka_unit_test(strays_are_dropped_and_told),
        cmocka_unit_test(triangles_left_out_are_told),
        cmocka_unit_test(a_soup_of_triangles_is_thinned_out),
        cmocka_unit_test(a_length_that_is_not_the_files_is_told),
        cmocka_unit_test(what_cannot_be_is_told),
        cmocka_unit_test(a_missing_texture_is_a_warning),
        cmocka_unit_test(missing_materials_are_warnings),
        cmocka_unit_test(marks_of_byte_order_are_no_text),
        cmocka_unit_test(skins_are_passed_over_and_told),
        cmocka_unit_test(holes_of_textures_reach_the_look),
        cmocka_unit_test(many_triangles_are_reduced_by_count),
        cmocka_unit_test(exported_trees_come_back),
        cmocka_unit_test(places_in_text_are_exact),
        cmocka_unit_test(ids_that_no_float_holds_are_refused),
        cmocka_unit_test(a_position_that_is_no_number_is_an_error),
        cmocka_unit_test(normals_that_are_no_direction_are_told),
        cmocka_unit_test(damaged_files_end_in_a_message_or_a_tree),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
