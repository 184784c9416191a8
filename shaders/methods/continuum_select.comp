#version 460
/* One workgroup a visible cluster: how many splats each tree gets, and where its model stands in
 * this view. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/continuum.h"
#include "shared/hash.h"
#include "shared/sun_ways.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint ORTHOGRAPHIC = 0u; /* 1: a cascade; depth is z, not z / w */
layout(constant_id = 2) const uint AGAIN = 0u; /* 1: the second round, of what was put off */
layout(constant_id = 3) const uint RUNS = 1u;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame_block; };
layout(scalar, set = 0, binding = 1) uniform View { wd_splat_view view_block; };
layout(scalar, set = 0, binding = 2) readonly buffer Clusters { wd_cluster clusters[]; };
layout(scalar, set = 0, binding = 3) buffer Counts { wd_splat_counts counts; };
layout(scalar, set = 0, binding = 4) readonly buffer Visible { uint visible[]; };
layout(set = 0, binding = 5) uniform usamplerBuffer trees; /* wd_packed_tree */
layout(scalar, set = 0, binding = 6) readonly buffer Models { wd_model models[]; };
layout(set = 0, binding = 7) uniform usamplerBuffer model_words; /* wd_splat_model */
layout(set = 0, binding = 8, rgba32ui) uniform writeonly uimageBuffer splat_trees; /* wd_splat_tree */
layout(scalar, set = 0, binding = 9) writeonly buffer Items { wd_splat_item items[]; };

layout(scalar, set = 0, binding = 10) writeonly buffer WoodItems { wd_splat_item wood_items[]; };
layout(set = 0, binding = 11) uniform samplerBuffer pyramid;
layout(set = 0, binding = 12) uniform sampler2D slopes;
layout(scalar, set = 0, binding = 13) buffer PutOff { uint put_off[]; };
layout(scalar, set = 0, binding = 14) readonly buffer Fades { wd_layer_fade fades[]; };

/* Read before any branch: lib/light_pixels.glsl tells why. */
wd_frame_uniforms frame = frame_block;
wd_splat_view view = view_block;

#define TREE_TEXELS
#define PYRAMID_TEXELS
#include "lib/dealt.glsl"
#include "lib/trees.glsl"
#include "lib/frustum.glsl"
#include "lib/pyramid.glsl"
#include "lib/occlusion.glsl"
#include "lib/put_off.glsl"
#include "lib/tree.glsl"
#include "lib/slice.glsl"

uint model_word(uint model, uint word)
{
    return texelFetch(model_words, int(model * WD_SPLAT_MODEL_WORDS + word)).x;
}

float model_float(uint model, uint word)
{
    return uintBitsToFloat(model_word(model, word));
}

vec3 model_vec3(uint model, uint word)
{
    return vec3(model_float(model, word), model_float(model, word + 1u), model_float(model, word + 2u));
}

void store_tree(uint slot, wd_splat_tree tree)
{
    int at = int(slot) * WD_SPLAT_TREE_TEXELS;
    imageStore(splat_trees, at, floatBitsToUint(tree.clip_x));
    imageStore(splat_trees, at + 1, floatBitsToUint(tree.clip_y));
    imageStore(splat_trees, at + 2, floatBitsToUint(tree.clip_w));
    imageStore(splat_trees, at + 3, floatBitsToUint(vec4(tree.sway, tree.radius)));
    imageStore(splat_trees, at + 4, floatBitsToUint(vec4(tree.facing, tree.wood_radius)));
    imageStore(splat_trees, at + 5, uvec4(tree.tree, tree.first_splat, tree.offset, tree.strata));
    imageStore(splat_trees, at + 6, uvec4(tree.first_wood, tree.turn, tree.shape, tree.tint));
    imageStore(splat_trees, at + 7,
               uvec4(tree.lower, tree.sun, tree.eye, floatBitsToUint(tree.nearer_m)));
}

/* Whether a cascade's box shades nothing that is seen: its middle's way from the slice, less its reach. */
bool box_shades_nothing(vec3 low, vec3 high)
{
    vec3 half_m = 0.5 * (high - low);
    vec2 at = (view.clip_from_rel * vec4(low + half_m, 1.0)).xy;
    float scale = 2.0 * view.pixels / float(view.width); /* clip units a metre */
    return ORTHOGRAPHIC != 0u && !may_shade(at, length(half_m) * scale);
}

