#version 460
/* From each chunk's number of cards to its place among all, and the draw of them all. */
#include "shared/card_soup.h"

layout(local_size_x = 1) in;

layout(scalar, set = 0, binding = 0) buffer Firsts { uint first_card[]; };
layout(scalar, set = 0, binding = 1) writeonly buffer Draw { wd_draw_indexed draw; };
layout(scalar, push_constant) uniform Push { wd_card_soup_push push; };

void main()
{
    uint sum = 0u;
    for (uint i = 0u; i < push.chunk_count; i++) {
        uint count = first_card[i];
        first_card[i] = sum;
        sum += count;
    }
    draw = wd_draw_indexed(sum * 6u, 1u, 0u, 0, 0u);
}
