/* The shader plants the same forest as the CPU, tree by tree and bit by bit. */
#include "../gpu/gpu_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "small_scene.h"
#include "world/placement.h"

static const uint32_t place_comp[] =
#include "place.comp.inc"
    ;

struct stage {
    struct small_scene small;
    struct wd_terrain terrain;
    struct wd_placement placement;
};

static void stage_init(struct stage *stage)
{
    small_scene_init(&stage->small);
    small_scene_hills(&stage->small);
    struct wd_scene_layer *layer = small_scene_layer(&stage->small);
    layer->density = 0.9;
    layer->slope_deg[0] = 2.0f;
    layer->slope_deg[1] = 35.0f;
    layer->slope_fade_deg = 10.0;
    layer->altitude_m[0] = 110.0;
    layer->altitude_m[1] = 380.0;
    layer->altitude_fade_m = 60.0;
    layer->patchiness = 0.6;
    layer->patch_size_m = 83.0;
    stage->small.scene.water.enabled = true;
    stage->small.scene.water.level_m = 130.0;
}

/* A probability map of odd cells and some holes, so that every rule has its say. */
static void stage_open(struct stage *stage, uint32_t map_kind)
{
    assert_true(wd_terrain_init(&stage->terrain, &stage->small.scene, 7, 0, 0, NULL, NULL));
    size_t samples = (size_t)stage->terrain.width * stage->terrain.height;
    stage->terrain.hole = wd_alloc(samples);
    for (uint32_t i = 0; i < samples; i++)
        stage->terrain.hole[i] = wd_hash2(3, i) % 50 == 0;
    const struct wd_placement_params params = {.scene = &stage->small.scene,
                                               .terrain = &stage->terrain, .seed = 11};
    assert_true(wd_placement_init(&stage->placement, &params, 0));
    struct wd_place_layer *layer = &stage->placement.input.layer;
    layer->map_kind = map_kind;
    layer->map_width = 61;
    layer->map_height = 47;
    layer->map_axis[0] = wd_axis_of(2000000.0 / 61.0);
    layer->map_axis[1] = wd_axis_of(2000000.0 / 47.0);
    layer->map_half_mm[0] = (uint32_t)(1000000.0 / 61.0);
    layer->map_half_mm[1] = (uint32_t)(1000000.0 / 47.0);
    stage->placement.map = wd_alloc_array(61 * 47, sizeof(float));
    for (uint32_t i = 0; i < 61 * 47; i++)
        stage->placement.map[i] = wd_hash_unit(wd_hash2(5, i));
    stage->placement.input.map = stage->placement.map;
}

static void stage_close(struct stage *stage)
{
    wd_placement_finish(&stage->placement);
    wd_terrain_finish(&stage->terrain);
}

static struct wd_buffer upload(struct gpu_test *test, const void *data, size_t size)
{
    struct wd_buffer buffer = make_buffer(test, (size + 3) / 4 * 4);
    assert_true(wd_buffer_upload(&test->gpu, &buffer, 0, data, size));
    return buffer;
}

/* Plants `count` cells from `first` on the device. */
static void plant_there(struct gpu_test *test, const struct stage *stage, uint32_t first,
                        uint32_t count, struct wd_tree *trees)
{
    struct {
        struct wd_place_layer layer;
        struct wd_place_ground ground;
    } told = {stage->placement.input.layer, stage->placement.input.ground.ground};
    size_t samples = (size_t)stage->terrain.width * stage->terrain.height;
    uint32_t slots = told.layer.count_size;
    struct wd_pipeline pipeline = make_compute(test, SPIRV(place_comp),
        BINDINGS(STORAGE, STORAGE, STORAGE, STORAGE, STORAGE, STORAGE), 12);
    struct wd_buffer buffers[6] = {
        upload(test, &told, sizeof told),
        upload(test, stage->terrain.height_m, samples * sizeof(float)),
        upload(test, stage->terrain.hole, samples),
        upload(test, stage->placement.map, 61 * 47 * sizeof(float)),
        upload(test, stage->placement.table, stage->placement.table_count * sizeof(uint32_t)),
        make_buffer(test, (VkDeviceSize)count * slots * sizeof *trees),
    };
    struct wd_cmd cmd = begin_frame(test);
    struct wd_binding bindings[6];
    for (int i = 0; i < 6; i++) {
        wd_cmd_use_buffer(&cmd, &buffers[i], i < 5 ? WD_USE_COMPUTE_READ : WD_USE_COMPUTE_WRITE);
        bindings[i] = WD_BIND_BUFFER(&buffers[i]);
    }
    wd_cmd_bind(&cmd, &pipeline, bindings);
    wd_cmd_push(&cmd, &pipeline, (uint32_t[]){first, count, slots}, 12);
    wd_cmd_dispatch_1d(&cmd, (count + 63) / 64);
    finish_frame(test, &cmd);
    assert_true(wd_buffer_read(&test->gpu, &buffers[5], 0, trees,
                               (VkDeviceSize)count * slots * sizeof *trees));
    for (int i = 0; i < 6; i++)
        wd_buffer_finish(&buffers[i], &test->gpu);
}

