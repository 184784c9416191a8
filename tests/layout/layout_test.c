/* The structs of shaders/shared have the same offsets in C as in compiled SPIR-V. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "shared/bake.h"
#include "shared/card_soup.h"
#include "shared/continuum.h"
#include "shared/crown_sky.h"
#include "shared/forest.h"
#include "shared/frame.h"
#include "shared/light.h"

static const uint32_t words[] =
#include "layout.comp.inc"
    ;
enum { WORD_COUNT = sizeof words / sizeof *words };

struct member {
    const char *type, *name;
    size_t offset;
};
#define M(type, name) {#type, #name, offsetof(struct type, name)}

static const struct member members[] = {
    M(wd_point_gains, gains),
    M(wd_splat, xy), M(wd_splat, z_normal), M(wd_splat_corner, at), M(wd_splat_corner, uv), M(wd_splat_corner, tint),
    M(wd_cluster, min_mm), M(wd_cluster, max_mm), M(wd_cluster, first), M(wd_cluster, count), M(wd_splat_lost, trees),
    M(wd_splat_lost, items), M(wd_large_part, id), M(wd_large_part, part), M(wd_cascade_push, layer),
    M(wd_cascade_push, has_drawn), M(wd_splat_item, tree), M(wd_splat_item, parts),
#define S(name) M(wd_splat_model, name)
    S(wood), S(leaf), S(light), S(wood_light), S(min_m), S(extent_m), S(leaf_area_m2), S(wood_area_m2), S(strata_top_m),
    S(lower_over_upper), S(lower), S(wood_falls), S(grain), S(finer), S(wood_first), S(wood_count), S(wood_corners),
    S(wood_stem), S(wood_far_stem), S(leaf_past_bark), S(thin_share), S(thin_wood), S(bare_thin),
#define V(name) M(wd_splat_view, name)
    V(clip_from_rel), V(planes), V(plane_count), V(calm), V(pixels), V(near_m), V(typical_m), V(width),
    V(height), V(texels), V(density), V(detail), V(min_splats), V(near_leaves_m), V(near_grains), V(wood_px),
    V(cluster_count), V(variants), V(page_count), V(slopes_scale), V(slopes_offset), V(slopes_texel_m), V(tree_capacity),
    V(item_capacity), V(has_history), V(moved), V(still), V(put_off_words), V(history_from_rel), V(slice),
    V(cascade_records), V(cascade_whole_m), V(pyramid_first),
#define C(name) M(wd_splat_counts, name)
    C(clusters), C(trees), C(items), C(small_items), C(wood_items), C(put_off), C(done_items), C(done_small),
    C(done_wood),
#define T(name) M(wd_splat_tree, name)
    T(clip_x), T(clip_y), T(clip_w), T(sway), T(radius), T(facing), T(wood_radius), T(tree), T(first_splat), T(offset),
    T(strata), T(first_wood), T(turn), T(shape), T(tint), T(lower), T(sun), T(eye), T(nearer_m),
#define G(name) M(wd_splat_groups, name)
    G(select), G(splat), G(small), G(all_splats), G(wood), G(sort),
    M(wd_bake_shot, x), M(wd_bake_shot, y), M(wd_bake_shot, depth),
    M(wd_bake_push, shot), M(wd_bake_push, shot_index), M(wd_bake_push, triangle_count),
    M(wd_bake_push, first_triangle), M(wd_bake_push, width), M(wd_bake_push, height),
    M(wd_bake_push, samples), M(wd_bake_push, wood_triangles), M(wd_bake_push, look_layer), M(wd_bake_push, leaf_sums),
    M(wd_packed_tree, x_kind), M(wd_packed_tree, y_look), M(wd_packed_tree, z_height),
    M(wd_packed_tree, crown_look),
    M(wd_tree_block, x_mm), M(wd_tree_block, y_mm), M(wd_tree_block, z_mm), M(wd_tree_block, steps),
    M(wd_tree_vertex, position_m), M(wd_tree_vertex, normal), M(wd_tree_vertex, uv),
    M(wd_tree_vertex, tint), M(wd_tree_vertex, kind),
    M(wd_tree_point, position_m), M(wd_tree_point, normal), M(wd_tree_point, face), M(wd_tree_point, albedo),
    M(wd_tree_point, kind),
    M(wd_model, height_m), M(wd_model, crown_m), M(wd_model, half_width_m),
    M(wd_model, half_depth_m), M(wd_model, bottom_m), M(wd_model, top_m), M(wd_model, flexibility),
    M(wd_model, look_layer), M(wd_model, card_layer), M(wd_model, transmittance),
    M(wd_model, crown_base_m), M(wd_model, roughness), M(wd_model, moss),
    M(wd_model, fall_mps), M(wd_model, phase), M(wd_model, behind), M(wd_model, ahead),
    M(wd_leaf_growths, of), M(wd_model, full_growth), M(wd_model, reduced_growth),
    M(wd_model, seen_m2), M(wd_model, wood_seen), M(wd_model, stem_seen), M(wd_model, mixed),
    M(wd_layer_fade, near_begin_m), M(wd_layer_fade, near_end_m), M(wd_layer_fade, far_begin_m),
    M(wd_layer_fade, far_end_m),
    M(wd_instance, tree), M(wd_instance, show),
    M(wd_tree_push, variants), M(wd_tree_push, cascade), M(wd_tree_push, level),
    M(wd_tree_push, show), M(wd_tree_push, pixels_per_radian),
    M(wd_tree_push, card_vertices), M(wd_tree_push, spray_reach),
    M(wd_tree_push, leaf_m), M(wd_tree_push, leaf_count), M(wd_tree_push, leaf_most),
    M(wd_spray_instance, tree), M(wd_spray_instance, leaf),
    M(wd_tree_leaf, xy), M(wd_tree_leaf, z_size), M(wd_tree_leaf, turn),
    M(wd_tree_leaf, shading), M(wd_tree_leaf, tint), M(wd_tree_leaf, open),
    M(wd_packed_vertex, xy), M(wd_packed_vertex, z_kind), M(wd_packed_vertex, uv),
    M(wd_packed_vertex, normal_tint),
    M(wd_leaf_vertex, place), M(wd_leaf_vertex, normal), M(wd_leaf_vertex, uv),
    M(wd_leaf_vertex, kind),
    M(wd_mesh_box, least_m), M(wd_mesh_box, step_m), M(wd_leaf_box, feet),
    M(wd_leaf_box, size_step_m),
    M(wd_mesh_push, tree), M(wd_mesh_push, box), M(wd_mesh_push, own),
    M(wd_mesh_push, arch_least), M(wd_mesh_push, arch_range), M(wd_mesh_push, first_leaf),
    M(wd_mesh_push, first_corner), M(wd_mesh_push, corner_count), M(wd_mesh_push, forms),
    M(wd_mesh_push, corner_bits), M(wd_mesh_push, first_name),
    M(wd_spray_push, tree), M(wd_spray_push, leaves), M(wd_spray_push, twig),
    M(wd_card_chunk, first_tree), M(wd_card_chunk, trees_slots),
    M(wd_card_flat, turn), M(wd_card_flat, tint_show), M(wd_card_flat, normal),
    M(wd_card_flat, ratio_flags), M(wd_card_flat, layer_lod), M(wd_card_flat, random_stem),
    M(wd_card_flat, surface), M(wd_card_flat, mixed),
    M(wd_card_vertex, clip), M(wd_card_vertex, layer_lod), M(wd_card_vertex, random_show),
    M(wd_card_vertex, card),
    M(wd_cull_planes, plane),
    M(wd_card_soup_push, chunk_count), M(wd_card_soup_push, variants),
    M(wd_card_soup_push, cascade), M(wd_card_soup_push, pixels_per_radian),
    M(wd_draw_indexed, index_count), M(wd_draw_indexed, instance_count),
    M(wd_draw_indexed, first_index), M(wd_draw_indexed, vertex_offset),
    M(wd_draw_indexed, first_instance),
    M(wd_sky_crown, foot_mm), M(wd_sky_crown, radius_m), M(wd_sky_crown, half_m), M(wd_sky_crown, middle_m),
    M(wd_sky_crown, per_m), M(wd_sky_crown, steeper), M(wd_sky_crown, stem_radius_m),
    M(wd_crown_sky_job, foot_mm), M(wd_crown_sky_job, crown), M(wd_crown_sky_job, reach_m), M(wd_crown_sky_job, slot),
    M(wd_crown_sky_job, radius_m), M(wd_crown_sky_job, top_m), M(wd_crown_sky_job, ground),
    M(wd_crown_sky_job, ground_across), M(wd_crown_sky_job, rise_m),
    M(wd_crown_sky_push, job_count), M(wd_crown_sky_push, tile_count), M(wd_crown_sky_push, first_column),
    M(wd_crown_sky_push, first_row), M(wd_crown_sky_push, columns), M(wd_crown_sky_push, rows),
    M(wd_crown_sky_push, canopy_from_m), M(wd_crown_sky_push, canopy_scale),
#define L(name) M(wd_light_push, name)
    L(camera_m), L(sun_cell_m), L(sun_soft_m), L(sun_width), L(sun_height), L(variants), L(tile_columns), L(tile_rows),
    L(is_sea), L(has_rivers), L(extent_m), L(canopy_from_m), L(canopy_scale), L(has_overlay), L(eye_over_ground_m),
    L(shafts_m), L(shafts), L(level_cards), L(pixels_a_radian), L(few_tiles), L(floor_sky_m),
#define F(name) M(wd_frame_uniforms, name)
    F(clip_from_rel), F(rel_from_clip), F(previous_clip_from_rel), F(steady_clip_from_rel),
    F(shadow_from_rel), F(cascades), F(camera_mm),
    F(time_s), F(camera_frac_m), F(previous_time_s), F(sun_direction), F(sun_cos_radius),
    F(sun_irradiance), F(sky_turbidity), F(sky_irradiance), F(sky_strength), F(circumsolar), F(sky_glow), F(near_m),
    F(sky_horizon), F(fog_per_m), F(sky_cloud), F(snow), F(sky_turn), F(sky_is_map),
    F(fog_height_m), F(fog_base_m), F(fog_bands), F(fog_over), F(wind_speed_mps), F(wind_gust),
    F(wind_toward), F(water_level_m), F(water_clarity_m), F(water_color), F(exposure), F(grass),
    F(rock_slope), F(soil), F(snow_line_m), F(rock), F(tree_line_m), F(litter), F(terrain_cell_m),
    F(sward), F(sward_share), F(sward_whole_m), F(sward_gone_m),
    F(sky_form), F(sky_under), F(sky_under_tint), F(sky_quarters), F(sky_slant), F(sunward), F(leaf_scatter), F(width), F(height),
    F(terrain_width), F(terrain_height), F(sample_index), F(sample_count), F(adds), F(view_mode),
    F(shadow_taps),
    F(wind_period),
};

enum { OP_NAME = 5, OP_MEMBER_NAME = 6, OP_MEMBER_DECORATE = 72, DECORATION_OFFSET = 35 };

/* Name of a type by its id, or NULL. */
static const char *type_name(uint32_t id)
{
    for (size_t at = 5; at < WORD_COUNT; at += words[at] >> 16) {
        if ((words[at] & 0xffff) == OP_NAME && words[at + 1] == id)
            return (const char *)&words[at + 2];
    }
    return NULL;
}

