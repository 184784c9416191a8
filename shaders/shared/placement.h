/* placement.h: trees as a function of where they stand, as C and as GLSL, alike to the bit.
 *
 *   layer, cell (column, row) -> how many trees -> each: place, acceptance, species, size, look
 *
 * A cell's numbers are hashes of its own index, so any cell can be planted alone, in any order, on
 * either side. Chances are 32-bit integer thresholds (an outcome of probability p has p * 2^32 of
 * the 2^32 hash values, whatever the other outcomes are); rules are floats in + - * of fixed order.
 *
 * Poisson cells: the count is Poisson(mean); the trees take `count` of side * side sub-cells, side =
 * ceil(sqrt(count)), every choice of them equally likely (Knuth's algorithm S), each jittered within
 * its own, so the perturbation's area is inverse to the count. Thinning by a place's probability p
 * afterwards leaves exactly Poisson(mean * p) (the thinning theorem).
 *
 * A shader that includes this defines before, besides those of ground.h: WD_LAYER(member),
 * WD_MAP_AT(index) and WD_TABLE_AT(index). */
#ifndef WD_SHARED_PLACEMENT_H
#define WD_SHARED_PLACEMENT_H

#include "shared/ground.h"
#include "shared/hash.h"
#include "shared/place_layer.h"
#include "shared/tree.h"

#ifdef __STDC_VERSION__
struct wd_place_input {
    struct wd_place_layer layer;
    struct wd_ground_input ground;
    const float *map; /* probabilities, row 0 in the south */
    const uint32_t *table;
};
#define WD_PLACE_IN const struct wd_place_input *place_input,
#define WD_PLACE_PASS place_input,
#define WD_PLACE_GROUND &place_input->ground,
#define WD_LAYER(member) (place_input->layer.member)
#define WD_MAP_AT(index) (place_input->map[index])
#define WD_TABLE_AT(index) (place_input->table[index])
#else
#define WD_PLACE_IN
#define WD_PLACE_PASS
#define WD_PLACE_GROUND
#endif

/* Purposes of random numbers: of a cell ... */
#define WD_FOR_COUNT 1u
#define WD_FOR_SUB_CELL 0x100u /* + index of the sub-cell */
#define WD_FOR_TREE 0x10000u   /* + index of the tree in its cell */
/* ... and of a tree. */
#define WD_FOR_EAST 1u
#define WD_FOR_NORTH 2u
#define WD_FOR_RULE 3u
#define WD_FOR_SPECIES 4u
#define WD_FOR_HEIGHT 5u
#define WD_FOR_ASPECT 6u
#define WD_FOR_YAW 7u
#define WD_FOR_TINT 8u
#define WD_FOR_VARIANT 9u

/* ---- cells ---- */

struct wd_place_cell {
    uint32_t column, row;
    uint32_t key;
    uint32_t count; /* trees, before any rule */
    uint32_t side;  /* the cell has side * side sub-cells */
};

WD_FUNC WD_STRUCT wd_place_cell wd_place_open_cell(WD_PLACE_IN uint32_t column, uint32_t row)
{
    WD_STRUCT wd_place_cell cell;
    cell.column = column;
    cell.row = row;
    cell.key = wd_hash3(WD_LAYER(key), column, row);
    uint32_t random = wd_hash2(cell.key, WD_FOR_COUNT);
    uint32_t count = 0u, side = 1u;
    while (count < WD_LAYER(count_size) && WD_TABLE_AT(WD_LAYER(count_first) + count) <= random)
        count++;
    while (side * side < count)
        side++;
    cell.count = count;
    cell.side = side;
    return cell;
}

/* The first sub-cell from `from` on that holds tree number `tree`. */
WD_FUNC uint32_t wd_place_sub_cell(WD_STRUCT wd_place_cell cell, uint32_t from, uint32_t tree)
{
    uint32_t left = cell.side * cell.side - from, wanted = cell.count - tree;
    while (left > wanted
           && WD_MULTIPLY_HIGH(wd_hash2(cell.key, WD_FOR_SUB_CELL + from), left) >= wanted) {
        from++;
        left--;
    }
    return from;
}

/* A coordinate in the sub-cell of that index along one axis. */
WD_FUNC int32_t wd_place_coordinate(WD_PLACE_IN WD_STRUCT wd_place_cell cell, uint32_t index,
                                    uint32_t sub, uint32_t random)
{
    uint32_t first_mm = sub * WD_LAYER(cell_mm) / cell.side;
    uint32_t width_mm = (sub + 1u) * WD_LAYER(cell_mm) / cell.side - first_mm;
    uint32_t jitter_mm = WD_MULTIPLY_HIGH(width_mm * 2u, WD_LAYER(jitter));
    return WD_INT(index * WD_LAYER(cell_mm) + first_mm + (width_mm - jitter_mm) / 2u
                  + WD_MULTIPLY_HIGH(random, jitter_mm));
}

