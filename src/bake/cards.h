/* cards.h: crossed billboards baked from a tree's full mesh, and their cache on disk. */
#ifndef WD_BAKE_CARDS_H
#define WD_BAKE_CARDS_H

#include "gpu/command.h"
#include "shared/forest.h"
#include "tree/grow.h"

enum {
    WD_CARD_WIDTH = WD_CARD_WIDTH_TEXELS,
    WD_CARD_HEIGHT = WD_CARD_HEIGHT_TEXELS,
    WD_CARD_MIPS = 8,     /* down to 1 x 2 */
    WD_LOOK_SIZE = 256,   /* texels a side of bark and leaf textures */
};

/* The cards of one model, with all mips, card after card, mip after mip.
 * albedo: RGB sRGB, A coverage. normal: RGB model-space normal * 0.5 + 0.5, A sky openness. Texels
 * that show nothing carry their neighbours' colours, so that filtering never darkens an edge. */
struct wd_cards {
    uint8_t *albedo, *normal; /* 4 bytes a texel; wd_cards_bytes() each */
    float half_width_m, half_depth_m, bottom_m, top_m; /* see struct wd_model */
};
size_t wd_cards_bytes(void);
/* Byte offset of a mip of a card, and its size in texels. */
size_t wd_card_offset(uint32_t card, uint32_t mip);
void wd_card_size(uint32_t mip, uint32_t *width, uint32_t *height);
void wd_cards_finish(struct wd_cards *cards);

/* The device side of baking; serves any number of models. */
struct wd_card_baker {
    struct wd_gpu *gpu;
    struct wd_frames frames;
    struct wd_pipeline pipeline;
    struct wd_image albedo, normal, depth; /* supersampled */
    VkSampler sampler;
    const struct wd_log *log;
};
bool wd_card_baker_init(struct wd_card_baker *baker, struct wd_gpu *gpu, const struct wd_log *log);
void wd_card_baker_finish(struct wd_card_baker *baker);

/* Renders the cards of `model` with its look textures (layer 0 bark, 1 leaf, WD_LOOK_SIZE square)
 * at 4 x 4 samples a texel and filters them. */
bool wd_cards_bake(struct wd_cards *cards, struct wd_card_baker *baker,
                   const struct wd_tree_model *model, struct wd_image *looks);

/* Cache files are named by the content they were made from and hold a checksum: a damaged, cut or
 * outdated file is a miss, never an error. */
uint64_t wd_cards_key(const struct wd_tree_model *model, const uint8_t *looks, size_t look_bytes);
bool wd_cards_load(struct wd_cards *cards, const char *cache_dir, uint64_t key);
/* Failure to write is a warning: the next start bakes again. */
void wd_cards_store(const struct wd_cards *cards, const char *cache_dir, uint64_t key,
                    const struct wd_log *log);

#endif