/* `stretch`: of the crown of a tree that stands for several. */
bool tree_is_outside(wd_tree tree, vec3 foot, float stretch)
{
    float height_m = WD_TREE_HEIGHT_M(tree);
    float reach = WD_TREE_REACH_M(WD_TREE_CROWN_M(tree) * stretch, height_m);
    float lower = stretch > 1.0 ? 0.5 * reach : 0.0;
    vec3 low = foot - vec3(reach, reach, WD_TREE_BELOW_M + lower);
    vec3 high = foot + vec3(reach, reach, WD_TREE_ABOVE_M(height_m) + lower);
    return box_is_outside(low, high) || box_shades_nothing(low, high);
}

/* What a crown covers of its height by its width: less than a spheroid's 0.79, as crowns taper. */
const float CROWN_SHADOW = 0.6;

/* Pixels that a crown covers. */
float covered_px(wd_tree tree, vec3 toward, float pixels_per_m)
{
    float wide = WD_TREE_CROWN_M(tree), tall = WD_TREE_HEIGHT_M(tree);
    float level = 1.0 - toward.z * toward.z;
    float seen = CROWN_SHADOW * wide * sqrt(tall * tall * level + wide * wide * toward.z * toward.z);
    return seen * pixels_per_m * pixels_per_m;
}

/* Herbs and ferns are fine work: discs a pixel or two wide fill the gaps between their leaflets. Where
 * such a plant is large on screen, and few are, it has more discs. */
float finer_near(uint model, float tall_px)
{
    float finer = model_float(model, WD_WORD_FINER);
    return mix(1.0, finer, smoothstep(24.0, 96.0, tall_px));
}

/* What a unit of surface shows along a direction of the world: its dot product with a normal in the
 * model's axes. The pose stretches areas by its cofactors. */
vec3 model_facing(tree_pose pose, vec3 v)
{
    vec2 turned = vec2(pose.turn.x * v.x + pose.turn.y * v.y, pose.turn.x * v.y - pose.turn.y * v.x);
    return pose.across * vec3(pose.up * turned * pose.mirror, pose.across * v.z);
}

/* Clip coordinates of an offset. */
vec3 clip_of(vec4 column)
{
    return vec3(column.xy, ORTHOGRAPHIC != 0u ? column.z : column.w);
}

/* `slope`: how far the model leans with the ground, rise over run. */
void fill_rows(inout wd_splat_tree splats, tree_pose pose, uint model, vec3 foot, vec2 slope)
{
    vec3 extent_m = model_vec3(model, WD_WORD_EXTENT_M);
    mat4 clip = view.clip_from_rel;
    vec3 east = clip_of(clip[0]), north = clip_of(clip[1]), up = clip_of(clip[2]);
    vec2 x_axis = tree_turn(pose, vec2(pose.across, 0.0));
    vec2 y_axis = tree_turn(pose, vec2(0.0, pose.across));
    vec3 along_x = (x_axis.x * east + x_axis.y * north + dot(slope, x_axis) * up) * extent_m.x;
    vec3 along_y = (y_axis.x * east + y_axis.y * north + dot(slope, y_axis) * up) * extent_m.y;
    vec3 along_z = up * pose.up * extent_m.z;
    vec3 corner = tree_offset(pose, model_vec3(model, WD_WORD_MIN_M));
    corner.z += dot(slope, corner.xy);
    corner += foot;
    vec3 start = clip_of(clip * vec4(corner, 1.0));
    splats.clip_x = vec4(along_x.x, along_y.x, along_z.x, start.x);
    splats.clip_y = vec4(along_x.y, along_y.y, along_z.y, start.y);
    splats.clip_w = vec4(along_x.z, along_y.z, along_z.z, start.z);
}

/* A disc's reach over a model's radius: it faces the eye, which sees it, and has a leaf's outline
 * (lib/splat_draw.glsl). */
const float LARGEST_DISC = 1.54 * sqrt(2.0 * WD_DISC_SEEN), LONGEST_TWIG = 6.27 * sqrt(WD_DISC_SEEN);