/* ---- rules ---- */

WD_FUNC float wd_ramp_at(WD_STRUCT wd_ramp ramp, float value)
{
    WD_PRECISE float above = value - ramp.from;
    WD_PRECISE float share = above * ramp.scale;
    return share > 1.0f ? 1.0f : (share > 0.0f ? share : 0.0f);
}

/* Places are inside the ground here: not negative. */
WD_FUNC float wd_place_map_at(WD_PLACE_IN uint32_t x, uint32_t y)
{
    uint32_t width = WD_LAYER(map_width), height = WD_LAYER(map_height);
    bool linear = WD_LAYER(map_kind) == WD_PLACE_MAP_LINEAR;
    if (linear) {
        x = x > WD_LAYER(map_half_mm[0]) ? x - WD_LAYER(map_half_mm[0]) : 0u;
        y = y > WD_LAYER(map_half_mm[1]) ? y - WD_LAYER(map_half_mm[1]) : 0u;
    }
    uint32_t i = wd_axis_cell(WD_LAYER(map_axis[0]), x), j = wd_axis_cell(WD_LAYER(map_axis[1]), y);
    i = i < width ? i : width - 1u;
    j = j < height ? j : height - 1u;
    if (!linear)
        return WD_MAP_AT(j * width + i);
    uint32_t east = i + 1u < width ? i + 1u : i, north = j + 1u < height ? j + 1u : j;
    float u = WD_FLOAT(wd_axis_share(WD_LAYER(map_axis[0]), x)) * 5.9604644775390625e-8f;
    float v = WD_FLOAT(wd_axis_share(WD_LAYER(map_axis[1]), y)) * 5.9604644775390625e-8f;
    float a = wd_ground_mix(WD_MAP_AT(j * width + i), WD_MAP_AT(j * width + east), u);
    float b = wd_ground_mix(WD_MAP_AT(north * width + i), WD_MAP_AT(north * width + east), u);
    return wd_ground_mix(a, b, v);
}

WD_FUNC float wd_place_smooth(float t)
{
    WD_PRECISE float twice = t * 2.0f;
    WD_PRECISE float rest = 3.0f - twice;
    WD_PRECISE float square = t * t;
    WD_PRECISE float smooth_t = square * rest;
    return smooth_t;
}

/* Value noise in 0..1, lattice spacing by the axis. */
WD_FUNC float wd_place_noise(WD_STRUCT wd_axis axis, uint32_t key, uint32_t x, uint32_t y)
{
    uint32_t i = wd_axis_cell(axis, x), j = wd_axis_cell(axis, y);
    float u = wd_place_smooth(WD_FLOAT(wd_axis_share(axis, x)) * 5.9604644775390625e-8f);
    float v = wd_place_smooth(WD_FLOAT(wd_axis_share(axis, y)) * 5.9604644775390625e-8f);
    float a = wd_ground_mix(wd_hash_unit(wd_hash3(key, i, j)),
                            wd_hash_unit(wd_hash3(key, i + 1u, j)), u);
    float b = wd_ground_mix(wd_hash_unit(wd_hash3(key, i, j + 1u)),
                            wd_hash_unit(wd_hash3(key, i + 1u, j + 1u)), u);
    return wd_ground_mix(a, b, v);
}

/* 1 in groves, 1 - patchiness in clearings; half the land is either. */
WD_FUNC float wd_place_patch(WD_PLACE_IN uint32_t x, uint32_t y)
{
    float coarse = wd_place_noise(WD_LAYER(patch_axis[0]), WD_LAYER(key) ^ 0x5bd1e995u, x, y);
    float fine = wd_place_noise(WD_LAYER(patch_axis[1]), WD_LAYER(key) ^ 0x1b873593u, x, y);
    float noise = wd_ground_mix(coarse, fine, 0.3f);
    WD_PRECISE float above = noise - 0.42f;
    WD_PRECISE float grove = above * 6.25f;
    grove = grove > 1.0f ? 1.0f : (grove > 0.0f ? grove : 0.0f);
    WD_PRECISE float missing = 1.0f - grove;
    WD_PRECISE float loss = missing * WD_LAYER(patchiness);
    WD_PRECISE float kept = 1.0f - loss;
    return kept;
}

/* The probability that a tree may stand there, and the ground under it. */
struct wd_place_odds {
    float chance;
    float height_m;
};

