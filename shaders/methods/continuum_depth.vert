#version 460
/* A triangle over the whole target, behind all that has depth, and what its pixels ask of the view:
 * fragments of software devices read blocks lane by lane. */
#include "shared/continuum.h"

layout(scalar, set = 0, binding = 0) uniform View { wd_splat_view view; };

layout(location = 0) flat out uvec2 out_row; /* of the visibility buffer: its length; log2 of texels */
layout(location = 1) flat out float out_near_m;

void main()
{
    out_row = uvec2(view.width, view.texels >> 1);
    out_near_m = view.near_m;
    gl_Position = vec4(float(gl_VertexIndex & 1) * 4.0 - 1.0, float(gl_VertexIndex >> 1) * 4.0 - 1.0,
                       1e-12, 1.0);
}