/* How many strata, from the top, show anything past what the frame before saw. */
uint seen_strata(wd_tree tree, vec3 foot, vec3 toward, tree_pose pose, uint model, vec3 sway,
                 float disc, float nearer_m, uint strata)
{
    float height_m = WD_TREE_HEIGHT_M(tree) * 1.02;
    vec3 min_m = model_vec3(model, WD_WORD_MIN_M);
    vec2 wide = max(-min_m.xy, min_m.xy + model_vec3(model, WD_WORD_EXTENT_M).xy);
    float reach_m = length(wide) * pose.across + length(sway) + 0.1;
    vec4 low = view.history_from_rel * vec4(foot, 1.0);
    vec4 high = view.history_from_rel * vec4(foot + vec3(0.0, 0.0, height_m), 1.0);
    float nearest_m = min(low.w, high.w) - reach_m - nearer_m;
    if (nearest_m < 1.0)
        return strata;
    vec2 size = vec2(view.width, view.height);
    vec2 bottom = (low.xy / low.w * 0.5 + 0.5) * size, top = (high.xy / high.w * 0.5 + 0.5) * size;
    float disc_px = disc / nearest_m + 1.0, reach_px = reach_m * view.pixels / nearest_m;
    vec2 around = vec2(reach_px, reach_px * abs(toward.z)) + disc_px;
    wd_screen_box box = clamp_screen_box(min(bottom, top) - around, max(bottom, top) + around,
                                         nearest_m);
    if (!box.known)
        return strata;
    float lowest = lowest_seen(box);
    strata = lowest < 0.0 ? 0u : strata;
    while (strata > 1u) {
        float share = model_float(model, WD_WORD_STRATA_TOP_M + strata - 1u) * pose.up / height_m;
        if (mix(bottom.y, top.y, share) - around.y <= lowest)
            break;
        strata--;
    }
    return strata;
}

/* Trees this tall may reach out of the view by whole strata. */
const float STRATA_PX = 100.0;

/* Whether nothing of a stratum of leaves is in the view, or shades what is seen. */
bool stratum_is_outside(wd_tree tree, vec3 foot, vec3 sway, float up, uint model, uint stratum)
{
    float bend_m = length(sway) + 0.5, reach = WD_TREE_CROWN_M(tree) * 0.75 + bend_m;
    float bottom_m = stratum + 1u < WD_LEAF_STRATA
                         ? model_float(model, WD_WORD_STRATA_TOP_M + stratum + 1u)
                         : model_float(model, WD_WORD_MIN_M + 2u);
    float top_m = model_float(model, WD_WORD_STRATA_TOP_M + stratum);
    vec3 low = foot + vec3(-reach, -reach, bottom_m * up - bend_m);
    vec3 high = foot + vec3(reach, reach, top_m * up + bend_m);
    return box_is_outside(low, high) || box_shades_nothing(low, high);
}

/* The first of the strata of leaves that may be in the view, and the one after the last. */
uvec2 strata_in_view(wd_tree tree, vec3 foot, vec3 sway, float up, uint model, uint end)
{
    uvec2 range = uvec2(0u, end);
    while (range.x + 1u < range.y && stratum_is_outside(tree, foot, sway, up, model, range.x))
        range.x++;
    while (range.x + 1u < range.y && stratum_is_outside(tree, foot, sway, up, model, range.y - 1u))
        range.y--;
    return range;
}

uint item_count(uint count)
{
    return (count + WD_ITEM_SPLATS - 1u) / WD_ITEM_SPLATS;
}

wd_splat_item item_at(uint slot, uint begin, uint count, uint i)
{
    uint before = i * WD_ITEM_SPLATS;
    return wd_splat_item(slot, WD_ITEM_PARTS(begin + before, min(count - before, WD_ITEM_SPLATS)));
}

void add_splats(uint slot, uint count)
{
    if (count <= WD_SMALL_SPLATS) {
        uint at = atomicAdd(counts.small_items, 1u);
        if (at < view.item_capacity)
            items[view.item_capacity - 1u - at] = wd_splat_item(slot, WD_ITEM_PARTS(0u, count));
        return;
    }
    uint wanted = item_count(count), first = atomicAdd(counts.items, wanted);
    for (uint i = 0u; i < wanted && first + i < view.item_capacity; i++)
        items[first + i] = item_at(slot, 0u, count, i);
}

void add_wood(uint slot, uint begin, uint count)
{
    uint wanted = item_count(count), first = wanted > 0u ? atomicAdd(counts.wood_items, wanted) : 0u;
    for (uint i = 0u; i < wanted && first + i < view.item_capacity; i++)
        wood_items[first + i] = item_at(slot, begin, count, i);
}

