/* tree.h: a placed tree and a tree model's vertex, as the CPU and the GPU both see them. */
#ifndef WD_SHARED_TREE_H
#define WD_SHARED_TREE_H

#include "shared/hash.h"
#include "shared/vec.h"

/* One standing tree. Positions are whole millimetres east, north and up of the world's origin, so
 * that a shader can subtract the camera's millimetres exactly: nothing jitters, however far the
 * world's origin is. Kept in 16 bytes: see shared/packed_tree.h. */
struct wd_tree {
    int32_t x_mm, y_mm, z_mm; /* the trunk's foot, on the ground */
    uint32_t id;              /* 1..: the same tree has the same id at every level and frame; 0 on
                                 the device, to which it is not told */
    uint32_t kind;            /* species index in bits 0..15, model variant in bits 16..23 */
    uint32_t size;            /* height in cm in bits 0..15; crown diameter in cm in bits 16..31 */
    uint32_t look;            /* yaw in 1/16384 turns in bits 0..13; tint in bits 14..21 (128 is
                                 neutral); bit 22: mirrored; bits 23..29: layer + 1, 0 inventory */
};
WD_STATIC_ASSERT_SIZE(wd_tree, 28);

#define WD_TREE_HEIGHT_MOST_CM 16383u
#define WD_TREE_CROWN_MOST_CM 8191u

#define WD_TREE_SPECIES(tree) ((tree).kind & 0xffffu)
#define WD_TREE_VARIANT(tree) (((tree).kind >> 16) & 0xffu)
#define WD_TREE_HEIGHT_CM(tree) ((tree).size & 0xffffu)
#define WD_TREE_CROWN_CM(tree) ((tree).size >> 16)
#define WD_TREE_HEIGHT_M(tree) (WD_FLOAT(WD_TREE_HEIGHT_CM(tree)) * 0.01f)
#define WD_TREE_CROWN_M(tree) (WD_FLOAT(WD_TREE_CROWN_CM(tree)) * 0.01f)
/* How far from the middle of its foot a tree of such a crown and height is found, which leans and sways: to the sides, below
 * it and above. */
#define WD_TREE_REACH_M(crown_m, height_m) ((crown_m) * 0.75f + (height_m) * 0.1f + 0.5f)
#define WD_TREE_BELOW_M 1.0f
#define WD_TREE_ABOVE_M(height_m) ((height_m) * 1.1f)
#define WD_TREE_YAW(tree) (WD_FLOAT((tree).look & 0x3fffu) * (6.28318530718f / 16384.0f))
#define WD_TREE_TINT(tree) (((tree).look >> 14) & 0xffu)
#define WD_TREE_IS_MIRRORED(tree) (((tree).look & 0x400000u) != 0u)
#define WD_TREE_LAYER(tree) ((tree).look >> 23) /* 0: inventory */
#define WD_TREE_LOOK(yaw, tint, mirrored) ((yaw) | (tint) << 14 | (mirrored) << 22)
#define WD_TREE_LOOK_OF_LAYER(look, layer) (((look) & 0x7fffffu) | (layer) << 23)

/* The tree's own random number, for fades, blends and the phase of its swaying: of what it looks
 * like in itself, so that it is the same wherever and at whatever level the tree is kept. */
WD_FUNC uint32_t wd_tree_random(WD_STRUCT wd_tree tree)
{
    return wd_hash_mix((tree.size * 0x9e3779b9u) ^ (tree.look & 0x7fffffu));
}

/* A vertex of a tree model: metres, z up, the trunk's foot at (0, 0, 0), in the model's own size.
 * 28 bytes. */
struct wd_tree_vertex {
    WD_VEC3(position_m);
    uint32_t normal; /* octahedral, two 16-bit snorm (x in the low half) */
    uint32_t uv;     /* two half floats: bark: tiles around, metres along; leaf: 0..1 across, along */
    uint32_t tint;   /* R, G, B: multiplier of the look texture, 255 is 1; A: sky openness of the
                        place in the crown, 0 dark .. 255 free */
    uint32_t kind;   /* bits 0..7: flexibility (0 trunk foot .. 255 leaf tip); bit 8: leaf;
                        bit 9: flower */
};
WD_STATIC_ASSERT_SIZE(wd_tree_vertex, 28);
#define WD_VERTEX_LEAF 0x100u
#define WD_VERTEX_FLOWER 0x200u /* together with WD_VERTEX_LEAF: a petal */
#define WD_VERTEX_KIND 0x3ffu   /* all of them */

