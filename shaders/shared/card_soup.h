/* card_soup.h: cards of a view as ready corners in clip space, made by compute (card_*.comp).
 *
 * Corner i of card c is vertices[4 c + i] (bit 0: right, bit 1: down); what fragments of the card
 * share is cards[c]. Cards stand in the order of their chunks, and within one in that of its trees:
 * near ones first. Rasterised is only which card a pixel shows (card number + 1); its surface is
 * found once a pixel (card_resolve.frag). */
#ifndef WD_SHARED_CARD_SOUP_H
#define WD_SHARED_CARD_SOUP_H

#include "shared/types.h"

/* Neighbours in octree order that one invocation looks at. */
#define WD_CHUNK_TREES 16u
struct wd_card_chunk {
    uint32_t first_tree;
    uint32_t trees_slots; /* bits 0..7: trees, at most WD_CHUNK_TREES; bits 8..15: cards a tree may
                             have: WD_UPRIGHT_VERTICES / 4 or WD_CARD_VERTICES / 4 */
};

/* What all fragments of a card share; see lib/card_flat.glsl. */
struct wd_card_flat {
    uint32_t turn;        /* cosine and sine of the yaw, snorm */
    uint32_t tint_show;   /* half the tint, unorm 8; show in A */
    uint32_t normal;      /* x and y of the normal if the card is seen from behind, snorm */
    uint32_t ratio_flags; /* half float: vertical over horizontal scale; bits WD_CARD_*; bits 19..23: down to how many
                             31sts of the picture's height its crown reaches; 24..31: of wood there the share that is
                             to be leaves, or less than 128 of leaves wood, in 127ths of all */
    uint32_t layer_lod;   /* image layer in bits 0..15; mip, 7.8 fixed point and 1 up, above; WD_CARD_LYING */
    uint32_t random_stem; /* bits 8..31: random; 0..7: down to how many 255ths of the picture's height its crown hides
                             the stem below its lowest living branch, or 0 */
    uint32_t surface;     /* tree + 1 */
    uint32_t mixed;       /* as of wd_model */
};
WD_STATIC_ASSERT_SIZE(wd_card_flat, 32);
#define WD_CARD_MIRRORED 0x10000u
#define WD_CARD_BEHIND 0x20000u /* seen from the side that it was not rendered from */
#define WD_CARD_LEVEL 0x40000u  /* the level card: its normal is up */
#define WD_CARD_LYING 0x80000000u /* of layer_lod: WD_CARD_LIES */

struct wd_card_vertex {
    WD_VEC4(clip);
    uint32_t layer_lod;   /* as in wd_card_flat */
    uint32_t random_show; /* bits 8..31: random; bits 0..7: show, unorm */
    uint32_t card;        /* + 1 */
};
WD_STATIC_ASSERT_SIZE(wd_card_vertex, 28);

#define WD_CULL_PLANES 12
/* Half-spaces in rel; planes beyond the view's own number let everything through. */
struct wd_cull_planes {
    WD_VEC4(plane[WD_CULL_PLANES]);
};

struct wd_card_soup_push {
    uint32_t chunk_count;
    uint32_t variants;
    uint32_t cascade;
    float pixels_per_radian;
};

/* As VkDrawIndexedIndirectCommand. */
struct wd_draw_indexed {
    uint32_t index_count, instance_count, first_index;
    int32_t vertex_offset;
    uint32_t first_instance;
};

#endif