/* One entry of wd_point_gain's tables. */
float gain_at(uint model, uint kind, uint k, float sine)
{
    uint word = kind + k;
    return wd_side_mix(model_float(model, word), model_float(model, word + WD_POINT_GAINS),
                       model_float(model, word + 2u * WD_POINT_GAINS), sine);
}

/* `place`: as gain_place has it. */
float gain_of(uint model, uint kind, vec2 place, float sine)
{
    uint k = uint(place.x);
    return mix(gain_at(model, kind, k, sine), gain_at(model, kind, k + 1u, sine), place.y);
}

/* Where a count lies in the tables: index of an entry and share of the next. */
vec2 gain_place(float count)
{
    float octave = clamp(floor(log2(count / float(WD_POINT_LEAST))), 0.0, float(WD_POINT_GAINS - 2));
    float at = count / (float(WD_POINT_LEAST) * exp2(octave));
    return vec2(octave, clamp(at - 1.0, 0.0, 1.0));
}

/* Radii in metres of discs of leaves and of wood that face the viewer, `each` of a stratum. */
vec2 disc_radii(uint model, float each, float sine)
{
    vec2 area_m2 = vec2(model_float(model, WD_WORD_LEAF_AREA_M2),
                        model_float(model, WD_WORD_WOOD_AREA_M2));
    vec2 place = gain_place(each * float(WD_SPLAT_STRATA));
    vec2 gain = vec2(gain_of(model, WD_WORD_LEAF_GAINS, place, sine),
                     gain_of(model, WD_WORD_WOOD_GAINS, place, sine));
    return sqrt(gain * area_m2 / (3.14159265 * each * vec2(WD_LEAF_STRATA, 1.0)));
}

/* Trees without leaves that are taller on screen have discs of twigs in all strata: in fewer strata these are dots a
 * twig's length wide. Smaller trees would cover up to a fifth more by it (snags at 32 px). */
const float TWIGS_PX = 90.0;

/* Of discs of wood where leaves' strata hold it, too. */
float twig_radius(uint model, float each, float sine)
{
    float count = each * float(WD_SPLAT_STRATA);
    float gain = gain_of(model, WD_WORD_WOOD_GAINS, gain_place(count * float(WD_SPLAT_STRATA)), sine);
    return sqrt(gain * model_float(model, WD_WORD_WOOD_AREA_M2) / (3.14159265 * count));
}

/* Factors of the leaves' colour and of how open few discs look. */
uint leaf_tint(wd_tree tree, uint model, float count, float sine)
{
    vec3 tint = tree_tint(tree, models[model]);
    float light = gain_of(model, WD_WORD_LIGHT_GAINS, gain_place(count), sine);
    return packUnorm4x8(vec4(tint, light) * 0.5);
}

/* Factors of the colour of leaves' lower sides and of the light of wood. */
uint lower_tint(uint model, float count, float sine)
{
    float light = gain_of(model, WD_WORD_WOOD_LIGHT_GAINS, gain_place(count), sine);
    return packUnorm4x8(vec4(model_vec3(model, WD_WORD_LOWER_OVER_UPPER) * 0.25, light * 0.5));
}

/* Triangles of wood with the far stem. */
uint far_wood(uint model)
{
    return model_word(model, WD_WORD_WOOD_COUNT) - model_word(model, WD_WORD_WOOD_STEM);
}

/* So many times the triangles where no leaves hide branches. */
const float BARE_WOOD = 8.0;

/* Triangles of wood for each squared pixel of a tree's height, beside one for each pixel. */
const float WOOD_A_PX2 = 0.006;

/* A tree has its stem, in place of the far one, from so many times the stem's triangles on, and so much later by lot. */
const float STEM_FROM = 1.6, STEM_LATER = 0.8;

/* Triangles of wood for a tree that tall: few of the first while it is small. In a cascade twigs, which
 * discs stand for then, are lost in the penumbra. */
uint wood_triangles(uint model, float tall_px)
{
    tall_px *= ORTHOGRAPHIC != 0u ? 0.5 : 1.0;
    float finer = ORTHOGRAPHIC != 0u || model_float(model, WD_WORD_LEAF_AREA_M2) > 0.0 ? 1.0 : BARE_WOOD;
    return min(uint(finer * (tall_px * tall_px * WOOD_A_PX2 + tall_px)), far_wood(model));
}

/* Of all triangles that a small tree may have, the first so many; the far stem is among them, for which large trees
 * have the stem, each from another size on. */