/* Stops, with a chance of 0, as soon as it is known to be at most `least`. */
WD_FUNC WD_STRUCT wd_place_odds wd_place_odds_at(WD_PLACE_IN int32_t x_mm, int32_t y_mm,
                                                 float least)
{
    WD_STRUCT wd_place_odds odds;
    odds.chance = 0.0f;
    odds.height_m = 0.0f;
    uint32_t x = WD_UINT(x_mm), y = WD_UINT(y_mm);
    WD_PRECISE float chance = 1.0f;
    if (WD_LAYER(map_kind) != WD_PLACE_MAP_NONE)
        chance = wd_place_map_at(WD_PLACE_PASS x, y);
    if (least >= chance)
        return odds;
    if (WD_LAYER(has_patches) != 0u)
        chance = chance * wd_place_patch(WD_PLACE_PASS x, y);
    if (least >= chance)
        return odds;
    WD_STRUCT wd_ground_place place = wd_ground_locate(WD_PLACE_GROUND x_mm, y_mm);
    odds.height_m = wd_ground_height(WD_PLACE_GROUND place);
    if (WD_LAYER(has_altitude) != 0u) {
        chance = chance * wd_ramp_at(WD_LAYER(altitude[0]), odds.height_m);
        chance = chance * wd_ramp_at(WD_LAYER(altitude[1]), odds.height_m);
    }
    if (least < chance && WD_LAYER(has_slope) != 0u) {
        float slope = wd_ground_slope_squared(WD_PLACE_GROUND place);
        chance = chance * wd_ramp_at(WD_LAYER(slope[0]), slope);
        chance = chance * wd_ramp_at(WD_LAYER(slope[1]), slope);
    }
    bool dry = WD_LAYER(has_water) == 0u || odds.height_m >= WD_LAYER(water_m);
    odds.chance = dry && !wd_ground_is_hole(WD_PLACE_GROUND place) ? chance : 0.0f;
    return odds;
}

/* Whether a tree may stand there, and the ground under it. */
struct wd_place_verdict {
    bool accepted;
    int32_t z_mm;
};

WD_FUNC WD_STRUCT wd_place_verdict wd_place_judge(WD_PLACE_IN uint32_t tree_key, int32_t x_mm,
                                                  int32_t y_mm)
{
    WD_STRUCT wd_place_verdict verdict;
    float random = wd_hash_unit(wd_hash2(tree_key, WD_FOR_RULE));
    WD_STRUCT wd_place_odds odds = wd_place_odds_at(WD_PLACE_PASS x_mm, y_mm, random);
    verdict.accepted = random < odds.chance;
    verdict.z_mm = wd_ground_mm(odds.height_m);
    return verdict;
}

/* ---- what grows there ---- */

/* Crown diameter in cm of a tree of that height, from the species' table. */
WD_FUNC uint32_t wd_place_crown_cm(WD_PLACE_IN uint32_t pick, uint32_t height_cm, uint32_t aspect)
{
    uint32_t first = WD_TABLE_AT(pick + WD_PICK_CROWN);
    uint32_t last = WD_TABLE_AT(pick + WD_PICK_CROWN_SIZE) - 1u;
    uint32_t index = height_cm / WD_CROWN_STEP_CM, share = height_cm % WD_CROWN_STEP_CM;
    if (index >= last) {
        index = last - 1u;
        share = WD_CROWN_STEP_CM;
    }
    uint32_t low = WD_TABLE_AT(first + index), high = WD_TABLE_AT(first + index + 1u);
    uint32_t quarters = (low * (WD_CROWN_STEP_CM - share) + high * share) / WD_CROWN_STEP_CM;
    uint32_t crown_cm = (quarters * aspect + 2048u) >> 12;
    uint32_t most = WD_TREE_CROWN_MOST_CM;
    return crown_cm < 1u ? 1u : (crown_cm > most ? most : crown_cm);
}

#define WD_PLACE_ANY_TURN 0x10000u

/* Trees that are to face one way still do so by a third of a degree more or less, so that no two of
 * them have one random number. `turn`: in 1/65536. */
WD_FUNC uint32_t wd_place_look(uint32_t tree_key, uint32_t tint, uint32_t turn)
{
    uint32_t yaw = wd_hash2(tree_key, WD_FOR_YAW);
    uint32_t facing = turn < WD_PLACE_ANY_TURN ? turn + (yaw & 0x7fu) - 64u : yaw;
    uint32_t random = wd_hash2(tree_key, WD_FOR_TINT);
    /* the sum of two even numbers: most trees are near neutral */
    uint32_t step = ((random & 0xffffu) + (random >> 16)) * tint >> 16;
    return WD_TREE_LOOK((facing >> 2) & 0x3fffu, 128u + step - tint, yaw >> 31);
}