static long decorated_offset(uint32_t type, uint32_t member)
{
    for (size_t at = 5; at < WORD_COUNT; at += words[at] >> 16) {
        if ((words[at] & 0xffff) == OP_MEMBER_DECORATE && words[at + 1] == type &&
            words[at + 2] == member && words[at + 3] == DECORATION_OFFSET)
            return words[at + 4];
    }
    return -1;
}

static const struct member *find(const char *type, const char *name)
{
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        if (strcmp(members[i].type, type) == 0 && strcmp(members[i].name, name) == 0)
            return &members[i];
    }
    return NULL;
}

static void every_member_lies_alike(void **state)
{
    (void)state;
    size_t checked = 0;
    for (size_t at = 5; at < WORD_COUNT; at += words[at] >> 16) {
        if ((words[at] & 0xffff) != OP_MEMBER_NAME)
            continue;
        const char *type = type_name(words[at + 1]), *name = (const char *)&words[at + 3];
        long offset = decorated_offset(words[at + 1], words[at + 2]);
        if (!type || strncmp(type, "wd_", 3) != 0 || offset < 0)
            continue;
        const struct member *member = find(type, name);
        if (!member)
            fail_msg("%s.%s is in the shader, but not in this test's table", type, name);
        else if ((long)member->offset != offset)
            fail_msg("%s.%s: C has it at %zu, SPIR-V at %ld", type, name, member->offset, offset);
        checked++;
    }
    assert_int_equal(checked, sizeof members / sizeof *members);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_member_lies_alike)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