void add_share_of_wood(uint slot, uint model, uint triangles, float share, uint random)
{
    uint stem = model_word(model, WD_WORD_WOOD_STEM), far_stem = model_word(model, WD_WORD_WOOD_FAR_STEM);
    uint wanted = uint(ceil(share * float(triangles)));
    float enough = min(float(stem) * (STEM_FROM + STEM_LATER * wd_hash_unit(random)), float(far_wood(model)));
    bool near = float(triangles) >= enough;
    add_wood(slot, 0u, near ? min(wanted * stem / max(far_stem, 1u), stem) : 0u);
    uint begin = near ? far_stem : 0u;
    add_wood(slot, stem + begin, max(wanted, begin) - begin);
}

/* Discs stand for the wood that is not there as triangles, of which few large ones are most: its share. */
float wood_missing(uint model, uint triangles)
{
    uint all = far_wood(model);
    float first = max(float(wd_first_wood(all)), 1.0);
    float times = pow(float(triangles) / first, model_float(model, WD_WORD_WOOD_FALLS));
    float left = triangles >= all ? 0.0 : pow(max(model_float(model, WD_WORD_THIN_SHARE), 1e-3), times);
    return mix(left, 1.0, model_float(model, WD_WORD_BARE_THIN));
}

/* Slope of the ground that a tree stands for when it is `wide_m` wide. */
vec2 slope_under(vec3 foot, float wide_m)
{
    return textureLod(slopes, foot.xy * view.slopes_scale + view.slopes_offset,
                      log2(max(wide_m / view.slopes_texel_m, 1.0))).xy;
}

/* Gains keep what a whole tree covers. From below an eye stands among crowns and looks into their insides, where
 * leaves lie close and discs, larger and fewer, leave more holes: areas grow by so much. By path-traced crowns of
 * three stands. */
const float FROM_BELOW = 0.20;

/* So do the many small discs of the sun's maps, whose rays pass through one crown after the other: areas in a cascade, of
 * the model's full number. By path-traced floors of the same stands under the sun alone. */
const float SUN_THROUGH_CROWNS = 0.08;

/* From below, leaves that lie flat hide the upper sides of those next to them, which a disc for each of them shows: share
 * of their area, the less the fewer lower sides the model shows from above. By path-traced trees of seven species. */
const float UPPER_FROM_BELOW = 0.65, STEEPEST_UPPER = 0.4;

float upper_share(uint model, float toward_z)
{
    float flat_lying = max(1.0 - 2.0 * model_float(model, WD_WORD_LOWER + WD_GAIN_SIDES - 1u), 0.0);
    return mix(1.0, UPPER_FROM_BELOW, flat_lying * clamp(-toward_z / STEEPEST_UPPER, 0.0, 1.0));
}

/* Way to a place over its part along the view axis. The picture's plane is aslant to ways away from its middle, and
 * shows surfaces that face the eye larger by so much than others as far along the axis. */
const float MOST_ASLANT = 3.0;

float aslant(vec3 middle, float distance_m)
{
    float axis_m = dot(vec3(view.clip_from_rel[0].w, view.clip_from_rel[1].w, view.clip_from_rel[2].w), middle);
    return ORTHOGRAPHIC != 0u ? 1.0 : min(distance_m / max(axis_m, 1e-3), MOST_ASLANT);
}

/* How much of a tree's discs shows: as far as its mesh is not drawn in their place. */
float splats_shown(wd_tree tree, wd_model model, uint model_index, vec3 foot)
{
    float near_m = wd_near_reach_m(tree, model_float(model_index, WD_WORD_GRAIN), view.near_leaves_m,
                                   view.near_grains);
    if (near_m <= 0.0)
        return 1.0;
    return wd_near_splats(wd_near_distance_m(tree, model.crown_base_m / model.height_m, foot), near_m);
}

/* What a tree is drawn of. */
struct wd_parts {
    float each;     /* discs of a stratum */
    uint triangles; /* of wood, the largest first */
    float missing;  /* share of the wood that these do not show */
    bool wood;      /* it is tall enough to have triangles */
    bool twigs;     /* all of its discs are twigs: see TWIGS_PX */
};

/* A tree's own share of a size on screen at which trees change: not all do at once. */
float own_size(uint random)
{
    return 0.8 + 0.4 * wd_hash_unit(random);
}

