#version 460
/* A triangle over the whole target, behind all that has depth, and what its pixels ask of the frame:
 * fragments of software devices read blocks lane by lane. */
#include "shared/frame.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };

/* Of rel_from_clip, what a step right and up is and where the middle lies; a: width, height, view mode. */
layout(location = 0) flat out vec4 out_right;
layout(location = 1) flat out vec4 out_up;
layout(location = 2) flat out vec4 out_middle;
layout(location = 3) flat out vec3 out_sun;

void main()
{
    out_right = vec4(frame.rel_from_clip[0].xyz, float(frame.width));
    out_up = vec4(frame.rel_from_clip[1].xyz, float(frame.height));
    out_middle = vec4(frame.rel_from_clip[3].xyz, float(frame.view_mode));
    out_sun = frame.sun_direction;
    gl_Position = vec4(float(gl_VertexIndex & 1) * 4.0 - 1.0, float(gl_VertexIndex >> 1) * 4.0 - 1.0,
                       1e-12, 1.0);
}
