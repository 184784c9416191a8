#version 460
/* A histogram of log2 luminance of the picture, every second pixel of every second row. */
#include "shared/frame.h"
#include "shared/tone.h"

layout(local_size_x = 256) in;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D radiance_image;
layout(scalar, set = 0, binding = 2) buffer Meter { wd_meter meter; };

shared uint bins[WD_METER_BINS];

void main()
{
    uint lane = gl_LocalInvocationIndex;
    bins[lane] = 0u;
    barrier();
    uint columns = (frame.width + 1u) / 2u, rows = (frame.height + 1u) / 2u;
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    for (uint i = 0u; i < 16u; i++) {
        uint index = (group * 16u + i) * 256u + lane;
        if (index < columns * rows) {
            vec4 sum = imageLoad(radiance_image, 2 * ivec2(index % columns, index / columns));
            float luminance = wd_luminance(sum.rgb) / max(sum.a, 1.0);
            atomicAdd(bins[wd_meter_bin(luminance)], 1u);
        }
    }
    barrier();
    if (bins[lane] != 0u)
        atomicAdd(meter.bins[lane], bins[lane]);
}