/* `wanted`: discs of all strata. */
wd_parts parts_of(uint model, float tall_px, float wanted, uint random)
{
    wd_parts parts;
    parts.each = min(wanted / float(WD_SPLAT_STRATA), float(WD_STRATUM_SPLATS));
    parts.wood = tall_px > view.wood_px * own_size(random);
    parts.triangles = parts.wood ? wood_triangles(model, tall_px) : 0u;
    parts.twigs = parts.triangles > 0u && tall_px > TWIGS_PX * own_size(random) &&
                  model_float(model, WD_WORD_LEAF_AREA_M2) <= 0.0;
    parts.missing = wood_missing(model, parts.triangles);
    return parts;
}

/* Radii, in pixels at w = 1, of discs of leaves (x) and of wood (y) that face the eye. `size`: pixels of a metre there,
 * more for discs that grow. */
vec2 radii_px(uint model, wd_parts parts, float toward_z, float size)
{
    vec2 radii = size * disc_radii(model, parts.each, toward_z);
    if (parts.twigs)
        radii.y = size * twig_radius(model, parts.each, toward_z);
    float thin_share = max(model_float(model, WD_WORD_THIN_SHARE), 1e-3);
    float thin = parts.triangles > 0u ? min(parts.missing / thin_share, 1.0) : 0.0;
    thin = mix(1.0, model_float(model, WD_WORD_THIN_WOOD), thin);
    radii.y *= sqrt(max(parts.missing, 0.0) * thin);
    radii.x *= sqrt(mix(model_float(model, WD_WORD_LEAF_PAST_BARK), 1.0, parts.missing));
    float many = smoothstep(0.125, 1.0, parts.each * (1.0 / float(WD_STRATUM_SPLATS)));
    float fuller = ORTHOGRAPHIC != 0u ? SUN_THROUGH_CROWNS * many : FROM_BELOW * smoothstep(0.0, 0.5, -toward_z);
    radii.x = parts.twigs ? radii.y : radii.x * sqrt(1.0 + fuller);
    return radii;
}

/* What resolve and the splat pass look up: where its splats begin, its tints, and how it stands. */
void fill_look(inout wd_splat_tree splats, wd_tree tree, uint model_index, wd_parts parts, tree_pose pose,
               float own_across, float toward_z)
{
    uint random = wd_tree_random(tree);
    float count = parts.each * float(WD_SPLAT_STRATA);
    uint window = (wd_hash_mix(random) * WD_WINDOW_STEP + frame.sample_index * uint(ceil(parts.each)))
                  & (WD_STRATUM_SPLATS - 1u);
    splats.first_splat = model_index * WD_SPLATS;
    splats.first_wood = model_word(model_index, WD_WORD_WOOD_FIRST);
    splats.offset = WD_TREE_OFFSET_OF(window, uint(upper_share(model_index, toward_z) * 255.0 + 0.5),
                                      parts.twigs ? 1u : 0u, parts.wood ? 1u : 0u);
    splats.turn = packHalf2x16(pose.turn);
    splats.shape = packHalf2x16(vec2(pose.mirror.x, pose.up / own_across));
    splats.tint = leaf_tint(tree, model_index, count, toward_z);
    splats.lower = lower_tint(model_index, count, toward_z);
}

/* `share` of the trees around stand for all: a tree is drawn as wide as the ground that it stands for
 * asks, as high as it is, and its splats grow with it. `place`: bit of the masks of put_off. */