/* Places in 1/65535 of a box. */
struct wd_mesh_box {
    WD_VEC3(least_m);
    WD_VEC3(step_m);
};
#define WD_BOX_STEPS 65535u

/* `xy`: two places, x in the low half; `z`: bits 16.. are not read. */
WD_FUNC WD_VECTOR wd_box_place(WD_STRUCT wd_mesh_box box, uint32_t xy, uint32_t z)
{
    return WD_V3(box.least_m[0] + box.step_m[0] * WD_FLOAT(xy & 0xffffu),
                 box.least_m[1] + box.step_m[1] * WD_FLOAT(xy >> 16),
                 box.least_m[2] + box.step_m[2] * WD_FLOAT(z & 0xffffu));
}

/* A wd_tree_vertex as the device keeps it, in the box of its mesh. 16 bytes. */
struct wd_packed_vertex {
    uint32_t xy;
    uint32_t z_kind;      /* bits 0..15: z; 16..25: kind; 26..31: the tint's openness */
    uint32_t uv;          /* as in wd_tree_vertex */
    uint32_t normal_tint; /* bits 0..15: octahedral, two 8-bit snorm; above, in 5, 6 and 5: square roots of
                             the tint's R, G, B */
};
WD_STATIC_ASSERT_SIZE(wd_packed_vertex, 16);
#define WD_PACKED_KIND(vertex) ((vertex).z_kind >> 16 & WD_VERTEX_KIND)

/* A leaf, needle shoot or flower: where it stands and how it is turned. Its form is one of its
 * species (wd_leaf_vertex). On a large tree it stands for a twig with many: close to the camera
 * that twig is drawn instead (its leaves, or needles, of their real size). 24 bytes. */
struct wd_tree_leaf {
    uint32_t xy;      /* of its foot, in the box of the tree's leaves */
    uint32_t z_size;  /* bits 0..15: z; 16..31: its length, the unit of its form, in steps */
    uint32_t turn;    /* quaternion from its own frame (x across, y along, z above) to the tree's:
                         bits 30..31 say which part is largest, bits 0..29 hold the others in
                         1/1023 of their range */
    uint32_t shading; /* bits 0..15: how the crown faces the light here, octahedral, two 8-bit
                         snorm; 16..23: flexibility; 24..29: how much it arches, 0..63;
                         30..31: which of its species' forms */
    uint32_t tint;    /* as wd_tree_vertex.tint */
    uint32_t open;    /* a bit for each way of shared/sun_ways.h along which its tree leaves open what
                         lies beyond; 0: not known yet (tree/sunlit.h) */
};
WD_STATIC_ASSERT_SIZE(wd_tree_leaf, 24);
#define WD_LEAF_FORM(leaf) ((leaf).shading >> 30)
#define WD_LEAF_FORMS 4 /* that it can tell apart */
#define WD_LEAF_ARCH(leaf) (WD_FLOAT(((leaf).shading >> 24) & 63u) * (1.0f / 63.0f))
#define WD_LEAF_FLEXIBILITY(leaf) (((leaf).shading >> 16) & 0xffu)

struct wd_leaf_box {
    WD_STRUCT wd_mesh_box feet;
    float size_step_m;
};

WD_FUNC WD_VECTOR wd_leaf_foot(WD_STRUCT wd_tree_leaf leaf, WD_STRUCT wd_leaf_box box)
{
    return wd_box_place(box.feet, leaf.xy, leaf.z_size);
}

WD_FUNC float wd_leaf_size_m(WD_STRUCT wd_tree_leaf leaf, WD_STRUCT wd_leaf_box box)
{
    return WD_FLOAT(leaf.z_size >> 16) * box.size_step_m;
}

/* The axes of its frame, of unit length and square to one another. */
struct wd_leaf_axes {
    WD_VECTOR across, along, above;
};

#define WD_QUATERNION_PART 0.70710678f /* parts but the largest lie within +- this */

