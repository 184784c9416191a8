#version 460
/* How many cards each chunk of trees brings to the soup. */
#include "lib/card_soup.glsl"

void main()
{
    uint at = chunk_index();
    if (at >= push.chunk_count)
        return;
    wd_card_chunk chunk = chunks[at];
    uint count = 0u;
    for (uint i = 0u; i < chunk_trees(chunk); i++) {
        card_tree t = soup_tree(chunk.first_tree + i);
        bool seen = soup_tree_seen(t);
        for (uint slot = 0u; slot < chunk_slots(chunk); slot++)
            count += seen && card_at(t, slot).share > 0.0 ? 1u : 0u;
    }
    first_card[at] = count;
}
