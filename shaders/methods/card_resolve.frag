#version 460
/* From the card that a pixel shows to its surface. */
#include "shared/frame.h"
#include "shared/forest.h"
#include "shared/card_soup.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 1) uniform sampler2DArray card_albedo;
layout(set = 0, binding = 2) uniform sampler2DArray card_normal;
layout(scalar, set = 0, binding = 3) readonly buffer Cards { wd_card_flat cards[]; };
layout(scalar, set = 0, binding = 4) readonly buffer Vertices { wd_card_vertex vertices[]; };
layout(set = 0, binding = 5) uniform usampler2D visible;
layout(set = 0, binding = 6) uniform sampler2DArray card_leaf;

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uint out_surface;

#include "lib/tree.glsl"
#include "lib/card.glsl"
#include "lib/card_flat.glsl"
#include "lib/card_surface.glsl"

/* A card is a parallelogram a + u b + v c. In clip space without depth, the pixel at (x, y) is a
 * multiple of (x, y, 1): Cramer's rule gives (1, u, v) up to that factor. */
vec2 card_place(uint card, vec2 at)
{
    vec3 a = vertices[4u * card].clip.xyw;
    vec3 b = vertices[4u * card + 1u].clip.xyw - a;
    vec3 c = vertices[4u * card + 2u].clip.xyw - a;
    vec3 p = vec3(at, 1.0);
    float one = dot(p, cross(b, c));
    return clamp(vec2(dot(p, cross(c, a)), dot(p, cross(a, b))) / one, 0.0, 1.0);
}

void main()
{
    uint shown = texelFetch(visible, ivec2(gl_FragCoord.xy), 0).x;
    if (shown == 0u)
        discard;
    wd_card_flat card = cards[shown - 1u];
    vec2 clip = gl_FragCoord.xy / vec2(frame.width, frame.height) * 2.0 - 1.0;
    vec2 place = card_place(shown - 1u, clip);
    vec3 uv = vec3(card_picture_uv(place, (card.layer_lod & WD_CARD_LYING) != 0u), card_layer(card.layer_lod));
    card_surface(uv, textureLod(card_albedo, uv, card_lod(card.layer_lod)),
                 uvec4(card.turn, card.tint_show, card.normal, card.ratio_flags),
                 uvec4(card.layer_lod, card.random_stem, card.surface, card.mixed));
}