WD_FUNC WD_STRUCT wd_leaf_axes wd_leaf_axes_of(uint32_t turn)
{
    float scale = 2.0f * WD_QUATERNION_PART / 1023.0f;
    float a = WD_FLOAT(turn & 1023u) * scale - WD_QUATERNION_PART;
    float b = WD_FLOAT((turn >> 10) & 1023u) * scale - WD_QUATERNION_PART;
    float c = WD_FLOAT((turn >> 20) & 1023u) * scale - WD_QUATERNION_PART;
    float d = WD_SQRT(WD_MAX(1.0f - a * a - b * b - c * c, 0.0f));
    uint32_t largest = turn >> 30;
    float w = largest == 0u ? d : a, x = largest == 0u ? a : (largest == 1u ? d : b);
    float y = largest < 2u ? b : (largest == 2u ? d : c), z = largest == 3u ? d : c;
    WD_STRUCT wd_leaf_axes axes;
    axes.across = WD_V3(1.0f - 2.0f * (y * y + z * z), 2.0f * (x * y + w * z),
                        2.0f * (x * z - w * y));
    axes.along = WD_V3(2.0f * (x * y - w * z), 1.0f - 2.0f * (x * x + z * z),
                       2.0f * (y * z + w * x));
    axes.above = WD_V3(2.0f * (x * z + w * y), 2.0f * (y * z - w * x),
                       1.0f - 2.0f * (x * x + y * y));
    return axes;
}

WD_FUNC WD_VECTOR wd_leaf_shading(uint32_t shading)
{
    float x = WD_FLOAT(WD_INT(shading << 24) >> 24) * (1.0f / 127.0f);
    float y = WD_FLOAT(WD_INT(shading << 16) >> 24) * (1.0f / 127.0f);
    float z = 1.0f - WD_ABS(x) - WD_ABS(y), fold = z < 0.0f ? -z : 0.0f;
    x += x >= 0.0f ? -fold : fold;
    y += y >= 0.0f ? -fold : fold;
    return wd_v3_normalize(WD_V3(x, y, z));
}

/* A corner of a leaf's form, in its own frame and in units of its length. 24 bytes. */
struct wd_leaf_vertex {
    WD_VEC3(place);
    uint32_t normal, uv; /* as in wd_tree_vertex; the normal is the upper side's */
    uint32_t kind;       /* likewise; its flexibility is what is added to the leaf's */
};
WD_STATIC_ASSERT_SIZE(wd_leaf_vertex, 24);


/* Twigs of broad leaves are whole nearer than the one, and nothing is drawn as a twig beyond the
 * other; those of needles come at four fifths of either: they are smaller, and many more. Pictures of few samples
 * have them nearer (methods/spray_draw.h). */
#define WD_SPRAY_WHOLE_M 6.5f
#define WD_SPRAY_NONE_M 9.5f

/* Share of the leaves at this distance that are drawn as twigs; `reach`: factor on distances. */
WD_FUNC float wd_spray_share(float distance_m, float reach)
{
    float t = (WD_SPRAY_NONE_M * reach - distance_m)
              / ((WD_SPRAY_NONE_M - WD_SPRAY_WHOLE_M) * reach);
    return t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t);
}

/* Those are twigs for which it is less; `random`: the tree's. */
WD_FUNC float wd_spray_chance(uint32_t leaf, uint32_t random)
{
    return wd_hash_unit(wd_hash2(leaf, random));
}

/* Layers of a species' looks. */
#define WD_LOOK_BARK 0
#define WD_LOOK_LEAF 1
#define WD_LOOK_LEAF_BACK 2 /* the lower side, seen as if through the leaf: same place, same texel */
#define WD_LOOK_FLOWER 3
#define WD_LOOK_LAYERS 4

/* What bark's tile covers on a stem of common thickness. */
#define WD_BARK_TILE_WIDTH_M 1.4f
#define WD_BARK_TILE_HEIGHT_M 1.0f

WD_FUNC uint32_t wd_vertex_layer(uint32_t kind)
{
    return (kind & WD_VERTEX_FLOWER) != 0u ? WD_LOOK_FLOWER
           : (kind & WD_VERTEX_LEAF) != 0u ? WD_LOOK_LEAF
                                           : WD_LOOK_BARK;
}

/* A point of a tree model's surface, in progressive order: any prefix of a model's points is a fair
 * sample of its surface (src/tree/points.h). 28 bytes. */