void select_tree(uint index, float share, uint place)
{
    wd_tree tree = tree_at(index);
    if (tree.size == 0u)
        return;
    float stretch = inversesqrt(share);
    vec3 foot = tree_foot_rel(tree);
    if (tree_is_outside(tree, foot, stretch))
        return;
    /* Layers come and go with distance, tree by tree, as the path tracer has it. */
    uint random = wd_tree_random(tree);
    if (wd_hash_unit(random) >= wd_layer_show(fades[WD_TREE_LAYER(tree)], length(foot)))
        return;
    uint model_index = WD_TREE_SPECIES(tree) * view.variants
                       + WD_TREE_VARIANT(tree) % view.variants;
    wd_model model = models[model_index];
    tree_pose pose = tree_pose_of(tree, model);
    vec3 middle = foot + vec3(0.0, 0.0, 0.5 * WD_TREE_HEIGHT_M(tree));
    float distance_m = ORTHOGRAPHIC != 0u ? 1.0 : max(length(middle), 0.1);
    vec3 toward = ORTHOGRAPHIC != 0u ? frame.sun_direction : -normalize(middle);
    float shown = splats_shown(tree, model, model_index, foot);
    if (shown <= 0.0)
        return;

    wd_wind wind = tree_wind();
    wind.gust = view.calm != 0u ? 0.0 : wind.gust;
    vec3 sway = tree_sway_in(wind, tree, model.flexibility, WD_TREE_HEIGHT_M(tree), frame.time_s);
    float pixels_per_m = view.pixels / distance_m;
    float tall_px = WD_TREE_HEIGHT_M(tree) * pixels_per_m * view.detail;
    float larger = aslant(middle, distance_m);
    float wanted = max(view.density * finer_near(model_index, tall_px)
                           * covered_px(tree, toward, pixels_per_m) * larger,
                       float(view.min_splats));
    wd_parts parts = parts_of(model_index, tall_px, wanted, random);
    float grown = min(pow(share, -0.25), 1.2) / share; /* discs that grow cover more of each other */
    vec2 radii = radii_px(model_index, parts, toward.z, sqrt(grown * larger) * view.pixels);
    float close = wd_disc_close(parts.each * float(WD_SPLAT_STRATA));
    wd_splat_tree splats;
    splats.tree = index;
    splats.radius = radii.x;
    splats.wood_radius = radii.y;
    splats.facing = model_facing(pose, toward);
    splats.sun = wd_sun_mix(tree_toward(pose, frame.sun_direction));
    splats.eye = wd_sun_mix(tree_toward(pose, toward));
    splats.nearer_m = (1.0 - close) * WD_DISC_NEARER * model_float(model_index, WD_WORD_EXTENT_M)
                    * pose.across
                    * smoothstep(-0.4, -0.1, toward.z); /* nothing is known of the view from below */

    uint strata = parts.missing > 0.0 ? WD_SPLAT_STRATA : WD_LEAF_STRATA;
    float own_across = pose.across;
    pose.across *= stretch;
    if (ORTHOGRAPHIC == 0u && view.has_history != 0u) {
        float reach = (parts.twigs ? LONGEST_TWIG : LARGEST_DISC) * max(radii.x, radii.y) * max(own_across, pose.up);
        uint seen = seen_strata(tree, foot, toward, pose, model_index, sway, reach, splats.nearer_m, strata);
        if (seen == 0u && view.moved != 0u)
            put_off_trees(place >> 5u, 1u << (place & 31u));
        if (seen == 0u)
            return;
        strata = view.moved != 0u ? strata : seen;
    }
    uint wood_last = strata > WD_LEAF_STRATA ? 1u : 0u;
    uvec2 leaves = uvec2(0u, strata - wood_last);
    if (tall_px > STRATA_PX && share >= 1.0)
        leaves = strata_in_view(tree, foot, sway, pose.up, model_index, leaves.y);
    strata = leaves.y - leaves.x + wood_last;

    fill_look(splats, tree, model_index, parts, pose, own_across, toward.z);
    splats.strata = WD_TREE_STRATA_OF(strata, uint(close * 15.0 + 0.5), leaves.x, wood_last, model.look_layer);
    vec2 slope = share < 1.0 ? slope_under(foot, WD_TREE_CROWN_M(tree) * stretch) * (1.0 - share)
                             : vec2(0.0);
    fill_rows(splats, pose, model_index, foot, slope);
    splats.sway = clip_of(view.clip_from_rel * vec4(sway, 0.0));

    uint slot = atomicAdd(counts.trees, 1u);
    if (slot >= view.tree_capacity)
        return;
    store_tree(slot, splats);
    add_splats(slot, uint(ceil(shown * parts.each * float(strata))));
    if (parts.wood)
        add_share_of_wood(slot, model_index, parts.triangles, wd_near_wood(shown), random);
}

/* How many times over a cluster's crowns may cover what is seen of it: what lies deeper is hidden all
 * the same. */
const float MOST_LAYERS = 2.0;

/* Which of a cluster's trees are drawn: the first so many records, of which each stands for 1 over
 * the share of trees. */
struct wd_drawn {
    uint count;
    float share;
};

