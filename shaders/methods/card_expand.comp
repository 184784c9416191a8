#version 460
/* Writes the cards of each chunk's trees into the soup. */
#include "lib/card_soup.glsl"

layout(scalar, set = 0, binding = 7) writeonly buffer Cards { wd_card_flat cards[]; };
layout(scalar, set = 0, binding = 8) writeonly buffer Vertices { wd_card_vertex vertices[]; };

void write_card(uint slot, card_tree t, card_frame card, uint tree)
{
    wd_card_flat constants = card_constants(t, card, tree, 1.0);
    uint random_show = (constants.random_stem & 0xffffff00u) | (constants.tint_show >> 24);
    if (SHADOW == 0u)
        cards[slot] = constants;
    for (uint i = 0u; i < 4u; i++) {
        vec2 side = vec2(float(i & 1u), float(i >> 1)) * 2.0 - 1.0;
        vertices[4u * slot + i] = wd_card_vertex(card_clip(t, card, side), constants.layer_lod,
                                                 random_show, slot + 1u);
    }
}

void main()
{
    uint at = chunk_index();
    if (at >= push.chunk_count)
        return;
    wd_card_chunk chunk = chunks[at];
    uint next = first_card[at];
    for (uint i = 0u; i < chunk_trees(chunk); i++) {
        uint tree = chunk.first_tree + i;
        card_tree t = soup_tree(tree);
        if (!soup_tree_seen(t))
            continue;
        for (uint slot = 0u; slot < chunk_slots(chunk); slot++) {
            card_frame card = card_at(t, slot);
            if (card.share > 0.0)
                write_card(next++, t, card, tree);
        }
    }
}