struct wd_tree_point {
    WD_VEC3(position_m);
    uint32_t normal; /* as in wd_tree_vertex */
    uint32_t face;   /* packed alike: of the flat triangle that the point lies on; a leaf's upper side */
    uint32_t albedo; /* R, G, B: sRGB albedo, look texture and tint included; A: sky openness */
    uint32_t kind;   /* bits 0..7: flexibility; bit 8: leaf; bit 9: one-sided (wood): unseen from
                        behind; bits 10..15: the way along its leaf, in the plane of its face
                        (src/tree/points.h); bits 16..31: half float: m^2 of surface that the point stands for
                        among all of its model's points, one side */
};
WD_STATIC_ASSERT_SIZE(wd_tree_point, 28);
#define WD_POINT_LEAF 0x100u
#define WD_POINT_ONE_SIDED 0x200u
#define WD_POINT_ALONG_BIT 10
#define WD_POINT_ALONG 64u /* steps */

/* Points drawn as discs: pi r^2 = gain * facing * (area of all points) / count. Facing is 1 for leaves,
 * whose normals are more the crown's than their own; of wood the cosine between normal and view, 0 for
 * points seen from behind.
 * Gains are found for counts WD_POINT_LEAST << k, seen level, from half above and from above. */
#define WD_POINT_LEAST 8
/* What nothing of a tree hides is drawn nearer by this share of the box's width: discs, larger than leaves
 * and fewer, would hide some of it. */
#define WD_DISC_NEARER 0.2f
/* And larger, that the rest shows in gaps alone; areas over the mean face's. */
#define WD_DISC_SEEN 2.0f
#define WD_DISC_HIDDEN 0.5f

/* So where a tree has few discs; 1: so many that each is sorted where it is and as large as its share. */
WD_FUNC float wd_disc_close(float discs)
{
    return WD_SMOOTH(300.0f, 1200.0f, discs);
}

/* Factor on a disc's area. `seen`: 1 where nothing of its tree hides it. */
WD_FUNC float wd_disc_open(float seen, float close)
{
    return WD_MIX(WD_MIX(WD_DISC_HIDDEN, WD_DISC_SEEN, seen), 1.0f, close);
}

#define WD_POINT_GAINS 12
#define WD_GAIN_SIDES 3
struct wd_point_gains {
    float gains[WD_GAIN_SIDES][WD_POINT_GAINS];
};
#ifdef __STDC_VERSION__
#define WD_GAINS_STRUCT struct wd_point_gains
#else
#define WD_GAINS_STRUCT wd_point_gains
#endif

/* What is known of three sides, as seen from elevation asin(sine). */
WD_FUNC float wd_side_mix(float level, float half_above, float above, float sine)
{
    float t = 2.0f * sine * sine;
    return t < 1.0f ? level + (half_above - level) * t
                    : half_above + (above - half_above) * (t - 1.0f);
}

/* Factors on the length of a level's leaves where the first 1, 1/2, 1/4, .. of them are drawn, besides
 * the one that keeps their area: with them the mesh covers what the full one does, seen level, from half
 * above and from above (src/tree/thinning.h). */
#define WD_LEAF_GROWTHS 7
struct wd_leaf_growths {
    float of[WD_GAIN_SIDES][WD_LEAF_GROWTHS];
};
#ifdef __STDC_VERSION__
#define WD_GROWTHS_STRUCT struct wd_leaf_growths
#else
#define WD_GROWTHS_STRUCT wd_leaf_growths
#endif

#define WD_POINT_GAIN(table, k, sine)                                                              \
    wd_side_mix((table).gains[0][k], (table).gains[1][k], (table).gains[2][k], sine)

/* Gain for `count` points. */
WD_FUNC float wd_point_gain(WD_GAINS_STRUCT table, float count, float sine)
{
    float at = count / WD_FLOAT(WD_POINT_LEAST);
    int k = 0;
    for (; k < WD_POINT_GAINS - 2 && at > 2.0f; k++)
        at *= 0.5f;
    float part = at < 1.0f ? 0.0f : (at > 2.0f ? 1.0f : at - 1.0f);
    float gain = WD_POINT_GAIN(table, k, sine);
    return gain + (WD_POINT_GAIN(table, k + 1, sine) - gain) * part;
}

#endif
