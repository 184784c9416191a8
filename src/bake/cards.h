/* cards.h: crossed billboards baked from a tree's full mesh. */
#ifndef WD_BAKE_CARDS_H
#define WD_BAKE_CARDS_H

#include "bake/baker.h"
#include "bake/cache.h"
#include "shared/forest.h"
#include "shared/view_set.h"
#include "tree/grow.h"

enum {
    WD_CARD_WIDTH = WD_CARD_WIDTH_TEXELS,
    WD_CARD_HEIGHT = WD_CARD_HEIGHT_TEXELS,
    WD_CARD_MIPS = WD_CARD_LAST_MIP + 1,
    WD_CARD_SUPERSAMPLING = 4,
    WD_LOOK_SIZE = 256,   /* texels a side of bark and leaf textures */
};

/* Half extents that the cards of a model span; see struct wd_model. */
struct wd_card_extent {
    float half_width_m, half_depth_m, bottom_m, top_m;
};
struct wd_card_extent wd_card_extent_of(const struct wd_tree_mesh *mesh);

/* What is kept of cards: of each plane (WD_PLANE_*) nothing, 4 bytes a texel, or blocks.h's. Of the
 * depth plane the fourth value is the share of leaves. */
enum wd_card_texels {
    WD_CARD_NOTHING,
    WD_CARD_TEXELS,
    WD_CARD_BLOCKS,
    WD_CARD_ALPHA,       /* a plane's fourth value alone: a byte a texel */
    WD_CARD_ALPHA_BLOCKS /* or half of one */
};
struct wd_card_form {
    enum wd_bake_parts parts;
    enum wd_card_texels planes[WD_PLANES];
};

/* The cards of one model, card after card, mip after mip: of normals, and of what is kept of a
 * fourth value alone, from WD_CARD_NORMAL_MIP on. What
 * a plane holds is in shared/view_set.h; depth 1 is a half width before the card (of the level card:
 * at the top), 0 as far behind it (at the bottom). */
struct wd_cards {
    struct wd_card_form form;
    uint8_t *planes[WD_PLANES]; /* wd_card_plane_bytes() each, or NULL */
    uint32_t mixed;             /* its wood over its leaves, as shared/mixed.h packs it */
};
/* The finest mip of a plane that is kept. */
uint32_t wd_card_first_mip(const struct wd_card_form *form, int plane);
size_t wd_card_plane_bytes(const struct wd_card_form *form, int plane);
/* Byte offset of a mip of a card in a plane, and its size in texels. */
size_t wd_card_offset(const struct wd_card_form *form, int plane, uint32_t card, uint32_t mip);
void wd_card_size(uint32_t mip, uint32_t *width, uint32_t *height);
void wd_cards_finish(struct wd_cards *cards); /* accepts {0} */

/* Renders the cards of `mesh` at 4 x 4 samples a texel. */
bool wd_cards_bake(struct wd_cards *cards, struct wd_baker *baker, const struct wd_bake_mesh *mesh,
                   const struct wd_card_extent *extent, const struct wd_card_form *form);

/* From the cache, and into it; `model_key` names mesh and looks. */
bool wd_cards_load(struct wd_cards *cards, struct wd_bake_cache *cache, uint64_t model_key,
                   const struct wd_card_form *form);
void wd_cards_store(const struct wd_cards *cards, struct wd_bake_cache *cache, uint64_t model_key);

#endif
