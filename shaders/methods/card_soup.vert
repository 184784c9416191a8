#version 460
/* Corners of cards that compute has made ready: struct wd_card_vertex. */
#include "shared/card_soup.h"
#include "shared/forest.h"
#include "lib/card_picture.glsl"

layout(location = 0) in vec4 in_clip;
layout(location = 1) in uvec3 in_card; /* layer_lod, random_show, card + 1 */

layout(location = 0) out vec2 out_uv;
layout(location = 1) flat out uvec3 out_card;

void main()
{
    vec2 place = vec2(float(gl_VertexIndex & 1), float((gl_VertexIndex >> 1) & 1));
    out_uv = card_picture_uv(place, (in_card.x & WD_CARD_LYING) != 0u);
    out_card = in_card;
    gl_Position = in_clip;
}
