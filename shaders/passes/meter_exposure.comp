#version 460
/* The exposure that the histogram asks for. */
#include "shared/frame.h"
#include "shared/light.h"

layout(local_size_x = 1) in;

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) buffer Meter { wd_meter meter; };

#define WD_BIN_AT(index) (meter.bins[index])

#include "shared/exposure.h"

void main()
{
    meter.exposure = wd_exposure_of();
}