WD_FUNC uint32_t wd_place_pick(WD_PLACE_IN uint32_t tree_key)
{
    uint32_t random = wd_hash2(tree_key, WD_FOR_SPECIES), pick = WD_LAYER(pick_first);
    uint32_t last = pick + (WD_LAYER(pick_size) - 1u) * WD_PLACE_PICK_WORDS;
    while (pick < last && random >= WD_TABLE_AT(pick + WD_PICK_THRESHOLD))
        pick += WD_PLACE_PICK_WORDS;
    return pick;
}

WD_FUNC uint32_t wd_place_height_cm(WD_PLACE_IN uint32_t tree_key)
{
    uint32_t random = wd_hash2(tree_key, WD_FOR_HEIGHT);
    return WD_LAYER(height_min_cm) + WD_MULTIPLY_HIGH(random, WD_LAYER(height_span_cm));
}

/* The variant whose height is nearest, or by chance one beside it: variants stand for equal parts
 * of [low, low + span] in turn. At most 65535 cm and 256 variants. */
WD_FUNC uint32_t wd_place_variant(uint32_t random, uint32_t variants, uint32_t height_cm,
                                  uint32_t low_cm, uint32_t span_cm)
{
    if (span_cm == 0u)
        return WD_MULTIPLY_HIGH(random, variants);
    uint32_t above_cm = height_cm < low_cm ? 0u : height_cm - low_cm;
    if (above_cm > span_cm)
        above_cm = span_cm;
    uint32_t place = above_cm * variants * 128u / span_cm + (random >> 24); /* a variant is 128 */
    uint32_t variant = place < 128u ? 0u : (place - 128u) / 128u;
    return variant < variants ? variant : variants - 1u;
}

/* The tree of that key and height; its id is 0 yet. */
WD_FUNC WD_STRUCT wd_tree wd_place_grow(WD_PLACE_IN uint32_t tree_key, int32_t x_mm, int32_t y_mm,
                                        int32_t z_mm, uint32_t height_cm)
{
    WD_STRUCT wd_tree tree;
    uint32_t pick = wd_place_pick(WD_PLACE_PASS tree_key);
    uint32_t aspect = WD_LAYER(aspect_min) + WD_MULTIPLY_HIGH(wd_hash2(tree_key, WD_FOR_ASPECT),
                                                              WD_LAYER(aspect_span));
    uint32_t variant = wd_place_variant(wd_hash2(tree_key, WD_FOR_VARIANT), WD_LAYER(variants),
                                        height_cm, WD_TABLE_AT(pick + WD_PICK_LOW_CM),
                                        WD_TABLE_AT(pick + WD_PICK_SPAN_CM));
    tree.x_mm = x_mm;
    tree.y_mm = y_mm;
    tree.z_mm = z_mm;
    tree.id = 0u;
    tree.kind = WD_TABLE_AT(pick + WD_PICK_SPECIES) | (variant << 16);
    tree.size = height_cm | (wd_place_crown_cm(WD_PLACE_PASS pick, height_cm, aspect) << 16);
    tree.look = wd_place_look(tree_key, WD_LAYER(tint), WD_LAYER(turn));
    return tree;
}

/* One tree of a cell: accepted, or with size 0. */
WD_FUNC WD_STRUCT wd_tree wd_place_candidate(WD_PLACE_IN WD_STRUCT wd_place_cell cell,
                                             uint32_t sub_cell, uint32_t index)
{
    WD_STRUCT wd_tree tree;
    uint32_t key = wd_hash2(cell.key, WD_FOR_TREE + index);
    uint32_t sub_row = sub_cell / cell.side, sub_column = sub_cell - sub_row * cell.side;
    int32_t x_mm = wd_place_coordinate(WD_PLACE_PASS cell, cell.column, sub_column,
                                       wd_hash2(key, WD_FOR_EAST));
    int32_t y_mm = wd_place_coordinate(WD_PLACE_PASS cell, cell.row, sub_row,
                                       wd_hash2(key, WD_FOR_NORTH));
    WD_STRUCT wd_place_verdict verdict;
    verdict.accepted = false;
    verdict.z_mm = 0;
    /* the last cells reach past the edge of the ground */
    if (x_mm >= 0 && y_mm >= 0 && x_mm <= WD_LAYER(extent_mm[0]) && y_mm <= WD_LAYER(extent_mm[1]))
        verdict = wd_place_judge(WD_PLACE_PASS key, x_mm, y_mm);
    if (verdict.accepted)
        return wd_place_grow(WD_PLACE_PASS key, x_mm, y_mm, verdict.z_mm,
                             wd_place_height_cm(WD_PLACE_PASS key));
    tree.x_mm = x_mm;
    tree.y_mm = y_mm;
    tree.z_mm = verdict.z_mm;
    tree.id = 0u;
    tree.kind = 0u;
    tree.size = 0u;
    tree.look = 0u;
    return tree;
}

#endif
