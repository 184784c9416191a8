/* tree.h: a placed tree and a tree model's vertex, as the CPU and the GPU both see them. */
#ifndef WD_SHARED_TREE_H
#define WD_SHARED_TREE_H

#include "shared/vec.h"

/* One standing tree. Positions are whole millimetres east, north and up of the world's origin, so
 * that a shader can subtract the camera's millimetres exactly: nothing jitters, however far the
 * world's origin is. 32 bytes. */
struct wd_tree {
    int32_t x_mm, y_mm, z_mm; /* the trunk's foot, on the ground */
    uint32_t id;              /* 1..: the same tree has the same id at every level and frame */
    uint32_t kind;            /* species index in bits 0..15, model variant in bits 16..23 */
    uint32_t size;            /* height in cm in bits 0..15; crown diameter in cm in bits 16..31 */
    uint32_t look;            /* yaw in 1/65536 turns in bits 0..15; tint in bits 16..23 (128 is
                                 neutral); bit 24: mirrored; bits 25..31: layer + 1, 0 inventory */
    uint32_t random;          /* the tree's own random number: fades, blends, wind phase */
};
WD_STATIC_ASSERT_SIZE(wd_tree, 32);

#define WD_TREE_SPECIES(tree) ((tree).kind & 0xffffu)
#define WD_TREE_VARIANT(tree) (((tree).kind >> 16) & 0xffu)
#define WD_TREE_LAYER(tree) ((tree).look >> 25) /* 0: inventory */
#define WD_TREE_HEIGHT_M(tree) (WD_FLOAT((tree).size & 0xffffu) * 0.01f)
#define WD_TREE_CROWN_M(tree) (WD_FLOAT((tree).size >> 16) * 0.01f)

/* A vertex of a tree model: metres, z up, the trunk's foot at (0, 0, 0), in the model's own size.
 * 28 bytes. */
struct wd_tree_vertex {
    WD_VEC3(position_m);
    uint32_t normal; /* octahedral, two 16-bit snorm (x in the low half) */
    uint32_t uv;     /* two half floats: bark: tiles around, metres along; leaf: 0..1 across, along */
    uint32_t tint;   /* R, G, B: multiplier of the look texture, 255 is 1; A: sky openness of the
                        place in the crown, 0 dark .. 255 free */
    uint32_t kind;   /* bits 0..7: flexibility (0 trunk foot .. 255 leaf tip); bit 8: leaf;
                        bit 9: flower; bits 10..31: 1 + the wd_tree_leaf that it is part of, or 0 */
};
WD_STATIC_ASSERT_SIZE(wd_tree_vertex, 28);
#define WD_VERTEX_LEAF 0x100u
#define WD_VERTEX_FLOWER 0x200u /* together with WD_VERTEX_LEAF: a petal */

#define WD_VERTEX_LEAF_SHIFT 10

/* A drawn leaf or needle shoot, which on a large tree stands for a twig with many: close to the
 * camera that twig is drawn instead (its leaves, or needles, of their real size). 36 bytes. */
struct wd_tree_leaf {
    WD_VEC3(position_m);    /* of its foot */
    uint32_t axis, normal;  /* to the tip; the upper side: as wd_tree_vertex.normal */
    uint32_t shading;       /* how the crown faces the light here, likewise */
    uint32_t tint;          /* as wd_tree_vertex.tint */
    float size_m;           /* of the leaf: the unit of the twig's mesh */
    uint32_t random;        /* bits 0..7: flexibility */
};
WD_STATIC_ASSERT_SIZE(wd_tree_leaf, 36);

/* Twigs of broad leaves are whole nearer than the one, and nothing is drawn as a twig beyond the
 * other; those of needles come at half of either: they are smaller, and many more. */
#define WD_SPRAY_WHOLE_M 3.5f
#define WD_SPRAY_NONE_M 5.5f

/* Share of the leaves at this distance that are drawn as twigs; `reach`: factor on distances. */
WD_FUNC float wd_spray_share(float distance_m, float reach)
{
    float t = (WD_SPRAY_NONE_M * reach - distance_m)
              / ((WD_SPRAY_NONE_M - WD_SPRAY_WHOLE_M) * reach);
    return t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t);
}

/* Layers of a species' looks. */
#define WD_LOOK_BARK 0
#define WD_LOOK_LEAF 1
#define WD_LOOK_LEAF_BACK 2 /* the lower side, seen as if through the leaf: same place, same texel */
#define WD_LOOK_FLOWER 3
#define WD_LOOK_LAYERS 4

WD_FUNC uint32_t wd_vertex_layer(uint32_t kind)
{
    return (kind & WD_VERTEX_FLOWER) != 0u ? WD_LOOK_FLOWER
           : (kind & WD_VERTEX_LEAF) != 0u ? WD_LOOK_LEAF
                                           : WD_LOOK_BARK;
}

/* A point of a tree model's surface, in progressive order: any prefix of a model's points is a fair
 * sample of its surface (src/tree/points.h). 24 bytes. */
struct wd_tree_point {
    WD_VEC3(position_m);
    uint32_t normal; /* as in wd_tree_vertex */
    uint32_t albedo; /* R, G, B: sRGB albedo, look texture and tint included; A: sky openness */
    uint32_t kind;   /* bits 0..7: flexibility; bit 8: leaf; bit 9: one-sided (wood): unseen from
                        behind; bits 16..31: half float: m^2 of surface that the point stands for
                        among all of its model's points, one side */
};
WD_STATIC_ASSERT_SIZE(wd_tree_point, 24);
#define WD_POINT_LEAF 0x100u
#define WD_POINT_ONE_SIDED 0x200u

/* Points drawn as discs: pi r^2 = gain * facing * (area of all points) / count, where facing is the
 * cosine between normal and view: its size for leaves, 0 for one-sided points seen from behind.
 * Gains are calibrated for counts WD_POINT_LEAST << k, seen level and from straight above. */
#define WD_POINT_LEAST 32
#define WD_POINT_GAINS 10
struct wd_point_gains {
    float level[WD_POINT_GAINS], above[WD_POINT_GAINS];
};
#ifdef __STDC_VERSION__
#define WD_GAINS_STRUCT struct wd_point_gains
#else
#define WD_GAINS_STRUCT wd_point_gains
#endif

/* Gain for `count` points seen from elevation asin(sine). */
WD_FUNC float wd_point_gain(WD_GAINS_STRUCT gains, float count, float sine)
{
    float at = count / WD_FLOAT(WD_POINT_LEAST);
    int k = 0;
    for (; k < WD_POINT_GAINS - 2 && at > 2.0f; k++)
        at *= 0.5f;
    float part = at < 1.0f ? 0.0f : (at > 2.0f ? 1.0f : at - 1.0f);
    float level = gains.level[k] + (gains.level[k + 1] - gains.level[k]) * part;
    float above = gains.above[k] + (gains.above[k + 1] - gains.above[k]) * part;
    return level + (above - level) * sine * sine;
}

#endif