/* All, until trees cover but a few pixels. */
wd_drawn drawn_of(wd_cluster cluster)
{
    bool paged = (cluster.count & WD_CLUSTER_PAGED) != 0u;
    float held = exp2(-2.0 * float(WD_CLUSTER_LEVEL(cluster))); /* share of trees that have records */
    if (ORTHOGRAPHIC != 0u) {
        uint records = paged ? WD_CLUSTER_TREES : view.cascade_records;
        return wd_drawn(records, held * float(records) / float(WD_CLUSTER_TREES));
    }
    ivec3 low = ivec3(cluster.min_mm[0], cluster.min_mm[1], cluster.min_mm[2]);
    ivec3 high = ivec3(cluster.max_mm[0], cluster.max_mm[1], cluster.max_mm[2]);
    vec3 middle = rel_of_mm(low + (high - low) / 2), size_m = vec3(high - low) * 0.001;
    float distance_m = max(length(middle), 1.0);
    float typical_m = paged ? WD_CLUSTER_GRAIN_M(cluster) : view.typical_m;
    float tall_px = typical_m * view.pixels * view.detail / distance_m;
    float wanted = tall_px * tall_px * (0.2 / WD_LEAST_TREE_PX) / held;
    float count = ceil(clamp(wanted * float(WD_CLUSTER_TREES), 1.0, float(WD_CLUSTER_TREES)));
    float share = held * count / float(WD_CLUSTER_TREES);
    if (!paged)
        return wd_drawn(uint(count), share);
    float sine = min(abs(middle.z) / distance_m, 1.0), cosine = sqrt(1.0 - sine * sine);
    float seen_m2 = size_m.x * size_m.y * sine + max(size_m.x, size_m.y) * size_m.z * cosine;
    float crowns_m2 = 0.2 * typical_m * typical_m * float(WD_CLUSTER_COUNT(cluster)) / held;
    count = ceil(count * min(MOST_LAYERS * seen_m2 / crowns_m2, 1.0));
    return wd_drawn(uint(max(count, 1.0)), share);
}

/* A loop, since software devices run idle lanes to the end. In the order of reversed bits any prefix
 * of a cluster's trees is spread over all of it. */
void select_trees(uint index, wd_cluster cluster, uvec2 range, uint mask)
{
    wd_drawn drawn = drawn_of(cluster);
    bool paged = (cluster.count & WD_CLUSTER_PAGED) != 0u;
    bool tall_too = ORTHOGRAPHIC != 0u && !paged && drawn.count < WD_CLUSTER_TREES;
    uint records = paged ? WD_CLUSTER_TREES : cluster.count;
    uint end = tall_too ? range.y : min(range.y, drawn.count);
    uint i = range.x + gl_LocalInvocationID.x;
    if (i >= end)
        return;
    do {
        uint at = bitfieldReverse(i) >> (32u - WD_CLUSTER_BITS);
        if (at < records && (mask >> (i & 31u) & 1u) != 0u) {
            float share = i < drawn.count ? drawn.share : 0.0;
            if (tall_too && WD_TREE_HEIGHT_M(tree_at(cluster.first + at)) >= view.cascade_whole_m)
                share = 1.0;
            if (share > 0.0)
                select_tree(cluster.first + at, share, index * WD_CLUSTER_TREES + i);
        }
        i += gl_WorkGroupSize.x;
    } while (i < end);
}

/* Whether what a cluster holds is hidden past what is drawn by now. */
bool cluster_is_hidden(wd_cluster cluster)
{
    vec3 low = rel_of_mm(ivec3(cluster.min_mm[0], cluster.min_mm[1], cluster.min_mm[2]));
    vec3 high = rel_of_mm(ivec3(cluster.max_mm[0], cluster.max_mm[1], cluster.max_mm[2]));
    return was_hidden(low, high);
}

/* One call of select_trees, which is most of the shader, for both rounds. */
void main()
{
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint groups = AGAIN != 0u ? counts.put_off : counts.clusters;
    if (group >= groups)
        return;
    group = dealt(group, groups);
    uint index = AGAIN != 0u ? 0u : visible[group], mask = ~0u;
    uvec2 range = uvec2(0u, WD_CLUSTER_TREES);
    if (AGAIN != 0u) { /* of the trees that a word of the masks tells of */
        uint word = put_off[view.put_off_words + group];
        index = word >> 1u;
        mask = put_off[word];
        range = (word & 1u) * 32u + uvec2(0u, 32u);
        if (cluster_is_hidden(clusters[index]))
            return;
    }
    select_trees(index, clusters[index], range, mask);
}