/* The same cells here; returns how many trees were accepted. */
static size_t plant_here(const struct stage *stage, uint32_t first, uint32_t count,
                         struct wd_tree *trees)
{
    const struct wd_place_input *input = &stage->placement.input;
    size_t accepted = 0;
    for (uint32_t index = 0; index < count; index++) {
        uint32_t at = first + index, sub_cell = 0;
        struct wd_place_cell cell = wd_place_open_cell(input, at % input->layer.columns,
                                                       at / input->layer.columns);
        for (uint32_t i = 0; i < cell.count; i++) {
            sub_cell = wd_place_sub_cell(cell, sub_cell, i);
            struct wd_tree tree = wd_place_candidate(input, cell, sub_cell, i);
            trees[(size_t)index * input->layer.count_size + i] = tree;
            accepted += tree.size != 0;
            sub_cell++;
        }
    }
    return accepted;
}

static void compare(struct gpu_test *test, struct stage *stage, uint32_t first, uint32_t count)
{
    size_t slots = (size_t)count * stage->placement.input.layer.count_size;
    struct wd_tree *here = wd_alloc_array(slots, sizeof *here);
    struct wd_tree *there = wd_alloc_array(slots, sizeof *there);
    size_t accepted = plant_here(stage, first, count, here);
    plant_there(test, stage, first, count, there);
    print_message("%u cells, %zu slots, %zu trees accepted\n", count, slots, accepted);
    assert_in_range(accepted, slots / 50, slots * 9 / 10);
    for (size_t i = 0; i < slots; i++)
        if (memcmp(&here[i], &there[i], sizeof here[i]) != 0)
            fail_msg("slot %zu: (%d, %d, %d) size %08x here, (%d, %d, %d) size %08x there", i,
                     here[i].x_mm, here[i].y_mm, here[i].z_mm, here[i].size, there[i].x_mm,
                     there[i].y_mm, there[i].z_mm, there[i].size);
    free(here);
    free(there);
}

static void grid_layer_is_equal(void **state)
{
    struct stage stage = {0};
    stage_init(&stage);
    stage_open(&stage, WD_PLACE_MAP_LINEAR);
    const struct wd_place_layer *layer = &stage.placement.input.layer;
    assert_true(layer->columns * layer->rows >= 250000);
    compare(*state, &stage, 0, layer->columns * layer->rows);
    stage_close(&stage);
}

static void part_of_a_layer_is_equal(void **state)
{
    struct stage stage = {0};
    stage_init(&stage);
    stage.small.scene.terrain.cell_m = 7.31;
    stage_open(&stage, WD_PLACE_MAP_NEAREST);
    compare(*state, &stage, 123457, 1001);
    stage_close(&stage);
}

static void poisson_layer_is_equal(void **state)
{
    struct stage stage = {0};
    stage_init(&stage);
    stage.small.layers[0].placement = WD_PLACE_POISSON;
    stage.small.layers[0].spacing_m = 23.7;
    stage.small.layers[0].density = 14.0;
    stage_open(&stage, WD_PLACE_MAP_NEAREST);
    const struct wd_place_layer *layer = &stage.placement.input.layer;
    compare(*state, &stage, 0, layer->columns * layer->rows);
    stage_close(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(grid_layer_is_equal, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(part_of_a_layer_is_equal, gpu_setup, gpu_teardown),
        cmocka_unit_test_setup_teardown(poisson_layer_is_equal, gpu_setup, gpu_teardown),
    };
    return cmocka_run_group_tests_name("place-gpu", tests, NULL, NULL);
}
